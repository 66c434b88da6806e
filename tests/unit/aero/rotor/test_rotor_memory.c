// What a rotor keeps from sample to sample: dynamic inflow, dynamic stall, its results.
#include "tests/unit/rotor_rig.h"

// -- dynamic inflow ------------------------------------------------------------------------------

static rig *create_inflow_rig(double time) {
    rig *r = create_flat_rig();
    r->def.inflow = (bough_inflow_def){BOUGH_INFLOW_OYE, time};
    operate(r, 8, 0, 9.156);
    return r;
}

static void sample_at(rig *r, double t) {
    r->motion.time = t;
    sample(r, r->speed * t);
}

// Thrust [kN] after a step of the pitch from 0 to 3.7° at 20 s: AeroDyn v5, slow time constant 5 s,
// discrete in steps of 50 ms.
TEST(pitch_step_matches_reference) {
    static const double table[][2] = {{20, 210.3897},  {20.1, 213.48109}, {21, 233.39587}, {22, 245.80637},
                                      {23, 253.38355}, {24, 258.48886},   {25, 262.17411}, {26, 264.95534},
                                      {28, 268.83479}, {30, 271.32461},   {35, 274.45232}, {40, 275.59214}};
    rig *r = create_inflow_rig(5);
    int row = 0;
    for (int k = 0; k <= 800; k++) {
        double t = 0.05 * k;
        if (t > 20 - 1e-9) r->pitch = 3.7 * degree;
        sample_at(r, t);
        if (t < 19.99) check_near(r->data.thrust, 384.4141e3, 1e-5, 0);
        if (fabs(t - table[row][0]) > 1e-6) continue;
        check_near(r->data.thrust, 1e3 * table[row++][1], 1e-6, 0);
    }
    assert_int_equal(row, 12);
    sample_at(r, 4000);
    sample_at(r, 8000);
    check_near(r->data.thrust, 276.2547e3, 1e-5, 0);
}

static void move_memory(rig *r, bough_snapshot_move move, double *copy) {
    bough_rotor_memory_snapshot(r->rotor, &r->data, &(bough_snapshot){move, (char *)copy, 0});
}

// The memory restored, a step repeats to the bit; a step of any length is stable.
TEST(inflow_is_saved_and_restored) {
    rig *r = create_inflow_rig(0);
    int n = bough_rotor_memory_size(r->rotor);
    assert_int_equal(n, 3 + 6 * BLADES * STATIONS);
    double *memory = calloc((size_t)n, sizeof *memory);
    for (int k = 0; k < 5; k++) sample_at(r, 0.3 * k);
    move_memory(r, BOUGH_SNAPSHOT_SAVE, memory);
    r->pitch = 3 * degree;
    sample_at(r, 2);
    double thrust = r->data.thrust;
    sample_at(r, 500);
    assert_true(isfinite(r->data.thrust) && fabs(r->data.thrust - thrust) > 1e3);
    move_memory(r, BOUGH_SNAPSHOT_RESTORE, memory);
    sample_at(r, 2);
    check_near(r->data.thrust, thrust, 0, 0);
    free(memory);
}

// A sample's results are the same once stored and put back, the blades' distance to the tower included,
// which differs from blade to blade.
TEST(results_are_saved_and_restored) {
    rig *r = create_rig(false);
    operate(r, 8, 0, 9);
    sample(r, BOUGH_PI); // blade 1 in front of the tower
    bough_snapshot snapshot = {.move = BOUGH_SNAPSHOT_MEASURE};
    bough_rotor_result_snapshot(r->rotor, &r->data, &snapshot);
    char *copy = test_malloc(snapshot.used);
    bough_rotor_extremes before[BLADES];
    for (int b = 0; b < BLADES; b++) before[b] = bough_rotor_look(r->rotor, &r->data, b);
    assert_true(before[0].distance < 10 && before[1].distance > 2 * before[0].distance);
    double thrust = r->data.thrust;
    snapshot = (bough_snapshot){BOUGH_SNAPSHOT_SAVE, copy, 0};
    bough_rotor_result_snapshot(r->rotor, &r->data, &snapshot);
    operate(r, 12, 3, 6);
    sample(r, 1);
    assert_true(bough_rotor_look(r->rotor, &r->data, 0).distance != before[0].distance);
    snapshot = (bough_snapshot){BOUGH_SNAPSHOT_RESTORE, copy, 0};
    bough_rotor_result_snapshot(r->rotor, &r->data, &snapshot);
    check_near(r->data.thrust, thrust, 0, 0);
    for (int b = 0; b < BLADES; b++) {
        bough_rotor_extremes after = bough_rotor_look(r->rotor, &r->data, b);
        assert_true(after.distance == before[b].distance && after.speed == before[b].speed);
    }
    test_free(copy);
}

// The time constant by its formula; one long advance equals many short ones.
TEST(inflow_advances_exactly) {
    const bough_inflow_def from_load = {BOUGH_INFLOW_OYE, 0}, fixed = {BOUGH_INFLOW_OYE, 4};
    check_near(bough_inflow_time(&from_load, 0.3, 60, 10), 6.6 / 0.61, 1e-14, 0);
    check_near(bough_inflow_time(&from_load, 0.9, 60, 10), 6.6 / 0.35, 1e-14, 0);
    check_near(bough_inflow_time(&fixed, 0.3, 60, 10), 4, 0, 0);
    bough_inflow_state one, many;
    const double start[2] = {2, -1};
    bough_inflow_start(&one, start);
    bough_inflow_start(&many, start);
    for (int k = 1; k <= 1000; k++) {
        const double sought[2] = {2 + 0.004 * k, -1 + 0.001 * k};
        bough_inflow_advance(&many, sought, 0.01, 5, 0.7);
        if (k == 1000) bough_inflow_advance(&one, sought, 10, 5, 0.7);
    }
    for (int c = 0; c < 2; c++) check_near(one.reached[c], many.reached[c], 1e-11, 0);
    assert_true(one.reached[0] > 3 && one.reached[0] < 6);
}

// -- dynamic stall -------------------------------------------------------------------------------

// Held still the rotor comes to its static loads; on the way, after a step of pitch into stall, it
// carries more than them; the memory restored, the step repeats to the bit.
TEST(stall_is_late_and_repeats) {
    rig *still = create_flat_rig(), *r = create_flat_rig();
    r->def.stall = BOUGH_STALL_HGM;
    r->def.inflow.kind = BOUGH_INFLOW_OYE;
    operate(still, 16, -8, 12.1);
    operate(r, 16, 3, 12.1);
    assert_int_equal(bough_rotor_memory_size(still->rotor), 0);
    int n = bough_rotor_memory_size(r->rotor);
    assert_int_equal(n, 3 + (6 + 9) * BLADES * STATIONS);
    double *memory = calloc((size_t)n, sizeof *memory), most = 0;
    sample(still, 0);
    for (int k = 0; k < 50; k++) sample_at(r, 0.02 * k);
    move_memory(r, BOUGH_SNAPSHOT_SAVE, memory);
    r->pitch = -8 * degree;
    for (int k = 50; k < 60; k++) {
        sample_at(r, 0.02 * k);
        most = fmax(most, r->data.thrust);
    }
    double thrust = r->data.thrust;
    assert_true(most > 1.02 * still->data.thrust);
    move_memory(r, BOUGH_SNAPSHOT_RESTORE, memory);
    for (int k = 50; k < 60; k++) sample_at(r, 0.02 * k);
    check_near(r->data.thrust, thrust, 0, 0);
    // The blade turns in space, cone or not: flat here, so nothing but the static polars is left.
    for (int k = 1; k < 5; k++) sample_at(r, 1e4 * k);
    check_near(r->data.thrust, still->data.thrust, 1e-6, 0);
    check_near(r->data.torque, still->data.torque, 1e-6, 0);
    free(memory);
}

// The rotor's own turn is no pitch rate of a coned blade's sections: in steady wind they carry the static
// polars' loads.
TEST(stall_keeps_the_loads_of_a_coned_rotor) {
    for (int sign = -1; sign <= 1; sign += 2) {
        rig *still = create_flat_rig(), *r = create_flat_rig();
        still->cone = r->cone = sign * 2.5 * degree;
        r->def.stall = BOUGH_STALL_HGM;
        operate(still, 11.4, 0, 12.1);
        operate(r, 11.4, 0, 12.1);
        sample(still, 0);
        for (int k = 0; k < 3; k++) sample_at(r, 1e3 * k);
        check_near(r->data.torque, still->data.torque, 1e-9, 0);
        check_near(r->data.thrust, still->data.thrust, 1e-9, 0);
    }
}
