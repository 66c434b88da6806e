// Reads frames.pvd and its frames, as apps/bough/results/frames.c writes them, and draws the shape of a
// frame.
#include "apps/bough/results/report.h"

#include "apps/bough/results/folder.h"
#include "apps/bough/results/picture.h"
#include "core/base/vec3.h"

// A frame as apps/bough/results/frames.c has written it.
typedef struct stored_frame {
    double time; // [s]
    int n_point, n_line;
    double *point;  // (n_point × 3) in ground axes [m]
    double *moment; // (n_point × 3) section moments in ground axes, 0 for bodies other than rods [N m]
    int *end;       // (n_line) behind each line's last point
} stored_frame;

static bough_status damaged(const char *folder, const char *name) {
    return bough_fail(BOUGH_INVALID, "%.200s/%.100s: not a frame that bough has written", folder, name);
}

enum { LINE = 256, NAME = 64, MOST_POINTS = 1 << 20 };

// Reads up to a line with that beginning.
static bool find_line(FILE *file, char line[LINE], const char *begin) {
    while (fgets(line, LINE, file)) {
        if (strncmp(line, begin, strlen(begin)) == 0) return true;
    }
    return false;
}

// The vectors of the next array: n rows.
static bool read_vectors(FILE *file, int n, double *x) {
    char line[LINE];
    if (!find_line(file, line, "<DataArray")) return false;
    for (int i = 0; i < n; i++, x += 3) {
        if (!fgets(line, LINE, file) || sscanf(line, "%lf %lf %lf", &x[0], &x[1], &x[2]) != 3) return false;
        if (!isfinite(x[0] + x[1] + x[2])) return false;
    }
    return true;
}

static bool read_ends(FILE *file, stored_frame *f) {
    char line[LINE];
    if (!find_line(file, line, "<DataArray type=\"Int32\" Name=\"offsets\"")) return false;
    for (int k = 0, before = 0; k < f->n_line; before = f->end[k++]) {
        if (!fgets(line, LINE, file) || sscanf(line, "%d", &f->end[k]) != 1) return false;
        if (f->end[k] <= before || f->end[k] > f->n_point) return false;
    }
    return true;
}

// Points, the lines' ends, forces and moments stand in this order.
static bool read_all(bough_arena *arena, FILE *file, stored_frame *f) {
    char line[LINE];
    if (!find_line(file, line, "<Piece") ||
        sscanf(line, "<Piece NumberOfPoints=\"%d\" NumberOfLines=\"%d\">", &f->n_point, &f->n_line) != 2 ||
        f->n_point < 1 || f->n_point > MOST_POINTS || f->n_line < 1 || f->n_line > f->n_point)
        return false;
    f->point = bough_arena_doubles(arena, 6 * (size_t)f->n_point);
    f->moment = f->point + 3 * f->n_point;
    f->end = bough_arena_take(arena, (size_t)f->n_line * sizeof *f->end);
    return read_vectors(file, f->n_point, f->point) && read_ends(file, f) &&
           read_vectors(file, f->n_point, f->moment) && read_vectors(file, f->n_point, f->moment);
}

static bough_status read_frame(bough_arena *arena, const char *folder, const char *name, stored_frame *f) {
    FILE *file;
    BOUGH_TRY(bough_report_open(folder, name, &file));
    bool good = file && read_all(arena, file, f);
    if (file) fclose(file);
    return good ? bough_ok() : damaged(folder, name);
}

// The next frame of the list.
static bool next_frame(FILE *list, double *t, char name[NAME]) {
    char line[LINE];
    while (fgets(line, LINE, list)) {
        int n = sscanf(line, "<DataSet timestep=\"%lf\" file=\"%63[a-z0-9/.]\"/>", t, name);
        if (n == 2 && isfinite(*t)) return true;
    }
    return false;
}

// The stored frame that is nearest to this time [s], the last one for HUGE_VAL; n_line is 0 where a run has
// stored none.
static bough_status find_frame(bough_arena *arena, const char *folder, double time, stored_frame *frame) {
    FILE *list;
    *frame = (stored_frame){0};
    bough_status status = bough_report_open(folder, "frames.pvd", &list);
    if (!bough_is_ok(&status) || !list) return status;
    char name[NAME], nearest[NAME] = "";
    double first = HUGE_VAL, last = -HUGE_VAL;
    for (double t; next_frame(list, &t, name);) {
        first = fmin(first, t), last = fmax(last, t);
        bool nearer = time < HUGE_VAL ? fabs(t - time) < fabs(frame->time - time) : t > frame->time;
        if (nearest[0] && !nearer) continue;
        frame->time = t;
        memcpy(nearest, name, sizeof nearest);
    }
    fclose(list);
    if (nearest[0] && time < HUGE_VAL && !(time >= first && time <= last))
        return bough_fail(BOUGH_INVALID,
                          "--at: %.200s/frames.pvd holds frames from %.6g s to %.6g s, not %.6g s", folder,
                          first, last, time);
    return nearest[0] ? read_frame(arena, folder, nearest, frame) : status;
}

static bough_status put_frame(bough_arena *arena, const char *folder, const char *name, double t, bool ends,
                              FILE *out) {
    bough_arena *own = bough_arena_child(arena);
    stored_frame f;
    bough_status status = read_frame(own, folder, name, &f);
    if (bough_is_ok(&status) && ends) {
        fputs("{ends: [", out);
        for (int k = 0; k < f.n_line; k++) fprintf(out, "%d,", f.end[k]);
        fputs("], frames: [\n", out);
    }
    if (bough_is_ok(&status)) {
        fprintf(out, "[%.9g", t);
        for (int i = 0; i < 3 * f.n_point; i++) fprintf(out, ",%.5g", f.point[i]);
        fputs("],\n", out);
    }
    bough_arena_destroy(own);
    return status;
}

bough_status bough_report_frames(bough_arena *arena, const char *folder, FILE *out, bool *found) {
    FILE *list;
    bough_status status = bough_report_open(folder, "frames.pvd", &list);
    if (!bough_is_ok(&status) || !list) return status;
    char name[NAME];
    for (double t; bough_is_ok(&status) && next_frame(list, &t, name); *found = true)
        status = put_frame(arena, folder, name, t, !*found, out);
    if (*found) fputs("]}", out);
    fclose(list);
    return status;
}

// -- the picture: parallel projection, true to scale, with the straight line from the root of each rod ---

enum { WIDTH = 640, TOP = 46, SIDE = 34, BOTTOM = 62, TALLEST = 560, RIGID = 3 };

typedef struct drawing {
    const stored_frame *frame;
    bough_vec3 across, up; // axes of the picture in the ground's
    double low[2], high[2];
    double scale, left, bottom; // [px/m], [px]
    FILE *svg;
} drawing;

static bough_vec3 point(const drawing *d, int i) { return bough_v3_load(d->frame->point + 3 * i); }

static double moment(const drawing *d, int i) { return bough_norm(bough_v3_load(d->frame->moment + 3 * i)); }

// Where the rod of points `at` to `end` would end if it went straight on from its first segment.
static bough_vec3 straight_end(const drawing *d, int at, int end) {
    double length = 0;
    for (int i = at + 1; i < end; i++) length += bough_norm(bough_sub(point(d, i), point(d, i - 1)));
    bough_vec3 first = bough_sub(point(d, at + 1), point(d, at));
    return bough_add(point(d, at), bough_scale(length / fmax(bough_norm(first), 1e-300), first));
}

static void include(drawing *d, bough_vec3 x) {
    const double at[2] = {bough_dot(d->across, x), bough_dot(d->up, x)};
    for (int k = 0; k < 2; k++) {
        d->low[k] = fmin(d->low[k], at[k]);
        d->high[k] = fmax(d->high[k], at[k]);
    }
}

// Viewed from upwind and from the side, 10 degrees from above.
static void look(drawing *d) {
    const double azimuth = 62 * BOUGH_DEGREE, height = 10 * BOUGH_DEGREE;
    bough_vec3 deep = bough_v3(cos(azimuth), sin(azimuth), 0);
    d->across = bough_v3(sin(azimuth), -cos(azimuth), 0);
    d->up = bough_add(bough_v3(0, 0, cos(height)), bough_scale(sin(height), deep));
}

// The picture's height [px].
static double fit(drawing *d) {
    double size[2];
    for (int k = 0, at = 0; k < d->frame->n_line; at = d->frame->end[k++]) {
        for (int i = at; i < d->frame->end[k]; i++) include(d, point(d, i));
        if (d->frame->end[k] - at > RIGID) include(d, straight_end(d, at, d->frame->end[k]));
    }
    for (int k = 0; k < 2; k++) size[k] = d->high[k] - d->low[k];
    double widest = fmax(fmax(size[0], size[1]), 1e-300);
    d->scale =
        fmin((WIDTH - 2 * SIDE) / fmax(size[0], 0.01 * widest), TALLEST / fmax(size[1], 0.01 * widest));
    d->left = 0.5 * (WIDTH - d->scale * size[0]);
    d->bottom = TOP + d->scale * size[1];
    return d->bottom + BOTTOM;
}

static void put(const drawing *d, char command, bough_vec3 x) {
    fprintf(d->svg, "%c%.1f %.1f", command, d->left + d->scale * (bough_dot(d->across, x) - d->low[0]),
            d->bottom - d->scale * (bough_dot(d->up, x) - d->low[1]));
}

// From blue at 0 to red.
static void put_colour(double fraction, FILE *svg) {
    static const double colour[3][3] = {{86, 140, 200}, {230, 159, 0}, {213, 60, 30}};
    int k = fraction < 0.5 ? 0 : 1;
    double f = 2 * fraction - k;
    int c[3];
    for (int i = 0; i < 3; i++) c[i] = (int)lround((1 - f) * colour[k][i] + f * colour[k + 1][i]);
    fprintf(svg, "#%02x%02x%02x", c[0], c[1], c[2]);
}

// Thinner towards the end, which shows where the root is.
static void draw_rod(const drawing *d, int at, int end) {
    double most = 1e-300;
    for (int i = at; i < end; i++) most = fmax(most, moment(d, i));
    fputs("<path class=\"weak-line\" stroke-dasharray=\"5 4\" d=\"", d->svg);
    put(d, 'M', point(d, at));
    put(d, 'L', straight_end(d, at, end));
    fputs("\"/>\n", d->svg);
    for (int i = at; i + 1 < end; i++) {
        double thick = 10 - 7 * (double)(i - at) / (end - at);
        fprintf(d->svg, "<path stroke-width=\"%.1f\" stroke=\"", thick);
        put_colour(0.5 * (moment(d, i) + moment(d, i + 1)) / most, d->svg);
        fputs("\" d=\"", d->svg);
        put(d, 'M', point(d, i));
        put(d, 'L', point(d, i + 1));
        fputs("\"/>\n", d->svg);
    }
}

static void draw_rigid(const drawing *d, int at, int end) {
    fputs("<path class=\"rigid\" d=\"", d->svg);
    for (int i = at; i < end; i++) put(d, i > at ? 'L' : 'M', point(d, i));
    fputs("\"/>\n", d->svg);
}

static void draw_lines(const drawing *d, bool rods) {
    for (int k = 0, at = 0; k < d->frame->n_line; at = d->frame->end[k++]) {
        bool rod = d->frame->end[k] - at > RIGID;
        if (rod == rods) (rod ? draw_rod : draw_rigid)(d, at, d->frame->end[k]);
    }
}

// A round length of about a fifth of the picture's width.
static double bar_length(const drawing *d) {
    double most = WIDTH / 5.0 / d->scale, power = pow(10, floor(log10(most)));
    return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
}

// The ground's axes: arrows of 30 px, shorter where they point away from the eye.
static void draw_axes(const drawing *d, double x, double y) {
    for (int k = 0; k < 3; k++) {
        double right = 30 * bough_dot(d->across, bough_unit3(k)), up = 30 * bough_dot(d->up, bough_unit3(k));
        fprintf(d->svg, "<path class=\"axis\" d=\"M%.1f %.1fl%.1f %.1f\"/>\n", x, y, right, -up);
        fprintf(d->svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%c</text>\n", x + 1.35 * right,
                y - 1.35 * up + 4, 'x' + k);
    }
}

static void draw_legend(const drawing *d, double height) {
    double bar = bar_length(d), y = height - 22, end = WIDTH - SIDE;
    fprintf(d->svg, "<path class=\"axis\" d=\"M%d %.1fv-5v5h%.1fv-5\"/>\n", SIDE, y, bar * d->scale);
    fprintf(d->svg, "<text x=\"%d\" y=\"%.1f\">%g m</text>\n", SIDE, y - 10, bar);
    for (int k = 0; k < 40; k++) {
        fprintf(d->svg, "<rect x=\"%.1f\" y=\"%.1f\" width=\"4.5\" height=\"8\" fill=\"", end - 160 + 4 * k,
                y - 8);
        put_colour(k / 39.0, d->svg);
        fputs("\"/>\n", d->svg);
    }
    fprintf(d->svg,
            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">section moment, of the rod's largest</text>\n",
            end, y - 14);
}

static void draw(const void *frame, FILE *svg) {
    drawing *d =
        &(drawing){.frame = frame, .low = {HUGE_VAL, HUGE_VAL}, .high = {-HUGE_VAL, -HUGE_VAL}, .svg = svg};
    look(d);
    double height = fit(d);
    bough_picture_begin(svg, WIDTH, (int)lround(height));
    fputs("<style>.weak-line{stroke:#8a939c}.rigid{stroke:#8a939c;stroke-width:7;fill:none}"
          "path{stroke-linecap:round;stroke-linejoin:round}</style>\n",
          svg);
    fprintf(svg, "<text x=\"%d\" y=\"26\">%.6g s, to scale; dashed: straight</text>\n", SIDE, d->frame->time);
    draw_lines(d, false);
    draw_lines(d, true);
    draw_axes(d, SIDE + 22, height - 90);
    draw_legend(d, height);
    fputs("</svg>\n", svg);
}

bough_status bough_report_shape(bough_arena *arena, const char *folder, double time, bool *drawn) {
    stored_frame frame;
    *drawn = false;
    BOUGH_TRY(find_frame(arena, folder, time, &frame));
    if (frame.n_line == 0 && time < HUGE_VAL)
        return bough_fail(BOUGH_INVALID, "--at: %.200s holds no frames; run with simulation.output.frames",
                          folder);
    if (frame.n_line == 0) return bough_ok();
    *drawn = true;
    return bough_folder_write(folder, "shape.svg", draw, &frame);
}
