#include "apps/import/draft.h"

#include "apps/config/text.h"
#include "apps/output/folder.h"
#include "apps/scene/scene.h"
#include "apps/simulation/run.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Macro steps [s], and by how much the rotor may turn in one [rad].
static const double longest_step = 0.02, shortest_step = 0.02 / 32, most_turn = 0.07;

enum { TRIAL_STEPS = 2 };

const char *const bough_import_name[BOUGH_N_IMPORT_FILE] = {"scene.yaml",           "blade-structure.yaml",
                                                            "tower-structure.yaml", "blade-aero.yaml",
                                                            "airfoils.yaml",        "import.txt"};

// -- text -----------------------------------------------------------------------------------------

void bough_draft_note(bough_draft *d, bough_import_note kind, const char *format, ...) {
    va_list list;
    va_start(list, format);
    fputs("  ", d->note[kind]);
    vfprintf(d->note[kind], format, list);
    fputc('\n', d->note[kind]);
    va_end(list);
}

void bough_draft_turbine(bough_draft *d, const char *rotor, int n_blade) {
    FILE *file = d->file[BOUGH_IMPORT_SCENE];
    fprintf(file, "turbine:\n  rotor: %s\n  blades: [blade1", rotor);
    for (int k = 2; k <= n_blade; k++) fprintf(file, ", blade%d", k);
    fputs("]\n", file);
}

void bough_draft_tower(bough_draft *d, double foot) {
    FILE *file = d->file[BOUGH_IMPORT_SCENE];
    fputs("  - name: tower\n    fidelity: rod\n    joint: {kind: fixed, parent: ground", file);
    if (foot != 0) fprintf(file, ", placement: [move z %.10g m]", foot);
    fprintf(file, "}\n    rod: {table: %s, segments: 20}\n", bough_import_name[BOUGH_IMPORT_TOWER]);
}

void bough_draft_library(bough_draft *d, const char *library, const char *input, double gear_ratio,
                         double efficiency) {
    FILE *file = d->file[BOUGH_IMPORT_SCENE];
    fprintf(
        file,
        "control:\n  kind: bladed\n  rate: %.10g Hz\n  gear_ratio: %.10g\n  efficiency: %.10g\n  library: ",
        1 / d->macro_step, gear_ratio, efficiency);
    bough_import_path(file, library);
    if (input) {
        fputs("\n  input: ", file);
        bough_import_path(file, input);
    }
    fputc('\n', file);
}

void bough_draft_airfoil_name(const char *text, size_t length, int number, char name[BOUGH_AIRFOIL_NAME]) {
    int n = snprintf(name, BOUGH_AIRFOIL_NAME, "%d-", number);
    for (size_t i = 0; i < length && n < BOUGH_AIRFOIL_NAME - 1; i++)
        name[n++] = bough_import_letter(text[i]);
    name[n] = '\0';
}

static void put_row(FILE *file, double angle, const double *rest) {
    const double value[BOUGH_POLAR_COLUMNS] = {angle, rest[0], rest[1], rest[2]};
    fputs("        - ", file);
    bough_import_list(file, value, BOUGH_POLAR_COLUMNS);
    fputc('\n', file);
}

void bough_draft_polar(bough_draft *d, const char *name, const double *row, int n) {
    const double close = 1e-3; // [deg]
    FILE *file = d->file[BOUGH_IMPORT_POLARS];
    const double *last = row + BOUGH_POLAR_COLUMNS * (n - 1);
    double end[3], gap = 0;
    for (int c = 0; c < 3; c++) {
        end[c] = (row[1 + c] + last[1 + c]) / 2;
        gap = fmax(gap, fabs(row[1 + c] - last[1 + c]));
    }
    bool whole = n > 1 && row[0] <= close - 180 && last[0] >= 180 - close;
    fprintf(file, "  - name: %s\n    table:\n      columns: [alpha deg, cl, cd, cm]\n      rows:\n", name);
    put_row(file, -180, end);
    for (int i = 0; i < n; i++) {
        const double *r = row + BOUGH_POLAR_COLUMNS * i;
        if (fabs(r[0]) < 180 - close) put_row(file, r[0], r + 1);
    }
    put_row(file, 180, end);
    if (whole && gap <= 1e-6) return;
    bough_draft_note(d, BOUGH_APPROXIMATED,
                     "%s: from %g to %g deg; the value at 180 deg is the mean of its ends", name, row[0],
                     last[0]);
}

void bough_import_list(FILE *file, const double *value, int n) {
    for (int i = 0; i < n; i++) fprintf(file, "%s%.10g", i == 0 ? "[" : ", ", value[i] + 0.0);
    fputc(']', file);
}

void bough_import_path(FILE *file, const char *path) {
    char here[BOUGH_PATH_MAX], whole[2 * BOUGH_PATH_MAX];
    bool relative = path[0] != '/' && getcwd(here, sizeof here);
    snprintf(whole, sizeof whole, "%s%s%s", relative ? here : "", relative ? "/" : "", path);
    bough_text_quoted(file, whole);
}

char bough_import_letter(char letter) {
    return isalnum((unsigned char)letter) || letter == '-' ? letter : '_';
}

void bough_draft_head(bough_draft *d, const char *title, const char *origin, double gravity, double duration,
                      double rotor_speed) {
    FILE *file = d->file[BOUGH_IMPORT_SCENE];
    double step = longest_step;
    while (step * rotor_speed > most_turn && step > shortest_step * 1.5) step /= 2;
    double steps = fmax(ceil(duration / step - 1e-6), 1);
    d->macro_step = step;
    fprintf(file,
            "# Imported from %s: import.txt tells what was taken.\n"
            "# Ground axes: x downwind, z up. The rotor turns positive about the shaft's x.\n"
            "title: ",
            origin);
    bough_text_quoted(file, title);
    fprintf(
        file,
        "\ngravity: [0, 0, %.10g]\nsimulation:\n  duration: %.10g s\n"
        "  macro_step: %g s\n"
        "  coupling: {scheme: monolithic} # all bodies coupled at the stages of the steps\n"
        "  master: {solver: rosenbrock, step: %g ms, rtol: 4.5e-4}\n"
        "  error_estimate: linearised # with a controller: second-solution, at three times the cost\n  threads: 2\n",
        -gravity, steps * step, step, 500 * step);
}

// -- files ----------------------------------------------------------------------------------------

static bough_status open_texts(bough_draft *d) {
    bool good = true;
    for (int i = 0; i < BOUGH_N_NOTE; i++)
        good = (d->note[i] = open_memstream(&d->note_text[i], &d->note_size[i])) && good;
    for (int i = 0; i < BOUGH_N_IMPORT_FILE; i++)
        good = (d->file[i] = open_memstream(&d->file_text[i], &d->file_size[i])) && good;
    return good ? bough_ok() : bough_fail(BOUGH_OUT_OF_MEMORY, "memory is exhausted");
}

static void put_text(const void *text, FILE *file) { fputs(text, file); }

static bough_status write_box(const char *folder, const bough_wind_box *box) {
    char path[BOUGH_PATH_MAX];
    FILE *file;
    bough_status status = bough_folder_open(folder, BOUGH_IMPORT_BOX, path, &file);
    if (!bough_is_ok(&status)) return status;
    if (bough_wind_box_write(box, "imported", file)) return bough_folder_commit(path, file);
    bough_folder_discard(path, file);
    return bough_fail(BOUGH_IO, "cannot write '%.200s'", path);
}

static bough_status write_files(const char *folder, const bough_draft *d) {
    bough_status status = bough_folder_make(folder);
    for (int i = 0; i < BOUGH_N_IMPORT_FILE && bough_is_ok(&status); i++) {
        const char *text = d->file_text[i];
        if (text[0]) status = bough_folder_write(folder, bough_import_name[i], put_text, text);
    }
    if (d->box && bough_is_ok(&status)) status = write_box(folder, d->box);
    return status;
}

// The scene's model can be built and goes its first steps; a controller's library, which is another's
// program, is loaded but not called.
static bough_status try_scene(bough_arena *arena, bough_scene *scene) {
    bough_run run;
    scene->simulation.threads = 1;
    bool calls = scene->control.node && scene->control.kind == BOUGH_SCENE_BLADED;
    bough_status status = bough_run_create(arena, scene, &run);
    for (int i = 0; i < TRIAL_STEPS && !calls && bough_is_ok(&status) && !bough_run_done(&run); i++)
        status = bough_run_step(&run);
    if (bough_is_ok(&status)) return status;
    return bough_fail(status.code, "the model gives a scene that cannot run: %.300s", status.message);
}

// What the deck's own checks have let through.
static bough_status check_scene(bough_arena *arena, const char *folder) {
    char path[BOUGH_PATH_MAX];
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    bough_status status = bough_folder_path(folder, bough_import_name[BOUGH_IMPORT_SCENE], path);
    if (bough_is_ok(&status)) status = bough_scene_read(arena, path, NULL, 0, &errors, &scene);
    if (errors.n == 0) return bough_is_ok(&status) ? try_scene(arena, scene) : status;
    const bough_error *e = errors.item;
    const char *slash = strrchr(e->file, '/');
    return bough_fail(BOUGH_INVALID, "the model gives no scene: %.40s:%d: %.80s: %.200s",
                      slash ? slash + 1 : e->file, e->line, e->path, e->text);
}

// Moves the files to their place, the scene last: with it the model is whole; or removes them.
static bough_status finish_files(const char *from, const char *folder, bool good) {
    char old[BOUGH_PATH_MAX], path[BOUGH_PATH_MAX];
    bough_status status = bough_ok();
    for (int i = BOUGH_N_IMPORT_FILE; i >= 0; i--) {
        const char *name = i < BOUGH_N_IMPORT_FILE ? bough_import_name[i] : BOUGH_IMPORT_BOX;
        bough_status named = bough_folder_path(from, name, old);
        if (bough_is_ok(&named)) named = bough_folder_path(folder, name, path);
        if (!bough_is_ok(&named) || !good) {
            unlink(old);
        } else if (rename(old, path) != 0 && errno != ENOENT && bough_is_ok(&status)) {
            status = bough_fail(BOUGH_IO, "cannot write '%.200s': %s", path, strerror(errno));
        }
    }
    rmdir(from);
    return status;
}

// The files are read as a scene before they take their place.
static bough_status publish(bough_draft *d, const char *folder) {
    char draft[BOUGH_PATH_MAX];
    bool present = access(folder, F_OK) == 0;
    bough_status status = bough_folder_path(folder, "import.partial", draft);
    if (!bough_is_ok(&status)) return status;
    status = write_files(draft, d);
    if (bough_is_ok(&status)) status = check_scene(d->arena, draft);
    bough_status finished = finish_files(draft, folder, bough_is_ok(&status));
    if (bough_is_ok(&status)) status = finished;
    if (!bough_is_ok(&status) && !present) rmdir(folder);
    return status;
}

static void put_list(bough_draft *d) {
    static const char *const head[BOUGH_N_NOTE] = {"taken", "approximated", "left out"};
    for (int i = 0; i < BOUGH_N_NOTE; i++) {
        const char *note = d->note_text[i];
        fprintf(d->file[BOUGH_IMPORT_LIST], "%s:\n%s", head[i], note[0] ? note : "  nothing\n");
    }
}

// Closes texts; whether all were written whole.
static bool close_all(FILE **file, int n) {
    bool good = true;
    for (int i = 0; i < n; i++) {
        if (file[i] && (ferror(file[i]) | fclose(file[i])) != 0) good = false;
        file[i] = NULL;
    }
    return good;
}

static bough_status import(bough_arena *arena, void *self) {
    const bough_draft_def *def = self;
    bough_draft *d = def->draft;
    d->arena = arena;
    def->convert(def->self, def->path);
    bool good = close_all(d->note, BOUGH_N_NOTE);
    if (good && bough_is_ok(d->status)) put_list(d);
    good = close_all(d->file, BOUGH_N_IMPORT_FILE) && good;
    if (!good) return bough_fail(BOUGH_OUT_OF_MEMORY, "memory is exhausted");
    if (bough_is_ok(d->status)) *d->status = publish(d, def->folder);
    if (bough_is_ok(d->status) && def->echo) fputs(d->file_text[BOUGH_IMPORT_LIST], def->echo);
    return *d->status;
}

bough_status bough_draft_import(const bough_draft_def *def) {
    bough_draft *d = def->draft;
    bough_draft_def own = *def;
    bough_status kept = bough_ok();
    *d = (bough_draft){.status = &kept};
    bough_status status = open_texts(d);
    if (bough_is_ok(&status)) status = bough_arena_use(import, &own);
    close_all(d->note, BOUGH_N_NOTE);
    close_all(d->file, BOUGH_N_IMPORT_FILE);
    for (int i = 0; i < BOUGH_N_NOTE; i++) free(d->note_text[i]);
    for (int i = 0; i < BOUGH_N_IMPORT_FILE; i++) free(d->file_text[i]);
    return status;
}
