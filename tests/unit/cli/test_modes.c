#include "cosim/analysis/modes.h"
#include "tests/unit/two_mass.h"

#include <complex.h>

enum { N = 4 };

typedef struct setup {
    bough_two_mass m;
    bough_whole *whole;
    bough_modes_def def;
    bough_eigen_pair pair[N];
    bough_eigen_count count;
} setup;

static void build(setup *s, bough_two_mass masses) {
    s->m = masses;
    bough_master_def def = bough_master_def_default();
    def.macro_step = def.duration = .1;
    check_ok(bough_two_mass_build(check_memory(), &s->m, def));
    s->whole = bough_whole_create(s->m.arena, s->m.master->assembly, NULL);
    bough_whole_inputs(s->whole, 0, s->m.y0);
    s->def = (bough_modes_def){.state = s->m.y0, .input = s->whole->input, .point = 1};
}

// det(λ² M + λ C + K) = 0, and the shape's ratio is that of the first row.
TEST(coupled_masses_have_their_eigenvalues) {
    setup s;
    build(&s, bough_two_mass_default());
    s.count.wanted = 2;
    check_ok(bough_modes_find(s.m.arena, s.whole, &s.def, s.pair, &s.count));
    assert_int_equal(s.count.found, 2);
    for (int k = 0; k < 2; k++) {
        const bough_eigen_pair *p = &s.pair[k];
        double complex l = p->real + p->imaginary * (double complex)I, link = .5 * l + 10;
        double complex first = l * l + .7 * l + 20, second = l * l + .8 * l + 30;
        assert_true(cabs(first * second - link * link) < 1e-6);
        double complex x1 = p->shape_real[0] + p->shape_imag[0] * (double complex)I;
        double complex x2 = p->shape_real[2] + p->shape_imag[2] * (double complex)I;
        assert_true(cabs(first * x1 - link * x2) < 1e-6 * cabs(link * x2));
        assert_true(p->real < 0 && p->imaginary > 0);
    }
}

// A pattern exp(i 2πhk/n) has that harmonic only.
TEST(harmonics_are_distinguished) {
    enum { PARTS = 5 };
    for (int h = -2; h <= 2; h++) {
        double real[PARTS], imaginary[PARTS], share[2];
        for (int k = 0; k < PARTS; k++) {
            real[k] = cos(2 * BOUGH_PI * h * k / PARTS);
            imaginary[k] = sin(2 * BOUGH_PI * h * k / PARTS);
        }
        for (int other = -2; other <= 2; other++) {
            bough_modes_harmonic(PARTS, other, real, imaginary, share);
            check_near(share[0], other == h, 0, 1e-15);
            check_near(share[1], 0, 0, 1e-15);
        }
    }
}
