#include "aero/rotor_memory.h"

#include <math.h>

// The equilibrium induction, mean over the disk's area, as a share of the wind along the shaft.
static double mean_induction(const bough_rotor *rotor, const bough_rotor_data *data, double wind) {
    double induced = 0, area = 0;
    int n = bough_rotor_n_station(rotor);
    for (int b = 0; b < bough_rotor_n_blade(rotor); b++) {
        for (int j = 1; j + 1 < n; j++) { // at the ends the loss factor leaves no load
            const bough_station *s = data->station + b * n + j;
            double share = s->radius * (s[1].radius - s[-1].radius);
            induced += share * data->memory.station[b * n + j].state.sought[0];
            area += share;
        }
    }
    return area > 0 && fabs(wind) > 1e-3 ? induced / area / wind : 0;
}

void bough_rotor_resume(const bough_rotor_motion *motion, bough_rotor_data *data) {
    bough_inflow_clock *clock = data->memory.clock;
    clock->step = motion->time - clock->time;
}

void bough_rotor_remember(const bough_rotor *rotor, const bough_rotor_motion *motion,
                          bough_rotor_data *data) {
    double wind = bough_dot(data->disk_wind, motion->shaft);
    double radius = fmax(data->station[bough_rotor_n_station(rotor) - 1].radius, 1e-3);
    double axial = mean_induction(rotor, data, wind);
    bough_inflow_clock *clock = data->memory.clock;
    clock->tau = bough_inflow_time(bough_rotor_inflow(rotor), axial, radius, wind);
    clock->time = motion->time;
    clock->started = true;
}

enum { SCALARS = 3, PER_STATION = 6 };

static int n_memory(const bough_rotor *rotor) {
    if (bough_rotor_inflow(rotor)->kind == BOUGH_INFLOW_EQUILIBRIUM) return 0;
    return bough_rotor_n_blade(rotor) * bough_rotor_n_station(rotor);
}

int bough_rotor_memory_size(const bough_rotor *rotor) {
    int n = n_memory(rotor);
    return n == 0 ? 0 : SCALARS + PER_STATION * n;
}

void bough_rotor_save(const bough_rotor *rotor, const bough_rotor_data *data, double *to) {
    int n = n_memory(rotor);
    if (n == 0) return;
    const bough_inflow_clock *clock = data->memory.clock;
    *to++ = clock->time;
    *to++ = clock->tau;
    *to++ = clock->started;
    for (int k = 0; k < 2 * n; k++) {
        const bough_inflow_state *state = &data->memory.station[k / 2].state;
        *to++ = state->sought[k % 2];
        *to++ = state->slow[k % 2];
        *to++ = state->reached[k % 2];
    }
}

void bough_rotor_restore(const bough_rotor *rotor, const double *from, bough_rotor_data *data) {
    int n = n_memory(rotor);
    if (n == 0) return;
    bough_inflow_clock *clock = data->memory.clock;
    clock->time = *from++;
    clock->tau = *from++;
    clock->started = *from++ != 0;
    for (int k = 0; k < 2 * n; k++) {
        bough_inflow_state *state = &data->memory.station[k / 2].state;
        state->sought[k % 2] = *from++;
        state->slow[k % 2] = *from++;
        state->reached[k % 2] = *from++;
    }
}
