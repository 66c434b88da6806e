// bough diff: differences between the channels of two results, at their common times.
#include "apps/bough/cli/command.h"
#include "apps/bough/results/recorder.h"

// A common channel.
typedef struct pair {
    int first, second;     // its column in either
    double low, high;      // of both, in its unit
    double largest, where; // difference, and its time [s]
} pair;

static bough_status open_rows(bough_arena *arena, const char *folder, bough_rows **r) {
    BOUGH_TRY(bough_rows_open(arena, folder, r));
    if (*r) return bough_ok();
    return bough_fail(BOUGH_INVALID, "'%.200s' holds no run's results: no channels.out", folder);
}

// *more is false after the last row.
static bough_status next_row(bough_rows *r, bool *more) {
    *more = bough_rows_line(r);
    return *more ? bough_rows_read(r) : bough_ok();
}

static int find_pairs(const bough_rows *a, const bough_rows *b, pair *list) {
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

// Angles are compared modulo 360 degrees. A NaN differs from every number by infinity.
static double difference(const char *unit, double x, double y) {
    double off = strcmp(unit, "(deg)") == 0 ? fabs(remainder(x - y, 360)) : fabs(x - y);
    return off == off ? off : x != x && y != y ? 0 : HUGE_VAL;
}

static void compare(const bough_rows *a, const bough_rows *b, int n, pair *list) {
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

static bough_status walk(bough_rows *a, bough_rows *b, int n, pair *list, long *rows) {
    bool more_a, more_b;
    BOUGH_TRY(next_row(a, &more_a));
    BOUGH_TRY(next_row(b, &more_b));
    while (more_a && more_b) {
        double later = a->value[0] - b->value[0], same = 1e-9 * (1 + fabs(a->value[0]));
        if (fabs(later) <= same) compare(a, b, n, list), ++*rows;
        if (later <= same) BOUGH_TRY(next_row(a, &more_a));
        if (later >= -same) BOUGH_TRY(next_row(b, &more_b));
    }
    return bough_ok();
}

static void print(const bough_rows *a, const bough_rows *b, int n, pair *list, long rows) {
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

static bough_status diff(bough_arena *arena, const void *given) {
    const bough_options *options = given;
    bough_rows *a, *b;
    BOUGH_TRY(open_rows(arena, options->operand, &a));
    BOUGH_TRY(open_rows(arena, options->operands[1], &b));
    pair *list = bough_arena_take(arena, ((size_t)a->n + 1) * sizeof *list);
    int n = find_pairs(a, b, list);
    long common = 0;
    if (n > 0) BOUGH_TRY(walk(a, b, n, list, &common));
    if (common == 0)
        return bough_fail(BOUGH_INVALID, "'%.200s' and '%.200s' have no %s in common", a->folder, b->folder,
                          n > 0 ? "time" : "channel");
    print(a, b, n, list, common);
    return bough_ok();
}

const bough_command bough_command_diff = {
    .name = "diff",
    .summary =
        "compares the channels of two results: the largest difference of each over its range, and when",
    .operands = "DIR DIR",
    .size = sizeof(bough_options),
    .run = diff,
};
