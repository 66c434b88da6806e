// channels.out read back, and its rows as channels.outb.
#include "apps/bough/results/recorder.h"

#include "apps/bough/results/report.h"
#include "core/base/bytes.h"

#include <float.h>

// -- rows -----------------------------------------------------------------------------------------

enum { FREE_LINES = 6, HEAD_LINES = 8, MOST_BYTES = 1 << 20 };

bough_status bough_rows_damaged(const bough_rows *r) {
    return bough_fail(BOUGH_INVALID, "%.200s/channels.out:%ld: not a row of its columns", r->folder, r->at);
}

static void close_rows(void *self) {
    bough_rows *r = self;
    fclose(r->file);
    free(r->line);
}

// The number of lines; −1 if one is longer than any row of channels.
static long count_lines(FILE *file) {
    long n = 0, length = 0;
    for (int byte; (byte = fgetc(file)) != EOF && length < MOST_BYTES;) {
        length = byte == '\n' ? 0 : length + 1;
        n += byte == '\n';
    }
    rewind(file);
    return length < MOST_BYTES ? n : -1;
}

bool bough_rows_line(bough_rows *r) {
    r->at++;
    return getline(&r->line, &r->room, r->file) >= 0;
}

static const char **split(bough_arena *arena, const char *line, int *n) {
    char *text = bough_arena_string(arena, line);
    const char **word = bough_arena_take(arena, (strlen(line) / 2 + 1) * sizeof *word);
    *n = 0;
    for (char *w = strtok(text, " \t\r\n"); w; w = strtok(NULL, " \t\r\n")) word[(*n)++] = w;
    return word;
}

bough_status bough_rows_open(bough_arena *arena, const char *folder, bough_rows **rows) {
    FILE *file;
    *rows = NULL;
    BOUGH_TRY(bough_report_open(folder, "channels.out", &file));
    if (!file) return bough_ok();
    bough_rows *r = *rows = bough_arena_take(arena, sizeof *r);
    *r = (bough_rows){.folder = folder, .file = file};
    bough_arena_on_destroy(arena, close_rows, r);
    r->n_row = count_lines(file) - HEAD_LINES;
    bool good = r->n_row >= 0;
    int n_unit = 0;
    while (good && r->at < HEAD_LINES) {
        good = bough_rows_line(r);
        if (good && r->at == FREE_LINES + 1) r->name = split(arena, r->line, &r->n);
        if (good && r->at == HEAD_LINES) r->unit = split(arena, r->line, &n_unit);
    }
    if (!good || r->n < 1 || n_unit != r->n) return bough_rows_damaged(r);
    r->value = bough_arena_doubles(arena, (size_t)r->n);
    return bough_ok();
}

bough_status bough_rows_read(bough_rows *r) {
    char *at = r->line, *end;
    for (int k = 0; k < r->n; k++, at = end) {
        r->value[k] = strtod(at, &end);
        if (end == at) return bough_rows_damaged(r);
    }
    return bough_ok();
}

// -- channels.outb --------------------------------------------------------------------------------

// The scales must be known before the first row, so channels.out is read twice: for ranges, and for rows.

enum { FORMAT = 4, LEAST = -32768, STEPS = 65535 };

// Values of a channel beyond this have no scale in single precision.
static const double most_value = 1e30;

typedef struct packed {
    double low, high;    // of its values
    float scale, offset; // a value is stored as round(scale value + offset)
} packed;

typedef struct packer {
    const bough_binary_def *def;
    int n; // channels
    bough_rows *in;
    packed *channel; // (n)
    double start;    // of the first row [s]
    int32_t rows;
} packer;

// `row`: the number that the present line should have.
static bough_status read_row(const packer *p, bool there, long row) {
    bough_status status = there ? bough_rows_read(p->in) : bough_rows_damaged(p->in);
    if (bough_is_ok(&status) && row < INT32_MAX) return status;
    return bough_fail(BOUGH_IO, "cannot read row %ld of '%.200s/channels.out' again", row + 1,
                      p->def->folder);
}

static bough_status check_value(const packer *p, int k) {
    double x = p->in->value[1 + k];
    if (fabs(x) <= most_value) return bough_ok();
    return bough_fail(BOUGH_INVALID,
                      "channels.outb cannot hold %s = %g at %.9g s: leave out simulation.output.binary",
                      p->def->channels->channel[k].name, x, p->in->value[0]);
}

// Counts the rows at equal intervals and finds each channel's range.
static bough_status measure(packer *p) {
    for (long row = 0;; row++) {
        bool there = bough_rows_line(p->in);
        if (!there && row > 0) break;
        BOUGH_TRY(read_row(p, there, row));
        if (row == 0) p->start = p->in->value[0];
        double beat = p->start + (double)row * p->def->interval;
        if (fabs(p->in->value[0] - beat) > 0.01 * p->def->interval) break;
        for (int k = 0; k < p->n; k++) {
            double x = p->in->value[1 + k];
            BOUGH_TRY(check_value(p, k));
            if (row == 0 || x < p->channel[k].low) p->channel[k].low = x;
            if (row == 0 || x > p->channel[k].high) p->channel[k].high = x;
        }
        p->rows = (int32_t)row + 1;
    }
    return bough_ok();
}

// A range is widened by what rounding to single precision does to its ends, so that they fit.
static void choose_scales(packer *p) {
    for (int k = 0; k < p->n; k++) {
        packed *c = &p->channel[k];
        double low = c->low, high = c->high;
        double margin = (double)FLT_EPSILON * fmax(fabs(low), fabs(high));
        double width = fmax(high - low + 2 * margin, 1e-30);
        c->scale = (float)(STEPS / width);
        c->offset = (float)(LEAST - (low - margin) * (double)c->scale);
    }
}

static void put_unit(FILE *out, const char *unit, int width) {
    char word[BOUGH_CHANNEL_UNIT + 2];
    snprintf(word, sizeof word, "(%s)", unit);
    fprintf(out, "%-*s", width, word);
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

// Words are padded with blanks.
static void put_head(const packer *p, FILE *out) {
    const bough_channels *c = p->def->channels;
    int width = longest_word(c);
    bough_put_bytes(out, FORMAT, 2);
    bough_put_bytes(out, (uint64_t)width, 2);
    bough_put_bytes(out, (uint64_t)p->n, 4);
    bough_put_bytes(out, (uint64_t)p->rows, 4);
    bough_put_double(out, p->start);
    bough_put_double(out, p->def->interval);
    for (int k = 0; k < p->n; k++) bough_put_float(out, p->channel[k].scale);
    for (int k = 0; k < p->n; k++) bough_put_float(out, p->channel[k].offset);
    bough_put_bytes(out, strlen(p->def->title), 4);
    fprintf(out, "%s%-*s", p->def->title, width, "Time");
    for (int k = 0; k < p->n; k++) fprintf(out, "%-*s", width, c->channel[k].name);
    put_unit(out, "s", width);
    for (int k = 0; k < p->n; k++) put_unit(out, c->channel[k].unit, width);
}

static bough_status put_rows(packer *p, FILE *out) {
    rewind(p->in->file);
    for (p->in->at = 0; p->in->at < HEAD_LINES;) bough_rows_line(p->in);
    for (int32_t row = 0; row < p->rows; row++) {
        BOUGH_TRY(read_row(p, bough_rows_line(p->in), row));
        for (int k = 0; k < p->n; k++) {
            double at = p->in->value[1 + k] * (double)p->channel[k].scale + (double)p->channel[k].offset;
            long step = lround(fmin(fmax(at, LEAST), LEAST + STEPS));
            bough_put_bytes(out, (uint64_t)step, 2);
        }
    }
    return bough_ok();
}

static bough_status pack(bough_arena *arena, void *self) {
    packer *p = self;
    const char *folder = p->def->folder;
    char path[BOUGH_PATH_MAX];
    FILE *out;
    BOUGH_TRY(bough_rows_open(arena, folder, &p->in));
    if (!p->in || p->in->n != p->n + 1)
        return bough_fail(BOUGH_IO, "cannot read '%.200s/channels.out' again", folder);
    p->channel = bough_arena_take(arena, (size_t)p->n * sizeof *p->channel);
    BOUGH_TRY(measure(p));
    choose_scales(p);
    BOUGH_TRY(bough_folder_open(folder, "channels.outb", path, &out));
    put_head(p, out);
    return bough_folder_close(path, out, put_rows(p, out));
}

bough_status bough_binary_write(const bough_binary_def *def) {
    packer p = {.def = def, .n = def->channels->count};
    return bough_arena_use(pack, &p);
}
