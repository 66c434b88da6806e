// The study that compares a blade's models: what it finds of a small clamped blade and a short run.
#include "tests/unit/scratch.h"
#include "tests/verification/blade_models_internal.h"

static const char head[] = "title: Two models\nkind: blade-models\n"
                           "blade: " BOUGH_SOURCE_DIR "/apps/beams/blade.yaml\n"
                           "load: [\"loads=[{body: blade, along: [0, 61.5], force: [2 kN/m, 0, 0],"
                           " frame: body}]\"]\n"
                           "turbine: " BOUGH_SOURCE_DIR "/apps/turbine/runup.yaml\n"
                           "run: [simulation.duration=0.2 s, simulation.threads=1]\n"
                           "reference: {body: [fidelity=rod, rod.segments=24]}\nrepeat: 1\n";
static const char models[] = "models:\n"
                             "  - {name: same, body: [fidelity=rod, rod.segments=24]}\n"
                             "  - {name: coarse, body: [fidelity=rod, rod.segments=12]}\n"
                             "  - {name: linear, body: [fidelity=modal, rod.segments=24, modal.modes=14]}\n";

static bough_blade_models *read_study(bough_arena *arena, const char *folder, const char *text,
                                      bough_errors *errors) {
    char path[128];
    bough_verification study;
    snprintf(path, sizeof path, "%s/study.yaml", folder);
    FILE *file = scratch_open(folder, "study.yaml", "w");
    fprintf(file, "%s%s", head, text);
    fclose(file);
    errors->arena = arena;
    bough_status status = bough_verification_read(arena, path, errors, &study);
    return bough_is_ok(&status) ? study.study : NULL;
}

// The linear body: the undeformed frequencies of the same mesh, of a cubic deflection error.
TEST_IN_FOLDER(blades_are_found_by_their_models) {
    check_arena(arena);
    bough_errors errors = {0};
    bough_blade_models *study = read_study(arena, *context, models, &errors);
    assert_non_null(study);
    bough_model_blade blade[3];
    for (int k = 0; k < 3; k++) {
        check_ok(bough_model_blade_find(arena, study, &study->model[k], &blade[k]));
    }
    assert_int_equal(blade[0].n, 24);
    assert_int_equal(blade[1].n, 12);
    assert_int_equal(blade[2].n_state, 2 * (14 + 12));
    check_near(blade[0].flap[24], 2.022713, 3e-3, 0); // an independent beam solver
    check_near(blade[0].twist[24], 0.0291 * acos(-1) / 180, 0.1, 0);
    for (int k = 0; k < BOUGH_BLADE_MODELS_FREQUENCIES; k++) {
        check_near(blade[2].rest[k], blade[0].rest[k], 1e-3, 0); // dampers couple
        assert_true(k == 0 || blade[0].rest[k] > blade[0].rest[k - 1]);
    }
    check_near(blade[2].flap[24], blade[0].flap[24], 0.01, 0);
}

TEST_IN_FOLDER(table_and_file_hold_every_model) {
    char table[4096] = "";
    check_arena(arena);
    bough_errors errors = {0};
    bough_blade_models *study = read_study(arena, *context, models, &errors);
    FILE *stream = fmemopen(table, sizeof table, "w");
    bough_verification_options options = {.folder = *context, .quiet = true, .stream = stream};
    bough_status status = bough_blade_models_perform(arena, study, &options);
    fclose(stream);
    assert_int_equal(status.code, BOUGH_OK);
    const char *same = strstr(table, "\nsame ");
    assert_non_null(same);
    double values[8];
    int states, n = sscanf(same + 23, "%d | %lf %lf %lf %lf | %lf %lf %lf", &states, &values[0], &values[1],
                           &values[2], &values[3], &values[4], &values[5], &values[6]);
    assert_int_equal(n, 8);
    for (int k = 0; k < 7; k++) check_near(values[k], 0, 0, 0); // it is the reference
    char *csv = scratch_read(*context, "blade-models.csv");
    assert_non_null(csv);
    assert_non_null(strstr(csv, "\ncoarse,156,"));
    assert_non_null(strstr(csv, "\nlinear,52,"));
    free(csv);
}

TEST_IN_FOLDER(meshes_must_fit_the_reference) {
    check_arena(arena);
    bough_errors errors = {0};
    bough_blade_models *study =
        read_study(arena, *context, "models: [{name: odd, body: [fidelity=rod, rod.segments=7]}]\n", &errors);
    bough_verification_options options = {.folder = *context, .quiet = true, .stream = stderr};
    check_fails(bough_blade_models_perform(arena, study, &options), BOUGH_INVALID,
                "24 segments are no multiple of 7 of 'odd'");
}

TEST_IN_FOLDER(keys_are_checked) {
    check_arena(arena);
    bough_errors errors = {0};
    assert_null(read_study(arena, *context, "models: [{name: a, bodies: [x=1]}]\n", &errors));
    assert_int_equal(errors.n, 2); // the unknown key, the missing one
}
