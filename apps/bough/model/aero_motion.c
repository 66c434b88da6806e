#include "apps/bough/model/aero_link.h"

enum { CALLS = 3 }; // stored: the motion is extrapolated by a parabola

// A blade's state: its rows, velocity and angular velocity of its frame, hub and shaft in the frame (of
// the first blade only).
enum { FRAME = 12, TWIST = 0, HUB = 6, SHAFT = 9 };

struct bough_aero_motion {
    bough_simulation *simulation;
    const bough_beam *const *beam; // (n_blade)
    int n_blade, n_vertex, n_state;
    double *state[CALLS]; // of the blades (n_blade × n_state) at the last calls, the latest first
    int known;            // number of stored calls
    double time;          // of the latest [s]
    double ahead;         // [s]
    bough_rotor_motion found;
    bough_blade_motion *moving; // (n_blade) in `found`
    double *expected;           // (n_blade × n_state) the rows of `moving`
};

bough_aero_motion *bough_aero_motion_build(bough_arena *arena, bough_simulation *simulation,
                                           const bough_beam *const *beam) {
    bough_aero_motion *m = bough_arena_take(arena, sizeof *m);
    m->simulation = simulation;
    m->beam = beam;
    m->n_blade = simulation->scene->turbine.n_blade;
    m->n_vertex = beam[0]->def.n_segment + 1;
    m->n_state = BOUGH_BLADE_ROWS * m->n_vertex + FRAME;
    size_t n = (size_t)m->n_blade * (size_t)m->n_state;
    m->moving = bough_arena_take(arena, (size_t)m->n_blade * sizeof *m->moving);
    m->expected = bough_arena_doubles(arena, n);
    for (int i = 0; i < CALLS; i++) m->state[i] = bough_arena_doubles(arena, n);
    m->found.blade = m->moving;
    for (int b = 0; b < m->n_blade; b++) m->moving[b].vertex = m->expected + b * m->n_state;
    return m;
}

void bough_aero_motion_forget(bough_aero_motion *m) { m->known = 0; }

const bough_rotor_motion *bough_aero_motion_found(const bough_aero_motion *m) { return &m->found; }

bough_aero_course bough_aero_motion_course(const bough_aero_motion *m, int b) {
    int at = b * m->n_state;
    return (bough_aero_course){m->state[m->known > 1] + at, m->state[0] + at, m->expected + at};
}

// -- as it is -------------------------------------------------------------------------------------

void bough_aero_motion_rotor(bough_aero_motion *m, double t) {
    bough_simulation *s = m->simulation;
    int rotor = s->scene->turbine.rotor;
    bough_simulation_update(s);
    m->found.time = t;
    m->found.hub = bough_body_pose(s, rotor).position;
    m->found.hub_velocity = bough_tree_frame_velocity(s->view, &s->tree->bodies[rotor]).linear;
    m->found.shaft = bough_simulation_joint_axis(s, rotor);
}

void bough_aero_motion_blade(bough_aero_motion *m, int b) {
    m->moving[b].frame = bough_beam_pose(m->simulation, m->beam[b]);
    bough_simulation_beam_rows(m->simulation, m->beam[b], m->expected + b * m->n_state);
}

// -- as expected ----------------------------------------------------------------------------------

static bough_vec3 load(const double *from) { return bough_v3(from[0], from[1], from[2]); }

// A quaternion and its negative are the same rotation: chooses the one nearer to `like`.
static void same_sign(int n, const double *like, double *p) {
    for (int i = 0; i < n; i++) {
        double dot = 0;
        for (int c = 0; c < 4; c++) dot += like[c * n + i] * p[c * n + i];
        for (int c = 0; c < 4 && dot < 0; c++) p[c * n + i] = -p[c * n + i];
    }
}

// Stores the present state of a blade.
static void enter(bough_aero_motion *m, int b) {
    const bough_simulation *s = m->simulation;
    size_t at = (size_t)b * (size_t)m->n_state, bytes = (size_t)m->n_state * sizeof(double);
    int rotation = BOUGH_BLADE_ROTATION * m->n_vertex;
    double *now = m->state[0] + at, *frame = now + BOUGH_BLADE_ROWS * m->n_vertex;
    for (int i = CALLS - 1; i > 0; i--) memcpy(m->state[i] + at, m->state[i - 1] + at, bytes);
    bough_simulation_beam_rows(s, m->beam[b], now);
    if (m->known > 1) same_sign(m->n_vertex, m->state[1] + at + rotation, now + rotation);
    bough_twist_store(bough_beam_twist(s, m->beam[b]), frame + TWIST);
    if (b > 0) return;
    bough_transform pose = bough_beam_pose(s, m->beam[b]);
    bough_v3_store(bough_mat3_tmul(pose.rotation, bough_sub(m->found.hub, pose.position)), frame + HUB);
    bough_v3_store(bough_mat3_tmul(pose.rotation, m->found.shaft), frame + SHAFT);
}

// Weights of the last calls, by their number: for the extrapolation to the next call, and for the mean up to
// it.
static const double to_next[CALLS][3] = {{1, 0, 0}, {2, -1, 0}, {3, -3, 1}};
static const double mean[CALLS][3] = {{1, 0, 0}, {1.5, -0.5, 0}, {23. / 12, -16. / 12, 5. / 12}};

static void expect(bough_aero_motion *m, int b) {
    size_t at = (size_t)b * (size_t)m->n_state;
    const double *restrict x = m->state[0] + at, *restrict y = m->state[1] + at;
    const double *restrict z = m->state[2] + at, *w = to_next[m->known - 1];
    double *restrict next = m->expected + at, w0 = w[0], w1 = w[1], w2 = w[2];
    for (int k = 0; k < m->n_state; k++) next[k] = w0 * x[k] + w1 * y[k] + w2 * z[k];
    // the frame moves by the mean of its velocity
    int frame = BOUGH_BLADE_ROWS * m->n_vertex + TWIST;
    double way[6];
    w = mean[m->known - 1];
    for (int c = 0; c < 6; c++) {
        int k = frame + c;
        way[c] = m->ahead * (w[0] * x[k] + w[1] * y[k] + w[2] * z[k]);
    }
    bough_vec3 turn = load(way + 3), half = bough_scale(0.5, turn);
    bough_mat3 middle = bough_rotation_matrix(bough_quaternion_exponential(half));
    bough_transform now = bough_beam_pose(m->simulation, m->beam[b]);
    bough_transform step = {bough_mat3_mul(middle, load(way)),
                            bough_rotation_matrix(bough_quaternion_exponential(turn))};
    m->moving[b].frame = bough_transform_compose(now, step);
}

void bough_aero_motion_expect_rotor(bough_aero_motion *m, double t, double ahead) {
    bool goes_on = m->known > 0 && fabs(t - m->time - m->ahead) <= 1e-6 * ahead &&
                   fabs(m->ahead - ahead) <= 1e-6 * ahead;
    m->known = !goes_on ? 1 : m->known < CALLS ? m->known + 1 : CALLS;
    m->time = t;
    m->ahead = ahead;
    bough_aero_motion_rotor(m, t);
    enter(m, 0);
    expect(m, 0);
    const double *frame = m->expected + BOUGH_BLADE_ROWS * m->n_vertex;
    bough_transform pose = m->moving[0].frame;
    bough_vec3 shaft = bough_mat3_mul(pose.rotation, load(frame + SHAFT));
    bough_vec3 turning = bough_cross(load(frame + TWIST + 3), load(frame + HUB));
    m->found.hub_velocity = bough_mat3_mul(pose.rotation, bough_add(load(frame + TWIST), turning));
    m->found.hub = bough_add(pose.position, bough_mat3_mul(pose.rotation, load(frame + HUB)));
    m->found.shaft = bough_scale(1 / bough_norm(shaft), shaft);
    m->found.time = t + ahead;
}

void bough_aero_motion_expect_blade(bough_aero_motion *m, int b) {
    if (b > 0) {
        enter(m, b);
        expect(m, b);
    }
}

// -- saving ---------------------------------------------------------------------------------------

void bough_aero_motion_snapshot(bough_aero_motion *m, bough_snapshot *s) {
    BOUGH_SNAPSHOT(s, m->known, m->time, m->ahead);
    for (int i = 0; i < CALLS; i++) bough_snapshot_doubles(s, m->state[i], m->n_blade * m->n_state);
}
