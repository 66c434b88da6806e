#include "apps/study/case_file.h"

#include "apps/output/folder.h"
#include "core/input_file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static bough_status path_of(const char *folder, int number, char path[BOUGH_PATH_MAX]) {
    char name[48];
    snprintf(name, sizeof name, "cases/%06d.case", number + 1);
    return bough_folder_path(folder, name, path);
}

// -- writing --------------------------------------------------------------------------------------

static void put(FILE *f, double x) { fprintf(f, " %.17g", x); }

static void put_levels(FILE *f, const char *name, const bough_levels *l) {
    fprintf(f, "%s %d %d %" PRId64 " %" PRId64 "", name, l->started, l->exponent, l->low, l->high);
    for (int64_t k = l->low; l->started && k <= l->high; k++) put(f, bough_levels_inside(l, k));
    for (int64_t k = l->low; l->started && k <= l->high; k++) put(f, bough_levels_crossed(l, k));
    fputc('\n', f);
}

static void put_channel(FILE *f, const bough_load_set *set, const bough_channel_counts *c, int n) {
    const bough_sample_statistics *s = &c->statistics;
    const double statistics[] = {s->n,    s->mean,     s->squares, s->least,
                                 s->most, s->least_at, s->most_at};
    fputs("statistics", f);
    for (int i = 0; i < 7; i++) put(f, statistics[i]);
    fputc('\n', f);
    if (set->sweep) return;
    fputs("cycles", f);
    put(f, c->rainflow.cycles);
    put(f, c->rainflow.forced);
    for (int i = 0; i < set->n_slope; i++) put(f, c->rainflow.damage[i]);
    fputc('\n', f);
    put_levels(f, "ranges", &c->rainflow.ranges);
    put_levels(f, "levels", &c->levels);
    for (int side = 0; side < 2; side++) {
        fputs(side ? "most" : "least", f);
        for (int i = 0; i < n; i++) put(f, side ? c->at_most[i] : c->at_least[i]);
        fputc('\n', f);
    }
}

static void put_result(FILE *f, const bough_load_set *set, int number,
                       const bough_case_result *r) {
    bool ok = bough_is_ok(&r->outcome);
    fprintf(f, "case %d fingerprint %016" PRIx64 "\noutcome %d ", number + 1,
            set->cases[number].fingerprint, (int)r->outcome.code);
    for (const char *c = ok ? "" : r->outcome.message; *c; c++) fputc(*c == '\n' ? ' ' : *c, f);
    fputs("\nrun", f);
    const double run[] = {r->time, r->counted, r->cpu, r->wall, r->counts.broken};
    for (int i = 0; i < 5; i++) put(f, run[i]);
    fputc('\n', f);
    for (int i = 0; ok && i < set->n_channel; i++)
        put_channel(f, set, &r->counts.channel[i], set->n_channel);
    fputs("end\n", f);
}

bough_status bough_case_write(const char *folder, const bough_load_set *set, int number,
                              const bough_case_result *result) {
    char path[BOUGH_PATH_MAX];
    FILE *file;
    bough_status status = path_of(folder, number, path);
    if (bough_is_ok(&status)) status = bough_folder_open_partial(path, &file);
    if (!bough_is_ok(&status)) return status;
    put_result(file, set, number, result);
    return bough_folder_commit(path, file);
}

// -- reading --------------------------------------------------------------------------------------

static bool take_word(FILE *f, const char *word) {
    char found[32];
    return fscanf(f, "%31s", found) == 1 && strcmp(found, word) == 0;
}

static bool take(FILE *f, int n, double *x) {
    for (int i = 0; i < n; i++)
        if (fscanf(f, "%lf", &x[i]) != 1) return false;
    return true;
}

static int slot(int64_t bin) { return (int)(((bin % BOUGH_LEVELS) + BOUGH_LEVELS) % BOUGH_LEVELS); }

static bool take_levels(FILE *f, const char *name, bough_levels *l) {
    int started;
    memset(l, 0, sizeof *l);
    if (!take_word(f, name)) return false;
    if (fscanf(f, "%d %d %" SCNd64 " %" SCNd64, &started, &l->exponent, &l->low, &l->high) != 4)
        return false;
    l->started = started != 0;
    if (!l->started) return true;
    if (l->high < l->low || l->high - l->low >= BOUGH_LEVELS) return false;
    for (int64_t k = l->low; k <= l->high; k++)
        if (!take(f, 1, &l->inside[slot(k)])) return false;
    for (int64_t k = l->low; k <= l->high; k++)
        if (!take(f, 1, &l->crossed[slot(k)])) return false;
    return true;
}

static bool take_channel(FILE *f, const bough_load_set *set, bough_channel_counts *c, int n) {
    double s[7], cycles[2];
    if (!take_word(f, "statistics") || !take(f, 7, s)) return false;
    c->statistics = (bough_sample_statistics){s[0], s[1], s[2], s[3], s[4], s[5], s[6]};
    if (set->sweep) return true;
    if (!take_word(f, "cycles") || !take(f, 2, cycles)) return false;
    c->rainflow.cycles = cycles[0];
    c->rainflow.forced = cycles[1];
    return take(f, set->n_slope, c->rainflow.damage) &&
           take_levels(f, "ranges", &c->rainflow.ranges) && take_levels(f, "levels", &c->levels) &&
           take_word(f, "least") && take(f, n, c->at_least) && take_word(f, "most") &&
           take(f, n, c->at_most);
}

static bool take_head(FILE *f, const bough_load_set *set, int number, bough_status *outcome) {
    uint64_t fingerprint;
    int code, found;
    char message[BOUGH_MESSAGE] = "";
    if (fscanf(f, "case %d fingerprint %" SCNx64 " outcome %d", &found, &fingerprint, &code) != 3)
        return false;
    if (!fgets(message, sizeof message, f)) return false;
    message[strcspn(message, "\n")] = '\0';
    *outcome = code == BOUGH_OK ? bough_ok()
                                : bough_fail((bough_code)code, "%s", message + 1);
    return found == number + 1 && fingerprint == set->cases[number].fingerprint;
}

// What follows the head.
static bool take_result(FILE *f, const bough_load_set *set, bough_case_result *r) {
    double run[5];
    if (!take_word(f, "run") || !take(f, 5, run)) return false;
    r->time = run[0];
    r->counted = run[1];
    r->cpu = run[2];
    r->wall = run[3];
    r->counts.broken = run[4];
    for (int i = 0; bough_is_ok(&r->outcome) && i < set->n_channel; i++)
        if (!take_channel(f, set, &r->counts.channel[i], set->n_channel)) return false;
    return take_word(f, "end");
}

static FILE *open_case(const char *folder, int number) {
    char path[BOUGH_PATH_MAX], why[BOUGH_INPUT_REASON];
    bough_status status = path_of(folder, number, path);
    return bough_is_ok(&status) ? bough_input_open(path, BOUGH_INPUT_DATA, why) : NULL;
}

bough_status bough_case_read(const char *folder, const bough_load_set *set, int number,
                             bough_case_result *result) {
    result->done = false;
    errno = 0;
    FILE *file = open_case(folder, number);
    if (!file && errno != ENOENT) {
        return bough_fail(BOUGH_IO, "cannot read the result of case %d in '%.200s': %s", number + 1,
                          folder, strerror(errno));
    }
    if (!file) return bough_ok();
    bool known = take_head(file, set, number, &result->outcome);
    result->done = known && take_result(file, set, result);
    fclose(file);
    if (result->done || !known) return bough_ok();
    return bough_fail(BOUGH_IO, "the result of case %d, '%.200s/cases/%06d.case', is damaged: remove it, "
                                "and the same command runs the case again", number + 1, folder,
                      number + 1);
}

bool bough_case_exists(const char *folder, const bough_load_set *set, int number,
                       bough_status *outcome) {
    FILE *file = open_case(folder, number);
    if (!file) return false;
    bool known = take_head(file, set, number, outcome);
    fclose(file);
    return known;
}
