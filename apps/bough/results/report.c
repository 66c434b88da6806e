#include "apps/bough/results/report.h"

#include "apps/bough/results/folder.h"
#include "core/base/arena.h"
#include "core/base/input_file.h"
#include "core/base/quote.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

bough_status bough_report_open(const char *folder, const char *name, FILE **file) {
    char path[BOUGH_PATH_MAX];
    *file = NULL;
    BOUGH_TRY(bough_folder_path(folder, name, path));
    char why[BOUGH_INPUT_REASON];
    *file = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (*file || errno == ENOENT || errno == ENOTDIR) return bough_ok();
    return bough_fail(BOUGH_IO, "cannot read '%.200s': %s", path, why);
}

// A file's text as a field of the data: never as a program, whoever has written it.
static bough_status add_file(const char *folder, const char *name, const char *field, FILE *out, bool *any) {
    char path[BOUGH_PATH_MAX], why[BOUGH_INPUT_REASON];
    size_t size;
    bough_status status = bough_folder_path(folder, name, path);
    if (!bough_is_ok(&status)) return status;
    bough_arena *arena = bough_arena_create();
    const char *text = bough_input_read(arena, path, BOUGH_INPUT_DATA, &size, why);
    if (text) {
        fprintf(out, "data.%s = ", field);
        bough_quote(out, text);
        fputs(";\n", out);
        *any = true;
    } else if (errno != ENOENT && errno != ENOTDIR) {
        status = bough_fail(BOUGH_IO, "cannot read '%.200s': %s", path, why);
    }
    bough_arena_destroy(arena);
    return status;
}

static bough_status add_part(const char *folder, const char *field,
                             bough_status (*part)(const char *, FILE *, bool *), FILE *out, bool *any) {
    bool found = false;
    fprintf(out, "data.%s = ", field);
    bough_status status = part(folder, out, &found);
    fputs(found ? ";\n" : "null;\n", out);
    *any = *any || found;
    return status;
}

// The rows of a command that leaves no table.txt.
static bough_status add_rows(const char *folder, FILE *out, bool *any) {
    static const char *const names[] = {"verify.csv", "blade-models.csv", "two-mass.csv", "added-mass.csv",
                                        "tune.csv",   "campbell.csv",     "modes.csv",    "static.csv"};
    bough_status status = bough_ok();
    for (size_t i = 0; i < sizeof names / sizeof *names && !*any && bough_is_ok(&status); i++) {
        status = add_file(folder, names[i], "rows", out, any);
    }
    return status;
}

static bough_status add_data(const char *folder, FILE *out) {
    bool any = false;
    fputs("const data = {};\n", out);
    bough_status status = add_file(folder, "summary.json", "summary", out, &any);
    if (bough_is_ok(&status)) status = add_file(folder, "table.txt", "table", out, &any);
    if (bough_is_ok(&status)) status = add_rows(folder, out, &any);
    if (bough_is_ok(&status)) status = add_file(folder, "cases.csv", "cases", out, &any);
    if (bough_is_ok(&status)) status = add_file(folder, "extremes.csv", "extremes", out, &any);
    static const char *const plots[] = {"plot.svg", "campbell.svg", "tune.svg"};
    for (size_t i = 0; i < sizeof plots / sizeof *plots && bough_is_ok(&status); i++)
        status = add_file(folder, plots[i], "plot", out, &any);
    if (bough_is_ok(&status)) {
        status = add_part(folder, "channels", bough_report_channels, out, &any);
    }
    if (bough_is_ok(&status)) status = add_part(folder, "shape", bough_report_frames, out, &any);
    if (!bough_is_ok(&status) || any) return status;
    return bough_fail(
        BOUGH_INVALID,
        "'%.200s' holds no results: a run leaves summary.json and channels.out, a study a table", folder);
}

static bough_status add_others(int n, const char *const *folder, FILE *out) {
    bough_status status = bough_ok();
    fputs("data.name = ", out);
    bough_quote(out, folder[0]);
    fputs(";\ndata.others = [\n", out);
    for (int k = 1; k < n && bough_is_ok(&status); k++) {
        bool found = false;
        fputs("{name: ", out);
        bough_quote(out, folder[k]);
        fputs(", channels: ", out);
        status = bough_report_channels(folder[k], out, &found);
        fputs("},\n", out);
        if (!bough_is_ok(&status) || found) continue;
        return bough_fail(BOUGH_INVALID, "'%.200s' holds no run's results: no channels.out", folder[k]);
    }
    fputs("];\n", out);
    return status;
}

bough_status bough_report_write(int n, const char *const *folder) {
    static const char mark[] = "@DATA@";
    const char *page = (const char *)bough_report_page, *data = strstr(page, mark);
    char path[BOUGH_PATH_MAX];
    FILE *out;
    BOUGH_TRY(bough_folder_path(folder[0], "report.html", path));
    struct stat there;
    if (stat(folder[0], &there) != 0) {
        return bough_fail(BOUGH_INVALID, "there is no folder '%.200s'", folder[0]);
    }
    BOUGH_TRY(bough_folder_open_partial(path, &out));
    fwrite(page, 1, (size_t)(data - page), out);
    bough_status status = add_data(folder[0], out);
    if (bough_is_ok(&status)) status = add_others(n, folder, out);
    if (!bough_is_ok(&status)) {
        bough_folder_discard(path, out);
        return status;
    }
    fputs(data + sizeof mark - 1, out);
    return bough_folder_commit(path, out);
}
