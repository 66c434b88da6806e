// Kind stability: a cell either held, with an error, or was stopped with a diagnosis.
#include "apps/bough/cases/perform.h"

#include <math.h>
#include <string.h>

// Errors of the first measure below this may be those of the sub-solvers, which are not estimated.
static const double large = 0.05;

static bool is_silent(const bough_case_result *r) {
    if (!bough_is_ok(&r->outcome) || r->warned || !isfinite(r->error[0])) return false;
    return !(r->error[0] <= 3 * r->estimate[0]) && r->error[0] > large;
}

// "[1, 2, 3]" is shown by its first.
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

// "1.2e-03", with ! after a warning before the run and ? where it is silent; the time reached where it
// stopped.
static void print_cell(const bough_case_result *r, FILE *f) {
    char text[24] = "held";
    if (!bough_held(r)) {
        snprintf(text, sizeof text, "%.3g s", r->time);
    } else if (isfinite(r->error[0])) {
        snprintf(text, sizeof text, "%.1e%s", r->error[0], r->warned ? "!" : "");
    }
    fprintf(f, " %8s%s", text, is_silent(r) ? "?" : " ");
}

// A row for each combination of the settings before the last, which runs along it.
static void print(const bough_study_results *x, FILE *f) {
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
    BOUGH_TRY(bough_precision_tables(x, o->folder));
    print(x, o->stream);
    return conclude(x, o->stream);
}
