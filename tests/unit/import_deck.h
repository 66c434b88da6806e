// The small turbine of tests/data/decks in a scratch folder, changed, and imported.
#pragma once

#include "tests/unit/decks.h"
#include "tests/unit/import.h"

#include "aero/wind/wind_box.h"
#include "apps/bough/results/folder.h"

// A box of 12 m/s with steps of 2 m/s across, in parts/box.bts; it lasts long and repeats.
static inline void write_box(const char *folder) {
    enum { TIMES = 8 };
    int16_t value[TIMES * 4 * 3];
    for (int i = 0; i < TIMES * 4; i++) {
        value[3 * i] = (int16_t)(1200 + (i % 2 ? 100 : -100));
        value[3 * i + 1] = value[3 * i + 2] = 0;
    }
    const bough_wind_box box = {.periodic = true,
                                .n_z = 2,
                                .n_y = 2,
                                .n_time = TIMES,
                                .dz = 30,
                                .dy = 30,
                                .dt = 0.5,
                                .mean = 12,
                                .hub = 21,
                                .bottom = 6,
                                .scale = {0.01, 0.01, 0.01},
                                .value = value};
    FILE *file = scratch_open(folder, "parts/box.bts", "wb");
    assert_true(bough_wind_box_write(&box, "test", file));
    fclose(file);
}

// Imports the decks under this main file with two texts replaced (NULL: none).
static inline trial attempt_given(const char *main, const edit *one, const edit *two,
                                  const bough_import_options *options) {
    trial t = begin_trial();
    char path[SCRATCH_PATH];
    for (int i = 0; i < N_DECK_FOLDER; i++) {
        snprintf(path, sizeof path, "%s/%s", t.folder, deck_folders[i]);
        check_ok(bough_folder_make(path));
    }
    for (int i = 0; i < N_DECK; i++) copy_deck(t.folder, decks[i], one, two);
    write_box(t.folder);
    snprintf(path, sizeof path, "%s/%s", t.folder, main);
    t.status = bough_import_openfast(path, t.out, options, NULL);
    return t;
}

static inline trial import_given(const char *main, const edit *one, const edit *two,
                                 const bough_import_options *options) {
    return imported(attempt_given(main, one, two, options));
}

static inline trial attempt(const char *main, const edit *change) {
    return attempt_given(main, change, NULL, &(bough_import_options){0});
}

static inline trial import_main(const char *main, const edit *one, const edit *two) {
    return import_given(main, one, two, &(bough_import_options){0});
}

static inline trial import_with(const edit *one, const edit *two) {
    return import_main("main.fst", one, two);
}

// Blades by ElastoDyn.
static const edit by_modes = {"main.fst", "2    CompElast", "1    CompElast"};

static inline trial import(const edit *change) { return import_with(change, NULL); }
