// bough diff: what differs between the channels of two results, at the times that both have.
#include "apps/bough/cli/command.h"
#include "apps/bough/results/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FREE_LINES = 6, NAME = 48, MOST_CHANNELS = 20000 };

// One channels.out, a row at a time.
typedef struct reading {
    const char *folder;
    FILE *file;
    char *line; // getline's
    size_t room;
    long at;            // lines read
    int n;              // columns, the time included
    char (*name)[NAME]; // (n)
    char (*unit)[NAME]; // (n) with brackets
    double *value;      // (n) of the present row
} reading;

// A channel of both.
typedef struct pair {
    int first, second;     // its columns
    double low, high;      // of both, in its unit
    double largest, where; // difference, and its time [s]
} pair;

static bough_status damaged(const reading *r) {
    return bough_fail(BOUGH_INVALID, "%.200s/channels.out:%ld: not a row of its columns", r->folder, r->at);
}

static void close_reading(void *self) {
    reading *r = self;
    if (r->file) fclose(r->file);
    free(r->line);
}

static bool next_line(reading *r) {
    r->at++;
    return getline(&r->line, &r->room, r->file) >= 0;
}

static int split(char *line, char (*word)[NAME]) {
    int n = 0;
    for (char *part = strtok(line, " \t\r\n"); part && n < MOST_CHANNELS;
         part = strtok(NULL, " \t\r\n"), n++) {
        if (word) snprintf(word[n], NAME, "%s", part);
    }
    return n;
}

static bough_status open_reading(bough_arena *arena, const char *folder, reading *r) {
    *r = (reading){.folder = folder};
    BOUGH_TRY(bough_report_open(folder, "channels.out", &r->file));
    if (!r->file)
        return bough_fail(BOUGH_INVALID, "'%.200s' holds no run's results: no channels.out", folder);
    bough_arena_on_destroy(arena, close_reading, r);
    while (r->at < FREE_LINES && next_line(r)) {
    }
    if (!next_line(r)) return damaged(r);
    char *copy = bough_arena_string(arena, r->line);
    r->n = split(copy, NULL);
    r->name = bough_arena_take(arena, ((size_t)r->n + 1) * sizeof *r->name);
    r->unit = bough_arena_take(arena, ((size_t)r->n + 1) * sizeof *r->unit);
    r->value = bough_arena_doubles(arena, (size_t)r->n + 1);
    split(r->line, r->name);
    if (!next_line(r) || split(bough_arena_string(arena, r->line), NULL) != r->n || r->n < 1)
        return damaged(r);
    split(r->line, r->unit);
    return bough_ok();
}

// *more is false behind the last row.
static bough_status next_row(reading *r, bool *more) {
    *more = next_line(r);
    if (!*more) return bough_ok();
    char *at = r->line, *end;
    for (int k = 0; k < r->n; k++, at = end) {
        r->value[k] = strtod(at, &end);
        if (end == at) return damaged(r);
    }
    return bough_ok();
}

static int find_pairs(const reading *a, const reading *b, pair *list) {
    int n = 0;
    for (int i = 1; i < a->n; i++) {
        for (int k = 1; k < b->n; k++) {
            bool same = strcmp(a->name[i], b->name[k]) == 0 && strcmp(a->unit[i], b->unit[k]) == 0;
            if (!same) continue;
            list[n++] = (pair){i, k, HUGE_VAL, -HUGE_VAL, 0, a->value[0]};
            break;
        }
    }
    return n;
}

// Angles near their jump differ by a whole turn. A value that is none differs by all.
static double difference(const char *unit, double x, double y) {
    double off = strcmp(unit, "(deg)") == 0 ? fabs(remainder(x - y, 360)) : fabs(x - y);
    return off == off ? off : x != x && y != y ? 0 : HUGE_VAL;
}

static void compare(const reading *a, const reading *b, int n, pair *list) {
    for (int k = 0; k < n; k++) {
        pair *p = &list[k];
        double x = a->value[p->first], y = b->value[p->second], off = difference(a->unit[p->first], x, y);
        p->low = fmin(p->low, fmin(x, y));
        p->high = fmax(p->high, fmax(x, y));
        if (off > p->largest) p->largest = off, p->where = a->value[0];
    }
}

static double relative(const pair *p) {
    double range = p->high - p->low;
    return range > 0 ? p->largest / range : p->largest;
}

static int larger(const void *x, const void *y) {
    const pair *a = x, *b = y;
    double first = relative(a), second = relative(b);
    return first != second ? (first < second) - (first > second) : a->first - b->first;
}

static bough_status walk(reading *a, reading *b, int n, pair *list, long *rows) {
    bool more_a, more_b;
    bough_status status = next_row(a, &more_a);
    if (bough_is_ok(&status)) status = next_row(b, &more_b);
    while (bough_is_ok(&status) && more_a && more_b) {
        double apart = a->value[0] - b->value[0], same = 1e-9 * (1 + fabs(a->value[0]));
        if (fabs(apart) <= same) compare(a, b, n, list), ++*rows;
        if (apart <= same) status = next_row(a, &more_a);
        if (apart >= -same && bough_is_ok(&status)) status = next_row(b, &more_b);
    }
    return status;
}

static void print(const reading *a, const reading *b, int n, pair *list, long rows) {
    qsort(list, (size_t)n, sizeof *list, larger);
    printf("%ld times and %d channels in both", rows, n);
    if (a->n - 1 > n) printf(", %d only in %s", a->n - 1 - n, a->folder);
    if (b->n - 1 > n) printf(", %d only in %s", b->n - 1 - n, b->folder);
    printf("\n%-20s %14s %-10s %12s %12s\n", "channel", "difference", "", "of its range", "at [s]");
    for (int k = 0; k < n; k++) {
        printf("%-20s %14.6g %-10s", a->name[list[k].first], list[k].largest, a->unit[list[k].first]);
        if (list[k].largest > 0) {
            printf(" %12.2g %12.9g\n", relative(&list[k]), list[k].where);
        } else {
            printf(" %12s\n", "equal");
        }
    }
}

static const bough_option rows[] = {{0}};

static bough_status diff(bough_arena *arena, const void *given) {
    const bough_options *options = given;
    reading *a = bough_arena_take(arena, 2 * sizeof *a), *b = a + 1;
    bough_status status = open_reading(arena, options->operand, a);
    if (bough_is_ok(&status)) status = open_reading(arena, options->second, b);
    if (!bough_is_ok(&status)) return status;
    pair *list = bough_arena_take(arena, ((size_t)a->n + 1) * sizeof *list);
    int n = find_pairs(a, b, list);
    long common = 0;
    if (n == 0)
        return bough_fail(BOUGH_INVALID, "'%.200s' and '%.200s' have no channel in common", a->folder,
                          b->folder);
    status = walk(a, b, n, list, &common);
    if (bough_is_ok(&status) && common == 0)
        return bough_fail(BOUGH_INVALID, "'%.200s' and '%.200s' have no time in common", a->folder,
                          b->folder);
    if (bough_is_ok(&status)) print(a, b, n, list, common);
    return status;
}

const bough_command bough_command_diff = {
    .name = "diff",
    .summary =
        "compares the channels of two results: the largest difference of each over its range, and when",
    .operand = BOUGH_OPERAND_TWO,
    .operand_name = "DIR DIR",
    .option = rows,
    .size = sizeof(bough_options),
    .run = diff,
};
