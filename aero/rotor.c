#include "aero/rotor.h"

#include "aero/rotor_memory.h"

#include "core/base.h"
#include "core/rotation.h"

// The blade elements follow the polar formulation of the reference code (AeroDyn v5): y is
// tangential at the element's own place, x normal to the bent but unswept, unpitched, untwisted
// blade, and momentum is balanced over the element's projection on the rotor plane. Axes of the
// blade root instead gave 0.4 % less thrust on a blade bent by 3 m. Loss factors are those of the
// undeformed rotor; forces are per length of the reference axis.
//
// Loads are piecewise linear between stations, the deformed reference axis piecewise linear
// between vertices. With the vertices' hat functions as weights, force and moment of the line
// load are then conserved exactly, and the weights are constants of the model.

typedef struct station_model {
    const bough_polar *polar;
    int vertex;         // the station lies between this vertex and the next
    double weight;      // of the next
    bough_mat3 section; // aero section axes in the interpolated structural section
    bough_vec3 centre;  // aerodynamic centre in the same axes, from the reference axis [m]
    double chord, tip_factor, hub_factor;
} station_model;

// Row i of the mapping: vertex i takes Σ_k weight[k] · line load of station first + k.
typedef struct vertex_row {
    int first, count;
    const double *weight; // (count) [m]
} vertex_row;

struct bough_rotor {
    int n_blade, n_station, n_vertex;
    double density;
    bool pitching_moment, skew;
    bough_induction_options induction;
    bough_inflow_def inflow;
    bough_wind wind;
    bough_tower tower;
    station_model *station; // (n_station)
    vertex_row *row;        // (n_vertex)
    const bough_stall_airfoil *airfoil; // (n_station); NULL: static polars
};

typedef struct station_state {
    bough_vec3 arm;     // from the reference axis to the aerodynamic centre [m]
    bough_vec3 x, y, z; // axes of the blade element: normal, tangential, along the blade
    bough_vec3 wind;    // at the aerodynamic centre [m/s]
    double twist;       // of the chord from y [rad]
    double nose_up;     // rate of the section's rotation [rad/s]
} station_state;

struct bough_rotor_scratch {
    station_state *state;        // (n_blade × n_station)
    bough_vec3 *force, *moment;  // (n_blade × n_station) per length
};

// What the whole rotor tells each station.
typedef struct disk {
    bough_vec3 shaft;    // unit vector
    double skew;         // acute angle of the wind and the shaft [rad]
    bough_vec3 downwind; // unit vector of the wind's part in the rotor plane, 0 if none
    double wake;         // 0: too slow for momentum theory, 1: full induction
    bough_inflow_station *memory; // of dynamic inflow, or NULL: one for each station from …
    bough_stall_state *stall;     // of dynamic stall, or NULL: likewise
    double step;                  // from the last sample to this [s]
    const bough_station *first;   // … this one
} disk;

bough_rotor_def bough_rotor_def_default(void) {
    return (bough_rotor_def){.n_blade = 3,
                             .density = 1.225,
                             .pitching_moment = true,
                             .skew = true,
                             .induction = bough_induction_options_default(),
                             .wind = bough_wind_def_default()};
}

int bough_rotor_n_blade(const bough_rotor *rotor) { return rotor->n_blade; }
int bough_rotor_n_station(const bough_rotor *rotor) { return rotor->n_station; }
int bough_rotor_n_vertex(const bough_rotor *rotor) { return rotor->n_vertex; }

// -- build ----------------------------------------------------------------------------------------

static bough_status check_station(const bough_rotor_def *def, int j) {
    const bough_station_def *s = def->station + j;
    double length = def->vertex_span[def->n_vertex - 1];
    if (j > 0 && !(s->span > s[-1].span)) {
        return bough_fail(BOUGH_INVALID, "Aero station %d: spans must increase.", j + 1);
    }
    if (s->span < def->vertex_span[0] - 1e-6 * length || s->span > length * (1 + 1e-6)) {
        return bough_fail(BOUGH_INVALID, "Aero station %d: span %g m is not on the blade (%g m).",
                          j + 1, s->span, length);
    }
    if (!(s->chord > 0)) {
        return bough_fail(BOUGH_INVALID, "Aero station %d: the chord must be positive.", j + 1);
    }
    const int wanted[2] = {s->polar, s->share > 0 ? s->second : s->polar};
    for (int i = 0; i < 2; i++) {
        if (wanted[i] >= 0 && wanted[i] < def->n_polar) continue;
        return bough_fail(BOUGH_INVALID, "Aero station %d: there is no polar %d.", j + 1,
                          wanted[i]);
    }
    if (!(s->share >= 0 && s->share <= 1)) {
        return bough_fail(BOUGH_INVALID, "Aero station %d: a polar's share is from 0 to 1.", j + 1);
    }
    return bough_ok();
}

static bough_status check(const bough_rotor_def *def) {
    if (def->n_blade < 1) return bough_fail(BOUGH_INVALID, "The rotor needs a blade.");
    if (def->n_station < 2) return bough_fail(BOUGH_INVALID, "A blade needs two aero stations.");
    if (def->n_vertex < 2) return bough_fail(BOUGH_INVALID, "A blade needs two vertices.");
    if (!(def->density > 0)) return bough_fail(BOUGH_INVALID, "The air density must be positive.");
    if (!(def->hub_radius > 0)) {
        return bough_fail(BOUGH_INVALID, "The hub radius must be positive.");
    }
    for (int i = 1; i < def->n_vertex; i++) {
        if (!(def->vertex_span[i] > def->vertex_span[i - 1])) {
            return bough_fail(BOUGH_INVALID, "Vertex %d: spans must increase.", i + 1);
        }
    }
    for (int j = 0; j < def->n_station; j++) {
        bough_status status = check_station(def, j);
        if (!bough_is_ok(&status)) return status;
    }
    return bough_ok();
}

// The rotation part way from p to q. Within the few degrees between neighbouring vertices the
// normalised chord is as good as the arc, and like it independent of the frame.
static bough_mat3 rotation_between(bough_quaternion p, bough_quaternion q, double weight) {
    double side = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z;
    double wp = 1 - weight, wq = side < 0 ? -weight : weight;
    bough_quaternion r = {wp * p.w + wq * q.w, wp * p.x + wq * q.x, wp * p.y + wq * q.y,
                          wp * p.z + wq * q.z};
    return bough_rotation_matrix(bough_quaternion_normalised(r));
}

static bough_vec3 between(bough_vec3 a, bough_vec3 b, double weight) {
    return bough_v3(a.x + weight * (b.x - a.x), a.y + weight * (b.y - a.y),
                    a.z + weight * (b.z - a.z));
}

// Section axes turned by the aero twist from blade-root axes: leading edge into the wind.
static bough_mat3 twisted(double twist) {
    double c = cos(twist), s = sin(twist);
    return (bough_mat3){{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
}

static void place_station(const bough_rotor_def *def, const bough_station_def *from,
                          const bough_polar *polar, station_model *to) {
    int i = 0;
    while (i < def->n_vertex - 2 && from->span > def->vertex_span[i + 1])
        i++;
    double start = def->vertex_span[i], end = def->vertex_span[i + 1];
    double w = bough_clamp((from->span - start) / (end - start), 0, 1);
    bough_mat3 structure =
        rotation_between(bough_quaternion_of_matrix(def->vertex_rotation[i]),
                         bough_quaternion_of_matrix(def->vertex_rotation[i + 1]), w);
    bough_vec3 axis = between(def->vertex_position[i], def->vertex_position[i + 1], w);
    bough_vec3 arm = bough_v3(from->centre_x - axis.x, from->centre_y - axis.y, 0);
    double radius = def->hub_radius + from->span;
    double tip = def->hub_radius + def->station[def->n_station - 1].span;
    *to = (station_model){
        .polar = polar,
        .vertex = i,
        .weight = w,
        .section = bough_mat3_product(bough_mat3_transpose(structure), twisted(from->twist)),
        .centre = bough_mat3_tmul(structure, arm),
        .chord = from->chord,
        .tip_factor = def->n_blade * (tip - radius) / (2 * radius),
        .hub_factor = def->n_blade * from->span / (2 * def->hub_radius)};
}

// Adds ∫ hat_i N_j ds over [a, b], on which all are linear; by Simpson's rule, exact for products.
static void add_interval(const bough_rotor_def *def, double a, double b, int vertex, int station,
                         double *dense) {
    const double *x = def->vertex_span;
    double x0 = x[vertex], dx = x[vertex + 1] - x0;
    double y0 = def->station[station].span, dy = def->station[station + 1].span - y0;
    const double point[3] = {a, (a + b) / 2, b}, weight[3] = {1. / 6, 4. / 6, 1. / 6};
    for (int k = 0; k < 3; k++) {
        double hat = bough_clamp((point[k] - x0) / dx, 0, 1), load = (point[k] - y0) / dy;
        double w = weight[k] * (b - a);
        double *here = dense + vertex * def->n_station + station, *next = here + def->n_station;
        here[0] += w * (1 - hat) * (1 - load);
        here[1] += w * (1 - hat) * load;
        next[0] += w * hat * (1 - load);
        next[1] += w * hat * load;
    }
}

// dense (n_vertex × n_station): what each vertex takes of each station's line load [m].
static void fill_mapping(const bough_rotor_def *def, double *dense) {
    int vertex = 0, last = def->n_vertex - 2;
    for (int j = 0; j + 1 < def->n_station; j++) {
        double a = def->station[j].span, end = def->station[j + 1].span;
        while (a < end) {
            while (vertex < last && def->vertex_span[vertex + 1] <= a)
                vertex++;
            double b = vertex < last ? fmin(end, def->vertex_span[vertex + 1]) : end;
            add_interval(def, a, b, vertex, j, dense);
            a = b;
        }
    }
}

// Keeps of each dense row the stretch from its first to its last entry.
static void compress_rows(const bough_rotor *rotor, const double *dense) {
    for (int i = 0; i < rotor->n_vertex; i++) {
        const double *d = dense + i * rotor->n_station;
        int first = 0, end = rotor->n_station;
        while (first < end && d[first] == 0)
            first++;
        while (end > first && d[end - 1] == 0)
            end--;
        rotor->row[i] = (vertex_row){first, end - first, d + first};
    }
}

// The def's polars and, after them, one for each station that has a mixture.
static bough_status build_polars(bough_arena *arena, const bough_rotor_def *def,
                                 const bough_polar **polars) {
    int most = def->n_polar + def->n_station;
    bough_polar *polar = bough_arena_take(arena, (size_t)most * sizeof *polar);
    if (!polar) return bough_fail(BOUGH_OUT_OF_MEMORY, "No memory for the polars.");
    *polars = polar;
    bough_status status = bough_ok();
    for (int i = 0; i < most && bough_is_ok(&status); i++) {
        if (i < def->n_polar) {
            status = bough_polar_build(arena, def->polar + i, polar + i);
            continue;
        }
        const bough_station_def *s = def->station + i - def->n_polar;
        if (s->share > 0) {
            status = bough_polar_blend(arena, polar + s->polar, polar + s->second, s->share,
                                       polar + i);
        }
    }
    for (int i = 0; i < most && def->smooth_polars && bough_is_ok(&status); i++)
        if (polar[i].n > 0) status = bough_polar_smoothen(arena, polar + i);
    return status;
}

static bough_status prepare_stall(bough_arena *arena, bough_rotor *rotor) {
    size_t n = (size_t)rotor->n_station;
    bough_stall_airfoil *airfoil = bough_arena_take(arena, n * sizeof *airfoil);
    if (!airfoil) return bough_fail(BOUGH_OUT_OF_MEMORY, "No memory for the dynamic stall.");
    for (size_t j = 0; j < n; j++)
        airfoil[j] = bough_stall_airfoil_of(rotor->station[j].polar);
    rotor->airfoil = airfoil;
    return bough_ok();
}

bough_status bough_rotor_build(bough_arena *arena, const bough_rotor_def *def,
                               const bough_rotor **result) {
    *result = NULL;
    bough_status status = check(def);
    if (!bough_is_ok(&status)) return status;
    size_t n_station = (size_t)def->n_station, n_vertex = (size_t)def->n_vertex;
    bough_rotor *rotor = bough_arena_take(arena, sizeof *rotor);
    station_model *station = bough_arena_take(arena, n_station * sizeof *station);
    vertex_row *row = bough_arena_take(arena, n_vertex * sizeof *row);
    double *dense = bough_arena_doubles(arena, n_vertex * n_station);
    if (!rotor || !station || !row || !dense) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "No memory for the rotor's aerodynamics.");
    }
    *rotor = (bough_rotor){.n_blade = def->n_blade,
                           .n_station = def->n_station,
                           .n_vertex = def->n_vertex,
                           .density = def->density,
                           .pitching_moment = def->pitching_moment,
                           .skew = def->skew,
                           .induction = def->induction,
                           .inflow = def->inflow,
                           .station = station,
                           .row = row};
    const bough_polar *polar = NULL;
    status = build_polars(arena, def, &polar);
    if (bough_is_ok(&status)) status = bough_wind_build(arena, &def->wind, &rotor->wind);
    if (bough_is_ok(&status)) status = bough_tower_build(arena, &def->tower, &rotor->tower);
    if (!bough_is_ok(&status)) return status;
    for (int j = 0; j < def->n_station; j++) {
        const bough_station_def *from = def->station + j;
        place_station(def, from, polar + (from->share > 0 ? def->n_polar + j : from->polar),
                      station + j);
    }
    fill_mapping(def, dense);
    compress_rows(rotor, dense);
    if (def->stall != BOUGH_STALL_NONE) status = prepare_stall(arena, rotor);
    if (bough_is_ok(&status)) *result = rotor;
    return status;
}

// Stations keep their place on the radius of the undeformed rotor, as the loss factors do.
static void take_inflow(bough_arena *arena, const bough_rotor *rotor, bough_rotor_memory *memory) {
    int n = rotor->n_blade * rotor->n_station;
    memory->station = bough_arena_take(arena, (size_t)n * sizeof *memory->station);
    if (!memory->station) return;
    for (int k = 0; k < n; k++) {
        double tip_factor = rotor->station[k % rotor->n_station].tip_factor;
        double share = 1 / (1 + 2 * tip_factor / rotor->n_blade); // of B (R − r)/(2 r)
        memory->station[k] = (bough_inflow_station){.share = share, .clock = memory->clock};
    }
}

static void take_memory(bough_arena *arena, const bough_rotor *rotor, bough_rotor_memory *memory) {
    size_t n = (size_t)rotor->n_blade * rotor->n_station;
    bool delayed = rotor->inflow.kind != BOUGH_INFLOW_EQUILIBRIUM;
    if (!delayed && !rotor->airfoil) return;
    memory->clock = bough_arena_take(arena, sizeof *memory->clock);
    if (delayed) take_inflow(arena, rotor, memory);
    if (rotor->airfoil) memory->stall = bough_arena_take(arena, n * sizeof *memory->stall);
}

bough_status bough_rotor_data_build(bough_arena *arena, const bough_rotor *rotor,
                                    bough_rotor_data *data) {
    size_t n_blade = (size_t)rotor->n_blade, n_station = (size_t)rotor->n_station;
    size_t n_vertex = (size_t)rotor->n_vertex;
    *data = (bough_rotor_data){0};
    data->force = bough_arena_take(arena, n_blade * n_vertex * sizeof *data->force);
    data->moment = bough_arena_take(arena, n_blade * n_vertex * sizeof *data->moment);
    data->station = bough_arena_take(arena, n_blade * n_station * sizeof *data->station);
    struct bough_rotor_scratch *s = bough_arena_take(arena, sizeof *s);
    if (s) {
        s->state = bough_arena_take(arena, n_blade * n_station * sizeof *s->state);
        s->force = bough_arena_take(arena, n_blade * n_station * sizeof *s->force);
        s->moment = bough_arena_take(arena, n_blade * n_station * sizeof *s->moment);
    }
    data->scratch = s;
    take_memory(arena, rotor, &data->memory);
    if (bough_arena_exhausted(arena)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "No memory for the rotor's loads.");
    }
    return bough_ok();
}

// -- sample ---------------------------------------------------------------------------------------

// The axes of a blade element at `arm` from the hub: y against the rotation, normal to shaft and
// arm; z as the section's, without sweep. Returns the distance from the shaft.
static double orient(bough_vec3 shaft, bough_vec3 arm, const bough_mat3 *section,
                     station_state *state) {
    bough_vec3 radial = bough_axpy(-bough_dot(arm, shaft), shaft, arm);
    double radius = bough_norm(radial);
    if (radius < 1e-9) { // on the shaft: any direction will do
        radial = bough_cross(shaft, fabs(shaft.x) < 0.5 ? bough_v3(1, 0, 0) : bough_v3(0, 1, 0));
    }
    radial = bough_scale(1 / bough_norm(radial), radial);
    double s = bough_clamp(bough_dot(section->c3, shaft), -1, 1), c = sqrt(1 - s * s);
    state->x = bough_axpy(-s, radial, bough_scale(c, shaft));
    state->y = bough_cross(radial, shaft);
    state->z = bough_axpy(s, shaft, bough_scale(c, radial));
    state->twist = atan2(bough_dot(section->c2, shaft), bough_dot(section->c1, shaft));
    return radius;
}

// Where station k of all is, how it moves, and the wind it meets.
static void move_station(const bough_rotor *rotor, const bough_rotor_motion *motion, int k,
                         bough_rotor_data *data) {
    const station_model *m = rotor->station + k % rotor->n_station;
    station_state *state = data->scratch->state + k;
    bough_station *out = data->station + k;
    int a = k / rotor->n_station * rotor->n_vertex + m->vertex, b = a + 1;
    bough_mat3 structure =
        rotation_between(bough_quaternion_of_matrix(motion->rotation[a]),
                         bough_quaternion_of_matrix(motion->rotation[b]), m->weight);
    bough_mat3 section = bough_mat3_product(structure, m->section);
    state->arm = bough_mat3_mul(structure, m->centre);
    bough_vec3 centre =
        bough_add(between(motion->position[a], motion->position[b], m->weight), state->arm);
    out->radius = orient(motion->shaft, bough_sub(centre, motion->hub), &section, state);
    bough_vec3 spin = between(motion->angular_velocity[a], motion->angular_velocity[b], m->weight);
    bough_vec3 velocity = bough_add(between(motion->velocity[a], motion->velocity[b], m->weight),
                                    bough_cross(spin, state->arm));
    state->wind = bough_tower_disturbed(&rotor->tower, centre,
                                        bough_wind_at(&rotor->wind, centre, motion->time));
    bough_vec3 inflow = bough_sub(state->wind, velocity);
    out->inflow_x = bough_dot(inflow, state->x);
    out->inflow_y = bough_dot(inflow, state->y);
    out->twist = state->twist;
    if (rotor->airfoil) state->nose_up = bough_dot(spin, state->z);
}

// Below this tip-speed ratio the wake is too disturbed for momentum theory: no induction; from
// the second value on, full induction.
static const double wakeless_ratio = 1, full_wake_ratio = 2;

static double wake_strength(const bough_rotor *rotor, const bough_rotor_data *data, double axial) {
    double tip = 0;
    for (int b = 0; b < rotor->n_blade; b++) {
        tip += data->station[(b + 1) * rotor->n_station - 1].inflow_y / rotor->n_blade;
    }
    if (fabs(tip) >= full_wake_ratio * fabs(axial)) return 1;
    double above = fabs(tip / axial) - wakeless_ratio;
    if (above <= 0) return 0;
    return (1 - cos(BOUGH_PI * above / (full_wake_ratio - wakeless_ratio))) / 2;
}

static disk survey_disk(const bough_rotor *rotor, const bough_rotor_motion *motion,
                        bough_rotor_data *data) {
    int n = rotor->n_blade * rotor->n_station;
    bough_vec3 wind = {0};
    for (int k = 0; k < n; k++)
        wind = bough_axpy(1. / n, data->scratch->state[k].wind, wind);
    data->disk_wind = wind;
    double axial = bough_dot(wind, motion->shaft);
    bough_vec3 across = bough_axpy(-axial, motion->shaft, wind);
    double size = bough_norm(across);
    disk d = {.shaft = motion->shaft,
              .skew = atan2(size, axial),
              .wake = wake_strength(rotor, data, axial)};
    if (size > 1e-9 * fabs(axial)) d.downwind = bough_scale(1 / size, across);
    return d;
}

// Pitt and Peters: the wake leans, and the half of the disk it leans over is induced more.
// D. M. Pitt, D. A. Peters, Vertica 5 (1981), with the wake angle χ = (1 + 0.6 a) χ₀; faded by
// the loss factor. `share` is the place on the radius, `blade` the radial direction.
static double skewed(const bough_induction *i, const disk *d, bough_vec3 blade, double share) {
    double angle = fmin((1 + 0.6 * i->axial) * d->skew, BOUGH_PI / 2);
    double lean = i->loss * tan(angle / 2) * fmin(share, 1);
    return i->axial * (1 + 15 * BOUGH_PI / 32 * lean * bough_dot(blade, d->downwind));
}

static void induce(const bough_rotor *rotor, const disk *d, const station_model *m,
                   const station_state *state, double tip_radius, bough_station *out) {
    bough_vec3 blade = bough_cross(d->shaft, state->y); // radial, in the rotor plane
    double cone = bough_dot(blade, state->z);
    double radius = fmax(out->radius, 1e-3);
    bough_element element = {.polar = m->polar,
                             .solidity = rotor->n_blade * m->chord / (2 * BOUGH_PI * radius),
                             .tip_factor = m->tip_factor,
                             .hub_factor = m->hub_factor,
                             .cone = cone * cone,
                             .twist = out->twist,
                             .inflow_x = out->inflow_x,
                             .inflow_y = out->inflow_y};
    bough_inflow_station *memory = d->memory ? d->memory + (out - d->first) : NULL;
    bough_induction i = bough_inflow_solve(&rotor->induction, &element, memory);
    out->axial = i.axial;
    out->tangential = i.tangential;
    if (!i.fixed) {
        if (rotor->skew) out->axial = skewed(&i, d, blade, out->radius / tip_radius);
        out->axial *= d->wake;
        out->tangential *= d->wake;
    }
    out->phi = bough_induction_angle(&element, out->axial, out->tangential);
    out->alpha = out->phi - out->twist;
    out->speed = hypot(out->inflow_x * (1 - out->axial), out->inflow_y * (1 + out->tangential));
}

static bough_coefficients coefficients(const bough_rotor *rotor, const disk *d, int station,
                                       const station_state *state, const bough_station *out) {
    const station_model *m = rotor->station + station;
    if (!d->stall) return bough_polar_at(m->polar, out->alpha);
    bough_stall_inflow inflow = {out->speed, out->alpha, state->nose_up};
    return bough_stall_advance(rotor->airfoil + station, m->chord, inflow, d->step,
                               d->stall + (out - d->first));
}

// Force and moment per length of one station on the reference axis.
static void load(const bough_rotor *rotor, const station_model *m, const station_state *state,
                 bough_coefficients k, bough_station *out, bough_vec3 *force, bough_vec3 *moment) {
    double q = 0.5 * rotor->density * out->speed * out->speed * m->chord;
    double c = cos(out->phi), s = sin(out->phi);
    out->coefficients = k;
    out->force_x = q * (k.lift * c + k.drag * s);
    out->force_y = q * (k.lift * s - k.drag * c);
    *force = bough_axpy(-out->force_y, state->y, bough_scale(out->force_x, state->x));
    *moment = bough_cross(state->arm, *force);
    if (rotor->pitching_moment) {
        *moment = bough_axpy(q * m->chord * k.moment, state->z, *moment);
    }
}

static void load_station(const bough_rotor *rotor, const disk *d, int k, bough_rotor_data *data) {
    int n = rotor->n_station, j = k % n;
    const station_state *state = data->scratch->state + k;
    bough_station *out = data->station + k;
    double tip_radius = fmax(data->station[k - j + n - 1].radius, 1e-3);
    induce(rotor, d, rotor->station + j, state, tip_radius, out);
    bough_coefficients c = coefficients(rotor, d, j, state, out);
    load(rotor, rotor->station + j, state, c, out, data->scratch->force + k,
         data->scratch->moment + k);
}

// The line loads of a blade on its vertices.
static void spread(const bough_rotor *rotor, int blade, bough_rotor_data *data) {
    const bough_vec3 *force = data->scratch->force + blade * rotor->n_station;
    const bough_vec3 *moment = data->scratch->moment + blade * rotor->n_station;
    for (int i = 0; i < rotor->n_vertex; i++) {
        vertex_row row = rotor->row[i];
        bough_vec3 f = {0}, m = {0};
        for (int k = 0; k < row.count; k++) {
            f = bough_axpy(row.weight[k], force[row.first + k], f);
            m = bough_axpy(row.weight[k], moment[row.first + k], m);
        }
        data->force[blade * rotor->n_vertex + i] = f;
        data->moment[blade * rotor->n_vertex + i] = m;
    }
}

static void sum_rotor(const bough_rotor *rotor, const bough_rotor_motion *motion,
                      bough_rotor_data *data) {
    data->thrust = data->torque = 0;
    for (int i = 0; i < rotor->n_blade * rotor->n_vertex; i++) {
        bough_vec3 arm = bough_sub(motion->position[i], motion->hub);
        bough_vec3 about_hub = bough_add(bough_cross(arm, data->force[i]), data->moment[i]);
        data->thrust += bough_dot(data->force[i], motion->shaft);
        data->torque += bough_dot(about_hub, motion->shaft);
    }
}

// -- stations, shared out in runs ------------------------------------------------------------------

enum { RUN = 4 }; // stations of a task

typedef struct sample_work {
    const bough_rotor *rotor;
    const bough_rotor_motion *motion;
    const disk *disk;
    bough_rotor_data *data;
} sample_work;

static int run_end(const bough_rotor *rotor, int run) {
    int n = rotor->n_blade * rotor->n_station, end = (run + 1) * RUN;
    return end < n ? end : n;
}

static void move_run(void *self, int run) {
    const sample_work *w = self;
    for (int k = run * RUN; k < run_end(w->rotor, run); k++) {
        move_station(w->rotor, w->motion, k, w->data);
    }
}

static void load_run(void *self, int run) {
    const sample_work *w = self;
    for (int k = run * RUN; k < run_end(w->rotor, run); k++) {
        load_station(w->rotor, w->disk, k, w->data);
    }
}

void bough_rotor_sample(const bough_rotor *rotor, const bough_rotor_motion *motion,
                        bough_rotor_data *data) {
    sample_work w = {rotor, motion, NULL, data};
    int n_run = (rotor->n_blade * rotor->n_station + RUN - 1) / RUN;
    bough_pool_run(data->pool, n_run, move_run, &w);
    disk d = survey_disk(rotor, motion, data);
    if (data->memory.clock) bough_rotor_resume(motion, data);
    d.memory = data->memory.station;
    d.stall = data->memory.stall;
    if (data->memory.clock) d.step = data->memory.clock->step;
    d.first = data->station;
    w.disk = &d;
    bough_pool_run(data->pool, n_run, load_run, &w);
    for (int b = 0; b < rotor->n_blade; b++)
        spread(rotor, b, data);
    sum_rotor(rotor, motion, data);
    if (data->memory.clock) bough_rotor_remember(rotor, motion, data);
}

const bough_inflow_def *bough_rotor_inflow(const bough_rotor *rotor) { return &rotor->inflow; }
bool bough_rotor_has_stall(const bough_rotor *rotor) { return rotor->airfoil != NULL; }

bool bough_rotor_in_wind(const bough_rotor *rotor, bough_vec3 hub, double radius) {
    return bough_wind_covers(&rotor->wind, hub, radius);
}

bough_vec3 bough_rotor_tower_drag(const bough_rotor *rotor, bough_vec3 position, bough_vec3 axis,
                                  bough_vec3 velocity, double t) {
    bough_vec3 inflow = bough_sub(bough_wind_at(&rotor->wind, position, t), velocity);
    return bough_tower_drag(&rotor->tower, rotor->density, position, axis, inflow);
}

bough_vec3 bough_rotor_hub_drag(const bough_rotor *rotor, double area, bough_vec3 position,
                                bough_vec3 velocity, double t) {
    bough_vec3 inflow = bough_sub(bough_wind_at(&rotor->wind, position, t), velocity);
    return bough_scale(0.5 * rotor->density * area * bough_norm(inflow), inflow);
}
