#include "aero/rotor/rotor.h"

#include "aero/rotor/rotor_model.h"

// All vectors of a blade are in its frame's axes, stations side by side in vector lanes; the
// blade elements are those of rotor_approach_kernel.c.

// -- survey ---------------------------------------------------------------------------------------

// Below this tip-speed ratio the wake is too disturbed for momentum theory: no induction; from
// the second value on, full induction.
static const double wakeless_ratio = 1, full_wake_ratio = 2;

// Fades the induction between both ratios.
static double wake_strength(const bough_rotor *rotor, const bough_rotor_data *data, double axial) {
    double tip = 0;
    for (int b = 0; b < rotor->n_blade; b++)
        tip += data->scratch->blade[b].inflow_y[rotor->n_station - 1] / rotor->n_blade;
    if (fabs(tip) >= full_wake_ratio * fabs(axial)) return 1;
    double above = fabs(tip / axial) - wakeless_ratio;
    if (above <= 0) return 0;
    return (1 - cos(BOUGH_PI * above / (full_wake_ratio - wakeless_ratio))) / 2;
}

void bough_rotor_survey(const bough_rotor *rotor, const bough_rotor_motion *motion, bough_rotor_data *data) {
    struct bough_rotor_scratch *scratch = data->scratch;
    bough_vec3 wind = {0, 0, 0}, velocity = {0, 0, 0};
    for (int b = 0; b < rotor->n_blade; b++) {
        wind = bough_add(wind, scratch->wind[b]);
        velocity = bough_add(velocity, scratch->velocity[b]);
    }
    wind = bough_scale(1. / (rotor->n_blade * rotor->n_station), wind);
    data->disk_wind = wind;
    data->disk_velocity = bough_scale(1. / (rotor->n_blade * rotor->n_station), velocity);
    // mean wind relative to the hub, along and across the shaft
    wind = bough_sub(wind, motion->hub_velocity);
    double axial = bough_dot(wind, motion->shaft);
    bough_vec3 across = bough_axpy(-axial, motion->shaft, wind);
    double size = bough_norm(across);
    scratch->skew = atan2(size, fabs(axial));
    // the flow along the shaft as the blades meet it
    bough_vec3 inflow = bough_sub(data->disk_wind, data->disk_velocity);
    scratch->wake = wake_strength(rotor, data, bough_dot(inflow, motion->shaft));
    bool yawed = size > 1e-9 * fabs(axial);
    scratch->downwind = yawed ? bough_scale(1 / size, across) : bough_v3(0, 0, 0);
}

// -- the kernels of the rotor's level --------------------------------------------------------------

void bough_rotor_approach(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                          bough_rotor_data *data) {
    BOUGH_OF_LEVEL(bough_rotor_approach, rotor->level)(rotor, motion, blade, data);
}

void bough_rotor_induce(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                        bough_rotor_data *data) {
    BOUGH_OF_LEVEL(bough_rotor_induce, rotor->level)(rotor, motion, blade, data);
}

void bough_rotor_load(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                      bough_rotor_data *data) {
    BOUGH_OF_LEVEL(bough_rotor_load, rotor->level)(rotor, motion, blade, data);
}

// -- dynamic inflow of the whole rotor ----------------------------------------------------------

// The equilibrium induction, mean over the disk's area, relative to the wind along the shaft.
static double mean_induction(const bough_rotor *rotor, const bough_rotor_data *data, double wind) {
    double induced = 0, area = 0;
    int n = rotor->n_station;
    for (int b = 0; b < rotor->n_blade; b++) {
        for (int j = 1; j + 1 < n; j++) { // at the ends the loss factor leaves no load
            const double *radius = data->scratch->blade[b].radius + j;
            // annulus of a station
            double annulus = radius[0] * (radius[1] - radius[-1]);
            induced += annulus * data->memory.station[b * n + j].state.sought[0];
            area += annulus;
        }
    }
    return area > 0 && fabs(wind) > 1e-3 ? induced / area / wind : 0;
}

// Advances the states of all stations; to be called after the stations of a sample are solved.
static void remember(const bough_rotor *rotor, const bough_rotor_motion *motion, bough_rotor_data *data) {
    bough_inflow_clock *clock = data->memory.clock;
    if (data->memory.station) {
        double wind = bough_dot(bough_sub(data->disk_wind, motion->hub_velocity), motion->shaft);
        double radius = fmax(data->scratch->blade[0].radius[rotor->n_station - 1], 1e-3);
        double axial = mean_induction(rotor, data, wind);
        clock->tau = bough_inflow_time(&rotor->inflow, axial, radius, wind);
    }
    clock->time = motion->time;
    clock->started = true;
}

// -- the whole ------------------------------------------------------------------------------------

void bough_rotor_conclude(const bough_rotor *rotor, const bough_rotor_motion *motion,
                          bough_rotor_data *data) {
    data->thrust = data->torque = 0;
    for (int b = 0; b < rotor->n_blade; b++) {
        data->thrust += data->scratch->thrust[b];
        data->torque += data->scratch->torque[b];
    }
    if (data->memory.clock) remember(rotor, motion, data);
}

bough_station bough_rotor_station(const bough_rotor_data *data, int blade, int station) {
    const blade_rows *r = data->scratch->blade + blade;
    int j = station;
    return (bough_station){.radius = r->radius[j],
                           .inflow_x = r->inflow_x[j],
                           .inflow_y = r->inflow_y[j],
                           .axial = r->axial[j],
                           .tangential = r->tangential[j],
                           .alpha = r->alpha[j],
                           .phi = r->phi[j],
                           .twist = r->twist[j],
                           .speed = r->speed[j],
                           .coefficients = {r->lift[j], r->drag[j], r->moment[j]},
                           .force_x = r->force_x[j],
                           .force_y = r->force_y[j]};
}

void bough_rotor_result_snapshot(const bough_rotor *rotor, bough_rotor_data *data, bough_snapshot *s) {
    BOUGH_SNAPSHOT(s, data->thrust, data->torque, data->disk_wind, data->disk_velocity);
    for (int b = 0; b < rotor->n_blade; b++)
        bough_snapshot_doubles(s, data->scratch->blade[b].results, RESULTS * rotor->stride);
}

// Slower than this the angle of attack does not matter [m/s].
static const double slow = 1;

// Only stations with enough inflow count for the angle of attack.
bough_rotor_extremes bough_rotor_look(const bough_rotor *rotor, const bough_rotor_data *data, int blade) {
    const blade_rows *r = data->scratch->blade + blade;
    bough_rotor_extremes x = {.distance = HUGE_VAL};
    for (int j = 0; j < rotor->n_station; j++) {
        x.speed = r->speed[j] > x.speed ? r->speed[j] : x.speed;
        bough_vec3 place = lane_load(r->place, rotor->stride, j);
        if (bough_tower_reaches(&rotor->tower, place)) {
            x.distance = fmin(x.distance, bough_tower_distance(&rotor->tower, place));
        }
        if (x.outside_table || r->speed[j] < slow) continue;
        x.outside_table = bough_polar_outside_table(rotor->station.polar[j], r->alpha[j]);
        if (x.outside_table) x.alpha = r->alpha[j];
    }
    return x;
}

void bough_rotor_set_speed(bough_rotor *rotor, double speed) { rotor->wind.def.speed = speed; }

const bough_wind *bough_rotor_wind(const bough_rotor *rotor) { return &rotor->wind; }

bough_vec3 bough_rotor_tower_drag(const bough_rotor *rotor, bough_vec3 position, bough_vec3 axis,
                                  bough_vec3 velocity, double t) {
    bough_vec3 inflow = bough_sub(bough_wind_at(&rotor->wind, position, t), velocity);
    return bough_tower_drag(&rotor->tower, rotor->density, position, axis, inflow);
}

// ½ρ A |v| v of the wind relative to the hub.
bough_vec3 bough_rotor_hub_drag(const bough_rotor *rotor, double area, bough_vec3 position,
                                bough_vec3 velocity, double t) {
    bough_vec3 inflow = bough_sub(bough_wind_at(&rotor->wind, position, t), velocity);
    return bough_scale(0.5 * rotor->density * area * bough_norm(inflow), inflow);
}

// -- memory: dynamic inflow and stall -------------------------------------------------------------

static int n_section(const bough_rotor *rotor) { return rotor->n_blade * rotor->n_station; }

void bough_rotor_forget(const bough_rotor *rotor, bough_rotor_data *data) {
    bough_rotor_memory *memory = &data->memory;
    if (!memory->clock) return;
    memory->clock->started = false;
    for (int k = 0; memory->stall && k < n_section(rotor); k++) memory->stall[k].started = 0;
}

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
    BOUGH_SNAPSHOT(s, memory->clock->time, memory->clock->tau, memory->clock->started);
    for (int k = 0; memory->station && k < n_section(rotor); k++)
        bough_snapshot_take(s, &memory->station[k].state, sizeof memory->station[k].state);
    for (int k = 0; memory->stall && k < n_section(rotor); k++)
        bough_snapshot_take(s, &memory->stall[k], sizeof memory->stall[k]);
}
