#include "apps/bough/cases/store.h"

#include "apps/bough/results/folder.h"
#include "core/base/input_file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

// -- names ----------------------------------------------------------------------------------------

typedef char case_name[24];

// Of compared runs by what the result depends on, since the place in the grid may change; else by the number.
static void name_of(const bough_study *s, const bough_case *c, case_name name) {
    if (s->is.compared)
        snprintf(name, sizeof(case_name), "%016" PRIx64, c->fingerprint);
    else
        snprintf(name, sizeof(case_name), "%06d", (int)(c - s->cases) + 1);
}

static bough_status path_of(const char *folder, const case_name name, char path[BOUGH_PATH_MAX]) {
    char file[48];
    snprintf(file, sizeof file, "cases/%s.case", name);
    return bough_folder_path(folder, file, path);
}

bough_status bough_store_open(const char *folder) {
    char path[BOUGH_PATH_MAX];
    bough_status status = bough_folder_path(folder, "cases", path);
    return bough_is_ok(&status) ? bough_folder_make(path) : status;
}

// -- rows -----------------------------------------------------------------------------------------

// A row of a word and a text, in one line.
static void put_text(FILE *stream, const char *word, const char *text) {
    fprintf(stream, "%s ", word);
    for (const char *c = text; *c; c++) fputc(*c == '\n' || *c == '\r' ? ' ' : *c, stream);
    fputc('\n', stream);
}

static void put(FILE *stream, const char *word, int n, const double *x) {
    fputs(word, stream);
    for (int i = 0; i < n; i++) fprintf(stream, " %.17g", x[i]);
    fputc('\n', stream);
}

static bool take_word(FILE *stream, const char *word) {
    char found[32];
    return fscanf(stream, "%31s", found) == 1 && strcmp(found, word) == 0;
}

static bool take(FILE *stream, const char *word, int n, double *x) {
    if (!take_word(stream, word)) return false;
    for (int i = 0; i < n; i++)
        if (fscanf(stream, "%lf", &x[i]) != 1) return false;
    return true;
}

// The place of a bin in the counts.
static int slot(int64_t bin) { return (int)(((bin % BOUGH_LEVELS) + BOUGH_LEVELS) % BOUGH_LEVELS); }

// -- compared runs --------------------------------------------------------------------------------

static void put_comparison(FILE *f, const bough_study *s, const bough_case *c, const bough_case_result *r) {
    const bough_coupling_report *k = &r->coupling;
    const double run[] = {r->time, r->wall, r->cpu, r->warned};
    const double coupling[] = {k->defect_max, k->defect_rms, k->energy_residual, k->energy_exchanged};
    put_text(f, "settings", c->settings);
    put(f, "run", 4, run);
    put(f, "coupling", 4, coupling);
    put(f, "errors", s->n_measure, r->error);
    put(f, "estimates", s->n_measure, r->estimate);
}

static bool take_comparison(FILE *f, const bough_study *s, bough_case_result *r) {
    double run[4], c[4];
    for (int byte = 0; byte != '\n';) // the settings are for people
        if ((byte = fgetc(f)) == EOF) return false;
    bool good = take(f, "run", 4, run) && take(f, "coupling", 4, c) &&
                take(f, "errors", s->n_measure, r->error) && take(f, "estimates", s->n_measure, r->estimate);
    if (!good) return false;
    r->time = run[0];
    r->wall = run[1];
    r->cpu = run[2];
    r->warned = run[3] > 0;
    r->coupling = (bough_coupling_report){c[0], c[1], c[2], c[3]};
    return true;
}

// -- statistics -----------------------------------------------------------------------------------

static void put_levels(FILE *f, const char *name, const bough_levels *l) {
    const double range[] = {l->started, l->exponent, (double)l->low, (double)l->high};
    double inside[BOUGH_LEVELS], crossed[BOUGH_LEVELS];
    int n = l->started ? (int)(l->high - l->low) + 1 : 0;
    for (int i = 0; i < n; i++) {
        inside[i] = bough_levels_inside(l, l->low + i);
        crossed[i] = bough_levels_crossed(l, l->low + i);
    }
    put(f, name, 4, range);
    put(f, "inside", n, inside);
    put(f, "crossed", n, crossed);
}

static void put_channel(FILE *f, const bough_study *s, const bough_channel_counts *c) {
    const bough_sample_statistics *x = &c->statistics;
    const double statistics[] = {x->n, x->mean, x->squares, x->least, x->most, x->least_at, x->most_at};
    const double cycles[] = {c->rainflow.cycles, c->rainflow.forced};
    put(f, "statistics", 7, statistics);
    if (!s->is.weighted) return;
    put(f, "cycles", 2, cycles);
    put(f, "damage", s->n_slope, c->rainflow.damage);
    put_levels(f, "ranges", &c->rainflow.ranges);
    put_levels(f, "levels", &c->levels);
    put(f, "least", s->n_channel, c->at_least);
    put(f, "most", s->n_channel, c->at_most);
}

static void put_error(FILE *f, const bough_study *s, const bough_load_error *e) {
    const double extremes[] = {e->least, e->most};
    put(f, "error", 2, extremes);
    put(f, "damage", s->n_slope, e->damage);
    put(f, "larger", s->n_slope, e->larger);
}

static void put_statistics(FILE *f, const bough_study *s, const bough_case_result *r) {
    const double run[] = {r->time, r->counted, r->cpu, r->wall, r->counts.broken, r->has_companion};
    put(f, "run", 6, run);
    for (int i = 0; bough_is_ok(&r->outcome) && i < s->n_channel; i++) {
        put_channel(f, s, &r->counts.channel[i]);
        if (r->has_companion) put_error(f, s, &r->load_error[i]);
    }
}

static bool take_levels(FILE *f, const char *name, bough_levels *l) {
    double range[4], inside[BOUGH_LEVELS], crossed[BOUGH_LEVELS];
    memset(l, 0, sizeof *l);
    if (!take(f, name, 4, range)) return false;
    for (int i = 0; i < 4; i++)
        if (!(fabs(range[i]) < 1e15)) return false;
    l->started = range[0] > 0;
    l->exponent = (int)fmax(-9999, fmin(range[1], 9999));
    l->low = (int64_t)range[2];
    l->high = (int64_t)range[3];
    if (l->started && (l->high < l->low || l->high - l->low >= BOUGH_LEVELS)) return false;
    int n = l->started ? (int)(l->high - l->low) + 1 : 0;
    if (!take(f, "inside", n, inside) || !take(f, "crossed", n, crossed)) return false;
    for (int i = 0; i < n; i++) {
        l->inside[slot(l->low + i)] = inside[i];
        l->crossed[slot(l->low + i)] = crossed[i];
    }
    return true;
}

static bool take_channel(FILE *f, const bough_study *s, bough_channel_counts *c) {
    double x[7], cycles[2];
    if (!take(f, "statistics", 7, x)) return false;
    c->statistics = (bough_sample_statistics){x[0], x[1], x[2], x[3], x[4], x[5], x[6]};
    if (!s->is.weighted) return true;
    if (!take(f, "cycles", 2, cycles)) return false;
    c->rainflow.cycles = cycles[0];
    c->rainflow.forced = cycles[1];
    return take(f, "damage", s->n_slope, c->rainflow.damage) &&
           take_levels(f, "ranges", &c->rainflow.ranges) && take_levels(f, "levels", &c->levels) &&
           take(f, "least", s->n_channel, c->at_least) && take(f, "most", s->n_channel, c->at_most);
}

static bool take_error(FILE *f, const bough_study *s, bough_load_error *e) {
    double extremes[2];
    if (!take(f, "error", 2, extremes)) return false;
    e->least = extremes[0];
    e->most = extremes[1];
    return take(f, "damage", s->n_slope, e->damage) && take(f, "larger", s->n_slope, e->larger);
}

static bool take_statistics(FILE *f, const bough_study *s, bough_case_result *r) {
    double run[6];
    if (!take(f, "run", 6, run)) return false;
    r->time = run[0];
    r->counted = run[1];
    r->cpu = run[2];
    r->wall = run[3];
    r->counts.broken = run[4];
    r->has_companion = run[5] > 0;
    for (int i = 0; bough_is_ok(&r->outcome) && i < s->n_channel; i++) {
        if (!take_channel(f, s, &r->counts.channel[i])) return false;
        if (r->has_companion && !take_error(f, s, &r->load_error[i])) return false;
    }
    return true;
}

// -- files ----------------------------------------------------------------------------------------

bough_status bough_store_write(const char *folder, const bough_study *s, const bough_case *c,
                               const bough_case_result *r) {
    case_name name;
    char path[BOUGH_PATH_MAX], code[12];
    FILE *f;
    name_of(s, c, name);
    bough_status status = path_of(folder, name, path);
    if (bough_is_ok(&status)) status = bough_folder_open_partial(path, &f);
    if (!bough_is_ok(&status)) return status;
    fprintf(f, "case %s fingerprint %016" PRIx64 "\noutcome ", name, c->fingerprint);
    snprintf(code, sizeof code, "%d", (int)r->outcome.code);
    put_text(f, code, bough_is_ok(&r->outcome) ? "" : r->outcome.message);
    if (s->is.compared)
        put_comparison(f, s, c, r);
    else
        put_statistics(f, s, r);
    fputs("end\n", f);
    return bough_folder_commit(path, f);
}

static bool take_head(FILE *f, const case_name name, uint64_t fingerprint, bough_status *outcome) {
    uint64_t found;
    int code;
    char word[24], message[BOUGH_MESSAGE] = "";
    if (fscanf(f, "case %23s fingerprint %" SCNx64 " outcome %d", word, &found, &code) != 3) return false;
    if (!fgets(message, sizeof message, f)) return false;
    message[strcspn(message, "\n")] = '\0';
    *outcome = code == BOUGH_OK ? bough_ok() : bough_fail((bough_code)code, "%s", message + 1);
    return strcmp(word, name) == 0 && found == fingerprint;
}

// Opens the file behind its head; *file is NULL when there is none or it is of other input.
static bough_status open_case(const char *folder, const case_name name, const bough_case *c,
                              bough_status *outcome, FILE **file) {
    char path[BOUGH_PATH_MAX], why[BOUGH_INPUT_REASON];
    *file = NULL;
    bough_status status = path_of(folder, name, path);
    if (!bough_is_ok(&status)) return status;
    errno = 0;
    FILE *found = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (!found && errno != ENOENT) return bough_fail(BOUGH_IO, "cannot read '%.200s': %s", path, why);
    if (found && take_head(found, name, c->fingerprint, outcome))
        *file = found;
    else if (found)
        fclose(found);
    return status;
}

bough_status bough_store_read(const char *folder, const bough_study *s, const bough_case *c,
                              bough_case_result *r) {
    case_name name;
    FILE *f;
    name_of(s, c, name);
    bough_status status = open_case(folder, name, c, &r->outcome, &f);
    r->done = false;
    if (!f) return status;
    r->done = (s->is.compared ? take_comparison(f, s, r) : take_statistics(f, s, r)) && take_word(f, "end");
    fclose(f);
    if (r->done) return status;
    return bough_fail(BOUGH_IO,
                      "the result '%.200s/cases/%s.case' is damaged: remove it, and the same command "
                      "runs the case again",
                      folder, name);
}

bool bough_store_has(const char *folder, const bough_study *s, const bough_case *c) {
    case_name name;
    bough_status outcome;
    FILE *f;
    name_of(s, c, name);
    open_case(folder, name, c, &outcome, &f);
    if (f) fclose(f);
    return f != NULL;
}

// -- claims ---------------------------------------------------------------------------------------

static void release(void *self) { close(*(int *)self); }

bough_status bough_claims_open(bough_arena *arena, const char *folder, int *claims) {
    char path[BOUGH_PATH_MAX];
    int *file = bough_arena_take(arena, sizeof *file);
    bough_status status = bough_folder_path(folder, "cases/claims", path);
    if (!bough_is_ok(&status) || !file) return status;
    *claims = *file = open(path, O_RDWR | O_CREAT | O_NONBLOCK | O_CLOEXEC, 0666);
    if (*file < 0) return bough_fail(BOUGH_IO, "cannot write '%.200s': %s", path, strerror(errno));
    bough_arena_on_destroy(arena, release, file);
    return status;
}

static bool set_lock(int claims, int number, short type) {
    struct flock byte = {.l_type = type, .l_whence = SEEK_SET, .l_start = (off_t)number, .l_len = 1};
    return fcntl(claims, F_SETLK, &byte) == 0 || (errno != EACCES && errno != EAGAIN);
}

bool bough_claim(int claims, int number) { return set_lock(claims, number, F_WRLCK); }

void bough_claim_drop(int claims, int number) { set_lock(claims, number, F_UNLCK); }
