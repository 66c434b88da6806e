#include "tests/verification/two_mass_study.h"

#include "apps/bough/cases/perform.h"
#include "apps/bough/config/schema.h"
#include "apps/bough/results/folder.h"
#include "tests/verification/map.h"
#include "tests/verification/two_mass.h"

#include <math.h>
#include <string.h>

enum { DEGREES = 3, STEPS = 3, COLUMNS = 64, FINER = 8 };
static const double limit_tolerance = 0.02, error_tolerance = 0.02, order_tolerance = 0.1;

typedef struct variant {
    const bough_node *node;
    const char *name;
    int cut;            // bough_cut
    const char *scheme; // one of bough_scheme_name
    int n_degree;
    double *degree; // (n_degree) polynomial degrees; of schemes without one 0
    int n_limit, n_error;
    double *limit; // (n_limit) expected largest macro step per degree; 0: none in the scan [s]
    double *error; // (n_error) expected per degree and macro step [m]
} variant;

typedef struct model {
    const bough_node *node;
    const char *name;
    double mass[2], stiffness[3], damping[3], start[4];
    double duration;
    double scan[2]; // macro steps [s]
    double macro_step[STEPS];
    int n_variant;
    variant *variants; // (n_variant)
} model;

typedef struct bough_two_mass_study {
    const bough_node *node;
    const char *title;
    int kind;
    int n_model;
    model *models; // (n_model)
} two_mass_study;

// What one variant and degree came to.
typedef struct result {
    double limit;        // 0: stable over the whole scan [s]
    double error[STEPS]; // NaN when the run failed [m]
    double order;
    bool limit_good, error_good;
    double radius[COLUMNS]; // spectral radius over the scan
} result;

// -- reading --------------------------------------------------------------------------------------

static void check_variant(bough_schema_reader *r, void *item) {
    const variant *v = item;
    if (!bough_scheme_find(v->scheme)) {
        const char *names[16];
        int n = 0;
        while (n < 16 && (names[n] = bough_scheme_name(n)) != NULL) n++;
        const char *near = bough_nearest(v->scheme, names, n);
        bough_schema_error(r, v->node, "scheme", "no scheme '%.40s'%s%s%s", v->scheme,
                           near ? " (did you mean '" : "", near ? near : "", near ? "'?)" : "");
    }
    if (v->n_limit != 0 && v->n_limit != v->n_degree) {
        bough_schema_error(r, v->node, "limits", "expected one for each degree, %d, got %d", v->n_degree,
                           v->n_limit);
    }
    if (v->n_error != 0 && v->n_error != STEPS * v->n_degree) {
        bough_schema_error(r, v->node, "errors", "expected %d for each degree, %d, got %d", STEPS,
                           STEPS * v->n_degree, v->n_error);
    }
}

// clang-format off
#define COUNT(table) (int)(sizeof(table) / sizeof(table)[0])
#define CHOICES(...) (const char *const[]){__VA_ARGS__, NULL}

#define AT(member) .offset = offsetof(variant, member)
static const bough_key variant_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name), .help = "heads its lines"},
    {.name = "cut", .kind = BOUGH_KEY_CHOICE,
     .choices = CHOICES("force-displacement", "displacement-displacement", "force-force"),
     .fallback = "force-displacement", AT(cut), .help = "what mass 1 and mass 2 receive"},
    {.name = "scheme", .kind = BOUGH_KEY_TEXT, .required = true, AT(scheme),
     .help = "coupling scheme"},
    {.name = "degrees", .kind = BOUGH_KEY_NUMBERS, .range = "[0, 2]", .count = 1,
     .fallback = "[0, 1, 2]", AT(degree), .count_offset = offsetof(variant, n_degree),
     .help = "of the polynomials"},
    {.name = "limits", .kind = BOUGH_KEY_NUMBERS, .range = ">= 0", .count = 1, AT(limit),
     .count_offset = offsetof(variant, n_limit),
     .help = "expected largest stable macro step per degree, 0: none in the scan [s]"},
    {.name = "errors", .kind = BOUGH_KEY_NUMBERS, .range = "> 0", .count = 1, AT(error),
     .count_offset = offsetof(variant, n_error),
     .help = "expected errors per degree at the macro steps [m]"},
};
#undef AT
static const bough_schema variant_schema = {
    .name = "a variant", .size = sizeof(variant), .n_key = COUNT(variant_keys),
    .key = variant_keys, .check = check_variant};

#define AT(member) .offset = offsetof(model, member)
static const bough_key model_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name), .help = "heads its lines"},
    {.name = "masses", .kind = BOUGH_KEY_VECTOR, .count = 2, .range = "> 0", .required = true,
     AT(mass), .help = "kg"},
    {.name = "stiffness", .kind = BOUGH_KEY_VECTOR, .count = 3, .range = ">= 0", .required = true,
     AT(stiffness), .help = "wall to mass 1, between the masses, mass 2 to wall [N/m]"},
    {.name = "damping", .kind = BOUGH_KEY_VECTOR, .count = 3, .range = ">= 0", .required = true,
     AT(damping), .help = "likewise [N s/m]"},
    {.name = "start", .kind = BOUGH_KEY_VECTOR, .count = 4, .fallback = "[0, 0, 0.5, 0]", AT(start),
     .help = "x1, v1, x2, v2 at time 0 [m, m/s]"},
    {.name = "duration", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .fallback = "10 s", AT(duration), .help = "of the runs"},
    {.name = "macro_steps", .kind = BOUGH_KEY_VECTOR, .count = STEPS, .range = "> 0",
     .fallback = "[0.04, 0.02, 0.01]", AT(macro_step), .help = "of the runs, each half the last [s]"},
    {.name = "scan", .kind = BOUGH_KEY_VECTOR, .count = 2, .range = "> 0",
     .fallback = "[0.02, 0.6]", AT(scan), .help = "macro steps judged by eigenvalues, from, to [s]"},
    {.name = "variants", .kind = BOUGH_KEY_LIST, .of = &variant_schema, .count = 1,
     .required = true, AT(variants), .count_offset = offsetof(model, n_variant),
     .help = "schemes and cuts"},
};
#undef AT
static const bough_schema model_schema = {
    .name = "a model", .size = sizeof(model), .n_key = COUNT(model_keys), .key = model_keys};

#define AT(member) .offset = offsetof(two_mass_study, member)
static const bough_key study_keys[] = {
    {.name = "title", .kind = BOUGH_KEY_TEXT, .fallback = "Two masses", AT(title),
     .help = "one line: what is asked"},
    {.name = "kind", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("two-mass"), .required = true,
     AT(kind), .help = "two-mass: schemes on two masses and three springs"},
    {.name = "models", .kind = BOUGH_KEY_LIST, .of = &model_schema, .count = 1, .required = true,
     AT(models), .count_offset = offsetof(two_mass_study, n_model), .help = "one after the other"},
};
#undef AT
static const bough_schema study_schema = {
    .name = "a study", .size = sizeof(two_mass_study), .n_key = COUNT(study_keys),
    .key = study_keys};
// clang-format on

void *bough_two_mass_read(bough_arena *arena, const char *path, const bough_node *root,
                          bough_errors *errors) {
    (void)path;
    two_mass_study *s = bough_arena_take(arena, sizeof *s);
    if (!s) return NULL;
    bough_schema_reader reader = {.arena = arena, .errors = errors, .directory = ""};
    bough_schema_read(&reader, &study_schema, root, s);
    return s;
}

// -- one variant ----------------------------------------------------------------------------------

static bough_two_mass two_masses(const model *m, const variant *v) {
    bough_two_mass x = {.s1 = {m->mass[0], m->stiffness[0], m->damping[0]},
                        .s2 = {m->mass[1], m->stiffness[2], m->damping[2]},
                        .k = m->stiffness[1],
                        .c = m->damping[1],
                        .cut = (bough_cut)v->cut};
    memcpy(x.y0, m->start, sizeof x.y0);
    return x;
}

static bough_master_def definition(const model *m, const variant *v, int degree, double macro_step) {
    bough_master_def def = bough_master_def_default();
    def.scheme.name = v->scheme;
    def.scheme.order = degree;
    def.scheme.theta = 0.5; // also where a scene would be refused
    def.scheme.exchange = BOUGH_EXCHANGE_END_VALUES;
    def.scheme.tolerance = 1e-11;
    def.macro_step = macro_step;
    def.duration = m->duration;
    return def;
}

static bool stable(double radius) { return radius <= 1 + 1e-9; }

// The scan, finer than the picture; the first crossing of 1 is interpolated. A step that fails is
// unstable. Judged schemes are built once: building judges, and what they do does not depend on it.
static bough_status scan(const model *m, const variant *v, int degree, result *r) {
    int n = COLUMNS * FINER;
    double factor = pow(m->scan[1] / m->scan[0], 1.0 / (n - 1)), before = 0;
    bool once = bough_scheme_find(v->scheme)->judged;
    bough_two_mass x = two_masses(m, v);
    bough_status status =
        bough_two_mass_build(bough_arena_create(), &x, definition(m, v, degree, m->scan[0]));
    for (int k = 0; k < n && bough_is_ok(&status); k++) {
        double h = m->scan[0] * pow(factor, k), radius;
        bough_status step = bough_two_mass_radius(&x, h, &radius);
        if (!bough_is_ok(&step)) radius = HUGE_VAL;
        if (k % FINER == 0) r->radius[k / FINER] = radius;
        if (r->limit == 0 && !stable(radius)) {
            double part = k > 0 && isfinite(radius) ? (radius - 1) / (radius - before) : 0;
            r->limit = h * pow(factor, -part);
        }
        before = radius;
        if (once || k == n - 1) continue;
        bough_arena_destroy(x.arena);
        status = bough_two_mass_build(bough_arena_create(), &x, definition(m, v, degree, h * factor));
    }
    bough_arena_destroy(x.arena);
    return status;
}

static void run(const model *m, const variant *v, int degree, int step, result *r) {
    bough_two_mass x = two_masses(m, v);
    r->error[step] = (double)NAN;
    bough_status status =
        bough_two_mass_build(bough_arena_create(), &x, definition(m, v, degree, m->macro_step[step]));
    if (bough_is_ok(&status)) {
        bough_two_mass_history(&x);
        status = bough_two_mass_error(&x, &r->error[step]);
    }
    if (!bough_is_ok(&status)) r->error[step] = (double)NAN;
    bough_arena_destroy(x.arena);
}

static bool near(double value, double expected, double tolerance) {
    return fabs(value - expected) <= tolerance * fabs(expected);
}

static void judge(const model *m, const variant *v, int row, result *r) {
    const double *expected = v->n_error > 0 ? v->error + STEPS * row : NULL;
    r->limit_good = v->n_limit == 0 || near(r->limit, v->limit[row], limit_tolerance);
    r->order = log(r->error[STEPS - 2] / r->error[STEPS - 1]) /
               log(m->macro_step[STEPS - 2] / m->macro_step[STEPS - 1]);
    r->error_good = true;
    for (int k = 0; k < STEPS; k++) {
        if (expected && !near(r->error[k], expected[k], error_tolerance)) r->error_good = false;
    }
    if (!expected) return;
    double order = log(expected[STEPS - 2] / expected[STEPS - 1]) /
                   log(m->macro_step[STEPS - 2] / m->macro_step[STEPS - 1]);
    if (!(fabs(r->order - order) <= order_tolerance)) r->error_good = false;
}

// -- report ---------------------------------------------------------------------------------------

typedef struct report {
    const bough_verification_options *options;
    FILE *csv;
    bough_map map;
    int n, failed;
} report;

static void put_line(const model *m, const variant *v, int row, const result *r, report *out) {
    FILE *f = out->options->stream;
    fprintf(f, "%-14.14s %-24.24s %.0f  ", m->name, v->name, v->degree[row]);
    fprintf(f, r->limit > 0 ? "%8.4g" : "    none", r->limit);
    fprintf(f, v->n_limit > 0 ? " (%8.4g)" : "           ", v->n_limit > 0 ? v->limit[row] : 0);
    for (int k = 0; k < STEPS; k++) fprintf(f, "  %8.2e", r->error[k]);
    fprintf(f, "  %5.2f  %s%s%s\n", r->order, r->limit_good && r->error_good ? "pass" : "FAIL",
            r->limit_good ? "" : " limit", r->error_good ? "" : " error");
    fflush(f);
}

static void write_line(const model *m, const variant *v, int row, const result *r, FILE *csv) {
    bough_csv_text(csv, m->name);
    fputc(',', csv);
    bough_csv_text(csv, v->name);
    fprintf(csv, ",%.0f,%.9g,", v->degree[row], r->limit);
    if (v->n_limit > 0) fprintf(csv, "%.9g", v->limit[row]);
    for (int k = 0; k < STEPS; k++) {
        fprintf(csv, ",%.9g,%.9g,", m->macro_step[k], r->error[k]);
        if (v->n_error > 0) fprintf(csv, "%.9g", v->error[STEPS * row + k]);
    }
    fprintf(csv, ",%.4g,%s\n", r->order, r->limit_good && r->error_good ? "pass" : "fail");
}

static void paint(const model *m, const result *r, bough_map_cell *cell, int n_column) {
    for (int k = 0; k < n_column; k++) {
        double h = m->scan[0] * pow(m->scan[1] / m->scan[0], (double)(k * FINER) / (COLUMNS * FINER - 1));
        cell[k].kind = stable(r->radius[k]) ? BOUGH_MAP_GOOD : BOUGH_MAP_STOPPED;
        cell[k].shade = 0.3 + 0.7 * fmin(1, (1 - r->radius[k]) / 0.1);
        snprintf(cell[k].text, sizeof cell[k].text, "%.4f", h);
    }
}

static bough_status perform_row(bough_arena *arena, const model *m, const variant *v, int row, report *out) {
    result r = {0};
    char name[80];
    bough_status status = scan(m, v, (int)v->degree[row], &r);
    if (!bough_is_ok(&status)) return status;
    for (int k = 0; k < STEPS; k++) run(m, v, (int)v->degree[row], k, &r);
    judge(m, v, row, &r);
    put_line(m, v, row, &r, out);
    write_line(m, v, row, &r, out->csv);
    snprintf(name, sizeof name, "%.24s %.32s, degree %.0f", m->name, v->name, v->degree[row]);
    out->map.row[out->map.n_row] = bough_arena_string(arena, name);
    paint(m, &r, out->map.cell + out->map.n_row++ * COLUMNS, COLUMNS);
    out->n++;
    out->failed += !(r.limit_good && r.error_good);
    return status;
}

static bough_status perform_model(bough_arena *arena, const model *m, report *out) {
    bough_status status = bough_ok();
    for (int i = 0; i < m->n_variant; i++) {
        for (int row = 0; row < m->variants[i].n_degree && bough_is_ok(&status); row++) {
            if (out->options->stop && out->options->stop()) {
                return bough_fail(BOUGH_INTERRUPTED, "interrupted");
            }
            status = perform_row(arena, m, &m->variants[i], row, out);
        }
        out->map.row[out->map.n_row++] = NULL;
    }
    return status;
}

static bough_status take_map(bough_arena *arena, const two_mass_study *s, bough_map *map) {
    int rows = 0;
    for (int i = 0; i < s->n_model; i++) rows += (DEGREES + 1) * s->models[i].n_variant;
    *map = (bough_map){.title = s->title,
                       .legend = "blue: stable, darker the more it damps; red: unstable",
                       .across = "macro step of the scan, from its lower to its upper end",
                       .n_column = COLUMNS,
                       .column_width = 10};
    map->row = bough_arena_take(arena, (size_t)rows * sizeof *map->row);
    map->column = bough_arena_take(arena, COLUMNS * sizeof *map->column);
    map->cell = bough_arena_take(arena, (size_t)rows * COLUMNS * sizeof *map->cell);
    for (int k = 0; k < COLUMNS && map->column; k++) map->column[k] = "";
    return bough_ok();
}

static bough_status perform_all(bough_arena *arena, const two_mass_study *s, report *out) {
    fprintf(out->options->stream,
            "%-14s %-24s k  limit [s] (expected)  largest errors [m]            order\n", "model", "variant");
    fputs("model,variant,degree,limit [s],expected [s],macro step [s],error [m],expected [m],"
          "macro step [s],error [m],expected [m],macro step [s],error [m],expected [m],order,verdict\n",
          out->csv);
    bough_status status = take_map(arena, s, &out->map);
    for (int i = 0; i < s->n_model && bough_is_ok(&status); i++) {
        status = perform_model(arena, &s->models[i], out);
    }
    if (bough_is_ok(&status)) status = bough_map_write(&out->map, out->options->folder, "plot.svg");
    fprintf(out->options->stream, "%d of %d hold\n", out->n - out->failed, out->n);
    return status;
}

bough_status bough_two_mass_perform(bough_arena *arena, const void *study,
                                    const bough_verification_options *options) {
    char path[BOUGH_PATH_MAX];
    report out = {.options = options};
    BOUGH_TRY(bough_folder_make(options->folder));
    BOUGH_TRY(bough_folder_open(options->folder, "two-mass.csv", path, &out.csv));
    bough_status status = perform_all(arena, study, &out);
    bough_status written = bough_folder_commit(path, out.csv);
    if (!bough_is_ok(&status)) return status;
    if (!bough_is_ok(&written) || out.failed == 0) return written;
    return bough_fail(BOUGH_FAILED, "%d of %d figures are not the expected ones", out.failed, out.n);
}
