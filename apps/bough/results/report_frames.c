// frames.pvd and the frames it lists, as apps/bough/results/frames.c writes them.
#include "apps/bough/results/report.h"

#include "apps/bough/results/folder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bough_status damaged(const char *folder, const char *name) {
    return bough_fail(BOUGH_INVALID, "%.200s/%.100s: not a frame that bough has written", folder, name);
}

// Reads on to the line that begins so.
static bool find_line(FILE *file, char *line, int room, const char *begin) {
    while (fgets(line, room, file)) {
        if (strncmp(line, begin, strlen(begin)) == 0) return true;
    }
    return false;
}

enum { LINE = 256 };

static bool put_points(FILE *file, FILE *out) {
    char line[LINE];
    if (!find_line(file, line, LINE, "<DataArray")) return false;
    while (fgets(line, LINE, file) && line[0] != '<') {
        double x, y, z;
        if (sscanf(line, "%lf %lf %lf", &x, &y, &z) != 3) return false;
        if (!isfinite(x + y + z)) return false;
        fprintf(out, ",%.5g,%.5g,%.5g", x, y, z);
    }
    return true;
}

// The lines' end points in the order of the bodies.
static bool put_ends(FILE *file, FILE *out) {
    char line[LINE];
    if (!find_line(file, line, LINE, "<DataArray type=\"Int32\" Name=\"offsets\"")) return false;
    fputs("ends: [", out);
    while (fgets(line, LINE, file) && line[0] != '<') fprintf(out, "%ld,", strtol(line, NULL, 10));
    fputs("]", out);
    return true;
}

static bough_status put_frame(const char *folder, const char *name, double t, FILE *out) {
    FILE *file;
    bough_status status = bough_report_open(folder, name, &file);
    if (!bough_is_ok(&status)) return status;
    if (!file) return damaged(folder, name);
    fprintf(out, "[%.9g", t);
    bool ok = put_points(file, out);
    fputs("],\n", out);
    fclose(file);
    return ok ? status : damaged(folder, name);
}

static bough_status put_lines(const char *folder, const char *name, FILE *out) {
    FILE *file;
    bough_status status = bough_report_open(folder, name, &file);
    if (!bough_is_ok(&status)) return status;
    if (!file) return damaged(folder, name);
    bool ok = put_ends(file, out);
    fclose(file);
    return ok ? status : damaged(folder, name);
}

bough_status bough_report_frames(const char *folder, FILE *out, bool *found) {
    FILE *list;
    bough_status status = bough_report_open(folder, "frames.pvd", &list);
    if (!bough_is_ok(&status) || !list) return status;
    char line[LINE], name[64], last[64] = "";
    double t;
    fputs("{frames: [\n", out);
    while (bough_is_ok(&status) && fgets(line, LINE, list)) {
        int n = sscanf(line, "<DataSet timestep=\"%lf\" file=\"%63[a-z0-9/.]\"/>", &t, name);
        if (n != 2 || !isfinite(t)) continue;
        status = put_frame(folder, name, t, out);
        memcpy(last, name, sizeof last);
    }
    fputs("], ", out);
    if (bough_is_ok(&status) && last[0]) status = put_lines(folder, last, out);
    fputs("}", out);
    fclose(list);
    *found = last[0] != 0;
    return status;
}
