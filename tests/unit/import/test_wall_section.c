// Thin-walled sections against formulas: tubes, boxes with one and two cells, a slit tube, laminates.
#include "apps/bough/import/section.h"

#include "tests/unit/check.h"

static const bough_ply steel = {{200e9, 200e9}, 80e9, 0.25, 7800, 0, 0.01};

typedef struct section {
    double k[36], m[36];
} section;

static section solve(int n_node, const double *x, const double *y, int n_wall, const bough_wall *wall) {
    section s;
    bough_arena *arena = bough_arena_create();
    check_ok(bough_wall_section(arena, n_node, x, y, n_wall, wall, s.k, s.m));
    bough_arena_destroy(arena);
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            check_near(s.k[6 * i + j], s.k[6 * j + i], 1e-9, 1e-6 * s.k[14]);
            check_near(s.m[6 * i + j], s.m[6 * j + i], 1e-12, 1e-12);
        }
    }
    return s;
}

enum { ROUND = 256 };

// Walls around a circle, counter-clockwise, so that the plies lie inside; `open` of them left out.
static section tube(double radius, double cx, double cy, int open) {
    double x[ROUND], y[ROUND];
    bough_wall wall[ROUND];
    for (int i = 0; i < ROUND; i++) {
        double a = 2 * BOUGH_PI * i / ROUND;
        x[i] = cx + radius * cos(a);
        y[i] = cy + radius * sin(a);
        wall[i] = (bough_wall){i, (i + 1) % ROUND, 1, &steel, 0};
    }
    return solve(ROUND, x, y, ROUND - open, wall);
}

// Between radii 1 and 0.99: E A, E I, G J; shear stiffness G A/2 of a thin tube.
TEST(tube_has_its_formulas) {
    section s = tube(1, 0, 0, 0);
    double area = BOUGH_PI * (1 - 0.99 * 0.99), second = BOUGH_PI / 4 * (1 - pow(0.99, 4));
    check_near(s.k[14], 200e9 * area, 2e-4, 0);
    check_near(s.k[21], 200e9 * second, 5e-4, 0);
    check_near(s.k[28], 200e9 * second, 5e-4, 0);
    check_near(s.k[35], 2 * 80e9 * second, 1e-3, 0);
    check_near(s.k[0], 80e9 * area / 2, 1e-3, 0);
    check_near(s.k[7], 80e9 * area / 2, 1e-3, 0);
    check_near(s.m[0], 7800 * area, 2e-4, 0);
    check_near(s.m[35], 2 * 7800 * second, 5e-4, 0);
    check_near(s.k[5], 0, 0, 1e-3 * s.k[0]);
}

// A square of four walls, centred on lines of length 1: E I = E t (2 · 1/12 + 2 · 1/4), without the walls'
// own thickness.
TEST(box_of_four_walls_has_its_formulas) {
    static const double x[] = {-0.5, 0.5, 0.5, -0.5}, y[] = {-0.5, -0.5, 0.5, 0.5};
    const bough_ply thin = {{200e9, 200e9}, 80e9, 0.25, 7800, 0, 1e-3};
    bough_wall wall[4];
    for (int i = 0; i < 4; i++) wall[i] = (bough_wall){i, (i + 1) % 4, 1, &thin, 1};
    section s = solve(4, x, y, 4, wall);
    check_near(s.k[14], 4 * 200e9 * 1e-3, 1e-9, 0);
    check_near(s.k[21], 2. / 3 * 200e9 * 1e-3, 1e-9, 0);
    check_near(s.k[28], 2. / 3 * 200e9 * 1e-3, 1e-9, 0);
    check_near(s.m[35], 4. / 3 * 7800 * 1e-3, 1e-9, 0);
}

// Moved by (0.3, −0.2): first moments and Steiner's terms, in shear and twist as well.
TEST(offsets_move_along) {
    section s = tube(1, 0, 0, 0), t = tube(1, 0.3, -0.2, 0);
    check_near(t.k[15], -0.2 * s.k[14], 1e-9, 0);
    check_near(t.k[16], -0.3 * s.k[14], 1e-9, 0);
    check_near(t.k[21], s.k[21] + 0.04 * s.k[14], 1e-9, 0);
    check_near(t.k[22], 0.06 * s.k[14], 1e-9, 0);
    check_near(t.k[5], 0.2 * s.k[0], 1e-6, 0);
    check_near(t.k[11], 0.3 * s.k[7], 1e-6, 0);
    check_near(t.k[35], s.k[35] + 0.04 * s.k[0] + 0.09 * s.k[7], 1e-6, 0);
    check_near(t.m[5], 0.2 * s.m[0], 1e-9, 0);
    check_near(t.m[11], 0.3 * s.m[0], 1e-9, 0);
}

// A slit tube twists freely, and its shear centre lies a diameter from its middle, away from the slit.
TEST(slit_tube_has_its_shear_centre_outside) {
    section s = tube(1, 0, 0, 1);
    // shear centre: the twist rate under a shear force along y at x vanishes
    double det = s.k[0] * s.k[7] - s.k[1] * s.k[1];
    double along = (s.k[11] * s.k[0] - s.k[5] * s.k[1]) / det;
    check_near(along, -2 * 0.995, 0.03, 0);
}

// Two cells of a by b, walls t: Bredt's equations for torsion; the middle web carries no flow by
// symmetry, so G J = 4 A² G t/s of the outside.
TEST(cells_share_the_torsion) {
    enum { N = 60 };
    double x[3 * N], y[3 * N], a = 1, b = 0.5;
    bough_wall wall[4 * N];
    const bough_ply thin = {{200e9, 200e9}, 80e9, 0.25, 7800, 0, 1e-3};
    int n = 0, n_wall = 0;
    // round the outside, 2 a by b, then the web between the middles of the long sides
    for (int i = 0; i < 2 * N; i++) {
        double s = 2 * (2 * a + b) * i / (2 * N);
        x[n] = s < 2 * a ? s : s < 2 * a + b ? 2 * a : s < 4 * a + b ? 4 * a + b - s : 0;
        y[n] = s < 2 * a ? 0 : s < 2 * a + b ? s - 2 * a : s < 4 * a + b ? b : 4 * a + 2 * b - s;
        wall[n_wall++] = (bough_wall){n, (n + 1) % (2 * N), 1, &thin, 1};
        n++;
    }
    section outside = solve(n, x, y, n_wall, wall);
    double perimeter = 4 * a + 2 * b, area = 2 * a * b;
    // about its shear centre: the inverse of the compliance to twist
    double k[9] = {outside.k[0],  outside.k[1], outside.k[5],  outside.k[1], outside.k[7],
                   outside.k[11], outside.k[5], outside.k[11], outside.k[35]};
    double det2 = k[0] * k[4] - k[1] * k[3];
    double own = k[8] - (k[2] * (k[2] * k[4] - k[5] * k[1]) + k[5] * (k[5] * k[0] - k[2] * k[3])) / det2;
    check_near(own, 4 * area * area * 80e9 * 1e-3 / perimeter, 2e-3, 0);
    wall[n_wall++] = (bough_wall){2 * N * 1 / 5, 2 * N * 1 / 5 + 2 * N / 2, 1, &thin, 1}; // x = a
    section both = solve(n, x, y, n_wall, wall);
    double q[9] = {both.k[0],  both.k[1], both.k[5],  both.k[1], both.k[7],
                   both.k[11], both.k[5], both.k[11], both.k[35]};
    det2 = q[0] * q[4] - q[1] * q[3];
    double own2 = q[8] - (q[2] * (q[2] * q[4] - q[5] * q[1]) + q[5] * (q[5] * q[0] - q[2] * q[3])) / det2;
    assert_true(both.k[7] > 1.3 * outside.k[7]); // a third wall along y
    assert_true(own2 >= own * (1 - 1e-6) && own2 < 1.05 * own);
}

// Fibres at ±45 deg shear as a plane laminate does; along them the whole is E1.
TEST(plies_turn) {
    const bough_ply along = {{40e9, 10e9}, 4e9, 0.3, 1900, 0, 5e-3};
    bough_ply turned[2] = {along, along};
    turned[0].angle = BOUGH_PI / 4;
    turned[1].angle = -BOUGH_PI / 4;
    double x[ROUND], y[ROUND];
    bough_wall wall[ROUND];
    double perimeter = 0;
    for (int i = 0; i < ROUND; i++) {
        x[i] = cos(2 * BOUGH_PI * i / ROUND);
        y[i] = sin(2 * BOUGH_PI * i / ROUND);
        wall[i] = (bough_wall){i, (i + 1) % ROUND, 1, &along, 1};
    }
    perimeter = ROUND * 2 * sin(BOUGH_PI / ROUND);
    section s = solve(ROUND, x, y, ROUND, wall);
    check_near(s.k[14], 40e9 * 5e-3 * perimeter, 1e-9, 0);
    check_near(s.k[35], 4e9 * 5e-3 * perimeter, 1e-3, 0);
    for (int i = 0; i < ROUND; i++) {
        wall[i].n_ply = 2;
        wall[i].ply = turned;
    }
    s = solve(ROUND, x, y, ROUND, wall);
    double minor = 0.3 * 10 / 40, d = 1 - 0.3 * minor;
    double q66 = (40e9 + 10e9 - 2 * minor * 40e9) / d / 4;
    check_near(s.k[35], q66 * 10e-3 * perimeter, 1e-3, 0);
    double q11 = ((40e9 + 10e9) / d + 2 * minor * 40e9 / d) / 4 + 4e9;
    double q12 = ((40e9 + 10e9) / d + 2 * minor * 40e9 / d) / 4 - 4e9;
    check_near(s.k[14], (q11 - q12 * q12 / q11) * 10e-3 * perimeter, 1e-9, 0);
}
