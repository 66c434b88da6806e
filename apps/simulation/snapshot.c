// What the parts of a simulation remember, in order.
#include "apps/simulation/aero_link.h"
#include "apps/simulation/simulation.h"
#include "apps/simulation/control_link.h"
#include "apps/simulation/drag_link.h"
#include "apps/simulation/input_link.h"
#include "apps/simulation/validity.h"

static void take_aero(bough_aero_link *link, bough_snapshot *s) {
    double *room = bough_snapshot_room(s, (size_t)bough_aero_link_size(link) * sizeof *room);
    if (s->move == BOUGH_SNAPSHOT_SAVE) bough_aero_link_save(link, room);
    if (s->move == BOUGH_SNAPSHOT_RESTORE) bough_aero_link_restore(link, room);
}

static void take_drag(bough_drag_link *link, bough_snapshot *s) {
    double *room = bough_snapshot_room(s, (size_t)bough_drag_link_size(link) * sizeof *room);
    if (s->move == BOUGH_SNAPSHOT_SAVE) bough_drag_link_save(link, room);
    if (s->move == BOUGH_SNAPSHOT_RESTORE) bough_drag_link_restore(link, room);
}

static void take_inputs(bough_input_link *link, bough_snapshot *s) {
    double *room = bough_snapshot_room(s, (size_t)bough_input_link_size(link) * sizeof *room);
    if (s->move == BOUGH_SNAPSHOT_SAVE) bough_input_link_save(link, room);
    if (s->move == BOUGH_SNAPSHOT_RESTORE) bough_input_link_restore(link, room);
}

static void take_control(bough_control_link *link, bough_snapshot *s) {
    double *room = bough_snapshot_room(s, (size_t)bough_control_link_size(link) * sizeof *room);
    if (s->move == BOUGH_SNAPSHOT_SAVE) bough_control_link_save(link, room);
    if (s->move == BOUGH_SNAPSHOT_RESTORE) bough_control_link_restore(link, room);
}

void bough_simulation_snapshot(bough_simulation *s, bough_snapshot *snapshot) {
    bough_master_snapshot(s->master, snapshot);
    if (s->inputs) take_inputs(s->inputs, snapshot);
    if (s->aero) take_aero(s->aero, snapshot);
    if (s->drag) take_drag(s->drag, snapshot);
    if (s->control) take_control(s->control, snapshot);
    bough_snapshot_take(snapshot, s->validity, sizeof *s->validity);
}

bough_status bough_simulation_known(const bough_simulation *s, const char *what) {
    if (s->n_fmu == 0) return bough_ok();
    return bough_fail(BOUGH_INVALID, "%.200s: '%.40s' is an FMU, whose equations are not known: %s",
                      s->scene->file, s->rod[s->n_rod].system.name, what);
}

bough_status bough_simulation_storable(const bough_simulation *s) {
    if (s->n_fmu > 0) {
        return bough_fail(BOUGH_INVALID, "the FMU of '%.40s' keeps a memory of its own, which cannot be "
                                         "stored", s->rod[s->n_rod].system.name);
    }
    const bough_scene_control *control = &s->scene->control;
    if (!control->node || control->kind != BOUGH_SCENE_BLADED) return bough_ok();
    return bough_fail(BOUGH_INVALID,
                      "the controller %.200s keeps a memory of its own, which cannot be stored",
                      control->library);
}
