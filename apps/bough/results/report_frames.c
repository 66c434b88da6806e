// frames.pvd and the frames it lists, as apps/bough/results/frames.c writes them.
#include "apps/bough/results/report.h"

#include "apps/bough/results/folder.h"

#include <math.h>
#include <string.h>

static bough_status damaged(const char *folder, const char *name) {
    return bough_fail(BOUGH_INVALID, "%.200s/%.100s: not a frame that bough has written", folder, name);
}

enum { LINE = 256, NAME = 64, MOST_POINTS = 1 << 20 };

// Reads on to the line that begins so.
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

static bool read_ends(FILE *file, bough_stored_frame *f) {
    char line[LINE];
    if (!find_line(file, line, "<DataArray type=\"Int32\" Name=\"offsets\"")) return false;
    for (int k = 0, before = 0; k < f->n_line; before = f->end[k++]) {
        if (!fgets(line, LINE, file) || sscanf(line, "%d", &f->end[k]) != 1) return false;
        if (f->end[k] <= before || f->end[k] > f->n_point) return false;
    }
    return true;
}

// Points, the lines' ends, forces and moments stand in this order.
static bool read_all(bough_arena *arena, FILE *file, bough_stored_frame *f) {
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

static bough_status read_frame(bough_arena *arena, const char *folder, const char *name,
                               bough_stored_frame *f) {
    FILE *file;
    bough_status status = bough_report_open(folder, name, &file);
    if (!bough_is_ok(&status)) return status;
    if (!file) return damaged(folder, name);
    bool ok = read_all(arena, file, f);
    fclose(file);
    return ok ? status : damaged(folder, name);
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

bough_status bough_report_frame(bough_arena *arena, const char *folder, double time,
                                bough_stored_frame *frame) {
    FILE *list;
    *frame = (bough_stored_frame){0};
    bough_status status = bough_report_open(folder, "frames.pvd", &list);
    if (!bough_is_ok(&status) || !list) return status;
    char name[NAME], nearest[NAME] = "";
    for (double t; next_frame(list, &t, name);) {
        bool nearer = time < HUGE_VAL ? fabs(t - time) < fabs(frame->time - time) : t > frame->time;
        if (nearest[0] && !nearer) continue;
        frame->time = t;
        memcpy(nearest, name, sizeof nearest);
    }
    fclose(list);
    return nearest[0] ? read_frame(arena, folder, nearest, frame) : status;
}

static bough_status put_frame(bough_arena *arena, const char *folder, const char *name, double t, bool ends,
                              FILE *out) {
    bough_arena *own = bough_arena_child(arena);
    bough_stored_frame f;
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
