// Times at which loads and prescribed motions of joints jump, by tables and ramps of the scene.
#include "apps/bough/model/companion.h"

// Values over time: of a load or of a motion.
typedef struct table {
    int n;
    const double *times, *values; // (n)
} table;

// The times of jumps, and the least change that is a jump.
typedef struct jumps {
    double step, part; // duration [s]; fraction of the range
    double *time;      // [s]; NULL: not wanted
    int n;
} jumps;

static void note(jumps *j, double at) {
    if (j->time) j->time[j->n] = at;
    ++j->n;
}

// Between the least and the largest value.
static double range_of(const table *x) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int k = 0; k < x->n; k++) {
        low = fmin(low, x->values[k]);
        high = fmax(high, x->values[k]);
    }
    return high - low;
}

// The largest change to row k from a row less than a step before it, but `first` at least.
static double change_to(const table *x, int k, int first, double step) {
    double change = 0;
    for (int j = k - 1; j >= first && x->times[k] - x->times[j] < step; j--)
        change = fmax(change, fabs(x->values[k] - x->values[j]));
    return change;
}

// The first row after the start, at which jumps do not count.
static int first_row(const table *x) {
    int first = 0;
    while (first < x->n && x->times[first] <= 0) first++;
    return first;
}

static void note_table(jumps *j, const table *x) {
    double least = x->n > 0 ? j->part * range_of(x) : 0;
    int first = first_row(x);
    for (int k = first + 1; k < x->n; k++)
        if (change_to(x, k, first, j->step) > least) note(j, x->times[k]);
}

static void note_ramp(jumps *j, double start, double end) {
    if (start > 0 && end - start < j->step) note(j, end);
}

static void note_motion(jumps *j, const bough_motion_def *m) {
    if (!m->given) return;
    note_table(j, &(table){m->n, m->times, m->values});
    if (m->n == 0 && m->from != m->to) note_ramp(j, m->start, m->end);
}

int bough_jump_times(const bough_scene *scene, double part, double *time) {
    jumps j = {scene->simulation.macro_step, part, time, 0};
    for (int i = 0; i < scene->n_load; i++) {
        const bough_scene_load *load = &scene->load[i];
        note_table(&j, &(table){load->n_time, load->times, load->values});
        note_ramp(&j, load->ramp[0], load->ramp[1]);
    }
    for (int i = 0; i < scene->n_body; i++)
        for (int k = 0; k < 2; k++) note_motion(&j, &scene->body[i].joint.motion[k].def);
    if (time) qsort(time, (size_t)j.n, sizeof *time, bough_ascending);
    return j.n;
}
