#include "apps/bough/import/draft.h"

#include "apps/bough/model/error_verdict.h"
#include "apps/bough/model/run.h"
#include "apps/bough/results/folder.h"
#include "core/base/quote.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

// -- trial ----------------------------------------------------------------------------------------

// The first steps of an imported scene, as a run takes them.

// Whether the air's sampling alone exceeds the bound, which no tolerance changes.
static bool fails_by_air(const bough_companion *c, const bough_error_shares *shares, double bound) {
    const bough_error_share *air = &shares->share[BOUGH_SHARE_AIR];
    return shares->found && !air->unknown[0] &&
           bough_error_verdict_of(c, true, air->largest).relative > bound;
}

// What a trial's process writes.
typedef struct outcome {
    bough_status status;
    bool by_air;
} outcome;

// An error that a finer mesh may mend, without a search for its cause.
static bough_status judge_whole(const bough_companion *c, double bound) {
    bough_error_verdict v = bough_error_verdict_of(c, true, c->error);
    char size[BOUGH_ERROR_SIZE];
    if (!(v.relative > bound)) return bough_ok();
    bough_error_size(c, v.channel, size);
    return bough_fail(BOUGH_FAILED, "%s errs by %s", c->channels->channel[v.channel].name, size);
}

static bough_status take_steps(bough_arena *arena, bough_scene *scene, int steps, double bound, bool finer,
                               bool *by_air) {
    bough_run run;
    bough_error_shares shares = {0};
    char warning[BOUGH_ERROR_WARNING];
    bough_scene_simulation *x = &scene->simulation;
    x->threads = 1;
    x->duration = fmin(x->duration, steps * x->macro_step);
    x->output.from = 0;
    bough_status status = bough_run_create(arena, scene, &run);
    while (bough_is_ok(&status) && !bough_run_done(&run)) status = bough_run_step(&run);
    if (!bough_is_ok(&status)) return status;
    if (finer && run.companion && bound > 0) return judge_whole(run.companion, bound);
    status = bough_error_judge(arena, run.companion, NULL, bound, &shares, warning);
    *by_air = status.code == BOUGH_FAILED && fails_by_air(run.companion, &shares, bound);
    return status;
}

static bool calls_library(const bough_scene *scene) {
    return scene->control.node && scene->control.kind == BOUGH_SCENE_BLADED;
}

// The failure of a process that ended without a result: by a signal, or because the library ended it.
static bough_status crash_of(const bough_scene *scene, int end) {
    const char *signal = WIFSIGNALED(end) ? strsignal(WTERMSIG(end)) : "the program ends";
    if (!calls_library(scene)) return bough_fail(BOUGH_INVALID, "the first steps crash: %s", signal);
    return bough_fail(BOUGH_INVALID,
                      "the controller's library '%.200s' crashes in its first calls: %s; --controller FILE "
                      "takes another",
                      scene->control.library, signal);
}

// Discards what a library prints.
static void silence(void) {
    int null = open("/dev/null", O_RDWR);
    if (null < 0) return;
    dup2(null, STDIN_FILENO);
    dup2(null, STDOUT_FILENO);
}

bough_status bough_import_trial(bough_arena *arena, bough_scene *scene, int steps, double bound, bool finer,
                                bool *by_air) {
    int ends[2], end = 0;
    outcome of = {0};
    if (pipe(ends) != 0) return bough_fail(BOUGH_IO, "cannot start a trial: %s", strerror(errno));
    pid_t child = fork();
    if (child == 0) {
        silence();
        of.status = take_steps(arena, scene, steps, bound, finer, &of.by_air);
        bool whole = write(ends[1], &of, sizeof of) == (ssize_t)sizeof of;
        _exit(whole ? 0 : 1);
    }
    close(ends[1]);
    ssize_t got = child > 0 ? read(ends[0], &of, sizeof of) : 0;
    close(ends[0]);
    if (child < 0) return bough_fail(BOUGH_IO, "cannot start a trial: %s", strerror(errno));
    while (waitpid(child, &end, 0) < 0 && errno == EINTR) continue;
    *by_air = of.by_air;
    return got == (ssize_t)sizeof of ? of.status : crash_of(scene, end);
}

// Macro steps [s], and the largest rotation of the rotor in one [rad].
static const double longest_step = 0.02, shortest_step = 0.02 / 32, most_turn = 0.07;
enum { HALVINGS = 2 }; // of the macro step, where no setting is good enough

// Segments of a blade and of the tower, integrator's steps in a macro step, its tolerance: the cheapest
// first.
static const struct {
    int blade, tower, steps;
    const char *rtol;
} setting[] = {
    {24, 10, 1, "1e-3"},   {32, 20, 1, "1e-3"}, {32, 20, 2, "4.5e-4"},
    {32, 20, 2, "1.5e-4"}, {32, 20, 2, "5e-5"}, {32, 20, 2, "1.5e-5"},
};
enum { N_SETTING = sizeof setting / sizeof *setting, TRIAL_STEPS = 2 };

const char *const bough_import_name[BOUGH_N_IMPORT_FILE] = {"scene.yaml",           "blade-structure.yaml",
                                                            "tower-structure.yaml", "blade-aero.yaml",
                                                            "airfoils.yaml",        "import.txt"};

// -- text -----------------------------------------------------------------------------------------

void bough_draft_note(bough_draft *d, bough_import_note kind, const char *format, ...) {
    va_list list;
    va_start(list, format);
    fputs("  ", d->file[kind]);
    vfprintf(d->file[kind], format, list);
    fputc('\n', d->file[kind]);
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
    fprintf(file, "}\n    rod: {table: %s, segments: %d}\n", bough_import_name[BOUGH_IMPORT_TOWER],
            setting[d->setting].tower);
}

// Segments that shorten towards the tip; docs/import.md has the errors of other numbers of them.
void bough_draft_blade_rod(bough_draft *d) {
    fprintf(d->file[BOUGH_IMPORT_SCENE], "    rod: {table: %s, segments: %d, grading: 0.2}\n",
            bough_import_name[BOUGH_IMPORT_BLADE], setting[d->setting].blade);
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
        name[n++] = isalnum((unsigned char)text[i]) || text[i] == '-' ? text[i] : '_';
    name[n] = '\0';
}

static void put_row(FILE *file, double angle, const double *rest) {
    const double value[BOUGH_POLAR_COLUMNS] = {angle, rest[0], rest[1], rest[2]};
    fputs("        - ", file);
    bough_import_list(file, value, BOUGH_POLAR_COLUMNS);
    fputc('\n', file);
}

void bough_draft_polar(bough_draft *d, const char *name, const double *row, int n, const double *indicial) {
    const double close = 1e-3; // [deg]
    FILE *file = d->file[BOUGH_IMPORT_POLARS];
    const double *last = row + BOUGH_POLAR_COLUMNS * (n - 1);
    double end[3], gap = 0;
    for (int c = 0; c < 3; c++) {
        end[c] = (row[1 + c] + last[1 + c]) / 2;
        gap = fmax(gap, fabs(row[1 + c] - last[1 + c]));
    }
    bool whole = n > 1 && row[0] <= close - 180 && last[0] >= 180 - close;
    fprintf(file, "  - name: %s\n", name);
    if (indicial) {
        fputs("    indicial: ", file);
        bough_import_list(file, indicial, 4);
        fputs("\n", file);
    }
    fputs("    table:\n      columns: [alpha deg, cl, cd, cm]\n      rows:\n", file);
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

void bough_draft_tower_list(bough_draft *d, const char *key, const double *value, int stride, int n) {
    FILE *file = d->file[BOUGH_IMPORT_SCENE];
    fprintf(file, "    %s: ", key);
    for (int i = 0; i < n; i++) fprintf(file, "%s%.10g", i > 0 ? ", " : "[", value[stride * i]);
    fputs("]\n", file);
}

void bough_import_path(FILE *file, const char *path) {
    char here[BOUGH_PATH_MAX], whole[2 * BOUGH_PATH_MAX];
    bool relative = path[0] != '/' && getcwd(here, sizeof here);
    snprintf(whole, sizeof whole, "%s%s%s", relative ? here : "", relative ? "/" : "", path);
    bough_quote(file, whole);
}

void bough_draft_head(bough_draft *d, const char *title, const char *origin, double gravity, double duration,
                      double rotor_speed) {
    FILE *file = d->file[BOUGH_IMPORT_SCENE];
    double step = longest_step;
    while (step * rotor_speed > most_turn && step > shortest_step * 1.5) step /= 2;
    step /= 1 << d->halvings;
    double steps = fmax(ceil(duration / step - 1e-6), 1);
    d->macro_step = step;
    fprintf(file,
            "# Imported from %s: import.txt lists what was taken.\n"
            "# Ground axes: x downwind, z up. The rotor turns positive about the shaft's x.\n"
            "title: ",
            origin);
    bough_quote(file, title);
    fprintf(file,
            "\ngravity: [0, 0, %.10g]\nsimulation:\n  duration: %.10g s\n"
            "  macro_step: %g s\n"
            "  coupling: {scheme: " BOUGH_SCHEME_DEFAULT "} # all bodies coupled at the stages of the steps\n"
            "  master: {solver: rosenbrock, step: %g ms, rtol: %s}\n"
            "  threads: 2\n",
            -gravity, steps * step, step, 1000 * step / setting[d->setting].steps, setting[d->setting].rtol);
}

// -- files ----------------------------------------------------------------------------------------

static bough_status open_texts(bough_draft *d) {
    bool good = true;
    for (int i = 0; i < BOUGH_N_IMPORT_TEXT; i++)
        good = (d->file[i] = open_memstream(&d->text[i], &d->size[i])) && good;
    return good ? bough_ok() : bough_fail(BOUGH_OUT_OF_MEMORY, "memory is exhausted");
}

static void put_text(const void *text, FILE *file) { fputs(text, file); }

static void put_box(const void *box, FILE *file) { bough_wind_box_write(box, "imported", file); }

static bough_status write_file(const char *folder, const bough_draft *d, int i) {
    const char *text = d->text[i];
    return text[0] ? bough_folder_write(folder, bough_import_name[i], put_text, text) : bough_ok();
}

static bough_status write_files(const char *folder, const bough_draft *d) {
    bough_status status = bough_folder_make(folder);
    for (int i = 0; i < BOUGH_IMPORT_LIST && bough_is_ok(&status); i++) status = write_file(folder, d, i);
    if (d->box && bough_is_ok(&status))
        status = bough_folder_write(folder, BOUGH_IMPORT_BOX, put_box, d->box);
    return status;
}

// -- trials ---------------------------------------------------------------------------------------

// Errors count as small enough well below the scene's bound, since a whole run may err by more than its first
// steps; with the last setting, below the bound.
static bough_status try_scene(bough_draft *d, bough_scene *scene) {
    const double usual = 0.5; // of the bound
    const bough_scene_simulation *s = &scene->simulation;
    bool judged = d->options->trial_steps > 0;
    int steps = judged ? d->options->trial_steps << d->halvings : TRIAL_STEPS;
    double part = !judged ? 0 : d->setting + 1 < N_SETTING ? usual : 1;
    double tried = fmin(steps * s->macro_step, s->duration), macro_step = s->macro_step;
    bool finer = setting[d->setting].blade < setting[N_SETTING - 1].blade;
    bough_status status =
        bough_import_trial(d->arena, scene, steps, part * s->error_bound, finer, &d->by_air);
    bough_draft_note(d, BOUGH_TRIED,
                     "%g s in macro steps of %g s with rtol %s, steps of %g s and at most %d segments%s%s",
                     tried, macro_step, setting[d->setting].rtol, s->master.step, setting[d->setting].blade,
                     bough_is_ok(&status) ? "" : ": ", status.message);
    if (bough_is_ok(&status)) return status;
    if (status.code != BOUGH_FAILED)
        return bough_fail(status.code, "the model gives a scene that cannot run: %.500s", status.message);
    return bough_fail(
        status.code,
        "the model gives a scene that cannot run, not even with macro steps of %g s and rtol %s: "
        "%.500s",
        macro_step, setting[d->setting].rtol, status.message);
}

// Reads the scene as a run does, whose checks are more than the deck's, and tries it.
static bough_status check_scene(bough_draft *d, const char *folder) {
    char path[BOUGH_PATH_MAX];
    bough_errors errors = {.arena = d->arena};
    bough_scene *scene;
    bough_status status = bough_folder_path(folder, bough_import_name[BOUGH_IMPORT_SCENE], path);
    if (bough_is_ok(&status)) status = bough_scene_read(d->arena, NULL, path, NULL, 0, &errors, &scene);
    if (errors.n == 0) return bough_is_ok(&status) ? try_scene(d, scene) : status;
    const bough_error *e = errors.item;
    return bough_fail(BOUGH_INVALID, "the model gives no scene: %.40s:%d: %.80s: %.200s",
                      bough_file_name(e->file), e->line, e->path, e->text);
}

// Moves the files to the folder, the scene last, which completes the model; after a failure removes them.
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

// Closes texts; whether all were written completely.
static bool close_all(FILE **file, int n) {
    bool good = true;
    for (int i = 0; i < n; i++) {
        if (file[i] && (ferror(file[i]) | fclose(file[i])) != 0) good = false;
        file[i] = NULL;
    }
    return good;
}

// The list, with the lines of the trials.
static bough_status write_list(bough_draft *d, const char *folder) {
    static const char *const head[] = {
        [BOUGH_OTHER_CASE] = "NOT THE MODEL'S LOAD CASE, which also has",
        [BOUGH_TAKEN] = "taken",
        [BOUGH_APPROXIMATED] = "approximated",
        [BOUGH_LEFT_OUT] = "left out",
        [BOUGH_TRIED] = "tried",
    };
    FILE **list = &d->file[BOUGH_IMPORT_LIST];
    bool good = close_all(d->file + BOUGH_OTHER_CASE, BOUGH_N_IMPORT_TEXT - BOUGH_OTHER_CASE);
    for (int i = BOUGH_OTHER_CASE; i < BOUGH_N_IMPORT_TEXT && good; i++) {
        const char *note = d->text[i];
        if (i == BOUGH_OTHER_CASE && !note[0]) continue;
        fprintf(*list, "%s:\n%s", head[i], note[0] ? note : "  nothing\n");
    }
    if (!close_all(list, 1) || !good) return bough_fail(BOUGH_OUT_OF_MEMORY, "memory is exhausted");
    return write_file(folder, d, BOUGH_IMPORT_LIST);
}

// The files are read and tried as a scene before they take their place.
static bough_status publish(bough_draft *d, const char *folder) {
    char draft[BOUGH_PATH_MAX];
    bool present = access(folder, F_OK) == 0;
    BOUGH_TRY(bough_folder_path(folder, "import.partial", draft));
    bough_status status = write_files(draft, d);
    if (bough_is_ok(&status)) status = check_scene(d, draft);
    if (bough_is_ok(&status)) status = write_list(d, draft);
    bough_status finished = finish_files(draft, folder, bough_is_ok(&status));
    if (bough_is_ok(&status)) status = finished;
    if (!bough_is_ok(&status) && !present) rmdir(folder);
    return status;
}

typedef struct task {
    void (*convert)(bough_draft *d, const char *path);
    const char *path, *folder;
    FILE *echo;
    bough_draft draft;
} task;

static bough_status import(bough_arena *arena, void *self) {
    task *t = self;
    bough_draft *d = &t->draft;
    d->arena = arena;
    t->convert(d, t->path);
    if (!close_all(d->file, BOUGH_IMPORT_LIST)) return bough_fail(BOUGH_OUT_OF_MEMORY, "memory is exhausted");
    if (bough_is_ok(d->status)) *d->status = publish(d, t->folder);
    if (bough_is_ok(d->status) && t->echo) fputs(d->text[BOUGH_IMPORT_LIST], t->echo);
    return *d->status;
}

// *tried: lines of the trials before this one, to which its own is added; to be freed.
static bough_status import_once(task *t, char **tried) {
    bough_draft *d = &t->draft;
    bough_status kept = bough_ok();
    d->status = &kept;
    bough_status status = open_texts(d);
    if (bough_is_ok(&status) && *tried) fputs(*tried, d->file[BOUGH_TRIED]);
    if (bough_is_ok(&status)) status = bough_arena_use(import, t);
    close_all(d->file, BOUGH_N_IMPORT_TEXT);
    free(*tried);
    *tried = d->text[BOUGH_TRIED];
    for (int i = 0; i < BOUGH_TRIED; i++) free(d->text[i]);
    return status;
}

bough_status bough_draft_import(void (*convert)(bough_draft *d, const char *path), const char *path,
                                const char *folder, const bough_import_options *options, FILE *echo) {
    int most = options->trial_steps > 0 ? HALVINGS : 0;
    char *tried = NULL;
    bough_status status = {.code = BOUGH_FAILED};
    for (int k = 0, i = 0; k <= most && status.code == BOUGH_FAILED; k += i == 0) {
        task t = {convert, path, folder, echo, {.options = options, .halvings = k, .setting = i}};
        status = import_once(&t, &tried);
        // shorter macro steps alone mend the error of the air's sampling
        i = t.draft.by_air && k < most ? 0 : (i + 1) % N_SETTING;
    }
    free(tried);
    return status;
}
