#include "apps/bough/cases/study_batch.h"

typedef struct piece {
    bough_batch *batch;
    int number;
} piece;

static bough_status perform_in(bough_arena *arena, void *self) {
    const piece *p = self;
    return p->batch->perform(arena, p->batch->self, p->number);
}

static void perform(void *self, int number) {
    bough_batch *b = self;
    piece p = {b, number};
    pthread_mutex_lock(&b->mutex);
    bool goes_on = bough_is_ok(&b->worst);
    pthread_mutex_unlock(&b->mutex);
    if (!goes_on) return;
    bough_status status = bough_arena_use(perform_in, &p);
    pthread_mutex_lock(&b->mutex);
    if (bough_is_ok(&b->worst)) b->worst = status;
    pthread_mutex_unlock(&b->mutex);
}

static void perform_all(void *self) {
    bough_batch *b = self;
    bough_pool_run(b->pool, b->n, perform, b);
}

void bough_batch_enter(bough_batch *b) { pthread_mutex_lock(&b->mutex); }

void bough_batch_leave(bough_batch *b) {
    b->done++;
    if (b->counts) fprintf(stderr, "\r%d of %d %s", b->done, b->to_do, b->what);
    pthread_mutex_unlock(&b->mutex);
}

bough_status bough_batch_run(bough_arena *arena, bough_batch *b, int threads) {
    b->pool = bough_pool_create(arena, threads > 0 ? threads : bough_pool_default(0));
    b->worst = bough_ok();
    pthread_mutex_init(&b->mutex, NULL);
    bough_pool_region(b->pool, perform_all, b);
    pthread_mutex_destroy(&b->mutex);
    if (b->counts && b->done > 0) fputc('\n', stderr);
    if (b->worst.code != BOUGH_INTERRUPTED) return b->worst;
    return bough_fail(BOUGH_INTERRUPTED,
                      "interrupted after %d of %d %s, which are kept in %.150s; the same command "
                      "goes on from there",
                      b->done, b->to_do, b->what, b->options->folder);
}
