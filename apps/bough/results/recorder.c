#include "apps/bough/results/recorder.h"

#include "apps/bough/results/folder.h"
#include "core/base/input_file.h"

#include <assert.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// -- statistics -----------------------------------------------------------------------------------

void bough_sample_statistics_add(bough_sample_statistics *s, double t, double x) {
    if (s->n == 0 || x < s->least) {
        s->least = x;
        s->least_at = t;
    }
    if (s->n == 0 || x > s->most) {
        s->most = x;
        s->most_at = t;
    }
    s->n++;
    double off = x - s->mean;
    s->mean += off / s->n;
    s->squares += off * (x - s->mean);
}

double bough_sample_statistics_deviation(const bough_sample_statistics *s) {
    return s->n > 0 ? sqrt(s->squares / s->n) : (double)NAN;
}

// -- numbers --------------------------------------------------------------------------------------

enum { DIGITS = 8, MOST = 22 }; // after the point; powers of ten up to 10²² are exact in any format

static const long double power[MOST + 1] = {1e0L,  1e1L,  1e2L,  1e3L,  1e4L,  1e5L,  1e6L,  1e7L,
                                            1e8L,  1e9L,  1e10L, 1e11L, 1e12L, 1e13L, 1e14L, 1e15L,
                                            1e16L, 1e17L, 1e18L, 1e19L, 1e20L, 1e21L, 1e22L};

// x·10^(8 − e): one rounding.
static long double scaled(double x, int e) {
    return e <= DIGITS ? x * power[DIGITS - e] : x / power[e - DIGITS];
}

// The nine digits of |x| as a whole number and the exponent of the first. False where rounding may
// decide otherwise than exact arithmetic, or x is too large or too small.
static bool nine_digits(double x, uint32_t *digits, int *exponent) {
    const long double doubtful = 4e9L * LDBL_EPSILON;
    int binary, e;
    if (x == 0) {
        *digits = *exponent = 0;
        return true;
    }
    if (!(x >= 1e-13 && x < 1e29)) return false;
    frexp(x, &binary);
    e = (int)floor((binary - 1) * 0.30102999566398120);
    long double v = scaled(x, e);
    if (v >= 1e9L) v = scaled(x, ++e);
    if (v < 1e8L) v = scaled(x, --e);
    uint32_t whole = (uint32_t)v;
    long double rest = v - whole;
    if (fabsl(rest - 0.5L) < doubtful) return false;
    if (rest > 0.5L) whole++;
    if (whole == 1000000000) {
        whole = 100000000;
        e++;
    }
    *digits = whole;
    *exponent = e;
    return whole >= 100000000 && e < 100;
}

void bough_number_write(char *to, int width, double x) {
    enum { LENGTH = DIGITS + 6 }; // "d.ddddddddE+dd"
    uint32_t digits;
    int e;
    if (!nine_digits(fabs(x), &digits, &e)) {
        snprintf(to, (size_t)width + 1, "%*.*E", width, DIGITS, x);
        return;
    }
    memset(to, ' ', (size_t)(width - LENGTH));
    char *out = to + width - LENGTH;
    if (signbit(x)) out[-1] = '-';
    for (int k = DIGITS + 1; k > 1; k--, digits /= 10) out[k] = (char)('0' + digits % 10);
    out[0] = (char)('0' + digits);
    out[1] = '.';
    int size = e < 0 ? -e : e;
    const char tail[5] = {'E', e < 0 ? '-' : '+', (char)('0' + size / 10), (char)('0' + size % 10), 0};
    memcpy(out + DIGITS + 2, tail, sizeof tail);
}

// Characters of a column: a tab and the longest number; OUTCOME is the third line's fixed length.
enum { COLUMN = 18, OUTCOME = 160, BUFFER = 1 << 16 };

struct bough_recorder {
    const bough_channels *channels;
    FILE *file; // NULL once finished
    char *path;
    char *buffer;    // of the file (BUFFER)
    char *line;      // one row and its terminator (row_length + 1)
    double *value;   // (count)
    long outcome_at; // offset of the line that tells how the run ended
    long rows_at;    // offset of the first row
    long row_length; // of every row [bytes]
    long rows;
};

static void release(void *self) {
    bough_recorder *recorder = self;
    if (recorder->file) fclose(recorder->file);
    recorder->file = NULL;
}

static bough_status write_error(const bough_recorder *r) {
    return bough_fail(BOUGH_IO, "cannot write '%.200s.partial' (%ld rows so far): %s", r->path, r->rows,
                      errno ? strerror(errno) : "the device refused");
}

// Whether the byte is inside a UTF-8 character, after its first.
static bool is_continuation(char byte) { return ((unsigned char)byte & 0xC0) == 0x80; }

// The outcome has a fixed length, so that it can be replaced once the end is known.
static bool write_outcome(bough_recorder *r, const char *text) {
    char line[OUTCOME];
    size_t length = strlen(text);
    if (length > OUTCOME - 1) {
        length = OUTCOME - 1;
        while (length && is_continuation(text[length])) length--;
    }
    memset(line, ' ', OUTCOME);
    for (size_t i = 0; i < length; i++) {
        if (text[i] != '\n' && text[i] != '\r') line[i] = text[i];
    }
    line[OUTCOME - 1] = '\n';
    return fwrite(line, 1, OUTCOME, r->file) == OUTCOME;
}

static bough_status write_head(bough_recorder *r, const char *title) {
    FILE *f = r->file;
    const bough_channels *c = r->channels;
    errno = 0;
    fprintf(f, "\nbough: %.*s\n", (int)strcspn(title, "\r\n"), title);
    r->outcome_at = ftell(f);
    write_outcome(r, "INCOMPLETE: the run has not ended");
    fprintf(f, "\n%d channels besides the time\n\n", c->count);
    fprintf(f, "%*s", COLUMN, "Time");
    for (int i = 0; i < c->count; i++) fprintf(f, "\t%*s", COLUMN - 1, c->channel[i].name);
    fprintf(f, "\n%*s", COLUMN, "(s)");
    for (int i = 0; i < c->count; i++) {
        char unit[BOUGH_CHANNEL_UNIT + 2];
        snprintf(unit, sizeof unit, "(%s)", c->channel[i].unit);
        fprintf(f, "\t%*s", COLUMN - 1, unit);
    }
    fprintf(f, "\n");
    if (fflush(f) != 0) return write_error(r);
    r->rows_at = ftell(f);
    return bough_ok();
}

// The head is written again, for its outcome; the rows stay.
static bough_status reopen(bough_recorder *r, const bough_recorder_def *def) {
    BOUGH_TRY(bough_folder_reopen_partial(r->path, def->kept.bytes, &r->file));
    rewind(r->file);
    bough_status status = write_head(r, def->title);
    r->rows = def->kept.count;
    if (!bough_is_ok(&status)) return status;
    bool same = r->rows_at + r->rows * r->row_length == def->kept.bytes;
    if (same && fseek(r->file, def->kept.bytes, SEEK_SET) == 0) return status;
    return bough_fail(BOUGH_INVALID, "'%.200s.partial' has other channels", r->path);
}

static bough_status create(bough_recorder *r, const bough_recorder_def *def) {
    BOUGH_TRY(bough_folder_open_partial(r->path, &r->file));
    setvbuf(r->file, r->buffer, _IOFBF, BUFFER);
    return write_head(r, def->title);
}

static void take_memory(bough_recorder *r, bough_arena *arena) {
    size_t count = (size_t)r->channels->count;
    r->buffer = bough_arena_take(arena, BUFFER);
    r->row_length = (long)(count + 1) * COLUMN + 1;
    r->line = bough_arena_take(arena, (size_t)r->row_length + 1);
    r->value = bough_arena_doubles(arena, count + 1);
}

bough_status bough_recorder_open(bough_arena *arena, const bough_recorder_def *def,
                                 bough_recorder **recorder) {
    char path[BOUGH_PATH_MAX];
    BOUGH_TRY(bough_folder_path(def->folder, "channels.out", path));
    bough_recorder *r = bough_arena_take(arena, sizeof *r);
    r->channels = def->channels;
    r->path = bough_arena_string(arena, path);
    take_memory(r, arena);
    bough_arena_on_destroy(arena, release, r);
    *recorder = r;
    return def->kept.count > 0 ? reopen(r, def) : create(r, def);
}

static void format_row(bough_recorder *r, double t) {
    char *end = r->line;
    bough_number_write(end, COLUMN, t);
    end += COLUMN;
    for (int i = 0; i < r->channels->count; i++) {
        *end++ = '\t';
        bough_number_write(end, COLUMN - 1, r->value[i]);
        end += COLUMN - 1;
    }
    *end++ = '\n';
    assert(end - r->line == r->row_length);
}

bough_status bough_recorder_sample(bough_recorder *r, double t) {
    bough_channels_sample(r->channels, t, r->value);
    format_row(r, t);
    size_t length = (size_t)r->row_length;
    errno = 0;
    if (fwrite(r->line, 1, length, r->file) != length) return write_error(r);
    r->rows++;
    return bough_ok();
}

bough_status bough_recorder_keep(bough_recorder *r, bough_kept *kept) {
    kept->count = r->rows;
    return bough_folder_keep(r->path, r->file, &kept->bytes);
}

// Where the device was full, readers would stumble over half a row.
static void cut_to_whole_rows(const bough_recorder *r) {
    char partial[BOUGH_PATH_MAX + 16];
    snprintf(partial, sizeof partial, "%s.partial", r->path);
    struct stat info;
    if (stat(partial, &info) != 0 || info.st_size <= r->rows_at) return;
    off_t rows = (info.st_size - r->rows_at) / r->row_length;
    // Nothing more can be done if this fails too: the file is marked incomplete as it is.
    if (truncate(partial, r->rows_at + rows * r->row_length) != 0) return;
}

bough_status bough_recorder_finish(bough_recorder *r, const bough_status *outcome) {
    char text[2 * OUTCOME];
    if (bough_is_ok(outcome)) {
        snprintf(text, sizeof text, "Complete: %ld rows", r->rows);
    } else {
        snprintf(text, sizeof text, "INCOMPLETE: %ld rows, then %.280s", r->rows, outcome->message);
    }
    errno = 0;
    // An earlier error counts too: the library may have dropped its buffer with it.
    bool written = !ferror(r->file) && fflush(r->file) == 0 && fseek(r->file, r->outcome_at, SEEK_SET) == 0 &&
                   write_outcome(r, text) && fflush(r->file) == 0;
    if (!written) {
        bough_status status = write_error(r);
        release(r);
        cut_to_whole_rows(r);
        return status;
    }
    FILE *file = r->file;
    r->file = NULL;
    return bough_folder_commit(r->path, file);
}

const double *bough_recorder_values(const bough_recorder *recorder) { return recorder->value; }

long bough_recorder_rows(const bough_recorder *recorder) { return recorder->rows; }

// -- channels.outb --------------------------------------------------------------------------------

// The scales must be known before the first row, so channels.out is read twice: for ranges, and for
// rows. All numbers are little-endian.

enum { FORMAT = 4, HEAD_LINES = 8, LEAST = -32768, STEPS = 65535 };

// Values of a channel beyond this have no scale in single precision.
static const double most_value = 1e30;

typedef struct span {
    double low, high;
} span;

typedef struct packer {
    const bough_binary_def *def;
    int n;         // channels
    FILE *in;      // channels.out
    double *row;   // (1 + n) time, values
    span *range;   // (n)
    float *scale;  // (n) a value is stored as round(scale value + offset)
    float *offset; // (n)
    double start;  // of the first row [s]
    int32_t rows;
} packer;

// -- reading --------------------------------------------------------------------------------------

static bough_status unreadable(const packer *p, long row) {
    return bough_fail(BOUGH_IO, "cannot read row %ld of '%.200s/channels.out' again", row + 1,
                      p->def->folder);
}

static bough_status rewind_rows(packer *p) {
    rewind(p->in);
    for (int line = 0; line < HEAD_LINES; line++) {
        int byte;
        while ((byte = fgetc(p->in)) != '\n') {
            if (byte == EOF) return unreadable(p, 0);
        }
    }
    return bough_ok();
}

// How many of the row's values there are.
static int read_row(packer *p) {
    int k = 0;
    while (k <= p->n && fscanf(p->in, "%lf", &p->row[k]) == 1) k++;
    return k;
}

static bough_status check_value(const packer *p, int k) {
    double x = p->row[1 + k];
    if (fabs(x) <= most_value) return bough_ok();
    return bough_fail(BOUGH_INVALID,
                      "channels.outb cannot hold %s = %g at %.9g s: leave out simulation.output.binary",
                      p->def->channels->channel[k].name, x, p->row[0]);
}

// Counts the rows on the beat and finds each channel's range.
static bough_status measure(packer *p) {
    bough_status status = rewind_rows(p);
    for (long row = 0; bough_is_ok(&status); row++) {
        int read = read_row(p);
        if (read == 0 && feof(p->in) && row > 0) return status;
        if (read <= p->n || row == INT32_MAX) return unreadable(p, row);
        if (row == 0) p->start = p->row[0];
        double beat = p->start + (double)row * p->def->interval;
        if (fabs(p->row[0] - beat) > 0.01 * p->def->interval) return status;
        for (int k = 0; k < p->n && bough_is_ok(&status); k++) {
            double x = p->row[1 + k];
            status = check_value(p, k);
            if (row == 0 || x < p->range[k].low) p->range[k].low = x;
            if (row == 0 || x > p->range[k].high) p->range[k].high = x;
        }
        p->rows = (int32_t)row + 1;
    }
    return status;
}

// A range is widened by what rounding to single precision does to its ends, so that they fit.
static void choose_scales(packer *p) {
    for (int k = 0; k < p->n; k++) {
        double low = p->range[k].low, high = p->range[k].high;
        double margin = (double)FLT_EPSILON * fmax(fabs(low), fabs(high));
        double width = fmax(high - low + 2 * margin, 1e-30);
        p->scale[k] = (float)(STEPS / width);
        p->offset[k] = (float)(LEAST - (low - margin) * (double)p->scale[k]);
    }
}

// -- writing --------------------------------------------------------------------------------------

static void put(FILE *out, uint64_t bits, int bytes) {
    for (int i = 0; i < bytes; i++) fputc((int)(bits >> 8 * i & 0xff), out);
}

static void put_double(FILE *out, double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    put(out, bits, 8);
}

static void put_float(FILE *out, float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    put(out, bits, 4);
}

// Blanks fill the word's place.
static void put_word(FILE *out, const char *word, int width) { fprintf(out, "%-*s", width, word); }

static void put_unit(FILE *out, const char *unit, int width) {
    char word[BOUGH_CHANNEL_UNIT + 2];
    snprintf(word, sizeof word, "(%s)", unit);
    put_word(out, word, width);
}

static int longest_word(const bough_channels *c) {
    size_t longest = strlen("Time");
    for (int k = 0; k < c->count; k++) {
        size_t name = strlen(c->channel[k].name), unit = strlen(c->channel[k].unit) + 2;
        if (name > longest) longest = name;
        if (unit > longest) longest = unit;
    }
    return (int)longest;
}

static void put_head(const packer *p, FILE *out) {
    const bough_channels *c = p->def->channels;
    int width = longest_word(c);
    put(out, FORMAT, 2);
    put(out, (uint64_t)width, 2);
    put(out, (uint64_t)p->n, 4);
    put(out, (uint64_t)p->rows, 4);
    put_double(out, p->start);
    put_double(out, p->def->interval);
    for (int k = 0; k < p->n; k++) put_float(out, p->scale[k]);
    for (int k = 0; k < p->n; k++) put_float(out, p->offset[k]);
    put(out, strlen(p->def->title), 4);
    fputs(p->def->title, out);
    put_word(out, "Time", width);
    for (int k = 0; k < p->n; k++) put_word(out, c->channel[k].name, width);
    put_unit(out, "s", width);
    for (int k = 0; k < p->n; k++) put_unit(out, c->channel[k].unit, width);
}

static bough_status put_rows(packer *p, FILE *out) {
    bough_status status = rewind_rows(p);
    for (int32_t row = 0; row < p->rows && bough_is_ok(&status); row++) {
        if (read_row(p) <= p->n) return unreadable(p, row);
        for (int k = 0; k < p->n; k++) {
            double at = p->row[1 + k] * (double)p->scale[k] + (double)p->offset[k];
            long step = lround(fmin(fmax(at, LEAST), LEAST + STEPS));
            put(out, (uint64_t)step, 2);
        }
    }
    return status;
}

static bough_status write_file(packer *p) {
    char path[BOUGH_PATH_MAX];
    FILE *out;
    BOUGH_TRY(bough_folder_open(p->def->folder, "channels.outb", path, &out));
    put_head(p, out);
    bough_status status = put_rows(p, out);
    if (bough_is_ok(&status)) return bough_folder_commit(path, out);
    bough_folder_discard(path, out);
    return status;
}

static bool take_buffers(packer *p) {
    size_t n = (size_t)p->n + 1;
    p->row = malloc(n * sizeof *p->row);
    p->range = malloc(n * sizeof *p->range);
    p->scale = malloc(n * sizeof *p->scale);
    p->offset = malloc(n * sizeof *p->offset);
    return p->row && p->range && p->scale && p->offset;
}

bough_status bough_binary_write(const bough_binary_def *def) {
    char path[BOUGH_PATH_MAX], why[BOUGH_INPUT_REASON];
    packer p = {.def = def, .n = def->channels->count};
    bough_status status = bough_folder_path(def->folder, "channels.out", path);
    if (!bough_is_ok(&status)) return status;
    if (!take_buffers(&p)) status = bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    if (bough_is_ok(&status)) p.in = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (bough_is_ok(&status) && !p.in) {
        status = bough_fail(BOUGH_IO, "cannot read '%.200s': %s", path, why);
    }
    if (bough_is_ok(&status)) status = measure(&p);
    if (bough_is_ok(&status)) choose_scales(&p);
    if (bough_is_ok(&status)) status = write_file(&p);
    if (p.in) fclose(p.in);
    free(p.row);
    free(p.range);
    free(p.scale);
    free(p.offset);
    return status;
}
