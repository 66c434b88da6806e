// The scales must be known before the first row, so channels.out is read twice: for ranges, and for
// rows. All numbers are little-endian.
#include "apps/bough/results/binary.h"

#include "apps/bough/results/folder.h"
#include "core/base/input_file.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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

static bool take_memory(packer *p) {
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
    if (!take_memory(&p)) status = bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
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
