#include "apps/bough/cases/case_run.h"

#include "aero/wind/wind_iec.h"
#include "apps/bough/model/aero_link.h"

#include <pthread.h>

typedef struct place {
    bough_arena *arena; // memory of the box; NULL: there is no box
    bough_wind_iec_def def;
    bough_wind_box box;
    int runs; // number of runs that use the box or wait for it
    bool making;
} place;

struct bough_boxes {
    int n;
    place *place; // (n) as many as simultaneous runs, so that there is always a free one
    pthread_mutex_t mutex;
    pthread_cond_t made;
};

static void release(void *self) {
    bough_boxes *b = self;
    for (int i = 0; i < b->n; i++) bough_arena_destroy(b->place[i].arena);
    pthread_cond_destroy(&b->made);
    pthread_mutex_destroy(&b->mutex);
}

bough_boxes *bough_boxes_create(bough_arena *arena, int runs) {
    bough_boxes *b = bough_arena_take(arena, sizeof *b);
    b->n = runs;
    b->place = bough_arena_take(arena, (size_t)runs * sizeof *b->place);
    pthread_mutex_init(&b->mutex, NULL);
    pthread_cond_init(&b->made, NULL);
    bough_arena_on_destroy(arena, release, b);
    return b;
}

// The place of this box, or else one that no run uses.
static place *find(bough_boxes *b, const bough_wind_iec_def *def) {
    place *unused = NULL;
    for (int i = 0; i < b->n; i++) {
        place *p = &b->place[i];
        bool there = p->making || p->arena;
        if (there && bough_turbulence_equal(&p->def, def)) return p;
        if (p->runs == 0 && (!unused || !there)) unused = p;
    }
    return unused;
}

static bough_status make_in(bough_arena *arena, void *self) {
    place *p = self;
    return bough_turbulence_make(arena, &p->def, &p->box);
}

static void make(place *p) {
    p->arena = bough_arena_create();
    if (!p->arena) return;
    bough_status status = bough_arena_guard(p->arena, make_in, p);
    if (bough_is_ok(&status)) return;
    bough_arena_destroy(p->arena);
    p->arena = NULL;
}

const bough_wind_box *bough_boxes_lend(bough_boxes *b, const bough_scene *scene) {
    bough_wind_iec_def def;
    if (!bough_aero_link_turbulence(scene, &def)) return NULL;
    pthread_mutex_lock(&b->mutex);
    place *p = find(b, &def);
    p->runs++;
    bool mine = !p->making && !(p->arena && bough_turbulence_equal(&p->def, &def));
    if (mine) {
        // generated without the lock, so that other runs continue
        p->def = def;
        p->making = true;
        pthread_mutex_unlock(&b->mutex);
        bough_arena_destroy(p->arena);
        make(p);
        pthread_mutex_lock(&b->mutex);
        p->making = false;
        pthread_cond_broadcast(&b->made);
    }
    while (p->making) pthread_cond_wait(&b->made, &b->mutex);
    bool there = p->arena != NULL;
    if (!there) p->runs--;
    pthread_mutex_unlock(&b->mutex);
    return there ? &p->box : NULL;
}

void bough_boxes_give_back(bough_boxes *b, const bough_wind_box *box) {
    if (!box) return;
    pthread_mutex_lock(&b->mutex);
    for (int i = 0; i < b->n; i++) {
        if (box == &b->place[i].box) b->place[i].runs--;
    }
    pthread_mutex_unlock(&b->mutex);
}
