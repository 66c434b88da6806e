// What the parts of a simulation remember, in order.
#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/simulation.h"
#include "apps/bough/model/control_link.h"
#include "apps/bough/model/drag_link.h"
#include "apps/bough/model/input_link.h"
#include "apps/bough/model/validity.h"

void bough_simulation_snapshot(bough_simulation *s, bough_snapshot *snapshot) {
    bough_master_snapshot(s->master, snapshot);
    if (s->inputs) bough_input_link_snapshot(s->inputs, snapshot);
    if (s->aero) bough_aero_link_snapshot(s->aero, snapshot);
    if (s->drag) bough_drag_link_snapshot(s->drag, snapshot);
    if (s->control) bough_control_link_snapshot(s->control, snapshot);
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
