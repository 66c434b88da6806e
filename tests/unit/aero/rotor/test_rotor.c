// Loads of a rotor without memory: other programs' figures, conservation, symmetry.
#include "tests/unit/rotor_rig.h"

// Thrust [kN] and torque [kN m] of the flat rotor: AeroDyn v5, and to six digits an independent
// solution of the same equations.
TEST(flat_rotor_matches_reference) {
    static const double table[][5] = {
        {3, 0, 6.972, 77.370925, 54.299714},       {4, 0, 7.183, 120.905807, 246.723471},
        {8, 0, 9.156, 384.414061, 1976.531272},    {10, 0, 11.431, 600.183949, 3091.937526},
        {11, 0, 11.89, 700.397181, 3932.783839},   {12, 3.823, 12.1, 589.108228, 4199.850531},
        {18, 14.92, 12.1, 337.306733, 4163.84765}, {25, 23.469, 12.1, 244.203811, 3637.726746}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        rig *r = create_flat_rig();
        operate(r, table[i][0], table[i][1], table[i][2]);
        sample(r, 0.4);
        check_near(r->data.thrust, 1e3 * table[i][3], 1e-5, 0);
        check_near(r->data.torque, 1e3 * table[i][4], 1e-5, 0);
    }
}

// Switching the corrections off one by one at 8 m/s, and heavy loading at 15 rpm.
TEST(switches_match_reference) {
    static const double table[5][2] = {{397.593, 2146.476},
                                       {384.535, 1976.489},
                                       {382.420, 1995.611},
                                       {384.880, 1978.841},
                                       {493.990, 889.607}};
    for (int i = 0; i < 5; i++) {
        rig *r = create_flat_rig();
        bough_induction_options *o = &r->def.induction;
        o->tip_loss = i != 0;
        o->hub_loss = i != 1;
        o->tangential = i != 2;
        o->axial_drag = i != 3;
        operate(r, 8, 0, i == 4 ? 15 : 9.156);
        sample(r, 0);
        check_near(r->data.thrust, 1e3 * table[i][0], 1e-4, 0);
        check_near(r->data.torque, 1e3 * table[i][1], 1e-4, 0);
    }
}

// Every station at 8 m/s: inflow x, y, relative speed, φ, α, a, a', Cl, Cd, force x, y. AeroDyn v5.
TEST(stations_match_reference) {
    // clang-format off
    static const double table[STATIONS][11] = {
        {8, 1.4382211, 1.4382211, 0, -13.308, 1, 0, 0, 0.5, 0, -2.2437578},
        {8, 2.7486323, 7.747101, 71.038353, 57.730353, 0.084160682, -0.084160682, 0, 0.5, 61.570565, -21.154356},
        {8, 5.3693588, 9.1786945, 56.131679, 42.823679, 0.04734269, -0.04734269, 0, 0.5, 82.564891, -55.415066},
        {8, 7.9900854, 10.982422, 45.035526, 31.727526, 0.028680187, -0.028680187, 0, 0.35, 76.233874, -76.139395},
        {8, 11.266065, 13.485452, 26.509642, 13.201642, 0.24759872, 0.071144324, 1.5230821, 0.11931222, 718.85357, 290.88041},
        {8, 15.197203, 16.997202, 20.059785, 8.5797845, 0.27124398, 0.05059269, 1.3259785, 0.012711698, 1028.9052, 364.5672},
        {8, 19.128341, 20.607258, 16.925217, 6.7632172, 0.25009342, 0.03065217, 1.1041654, 0.011405287, 1228.7198, 360.08074},
        {8, 23.059479, 24.302002, 14.337997, 5.3269966, 0.24772673, 0.021056774, 0.98585556, 0.0098307986, 1471.8145, 360.60464},
        {8, 26.990616, 28.045367, 11.955757, 4.1607573, 0.27377812, 0.016538583, 0.97161239, 0.0073964544, 1837.8742, 374.57445},
        {8, 30.921754, 31.840209, 10.400601, 3.8566007, 0.28148804, 0.012784108, 0.93421849, 0.0072426403, 2141.5518, 375.93395},
        {8, 34.852892, 35.652472, 8.8799601, 3.5189601, 0.31206405, 0.01068052, 0.94982017, 0.0066189601, 2561.4069, 381.92245},
        {8, 38.784029, 39.490504, 7.7648981, 3.5768981, 0.3330618, 0.008879377, 0.95538222, 0.0066768981, 2946.9052, 380.87861},
        {8, 42.715167, 43.368425, 7.2577693, 4.1327693, 0.31513947, 0.0071586517, 0.91300293, 0.0054531077, 3142.886, 381.19716},
        {8, 46.646305, 47.238574, 6.546013, 4.227013, 0.32684387, 0.0060948611, 0.92365247, 0.0054908052, 3468.9803, 377.18344},
        {8, 50.577443, 51.114984, 5.8889672, 4.3629672, 0.34444397, 0.0052945894, 0.93901529, 0.0055451869, 3766.1479, 365.99735},
        {8, 53.853423, 54.343531, 5.2827183, 4.4197183, 0.37457219, 0.0048146376, 0.94542817, 0.0055678873, 3940.8854, 340.99138},
        {8, 56.474149, 56.920539, 4.7010481, 4.3310481, 0.41687228, 0.0045136236, 0.93540843, 0.0055324192, 3861.0674, 294.52932},
        {8, 59.094876, 59.511779, 4.3029362, 4.1969362, 0.44185518, 0.0042162116, 0.92025379, 0.0054787745, 2825.9898, 195.72054},
        {8, 60.405191, 60.405191, 0, -0.106, 1, 0, 0.429916, 0.0052, 1363.3916, -16.490748},
    };
    // clang-format on
    rig *r = create_flat_rig();
    operate(r, 8, 0, 9.156);
    sample(r, 1);
    for (int j = 0; j < STATIONS; j++) {
        const double *t = table[j];
        bough_station s = bough_rotor_station(&r->data, 0, j);
        const double value[11] = {s.inflow_x,          s.inflow_y, s.speed,      s.phi / degree,
                                  s.alpha / degree,    s.axial,    s.tangential, s.coefficients.lift,
                                  s.coefficients.drag, s.force_x,  s.force_y};
        for (int c = 0; c < 11; c++) check_near(value[c], t[c], 1e-5, 2e-6);
    }
}

static void mean_of_revolution(rig *r, double *thrust, double *torque) {
    enum { SAMPLES = 72 }; // over the passage of one blade
    *thrust = *torque = 0;
    for (int k = 0; k < SAMPLES; k++) {
        sample(r, 2 * BOUGH_PI / BLADES * k / SAMPLES);
        *thrust += r->data.thrust / SAMPLES;
        *torque += r->data.torque / SAMPLES;
    }
}

// The whole turbine with rigid blades: tilt 5°, pre-cone 2.5°, tower potential flow, skewed wake.
// Wind, pitch, speed, mean thrust [kN] and torque [kN m]: OpenFAST v5. At the last two tip-speed ratios, 1.6
// and 0.8, the wake induces a part of its velocity and none.
TEST(rigid_turbine_matches_reference) {
    static const double table[14][5] = {
        {4, 0, 7.2, 122.637, 260.011},         {6, 0, 7.9, 233.22, 950.717},
        {8, 0, 6, 244.148, 2145.35},           {8, 0, 9.16, 382.103, 1960.59},
        {8, 0, 15, 501.001, 950.214},          {8, 5, 9.16, 232.219, 1481.82},
        {11.4, 0, 12.1, 737.315, 4236.88},     {13, 6.6, 12.1, 496.79, 4123.98},
        {15, 10.45, 12.1, 404.739, 4109.58},   {20, 6.5, 14, 1102.77, 12095},
        {20, 17.47, 12.1, 302.035, 4041.38},   {25, 23.47, 12.1, 232.542, 3459.5},
        {20, 6.5, 4.774648, 301.460, 2919.13}, {20, 6.5, 2.5, 237.145, 1850.03}};
    for (int i = 0; i < 14; i++) {
        rig *r = create_rig(false);
        operate(r, table[i][0], table[i][1], table[i][2]);
        double thrust, torque;
        mean_of_revolution(r, &thrust, &torque);
        check_near(thrust, 1e3 * table[i][3], 2e-3, 0);
        check_near(torque, 1e3 * table[i][4], 2e-3, 0);
    }
}

// In calm air a coned blade meets only its own motion. Where the aerodynamic centre is off the
// axis, that is not square to the section's normal: the blade turns about its own axis, too.
TEST(angle_of_attack_is_in_the_plane_of_the_section) {
    rig *r = create_rig(true);
    r->cone = 20 * degree;
    for (int j = 0; j < STATIONS; j++) r->station[j].centre_y = -2;
    operate(r, 0, 7, 10);
    sample(r, 0.4);
    bough_mat3 blade = r->rotation[0];
    for (int j = 5; j < STATIONS; j++) {
        bough_vec3 centre = bough_v3(0, -2, r->station[j].span + 1.5);
        bough_vec3 arm = bough_mat3_mul(blade, centre);
        bough_vec3 inflow = bough_scale(-r->speed, bough_cross(r->motion.shaft, arm));
        double normal = bough_dot(inflow, blade.c1), chord = bough_dot(inflow, blade.c2);
        bough_station s = bough_rotor_station(&r->data, 0, j);
        check_near(s.alpha, atan2(normal, chord) - r->station[j].twist, 0, 1e-9);
        assert_true(fabs(s.alpha - (s.phi - s.twist)) > 0.01 / s.radius);
    }
}

// A blade whose axis leans by prebend from the root on has the loads of a straight blade on a coned root.
TEST(sections_are_normal_to_a_prebent_axis) {
    const double lean = 10 * degree;
    bough_vec3 force[2][VERTICES];
    for (int k = 0; k < 2; k++) {
        rig *r = create_rig(true);
        bough_mat3 leaning = turned(bough_v3(0, -lean, 0));
        if (k == 0) r->cone = lean;
        for (int i = 0; k == 1 && i < VERTICES; i++) {
            bough_vec3 from_hub = bough_mat3_mul(leaning, bough_v3(0, 0, r->span[i] + 1.5));
            r->axis[i] = bough_sub(from_hub, bough_v3(0, 0, 1.5));
            r->section[i] = leaning;
        }
        for (int j = 0; k == 1 && j < STATIONS; j++) {
            r->station[j].centre_x += -sin(lean) * (r->station[j].span + 1.5);
        }
        operate(r, 12, 0, 11);
        sample(r, 0.4);
        memcpy(force[k], r->force, sizeof force[k]);
    }
    for (int i = 0; i < VERTICES; i++) {
        bough_vec3 off = bough_sub(force[1][i], force[0][i]);
        check_near(bough_norm(off), 0, 0, 1e-9 * bough_norm(force[0][VERTICES / 2]));
    }
}

// Bends, twists and moves the placed blades smoothly by some decimetres and degrees.
static void disturb(rig *r) {
    for (int k = 0; k < BLADES * VERTICES; k++) {
        double s = r->span[k % VERTICES] / 61.5, b = 1 + 0.3 * (k / VERTICES);
        r->rotation[k] =
            bough_mat3_product(r->rotation[k], turned(bough_v3(-0.05 * b * s, 0.12 * s * s, 0.08 * b * s)));
        r->position[k] = bough_axpy(4 * b * s * s, bough_v3(0.9, 0.1, -0.2), r->position[k]);
        r->velocity[k] = bough_add(r->velocity[k], bough_v3(b * s * s, -0.4 * s, 0.2));
        r->spin[k] = bough_add(r->spin[k], bough_v3(0.01, 0.02 * s, -0.01 * b));
    }
}

// Force and moment about the origin of the line loads of blade 0, independently of the weights:
// many points along the deformed axis, between vertices and stations linear.
static void integrate_line_load(const rig *r, const bough_vec3 *force, const bough_vec3 *moment,
                                bough_vec3 *total, bough_vec3 *about) {
    enum { POINTS = 400000 };
    *total = *about = bough_v3(0, 0, 0);
    double end = r->station[STATIONS - 1].span, ds = end / POINTS;
    for (int k = 0, i = 0, j = 0; k < POINTS; k++) {
        double s = (k + 0.5) * ds;
        while (i < VERTICES - 2 && r->span[i + 1] < s) i++;
        while (j < STATIONS - 2 && r->station[j + 1].span < s) j++;
        double w = (s - r->span[i]) / (r->span[i + 1] - r->span[i]);
        double v = (s - r->station[j].span) / (r->station[j + 1].span - r->station[j].span);
        bough_vec3 x = bough_add(bough_scale(1 - w, r->position[i]), bough_scale(w, r->position[i + 1]));
        bough_vec3 f = bough_add(bough_scale(1 - v, force[j]), bough_scale(v, force[j + 1]));
        bough_vec3 m = bough_add(bough_scale(1 - v, moment[j]), bough_scale(v, moment[j + 1]));
        *total = bough_axpy(ds, f, *total);
        *about = bough_axpy(ds, bough_add(bough_cross(x, f), m), *about);
    }
}

// The line load is rebuilt from the reported stations; without offsets, with flat blades.
TEST(mapping_conserves_force_and_moment) {
    rig *r = create_rig(true);
    operate(r, 12, 3, 11);
    place(r, 0.7);
    // Bent out of the rotor plane and stretched, sections unturned: the element axes stay.
    for (int k = 0; k < BLADES * VERTICES; k++) {
        double s = r->span[k % VERTICES] / 61.5;
        r->position[k] = bough_axpy(6 * s * s, r->motion.shaft, r->position[k]);
        r->position[k] = bough_axpy(-1.5 * s * s, r->rotation[k].c3, r->position[k]);
    }
    sample_as_placed(r);
    bough_vec3 z = r->rotation[0].c3, y = bough_cross(z, r->motion.shaft), x = bough_cross(y, z);
    bough_vec3 force[STATIONS], moment[STATIONS], total, about;
    for (int j = 0; j < STATIONS; j++) {
        bough_station s = bough_rotor_station(&r->data, 0, j);
        double c = r->station[j].chord;
        force[j] = bough_axpy(-s.force_y, y, bough_scale(s.force_x, x));
        moment[j] = bough_scale(0.5 * 1.225 * s.speed * s.speed * c * c * s.coefficients.moment, z);
    }
    integrate_line_load(r, force, moment, &total, &about);
    for (int i = 0; i < VERTICES; i++) {
        total = bough_sub(total, r->force[i]);
        about = bough_sub(about, bough_cross(r->position[i], r->force[i]));
        about = bough_sub(about, r->moment[i]);
    }
    check_near(bough_norm(total), 0, 0, 1e-3); // of 2e5 N: the error of the summation
    check_near(bough_norm(about), 0, 0, 2e-1); // of 2e7 N m
}

// Aerodynamic-centre offsets leave the forces of a station and add offset × force.
TEST(offsets_carry_moment) {
    rig *r = create_rig(true);
    for (int j = 0; j < STATIONS; j++) r->station[j].centre_y = -0.4;
    r->def.pitching_moment = false;
    operate(r, 10, 2, 10);
    sample(r, 0);
    bough_vec3 force = {0}, moment = {0};
    for (int i = 0; i < VERTICES; i++) {
        force = bough_add(force, r->force[i]);
        moment = bough_add(moment, r->moment[i]);
    }
    bough_mat3 blade = r->rotation[0];
    bough_vec3 expected = bough_cross(bough_scale(-0.4, blade.c2), force);
    check_near(bough_norm(bough_sub(moment, expected)), 0, 0, 1e-9 * bough_norm(expected));
    assert_true(bough_norm(expected) > 1e4);
}

static void check_same_loads(const rig *a, const rig *b, const bough_mat3 *turn) {
    for (int k = 0; k < BLADES * VERTICES; k++) {
        bough_vec3 f = a->force[k], m = a->moment[k];
        if (turn) f = bough_mat3_mul(*turn, f), m = bough_mat3_mul(*turn, m);
        check_near(bough_norm(bough_sub(f, b->force[k])), 0, 0, 1e-5);
        check_near(bough_norm(bough_sub(m, b->moment[k])), 0, 0, 1e-5);
    }
}

// Structural section axes may include the structural twist, or any other fixed angles.
TEST(section_axes_are_arbitrary) {
    rig *a = create_rig(false), *b = create_rig(false);
    for (int i = 0; i < VERTICES; i++) b->section[i] = turned(bough_v3(0, 0, -0.01 * (24 - i)));
    operate(a, 9, 1, 10);
    operate(b, 9, 1, 10);
    sample(a, 2);
    sample(b, 2);
    check_same_loads(a, b, NULL);
}

// Moving with the wind of the same speed, or standing elsewhere, changes nothing, also where the wake fades.
TEST(rigid_translation_changes_nothing) {
    static const double rpm_of[2] = {10, 3};
    for (int i = 0; i < 2; i++) {
        rig *a = create_rig(false), *b = create_rig(false);
        a->def.tower.n = b->def.tower.n = 0;
        operate(a, 11, 0, rpm_of[i]);
        operate(b, 14, 0, rpm_of[i]);
        place(a, 1);
        place(b, 1);
        disturb(a);
        disturb(b);
        bough_vec3 shift = bough_v3(7, -3, 20), drift = bough_v3(3, 0, 0);
        for (int k = 0; k < BLADES * VERTICES; k++) {
            b->position[k] = bough_add(b->position[k], shift);
            b->velocity[k] = bough_add(b->velocity[k], drift);
        }
        b->motion.hub = bough_add(b->motion.hub, shift);
        sample_as_placed(a);
        sample_as_placed(b);
        check_same_loads(a, b, NULL);
    }
}

// A third of a turn exchanges the blades.
TEST(blades_are_alike) {
    rig *a = create_rig(true), *b = create_rig(true);
    operate(a, 11, 0, 10);
    operate(b, 11, 0, 10);
    sample(a, 0.3);
    sample(b, 0.3 + 0.5);
    bough_mat3 turn = turned(bough_v3(0.5, 0, 0));
    check_same_loads(a, b, &turn);
}

// Nothing is kept between samples, so repeated steps repeat their loads to the bit.
TEST(sample_is_a_function_of_motion) {
    rig *a = create_rig(false), *b = create_rig(false);
    operate(a, 20, 6.5, 14);
    operate(b, 20, 6.5, 14);
    for (int k = 0; k < 20; k++) {
        sample(a, 0.3 * k);
        disturb(a);
        sample_as_placed(a);
    }
    sample(a, 0.9);
    size_t before = bough_arena_bytes(b->arena);
    sample(b, 0.9);
    assert_true(bough_arena_bytes(b->arena) == before);
    size_t size = BLADES * VERTICES * sizeof *a->force;
    assert_memory_equal(a->force, b->force, size);
    assert_memory_equal(a->moment, b->moment, size);
}

// Loads on the vertices (force x, y and moment z in the frame's axes) of the first blade.
static void fetch_rows(const rig *r, double row[3][VERTICES]) {
    static const int place[3] = {0, 1, 5};
    for (int c = 0; c < 3; c++) memcpy(row[c], r->data.load + place[c] * VERTICES, sizeof row[c]);
}

// How far the slopes are from what a motion of all vertices of the first blade changes, per direction
// of the motion, relative to the largest change on the blade: the whole blade moves along x or y, or
// turns about its span.
static void measure_slopes(rig *r, double off[4]) {
    static double before[3][VERTICES], after[3][VERTICES];
    static const double step[4] = {0.05, 0.05, 2e-4, 2e-3};
    double *rows = r->vertex[0];
    sample(r, 0.7);
    for (int j = 0; j < 4; j++) {
        double most = 0, worst = 0;
        for (int side = 0; side < 2; side++) {
            double d = side == 0 ? -step[j] : step[j];
            sample(r, 0.7);
            for (int i = 0; i < VERTICES; i++) {
                double *p = rows + BOUGH_BLADE_ROTATION * VERTICES + i;
                double w = p[0], x = p[VERTICES], y = p[2 * VERTICES], z = p[3 * VERTICES];
                if (j < 2) rows[(BOUGH_BLADE_VELOCITY + j) * VERTICES + i] += d;
                if (j == 3) rows[(BOUGH_BLADE_SPIN + 2) * VERTICES + i] += d;
                if (j != 2) continue;
                p[0] = w - d / 2 * z; // p ∘ (1, 0, 0, d/2)
                p[VERTICES] = x + d / 2 * y;
                p[2 * VERTICES] = y - d / 2 * x;
                p[3 * VERTICES] = z + d / 2 * w;
            }
            evaluate(r);
            fetch_rows(r, side == 0 ? before : after);
        }
        sample(r, 0.7);
        for (int c = 0; c < 2; c++) {
            for (int i = 0; i < VERTICES; i++) {
                double change = (after[c][i] - before[c][i]) / (2 * step[j]);
                double slope = r->data.slope[(4 * c + j) * VERTICES + i];
                most = fmax(most, fabs(change));
                worst = fmax(worst, fabs(change - slope));
            }
        }
        off[j] = worst / most;
    }
}

// Slopes are those of the momentum balance without drag and skew: near enough for
// loads that go on from sample to sample.
TEST(loads_follow_the_motion_by_their_slopes) {
    static const double wind[3] = {8, 12, 20}, pitch[3] = {0, 3, 6.5}, speed[3] = {9, 12.1, 14};
    for (int k = 0; k < 3; k++) {
        rig *r = create_rig(false);
        r->def.slopes = true;
        operate(r, wind[k], pitch[k], speed[k]);
        double off[4];
        measure_slopes(r, off);
        print_message("wind %g m/s: %.2f %.2f %.2f %.2f\n", wind[k], off[0], off[1], off[2], off[3]);
        for (int j = 0; j < 4; j++) assert_true(off[j] < (j == 2 ? 0.2 : 0.12));
    }
}

TEST(slopes_that_are_not_wanted_stay_and_change_no_load) {
    rig *r = create_rig(false);
    r->def.slopes = true;
    operate(r, 12, 0, 12.1);
    sample(r, 0.7);
    double thrust = r->data.thrust, slope = r->data.slope[VERTICES / 2];
    sample(r, 1.2);
    assert_true(r->data.slope[VERTICES / 2] != slope);
    slope = r->data.slope[VERTICES / 2];
    r->data.skips_slopes = true;
    sample(r, 0.7);
    assert_true(r->data.thrust == thrust && r->data.slope[VERTICES / 2] == slope);
}

// Calm, locked, feathered, turning backwards, overspeeding, blown from behind.
TEST(odd_states_are_finite) {
    static const double wind[] = {-15, 0, 1e-9, 8, 60}, pitch[] = {-180, -30, 0, 90};
    static const double speed[] = {-12, 0, 1e-9, 3, 40};
    for (int i = 0; i < 5 * 4 * 5; i++) {
        rig *r = create_rig(false);
        operate(r, wind[i % 5], pitch[i / 5 % 4], speed[i / 20]);
        sample(r, 0.1 * i);
        assert_true(isfinite(r->data.thrust) && isfinite(r->data.torque));
        for (int k = 0; k < BLADES * VERTICES; k++) {
            assert_true(isfinite(bough_norm(r->force[k])));
            assert_true(isfinite(bough_norm(r->moment[k])));
        }
        for (int j = 0; j < STATIONS; j++)
            assert_true(fabs(bough_rotor_station(&r->data, 0, j).alpha) < BOUGH_PI + 1e-9);
    }
}

TEST(station_off_the_blade_is_refused) {
    rig *r = create_rig(true);
    r->station[18].span = 62;
    bough_status status = bough_rotor_build(r->arena, &r->def, &r->rotor);
    assert_int_equal(status.code, BOUGH_INVALID);
    assert_null(r->rotor);
}
