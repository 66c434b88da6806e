#include "apps/simulation/error_probe.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// A controller moves its joints by what the run does. Without a model beside it their errors are not known,
// and what the motion needs also depends on the demanded acceleration.
static void leave_steered_joints(bough_error_probe *p, bool beside) {
    static const char *const parts[] = {"Trq", "Pos", "Vel"};
    const bough_scene *scene = p->simulation->scene;
    if (!scene->control.node || !scene->control.pitch) return;
    for (int b = 0; b < scene->turbine.n_blade; b++) {
        const bough_scene_body *body = &scene->body[scene->turbine.blade[b]];
        for (int k = 0; k < (beside ? 1 : 3) && body->joint.motion.node; k++) {
            char name[128];
            snprintf(name, sizeof name, "%.100s%s", body->name, parts[k]);
            int channel = bough_channels_find(p->channels, name);
            if (channel >= 0) p->largest[channel] = (double)NAN;
        }
    }
}

bough_status bough_error_probe_create(bough_arena *arena, bough_simulation *s, bough_simulation *second,
                                      const bough_channels *channels, bough_error_probe *probe) {
    size_t n = (size_t)channels->count;
    *probe = (bough_error_probe){.simulation = s, .channels = channels, .last = {.channel = -1}};
    probe->difference = bough_arena_doubles(arena, n);
    probe->largest = bough_arena_doubles(arena, n);
    probe->low = bough_arena_doubles(arena, n);
    probe->high = bough_arena_doubles(arena, n);
    probe->value = bough_arena_doubles(arena, n);
    probe->true_low = bough_arena_doubles(arena, n);
    probe->true_high = bough_arena_doubles(arena, n);
    probe->passed = bough_arena_doubles(arena, n);
    probe->vector = bough_arena_take(arena, (n + 1) * sizeof *probe->vector);
    probe->own = bough_arena_take(arena, (size_t)s->master->assembly->n_member * sizeof *probe->own);
    probe->state = bough_arena_doubles(arena, (size_t)s->master->assembly->n_state);
    probe->input = bough_arena_doubles(arena, (size_t)s->master->assembly->n_input);
    for (size_t i = 0; i < n; i++) {
        probe->low[i] = HUGE_VAL;
        probe->high[i] = -HUGE_VAL;
        probe->true_low[i] = HUGE_VAL;
        probe->true_high[i] = -HUGE_VAL;
        probe->passed[i] = -1;
    }
    bough_error_probe_find_vectors(channels, probe->vector);
    leave_steered_joints(probe, second != NULL);
    return bough_master_watch(s->master, arena, second ? second->master : NULL);
}

static bough_member *member(bough_simulation *s, int i) {
    return i == 0 ? &s->leader : &s->rod[i - 1];
}

static void sample(const bough_error_probe *p, double *value) {
    bough_simulation_update(p->simulation);
    bough_channels_sample(p->channels, p->simulation->master->time, value);
}

// The channels without the error: the queries see other states for a moment.
static void sample_corrected(bough_error_probe *p, const double *error) {
    bough_simulation *s = p->simulation;
    const bough_assembly *a = s->master->assembly;
    for (int i = 0; i < a->n_member; i++) {
        double *state = p->state + a->state_offset[i];
        p->own[i] = member(s, i)->state;
        for (int k = 0; k < a->member[i]->system.n_state; k++) {
            state[k] = p->own[i][k] - error[a->state_offset[i] + k];
        }
        member(s, i)->state = state;
    }
    double *input = s->master->coupling->input;
    const double *input_error = bough_master_inputs_error(s->master);
    size_t size = (size_t)a->n_input * sizeof *input;
    memcpy(p->input, input, size);
    for (int j = 0; input_error && j < a->n_input; j++) input[j] -= input_error[j];
    sample(p, p->difference);
    memcpy(input, p->input, size);
    for (int i = 0; i < a->n_member; i++) member(s, i)->state = p->own[i];
}

// An azimuth near its jump differs by a whole turn.
static double unturned(const char *unit, double difference) {
    return strcmp(unit, "deg") == 0 ? remainder(difference, 360) : difference;
}

static bool is_force(const char *unit) { return unit[0] && unit[strlen(unit) - 1] == 'N'; }

// Only a second solution tells the errors of the rods' wrenches, on which forces of driven joints, closures
// and the nacelle depend, and of forces at all: vibrations along a blade, which the linearised members damp,
// make up theirs.
static bool is_told(const bough_error_probe *p, int channel) {
    const bough_simulation *s = p->simulation;
    if (bough_master_inputs_error(s->master)) return true;
    return !is_force(p->channels->channel[channel].unit) &&
           (channel < s->first_drive || channel >= s->first_drive + s->n_drive) &&
           (channel < s->first_closure || channel >= s->first_closure + s->n_closure) &&
           (channel < s->first_bearing || channel >= s->first_bearing + s->n_bearing);
}

bool bough_error_probe_update(bough_error_probe *p) {
    const bough_master *m = p->simulation->master;
    if (bough_master_errors(m) == p->batches) return false;
    p->batches = bough_master_errors(m);
    const double *error = bough_master_state_error(m);
    const double safety = bough_master_error_safety(m);
    if (error) sample_corrected(p, error);
    sample(p, p->value);
    for (int i = 0; i < p->simulation->n_motion_channel; i++) {
        double corrected = error && is_told(p, i) ? p->difference[i] : (double)NAN;
        const char *unit = p->channels->channel[i].unit;
        p->true_low[i] = fmin(p->true_low[i], corrected);
        p->true_high[i] = fmax(p->true_high[i], corrected);
        p->difference[i] = safety * unturned(unit, p->value[i] - corrected);
        bool grows = !(fabs(p->difference[i]) <= p->largest[i]); // a NaN wins and stays
        if (grows && !isnan(p->largest[i])) p->largest[i] = fabs(p->difference[i]);
    }
    bough_error_probe_widen(p, p->value);
    bough_error_probe_mark(p, m->time);
    bough_error_probe_watch(p);
    return true;
}

bool bough_error_probe_knows(const bough_error_probe *p, int channel) {
    return p->batches > 0 && channel < p->simulation->n_motion_channel &&
           isfinite(p->largest[channel]);
}
