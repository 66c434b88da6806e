// channels.out: names, units and rows after six free lines.
#include "apps/bough/results/report.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FREE_LINES = 6, MOST_ROWS = 4000, MOST_BYTES = 1 << 20 };

static bough_status damaged(const char *folder, long line) {
    return bough_fail(BOUGH_INVALID, "%.200s/channels.out:%ld: not a row of its columns", folder, line);
}

// The words of a line as strings; their number. Brackets around a unit are left out.
static int put_words(char *line, FILE *out) {
    int n = 0;
    fputc('[', out);
    for (char *word = strtok(line, " \t\r\n"); word; word = strtok(NULL, " \t\r\n")) {
        size_t length = strlen(word);
        bool bracket = length > 1 && word[0] == '(' && word[length - 1] == ')';
        fprintf(out, "%s\"", n++ > 0 ? "," : "");
        for (size_t i = bracket; i < length - bracket; i++) {
            if (isalnum((unsigned char)word[i]) || strchr("_-/.^*% ", word[i])) fputc(word[i], out);
        }
        fputc('"', out);
    }
    fputc(']', out);
    return n;
}

static bool put_row(const char *line, int n, FILE *out) {
    char *end;
    fputc('[', out);
    for (int k = 0; k < n; k++, line = end) {
        double value = strtod(line, &end);
        if (end == line || !isfinite(value)) return false;
        fprintf(out, k > 0 ? ",%.6g" : "%.9g", value);
    }
    fputs("],\n", out);
    return true;
}

// The number of lines; −1 if one is longer than any row of channels.
static long count_lines(FILE *file) {
    long n = 0, length = 0;
    for (int byte; (byte = fgetc(file)) != EOF && length < MOST_BYTES;) {
        length = byte == '\n' ? 0 : length + 1;
        n += byte == '\n';
    }
    rewind(file);
    return length < MOST_BYTES ? n : -1;
}

static bough_status put_rows(const char *folder, FILE *file, char **line, size_t *room, FILE *out) {
    long lines = count_lines(file), stride = 1 + (lines - FREE_LINES - 2) / MOST_ROWS, at = 0;
    int n = 0;
    if (lines < 0) return damaged(folder, 1);
    for (; getline(line, room, file) >= 0; at++) {
        if (at == FREE_LINES) {
            fputs("{names: ", out);
            n = put_words(*line, out);
        } else if (at == FREE_LINES + 1) {
            fputs(", units: ", out);
            if (put_words(*line, out) != n) return damaged(folder, at + 1);
            fputs(", rows: [\n", out);
        } else if (at > FREE_LINES + 1 && (at - FREE_LINES - 2) % stride == 0) {
            if (!put_row(*line, n, out)) return damaged(folder, at + 1);
        }
    }
    if (at < FREE_LINES + 2) return damaged(folder, at + 1);
    fputs("]}", out);
    return bough_ok();
}

bough_status bough_report_channels(const char *folder, FILE *out, bool *found) {
    FILE *file;
    bough_status status = bough_report_open(folder, "channels.out", &file);
    if (!bough_is_ok(&status) || !file) return status;
    char *line = NULL;
    size_t room = 0;
    status = put_rows(folder, file, &line, &room, out);
    free(line);
    fclose(file);
    *found = true;
    return status;
}
