#include "apps/bough/model/body_alone.h"

#include "cosim/port.h"

#include <math.h>
#include <string.h>

struct bough_body {
    const bough_beam *beam;
    bough_member *member;
    double macro_step;                // [s]
    double now[BOUGH_BODY_INPUTS];    // motion at the present time
    double motion[BOUGH_BODY_INPUTS]; // to be reached
    bough_signal signal;
    double wrench[BOUGH_ROD_MOST_OUTPUTS];
};

const bough_body_variable bough_body_inputs[BOUGH_BODY_INPUTS] = {
    {"vx", BOUGH_SPEED, NULL},         {"vy", BOUGH_SPEED, NULL},
    {"vz", BOUGH_SPEED, NULL},         {"wx", BOUGH_ANGULAR_SPEED, NULL},
    {"wy", BOUGH_ANGULAR_SPEED, NULL}, {"wz", BOUGH_ANGULAR_SPEED, NULL},
    {"gx", BOUGH_ACCELERATION, NULL},  {"gy", BOUGH_ACCELERATION, NULL},
    {"gz", BOUGH_ACCELERATION, NULL},
};
const bough_body_variable bough_body_outputs[BOUGH_BODY_OUTPUTS] = {
    {.name = "Fx", .unit = "N"},   {.name = "Fy", .unit = "N"},   {.name = "Fz", .unit = "N"},
    {.name = "Mx", .unit = "N m"}, {.name = "My", .unit = "N m"}, {.name = "Mz", .unit = "N m"},
};

static bough_status find(const bough_simulation *s, const char *name, const bough_beam **beam) {
    for (int k = 0; k < s->n_beam; k++) {
        if (strcmp(s->beam[k].body->name, name) == 0) *beam = &s->beam[k];
    }
    if (!*beam || (*beam)->port < 0) {
        return bough_fail(BOUGH_INVALID, "%.200s: there is no flexible body '%.48s'", s->scene->file,
                          name);
    }
    if ((*beam)->end >= 0) {
        return bough_fail(BOUGH_INVALID, "'%.48s' carries bodies: only a body at the end of a chain can "
                                         "be stepped by itself", name);
    }
    if ((*beam)->in_ground) {
        return bough_fail(BOUGH_INVALID, "'%.48s' cannot be stepped by itself: it moves under loads in "
                                         "ground axes", name);
    }
    if (s->master->n_load > 0) {
        return bough_fail(BOUGH_INVALID, "'%.48s' cannot be stepped by itself in a scene with air, "
                                         "control, inputs or loads that jump", name);
    }
    return bough_ok();
}

bough_status bough_body_create(bough_arena *arena, bough_simulation *s, const char *name,
                               bough_body **body) {
    const bough_beam *beam = NULL;
    bough_status status = find(s, name, &beam);
    if (!bough_is_ok(&status)) return status;
    bough_body *b = bough_arena_take(arena, sizeof *b);
    *b = (bough_body){.beam = beam,
                      .member = &s->rod[beam->port],
                      .macro_step = s->master->macro_step,
                      .signal = bough_port_signal(arena, BOUGH_BODY_INPUTS)};
    memcpy(b->now, bough_simulation_rod_input(s, beam), sizeof b->now);
    memcpy(b->motion, b->now, sizeof b->motion);
    *body = b;
    return status;
}

void bough_body_begin(bough_body *b) {
    if (memcmp(b->now, b->motion, sizeof b->now) == 0) return;
    memcpy(b->now, b->motion, sizeof b->now);
    bough_beam_ride(b->beam, b->now, b->member->state);
    bough_member_set(b->member, b->member->time, b->member->state);
}

bough_status bough_body_step(bough_body *b) {
    double t = b->member->time;
    b->signal.t0 = t;
    b->signal.t1 = (round(t / b->macro_step) + 1) * b->macro_step;
    bough_port_linear(&b->signal, 0, BOUGH_BODY_INPUTS, b->now, b->motion);
    bough_status status = bough_member_advance(b->member, b->signal.t1, &b->signal, true);
    if (bough_is_ok(&status)) memcpy(b->now, b->motion, sizeof b->now);
    return status;
}

double bough_body_time(const bough_body *b) { return b->member->time; }

double *bough_body_motion(bough_body *b) { return b->motion; }

const double *bough_body_wrench(bough_body *b) {
    const bough_system *x = &b->member->system;
    x->ops->output(x->self, b->member->time, b->member->state, b->now, b->wrench);
    return b->wrench;
}

void bough_body_snapshot(bough_body *b, bough_snapshot *s) {
    bough_member_snapshot(b->member, s);
    bough_snapshot_doubles(s, b->now, BOUGH_BODY_INPUTS);
    bough_snapshot_doubles(s, b->motion, BOUGH_BODY_INPUTS);
}
