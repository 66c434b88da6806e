#include "apps/bough/results/recorder.h"

#include <errno.h>
#include <float.h>
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
    bough_growing out;
    char *buffer;    // of the file (BUFFER)
    char *line;      // one row and its terminator (row_length + 1)
    double *value;   // (count)
    long outcome_at; // offset of the line with the outcome of the run
    long rows_at;    // offset of the first row
    long row_length; // of every row [bytes]
};

static bough_status write_error(const bough_recorder *r) {
    return bough_fail(BOUGH_IO, "cannot write '%.200s.partial' (%ld rows so far): %s", r->out.path,
                      r->out.count, errno ? strerror(errno) : "the device refused");
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
    return fwrite(line, 1, OUTCOME, r->out.file) == OUTCOME;
}

static bough_status write_head(bough_recorder *r, const char *title) {
    FILE *f = r->out.file;
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

// Writes the head again, for its outcome, and keeps the rows.
static bough_status go_on(bough_recorder *r, const bough_recorder_def *def) {
    rewind(r->out.file);
    BOUGH_TRY(write_head(r, def->title));
    bool same = r->rows_at + r->out.count * r->row_length == def->kept.bytes;
    if (same && fseek(r->out.file, def->kept.bytes, SEEK_SET) == 0) return bough_ok();
    return bough_fail(BOUGH_INVALID, "'%.200s.partial' has other channels", r->out.path);
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
    bough_recorder *r = *recorder = bough_arena_take(arena, sizeof *r);
    r->channels = def->channels;
    take_memory(r, arena);
    BOUGH_TRY(bough_growing_open(arena, def->folder, "channels.out", def->kept, &r->out));
    if (def->kept.count > 0) return go_on(r, def);
    setvbuf(r->out.file, r->buffer, _IOFBF, BUFFER);
    return write_head(r, def->title);
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
    if (fwrite(r->line, 1, length, r->out.file) != length) return write_error(r);
    r->out.count++;
    return bough_ok();
}

bough_status bough_recorder_keep(bough_recorder *r, bough_kept *kept) {
    return bough_growing_keep(&r->out, kept);
}

// Removes an incomplete last row, which a full device leaves and no reader expects.
static void cut_to_whole_rows(const bough_recorder *r) {
    char partial[BOUGH_PATH_MAX + 16];
    snprintf(partial, sizeof partial, "%s.partial", r->out.path);
    struct stat info;
    if (stat(partial, &info) != 0 || info.st_size <= r->rows_at) return;
    off_t rows = (info.st_size - r->rows_at) / r->row_length;
    // Nothing more can be done if this fails too: the file is marked incomplete as it is.
    if (truncate(partial, r->rows_at + rows * r->row_length) != 0) return;
}

bough_status bough_recorder_finish(bough_recorder *r, const bough_status *outcome) {
    char text[2 * OUTCOME];
    if (bough_is_ok(outcome)) {
        snprintf(text, sizeof text, "Complete: %ld rows", r->out.count);
    } else {
        snprintf(text, sizeof text, "INCOMPLETE: %ld rows, then %.280s", r->out.count, outcome->message);
    }
    errno = 0;
    // An earlier error counts too: the library may have dropped its buffer with it.
    FILE *file = r->out.file;
    bool written = !ferror(file) && fflush(file) == 0 && fseek(file, r->outcome_at, SEEK_SET) == 0 &&
                   write_outcome(r, text) && fflush(file) == 0;
    if (written) return bough_growing_finish(&r->out);
    bough_status status = write_error(r);
    fclose(file);
    r->out.file = NULL;
    cut_to_whole_rows(r);
    return status;
}

const double *bough_recorder_values(const bough_recorder *recorder) { return recorder->value; }

long bough_recorder_rows(const bough_recorder *recorder) { return recorder->out.count; }
