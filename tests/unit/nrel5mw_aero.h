// The NREL 5 MW reference blade as aerodynamics sees it: stations of J. Jonkman et al., NREL/TP-500-38060
// (2009), with the aerodynamic centres of its AeroDyn model, and the airfoil tables of apps/turbine/.
#pragma once

#include "aero/rotor/rotor.h"
#include "tests/unit/check.h"

// Cylinders of drag .5 and .35, DU 40 %, 35, 30, 25, 21 % and NACA 64: filled before the tests start.
enum { NREL5MW_POLARS = 8, NREL5MW_ROWS = 1000 };
static bough_polar_def nrel5mw_polars[NREL5MW_POLARS];

// The rows of apps/turbine/airfoils.yaml, one a line: α [deg], Cl, Cd, Cm.
__attribute__((constructor)) static void nrel5mw_read(void) {
    static double row[NREL5MW_ROWS][4];
    static char name[NREL5MW_POLARS][32];
    FILE *file = fopen(BOUGH_SOURCE_DIR "/apps/turbine/airfoils.yaml", "r");
    char line[200];
    for (int polar = -1, n = 0; file != NULL && fgets(line, sizeof line, file) != NULL && n < NREL5MW_ROWS;) {
        if (polar + 1 < NREL5MW_POLARS && sscanf(line, "  - name: %31s", name[polar + 1]) == 1) {
            polar++;
            nrel5mw_polars[polar] = (bough_polar_def){.row = row[n]};
        }
        double *to = row[n];
        if (sscanf(line, " - [%lf,%lf,%lf,%lf]", to, to + 1, to + 2, to + 3) == 4) {
            nrel5mw_polars[polar].n++;
            n++;
        }
    }
    if (file == NULL || fclose(file) != 0 || nrel5mw_polars[NREL5MW_POLARS - 1].n != 127) abort();
}

// The airfoils built, and a plate beside them.
typedef struct airfoils {
    bough_arena *arena;
    bough_polar polar[NREL5MW_POLARS], plate;
} airfoils;

static inline int airfoils_make(void **state, const bough_polar_def *plate) {
    airfoils *a = test_malloc(sizeof *a);
    a->arena = check_memory();
    for (int i = 0; i < NREL5MW_POLARS; i++) bough_polar_build(a->arena, nrel5mw_polars + i, a->polar + i);
    bough_polar_build(a->arena, plate, &a->plate);
    *state = a;
    return 0;
}

static inline int airfoils_drop(void **state) {
    airfoils *a = *state;
    bough_arena_destroy(a->arena);
    test_free(a);
    return 0;
}

// clang-format off
// span [m], x and y of the aerodynamic centre [m], twist [deg], chord [m], polar
static const double nrel5mw_blade[19][6] = {
    {0, 0, 0, 13.308, 3.542, 0},
    {1.3667, -0.00081531745, -0.0034468858, 13.308, 3.542, 0},
    {4.1, -0.02483979, -0.10501421, 13.308, 3.854, 0},
    {6.8333, -0.059469375, -0.25141635, 13.308, 4.167, 1},
    {10.25, -0.10909141, -0.46120149, 13.308, 4.557, 2},
    {14.35, -0.11573354, -0.56986665, 11.48, 4.652, 3},
    {18.45, -0.098316709, -0.54850833, 10.162, 4.458, 3},
    {22.55, -0.083186967, -0.52457001, 9.011, 4.249, 4},
    {26.65, -0.067933232, -0.49624675, 7.795, 4.007, 5},
    {30.75, -0.053393159, -0.46544755, 6.544, 3.748, 5},
    {34.85, -0.04089926, -0.43583519, 5.361, 3.502, 6},
    {38.95, -0.029722933, -0.40591323, 4.188, 3.256, 6},
    {43.05, -0.020511081, -0.37569051, 3.125, 3.01, 7},
    {47.15, -0.013980013, -0.34521705, 2.319, 2.764, 7},
    {51.25, -0.0083819737, -0.31463837, 1.526, 2.518, 7},
    {54.6667, -0.0043546914, -0.2890922, 0.863, 2.313, 7},
    {57.4, -0.0016838383, -0.26074456, 0.37, 2.086, 7},
    {60.1333, -0.00032815226, -0.1773747, 0.106, 1.419, 7},
    {61.4999, -0.00032815226, -0.1773747, 0.106, 1.419, 7},
};

// Tower: height [m], diameter [m]
static const double nrel5mw_tower_height[12] = {0, 8.5261, 17.053, 25.579, 34.105, 42.633,
                                                51.158, 59.685, 68.211, 76.738, 85.268, 87.6};
static const double nrel5mw_tower_diameter[12] = {6, 5.787, 5.574, 5.361, 5.148, 4.935,
                                                  4.722, 4.509, 4.296, 4.083, 3.87, 3.87};
// clang-format on

// The 19 stations; with `flat` the aerodynamic centres lie on the pitch axis.
static inline void nrel5mw_stations(bough_station_def *station, bool flat) {
    for (int j = 0; j < 19; j++) {
        const double *b = nrel5mw_blade[j];
        station[j] = (bough_station_def){.span = b[0],
                                         .chord = b[4],
                                         .twist = b[3] * BOUGH_PI / 180,
                                         .centre_x = flat ? 0 : b[1],
                                         .centre_y = flat ? 0 : b[2],
                                         .polar = (int)b[5]};
    }
}
