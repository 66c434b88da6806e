#include "apps/bough/cli/static_path.h"

#include "apps/bough/model/equilibrium.h"
#include "apps/bough/results/channels.h"
#include "apps/bough/results/folder.h"

typedef struct table {
    FILE *file;
    const bough_channels *channels;
    double *value; // (channels->count)
    int point;
} table;

static void write_head(const table *t) {
    fputs("point,limit,share of the loads (-)", t->file);
    for (int i = 0; i < t->channels->count; i++)
        fprintf(t->file, ",%s (%s)", t->channels->channel[i].name, t->channels->channel[i].unit);
    fputc('\n', t->file);
}

static bough_status write_point(void *self, double time, double share, bool limit) {
    table *t = self;
    bough_channels_sample(t->channels, time, t->value);
    fprintf(t->file, "%d,%d,%.10g", t->point, limit, share);
    for (int i = 0; i < t->channels->count; i++) fprintf(t->file, ",%.10g", t->value[i]);
    fputc('\n', t->file);
    if (limit) printf("limit point: %.7g of the loads, point %d\n", share, t->point);
    t->point++;
    return bough_ok();
}

static void print_end(const bough_path_report *report) {
    printf("path: %d points, %d limit points, %d steps, ", report->points, report->limits, report->steps);
    printf("to %.7g of the loads\n", report->share);
    puts("mesh error: not estimated along a path");
}

bough_status bough_static_path(bough_arena *arena, bough_simulation *s, const char *folder) {
    char path[BOUGH_PATH_MAX];
    bough_path_report report;
    bough_channels channels = bough_channels_start(arena);
    bough_status status = bough_simulation_channels(s, &channels);
    if (!bough_is_ok(&status)) return status;
    table t = {.channels = &channels};
    t.value = bough_arena_doubles(arena, (size_t)channels.count + 1);
    status = bough_folder_make(folder);
    if (bough_is_ok(&status)) status = bough_folder_open(folder, "static-path.csv", path, &t.file);
    if (!bough_is_ok(&status)) return status;
    write_head(&t);
    bough_status followed =
        bough_simulation_path(s, s->master->assembly, (bough_path_listener){&t, write_point}, &report);
    if (report.points == 0) {
        bough_folder_discard(path, t.file);
        return followed;
    }
    print_end(&report);
    status = bough_folder_commit(path, t.file);
    if (bough_is_ok(&status)) printf("out: %s\n", path);
    return bough_is_ok(&followed) ? status : followed;
}
