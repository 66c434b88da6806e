#include "apps/bough/cases/perform.h"

#include "apps/bough/results/folder.h"
#include "core/base/input_file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <unistd.h>

// -- names ----------------------------------------------------------------------------------------

typedef char case_name[24], case_file[48];

// Compared runs are named by their fingerprints, since a grid may grow; other cases by their numbers.
static void name_of(const bough_study *s, const bough_case *c, case_name name, case_file file) {
    if (s->is.compared)
        snprintf(name, sizeof(case_name), "%016" PRIx64, c->fingerprint);
    else
        snprintf(name, sizeof(case_name), "%06d", (int)(c - s->cases) + 1);
    snprintf(file, sizeof(case_file), "cases/%s.case", name);
}

bough_status bough_store_open(const char *folder) {
    char path[BOUGH_PATH_MAX];
    BOUGH_TRY(bough_folder_path(folder, "cases", path));
    return bough_folder_make(path);
}

// -- rows -----------------------------------------------------------------------------------------

// A file of rows, which is written, or read in the same order.
typedef struct rows {
    FILE *file;
    bool reads;
    bool good; // all rows so far are there
} rows;

// Writes a row of a word and a text, in one line.
static void put_text(FILE *stream, const char *word, const char *text) {
    fprintf(stream, "%s ", word);
    for (const char *c = text; *c; c++) fputc(*c == '\n' || *c == '\r' ? ' ' : *c, stream);
    fputc('\n', stream);
}

static bool take_word(FILE *stream, const char *word) {
    char found[32];
    return fscanf(stream, "%31s", found) == 1 && strcmp(found, word) == 0;
}

// Writes or reads a row of a word and n numbers.
static void move(rows *r, const char *word, int n, double *x) {
    if (!r->reads) {
        fputs(word, r->file);
        for (int i = 0; i < n; i++) fprintf(r->file, " %.17g", x[i]);
        fputc('\n', r->file);
        return;
    }
    r->good = r->good && take_word(r->file, word);
    for (int i = 0; i < n && r->good; i++) r->good = fscanf(r->file, "%lf", &x[i]) == 1;
}

// Writes or reads a row of a word and a text of less than `size` bytes.
static void move_text(rows *r, const char *word, char *text, int size) {
    if (!r->reads) {
        put_text(r->file, word, text);
        return;
    }
    char line[BOUGH_CASE_WARNINGS + 2] = "";
    assert((size_t)size + 2 <= sizeof line);
    r->good = r->good && take_word(r->file, word) && fgets(line, size + 2, r->file) && line[0] == ' ';
    if (!r->good) return;
    line[strcspn(line, "\n")] = line[size] = '\0';
    memcpy(text, line + 1, (size_t)size);
}

// -- statistics -----------------------------------------------------------------------------------

// Takes a range of bins from a file that may be damaged.
static bool take_range(const double range[4], bough_levels *l) {
    for (int i = 0; i < 4; i++)
        if (!(fabs(range[i]) < 1e15)) return false;
    *l = (bough_levels){.started = range[0] > 0,
                        .exponent = (int)fmax(-9999, fmin(range[1], 9999)),
                        .low = (int64_t)range[2],
                        .high = (int64_t)range[3]};
    return !l->started || (l->high >= l->low && l->high - l->low < BOUGH_LEVELS);
}

static void move_levels(rows *r, const char *name, bough_levels *l) {
    double range[] = {l->started, l->exponent, (double)l->low, (double)l->high};
    double inside[BOUGH_LEVELS], crossed[BOUGH_LEVELS];
    move(r, name, 4, range);
    if (r->reads) r->good = r->good && take_range(range, l);
    int n = r->good && l->started ? (int)(l->high - l->low) + 1 : 0;
    for (int i = 0; i < n; i++) {
        inside[i] = bough_levels_inside(l, l->low + i);
        crossed[i] = bough_levels_crossed(l, l->low + i);
    }
    move(r, "inside", n, inside);
    move(r, "crossed", n, crossed);
    for (int i = 0; i < n && r->reads; i++) {
        l->inside[bough_levels_slot(l->low + i)] = inside[i];
        l->crossed[bough_levels_slot(l->low + i)] = crossed[i];
    }
}

static void move_channel(rows *r, const bough_study *s, bough_channel_counts *c) {
    move(r, "statistics", sizeof c->statistics / sizeof(double), &c->statistics.n); // numbers only
    if (!s->is.weighted) return;
    move(r, "cycles", 2, &c->rainflow.cycles); // and those forced
    move(r, "damage", s->n_slope, c->rainflow.damage);
    move_levels(r, "ranges", &c->rainflow.ranges);
    move_levels(r, "levels", &c->levels);
    move(r, "least", s->n_channel, c->at_least);
    move(r, "most", s->n_channel, c->at_most);
}

static void move_error(rows *r, const bough_study *s, bough_load_error *e) {
    move(r, "error", 2, &e->least); // and the most
    move(r, "damage", s->n_slope, e->damage);
    move(r, "larger", s->n_slope, e->larger);
}

// -- a result -------------------------------------------------------------------------------------

// The settings are written for the reader of the file only.
static void move_settings(rows *r, const char *settings) {
    if (!r->reads) put_text(r->file, "settings", settings);
    for (int byte = 0; r->reads && byte != '\n' && byte != EOF;) byte = fgetc(r->file);
}

static void move_result(rows *r, const bough_study *s, const bough_case *c, bough_case_result *x) {
    bough_coupling_report *k = &x->coupling;
    double run[] = {x->time, x->counted, x->cpu, x->wall, x->warned, x->counts.broken, x->has_companion};
    move_settings(r, c->settings);
    move(r, "run", 7, run);
    x->time = run[0], x->counted = run[1], x->cpu = run[2], x->wall = run[3];
    x->warned = run[4] > 0, x->counts.broken = run[5], x->has_companion = run[6] > 0;
    move(r, "coupling", sizeof *k / sizeof(double), &k->defect_max); // numbers only
    move(r, "errors", s->n_measure, x->error);
    move(r, "estimates", s->n_measure, x->estimate);
    move_text(r, "warnings", x->warnings, BOUGH_CASE_WARNINGS);
    for (int i = 0; bough_is_ok(&x->outcome) && i < x->counts.n_channel && r->good; i++) {
        move_channel(r, s, &x->counts.channel[i]);
        if (x->has_companion) move_error(r, s, &x->load_error[i]);
    }
}

// -- files ----------------------------------------------------------------------------------------

bough_status bough_store_write(const char *folder, const bough_study *s, const bough_case *c,
                               bough_case_result *r) {
    case_name name;
    case_file file;
    char path[BOUGH_PATH_MAX], code[12];
    FILE *f;
    name_of(s, c, name, file);
    BOUGH_TRY(bough_folder_open(folder, file, path, &f));
    fprintf(f, "case %s fingerprint %016" PRIx64 "\noutcome ", name, c->fingerprint);
    snprintf(code, sizeof code, "%d", (int)r->outcome.code);
    put_text(f, code, bough_is_ok(&r->outcome) ? "" : r->outcome.message);
    move_result(&(rows){.file = f, .good = true}, s, c, r);
    fputs("end\n", f);
    return bough_folder_close(path, f, bough_ok());
}

static bool take_head(FILE *f, const case_name name, uint64_t fingerprint, bough_status *outcome) {
    uint64_t found;
    int code;
    char word[24], message[BOUGH_MESSAGE + 2] = ""; // with the blank before it and the end of its line
    if (fscanf(f, "case %23s fingerprint %" SCNx64 " outcome %d", word, &found, &code) != 3) return false;
    if (!fgets(message, sizeof message, f)) return false;
    message[strcspn(message, "\n")] = '\0';
    *outcome = code == BOUGH_OK ? bough_ok() : bough_fail((bough_code)code, "%s", message + 1);
    return strcmp(word, name) == 0 && found == fingerprint;
}

// Opens a result after its head; *file is NULL if there is none or it belongs to other input.
static bough_status open_case(const char *folder, const bough_study *s, const bough_case *c,
                              bough_status *outcome, FILE **file) {
    case_name name;
    case_file place;
    char path[BOUGH_PATH_MAX], why[BOUGH_INPUT_REASON];
    *file = NULL;
    name_of(s, c, name, place);
    BOUGH_TRY(bough_folder_path(folder, place, path));
    errno = 0;
    FILE *found = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (!found && errno != ENOENT) return bough_fail(BOUGH_IO, "cannot read '%.200s': %s", path, why);
    if (found && take_head(found, name, c->fingerprint, outcome))
        *file = found;
    else if (found)
        fclose(found);
    return bough_ok();
}

bough_status bough_store_read(const char *folder, const bough_study *s, const bough_case *c,
                              bough_case_result *r) {
    case_name name;
    case_file place;
    FILE *f;
    bough_status status = open_case(folder, s, c, &r->outcome, &f);
    r->done = false;
    if (!f) return status;
    rows file = {f, true, true};
    move_result(&file, s, c, r);
    r->done = file.good && take_word(f, "end");
    fclose(f);
    if (r->done) return status;
    name_of(s, c, name, place);
    return bough_fail(
        BOUGH_IO, "the result '%.200s/%s' is damaged: remove it, and the same command runs the case again",
        folder, place);
}

bool bough_store_has(const char *folder, const bough_study *s, const bough_case *c) {
    bough_status outcome;
    FILE *f;
    open_case(folder, s, c, &outcome, &f);
    if (f) fclose(f);
    return f != NULL;
}

// -- claims ---------------------------------------------------------------------------------------

static void release(void *self) { close(*(int *)self); }

bough_status bough_claims_open(bough_arena *arena, const char *folder, int *claims) {
    char path[BOUGH_PATH_MAX];
    int *file = bough_arena_take(arena, sizeof *file);
    BOUGH_TRY(bough_folder_path(folder, "cases/claims", path));
    *claims = *file = open(path, O_RDWR | O_CREAT | O_NONBLOCK | O_CLOEXEC, 0666);
    if (*file < 0) return bough_fail(BOUGH_IO, "cannot write '%.200s': %s", path, strerror(errno));
    bough_arena_on_destroy(arena, release, file);
    return bough_ok();
}

static bool set_lock(int claims, int number, short type) {
    struct flock byte = {.l_type = type, .l_whence = SEEK_SET, .l_start = (off_t)number, .l_len = 1};
    return fcntl(claims, F_SETLK, &byte) == 0 || (errno != EACCES && errno != EAGAIN);
}

bool bough_claim(int claims, int number) { return set_lock(claims, number, F_WRLCK); }

void bough_claim_drop(int claims, int number) { set_lock(claims, number, F_UNLCK); }
