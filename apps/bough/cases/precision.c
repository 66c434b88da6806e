// Compared runs: differences, tables and work-precision diagram, and the table of kind stability.
#include "apps/bough/cases/perform.h"

#include "apps/bough/results/folder.h"
#include "apps/bough/results/picture.h"

// -- differences of series ------------------------------------------------------------------------

bough_study_series bough_study_series_take(bough_arena *arena, const bough_study *study) {
    bough_study_series series = {.n_row = (int)(study->duration / study->interval + 1e-6) + 1,
                                 .n_channel = study->n_channel};
    series.value = bough_arena_doubles(arena, (size_t)series.n_row * (size_t)series.n_channel);
    return series;
}

// The larger of the two; NaN if one of them is.
static double larger(double a, double b) { return isnan(b) || b > a ? b : a; }

// Norm of a − b (n); of a where b is NULL.
static double difference(const double *a, const double *b, int n, int norm) {
    double sum = 0, largest = 0;
    for (int i = 0; i < n; i++) {
        double d = b ? a[i] - b[i] : a[i];
        sum += d * d;
        largest = larger(largest, fabs(d));
    }
    return norm == BOUGH_STUDY_EUCLID ? sqrt(sum) : largest;
}

// The largest norm among the vectors of a measure in one row.
static double measured(const bough_study_measure *m, const double *a, const double *b) {
    double largest = 0;
    for (int k = 0, first = 0; k < m->channels.n_vector; first = m->channels.end[k++]) {
        const double *other = b ? b + first : NULL;
        largest = larger(largest, difference(a + first, other, m->channels.end[k] - first, m->norm));
    }
    return largest;
}

void bough_study_norms(const bough_study *study, const double *value, double *norm) {
    for (int i = 0; i < study->n_measure; value += study->measure[i++].channels.n_channel)
        norm[i] = study->measure[i].scale * measured(&study->measure[i], value, NULL);
}

void bough_study_compare(const bough_study *study, const bough_study_series *series,
                         const bough_study_series *reference, double *error) {
    assert(series->filled == series->n_row && reference->filled == series->n_row);
    int first = 0;
    for (int i = 0; i < study->n_measure; first += study->measure[i++].channels.n_channel) {
        const bough_study_measure *m = &study->measure[i];
        error[i] = 0;
        for (int row = 0; row < series->n_row; row++) {
            size_t at = (size_t)row * (size_t)series->n_channel + (size_t)first;
            error[i] = larger(error[i], measured(m, series->value + at, reference->value + at));
        }
        error[i] *= m->scale;
    }
}

// "ok", "failed at t=12.3 s"
static void case_status(const bough_case_result *result, char text[40]) {
    snprintf(text, 40, bough_is_ok(&result->outcome) ? "ok" : "failed at t=%.4g s", result->time);
}

// Rows of the table before the cells.
enum { HEAD = -2, REFERENCE = -1 };

static const bough_case *cell_of(const bough_study *s, int row) {
    return row < 0 ? s->reference_case : &s->cases[row];
}

static const bough_case_result *result_of(const bough_study_results *results, int row) {
    return row < 0 ? results->reference : &results->result[row];
}

// -- rows -----------------------------------------------------------------------------------------

enum { COLUMNS = BOUGH_STUDY_AXES + 2 * BOUGH_STUDY_MEASURES + 12, SHORT = 100 };

// A line of table.txt, or of table.csv, which has keys, all digits and more columns.
typedef struct line {
    bool csv, head;
    int n;
    char field[COLUMNS][sizeof((bough_status *)NULL)->message];
} line;

__attribute__((format(printf, 2, 3))) static void put(line *l, const char *format, ...) {
    BOUGH_PRINT(l->field[l->n], format);
    l->n++;
}

// The text in table.txt is cut at the column's width.
static void put_either(line *l, const char *csv, const char *text) {
    put(l, "%.*s", l->csv ? (int)sizeof *l->field : 40, l->csv ? csv : text);
}

// A number, NaN if it is unknown, or its headings; `text` NULL: only in the CSV.
static void put_number(line *l, const char *csv, const char *text, double value) {
    if (!l->csv && !text) return;
    if (l->head)
        put(l, "%s", l->csv ? csv : text);
    else if (isfinite(value))
        put(l, l->csv ? "%.9g" : "%.3g", value);
    else
        put_either(l, "", "-");
}

static void put_measure(line *l, const bough_study_measure *m, double error, double estimate) {
    char heading[200], estimated[200];
    snprintf(heading, sizeof heading, "%.120s [%.60s]", m->name, m->unit);
    snprintf(estimated, sizeof estimated, "%.120s estimated [%.50s]", m->name, m->unit);
    put_number(l, heading, heading, error);
    put_number(l, estimated, "estimated", estimate);
}

static void put_row(line *l, const bough_study_results *results, int row) {
    const bough_study *s = results->study;
    const bough_case_result *r = result_of(results, row);
    const bough_coupling_report *k = &r->coupling;
    const double none = (double)NAN;
    char number[12], status[40];
    bool failed = !bough_is_ok(&r->outcome), known = l->csv || !failed;
    l->n = 0;
    l->head = row == HEAD;
    case_status(r, status);
    snprintf(number, sizeof number, "%d", row + 1);
    put(l, "%s", l->head ? "run" : row == REFERENCE ? "reference" : number);
    for (int i = 0; i < s->grid.n; i++) {
        const bough_study_axis *axis = &s->grid.axis[i];
        const char *value = bough_study_value(s, cell_of(s, row), i);
        put_either(l, l->head ? axis->key : value, l->head ? axis->label : value[0] ? value : "as the scene");
    }
    put_either(l, l->head ? "status" : failed ? "failed" : status, l->head ? "status" : status);
    put_number(l, "time [s]", NULL, r->time);
    put_number(l, "wall [s]", "wall [s]", r->wall);
    put_number(l, "cpu [s]", "cpu [s]", r->cpu);
    put_number(l, "real_time_factor [1]", "x real time", r->time / r->wall);
    for (int i = 0; i < s->n_measure; i++)
        put_measure(l, &s->measure[i], known ? r->error[i] : none, known ? r->estimate[i] : none);
    put_number(l, "defect_max [1]", NULL, k->defect_max);
    put_number(l, "defect_rms [1]", "defect rms [1]", k->defect_rms);
    if (l->csv)
        put_number(l, "energy_residual [J]", NULL, k->energy_residual);
    else
        put_number(l, NULL, "energy defect [1]",
                   k->energy_exchanged > 0 ? k->energy_residual / k->energy_exchanged : none);
    put_number(l, "energy_exchanged [J]", NULL, k->energy_exchanged);
    if (l->csv) put(l, "%s", l->head ? "diagnosis" : failed ? r->outcome.message : "");
}

// -- text -----------------------------------------------------------------------------------------

static void widen(const line *l, int width[COLUMNS]) {
    for (int i = 0; i < l->n; i++) {
        int w = bough_picture_letters(l->field[i]);
        if (w > width[i]) width[i] = w;
    }
}

// Settings and status are aligned left, numbers right.
static void print_line(const line *l, const int width[COLUMNS], int n_left, FILE *stream) {
    for (int i = 0; i < l->n; i++) {
        int pad = width[i] - bough_picture_letters(l->field[i]);
        bool left = i < n_left;
        fprintf(stream, "%s%*s%s", i ? "  " : "", left ? 0 : pad, "", l->field[i]);
        if (left && i + 1 < l->n) fprintf(stream, "%*s", pad, "");
    }
    fputc('\n', stream);
}

static void print_diagnosis(const char *settings, const bough_case_result *r, FILE *stream) {
    if (bough_is_ok(&r->outcome)) return;
    const char *text = r->outcome.message;
    size_t length = strlen(text);
    bool cut = length > SHORT;
    if (cut) {
        for (length = SHORT; length > 0 && ((unsigned char)text[length] & 0xC0) == 0x80;) length--;
    }
    fprintf(stream, "failed: %s: %.*s%s\n", settings, (int)length, text, cut ? "..." : "");
}

// The first pass finds the width of each column.
static void print_text(const void *self, FILE *stream) {
    const bough_study_results *results = self;
    const bough_study *s = results->study;
    line l = {.csv = false};
    int width[COLUMNS] = {0};
    if (s->title) fprintf(stream, "%s\n", s->title);
    for (int pass = 0; pass < 2; pass++) {
        for (int row = HEAD; row < s->n_case; row++) {
            put_row(&l, results, row);
            if (pass == 0)
                widen(&l, width);
            else
                print_line(&l, width, s->grid.n + 2, stream);
        }
    }
    for (int row = REFERENCE; row < s->n_case; row++)
        print_diagnosis(cell_of(s, row)->settings, result_of(results, row), stream);
}

// -- CSV ------------------------------------------------------------------------------------------

void bough_csv_text(FILE *file, const char *text) {
    bool quoted = strpbrk(text, ",\"\r\n") != NULL;
    if (quoted) fputc('"', file);
    for (const char *c = text; *c; c++) {
        if (*c == '"') fputc('"', file);
        fputc(*c == '\n' || *c == '\r' ? ' ' : *c, file);
    }
    if (quoted) fputc('"', file);
}

void bough_csv_next(FILE *file, const char *text) {
    fputc(',', file);
    bough_csv_text(file, text);
}

static void write_csv(const void *self, FILE *f) {
    const bough_study_results *results = self;
    line l = {.csv = true};
    for (int row = HEAD; row < results->study->n_case; row++) {
        put_row(&l, results, row);
        bough_csv_text(f, l.field[0]);
        for (int i = 1; i < l.n; i++) bough_csv_next(f, l.field[i]);
        fputc('\n', f);
    }
}

// -- files ----------------------------------------------------------------------------------------

static bough_status write_tables(const bough_study_results *results, const char *folder) {
    BOUGH_TRY(bough_folder_write(folder, "table.txt", print_text, results));
    return bough_folder_write(folder, "table.csv", write_csv, results);
}

// -- plot.svg: cost against error -----------------------------------------------------------------

static int along(const bough_study *s) { return s->grid.axis[s->grid.n - 1].value.n; }

static double cost(const bough_case_result *r) { return r->cpu / r->time; }

// A run that equals the reference has no point on a logarithmic axis.
static bool has_point(const bough_case_result *r, int measure) {
    return bough_held(r) && r->error[measure] > 0 && cost(r) > 0;
}

// The settings that distinguish a line from the others, and its runs without a point.
static const char *line_name(bough_arena *arena, const bough_study_results *results, int curve) {
    const bough_study *s = results->study;
    int n = along(s), first = curve * n, last = s->grid.n - 1;
    const char *name = bough_grid_others(arena, s, &s->cases[first], last), *between = " — ";
    if (!name[0]) name = s->grid.axis[last].label;
    for (int i = first; i < first + n; i++) {
        char status[40];
        if (has_point(&results->result[i], 0)) continue;
        case_status(&results->result[i], status);
        name = bough_arena_print(arena, "%s%s%s %s", name, between, bough_study_value(s, &s->cases[i], last),
                                 strcmp(status, "ok") == 0 ? "equals the reference" : status);
        between = "; ";
    }
    return name;
}

static bough_status plot(bough_arena *arena, const bough_study_results *results) {
    const bough_study *s = results->study;
    bough_chart chart = bough_chart_start(arena, s->title ? s->title : s->file, 2);
    for (int m = 0; m < s->n_measure; m++) {
        const char *across =
            bough_arena_print(arena, "largest difference: %s [%s]", s->measure[m].name, s->measure[m].unit);
        bough_chart_add_panel(&chart, "CPU time per simulated second [s]", across, true, true);
        for (int i = 0; i < s->n_case; i++) {
            const bough_case_result *r = &results->result[i];
            int curve = i / along(s);
            const char *name = i % along(s) == 0 ? line_name(arena, results, curve) : NULL;
            if (name) bough_chart_add_line(&chart, (bough_chart_line){name, curve, true, true, 0});
            if (!has_point(r, m)) continue;
            const char *value = bough_study_value(s, &s->cases[i], s->grid.n - 1);
            bough_chart_add(&chart, (bough_chart_point){.x = r->error[m], .y = cost(r), .label = value});
        }
    }
    return bough_folder_write(results->options->folder, "plot.svg", bough_chart_write, &chart);
}

bough_status bough_precision_conclude(bough_arena *arena, const bough_study_results *results) {
    const bough_study_options *o = results->options;
    BOUGH_TRY(write_tables(results, o->folder));
    BOUGH_TRY(plot(arena, results));
    print_text(results, o->stream);
    return bough_ok();
}

// -- kind stability: a cell held, with an error, or stopped with a diagnosis ----------------------

// Errors of the first measure below this may be those of the sub-solvers, which are not estimated.
static const double large = 0.05;

static bool is_silent(const bough_case_result *r) {
    if (!bough_is_ok(&r->outcome) || r->warned || !isfinite(r->error[0])) return false;
    return !(r->error[0] <= 3 * r->estimate[0]) && r->error[0] > large;
}

// "[1, 2, 3]" is shown as "1".
static void shorten(const char *value, char text[24]) {
    snprintf(text, 24, "%s", value + (value[0] == '['));
    text[strcspn(text, ",]")] = '\0';
}

static void print_row_name(const bough_study *s, const bough_case *cell, FILE *f) {
    char text[160] = "";
    size_t used = 0;
    for (int i = 0; i + 1 < s->grid.n && used < sizeof text; i++) {
        char value[24];
        shorten(bough_study_value(s, cell, i), value);
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", i ? ", " : "", value);
    }
    fprintf(f, "\n%-40.40s", text);
}

// "1.2e-03", with ! after a warning before the run and ? if it is silent; of a stopped run the time that it
// reached.
static void print_cell(const bough_case_result *r, FILE *f) {
    char text[24] = "held";
    if (!bough_held(r)) {
        snprintf(text, sizeof text, "%.3g s", r->time);
    } else if (isfinite(r->error[0])) {
        snprintf(text, sizeof text, "%.1e%s", r->error[0], r->warned ? "!" : "");
    }
    fprintf(f, " %8s%s", text, is_silent(r) ? "?" : " ");
}

// A row for each combination of all settings but the last, which varies along the row.
static void print_map(const bough_study_results *x, FILE *f) {
    const bough_study *s = x->study;
    const bough_study_axis *across = &s->grid.axis[s->grid.n - 1];
    fprintf(
        f,
        "%s\n%.60s [%.20s]; !: warning before the run; seconds: stopped with a diagnosis, with its time\n%-40s",
        s->title ? s->title : s->file, s->measure[0].name, s->measure[0].unit, "");
    for (int k = 0; k < across->value.n; k++) fprintf(f, " %9s", across->value.item[k].value);
    for (int i = 0; i < s->n_case; i++) {
        if (i % across->value.n == 0) print_row_name(s, &s->cases[i], f);
        print_cell(&x->result[i], f);
    }
    fputc('\n', f);
}

static bough_status conclude(const bough_study_results *x, FILE *f) {
    int n_held = 0, n_silent = 0, n = x->study->n_case;
    for (int i = 0; i < n; i++) {
        n_held += bough_held(&x->result[i]);
        n_silent += is_silent(&x->result[i]);
    }
    fprintf(f, "%d of %d held, %d stopped with a diagnosis, %d silent\n", n_held, n, n - n_held, n_silent);
    if (n_silent == 0) return bough_ok();
    return bough_fail(BOUGH_FAILED, "%d of %d cells are silent: marked ?", n_silent, n);
}

bough_status bough_stability_conclude(bough_arena *arena, const bough_study_results *x) {
    const bough_study_options *o = x->options;
    (void)arena;
    if (o->parts > 0) {
        fprintf(o->stream, "part %d of %d: %d runs, %d of %d cells still missing\n", o->part, o->parts,
                x->ran, bough_study_missing(x, -1), x->study->n_case);
        return bough_ok();
    }
    BOUGH_TRY(write_tables(x, o->folder));
    print_map(x, o->stream);
    return conclude(x, o->stream);
}
