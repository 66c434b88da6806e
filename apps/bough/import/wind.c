#include "apps/bough/import/wind.h"

#include "core/base/bytes.h"
#include "core/base/input_file.h"

#include <strings.h>

enum { PATH = 1024, LINE = 1024, MOST_POINTS = 100000000, MOST_GRID = 4096 };

static bough_status bad(const char *path, const char *what) {
    return bough_fail(BOUGH_INVALID, "%.220s: %s", path, what);
}

// Opens the file, or refuses it with the reason.
static bough_status open_data(const char *path, FILE **file) {
    char why[BOUGH_INPUT_REASON];
    *file = bough_input_open(path, BOUGH_INPUT_DATA, why);
    return *file ? bough_ok() : bad(path, why);
}

// Values between −32767 and 32767 that a component's velocities are stored as.
static int16_t *take_values(bough_arena *arena, bough_wind_box *box) {
    int64_t n = 3 * (int64_t)box->n_z * box->n_y * box->n_time;
    if (n > 3 * (int64_t)MOST_POINTS) bough_arena_leave(arena);
    int16_t *value = bough_arena_take(arena, (size_t)n * sizeof *value);
    box->value = value;
    return value;
}

static size_t place_of(const bough_wind_box *box, int time, int z, int y, int component) {
    return 3 * (((size_t)time * (size_t)box->n_z + (size_t)z) * (size_t)box->n_y + (size_t)y) +
           (size_t)component;
}

static void finish(bough_wind_box *box, double middle, bool periodic) {
    box->periodic = periodic;
    box->bottom = middle - box->dz * (box->n_z - 1) / 2;
    box->half_width = box->dy * (box->n_y - 1) / 2;
    box->duration = box->dt * (box->n_time - (periodic ? 0 : 1));
}

// -- summary of Bladed's files --------------------------------------------------------------------

typedef struct summary {
    bool clockwise, periodic, left_handed;
    double hub, offset, mean, intensity[3]; // [m], [m], [m/s], [%]
} summary;

// Whether the line has the words, in any capitals.
static bool has(const char *line, const char *words) {
    size_t n = strlen(words);
    while (*line && strncasecmp(line, words, n) != 0) line++;
    return *line != '\0';
}

// The number after '=', or at the line's beginning.
static double number_in(const char *line) {
    const char *equals = strchr(line, '=');
    return strtod(equals ? equals + 1 : line, NULL);
}

static bool is_yes(const char *line) {
    line += strspn(line, " \t.");
    return *line && strchr("TtYy", *line);
}

static void read_summary_lines(FILE *file, summary *s) {
    char line[LINE];
    while (fgets(line, LINE, file)) {
        if (has(line, "CLOCKWISE")) s->clockwise = is_yes(line);
        if (s->hub == 0 && (has(line, "HUB HEIGHT") || has(line, "ZHUB"))) s->hub = number_in(line);
        if (has(line, "HEIGHT OFFSET")) s->offset = number_in(line);
        if (s->mean > 0 && has(line, "PERIODIC")) s->periodic = true;
        if (has(line, "BLADED LEFT-HAND RULE")) s->left_handed = true;
        if (!has(line, "UBAR")) continue;
        s->mean = number_in(line);
        for (int c = 0; c < 3 && fgets(line, LINE, file); c++) s->intensity[c] = number_in(line);
    }
}

static bough_status read_summary(const char *path, summary *s) {
    FILE *file;
    bough_status status = open_data(path, &file);
    if (!bough_is_ok(&status)) return status;
    *s = (summary){0};
    read_summary_lines(file, s);
    fclose(file);
    if (s->hub > 0 && s->mean > 0) return status;
    return bad(path, "expected lines 'HUB HEIGHT' and 'UBAR =' with their values");
}

// -- Bladed's binary file -------------------------------------------------------------------------

static bool read_int16(FILE *file, int *value) {
    unsigned char b[2];
    if (fread(b, 1, 2, file) != 2) return false;
    *value = bough_bytes_int16(b);
    return true;
}

typedef unsigned char word[4];

static bool read_words(FILE *file, word *to, int n) {
    return fread(to, sizeof *to, (size_t)n, file) == (size_t)n;
}

typedef struct bladed_head {
    int components, n_z, n_y, n_time;
    double dz, dy, dx, mean; // [m], [m/s]
    double intensity[3];     // [%]; 0: those of the summary
} bladed_head;

// Lengths in mm, the speed in 0.1 m/s, numbers of points in thousandths.
static bool read_old_head(FILE *file, int first, bladed_head *h) {
    int v[12], skipped;
    for (int i = 0; i < 12; i++) {
        if (!read_int16(file, &v[i])) return false;
    }
    *h = (bladed_head){-first,      v[10] / 1000, v[11] / 1000, 2 * v[3], 1e-3 * v[0],
                       1e-3 * v[1], 1e-3 * v[2],  0.1 * v[4],   {0}};
    for (int i = 0; h->components == 3 && i < 6; i++) {
        if (!read_int16(file, &skipped)) return false;
    }
    return true;
}

// The parts that depend on the turbulence model come before and after the common one.
static bool read_new_head(FILE *file, bladed_head *h) {
    int model;
    word own[7], common[12], rest[12];
    *h = (bladed_head){.components = 3};
    if (!read_int16(file, &model)) return false;
    if (model == 1 || model == 2) h->components = 1;
    if (model == 4) {
        if (!read_words(file, own, 7)) return false;
        h->components = bough_bytes_int32(own[0]);
        for (int c = 0; c < 3; c++) h->intensity[c] = bough_bytes_float(own[4 + c]);
    }
    if (model == 7 || model == 8) {
        if (!read_words(file, own, 2)) return false;
        h->components = bough_bytes_int32(own[1]);
    }
    if (!read_words(file, common, 12)) return false;
    h->dz = bough_bytes_float(common[0]);
    h->dy = bough_bytes_float(common[1]);
    h->dx = bough_bytes_float(common[2]);
    int half = bough_bytes_int32(common[3]);
    h->n_time = half > 0 && half < MOST_POINTS ? 2 * half : 0;
    h->mean = bough_bytes_float(common[4]);
    h->n_z = bough_bytes_int32(common[10]);
    h->n_y = bough_bytes_int32(common[11]);
    if (h->components == 3 && !read_words(file, rest, 6)) return false;
    if (model == 7 && !read_words(file, rest, 2)) return false;
    return model != 8 || (read_words(file, rest, 8) && read_words(file, rest, 8));
}

static bool is_sound(const bladed_head *h) {
    return (h->components == 1 || h->components == 3) && h->n_z >= 2 && h->n_y >= 2 && h->n_z < MOST_GRID &&
           h->n_y < MOST_GRID && h->n_time >= 2 && h->dz > 0 && h->dy > 0 && h->dx > 0 && h->mean > 0 &&
           isfinite(h->dz + h->dy + h->dx + h->mean) && (int64_t)h->n_z * h->n_y * h->n_time <= MOST_POINTS;
}

static bough_status read_grid(FILE *file, const char *path, const bladed_head *h, const summary *s,
                              const bough_wind_box *box, int16_t *value) {
    for (int t = 0; t < box->n_time; t++) {
        for (int z = 0; z < box->n_z; z++) {
            for (int y = 0; y < box->n_y; y++) {
                int at = s->clockwise ? box->n_y - 1 - y : y, v;
                for (int c = 0; c < h->components; c++) {
                    if (!read_int16(file, &v)) return bad(path, "it ends before its last velocity");
                    value[place_of(box, t, z, at, c)] = (int16_t)v;
                }
            }
        }
    }
    return bough_ok();
}

static bough_status read_bladed(bough_arena *arena, FILE *file, const char *path, const summary *s,
                                bough_wind_box *box) {
    int first;
    bladed_head h = {0};
    bool good =
        read_int16(file, &first) &&
        (first == -99 ? read_new_head(file, &h) : first < 0 && first >= -3 && read_old_head(file, first, &h));
    if (!good || !is_sound(&h)) return bad(path, "it is not a full-field file in Bladed's format");
    if (fabs(h.mean - s->mean) > 0.1) {
        return bad(path, "its mean speed is not that of the .sum file");
    }
    *box = (bough_wind_box){.n_z = h.n_z,
                            .n_y = h.n_y,
                            .n_time = h.n_time,
                            .dz = h.dz,
                            .dy = h.dy,
                            .dt = h.dx / h.mean,
                            .mean = h.mean,
                            .hub = s->hub};
    for (int c = 0; c < 3; c++) {
        double percent = h.intensity[c] > 0 ? h.intensity[c] : s->intensity[c];
        box->scale[c] = 1e-5 * h.mean * percent * (c == 1 && s->left_handed ? -1 : 1);
        if (c >= h.components || !(fabs(box->scale[c]) > 1e-12)) box->scale[c] = 1e-6;
    }
    box->offset[0] = -h.mean / box->scale[0];
    finish(box, s->hub - s->offset, s->periodic);
    return read_grid(file, path, &h, s, box, take_values(arena, box));
}

bough_status bough_wind_bladed_read(bough_arena *arena, const char *path, bough_wind_box *box) {
    char wind[PATH], sum[PATH];
    const char *dot = strrchr(path, '.');
    bool ends = dot && (strcmp(dot, ".wnd") == 0 || strcmp(dot, ".WND") == 0);
    snprintf(sum, sizeof sum, "%.*s.sum", ends ? (int)(dot - path) : (int)strlen(path), path);
    snprintf(wind, sizeof wind, "%s%s", path, ends ? "" : ".wnd");
    FILE *file;
    summary s;
    BOUGH_TRY(open_data(wind, &file));
    bough_status status = read_summary(sum, &s);
    if (bough_is_ok(&status)) status = read_bladed(arena, file, wind, &s, box);
    fclose(file);
    return status;
}

// -- HAWC -----------------------------------------------------------------------------------------

static double mean_at(const bough_hawc_def *d, double height) {
    if (height <= 0) return 0;
    if (d->profile == BOUGH_HAWC_POWER) return d->mean * pow(height / d->height, d->exponent);
    if (d->profile == BOUGH_HAWC_LOG) {
        return d->mean * fmax(log(height / d->roughness), 0) / log(d->height / d->roughness);
    }
    return d->mean;
}

// The velocities (nx × ny × nz, z fastest), y from its positive end.
static bough_status read_component(const char *path, size_t n, double *value) {
    FILE *file;
    bough_status status = open_data(path, &file);
    if (!bough_is_ok(&status)) return status;
    word read = {0};
    for (size_t i = 0; i < n && bough_is_ok(&status); i++) {
        if (!read_words(file, &read, 1)) status = bad(path, "it ends before its last velocity");
        value[i] = bough_bytes_float(read);
        if (!isfinite(value[i])) status = bad(path, "a velocity is not a number");
    }
    fclose(file);
    return status;
}

// The scale of a component.
static double factor_of(const bough_hawc_def *d, int component, const double *value) {
    if (d->scaling != 2) return d->scaling == 1 ? d->factor[component] : 1;
    double sum = 0, square = 0;
    size_t middle = (size_t)((d->ny - 1) / 2) * (size_t)d->nz + (size_t)((d->nz - 1) / 2);
    for (int x = 0; x < d->nx; x++) {
        double v = value[(size_t)x * (size_t)(d->ny * d->nz) + middle];
        sum += v;
        square += v * v;
    }
    double deviation = sqrt(fmax(square / d->nx - sum * sum / d->nx / d->nx, 0));
    return deviation > 0 ? d->sigma[component] / deviation : 0;
}

// Scales the field. Of u the mean over time of each point is removed where there is a scale, and the profile
// is added.
static void shape(const bough_hawc_def *d, int component, double bottom, double *value) {
    double factor = factor_of(d, component, value);
    size_t points = (size_t)(d->ny * d->nz);
    for (size_t p = 0; p < points; p++) {
        double mean = 0, own = component == 0 ? mean_at(d, bottom + d->dz * (double)(p % (size_t)d->nz)) : 0;
        for (int x = 0; x < d->nx && component == 0 && d->scaling != 0; x++)
            mean += factor * value[(size_t)x * points + p] / d->nx;
        for (int x = 0; x < d->nx; x++)
            value[(size_t)x * points + p] = factor * value[(size_t)x * points + p] - mean + own;
    }
}

// Puts a component into the box, whose sixteen bits cover its range.
static void store(const bough_wind_box *box, int component, const double *from, size_t n, double *scale,
                  double *offset, int16_t *value) {
    double low = from[0], high = from[0];
    for (size_t i = 0; i < n; i++) {
        low = fmin(low, from[i]);
        high = fmax(high, from[i]);
    }
    *scale = fmax((high - low) / 65000, 1e-9);
    *offset = -(low + high) / 2 / *scale;
    for (int t = 0; t < box->n_time; t++) {
        for (int y = 0; y < box->n_y; y++) {
            for (int z = 0; z < box->n_z; z++) {
                double v = *from++ / *scale + *offset;
                value[place_of(box, t, z, box->n_y - 1 - y, component)] = (int16_t)lround(v);
            }
        }
    }
}

bough_status bough_wind_hawc_read(bough_arena *arena, const bough_hawc_def *def, bough_wind_box *box) {
    bool sound = def->nx >= 2 && def->ny >= 2 && def->nz >= 2 && def->ny < MOST_GRID && def->nz < MOST_GRID &&
                 (int64_t)def->nx * def->ny * def->nz <= MOST_POINTS && def->dx > 0 && def->dy > 0 &&
                 def->dz > 0 && def->mean > 0 && def->height > 0;
    if (sound && def->profile == BOUGH_HAWC_LOG) {
        sound = def->roughness > 0 && def->roughness < def->height;
    }
    if (!sound) {
        return bough_fail(BOUGH_INVALID,
                          "the wind in HAWC's form: expected at least 2 points in each direction, "
                          "positive distances, height and mean speed");
    }
    *box = (bough_wind_box){.n_z = def->nz,
                            .n_y = def->ny,
                            .n_time = def->nx,
                            .dz = def->dz,
                            .dy = def->dy,
                            .dt = def->dx / def->mean,
                            .mean = def->mean,
                            .hub = def->height};
    finish(box, def->height, true);
    size_t n = (size_t)def->nx * (size_t)(def->ny * def->nz);
    int16_t *value = take_values(arena, box);
    double *from = bough_arena_doubles(arena, n);
    for (int c = 0; c < 3; c++) {
        BOUGH_TRY(read_component(def->file[c], n, from));
        shape(def, c, box->bottom, from);
        store(box, c, from, n, &box->scale[c], &box->offset[c], value);
    }
    return bough_ok();
}

// -- in the scene ---------------------------------------------------------------------------------

bough_wind_form bough_wind_form_of(const char *path) {
    FILE *file;
    int first = 0;
    bough_status status = open_data(path, &file);
    if (!bough_is_ok(&status)) return BOUGH_WIND_UNIFORM_FILE; // whose reader says why
    bool read = read_int16(file, &first);
    fclose(file);
    if (read && (first == 7 || first == 8)) return BOUGH_WIND_TURBSIM;
    return read && first < 0 && first >= -256 ? BOUGH_WIND_BLADED : BOUGH_WIND_UNIFORM_FILE;
}

void bough_wind_made(bough_draft *d, const bough_wind_box *box, const char *path) {
    d->box = box;
    fputs("  wind: {kind: bts, file: " BOUGH_IMPORT_BOX, d->file[BOUGH_IMPORT_SCENE]);
    bough_draft_note(d, BOUGH_TAKEN, "wind of %s, as " BOUGH_IMPORT_BOX, path);
}

static void put(bough_draft *d, bough_wind_form form, const char *path, double height, double diameter) {
    FILE *file = d->file[BOUGH_IMPORT_SCENE];
    bool box = form == BOUGH_WIND_TURBSIM;
    fprintf(file, "  wind: {kind: %s, file: ", box ? "bts" : "wnd");
    bough_import_path(file, path);
    if (!box) {
        fprintf(file, ", reference_height: %.10g m, reference_length: %.10g m", height, diameter);
    }
    bough_draft_note(d, BOUGH_TAKEN, "wind of %s, by its path", path);
}

bough_status bough_wind_given(bough_draft *d, bough_wind_form form, const char *path, double height,
                              double diameter) {
    bough_wind_box *box = bough_arena_take(d->arena, sizeof *box);
    bough_wind_hub hub;
    bough_status status = bough_ok();
    switch (form) {
    case BOUGH_WIND_UNIFORM_FILE: status = bough_wind_hub_read(d->arena, path, &hub); break;
    case BOUGH_WIND_TURBSIM: status = bough_wind_box_read(d->arena, path, box); break;
    case BOUGH_WIND_BLADED: status = bough_wind_bladed_read(d->arena, path, box); break;
    }
    if (!bough_is_ok(&status)) return status;
    if (form == BOUGH_WIND_BLADED)
        bough_wind_made(d, box, path);
    else
        put(d, form, path, height, diameter);
    return status;
}
