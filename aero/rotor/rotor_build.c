// Builds a rotor: places the stations in the structural mesh and the line loads on its vertices.
#include "aero/rotor/rotor_model.h"

#include "core/base/base.h"
#include "core/base/rotation.h"

#include <assert.h>

// Loads are piecewise linear between stations, the deformed reference axis piecewise linear
// between vertices. With the vertices' hat functions as weights, force and moment of the line
// load are then conserved exactly, and the weights are constants of the model.

bough_rotor_def bough_rotor_def_default(void) {
    return (bough_rotor_def){.n_blade = 3,
                             .density = 1.225,
                             .pitching_moment = true,
                             .skew = true,
                             .induction = bough_induction_options_default(),
                             .wind = bough_wind_def_default()};
}

// -- build ----------------------------------------------------------------------------------------

// Stations must lie on the blade, to rounding of its length.
static bough_status check_spans(const bough_rotor_def *def) {
    double length = def->vertex_span[def->n_vertex - 1];
    for (int j = 0; j < def->n_station; j++) {
        double span = def->station[j].span;
        assert(j == 0 || span > def->station[j - 1].span);
        if (span >= def->vertex_span[0] - 1e-6 * length && span <= length * (1 + 1e-6)) continue;
        return bough_fail(BOUGH_INVALID, "Aero station %d: span %g m is not on the blade (%g m).", j + 1,
                          span, length);
    }
    return bough_ok();
}

// Section axes in blade-root axes: normal to the axis where it leans flapwise with the slope t.x/t.z of its
// tangent t (prebend), then rotated by the aerodynamic twist, leading edge into the wind. An axis that leans
// edgewise (sweep) leaves them as they are.
static bough_mat3 section_axes(bough_vec3 tangent, double twist) {
    double size = hypot(tangent.x, tangent.z), lean_s = tangent.x / size, lean_c = tangent.z / size;
    double c = cos(twist), s = sin(twist);
    const bough_mat3 lean = {{lean_c, 0, -lean_s}, {0, 1, 0}, {lean_s, 0, lean_c}};
    return bough_mat3_product(lean, (bough_mat3){{c, -s, 0}, {s, c, 0}, {0, 0, 1}});
}

// Station j of the rotor from its row in the table.
static void place_station(const bough_rotor_def *def, const bough_station_def *from, int j,
                          bough_rotor *rotor) {
    // its place between two vertices
    int i = 0;
    while (i < def->n_vertex - 2 && from->span > def->vertex_span[i + 1]) i++;
    double start = def->vertex_span[i], end = def->vertex_span[i + 1];
    double w = bough_clamp((from->span - start) / (end - start), 0, 1);
    bough_mat3 structure = rotation_between(bough_quaternion_of_matrix(def->vertex_rotation[i]),
                                            bough_quaternion_of_matrix(def->vertex_rotation[i + 1]), w);
    // aerodynamic centre and section axes in the interpolated section
    bough_vec3 axis = bough_between(def->vertex_position[i], def->vertex_position[i + 1], w);
    bough_vec3 arm = bough_v3(from->centre_x - axis.x, from->centre_y - axis.y, 0);
    bough_mat3 section =
        bough_mat3_product(bough_mat3_transpose(structure), section_axes(structure.c3, from->twist));
    double radius = def->hub_radius + from->span;
    double tip = def->hub_radius + def->station[def->n_station - 1].span;
    station_rows *to = &rotor->station;
    to->vertex[j] = i;
    to->weight[j] = w;
    lane_store_matrix(to->section, rotor->stride, j, section);
    lane_store(to->centre, rotor->stride, j, bough_mat3_tmul(structure, arm));
    // where the axis lies beside the chord of the two vertices
    bough_vec3 ends = bough_sub(def->vertex_rotation[i + 1].c3, def->vertex_rotation[i].c3);
    lane_store(to->ends, rotor->stride, j, bough_mat3_tmul(structure, ends));
    to->bow[j] = -0.5 * w * (1 - w) * (end - start);
    to->chord[j] = from->chord;
    // Prandtl's losses
    to->tip_factor[j] = def->n_blade * (tip - radius) / (2 * radius);
    to->hub_factor[j] = def->n_blade * from->span / (2 * def->hub_radius);
    bool fixed = bough_induction_is_fixed(&def->induction, to->tip_factor[j], to->hub_factor[j]);
    to->free[j] = fixed ? 0 : 1;
}

static void take_stations(bough_arena *arena, int stride, station_rows *rows) {
    size_t n = (size_t)stride;
    rows->polar = bough_arena_take(arena, n * sizeof *rows->polar);
    rows->vertex = bough_arena_take(arena, n * sizeof *rows->vertex);
    bough_arena_each(arena, n, &rows->weight, &rows->bow, &rows->chord, &rows->tip_factor, &rows->hub_factor,
                     &rows->free);
    rows->section = bough_arena_doubles(arena, 9 * n);
    bough_arena_each(arena, 3 * n, &rows->centre, &rows->ends);
}

// Padding repeats the last station.
static void place_stations(const bough_rotor_def *def, const bough_polar *polar, bough_rotor *rotor) {
    for (int j = 0; j < rotor->stride; j++) {
        int k = j < def->n_station ? j : def->n_station - 1;
        const bough_station_def *from = def->station + k;
        place_station(def, from, j, rotor);
        rotor->station.polar[j] = polar + (from->share > 0 ? def->n_polar + k : from->polar);
    }
}

// Integrals over the hat function N_j of a station's line load, dense by rows of n_station.
typedef struct mappings {
    double *vertex; // to each vertex: ∫ hat_i N_j ds [m] (n_vertex)
    double *mean;   // over each segment: ∫ N_j ds/h (n_vertex − 1)
    double *slope;  // the slope of the line that has the same moments: ∫ N_j σ ds 12/h³ [1/m]
} mappings;

// Adds the integrals over [a, b], where all functions are linear; by Simpson's rule, exact for products.
static void add_interval(const bough_rotor_def *def, double a, double b, int vertex, int station,
                         const mappings *to) {
    const double *x = def->vertex_span;
    double x0 = x[vertex], dx = x[vertex + 1] - x0;
    double y0 = def->station[station].span, dy = def->station[station + 1].span - y0;
    const double point[3] = {a, (a + b) / 2, b}, weight[3] = {1. / 6, 4. / 6, 1. / 6};
    for (int k = 0; k < 3; k++) {
        double hat = bough_clamp((point[k] - x0) / dx, 0, 1), load = (point[k] - y0) / dy;
        double w = weight[k] * (b - a);
        int at = vertex * def->n_station + station;
        double *here = to->vertex + at, *next = here + def->n_station;
        // moments of the load about the segment's middle
        double slope = 12 * (hat - 0.5) / (dx * dx);
        here[0] += w * (1 - hat) * (1 - load);
        here[1] += w * (1 - hat) * load;
        next[0] += w * hat * (1 - load);
        next[1] += w * hat * load;
        to->mean[at] += w / dx * (1 - load);
        to->mean[at + 1] += w / dx * load;
        to->slope[at] += w * slope * (1 - load);
        to->slope[at + 1] += w * slope * load;
    }
}

// All intervals on which hat functions of vertices and of stations are linear.
static void fill_mappings(const bough_rotor_def *def, const mappings *to) {
    int vertex = 0, last = def->n_vertex - 2;
    for (int j = 0; j + 1 < def->n_station; j++) {
        double a = def->station[j].span, end = def->station[j + 1].span;
        while (a < end) {
            // intervals between neighbouring points of both meshes
            while (vertex < last && def->vertex_span[vertex + 1] <= a) vertex++;
            double b = vertex < last ? fmin(end, def->vertex_span[vertex + 1]) : end;
            add_interval(def, a, b, vertex, j, to);
            a = b;
        }
    }
}

// Keeps each dense row from its first to its last nonzero entry.
static void compress_rows(int n, int n_station, const double *dense, vertex_row *row) {
    for (int i = 0; i < n; i++) {
        const double *d = dense + i * n_station;
        int first = 0, end = n_station;
        while (first < end && d[first] == 0) first++;
        while (end > first && d[end - 1] == 0) end--;
        row[i] = (vertex_row){first, end - first, d + first};
    }
}

// The def's polars and, after them, one for each station that has a mixture.
static const bough_polar *build_polars(bough_arena *arena, const bough_rotor_def *def) {
    int most = def->n_polar + def->n_station;
    bough_polar *polar = bough_arena_take(arena, (size_t)most * sizeof *polar);
    for (int i = 0; i < def->n_polar; i++) bough_polar_build(arena, def->polar + i, polar + i);
    for (int j = 0; j < def->n_station; j++) {
        const bough_station_def *s = def->station + j;
        if (s->share == 0) continue;
        bough_polar_blend(arena, polar + s->polar, polar + s->second, s->share, polar + def->n_polar + j);
    }
    // mixtures first: they are exact between linear polars
    for (int i = 0; i < most && def->smooth_polars; i++)
        if (polar[i].n > 0) bough_polar_smoothen(arena, polar + i);
    return polar;
}

bough_status bough_rotor_build(bough_arena *arena, const bough_rotor_def *def, bough_rotor **result) {
    *result = NULL;
    BOUGH_TRY(check_spans(def));
    size_t n_station = (size_t)def->n_station, n_vertex = (size_t)def->n_vertex;
    bough_rotor *rotor = bough_arena_take(arena, sizeof *rotor);
    vertex_row *row = bough_arena_take(arena, (3 * n_vertex - 2) * sizeof *row);
    bough_quaternion *undeformed = bough_arena_take(arena, n_vertex * sizeof *undeformed);
    const mappings map = {bough_arena_doubles(arena, n_vertex * n_station),
                          bough_arena_doubles(arena, (n_vertex - 1) * n_station),
                          bough_arena_doubles(arena, (n_vertex - 1) * n_station)};
    for (size_t i = 0; i < n_vertex; i++) {
        undeformed[i] = bough_quaternion_of_matrix(def->vertex_rotation[i]);
    }
    *rotor = (bough_rotor){.level = bough_level_chosen(),
                           .n_blade = def->n_blade,
                           .n_station = def->n_station,
                           .n_vertex = def->n_vertex,
                           .stride = bough_padded(def->n_station),
                           .density = def->density,
                           .pitching_moment = def->pitching_moment,
                           .skew = def->skew,
                           .slopes = def->slopes,
                           .stalls = def->stall != BOUGH_STALL_NONE,
                           .induction = def->induction,
                           .inflow = def->inflow,
                           .undeformed = undeformed,
                           .row = row,
                           .mean = row + n_vertex,
                           .slope = row + 2 * n_vertex - 1};
    // wind and tower, stations with their polars, mapping to the structural mesh
    take_stations(arena, rotor->stride, &rotor->station);
    BOUGH_TRY(bough_wind_build(arena, &def->wind, &rotor->wind));
    bough_tower_build(arena, &def->tower, &rotor->tower);
    place_stations(def, build_polars(arena, def), rotor);
    fill_mappings(def, &map);
    compress_rows(def->n_vertex, def->n_station, map.vertex, rotor->row);
    compress_rows(def->n_vertex - 1, def->n_station, map.mean, rotor->mean);
    compress_rows(def->n_vertex - 1, def->n_station, map.slope, rotor->slope);
    *result = rotor;
    return bough_ok();
}

// Stations keep their place on the radius of the undeformed rotor, as the loss factors do.
static void take_inflow(bough_arena *arena, const bough_rotor *rotor, bough_rotor_memory *memory) {
    int n = rotor->n_blade * rotor->n_station;
    memory->station = bough_arena_take(arena, (size_t)n * sizeof *memory->station);
    for (int k = 0; k < n; k++) {
        double tip_factor = rotor->station.tip_factor[k % rotor->n_station];
        double fraction = 1 / (1 + 2 * tip_factor / rotor->n_blade); // of B (R − r)/(2 r)
        memory->station[k] = (bough_inflow_station){.fraction = fraction};
    }
}

static void take_memory(bough_arena *arena, const bough_rotor *rotor, bough_rotor_memory *memory) {
    size_t n = (size_t)rotor->n_blade * rotor->n_station;
    bool delayed = rotor->inflow.kind != BOUGH_INFLOW_EQUILIBRIUM;
    if (!delayed && !rotor->stalls) return;
    memory->clock = bough_arena_take(arena, sizeof *memory->clock);
    if (delayed) take_inflow(arena, rotor, memory);
    if (rotor->stalls) memory->stall = bough_arena_take(arena, n * sizeof *memory->stall);
}

static void take_rows(bough_arena *arena, const bough_rotor *rotor, blade_rows *rows) {
    size_t n = (size_t)rotor->stride;
    bough_arena_each(arena, 3 * n, &rows->arm, &rows->x, &rows->y, &rows->z, &rows->velocity, &rows->wind,
                     &rows->normal, &rows->chord);
    bough_arena_each(arena, n, &rows->pitch_rate, &rows->solidity, &rows->cone, &rows->skew_normal,
                     &rows->skew_chord, &rows->loss, &rows->balanced_axial, &rows->balanced_tangential,
                     &rows->lift_slope, &rows->drag_slope, &rows->moment_slope, &rows->lift_rate,
                     &rows->drag_rate, &rows->moment_rate, &rows->static_slope);
    rows->load = bough_arena_doubles(arena, LOAD * n);
    rows->slope = bough_arena_doubles(arena, SLOPE * n);
    bough_arena_each(arena, 3 * (size_t)rotor->n_vertex, &rows->rotation, &rows->bend);
    rows->place = rows->results = bough_arena_doubles(arena, RESULTS * n);
    double **const reported[RESULTS - 3] = {
        &rows->radius,     &rows->twist,  &rows->inflow_x, &rows->inflow_y, &rows->axial,
        &rows->tangential, &rows->phi,    &rows->alpha,    &rows->speed,    &rows->lift,
        &rows->drag,       &rows->moment, &rows->force_x,  &rows->force_y};
    for (int k = 0; k < RESULTS - 3; k++) *reported[k] = rows->results + (size_t)(3 + k) * n;
}

void bough_rotor_data_build(bough_arena *arena, const bough_rotor *rotor, bough_rotor_data *data) {
    size_t n_blade = (size_t)rotor->n_blade;
    *data = (bough_rotor_data){0};
    data->load = bough_arena_doubles(arena, 6 * n_blade * (size_t)rotor->n_vertex);
    size_t slopes = rotor->slopes ? BOUGH_SLOPES : 0;
    data->slope = bough_arena_doubles(arena, slopes * n_blade * (size_t)rotor->n_vertex);
    data->line = bough_arena_doubles(arena, 12 * n_blade * (size_t)(rotor->n_vertex - 1));
    struct bough_rotor_scratch *s = bough_arena_take(arena, sizeof *s);
    data->scratch = s;
    s->blade = bough_arena_take(arena, n_blade * sizeof *s->blade);
    s->wind = bough_arena_take(arena, n_blade * sizeof *s->wind);
    s->velocity = bough_arena_take(arena, n_blade * sizeof *s->velocity);
    bough_arena_each(arena, n_blade, &s->thrust, &s->torque);
    for (int b = 0; b < rotor->n_blade; b++) take_rows(arena, rotor, s->blade + b);
    take_memory(arena, rotor, &data->memory);
}
