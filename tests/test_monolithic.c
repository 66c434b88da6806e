#include "tests/two_mass.h"

static double error_at(double rtol) {
    bough_two_mass m = bough_two_mass_default();
    bough_master_def def = bough_master_def_default();
    def.scheme.name = "monolithic";
    def.scheme.rtol = rtol;
    def.macro_step = .1;
    def.duration = 10;
    bough_status status = bough_two_mass_build(&m, def);
    if (!bough_is_ok(&status)) fail_msg("%s", status.message);
    double error = two_mass_error(&m);
    bough_coupling_report report = bough_monitor_report(m.master->monitor, m.master->coupling);
    check_near(report.defect_max, 0, 0, 1e-12);
    bough_two_mass_destroy(&m);
    return error;
}

static void error_follows_the_tolerance(void **state) {
    (void)state;
    double coarse = error_at(1e-6), fine = error_at(1e-10);
    check_near(coarse, 0, 0, 1e-4);
    check_near(fine, 0, 0, 2e-8);
    assert_true(fine < 1e-2 * coarse);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(error_follows_the_tolerance)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
