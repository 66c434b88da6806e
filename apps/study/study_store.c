#include "apps/study/study_store.h"

#include "apps/output/folder.h"
#include "core/input_file.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 8192, FIELDS = 14 };

static const char all_cells[] = "cells.csv";
static const char head[] =
    "fingerprint,settings,code,time [s],wall [s],cpu [s],defect_max [1],defect_rms [1],"
    "energy_residual [J],energy_exchanged [J],errors,estimates,warned,diagnosis\n";

static bough_status io_error(const bough_study_store *store, const char *what) {
    return bough_fail(BOUGH_IO, "cannot %s '%.200s': %s", what, store->path,
                      errno ? strerror(errno) : "an earlier write failed");
}

// -- writing --------------------------------------------------------------------------------------

void bough_csv_text(FILE *file, const char *text) {
    bool quoted = strpbrk(text, ",\"\r\n") != NULL;
    if (quoted) fputc('"', file);
    for (const char *c = text; *c; c++) {
        if (*c == '"') fputc('"', file);
        fputc(*c == '\n' || *c == '\r' ? ' ' : *c, file);
    }
    if (quoted) fputc('"', file);
}

static void write_line(FILE *f, const bough_study *s, const bough_study_cell *cell,
                       const bough_study_result *r) {
    fprintf(f, "%016" PRIx64 ",", s->fingerprint);
    bough_csv_text(f, cell->settings);
    fprintf(f, ",%d,%.17g,%.17g,%.17g,", (int)r->outcome.code, r->time, r->wall, r->cpu);
    const bough_coupling_report *c = &r->coupling;
    fprintf(f, "%.17g,%.17g,%.17g,%.17g,", c->defect_max, c->defect_rms, c->energy_residual,
            c->energy_exchanged);
    for (int i = 0; i < s->n_measure; i++)
        fprintf(f, "%s%.17g", i ? " " : "", r->error[i]);
    fputc(',', f);
    for (int i = 0; i < s->n_measure; i++)
        fprintf(f, "%s%.17g", i ? " " : "", r->estimate[i]);
    fprintf(f, ",%d,", r->warned);
    bough_csv_text(f, bough_is_ok(&r->outcome) ? "" : r->outcome.message);
    fputc('\n', f);
}

bough_status bough_study_store_add(const bough_study_store *store, const bough_study_cell *cell,
                                   const bough_study_result *result) {
    errno = 0;
    write_line(store->file, store->study, cell, result);
    if (ferror(store->file) || fflush(store->file) != 0) return io_error(store, "write");
    return bough_ok();
}

// -- reading --------------------------------------------------------------------------------------

// Splits a line in place; the number of its fields.
static int split(char *line, char *field[FIELDS]) {
    int n = 0;
    char *in = line;
    while (n < FIELDS) {
        char *out = field[n++] = in;
        bool quoted = *in == '"';
        if (quoted) in++;
        while (*in && (quoted || *in != ',')) {
            if (quoted && *in == '"' && *++in != '"') {
                quoted = false;
                continue;
            }
            *out++ = *in++;
        }
        bool more = *in == ',';
        *out = '\0';
        if (!more) return n;
        in++;
    }
    return FIELDS + 1;
}

static bool read_errors(const char *text, int n, double *error) {
    for (int i = 0; i < n; i++) {
        char *end;
        error[i] = strtod(text, &end);
        if (end == text) return false;
        text = end;
    }
    return *text == '\0';
}

static void read_result(char *const field[FIELDS], int n_measure, bough_study_result *r) {
    bough_study_result read = {
        .outcome = bough_ok(),
        .time = strtod(field[3], NULL),
        .wall = strtod(field[4], NULL),
        .cpu = strtod(field[5], NULL),
        .coupling = {strtod(field[6], NULL), strtod(field[7], NULL), strtod(field[8], NULL),
                     strtod(field[9], NULL)},
        .warned = atoi(field[12]) != 0,
        .done = true,
    };
    int code = atoi(field[2]);
    if (code != BOUGH_OK) read.outcome = bough_fail((bough_code)code, "%s", field[13]);
    bool whole = read_errors(field[10], n_measure, read.error) &&
                 read_errors(field[11], n_measure, read.estimate);
    if (whole) *r = read;
}

static void read_line(const bough_study *s, char *line, bough_study_result *reference,
                      bough_study_result *result) {
    char *field[FIELDS], fingerprint[20];
    snprintf(fingerprint, sizeof fingerprint, "%016" PRIx64, s->fingerprint);
    if (split(line, field) != FIELDS || strcmp(field[0], fingerprint) != 0) return;
    for (int i = 0; i < s->n_reference; i++) {
        if (strcmp(field[1], s->reference_cell[i].settings) == 0) {
            read_result(field, s->n_measure, &reference[i]);
        }
    }
    for (int i = 0; i < s->n_cell; i++) {
        if (strcmp(field[1], s->cell[i].settings) == 0) {
            read_result(field, s->n_measure, &result[i]);
        }
    }
}

// Whether the last line is whole; a killed process may have left half of one, or nothing.
static bool read_lines(FILE *file, const bough_study *s, bough_study_result *reference,
                       bough_study_result *result) {
    char line[LINE];
    bool whole = true;
    while (fgets(line, sizeof line, file)) {
        size_t length = strlen(line);
        whole = length > 0 && line[length - 1] == '\n';
        if (whole) line[length - 1] = '\0';
        read_line(s, line, reference, result);
    }
    return whole;
}

// Reads one file of the folder, if it is there.
static void read_file(const char *folder, const char *name, const bough_study *study,
                      bough_study_result *reference, bough_study_result *result) {
    char path[BOUGH_PATH_MAX];
    bough_status status = bough_folder_path(folder, name, path);
    char why[BOUGH_INPUT_REASON];
    FILE *file = bough_is_ok(&status) ? bough_input_open(path, BOUGH_INPUT_DATA, why) : NULL;
    if (!file) return;
    read_lines(file, study, reference, result);
    fclose(file);
}

// What parts of the study have left.
static void read_parts(const char *folder, const bough_study *study, bough_study_result *reference,
                       bough_study_result *result) {
    DIR *directory = opendir(folder);
    if (!directory) return;
    for (const struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        if (strncmp(entry->d_name, "cells-", 6) == 0) {
            read_file(folder, entry->d_name, study, reference, result);
        }
    }
    closedir(directory);
}

bough_status bough_study_store_open(bough_arena *arena, const char *folder, const char *name,
                                    const bough_study *study, bough_study_result *reference,
                                    bough_study_result *result, bough_study_store *store) {
    char path[BOUGH_PATH_MAX];
    bough_status status = bough_folder_path(folder, name, path);
    if (!bough_is_ok(&status)) return status;
    *store = (bough_study_store){.study = study, .path = bough_arena_string(arena, path)};
    if (strcmp(name, all_cells) != 0) read_file(folder, all_cells, study, reference, result);
    read_parts(folder, study, reference, result);
    char why[BOUGH_INPUT_REASON];
    errno = 0;
    FILE *earlier = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (!earlier && errno != ENOENT) {
        return bough_fail(BOUGH_IO, "cannot read '%.200s': %s", path, why);
    }
    if (earlier) fclose(earlier);
    errno = 0;
    store->file = fopen(path, "a+");
    if (!store->file) return io_error(store, "open");
    rewind(store->file);
    bool complete = read_lines(store->file, study, reference, result);
    bool good = fseek(store->file, 0, SEEK_END) == 0;
    if (good && !complete) good = fputc('\n', store->file) != EOF;
    if (good && ftell(store->file) == 0) good = fputs(head, store->file) >= 0;
    return good ? status : io_error(store, "write");
}

void bough_study_store_close(bough_study_store *store) {
    if (store->file) fclose(store->file);
    store->file = NULL;
}
