// The geometrically exact Cosserat rod, theory (1, 8, 9), divided into segments: constant model and scratch.
//
// Vertex 0 is the root: it is welded to the body reference frame (BRF), whose motion is an
// input. Of a rod that carries bodies at its end, vertex N belongs to them, and its motion is an
// input, too. The vertices 1..n between carry the states, n = N or N − 1. Velocities are ABSOLUTE
// velocities resolved in moving axes, so that inputs are the BRF's twist and gravity only, no
// acceleration:
//     x  position relative to the BRF, in BRF axes [m]              ẋ = u − u₀ − ω×x
//     p  rotation BRF ← section, quaternion      ṗ = ½ (p∘(0,W) − (0,ω)∘p) + κ(1 − |p|²)p
//     u  absolute velocity, in BRF axes [m/s]                       theory (11)
//     W  absolute angular velocity, in section axes [rad/s]         theory (11)
// State arrays are component-major: state[c·N + i], c = x₁₋₃ p₀₋₃ u₁₋₃ W₁₋₃, i = vertex − 1.
#pragma once

#include "core/base/arena.h"
#include "core/base/level.h"
#include "core/base/rotation.h"
#include "core/base/schedule.h"

enum {
    BOUGH_ROD_STATES = 13, // per moving vertex
    BOUGH_ROD_INPUTS = 9,  // BRF velocity, angular velocity, gravity, each in BRF axes
    BOUGH_ROD_OUTPUTS = 6, // root wrench on the carrier: force, moment about the BRF origin
    // After these, of a rod that carries bodies at its end:
    BOUGH_ROD_END_INPUTS = 13, // u, W, x, p of the last vertex
    BOUGH_ROD_END_OUTPUTS = 6, // wrench on what moves it: force in BRF axes, moment in section axes
    BOUGH_ROD_MOST_INPUTS = BOUGH_ROD_INPUTS + BOUGH_ROD_END_INPUTS,
    BOUGH_ROD_MOST_OUTPUTS = BOUGH_ROD_OUTPUTS + BOUGH_ROD_END_OUTPUTS,
};

// κ: restores |p| = 1 at this rate, far from the rod's stiff ones [1/s].
#define BOUGH_ROD_NORM_RATE 1.0

// Offsets of the state's parts, in components.
enum { BOUGH_ROD_X = 0, BOUGH_ROD_P = 3, BOUGH_ROD_U = 7, BOUGH_ROD_W = 10 };

// Mass of a part of a segment, about its left vertex.
typedef struct bough_axial_mass {
    double mass, moment, second; // [kg]; along the chord [kg m, kg m²]
    bough_vec3 offset; // of the mass centre from the chord, times the mass, in the vertex' axes [kg m]
} bough_axial_mass;

// Inertia lumped at a vertex, in section axes about the vertex.
typedef struct bough_vertex_inertia {
    double mass;       // [kg]
    bough_vec3 moment; // first moment mζ [kg m]
    double inertia[6]; // Ixx Iyy Izz Ixy Ixz Iyz, tensor entries [kg m²]
    // parts that the sections do not have, theory (120): inertia across the axis [kg m²], and mass [kg] that
    // balances it, and a neighbour's
    double added_inertia, added_mass;
    bough_axial_mass outer; // the part of it that the segment towards the tip gives
} bough_vertex_inertia;

// The upper triangle of the mass of theory (11) in section axes: [mE, −ξ(s); ξ(s), I].
void bough_vertex_mass(const bough_vertex_inertia *v, double upper[21]);

// A wrench (force, moment) on segment n, from one arc length to another: per length, linear between, or at
// one point, in the axes of the segment's middle.
typedef struct bough_rod_part {
    double from, to;           // [m]
    double start[6], slope[6]; // at `from` [N/m, N or N, N m], and over the length [N/m², N/m]
} bough_rod_part;

// The sections between the vertices: `strain` gives the mean strain (6) of segment n, in the axes of its
// middle, by such a wrench, beyond that by its forces and moments on the vertices by hat functions.
typedef struct bough_rod_model bough_rod_model;
typedef struct bough_rod_def bough_rod_def;
typedef struct bough_rod_sections {
    void (*strain)(const void *axis, const bough_rod_model *m, int n, const bough_rod_part *part,
                   double strain[6]);
    // mass of segment n up to an arc length
    bough_axial_mass (*mass)(const void *axis, const bough_rod_def *def, int n, double to);
    // by how much the section at s rotates beyond the straight line between both ends of a segment [rad], for
    // a unit of force and moment in its middle and of the moment's slope, in the middle's axes (3 × 9);
    // returns the same of the undeformed rod about its axis
    double (*bend)(const void *axis, const double span[2], double s, double bend[27]);
    const void *axis;
} bough_rod_sections;

// What is discretised: filled by bough_section_discretise or by hand.
struct bough_rod_def {
    const char *name;
    int n_segment;                       // N
    const double *span;                  // arc length of the vertices (N + 1) [m]
    const bough_vec3 *position;          // undeformed, in the BRF (N + 1) [m]
    const bough_quaternion *rotation;    // undeformed, section axes in the BRF (N + 1)
    const double *stiffness;             // per segment, symmetric 6×6 upper triangle by rows
                                         // (N × 21) [N, N m, N m²]; order V₁V₂V₃U₁U₂U₃
    const double *damping;               // likewise (N × 21) [N s, N m s, N m² s]
    const bough_vertex_inertia *inertia; // (N + 1)
    const double *line;                  // D per segment, 6×12 in two 6×6 by rows (N × 72): mean
                                         // strain per load along it and per slope of the load
                                         // [1/N, 1/N m …]; NULL: none
    const double *taper;                 // per segment, how the sections' compliance in bending and
                                         // twist changes along it (N × 9) [1/(N m³)]; NULL: not
    bough_rod_sections sections;         // NULL: uniform within each segment
    const double *bow;                   // B per segment, symmetric 4×4, upper triangle by columns (N × 10)
                                         // [1, m, m²]: rod_elastic.h; NULL: 0
    bool carries; // bodies at its end: the last vertex belongs to them as the root to the carrier
};

struct bough_rod_model {
    const char *name;
    bough_level level;            // of the kernels
    int n;                        // moving vertices
    int n_segment;                // N: n, or n + 1 if the rod carries bodies
    int stride;                   // of the arrays over vertices and segments below: padded, more than N + 7
    double *span;                 // (N + 1) [m]
    bough_vec3 *position0;        // undeformed (N + 1) [m]
    bough_quaternion *rotation0;  // undeformed (N + 1)
    bough_mat3 root;              // the first of them as a matrix
    double *length;               // segment length h (stride) [m]
    double *inverse_length;       // 1/h (stride) [1/m]
    double *strain0;              // V⁰, U⁰ (6 × stride)
    double *bend0;                // change of the undeformed tangent over a segment (3 × stride)
    double *stiffness;            // C (21 × stride), by tiles: bough_rod_tile
    double *damping;              // (21 × stride), by tiles
    double *line;                 // D (72 × stride), two 6×6 by rows
    double *gradient;             // L (18 × stride), 3×6 by rows, G (6 × stride), R (stride) and B
                                  // (10 × stride), by tiles: rod_elastic.h
    double *mass;                 // of moving vertices (stride) [kg]
    double *moment;               // first moment s = mζ of moving vertices (3 × stride) [kg m]
    double *inertia;              // of moving vertices (6 × stride) [kg m²]
    double *inverse_mass;         // of the 6×6 mass in section axes (21 × stride), by tiles
    bough_vertex_inertia *vertex; // (N + 1); vertex 0 belongs to the carrier
    bough_rod_sections sections;  // of loads on parts of segments
};

// Row k of segment n is at tile[k · BOUGH_LANES]: eight segments lie side by side, so that a kernel reads the
// rows of a tile at offsets that the compiler knows.
static inline double *bough_rod_tile(double *array, int rows, int n) {
    return array + (size_t)rows * (size_t)(n - n % BOUGH_LANES) + n % BOUGH_LANES;
}

static inline bool bough_rod_carries(const bough_rod_model *m) { return m->n_segment > m->n; }

// R of moving vertex i + 1 in a state, whatever the length of its quaternion.
static inline bough_mat3 bough_rod_rotation(const double *state, int n, int i) {
    const double *p = state + (size_t)BOUGH_ROD_P * (size_t)n + i;
    bough_quaternion q = {p[0], p[n], p[2 * n], p[3 * n]};
    return bough_rotation_matrix(bough_quaternion_normalised(q));
}

// Twice the kinetic energy of the moving vertices in a state (13 n) at velocities u, then W (6 n) [J].
double bough_rod_energy(const bough_rod_model *m, const double *state, const double *velocity);

static inline int bough_rod_n_inputs(const bough_rod_model *m) {
    return bough_rod_carries(m) ? BOUGH_ROD_MOST_INPUTS : BOUGH_ROD_INPUTS;
}

static inline int bough_rod_n_outputs(const bough_rod_model *m) {
    return bough_rod_carries(m) ? BOUGH_ROD_MOST_OUTPUTS : BOUGH_ROD_OUTPUTS;
}

// A load along the rod acts in two ways (docs/theory.md, "Loads along a segment"). It is lumped to the
// vertices by hat functions: these forces are in the balances of the vertices. And it gives each segment
// the strain D q, so that the elastic law, stress = C (e − e⁰ − D q), is that of the loaded segment; q are
// the mean and the slope of the load over the segment, those that bend it as the load does where it is not
// linear. Linear statics is then exact at the vertices. Weight and slow inertia forces need no such strain:
// the mass and first moment of the vertices account for them (section.c).

// Loads that change over time: value × factor. Dead ones are resolved in BRF axes, followers in the section
// axes of each vertex and segment, with which they rotate.
typedef struct bough_rod_ramped_load {
    struct bough_rod_ramped_load *next;
    bough_schedule schedule; // of the factor
    bool follower;
    double *value; // on vertices: force then moment (6 × stride), vertex 0 included [N, N m]
    double *line;  // what of it acts between vertices, as a load linear over each segment, per length: force
                   // then moment, and their slopes (12 × stride) [N/m, N, N/m², N/m]
    bool along;    // there is such a part
} bough_rod_ramped_load;

// Loads on the vertices: value + τ·(rate + τ·curve), τ = t − start, resolved in BRF axes, what the
// vertices' own motion adds to them (`damped`), and all ramped loads.
typedef struct bough_rod_loads {
    double start;  // [s]
    double *value; // force then moment (6 × stride), vertex 0 included [N, N m]
    double *rate;  // (6 × stride) [N/s, N m/s]
    double *curve; // (6 × stride) [N/s², N m/s²]
    bool damped;   // forces along x and y and the moment about z of the BRF (c) change with the vertex'
                   // velocity along x and y, its section's rotation about the normal, and W₃ (j):
    double *slope; // by row 4 c + j (12 × stride) [N s/m, N, N s; N s, N m, N m s]; 0 at vertices whose
                   // motion is an input
    double *angle; // (4 × stride) its product with the vertex' quaternion is the rotation about the normal
    double *rest;  // strains without stress: e⁰ + D q of loads along the segments (6 × stride) …
    double *rest_rate;             // … and its rate [1/s, 1/(m s)], both set by bough_rod_loads_along
    bool moving;                   // the rate is not zero
    bough_rod_ramped_load *ramped; // NULL: none
} bough_rod_loads;

// Work arrays of one evaluation; every array is (· × stride).
typedef struct bough_rod_scratch {
    double *vertex;   // x p u W of vertices 0..N, p normalised (13 × stride)
    double *segment;  // force on the left vertex in BRF axes, moments on the left and the right
                      // vertex in their section axes (9 × stride), zero at N
    double *load;     // loads at the time of evaluation (6 × stride), in BRF axes
    double *follower; // the followers among them in section axes (6 × stride); set if there are any
    // set with the loads:
    double time;        // of the last bough_rod_derivative [s]
    const double *rest; // strains without stress (6 × stride); before any loads e⁰
    bool turning;       // `rest` contains ramped loads along the segments; the part by dead ones rotates
    double *along;      // these dead ones in the axes of the segments' middles (12 × stride)
    double *following;  // forces of the followers per length, in section axes (3 × stride)
    double *own_rest;   // (6 × stride) memory for `rest`
} bough_rod_scratch;

// Builds the constant model. BOUGH_INVALID names the segment or vertex that is not usable.
bough_status bough_rod_create(bough_arena *arena, const bough_rod_def *def, bough_rod_model **model);

// An array over the vertices (rows × stride) in which those of vertex 1 begin vector registers: loops
// over moving vertices load and store aligned ones.
double *bough_rod_vertex_rows(bough_arena *arena, const bough_rod_model *model, int rows);

void bough_rod_scratch_init(bough_rod_scratch *scratch, bough_arena *arena, const bough_rod_model *model);
void bough_rod_loads_init(bough_rod_loads *loads, bough_arena *arena, const bough_rod_model *model);

// A new load of zeros.
bough_rod_ramped_load *bough_rod_loads_add(bough_rod_loads *loads, bough_arena *arena,
                                           const bough_rod_model *model, bool follower,
                                           const bough_schedule *schedule);

// The ramped load of this kind and ramp, a new one if there is none yet or the schedule is a table.
bough_rod_ramped_load *bough_rod_loads_ramped(bough_rod_loads *loads, bough_arena *arena,
                                              const bough_rod_model *model, bool follower,
                                              const bough_schedule *schedule);

// Sets the strains for loads along the segments, given per length (12 × n_segment: force and moment
// [N/m, N], then their slopes) in the axes of a segment's middle (bough_rod_take_line), and at which rate
// they change; their vertex loads and loads->start are the caller's. They should be continuous from one call
// to the next: a jump is a jump of stress, which every integrator then resolves.
void bough_rod_loads_along(const bough_rod_model *m, const double *line, const double *rate,
                           bough_rod_loads *loads);

// D q of such loads, to along (6 × stride).
void bough_rod_line_strain(const bough_rod_model *m, const double *line, double *along);

bool bough_rod_loads_follow(const bough_rod_loads *loads); // whether any load is a follower

// The undeformed rod moving rigidly with its BRF: state (13 n), input (the first 9).
void bough_rod_rest_state(const bough_rod_model *m, const double *input, double *state);

// Copies state and input into scratch->vertex; quaternions are normalised on the way.
void bough_rod_gather(const bough_rod_model *m, const double *state, const double *input,
                      bough_rod_scratch *scratch);

// Elastic and viscous forces of segments first..last−1 from scratch->vertex into
// scratch->segment. False when a segment's relative rotation exceeds 120° (mesh too coarse).
bool bough_rod_forces(const bough_rod_model *m, int first, int last, bough_rod_scratch *scratch);

// theory (11, 16): rate (13 n). False when a value is not finite or a segment over-rotates.
bool bough_rod_derivative(const bough_rod_model *m, const bough_rod_loads *loads, double t,
                          const double *state, const double *input, bough_rod_scratch *scratch, double *rate);

// The same at another time and input, for ∂f/∂t; `state` is that of the last bough_rod_derivative with this
// scratch. Only segments that touch the input, or have ramped loads, are evaluated again. In the others the
// forces change as loads along them change those of an unbent segment: a relative error of the order of the
// segment's own rotation.
bool bough_rod_derivative_again(const bough_rod_model *m, const bough_rod_loads *loads, double t,
                                const double *state, const double *input, bough_rod_scratch *scratch,
                                double *rate);

// The outputs: the wrench on the carrier (6), and of a rod that carries bodies that on them, without inertia
// and weight of the last vertex (6): force in BRF axes, moment in section axes.
void bough_rod_wrenches(const bough_rod_model *m, const bough_rod_loads *loads, double t, const double *state,
                        const double *input, bough_rod_scratch *scratch, double *wrench);

// The same where scratch has the forces and loads of a derivative.
void bough_rod_present_wrenches(const bough_rod_model *m, const bough_rod_scratch *scratch, double *wrench);

// Loads at time t into scratch, after a gathering.
void bough_rod_load(const bough_rod_model *m, const bough_rod_loads *loads, double t,
                    bough_rod_scratch *scratch);

// Torsional stiffness over the one below which a segment that is bent and under tension twists although the
// rod does not, theory (111): the smallest of all segments, for scratch->vertex under the last loads of
// scratch.
double bough_rod_twist_reserve(const bough_rod_model *m, const bough_rod_scratch *scratch);

// Kernels, each called at its model's level.
BOUGH_DECLARE_LEVELS(bough_rod_gather);
BOUGH_DECLARE_LEVELS(bough_rod_forces);
BOUGH_DECLARE_LEVELS(bough_rod_load);
BOUGH_DECLARE_LEVELS(bough_rod_derivative);
BOUGH_DECLARE_LEVELS(bough_rod_derivative_again);
BOUGH_DECLARE_LEVELS(bough_rod_wrenches);
BOUGH_DECLARE_LEVELS(bough_rod_line_strain);
#define bough_rod_gather(m, ...) BOUGH_OF_LEVEL(bough_rod_gather, (m)->level)(m, __VA_ARGS__)
#define bough_rod_forces(m, ...) BOUGH_OF_LEVEL(bough_rod_forces, (m)->level)(m, __VA_ARGS__)
#define bough_rod_load(m, ...) BOUGH_OF_LEVEL(bough_rod_load, (m)->level)(m, __VA_ARGS__)
#define bough_rod_derivative(m, ...) BOUGH_OF_LEVEL(bough_rod_derivative, (m)->level)(m, __VA_ARGS__)
#define bough_rod_derivative_again(m, ...)                                                                   \
    BOUGH_OF_LEVEL(bough_rod_derivative_again, (m)->level)(m, __VA_ARGS__)
#define bough_rod_wrenches(m, ...) BOUGH_OF_LEVEL(bough_rod_wrenches, (m)->level)(m, __VA_ARGS__)
#define bough_rod_line_strain(m, ...) BOUGH_OF_LEVEL(bough_rod_line_strain, (m)->level)(m, __VA_ARGS__)
