#include "tests/verification/added_mass.h"

#include "apps/bough/cases/perform.h"
#include "apps/bough/config/schema.h"
#include "apps/bough/results/folder.h"
#include "tests/verification/map.h"
#include "tests/verification/two_mass.h"

#include <math.h>
#include <string.h>

enum { ACCELERATORS = 5, MOST = 16, MOST_EVALUATIONS = 500, DIVERGED = 0 };

// A map whose components answer with these ratios.
typedef struct ratios {
    const bough_node *node;
    int n, n_expected;
    double *ratio;    // (n)
    double *expected; // (n_expected) evaluations per accelerator; 0: diverges
    double spread;    // of the expected, relative
} ratios;

typedef struct bough_added_mass_study {
    const bough_node *node;
    const char *title;
    int kind;
    int n_map, n_ratio;
    ratios *map;       // (n_map)
    double *ratio;     // (n_ratio) of the coupled runs
    double macro_step; // [s]
    double turn;       // of the coupling spring's oscillation in a macro step [rad]
    int steps;
} added_mass_study;

// Ways to couple the runs.
typedef struct way {
    const char *name, *scheme;
    bough_acceleration accelerator;
    bough_exchange exchange;
    bool must_hold; // at any ratio
} way;

#define ENDS BOUGH_EXCHANGE_END_VALUES
#define WAVE BOUGH_EXCHANGE_WAVEFORM
static const way ways[] = {
    {"gauss-seidel", "gauss-seidel", BOUGH_ACCELERATE_NONE, ENDS, false},
    {"iterated, none", "iterated", BOUGH_ACCELERATE_NONE, ENDS, false},
    {"iterated, relaxation", "iterated", BOUGH_ACCELERATE_RELAXATION, ENDS, false},
    {"iterated, aitken", "iterated", BOUGH_ACCELERATE_AITKEN, ENDS, false},
    {"iterated, iqn-ils", "iterated", BOUGH_ACCELERATE_IQN_ILS, ENDS, true},
    {"iterated, interface-newton", "iterated", BOUGH_ACCELERATE_NEWTON, ENDS, true},
    {"waveform, iqn-ils", "iterated", BOUGH_ACCELERATE_IQN_ILS, WAVE, true},
    {"waveform, interface-newton", "iterated", BOUGH_ACCELERATE_NEWTON, WAVE, true},
    {"ramp", "ramp", BOUGH_ACCELERATE_NONE, ENDS, false},
    {"monolithic", "monolithic", BOUGH_ACCELERATE_NONE, ENDS, true},
};
#undef ENDS
#undef WAVE
enum { WAYS = sizeof ways / sizeof *ways };

// -- reading --------------------------------------------------------------------------------------

static void check_map(bough_schema_reader *r, void *item) {
    const ratios *m = item;
    if (m->n > MOST) bough_schema_error(r, m->node, "ratios", "expected at most %d", MOST);
    if (m->n_expected == 0 || m->n_expected == ACCELERATORS) return;
    bough_schema_error(r, m->node, "evaluations", "expected %d numbers, one for each accelerator",
                       ACCELERATORS);
}

static void check_study(bough_schema_reader *r, void *item) {
    const added_mass_study *s = item;
    if (s->n_ratio > MOST) bough_schema_error(r, s->node, "ratios", "expected at most %d", MOST);
}

// clang-format off
#define COUNT(table) (int)(sizeof(table) / sizeof(table)[0])
#define CHOICES(...) (const char *const[]){__VA_ARGS__, NULL}

#define AT(member) .offset = offsetof(ratios, member)
static const bough_key map_keys[] = {
    {.name = "ratios", .kind = BOUGH_KEY_NUMBERS, .range = "> 0", .count = 1, .required = true,
     AT(ratio), .count_offset = offsetof(ratios, n), .help = "one for each component"},
    {.name = "evaluations", .kind = BOUGH_KEY_NUMBERS, .range = ">= 0", .count = 1, AT(expected),
     .count_offset = offsetof(ratios, n_expected),
     .help = "expected: plain, relaxation 0.5, Aitken, IQN-ILS, Newton; 0: diverges"},
    {.name = "spread", .kind = BOUGH_KEY_NUMBER, .range = "[0, 1]", .fallback = "0", AT(spread),
     .help = "of Aitken's count, which depends on the right side"},
};
#undef AT
static const bough_schema map_schema = {
    .name = "a map", .size = sizeof(ratios), .n_key = COUNT(map_keys), .key = map_keys,
    .check = check_map};

#define AT(member) .offset = offsetof(added_mass_study, member)
static const bough_key study_keys[] = {
    {.name = "title", .kind = BOUGH_KEY_TEXT, .fallback = "Added mass", AT(title),
     .help = "one line: what is asked"},
    {.name = "kind", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("added-mass"), .required = true,
     AT(kind), .help = "added-mass: evaluations that close an interface"},
    {.name = "maps", .kind = BOUGH_KEY_LIST, .of = &map_schema, .count = 1, .required = true,
     AT(map), .count_offset = offsetof(added_mass_study, n_map), .help = "u <- -r u + b"},
    {.name = "ratios", .kind = BOUGH_KEY_NUMBERS, .range = "> 0", .count = 1, .required = true,
     AT(ratio), .count_offset = offsetof(added_mass_study, n_ratio),
     .help = "of the masses in the coupled runs"},
    {.name = "macro_step", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .fallback = "10 ms", AT(macro_step), .help = "of the coupled runs"},
    {.name = "turn", .kind = BOUGH_KEY_NUMBER, .range = "> 0", .fallback = "0.5", AT(turn),
     .help = "of the spring between the masses in a macro step [rad]"},
    {.name = "steps", .kind = BOUGH_KEY_INTEGER, .range = "[1, 100000]", .fallback = "1000",
     AT(steps), .help = "macro steps of the coupled runs"},
};
#undef AT
static const bough_schema study_schema = {
    .name = "a study", .size = sizeof(added_mass_study), .n_key = COUNT(study_keys),
    .key = study_keys, .check = check_study};
// clang-format on

void *bough_added_mass_read(bough_arena *arena, const char *path, const bough_node *root,
                            bough_errors *errors) {
    (void)path;
    added_mass_study *s = bough_arena_take(arena, sizeof *s);
    if (!s) return NULL;
    bough_schema_reader reader = {.arena = arena, .errors = errors, .directory = ""};
    bough_schema_read(&reader, &study_schema, root, s);
    return s;
}

// -- maps -----------------------------------------------------------------------------------------

// x ← (I − ∂H/∂u)⁻¹ x
static void solve_exactly(void *self, double *x) {
    const ratios *m = self;
    for (int i = 0; i < m->n; i++) x[i] /= 1 + m->ratio[i];
}

// Evaluations until the residual is below 1e-10, from u = 0 with b = 1.
static bough_status evaluate(ratios *m, bough_acceleration kind, int *evaluations) {
    double u[MOST] = {0}, image[MOST];
    bough_accelerator_def def = {
        .kind = kind, .n = m->n, .relaxation = 0.5, .solve = solve_exactly, .self = m};
    bough_arena *arena = bough_arena_create();
    if (!arena) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    bough_accelerator *a = bough_accelerator_create(arena, &def);
    *evaluations = DIVERGED;
    for (int count = 1; count < MOST_EVALUATIONS; count++) {
        for (int i = 0; i < m->n; i++) image[i] = 1 - m->ratio[i] * u[i];
        bool closed = bough_accelerator_take(a, u, image) < 1e-10;
        if (closed) *evaluations = count;
        if (closed || bough_accelerator_diverges(a)) break;
        bough_accelerator_next(a, u);
    }
    bough_arena_destroy(arena);
    return bough_ok();
}

// -- coupled runs ---------------------------------------------------------------------------------

typedef struct outcome {
    double sweeps; // per macro step; 1 where the scheme does not iterate
    double error;  // of either position over the run, relative to the start [1]
    bough_status status;
    double time; // reached [s]
    char verdict[BOUGH_VERDICT];
} outcome;

// Mass 1 of 1 kg at 1 Hz, damped by 2 %, carries mass 2 on a critically damped spring. It starts as
// if welded: the spring already carries the force that accelerates mass 2.
static bough_two_mass carrier(const added_mass_study *s, double ratio) {
    double omega = s->turn / s->macro_step, own = 6.283185307179586;
    return (bough_two_mass){.s1 = {1, own * own * (1 + ratio), 0.04 * own * (1 + ratio)},
                            .s2 = {ratio, 0, 0},
                            .k = ratio * omega * omega,
                            .c = 2 * ratio * omega,
                            .y0 = {1, 0, 1 + own * own / (omega * omega), 0}};
}

static void run(const added_mass_study *s, const way *w, double ratio, outcome *o) {
    bough_two_mass m = carrier(s, ratio);
    bough_master_def def = bough_master_def_default();
    def.scheme.name = w->scheme;
    def.scheme.accelerator = w->accelerator;
    def.scheme.exchange = w->exchange;
    def.scheme.tolerance = 1e-9;
    def.scheme.iterations = 200;
    def.macro_step = s->macro_step;
    def.duration = s->steps * s->macro_step;
    o->status = bough_two_mass_build(bough_arena_create(), &m, def);
    if (bough_is_ok(&o->status)) o->status = bough_two_mass_error(&m, &o->error);
    if (m.master) {
        o->time = m.master->time;
        o->sweeps = fmax(1, (double)bough_scheme_reported(m.master->coupling).sweeps /
                                fmax(1, (double)m.master->steps));
        memcpy(o->verdict, m.master->verdict, sizeof o->verdict);
    }
    bough_arena_destroy(m.arena);
}

// A run that errs by more than the motion itself, without a word, is silent.
static bool silent(const outcome *o) {
    return bough_is_ok(&o->status) && !(o->error < 0.5) && o->verdict[0] == '\0';
}

// -- report ---------------------------------------------------------------------------------------

typedef struct report {
    const bough_verification_options *options;
    FILE *csv;
    bough_map picture;
    int n, failed;
} report;

static bool as_expected(const ratios *m, int kind, int evaluations) {
    if (m->n_expected == 0) return true;
    double spread = kind == BOUGH_ACCELERATE_AITKEN ? m->spread : 0;
    return fabs(evaluations - m->expected[kind]) <= spread * m->expected[kind];
}

static bough_status perform_maps(const added_mass_study *s, report *out) {
    FILE *f = out->options->stream;
    fprintf(f, "%-32s  plain  relaxation  aitken  iqn-ils  newton   (expected)\n", "u <- -r u + b, r");
    for (int i = 0; i < s->n_map; i++) {
        ratios *m = &s->map[i];
        char name[80] = "";
        for (int k = 0; k < m->n; k++) {
            size_t used = strlen(name);
            snprintf(name + used, sizeof name - used, "%s%g", k ? " " : "", m->ratio[k]);
        }
        fprintf(f, "%-32.32s", name);
        bool good = true;
        for (int kind = 0; kind < ACCELERATORS; kind++) {
            int count = DIVERGED;
            BOUGH_TRY(evaluate(m, (bough_acceleration)kind, &count));
            good = good && as_expected(m, kind, count);
            fprintf(out->csv, "map %s,%s,%d,", name, bough_acceleration_names[kind], count);
            if (m->n_expected > 0) fprintf(out->csv, "%g", m->expected[kind]);
            fprintf(out->csv, ",,%s\n", as_expected(m, kind, count) ? "pass" : "fail");
            fprintf(f, count == DIVERGED ? "     div" : "  %6d", count);
        }
        fputs("   (", f);
        for (int k = 0; k < m->n_expected; k++) fprintf(f, "%s%g", k ? " " : "", m->expected[k]);
        fprintf(f, ") %s\n", good ? "pass" : "FAIL");
        out->n++;
        out->failed += !good;
    }
    return bough_ok();
}

static void paint(const outcome *o, bough_map_cell *cell, bough_arena *arena) {
    bool held = bough_is_ok(&o->status) && o->error < 0.5;
    cell->kind = held ? BOUGH_MAP_GOOD : BOUGH_MAP_STOPPED;
    cell->shade = fmin(1, -log10(fmax(o->error, 1e-6)) / 6);
    if (held) {
        snprintf(cell->text, sizeof cell->text, "%.3g / %.0e", o->sweeps, o->error);
    } else {
        snprintf(cell->text, sizeof cell->text, "%.3g s", o->time);
    }
    const char *text = bough_is_ok(&o->status) ? o->verdict : o->status.message;
    cell->hint = text[0] ? bough_arena_string(arena, text) : NULL;
}

static void perform_run(bough_arena *arena, const added_mass_study *s, int i, int k, report *out) {
    const way *w = &ways[i];
    outcome o = {0};
    run(s, w, s->ratio[k], &o);
    bool held = bough_is_ok(&o.status) && o.error < 0.5;
    bool good = !silent(&o) && (held || !w->must_hold);
    out->n++;
    out->failed += !good;
    fprintf(out->csv, "run %g,%s,%.6g,,%.6g,%s,", s->ratio[k], w->name, o.sweeps, o.error,
            good ? held ? "held" : "stopped" : "fail");
    bough_csv_text(out->csv, bough_is_ok(&o.status) ? o.verdict : o.status.message);
    fputc('\n', out->csv);
    if (held) {
        fprintf(out->options->stream, "  %4.3g/%.0e%s", o.sweeps, o.error, good ? "" : "!");
    } else {
        fprintf(out->options->stream, "  %8.3g s%s", o.time, good ? " " : "!");
    }
    paint(&o, &out->picture.cell[i * s->n_ratio + k], arena);
}

static bough_status perform_runs(bough_arena *arena, const added_mass_study *s, report *out) {
    FILE *f = out->options->stream;
    fprintf(f, "\nruns: sweeps per step / relative error, or when they were stopped; mass ratio\n%-22s", "");
    for (int k = 0; k < s->n_ratio; k++) fprintf(f, "  %10g", s->ratio[k]);
    for (int i = 0; i < WAYS; i++) {
        fprintf(f, "\n%-22s", ways[i].name);
        for (int k = 0; k < s->n_ratio; k++) {
            if (out->options->stop && out->options->stop()) {
                return bough_fail(BOUGH_INTERRUPTED, "interrupted");
            }
            perform_run(arena, s, i, k, out);
            fflush(f);
        }
    }
    fputc('\n', f);
    return bough_map_write(&out->picture, out->options->folder, "plot.svg");
}

static bough_status take_picture(bough_arena *arena, const added_mass_study *s, bough_map *map) {
    *map = (bough_map){.title = s->title,
                       .legend = "sweeps per macro step / relative error; red: stopped, when",
                       .across = "mass hanging on the interface over the mass that carries it",
                       .n_row = WAYS,
                       .n_column = s->n_ratio,
                       .column_width = 86};
    map->row = bough_arena_take(arena, WAYS * sizeof *map->row);
    map->column = bough_arena_take(arena, (size_t)s->n_ratio * sizeof *map->column);
    map->cell = bough_arena_take(arena, (size_t)(WAYS * s->n_ratio) * sizeof *map->cell);
    for (int i = 0; i < WAYS && map->row; i++) map->row[i] = ways[i].name;
    for (int k = 0; k < s->n_ratio && map->column; k++) {
        char text[24];
        snprintf(text, sizeof text, "%g", s->ratio[k]);
        map->column[k] = bough_arena_string(arena, text);
    }
    return bough_ok();
}

bough_status bough_added_mass_perform(bough_arena *arena, const void *study,
                                      const bough_verification_options *options) {
    char path[BOUGH_PATH_MAX];
    report out = {.options = options};
    BOUGH_TRY(take_picture(arena, study, &out.picture));
    BOUGH_TRY(bough_folder_make(options->folder));
    BOUGH_TRY(bough_folder_open(options->folder, "added-mass.csv", path, &out.csv));
    fputs("problem,way,evaluations or sweeps,expected,error [1],verdict,diagnosis\n", out.csv);
    bough_status status = perform_maps(study, &out);
    if (bough_is_ok(&status)) status = perform_runs(arena, study, &out);
    bough_status written = bough_folder_commit(path, out.csv);
    if (!bough_is_ok(&status)) return status;
    fprintf(options->stream, "%d of %d hold\n", out.n - out.failed, out.n);
    if (!bough_is_ok(&written) || out.failed == 0) return written;
    return bough_fail(BOUGH_FAILED, "%d of %d are not as they should be", out.failed, out.n);
}
