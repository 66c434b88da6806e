// The texts of an imported scene's files and of its list. They become files only when the whole model could
// be read.
#pragma once

#include "aero/wind/wind_box.h"
#include "apps/bough/import/import.h"
#include "apps/bough/scene/scene.h"

typedef enum bough_import_file {
    BOUGH_IMPORT_SCENE,
    BOUGH_IMPORT_BLADE,
    BOUGH_IMPORT_TOWER,
    BOUGH_IMPORT_AERO,
    BOUGH_IMPORT_POLARS,
    BOUGH_IMPORT_LIST,
    BOUGH_N_IMPORT_FILE,
} bough_import_file;

// Parts of the list, which are texts beside those of the files.
typedef enum bough_import_note {
    BOUGH_OTHER_CASE = BOUGH_N_IMPORT_FILE, // left out, which makes the load case another one
    BOUGH_TAKEN,
    BOUGH_APPROXIMATED,
    BOUGH_LEFT_OUT,
    BOUGH_TRIED,
    BOUGH_N_IMPORT_TEXT
} bough_import_note;

extern const char *const bough_import_name[BOUGH_N_IMPORT_FILE];

typedef struct bough_draft {
    bough_arena *arena;
    bough_status *status;            // the first failure is kept
    FILE *file[BOUGH_N_IMPORT_TEXT]; // by file and note; a file left empty is not written
    char *text[BOUGH_N_IMPORT_TEXT];
    size_t size[BOUGH_N_IMPORT_TEXT];
    double macro_step; // [s]; air and control are sampled as often
    const bough_import_options *options;
    int halvings;              // of the macro step, after those for the speed of the rotor
    int setting;               // index among those of mesh and integrator that are tried
    bool by_air;               // the trial failed by the sampling of the air alone
    const bough_wind_box *box; // to be written as wind.bts; NULL: none
} bough_draft;

#define BOUGH_IMPORT_BOX "wind.bts"

// convert(d, path) fills a draft, then the files are written unless there was a failure or they make no scene
// that runs; the list also to `echo` (NULL: nobody). Where a trial fails, again with a finer mesh, smaller
// steps and tolerances, then with half the macro step.
bough_status bough_draft_import(void (*convert)(bough_draft *d, const char *path), const char *path,
                                const char *folder, const bough_import_options *options, FILE *echo);

// A line of the list.
void bough_draft_note(bough_draft *d, bough_import_note kind, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Lines of one kind, for the importers, whose struct *x has the draft.
#define bough_taken(x, ...) bough_draft_note((x)->draft, BOUGH_TAKEN, __VA_ARGS__)
#define bough_approximated(x, ...) bough_draft_note((x)->draft, BOUGH_APPROXIMATED, __VA_ARGS__)
#define bough_left_out(x, ...) bough_draft_note((x)->draft, BOUGH_LEFT_OUT, __VA_ARGS__)
#define bough_other_case(x, ...) bough_draft_note((x)->draft, BOUGH_OTHER_CASE, __VA_ARGS__)

// Adds to the scene's text, as printf does.
#define bough_put(x, ...) fprintf((x)->draft->file[BOUGH_IMPORT_SCENE], __VA_ARGS__)

// Writes the scene's first lines: comment, title, time, solvers. The macro step follows from the rotor's
// speed [rad/s]; the duration [s] is rounded up to whole macro steps. `origin`: "an OpenFAST model".
void bough_draft_head(bough_draft *d, const char *title, const char *origin, double gravity, double duration,
                      double rotor_speed);

enum { BOUGH_IMPORT_BLADES = 16 }; // at most

// The scene's 'turbine': blades are named blade1, blade2 ...
void bough_draft_turbine(bough_draft *d, const char *rotor, int n_blade);

// Table and segments of the blade whose body was written last.
void bough_draft_blade_rod(bough_draft *d);

// The scene's flexible tower, its foot at this height [m], and its 'control' by a library with its input file
// (NULL: none) and the constants of the generator; further keys may follow.
void bough_draft_tower(bough_draft *d, double foot);
void bough_draft_library(bough_draft *d, const char *library, const char *input, double gear_ratio,
                         double efficiency);

// The name of an airfoil's polar: its number, and `text` in the letters that names in scenes may have.
enum { BOUGH_AIRFOIL_NAME = 64, BOUGH_POLAR_COLUMNS = 4 };
void bough_draft_airfoil_name(const char *text, size_t length, int number, char name[BOUGH_AIRFOIL_NAME]);

// A polar with rows (n × BOUGH_POLAR_COLUMNS) of increasing angle [deg], lift, drag and moment, written from
// -180 to 180 deg, both with the mean of the table's first and last values. `indicial`: A1, A2, b1, b2 of
// the polar's dynamic stall (4), NULL: the scene's default.
void bough_draft_polar(bough_draft *d, const char *name, const double *row, int n, const double *indicial);

// "[1, 2, 3]" in the scene's spelling.
void bough_import_list(FILE *file, const double *value, int n);

// A line of the scene's aero.tower: the n values at these strides.
void bough_draft_tower_list(bough_draft *d, const char *key, const double *value, int stride, int n);

// Writes a path as an absolute path in double quotes, for files that stay where they are.
void bough_import_path(FILE *file, const char *path);

// -- the first steps of an imported scene, as a run takes them ------------------------------------

// Builds the scene and takes at most `steps` macro steps, with one thread and the calls of the controller's
// library, in a process of its own: a library that crashes ends the trial, not the import. `bound`: of the
// errors relative to the channels' ranges [1]; 0: none. BOUGH_INVALID: there is no such model, or its library
// crashes; BOUGH_FAILED: it cannot be stepped, or its errors exceed the bound, those of the mesh only if
// there is a `finer` one; `by_air`: those of the air's sampling alone do.
bough_status bough_import_trial(bough_arena *arena, bough_scene *scene, int steps, double bound, bool finer,
                                bool *by_air);
