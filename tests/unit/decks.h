// The files of the small turbine of tests/data/decks, by OpenFAST's versions 3, 4 and 5.
#pragma once

static const char *const decks[] = {
    "main.fst",        "parts/elasto.dat",     "parts/blade.dat",       "parts/tower.dat",
    "parts/beam.dat",  "parts/beam-blade.dat", "parts/wind.dat",        "parts/aero.dat",
    "parts/servo.dat", "parts/aero-blade.dat", "parts/foils/round.dat", "parts/foils/flat.dat",
    "v4/main.fst",     "v4/elasto.dat",        "v4/blade.dat",          "v4/aero.dat",
    "v5/main.fst",     "v5/elasto.dat",        "v5/aero-blade.dat",     "v5/aero.dat",
    "v5/servo.dat",    "v5/beam.dat",          "v5/beam-blade.dat",
};
static const char *const deck_folders[] = {"parts/foils", "v4", "v5"};
enum { N_DECK = sizeof decks / sizeof *decks, N_DECK_FOLDER = 3 };
