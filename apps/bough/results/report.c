#include "apps/bough/results/report.h"

#include "apps/bough/results/recorder.h"
#include "core/base/input_file.h"
#include "core/base/quote.h"

#include <ctype.h>
#include <errno.h>
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

// -- channels -------------------------------------------------------------------------------------

enum { MOST_ROWS = 4000 };

// The words as strings. Brackets around a unit are left out.
static void put_words(int n, const char *const *words, FILE *out) {
    for (int k = 0; k < n; k++) {
        const char *word = words[k];
        size_t length = strlen(word);
        bool bracket = length > 1 && word[0] == '(' && word[length - 1] == ')';
        fputs(k > 0 ? ",\"" : "[\"", out);
        for (size_t i = bracket; i < length - bracket; i++) {
            if (isalnum((unsigned char)word[i]) || strchr("_-/.^*% ", word[i])) fputc(word[i], out);
        }
        fputc('"', out);
    }
    fputc(']', out);
}

static bough_status put_row(const bough_rows *r, FILE *out) {
    for (int k = 0; k < r->n; k++) {
        if (!isfinite(r->value[k])) return bough_rows_damaged(r);
        fprintf(out, k > 0 ? ",%.6g" : "[%.9g", r->value[k]);
    }
    fputs("],\n", out);
    return bough_ok();
}

bough_status bough_report_channels(bough_arena *arena, const char *folder, FILE *out, bool *found) {
    bough_rows *r;
    bough_status status = bough_rows_open(arena, folder, &r);
    *found = r != NULL;
    if (!bough_is_ok(&status) || !r) return status;
    fputs("{names: ", out);
    put_words(r->n, r->name, out);
    fputs(", units: ", out);
    put_words(r->n, r->unit, out);
    fputs(", rows: [\n", out);
    long stride = 1 + r->n_row / MOST_ROWS;
    for (long k = 0; bough_rows_line(r); k++) {
        if (k % stride != 0) continue;
        BOUGH_TRY(bough_rows_read(r));
        BOUGH_TRY(put_row(r, out));
    }
    fputs("]}", out);
    return bough_ok();
}

// -- the page -------------------------------------------------------------------------------------

// The texts that results may have; fields of one name are of different commands.
static const struct text {
    const char *field, *file;
    bool alone; // only where none of the files before exists
} texts[] = {
    {"summary", "summary.json", false},  {"table", "table.txt", false}, {"rows", "verify.csv", true},
    {"rows", "blade-models.csv", true},  {"rows", "tune.csv", true},    {"rows", "campbell.csv", true},
    {"rows", "modes.csv", true},         {"rows", "static.csv", true},  {"cases", "cases.csv", false},
    {"extremes", "extremes.csv", false}, {"plot", "plot.svg", false},   {"plot", "campbell.svg", false},
    {"plot", "tune.svg", false},
};

// A file's text as a field of the data: never as a program, whoever has written it.
static bough_status add_text(bough_arena *arena, const char *folder, const struct text *text, FILE *out,
                             bool *any) {
    char path[BOUGH_PATH_MAX], why[BOUGH_INPUT_REASON];
    size_t size;
    if (text->alone && *any) return bough_ok();
    BOUGH_TRY(bough_folder_path(folder, text->file, path));
    const char *content = bough_input_read(arena, path, BOUGH_INPUT_DATA, &size, why);
    if (content) {
        fprintf(out, "data.%s = ", text->field);
        bough_quote(out, content);
        fputs(";\n", out);
        *any = true;
    } else if (errno != ENOENT && errno != ENOTDIR) {
        return bough_fail(BOUGH_IO, "cannot read '%.200s': %s", path, why);
    }
    return bough_ok();
}

static bough_status add_part(bough_arena *arena, const char *folder, const char *field,
                             bough_report_part *part, FILE *out, bool *any) {
    bool found = false;
    fprintf(out, "data.%s = ", field);
    BOUGH_TRY(part(arena, folder, out, &found));
    fputs(found ? ";\n" : "null;\n", out);
    *any = *any || found;
    return bough_ok();
}

static bough_status add_data(bough_arena *arena, const char *folder, FILE *out) {
    bool any = false;
    fputs("const data = {};\n", out);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        BOUGH_TRY(add_text(arena, folder, &texts[i], out, &any));
    BOUGH_TRY(add_part(arena, folder, "channels", bough_report_channels, out, &any));
    BOUGH_TRY(add_part(arena, folder, "shape", bough_report_frames, out, &any));
    if (any) return bough_ok();
    return bough_fail(
        BOUGH_INVALID,
        "'%.200s' holds no results: a run leaves summary.json and channels.out, a study a table", folder);
}

static bough_status add_others(bough_arena *arena, int n, const char *const *folder, FILE *out) {
    fputs("data.name = ", out);
    bough_quote(out, folder[0]);
    fputs(";\ndata.others = [\n", out);
    for (int k = 1; k < n; k++) {
        bool found = false;
        fputs("{name: ", out);
        bough_quote(out, folder[k]);
        fputs(", channels: ", out);
        BOUGH_TRY(bough_report_channels(arena, folder[k], out, &found));
        fputs("},\n", out);
        if (found) continue;
        return bough_fail(BOUGH_INVALID, "'%.200s' holds no run's results: no channels.out", folder[k]);
    }
    fputs("];\n", out);
    return bough_ok();
}

bough_status bough_report_write(bough_arena *arena, int n, const char *const *folder) {
    static const char mark[] = "@DATA@";
    const char *page = (const char *)bough_report_page, *data = strstr(page, mark);
    char path[BOUGH_PATH_MAX];
    FILE *out;
    struct stat there;
    if (stat(folder[0], &there) != 0) {
        return bough_fail(BOUGH_INVALID, "there is no folder '%.200s'", folder[0]);
    }
    BOUGH_TRY(bough_folder_open(folder[0], "report.html", path, &out));
    fwrite(page, 1, (size_t)(data - page), out);
    bough_status status = add_data(arena, folder[0], out);
    if (bough_is_ok(&status)) status = add_others(arena, n, folder, out);
    fputs(data + sizeof mark - 1, out);
    return bough_folder_close(path, out, status);
}
