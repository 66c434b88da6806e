#include "apps/bough/cases/case_run.h"

#include "aero/wind/wind_iec.h"
#include "apps/bough/model/aero_link.h"

#include <pthread.h>

typedef struct place {
    bough_arena *arena; // memory of the box; NULL: it is not generated
    bough_wind_iec_def def;
    bough_wind_box box;
    int runs;              // number of runs that use the box or wait for it
    pthread_mutex_t mutex; // held while the box is generated
} place;

struct bough_boxes {
    int n;
    place *place;          // (n) as many as simultaneous runs, so that there is always a free one
    pthread_mutex_t mutex; // guards which box has which place, and the numbers of runs
};

static void release(void *self) {
    bough_boxes *b = self;
    for (int i = 0; i < b->n; i++) {
        bough_arena_destroy(b->place[i].arena);
        pthread_mutex_destroy(&b->place[i].mutex);
    }
    pthread_mutex_destroy(&b->mutex);
}

bough_boxes *bough_boxes_create(bough_arena *arena, int runs) {
    bough_boxes *b = bough_arena_take(arena, sizeof *b);
    b->n = runs;
    b->place = bough_arena_take(arena, (size_t)runs * sizeof *b->place);
    for (int i = 0; i < runs; i++) pthread_mutex_init(&b->place[i].mutex, NULL);
    pthread_mutex_init(&b->mutex, NULL);
    bough_arena_on_destroy(arena, release, b);
    return b;
}

// The place of this box, or else one that no run uses, emptied for it.
static place *find(bough_boxes *b, const bough_wind_iec_def *def) {
    place *unused = NULL;
    for (int i = 0; i < b->n; i++) {
        place *p = &b->place[i];
        bool there = p->runs > 0 || p->arena;
        if (there && bough_turbulence_equal(&p->def, def)) return p;
        if (p->runs == 0 && (!unused || !there)) unused = p;
    }
    bough_arena_destroy(unused->arena);
    unused->arena = NULL;
    unused->def = *def;
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
    pthread_mutex_unlock(&b->mutex);
    // runs with other boxes continue meanwhile
    pthread_mutex_lock(&p->mutex);
    if (!p->arena) make(p);
    bool there = p->arena != NULL;
    pthread_mutex_unlock(&p->mutex);
    if (there) return &p->box;
    bough_boxes_give_back(b, &p->box);
    return NULL;
}

void bough_boxes_give_back(bough_boxes *b, const bough_wind_box *box) {
    if (!box) return;
    pthread_mutex_lock(&b->mutex);
    for (int i = 0; i < b->n; i++) {
        if (box == &b->place[i].box) b->place[i].runs--;
    }
    pthread_mutex_unlock(&b->mutex);
}
