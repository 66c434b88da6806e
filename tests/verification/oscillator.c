#include "tests/verification/oscillator.h"

static bool derivative(void *self, double t, const double *y, const double *u, double *rate) {
    const bough_oscillator *o = self;
    (void)t;
    for (int i = 0; i < o->n_state; i++) {
        rate[i] = o->a[i][0] * y[0] + o->a[i][1] * y[1];
        for (int j = 0; j < o->n_input; j++) rate[i] += o->b[i][j] * u[j];
    }
    return o->n_state == 0 || (isfinite(rate[0]) && isfinite(rate[1]));
}

static void output_tangent(void *self, double t, const double *y, const double *u, const double *dy,
                           const double *du, double *out) {
    const bough_oscillator *o = self;
    (void)t, (void)y, (void)u;
    for (int i = 0; i < o->n_output; i++) {
        out[i] = dy && o->n_state > 0 ? o->c[i][0] * dy[0] + o->c[i][1] * dy[1] : 0;
        for (int j = 0; du && j < o->n_input; j++) out[i] += o->d[i][j] * du[j];
    }
}

static void output(void *self, double t, const double *y, const double *u, double *out) {
    output_tangent(self, t, y, u, y, u, out);
}

static void input_columns(void *self, double t, const double *y, const double *u, double *column) {
    const bough_oscillator *o = self;
    (void)t, (void)y, (void)u;
    for (int j = 0; j < o->n_input && o->n_state > 0; j++) {
        column[2 * j] = o->b[0][j];
        column[2 * j + 1] = o->b[1][j];
    }
}

// (I − γA)⁻¹
typedef struct inverse {
    double of[2][2];
} inverse;

static void *factors(void *self, bough_arena *arena) {
    (void)self;
    return bough_arena_take(arena, sizeof(inverse));
}

static bool linearise(void *self, double t, const double *y, const double *u, void *factors) {
    (void)self, (void)t, (void)y, (void)u, (void)factors;
    return true;
}

static bool factor(void *self, void *factors, double gamma) {
    const bough_oscillator *o = self;
    inverse *k = factors;
    double m00 = 1 - gamma * o->a[0][0], m01 = -gamma * o->a[0][1];
    double m10 = -gamma * o->a[1][0], m11 = 1 - gamma * o->a[1][1];
    double determinant = m00 * m11 - m01 * m10;
    k->of[0][0] = m11 / determinant;
    k->of[0][1] = -m01 / determinant;
    k->of[1][0] = -m10 / determinant;
    k->of[1][1] = m00 / determinant;
    return determinant != 0;
}

static void solve(void *self, void *factors, double *x) {
    const bough_oscillator *o = self;
    const inverse *k = factors;
    if (o->n_state == 0) return;
    double x0 = x[0];
    x[0] = k->of[0][0] * x0 + k->of[0][1] * x[1];
    x[1] = k->of[1][0] * x0 + k->of[1][1] * x[1];
}

// Taylor coefficients of the input about t, in (time)ᵏ.
static void input_series(const bough_signal *s, double t, double (*series)[4]) {
    double length = s->t1 - s->t0, tau = (t - s->t0) / length;
    for (int j = 0; j < s->n; j++) {
        const double *c = s->coefficient + j;
        double c1 = c[s->n], c2 = c[2 * s->n], c3 = c[3 * s->n];
        series[j][0] = c[0] + tau * (c1 + tau * (c2 + tau * c3));
        series[j][1] = (c1 + tau * (2 * c2 + 3 * tau * c3)) / length;
        series[j][2] = (c2 + 3 * tau * c3) / (length * length);
        series[j][3] = c3 / (length * length * length);
    }
}

static void step(const bough_oscillator *o, double t, double h, double *y) {
    double series[BOUGH_OSCILLATOR_PORT][4], term[2] = {y[0], y[1]}, power = 1;
    input_series(o->member->signal, t, series);
    for (int k = 0; k < 24; k++) {
        double next[2];
        for (int i = 0; i < 2; i++) {
            next[i] = o->a[i][0] * term[0] + o->a[i][1] * term[1];
            for (int j = 0; k < 4 && j < o->n_input; j++) next[i] += o->b[i][j] * series[j][k];
        }
        power *= h;
        for (int i = 0; i < 2; i++) {
            term[i] = next[i] / (k + 1);
            y[i] += power * term[i];
        }
    }
}

static bough_status advance(void *self, double *t, double t1, bool restart, double *y) {
    bough_oscillator *o = self;
    double rate = sqrt(fabs(o->a[1][0])) + fabs(o->a[1][1]) + 1, t0 = *t;
    int n = (int)ceil((t1 - t0) * rate);
    for (int k = 0; k < n; k++) {
        step(o, t0 + (t1 - t0) * k / n, (t1 - t0) / n, y);
    }
    *t = t1;
    o->advances++;
    o->starts += restart;
    return bough_ok();
}

static void statistics(const void *self, bough_statistics *sum) {
    const bough_oscillator *o = self;
    sum->steps += o->advances;
    sum->starts += o->starts;
}

// Its states are all that a step depends on.
static void transfer(void *self, bough_snapshot *s) { (void)self, (void)s; }

static const bough_integrator_ops taylor = {
    .title = "Taylor series", .advance = advance, .statistics = statistics, .transfer = transfer};

static const bough_system_ops operations = {BOUGH_SYSTEM_REQUIRED};

bough_system bough_oscillator_system(bough_oscillator *o, const char *name) {
    o->scale[0] = o->scale[1] = 1;
    return (bough_system){.name = name,
                          .kind = "oscillator",
                          .n_state = o->n_state,
                          .n_input = o->n_input,
                          .n_output = o->n_output,
                          .scale = o->scale,
                          .initial = o->y,
                          .ops = &operations,
                          .self = o};
}

void bough_oscillator_member(bough_oscillator *o, const char *name, bough_member *member) {
    o->member = member;
    *member = (bough_member){.system = bough_oscillator_system(o, name),
                             .solver = taylor.title,
                             .state = o->y,
                             .integrated = o->integrated,
                             .integrator = {.ops = &taylor, .self = o}};
}

// -- kinds ----------------------------------------------------------------------------------------

bough_oscillator bough_oscillator_force_in(bough_spring_mass s, double sign, double x) {
    return (bough_oscillator){.a = {{0, 1}, {-s.k / s.m, -s.c / s.m}},
                              .b = {{0}, {sign / s.m}},
                              .c = {{0, 1}, {1, 0}},
                              .n_state = 2,
                              .n_input = 1,
                              .n_output = 2,
                              .y = {x, 0}};
}

bough_oscillator bough_oscillator_motion_in(bough_spring_mass s, double k, double c, double x) {
    return (bough_oscillator){.a = {{0, 1}, {-(s.k + k) / s.m, -(s.c + c) / s.m}},
                              .b = {{0}, {c / s.m, k / s.m}},
                              .c = {{k, c}},
                              .d = {{-c, -k}},
                              .n_state = 2,
                              .n_input = 2,
                              .n_output = 1,
                              .y = {x, 0}};
}

bough_oscillator bough_oscillator_motion_in_and_out(bough_spring_mass s, double k, double c, double x) {
    bough_oscillator o = bough_oscillator_motion_in(s, k, c, x), out = bough_oscillator_force_in(s, 1, x);
    memcpy(o.c, out.c, sizeof o.c);
    memcpy(o.d, out.d, sizeof o.d);
    o.n_output = out.n_output;
    return o;
}

bough_oscillator bough_oscillator_link(double k, double c) {
    return (bough_oscillator){.d = {{-c, -k, c, k}}, .n_input = 4, .n_output = 1};
}
