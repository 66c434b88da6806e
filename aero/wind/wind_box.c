// TurbSim's full-field files: read, interpolated linearly in time and space, written. Little-endian whatever
// the processor.
#include "aero/wind/wind_box.h"

#include "core/base/base.h"
#include "core/base/bytes.h"
#include "core/base/input_file.h"

enum { HEAD = 70, COUNTS = 4, FLOATS = 12, MOST_TEXT = 10000, PIECE = 4096 };

static bough_status bad(const char *path, const char *what) {
    return bough_fail(BOUGH_INVALID, "%s is not a TurbSim full-field file: %s.", path, what);
}

// Kind, then numbers of points in z, y and below the grid, and of times.
static bough_status read_counts(const char *path, const unsigned char *head, bough_wind_box *box) {
    int64_t count[COUNTS];
    int kind = bough_bytes_int16(head);
    if (kind != 7 && kind != 8) return bad(path, "it must begin with 7 or 8");
    box->periodic = kind == 8;
    for (int i = 0; i < COUNTS; i++) {
        count[i] = bough_bytes_int32(head + 2 + 4 * i);
        if (count[i] < (i == 2 ? 0 : 2) || count[i] > 100000000) {
            return bad(path, "a number of points or times is out of range");
        }
    }
    box->n_z = (int)count[0];
    box->n_y = (int)count[1];
    box->n_tower = (int)count[2];
    box->n_time = (int)count[3];
    return bough_ok();
}

// Distances, time step, mean speed, heights, then slope and offset of each component.
static bough_status read_measures(const char *path, const unsigned char *head, bough_wind_box *box) {
    double v[FLOATS];
    for (int i = 0; i < FLOATS; i++) {
        v[i] = bough_bytes_float(head + 2 + 4 * (COUNTS + i));
        if (!isfinite(v[i])) return bad(path, "a number in its head is not finite");
    }
    if (!(v[0] > 0 && v[1] > 0 && v[2] > 0 && v[3] > 0)) {
        return bad(path, "distances, time step and mean speed must be positive");
    }
    box->dz = v[0];
    box->dy = v[1];
    box->dt = v[2];
    box->mean = v[3];
    box->hub = v[4];
    box->bottom = v[5];
    for (int c = 0; c < 3; c++) {
        if (fabs(v[6 + 2 * c]) < 1e-30) return bad(path, "a slope is zero");
        box->scale[c] = 1 / v[6 + 2 * c];
        box->offset[c] = v[7 + 2 * c];
    }
    box->half_width = box->dy * (box->n_y - 1) / 2;
    box->duration = box->dt * (box->n_time - (box->periodic ? 0 : 1));
    return bough_ok();
}

// The number of values, when the file has as many bytes as its head promises. Factors are compared
// with the file's size before they are multiplied.
static bough_status count_values(const char *path, const bough_wind_box *box, int64_t text, int64_t size,
                                 int64_t *n) {
    int64_t points = (int64_t)box->n_z * box->n_y + box->n_tower;
    int64_t room = (size - HEAD - text) / 6; // of three int16
    if (text < 0 || text > MOST_TEXT) return bad(path, "the length of its text is out of range");
    *n = 0;
    if (points <= room && box->n_time <= room / points) *n = 3 * points * box->n_time;
    if (*n > 0 && HEAD + text + 2 * *n == size) return bough_ok();
    return bough_fail(BOUGH_INVALID,
                      "%s is damaged: it has %lld bytes, but its header gives %d times of %d "
                      "x %d points and %d of the tower.",
                      path, (long long)size, box->n_time, box->n_z, box->n_y, box->n_tower);
}

// Little-endian integers in portions.
static bough_status read_values(FILE *stream, const char *path, int64_t n, int16_t *value) {
    unsigned char piece[2 * PIECE];
    for (int64_t k = 0; k < n; k += PIECE) {
        size_t many = (size_t)(n - k < PIECE ? n - k : PIECE);
        if (fread(piece, 2, many, stream) != many) return bad(path, "it cannot be read to its end");
        for (size_t i = 0; i < many; i++) value[k + (int64_t)i] = bough_bytes_int16(piece + 2 * i);
    }
    return bough_ok();
}

static bough_status read_all(bough_arena *arena, FILE *stream, const char *path, bough_wind_box *box) {
    unsigned char head[HEAD];
    if (fseek(stream, 0, SEEK_END) != 0) return bad(path, "it is not a regular file");
    // header, then text of unknown length, then values to the end
    int64_t size = ftell(stream), n = 0;
    rewind(stream);
    if (fread(head, 1, HEAD, stream) != HEAD) return bad(path, "it is shorter than a head");
    BOUGH_TRY(read_counts(path, head, box));
    BOUGH_TRY(read_measures(path, head, box));
    int64_t text = bough_bytes_int32(head + HEAD - 4);
    BOUGH_TRY(count_values(path, box, text, size, &n));
    int16_t *value = bough_arena_take(arena, (size_t)n * sizeof *value);
    box->value = value;
    if (fseek(stream, (long)(HEAD + text), SEEK_SET) != 0) return bad(path, "it is not a regular file");
    return read_values(stream, path, n, value);
}

bough_status bough_wind_box_read(bough_arena *arena, const char *path, bough_wind_box *box) {
    char why[BOUGH_INPUT_REASON];
    FILE *stream = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (!stream) {
        return bough_fail(BOUGH_INVALID, "cannot open the wind file %.220s: %s", path, why);
    }
    *box = (bough_wind_box){0};
    bough_status status = read_all(arena, stream, path, box);
    fclose(stream);
    return status;
}

bool bough_wind_box_lasts(const bough_wind_box *box, double until) {
    return box->periodic || until + box->half_width / box->mean <= box->duration * (1 + 1e-9);
}

// A place between two of n points.
typedef struct place {
    int low, high;
    double weight; // of high
} place;

static place place_of(double x, int n) {
    // held outside
    double held = bough_clamp(x, 0, n - 1);
    int low = held < n - 1 ? (int)held : n - 2;
    return (place){low, low + 1, held - low};
}

// Taylor's hypothesis: the box moves with the mean wind.
static place time_of(const bough_wind_box *box, double x, double t) {
    double start = box->periodic ? 0 : box->half_width;
    double k = (t + (start - x) / box->mean) / box->dt;
    if (!box->periodic) return place_of(k, box->n_time);
    k -= box->n_time * floor(k / box->n_time); // rounding may leave the range
    int low = k >= 0 && k < box->n_time ? (int)k : 0;
    return (place){low, (low + 1) % box->n_time, bough_clamp(k - low, 0, 1)};
}

// v = (stored − offset)/slope
static bough_vec3 point_at(const bough_wind_box *box, int time, int64_t point) {
    int64_t points = (int64_t)box->n_z * box->n_y + box->n_tower;
    const int16_t *v = box->value + 3 * (time * points + point);
    return bough_v3((v[0] - box->offset[0]) * box->scale[0], (v[1] - box->offset[1]) * box->scale[1],
                    (v[2] - box->offset[2]) * box->scale[2]);
}

// Bilinear between four points of the grid.
static bough_vec3 grid_at(const bough_wind_box *box, int time, place y, place z) {
    int64_t low = (int64_t)z.low * box->n_y, high = (int64_t)z.high * box->n_y;
    bough_vec3 below =
        bough_between(point_at(box, time, low + y.low), point_at(box, time, low + y.high), y.weight);
    bough_vec3 above =
        bough_between(point_at(box, time, high + y.low), point_at(box, time, high + y.high), y.weight);
    return bough_between(below, above, z.weight);
}

// `depth` below the grid in points; the grid's middle column goes on in the tower points.
static bough_vec3 tower_at(const bough_wind_box *box, int time, double depth) {
    int64_t first = (int64_t)box->n_z * box->n_y;
    double held = fmin(depth, box->n_tower);
    int above = held < box->n_tower ? (int)held : box->n_tower - 1;
    place middle = place_of((box->n_y - 1) / 2., box->n_y), bottom = {0, 1, 0};
    bough_vec3 upper =
        above == 0 ? grid_at(box, time, middle, bottom) : point_at(box, time, first + above - 1);
    return bough_between(upper, point_at(box, time, first + above), held - above);
}

bough_vec3 bough_wind_box_at(const bough_wind_box *box, bough_vec3 position, double t) {
    place time = time_of(box, position.x, t);
    double height = (position.z - box->bottom) / box->dz;
    // below the grid: the column of tower points
    if (height < 0 && box->n_tower > 0) {
        return bough_between(tower_at(box, time.low, -height), tower_at(box, time.high, -height),
                             time.weight);
    }
    // held beyond the edges of the grid
    place z = place_of(height, box->n_z);
    place y = place_of((position.y + box->half_width) / box->dy, box->n_y);
    return bough_between(grid_at(box, time.low, y, z), grid_at(box, time.high, y, z), time.weight);
}

// -- writing -----------------------------------------------------------------------------------

enum { TEXT = 100 };

static void put_head(FILE *f, const bough_wind_box *box, const char *text) {
    const double measures[] = {box->dz, box->dy, box->dt, box->mean, box->hub, box->bottom};
    int length = (int)strnlen(text, TEXT);
    bough_put_bytes(f, box->periodic ? 8 : 7, 2);
    bough_put_bytes(f, (uint64_t)box->n_z, 4);
    bough_put_bytes(f, (uint64_t)box->n_y, 4);
    bough_put_bytes(f, (uint64_t)box->n_tower, 4);
    bough_put_bytes(f, (uint64_t)box->n_time, 4);
    for (int i = 0; i < 6; i++) bough_put_float(f, (float)measures[i]);
    for (int c = 0; c < 3; c++) {
        bough_put_float(f, (float)(1 / box->scale[c]));
        bough_put_float(f, (float)box->offset[c]);
    }
    bough_put_bytes(f, (uint64_t)length, 4);
    fwrite(text, 1, (size_t)length, f);
}

bool bough_wind_box_write(const bough_wind_box *box, const char *text, FILE *f) {
    int64_t points = (int64_t)box->n_z * box->n_y + box->n_tower;
    // header, then the stored integers as they are
    put_head(f, box, text);
    for (int64_t k = 0; k < 3 * points * box->n_time; k++) bough_put_bytes(f, (uint64_t)box->value[k], 2);
    return !ferror(f);
}
