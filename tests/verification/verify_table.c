// The cases of a study of kind verify one after the other: what holds and what does not.
#include "tests/verification/verify.h"

#include "apps/bough/cases/perform.h"
#include "apps/bough/results/folder.h"
#include "apps/bough/results/progress.h"

// What an expectation came to.
typedef struct verdict {
    double result, error, tolerance; // error: relative where the tolerance is
    double order;                    // observed over the three finest meshes; NaN: not seen
    bool relative, holds;
} verdict;

typedef struct report {
    const bough_verification_options *options;
    FILE *csv;
    int n, failed;
} report;

// -- judgement ------------------------------------------------------------------------------------

// Differences far below the tolerance are rounding.
static double observed_order(const bough_verify_case *x, const double *v, double tolerance) {
    int last = x->n_mesh - 1;
    if (last < 2) return NAN;
    double before = v[last - 1] - v[last - 2], after = v[last] - v[last - 1];
    if (fabs(after) <= fmax(1e-11 * fabs(v[last]), 0.02 * tolerance)) return NAN;
    return log(fabs(before / after)) / log(x->mesh[last] / x->mesh[last - 1]);
}

// v: on each mesh.
static verdict judge_value(const bough_verify_case *x, const bough_verify_expect *e, const double *v) {
    int last = x->n_mesh > 0 ? x->n_mesh - 1 : 0;
    verdict d = {.result = v[last], .relative = e->relative > 0};
    if (e->extrapolate) {
        double ratio = x->mesh[last] / x->mesh[last - 1];
        d.result += (v[last] - v[last - 1]) / (ratio * ratio - 1);
    }
    d.tolerance = d.relative ? e->relative : e->absolute;
    d.order = observed_order(x, v, d.relative ? e->relative * fabs(e->value) : e->absolute);
    d.error = fabs(d.result - e->value) / (d.relative ? fabs(e->value) : 1);
    d.holds = d.error <= d.tolerance; // not with NaN
    return d;
}

static bool judge_diagnosis(const bough_verify_expect *e, const bough_verify_result *last) {
    return last->outcome.code == BOUGH_FAILED && strstr(last->outcome.message, e->diagnosis);
}

static verdict judge(const bough_verify_case *x, int i, const bough_verify_result *result) {
    const bough_verify_expect *e = &x->expect[i];
    int n = x->n_mesh > 0 ? x->n_mesh : 1;
    double v[BOUGH_VERIFY_MESHES];
    if (e->diagnosis) {
        return (verdict){
            .result = NAN, .error = NAN, .order = NAN, .holds = judge_diagnosis(e, &result[n - 1])};
    }
    for (int k = 0; k < n; k++) { // a run that ended early has not shown it
        v[k] = NAN;
        if (bough_is_ok(&result[k].outcome)) v[k] = e->scale * result[k].value[i];
    }
    return judge_value(x, e, v);
}

// -- table ----------------------------------------------------------------------------------------

static void print_head(FILE *stream) {
    fprintf(stream, "%-36s %-34s %13s %13s %9s %6s %11s\n", "case", "quantity", "reference", "result",
            "error", "order", "tolerance");
}

static void print_line(FILE *stream, const bough_verify_case *x, int i, const verdict *d) {
    const bough_verify_expect *e = &x->expect[i];
    const char *word = d->holds ? "pass" : "FAIL";
    char order[16] = "-", tolerance[32];
    if (e->diagnosis) {
        fprintf(stream, "%-36.36s says '%.78s' %s\n", x->name, e->diagnosis, word);
        return;
    }
    if (isfinite(d->order)) snprintf(order, sizeof order, "%.2f", d->order);
    snprintf(tolerance, sizeof tolerance, "%.1e%s", d->tolerance, d->relative ? " of" : "   ");
    fprintf(stream, "%-36.36s %-34.34s %13.7g %13.7g %9.1e %6s %11s  %s\n", x->name, e->name, e->value,
            d->result, d->error, order, tolerance, word);
}

static void write_line(FILE *csv, const bough_verify_case *x, int i, const verdict *d, double wall) {
    const bough_verify_expect *e = &x->expect[i];
    bough_csv_text(csv, x->name);
    fputc(',', csv);
    bough_csv_text(csv, e->diagnosis ? e->diagnosis : e->name);
    fprintf(csv, ",%.12g,%.12g,%.3g,%.3g,%.3g,%s,%s,%.3g\n", e->value, d->result, d->error, d->order,
            d->tolerance, d->relative ? "relative" : "absolute", d->holds ? "pass" : "fail", wall);
}

// -- cases ----------------------------------------------------------------------------------------

static bool expects_diagnosis(const bough_verify_case *x) {
    for (int i = 0; i < x->n_expect; i++) {
        if (x->expect[i].diagnosis) return true;
    }
    return false;
}

static void report_case(const bough_verify_case *x, const bough_verify_result *result, double wall,
                        report *r) {
    int n = x->n_mesh > 0 ? x->n_mesh : 1;
    for (int i = 0; i < x->n_expect; i++) {
        verdict d = judge(x, i, result);
        r->n++;
        r->failed += !d.holds;
        print_line(r->options->stream, x, i, &d);
        write_line(r->csv, x, i, &d, wall);
    }
    for (int k = 0; k < n; k++) {
        if (bough_is_ok(&result[k].outcome)) continue;
        bool own = expects_diagnosis(x);
        fprintf(r->options->stream, "    %s%.300s\n", own ? "" : "failed: ", result[k].outcome.message);
    }
    fflush(r->options->stream);
}

// A failure of the case is a result; being stopped is not.
static bough_status perform_case(bough_arena *arena, const bough_verify_case *x, report *r) {
    bough_verify_result result[BOUGH_VERIFY_MESHES];
    double began = bough_wall_clock();
    for (int k = 0; k < (x->n_mesh > 0 ? x->n_mesh : 1); k++) {
        bough_verify_run(arena, x, k, r->options->stop, &result[k]);
        bough_code code = result[k].outcome.code;
        if (code == BOUGH_INTERRUPTED || code == BOUGH_OUT_OF_MEMORY) return result[k].outcome;
    }
    report_case(x, result, bough_wall_clock() - began, r);
    return bough_ok();
}

static bough_status perform_all(bough_arena *arena, const bough_verify *v, report *r) {
    bough_status status = bough_ok();
    double began = bough_wall_clock();
    print_head(r->options->stream);
    fputs("case,quantity,reference,result,error,order,tolerance,kind,verdict,case wall (s)\n", r->csv);
    for (int i = 0; i < v->n_case && bough_is_ok(&status); i++)
        BOUGH_TRY(perform_case(arena, &v->cases[i], r));
    fprintf(r->options->stream, "%d of %d hold, %d cases in %.1f s\n", r->n - r->failed, r->n, v->n_case,
            bough_wall_clock() - began);
    return status;
}

bough_status bough_verify_perform(bough_arena *arena, const void *study,
                                  const bough_verification_options *options) {
    char path[BOUGH_PATH_MAX];
    report r = {.options = options};
    BOUGH_TRY(bough_folder_make(options->folder));
    BOUGH_TRY(bough_folder_open(options->folder, "verify.csv", path, &r.csv));
    bough_status status = perform_all(arena, study, &r);
    bough_status written = bough_folder_close(path, r.csv, bough_ok());
    if (!bough_is_ok(&status)) return status;
    if (!bough_is_ok(&written)) return written;
    if (r.failed == 0) return status;
    return bough_fail(BOUGH_FAILED, "%d of %d expectations do not hold", r.failed, r.n);
}
