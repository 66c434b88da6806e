#include "aero/rotor/rotor_memory.h"

#include "aero/rotor/rotor_model.h"

#include <math.h>
#include <string.h>

// The equilibrium induction, mean over the disk's area, as a share of the wind along the shaft.
static double mean_induction(const bough_rotor *rotor, const bough_rotor_data *data, double wind) {
    double induced = 0, area = 0;
    int n = rotor->n_station;
    for (int b = 0; b < rotor->n_blade; b++) {
        for (int j = 1; j + 1 < n; j++) { // at the ends the loss factor leaves no load
            const double *radius = data->scratch->blade[b].radius + j;
            double share = radius[0] * (radius[1] - radius[-1]);
            induced += share * data->memory.station[b * n + j].state.sought[0];
            area += share;
        }
    }
    return area > 0 && fabs(wind) > 1e-3 ? induced / area / wind : 0;
}

void bough_rotor_remember(const bough_rotor *rotor, const bough_rotor_motion *motion,
                          bough_rotor_data *data) {
    bough_inflow_clock *clock = data->memory.clock;
    if (data->memory.station) {
        double wind = bough_dot(data->disk_wind, motion->shaft);
        double radius = fmax(data->scratch->blade[0].radius[rotor->n_station - 1], 1e-3);
        double axial = mean_induction(rotor, data, wind);
        clock->tau = bough_inflow_time(&rotor->inflow, axial, radius, wind);
    }
    clock->time = motion->time;
    clock->started = true;
}

static int n_section(const bough_rotor *rotor) { return rotor->n_blade * rotor->n_station; }

void bough_rotor_forget(const bough_rotor *rotor, bough_rotor_data *data) {
    bough_rotor_memory *memory = &data->memory;
    if (!memory->clock) return;
    memory->clock->started = false;
    for (int k = 0; memory->stall && k < n_section(rotor); k++) memory->stall[k].started = 0;
}

// -- saving ---------------------------------------------------------------------------------------

// Both are doubles only: a row of numbers each.
enum {
    SCALARS = 3,
    INFLOW = sizeof(bough_inflow_state) / sizeof(double),
    STALL = sizeof(bough_stall_state) / sizeof(double),
};

static bool has_inflow(const bough_rotor *rotor) { return rotor->inflow.kind != BOUGH_INFLOW_EQUILIBRIUM; }

int bough_rotor_memory_size(const bough_rotor *rotor) {
    int per_section = (has_inflow(rotor) ? INFLOW : 0) + (rotor->stalls ? STALL : 0);
    return per_section == 0 ? 0 : SCALARS + per_section * n_section(rotor);
}

int bough_rotor_memory_states(const bough_rotor *rotor, int *row) {
    static const int inflow[] = {2, 3, 4, 5}, stall[] = {3, 4, 6, 8}; // of their structs' doubles
    int n = 0, first = has_inflow(rotor) ? SCALARS + INFLOW * n_section(rotor) : SCALARS;
    for (int k = 0; k < n_section(rotor); k++) {
        for (int i = 0; i < 4 && has_inflow(rotor); i++) row[n++] = SCALARS + INFLOW * k + inflow[i];
        for (int i = 0; i < 4 && rotor->stalls; i++) row[n++] = first + STALL * k + stall[i];
    }
    return n;
}

void bough_rotor_memory_snapshot(const bough_rotor *rotor, bough_rotor_data *data, bough_snapshot *s) {
    const bough_rotor_memory *memory = &data->memory;
    if (!memory->clock) return;
    bough_snapshot_doubles(s, &memory->clock->time, 1);
    bough_snapshot_doubles(s, &memory->clock->tau, 1);
    bough_snapshot_take(s, &memory->clock->started, sizeof memory->clock->started);
    for (int k = 0; memory->station && k < n_section(rotor); k++)
        bough_snapshot_take(s, &memory->station[k].state, sizeof memory->station[k].state);
    for (int k = 0; memory->stall && k < n_section(rotor); k++)
        bough_snapshot_take(s, &memory->stall[k], sizeof memory->stall[k]);
}
