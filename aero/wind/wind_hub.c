// Hub-height wind files: rows over time, interpolated linearly.
#include "aero/wind/wind_hub.h"

#include "core/base/base.h"
#include "core/base/input_file.h"
#include "core/base/schedule.h"

enum { LINE = 1024, LEAST = 8, MOST = 9, MOST_ROWS = 1000000 };

// The numbers of a line, at most MOST of them; −1 if it has another word.
static int parse(const char *line, double *value) {
    int n = 0;
    for (const char *at = line;; n++) {
        at += strspn(at, " \t,\r\n");
        if (*at == '\0' || *at == '!' || n == MOST) return n;
        char *end;
        value[n] = strtod(at, &end);
        if (end == at || !isfinite(value[n])) return -1;
        at = end;
    }
}

static bool is_comment(const char *line) {
    line += strspn(line, " \t\r\n");
    return *line == '!' || *line == '\0';
}

static bough_wind_hub_row row_of(const double *v) {
    return (bough_wind_hub_row){v[0], v[1], v[2] * BOUGH_DEGREE, v[3], v[4], v[5],
                                v[6], v[7], v[8] * BOUGH_DEGREE};
}

// Times must increase; the ninth number, the upflow, may be missing. The direction turns the shorter way from
// one row to the next.
static bough_status read_row(const char *path, const char *line, int number, const bough_wind_hub_row *before,
                             bough_wind_hub_row *row) {
    double value[MOST] = {0};
    if (parse(line, value) < LEAST) {
        return bough_fail(BOUGH_INVALID,
                          "%s:%d: expected 8 or 9 numbers: time, speed, direction, vertical speed, "
                          "three shears, gust, upflow.",
                          path, number);
    }
    *row = row_of(value);
    if (before && !(row->time > before->time)) {
        return bough_fail(BOUGH_INVALID, "%s:%d: times must increase: %g s is followed by %g s.", path,
                          number, before->time, row->time);
    }
    if (before)
        row->direction = before->direction + remainder(row->direction - before->direction, 2 * BOUGH_PI);
    return bough_ok();
}

static bough_status read_rows(bough_arena *arena, FILE *stream, const char *path, bough_wind_hub *hub) {
    char line[LINE];
    bough_wind_hub_row *row = NULL;
    int n = 0, room = 0;
    for (int number = 1; fgets(line, LINE, stream); number++) {
        // a line that does not fit would be read as two
        if (!strchr(line, '\n') && !feof(stream)) {
            return bough_fail(BOUGH_INVALID, "%s:%d: the line is too long.", path, number);
        }
        if (is_comment(line)) continue;
        if (n == MOST_ROWS) {
            return bough_fail(BOUGH_INVALID, "%s:%d: more than %d rows.", path, number, (int)MOST_ROWS);
        }
        row = bough_arena_grow(arena, row, n, &room, sizeof *row);
        BOUGH_TRY(read_row(path, line, number, n > 0 ? row + n - 1 : NULL, row + n));
        n++;
    }
    if (n == 0) return bough_fail(BOUGH_INVALID, "%s: has no rows.", path);
    hub->n = n;
    hub->row = row;
    return bough_ok();
}

bough_status bough_wind_hub_read(bough_arena *arena, const char *path, bough_wind_hub *hub) {
    char why[BOUGH_INPUT_REASON];
    FILE *stream = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (!stream) {
        return bough_fail(BOUGH_INVALID, "cannot open the wind file %.220s: %s", path, why);
    }
    bough_status status = read_rows(arena, stream, path, hub);
    fclose(stream);
    return status;
}

// Held before the first and after the last row.
static bough_wind_hub_row row_at(const bough_wind_hub *hub, double t) {
    const bough_wind_hub_row *row = hub->row;
    if (!(t > row[0].time)) return row[0];
    if (t >= row[hub->n - 1].time) return row[hub->n - 1];
    // a row is MOST doubles, the first its time
    const double *a = &row->time + MOST * bough_table_row(hub->n, &row->time, MOST, t), *b = a + MOST;
    double w = (t - a[0]) / (b[0] - a[0]), between[MOST];
    for (int i = 0; i < MOST; i++) between[i] = (1 - w) * a[i] + w * b[i];
    bough_wind_hub_row x;
    memcpy(&x, between, sizeof x);
    return x;
}

// Power law; no wind below ground.
static double power_law(double height, double exponent) {
    if (exponent == 0) return 1;
    return height <= 0 ? 0 : pow(height, exponent);
}

bough_vec3 bough_wind_hub_at(const bough_wind_hub *hub, bough_vec3 position, double t) {
    bough_wind_hub_row r = row_at(hub, t);
    double c = cos(r.direction), s = sin(r.direction);
    // shear across the wind and above the hub, relative to the reference length
    double across = position.y * c + position.x * s;
    double above = position.z - hub->reference_height;
    double profile = power_law(position.z / hub->reference_height, r.exponent);
    double sheared = r.horizontal_shear * across + r.vertical_shear * above;
    double speed = r.speed * (profile + sheared / hub->reference_length) + r.gust;
    // inclined by the upflow, then into ground axes
    double cu = cos(r.upflow), su = sin(r.upflow), along = speed * cu - r.vertical * su;
    return bough_v3(along * c, -along * s, speed * su + r.vertical * cu);
}
