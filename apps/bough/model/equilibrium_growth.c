// Growth of motions from an equilibrium, by eigenvalues of the tangents.
#include "apps/bough/model/equilibrium_search.h"
#include "cosim/analysis/modes.h"
#include "flexbody/rod/rod_system.h"

// Points of the real axis near which growing eigenvalues of the Jacobian are searched for, in units of 1 over
// the scene's time. Values below this fraction of a point, or above its inverse, are rounding.
static const double point[] = {1, 10, 100, 1000}, rounded = 1e-3;
enum { POINTS = 4, NEAREST = 12 }; // values nearest to the first point; 4 of each other one

// Growth of an oscillation below this fraction of its eigenvalue is rounding. A growing motion must be found
// again from a second point, `again` times as far, with the same growth to within `equal`.
static const double rounded_oscillation = 1e-5, again = 2.7, equal = 0.01;
static const double beside = 1.3; // the second point of a motion that does not oscillate, over its rate

// Pairs with a larger residual come from rounding in long steps, as (72), and are discarded.
static const double trusted = 1e-4;

static bool oscillates(const bough_eigen_pair *pair) {
    return fabs(pair->imaginary) > rounded * fabs(pair->real);
}

// `at`: by the scene's time.
static bough_status find_near(bough_arena *arena, const bough_equilibrium_search *x, double at,
                              bough_eigen_pair *pair, bough_eigen_count *count) {
    bough_modes_def def = {
        .time = x->time, .state = x->state, .input = x->whole->input, .point = at / x->unit.period};
    return bough_modes_find(arena, x->whole, &def, pair, count);
}

// The oscillation among the pairs that grows fastest; NULL: none. `time`: the scene's [s].
static const bough_eigen_pair *growing_oscillation(const bough_eigen_pair *pair, int n, double time) {
    const bough_eigen_pair *most = NULL;
    for (int k = 0; k < n; k++) {
        double size = hypot(pair[k].real, pair[k].imaginary);
        bool slow = size * time > rounded && size * time < 1 / rounded && oscillates(&pair[k]);
        if (slow && pair[k].residual < trusted && pair[k].real > rounded_oscillation * size &&
            (most == NULL || pair[k].real > most->real))
            most = &pair[k];
    }
    return most;
}

// The state with the largest amplitude relative to its scale.
static int largest_row(bough_arena *arena, const bough_equilibrium_search *x, const bough_eigen_pair *pair) {
    const bough_assembly *a = x->simulation->assembly;
    double largest = 0, *scale = bough_arena_doubles(arena, (size_t)a->n_state);
    int row = 0;
    bough_assembly_scales(a, scale);
    for (int k = 0; k < a->n_state; k++) {
        double size = hypot(pair->shape_real[k], pair->shape_imag[k]) / scale[k];
        if (size > largest) row = k;
        largest = fmax(largest, size);
    }
    return row;
}

// The state with the pair's velocities; of a motion that grows without oscillating they are real.
static double *take_motion(bough_arena *arena, const bough_equilibrium_search *x,
                           const bough_eigen_pair *pair) {
    const bough_simulation *s = x->simulation;
    size_t n = (size_t)s->assembly->n_state, speeds = (size_t)s->tree->n_v * sizeof(double);
    double *motion = bough_arena_copy(arena, x->state, n * sizeof *motion);
    memcpy(motion + s->tree->n_q, pair->shape_real + s->tree->n_q, speeds);
    for (int k = 0; k < s->n_beam; k++) {
        if (!s->beam[k].rod) continue;
        int vertices = s->beam[k].mesh->n;
        size_t first = (size_t)(bough_beam_row(s, &s->beam[k]) + BOUGH_ROD_U * vertices);
        size_t size = (size_t)((BOUGH_ROD_STATES - BOUGH_ROD_U) * vertices) * sizeof *motion;
        memcpy(motion + first, pair->shape_real + first, size);
    }
    return motion;
}

// Twice the kinetic energy of its sections' rotation about the rod's axis.
static double twist_energy(const bough_equilibrium_search *x, const bough_beam *beam, const double *motion) {
    int n = beam->mesh->n;
    const double *w = motion + bough_beam_row(x->simulation, beam) + (size_t)(BOUGH_ROD_W + 2) * (size_t)n;
    double sum = 0;
    for (int i = 0; i < n; i++) sum += beam->mesh->vertex[i + 1].inertia[2] * w[i] * w[i];
    return sum;
}

static double twist_reserve(bough_arena *arena, const bough_equilibrium_search *x, const bough_beam *beam) {
    const bough_simulation *s = x->simulation;
    const double *input = x->whole->input + s->assembly->input_offset[beam->port + 1];
    bough_rod_scratch scratch;
    bough_rod_scratch_init(&scratch, arena, beam->mesh);
    bough_rod_gather(beam->mesh, x->state + bough_beam_row(s, beam), input, &scratch);
    bough_rod_load(beam->mesh, bough_rod_body_loads(beam->rod), x->time, &scratch);
    return bough_rod_twist_reserve(beam->mesh, &scratch);
}

// Whether the growing motion is a twist that the mesh of a rod causes, theory (111); stores the rod if so.
static bool is_twist_of_mesh(bough_arena *arena, bough_equilibrium_search *x, const bough_eigen_pair *pair) {
    static const double most = 0.5; // of the motion's kinetic energy
    const bough_simulation *s = x->simulation;
    double *motion = take_motion(arena, x, pair);
    double whole = bough_equilibrium_search_kinetic(x, motion);
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        if (!beam->rod || !(twist_energy(x, beam, motion) > most * whole)) continue;
        double reserve = twist_reserve(arena, x, beam);
        if (!(reserve < 1)) continue;
        x->growth->twisting = beam->body->name;
        x->growth->segments = (int)ceil(beam->def.n_segment * pow(reserve, -0.25));
        return true;
    }
    return false;
}

// Whether the same growth is found from another point, as growth by rounding is not. If nothing converges
// there, the value is accepted.
static bool is_confirmed(bough_arena *arena, const bough_equilibrium_search *x, double at, int wanted,
                         const bough_eigen_pair *found) {
    bough_eigen_pair pair[NEAREST];
    bough_eigen_count count = {.wanted = wanted};
    bough_status status = find_near(arena, x, at, pair, &count);
    bool confirmed = !bough_is_ok(&status);
    for (int k = 0; k < count.found && !confirmed; k++) {
        double off = hypot(pair[k].real - found->real, fabs(pair[k].imaginary) - fabs(found->imaginary));
        confirmed = oscillates(&pair[k]) == oscillates(found) && off < equal * found->real;
    }
    return confirmed;
}

static bough_status find_growth(bough_arena *arena, void *self) {
    bough_equilibrium_search *x = self;
    bough_equilibrium_search_set_up(arena, x);
    bough_whole_inputs(x->whole, x->time, x->state);
    for (int i = 0; i < x->points; i++) {
        bough_eigen_pair pair[NEAREST];
        bough_eigen_count count = {.wanted = i == 0 ? NEAREST : 4};
        bough_status status = find_near(arena, x, point[i], pair, &count);
        if (!bough_is_ok(&status) && i > 0) continue; // no distinct eigenvalue near this point
        BOUGH_TRY(status);
        for (int k = 0; k < count.found; k++) {
            double part = pair[k].real * x->unit.period / point[i];
            bool known = part > rounded && part < 1 / rounded;
            bool grows = !oscillates(&pair[k]) && known && pair[k].residual < trusted;
            if (!grows || pair[k].real <= x->growth->rate || is_twist_of_mesh(arena, x, &pair[k])) continue;
            if (!is_confirmed(arena, x, beside * pair[k].real * x->unit.period, 4, &pair[k])) continue;
            x->growth->rate = pair[k].real;
            x->growth->row = largest_row(arena, x, &pair[k]);
        }
        const bough_eigen_pair *found = growing_oscillation(pair, count.found, x->unit.period);
        if (i > 0 || found == NULL || bough_equilibrium_search_turns(x)) continue;
        if (!is_confirmed(arena, x, again, NEAREST, found)) continue;
        if (found->real > x->growth->rate) x->growth->row = largest_row(arena, x, found);
        x->growth->oscillation = found->real;
        x->growth->frequency = fabs(found->imaginary) / (2 * BOUGH_PI);
    }
    return bough_ok();
}

bough_status bough_simulation_growth(bough_simulation *s, double time, bool slow, bough_growth *growth) {
    bough_equilibrium_search x = {
        .simulation = s, .time = time, .growth = growth, .points = slow ? 1 : POINTS};
    *growth = (bough_growth){0};
    return bough_arena_use(find_growth, &x);
}
