#include "tests/verification/blade_models.h"

#include "apps/bough/cases/perform.h"
#include "apps/bough/cases/study.h"
#include "apps/bough/config/schema_keys.h"
#include "apps/bough/results/folder.h"
#include "apps/bough/scene/scene.h"
#include "tests/verification/blade_models_internal.h"

// -- reading --------------------------------------------------------------------------------------

// clang-format off

#define FILLS bough_blade_model
static const bough_schema model_schema = {.name = "a model", KEYS(
    {.name = "name", .kind = BOUGH_KEY_TEXT, .fallback = "reference", AT(name),
     .help = "heads its row"},
    {.name = "body", .kind = BOUGH_KEY_TEXTS, .count = 1, .required = true, AT(set.item),
     .count_offset = offsetof(bough_blade_model, set.n),
     .help = "replacements KEY=VALUE in every body that bends"},
)};
#undef FILLS

#define FILLS bough_blade_models
static const bough_schema study_schema = {.name = "a study", KEYS(
    {.name = "title", .kind = BOUGH_KEY_TEXT, .fallback = "Blade models", AT(title),
     .help = "one line: what is asked"},
    {.name = "kind", .kind = BOUGH_KEY_CHOICE, CHOICES("blade-models"), .required = true,
     AT(kind), .help = "blade-models: one blade modelled in several ways"},
    {.name = "blade", .kind = BOUGH_KEY_TEXT, .required = true, AT(blade),
     .help = "scene of the clamped blade, relative to the study"},
    {.name = "load", .kind = BOUGH_KEY_TEXTS, .count = 1, .required = true, AT(load.item),
     .count_offset = offsetof(bough_blade_models, load.n),
     .help = "replacements KEY=VALUE that bend the blade"},
    {.name = "turbine", .kind = BOUGH_KEY_TEXT, .required = true, AT(turbine),
     .help = "scene of the run, relative to the study"},
    {.name = "run", .kind = BOUGH_KEY_TEXTS, .count = 1, .required = true, AT(run.item),
     .count_offset = offsetof(bough_blade_models, run.n), .help = "replacements KEY=VALUE in that scene"},
    {.name = "reference", .kind = BOUGH_KEY_MAPPING, .of = &model_schema, .required = true,
     AT(reference), .help = "what all are measured against"},
    {.name = "repeat", .kind = BOUGH_KEY_INTEGER, .range = "[1, 99]", .fallback = "3", AT(repeat),
     .help = "runs of each model, alternately; the least time counts"},
    {.name = "models", .kind = BOUGH_KEY_LIST, .of = &model_schema, .count = 1, .required = true,
     AT(model), COUNT_AT(n),
     .help = "times are relative to the first one's"},
)};
#undef FILLS
// clang-format on

void *bough_blade_models_read(bough_arena *arena, const char *path, const bough_node *root,
                              bough_errors *errors) {
    bough_blade_models *s = bough_arena_take(arena, sizeof *s);
    bough_schema_reader reader = {.arena = arena, .errors = errors, .directory = ""};
    bough_schema_read(&reader, &study_schema, root, s);
    if (errors->n > 0) return s;
    s->blade = bough_study_path(arena, path, s->blade);
    s->turbine = bough_study_path(arena, path, s->turbine);
    return s;
}

// -- the run --------------------------------------------------------------------------------------

// What is recorded of the run: tip positions, twist of the tips, speed of the rotor.
static const struct {
    const char *name, *unit;
    int n; // channels per vector, numbered by the blade; 0: one for all
    const char *channel[3];
} measures[BOUGH_BLADE_MODELS_MEASURES] = {
    {"tip", "m", 3, {"TipDxb", "TipDyb", "TipDzb"}},
    {"twist", "deg", 1, {"TwstDefl"}},
    {"speed", "rpm", 0, {"RotSpeed"}},
};

static void set_measure(bough_arena *arena, int k, int n_blade, bough_study *run) {
    int vectors = measures[k].n > 0 ? n_blade : 1, each = measures[k].n > 0 ? measures[k].n : 1;
    bough_study_measure *m = &run->measure[k];
    *m = (bough_study_measure){.name = measures[k].name, .unit = measures[k].unit, .scale = 1};
    m->channels = (bough_study_vectors){.n_channel = vectors * each, .n_vector = vectors};
    m->channels.channel = bough_arena_take(arena, (size_t)(vectors * each) * sizeof *m->channels.channel);
    m->channels.end = bough_arena_take(arena, (size_t)vectors * sizeof *m->channels.end);
    for (int v = 0; v < vectors; v++) {
        m->channels.end[v] = (v + 1) * each;
        for (int c = 0; c < each; c++) {
            char text[32];
            snprintf(text, sizeof text, measures[k].n > 0 ? "%s%d" : "%s", measures[k].channel[c], v + 1);
            m->channels.channel[v * each + c] = run->channel[run->n_channel++] =
                bough_arena_string(arena, text);
        }
    }
}

// A study of one cell, filled as the reading of a grid would.
static bough_status make_run(bough_arena *arena, const bough_blade_models *s, bough_study *run) {
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    bough_status status = bough_scene_read(arena, NULL, s->turbine, s->run.item, s->run.n, &errors, &scene);
    if (errors.n > 0) bough_errors_print(&errors, stderr);
    if (!bough_is_ok(&status)) return status;
    int n_blade = scene->turbine.n_blade;
    *run = (bough_study){.n_measure = BOUGH_BLADE_MODELS_MEASURES,
                         .duration = scene->simulation.duration,
                         .interval = 5 * scene->simulation.macro_step};
    run->measure = bough_arena_take(arena, BOUGH_BLADE_MODELS_MEASURES * sizeof *run->measure);
    run->channel = bough_arena_take(arena, (size_t)(4 * n_blade + 1) * sizeof *run->channel);
    for (int k = 0; k < BOUGH_BLADE_MODELS_MEASURES; k++) set_measure(arena, k, n_blade, run);
    return status;
}

// -- performing -----------------------------------------------------------------------------------

typedef struct outcome {
    bough_model_blade blade;
    bough_case cell;
    bough_case_result result; // of the first run
    double cpu;               // least of the runs [s]
    double flap, twist;       // largest differences along the blade [m, rad]
    double rest, bent;        // largest relative differences of frequencies
} outcome;

typedef struct comparison {
    const bough_blade_models *study;
    bough_study run;
    bough_study_drive drive;
    bough_study_series reference, series;
    outcome base;
    outcome *outcome; // (n)
} comparison;

static bough_status prepare(bough_arena *arena, comparison *c, const bough_blade_model *model, outcome *o) {
    bough_model_sets sets;
    bough_status status = bough_model_blade_find(arena, c->study, model, &o->blade);
    if (bough_is_ok(&status)) {
        status = bough_model_scene_sets(arena, c->study->turbine, &c->study->run, model, &sets);
    }
    if (!bough_is_ok(&status)) return status;
    o->cell =
        (bough_case){.scene = c->study->turbine, .n_set = sets.n, .set = sets.item, .settings = model->name};
    o->cpu = HUGE_VAL;
    return status;
}

static double frequency_difference(const double *a, const double *b) {
    double largest = 0;
    for (int k = 0; k < BOUGH_BLADE_MODELS_FREQUENCIES; k++) {
        largest = fmax(largest, fabs(a[k] / b[k] - 1));
    }
    return largest;
}

static bough_status compare_blades(const bough_model_blade *base, outcome *o) {
    const bough_model_blade *blade = &o->blade;
    int step = base->n / blade->n;
    if (step * blade->n != base->n) {
        return bough_fail(BOUGH_INVALID, "the reference's %d segments are no multiple of %d of '%s'", base->n,
                          blade->n, o->cell.settings);
    }
    for (int i = 0; i <= blade->n; i++) {
        o->flap = fmax(o->flap, fabs(blade->flap[i] - base->flap[i * step]));
        o->twist = fmax(o->twist, fabs(blade->twist[i] - base->twist[i * step]));
    }
    o->rest = frequency_difference(blade->rest, base->rest);
    o->bent = frequency_difference(blade->bent, base->bent);
    return bough_ok();
}

static bough_status run_once(comparison *c, outcome *o, bough_study_series *series) {
    bough_case_result result;
    c->drive.progress.label = o->cell.settings;
    bough_status status = bough_case_run(&c->run, &o->cell, 1, &c->drive, series, &result);
    if (!bough_is_ok(&status)) return status;
    if (!bough_is_ok(&result.outcome)) {
        return bough_fail(BOUGH_FAILED, "%.60s: %.300s", o->cell.settings, result.outcome.message);
    }
    bough_study_compare(&c->run, series, &c->reference, result.error);
    o->result = result;
    o->cpu = fmin(o->cpu, result.cpu);
    return status;
}

static bough_status measure_all(bough_arena *arena, comparison *c) {
    bough_status status = prepare(arena, c, &c->study->reference, &c->base);
    if (bough_is_ok(&status)) status = run_once(c, &c->base, &c->reference);
    for (int k = 0; k < c->study->n && bough_is_ok(&status); k++) {
        status = prepare(arena, c, &c->study->model[k], &c->outcome[k]);
        if (bough_is_ok(&status)) status = compare_blades(&c->base.blade, &c->outcome[k]);
    }
    for (int turn = 0; turn < c->study->repeat; turn++) {
        for (int k = 0; k < c->study->n && bough_is_ok(&status); k++) {
            status = run_once(c, &c->outcome[k], &c->series);
        }
    }
    return status;
}

// -- report ---------------------------------------------------------------------------------------

#define DEGREES(angle) ((angle) * (180 / 3.14159265358979323846))

static void print_table(const comparison *c, FILE *f) {
    const bough_model_blade *base = &c->base.blade;
    fprintf(f, "%s\nreference: tip %.4f m, twist %.4f deg, f1 %.5f Hz, f12 %.4f Hz; %.2f s of CPU\n",
            c->study->title, base->flap[base->n], DEGREES(base->twist[base->n]), base->rest[0],
            base->rest[BOUGH_BLADE_MODELS_FREQUENCIES - 1], c->base.cpu);
    fprintf(f,
            "%-22s %6s | clamped blade: largest differences       | run: largest differences"
            "             CPU\n",
            "", "states");
    fprintf(f, "%-22s %6s | %8s %8s %9s %9s   | %8s %8s %8s %9s %6s\n", "", "", "tip (%)", "twist (°)",
            "f1-12 (%)", "bent (%)", "tip (m)", "twist (°)", "speed(rpm)", "(s)", "ratio");
    for (int k = 0; k < c->study->n; k++) {
        const outcome *o = &c->outcome[k];
        fprintf(f, "%-22.22s %6d | %8.3f %8.4f %9.3f %9.3f   | %8.4f %8.4f %9.5f %9.3f %6.2f\n",
                o->cell.settings, o->blade.n_state, 100 * o->flap / fabs(base->flap[base->n]),
                DEGREES(o->twist), 100 * o->rest, 100 * o->bent, o->result.error[0], o->result.error[1],
                o->result.error[2], o->cpu, o->cpu / c->outcome[0].cpu);
    }
}

static void write_frequencies(FILE *f, const char *name, const bough_model_blade *b) {
    bough_csv_text(f, name);
    fprintf(f, ",%d,%.9g,%.9g", b->n_state, b->flap[b->n], DEGREES(b->twist[b->n]));
    for (int k = 0; k < BOUGH_BLADE_MODELS_FREQUENCIES; k++) fprintf(f, ",%.9g", b->rest[k]);
    for (int k = 0; k < BOUGH_BLADE_MODELS_FREQUENCIES; k++) fprintf(f, ",%.9g", b->bent[k]);
}

static void write_rows(const void *self, FILE *f) {
    const comparison *c = self;
    fputs("model,states,tip (m),twist (deg)", f);
    for (int k = 0; k < BOUGH_BLADE_MODELS_FREQUENCIES; k++) fprintf(f, ",f%d (Hz)", k + 1);
    for (int k = 0; k < BOUGH_BLADE_MODELS_FREQUENCIES; k++) fprintf(f, ",bent f%d (Hz)", k + 1);
    fputs(",largest flap difference (m),largest twist difference (deg),run tip difference (m),"
          "run twist difference (deg),run speed difference (rpm),CPU (s)\n",
          f);
    write_frequencies(f, "reference", &c->base.blade);
    fprintf(f, ",0,0,0,0,0,%.6g\n", c->base.cpu);
    for (int k = 0; k < c->study->n; k++) {
        const outcome *o = &c->outcome[k];
        write_frequencies(f, o->cell.settings, &o->blade);
        fprintf(f, ",%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", o->flap, DEGREES(o->twist), o->result.error[0],
                o->result.error[1], o->result.error[2], o->cpu);
    }
}

bough_status bough_blade_models_perform(bough_arena *arena, const void *study,
                                        const bough_verification_options *options) {
    comparison c = {.study = study};
    BOUGH_TRY(make_run(arena, c.study, &c.run));
    BOUGH_TRY(bough_folder_make(options->folder));
    c.run.threads = options->threads;
    c.drive.stop = options->stop;
    c.drive.progress = bough_progress_start(0, c.run.duration, options->quiet);
    c.reference = bough_study_series_take(arena, &c.run);
    c.series = bough_study_series_take(arena, &c.run);
    c.outcome = bough_arena_take(arena, (size_t)c.study->n * sizeof *c.outcome);
    bough_status status = measure_all(arena, &c);
    bough_progress_clear(&c.drive.progress);
    if (bough_is_ok(&status))
        status = bough_folder_write(options->folder, "blade-models.csv", write_rows, &c);
    if (bough_is_ok(&status)) print_table(&c, options->stream);
    return status;
}
