#include "tests/unit/two_mass.h"

static double error_with(bough_integrator_options integrator) {
    bough_two_mass m = bough_two_mass_default();
    bough_master_def def = two_mass_def("monolithic", .1, 10);
    def.scheme.integrator = integrator;
    check_ok(bough_two_mass_build(check_memory(), &m, def));
    double error = two_mass_error(&m);
    bough_coupling_report report = bough_monitor_report(m.master->monitor, m.master->coupling);
    check_near(report.defect_max, 0, 0, 1e-12);
    return error;
}

static double error_at(bough_integrator_kind kind, double rtol) {
    return error_with((bough_integrator_options){.kind = kind, .rtol = rtol});
}

TEST(error_follows_the_tolerance) {
    double coarse = error_at(BOUGH_IDA, 1e-6), fine = error_at(BOUGH_IDA, 1e-10);
    check_near(coarse, 0, 0, 1e-4);
    check_near(fine, 0, 0, 2e-8);
    assert_true(fine < 1e-2 * coarse);
}

TEST(with_every_integrator) {
    for (int kind = BOUGH_IDA; kind <= BOUGH_ROSENBROCK; kind++) {
        if (kind == BOUGH_GENERALIZED_ALPHA) continue; // has no error control
        double coarse = error_at(kind, 1e-5), fine = error_at(kind, 1e-9);
        print_message("%s: %.1e, %.1e\n", bough_integrator_find(kind)->name, coarse, fine);
        check_near(coarse, 0, 0, 1e-3);
        check_near(fine, 0, 0, 1e-6);
    }
}

// Equal steps, members coupled at the stages: the method's order for all bodies together.
TEST(coupled_stages_keep_the_order) {
    static const struct {
        bough_integrator_kind kind;
        int order;
    } method[] = {{BOUGH_ROSENBROCK, 3}, {BOUGH_GENERALIZED_ALPHA, 2}};
    for (int k = 0; k < 2; k++) {
        bough_integrator_options o = {.kind = method[k].kind, .rtol = 1, .step = .01, .rho = .8};
        if (o.kind == BOUGH_GENERALIZED_ALPHA) o.rtol = 1e-12;
        double coarse = error_with(o);
        o.step = .005;
        check_near(log2(coarse / error_with(o)), method[k].order, 0, .2);
    }
}
