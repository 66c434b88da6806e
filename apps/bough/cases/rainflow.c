#include "apps/bough/cases/counts.h"

#include <math.h>
#include <string.h>

static void count(bough_rainflow *r, double range, double cycles) {
    for (int i = 0; i < r->n_slope; i++) r->damage[i] += cycles * pow(range, r->slope[i]);
    r->cycles += cycles;
    bough_levels_add(&r->ranges, range, cycles);
}

static double range_before(const bough_rainflow *r, int back) {
    return fabs(r->point[r->n - back] - r->point[r->n - back - 1]);
}

// Step 5: half a cycle, whose first point goes.
static void count_start(bough_rainflow *r) {
    count(r, range_before(r, 2), 0.5);
    memmove(r->point, r->point + 1, (size_t)--r->n * sizeof *r->point);
}

// Step 4: a whole cycle, whose two points go.
static void count_inside(bough_rainflow *r) {
    count(r, range_before(r, 2), 1);
    r->point[r->n - 3] = r->point[r->n - 1];
    r->n -= 2;
}

static void turn(bough_rainflow *r, double point) {
    r->point[r->n++] = point;
    while (r->n >= 3 && range_before(r, 1) >= range_before(r, 2)) {
        if (r->n == 3)
            count_start(r);
        else
            count_inside(r);
    }
    if (r->n < BOUGH_RAINFLOW_OPEN) return;
    count(r, range_before(r, 1), 1);
    r->forced++;
    r->n -= 2;
}

void bough_rainflow_add(bough_rainflow *r, double x) {
    if (!r->started) {
        r->started = true;
        r->point[r->n++] = r->last = x;
        return;
    }
    int direction = (x > r->last) - (x < r->last);
    if (direction == 0) return;
    if (r->direction != 0 && direction != r->direction) turn(r, r->last);
    r->direction = direction;
    r->last = x;
}

void bough_rainflow_finish(bough_rainflow *r) {
    if (r->direction != 0) turn(r, r->last);
    for (; r->n > 1; r->n--) count(r, range_before(r, 1), 0.5);
}

double bough_equivalent_load(double sum, double slope, double cycles) { return pow(sum / cycles, 1 / slope); }
