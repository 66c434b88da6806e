#include "apps/bough/cases/perform.h"

#include "apps/bough/results/channels.h"
#include "apps/bough/results/folder.h"
#include "apps/bough/results/picture.h"

#include <math.h>
#include <stdlib.h>

// Of the picture [px].
enum { WIDE = 420, HIGH = 264, LEFT = 74, RIGHT = 16, TOP = 34, FOOT = 44, PER_ROW = 2 };

static int height_of(int n_panel) { return HIGH * ((n_panel + PER_ROW - 1) / PER_ROW); }

static bough_panel panel_at(FILE *svg, int k, bool logarithmic) {
    double left = WIDE * (k % PER_ROW), top = HIGH * (k / PER_ROW);
    return (bough_panel){svg, bough_axis_between(left + LEFT, left + WIDE - RIGHT, logarithmic),
                         bough_axis_between(top + HIGH - FOOT, top + TOP, false)};
}

static void draw_axes(bough_panel *p, const char *channel, const char *unit, const char *across) {
    char title[BOUGH_CHANNEL_NAME + BOUGH_CHANNEL_UNIT + 4];
    snprintf(title, sizeof title, "%s [%s]", channel, unit);
    bough_axis_widen(&p->x, 0.05);
    bough_axis_widen(&p->y, 0.05);
    bough_panel_axes(p, title, across);
}

// -- sweep ----------------------------------------------------------------------------------------

bough_case_plot bough_case_plot_take(bough_arena *arena, const bough_study *study) {
    int n = study->n_channel < BOUGH_CASE_PANELS ? study->n_channel : BOUGH_CASE_PANELS;
    size_t room = 3 * (size_t)n * (size_t)study->n_case;
    return (bough_case_plot){study, n, bough_arena_doubles(arena, room)};
}

void bough_case_plot_add(bough_case_plot *plot, int number, const bough_case_result *r) {
    bool good = r->done && bough_is_ok(&r->outcome);
    for (int k = 0; k < plot->n_panel; k++) {
        const bough_sample_statistics *s = &r->counts.channel[k].statistics;
        double *to = plot->value + 3 * (number * plot->n_panel + k);
        to[0] = good ? s->least : (double)NAN;
        to[1] = good ? s->most : (double)NAN;
        to[2] = good ? s->mean : (double)NAN;
    }
}

// The value of the grid's first key as a number; its place in the list where it is none.
static double across_of(const bough_study *s, int number) {
    const bough_study_axis *axis = &s->grid.axis[0];
    int i = s->cases[number].index[0];
    char *end;
    double x = strtod(axis->value.item[i].value, &end);
    return end == axis->value.item[i].value ? i : x;
}

static void draw_channel(const bough_case_plot *plot, int k, FILE *f) {
    const bough_study *s = plot->study;
    bough_panel p = panel_at(f, k, false);
    for (int i = 0; i < s->n_case; i++) {
        bough_axis_include(&p.x, across_of(s, i));
        for (int c = 0; c < 3; c++) bough_axis_include(&p.y, plot->value[3 * (i * plot->n_panel + k) + c]);
    }
    draw_axes(&p, s->channel[k], s->unit[k], s->grid.axis[0].key);
    for (int i = 0; i < s->n_case; i++) {
        const double *v = plot->value + 3 * (i * plot->n_panel + k);
        if (!isfinite(v[0])) continue;
        double x = bough_axis_place(&p.x, across_of(s, i));
        fprintf(f,
                "<path d=\"M%.1f %.1fV%.1f\" stroke=\"#56B4E9\" stroke-width=\"2\"/>"
                "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"#0072B2\"><title>",
                x, bough_axis_place(&p.y, v[0]), bough_axis_place(&p.y, v[1]), x,
                bough_axis_place(&p.y, v[2]));
        bough_picture_text(f, s->cases[i].settings);
        fprintf(f, ": %.5g (%.5g to %.5g)</title></circle>\n", v[2], v[0], v[1]);
    }
}

static void draw_sweep(const void *self, FILE *svg) {
    const bough_case_plot *plot = self;
    bough_picture_begin(svg, WIDE * PER_ROW, height_of(plot->n_panel));
    for (int k = 0; k < plot->n_panel; k++) draw_channel(plot, k, svg);
    fputs("</svg>\n", svg);
}

bough_status bough_case_plot_write(const bough_case_plot *plot, const char *folder) {
    return bough_folder_write(folder, "plot.svg", draw_sweep, plot);
}

// -- lifetime -------------------------------------------------------------------------------------

// Cycles of at least the range at the lower edge of bin k.
static double exceeded(const bough_levels *r, int64_t k) {
    double sum = 0;
    for (int64_t i = r->high; i >= k; i--) sum += bough_levels_inside(r, i);
    return sum;
}

static void draw_ranges(const bough_lifetime *l, int i, FILE *f) {
    const bough_levels *r = &l->channel[i].ranges;
    double width = bough_levels_width(r);
    bough_panel p = panel_at(f, i, true);
    for (int64_t k = r->low; r->started && k <= r->high; k++) {
        bough_axis_include(&p.x, exceeded(r, k));
        bough_axis_include(&p.y, width * (double)k);
    }
    draw_axes(&p, l->study->channel[i], l->study->unit[i], "cycles in the lifetime with at least this range");
    if (!r->started) return;
    fputs("<path fill=\"none\" stroke=\"#0072B2\" stroke-width=\"1.6\" d=\"", f);
    for (int64_t k = r->low; k <= r->high; k++) {
        double many = exceeded(r, k);
        if (many > 0) {
            fprintf(f, "%s%.1f %.1f", k == r->low ? "M" : "L", bough_axis_place(&p.x, many),
                    bough_axis_place(&p.y, width * (double)k));
        }
    }
    fputs("\"/>\n", f);
}

static void draw_lifetime(const void *self, FILE *svg) {
    const bough_lifetime *l = self;
    int n = l->study->n_channel < BOUGH_CASE_PANELS ? l->study->n_channel : BOUGH_CASE_PANELS;
    bough_picture_begin(svg, WIDE * PER_ROW, height_of(n));
    for (int i = 0; i < n; i++) draw_ranges(l, i, svg);
    fputs("</svg>\n", svg);
}

bough_status bough_lifetime_plot(const bough_lifetime *l, const char *folder) {
    return bough_folder_write(folder, "plot.svg", draw_lifetime, l);
}
