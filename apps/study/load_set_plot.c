#include "apps/study/load_set_plot.h"

#include "apps/output/folder.h"
#include "apps/output/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Of the picture [px].
enum { WIDE = 420, HIGH = 260, LEFT = 74, RIGHT = 16, TOP = 34, FOOT = 40, PER_ROW = 2 };

// Values to pixels, of the logarithm where that is told.
typedef struct scale {
    double low, high, from, to;
    bool logarithmic;
} scale;

typedef struct panel {
    FILE *svg;
    double left, top;
    scale x, y;
} panel;

static void include(scale *s, double v) {
    if (s->logarithmic) v = v > 0 ? log10(v) : (double)NAN;
    if (!isfinite(v)) return;
    s->low = fmin(s->low, v);
    s->high = fmax(s->high, v);
}

static void widen(scale *s) {
    if (!(s->low <= s->high)) s->low = 0, s->high = 1;
    double margin = s->high > s->low ? 0.05 * (s->high - s->low) : fmax(fabs(s->low) * 0.05, 1e-12);
    s->low -= margin;
    s->high += margin;
}

static double place(const scale *s, double v) {
    if (s->logarithmic) v = log10(v);
    return s->from + (s->to - s->from) * (v - s->low) / (s->high - s->low);
}

// -- drawing --------------------------------------------------------------------------------------

static void escape(FILE *f, const char *text) {
    for (const char *c = text; *c; c++) {
        if (*c == '<') fputs("&lt;", f);
        else if (*c == '&') fputs("&amp;", f);
        else fputc(*c, f);
    }
}

static bough_status open_picture(const char *folder, int n_panel, char path[BOUGH_PATH_MAX],
                                 FILE **f) {
    int rows = (n_panel + PER_ROW - 1) / PER_ROW;
    bough_status status = bough_folder_open(folder, "plot.svg", path, f);
    if (!bough_is_ok(&status)) return status;
    fprintf(*f, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
                "font-family=\"sans-serif\" font-size=\"11\">\n" BOUGH_PICTURE_STYLE,
            WIDE * PER_ROW, HIGH * rows);
    return status;
}

static panel panel_at(FILE *f, int k, bool logarithmic) {
    panel p = {.svg = f, .left = WIDE * (k % PER_ROW), .top = HIGH * (k / PER_ROW)};
    p.x = (scale){HUGE_VAL, -HUGE_VAL, p.left + LEFT, p.left + WIDE - RIGHT, logarithmic};
    p.y = (scale){HUGE_VAL, -HUGE_VAL, p.top + HIGH - FOOT, p.top + TOP, false};
    return p;
}

static double step_of(double span) {
    double power = pow(10, floor(log10(span / 5)));
    static const double steps[] = {1, 2, 5, 10};
    for (int i = 0; i < 4; i++)
        if (steps[i] * power >= span / 5) return steps[i] * power;
    return 10 * power;
}

static void draw_ticks(const panel *p, const scale *s, bool across) {
    double step = s->logarithmic ? fmax(1, ceil((s->high - s->low) / 8)) : step_of(s->high - s->low);
    for (double v = ceil(s->low / step) * step; v <= s->high; v += step) {
        double at = s->from + (s->to - s->from) * (v - s->low) / (s->high - s->low);
        double shown = s->logarithmic ? pow(10, v) : fabs(v) < 1e-9 * step ? 0 : v;
        if (across) {
            fprintf(p->svg, "<path d=\"M%.1f %.1fV%.1f\" class=\"grid\"/>"
                            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%.4g</text>\n",
                    at, p->y.from, p->y.to, at, p->y.from + 14, shown);
        } else {
            fprintf(p->svg, "<path d=\"M%.1f %.1fH%.1f\" class=\"grid\"/>"
                            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%.4g</text>\n",
                    p->x.from, at, p->x.to, p->x.from - 5, at + 4, shown);
        }
    }
}

static void draw_frame(panel *p, const char *title, const char *unit, const char *across) {
    widen(&p->x);
    widen(&p->y);
    draw_ticks(p, &p->x, true);
    draw_ticks(p, &p->y, false);
    fprintf(p->svg, "<text x=\"%.1f\" y=\"%.1f\" font-weight=\"bold\">", p->x.from, p->top + 22);
    escape(p->svg, title);
    fputs(" [", p->svg);
    escape(p->svg, unit);
    fprintf(p->svg, "]</text>\n<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">",
            (p->x.from + p->x.to) / 2, p->y.from + 30);
    escape(p->svg, across);
    fprintf(p->svg, "</text>\n<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" "
                    "fill=\"none\" stroke=\"#888\"/>\n",
            p->x.from, p->y.to, p->x.to - p->x.from, p->y.from - p->y.to);
}

// -- sweep ----------------------------------------------------------------------------------------

bough_case_plot bough_case_plot_take(bough_arena *arena, const bough_load_set *set) {
    int n = set->n_channel < BOUGH_CASE_PANELS ? set->n_channel : BOUGH_CASE_PANELS;
    size_t room = 3 * (size_t)n * (size_t)set->n_case;
    return (bough_case_plot){set, n, bough_arena_doubles(arena, room)};
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
static double across_of(const bough_load_set *s, int number) {
    const bough_study_axis *axis = &s->grid.axis[0];
    int i = s->cases[number].index[0];
    char *end;
    double x = strtod(axis->value.item[i].value, &end);
    return end == axis->value.item[i].value ? i : x;
}

static void draw_channel(const bough_case_plot *plot, int k, FILE *f) {
    const bough_load_set *s = plot->set;
    panel p = panel_at(f, k, false);
    for (int i = 0; i < s->n_case; i++) {
        include(&p.x, across_of(s, i));
        for (int c = 0; c < 3; c++) include(&p.y, plot->value[3 * (i * plot->n_panel + k) + c]);
    }
    draw_frame(&p, s->channel[k], s->unit[k], s->grid.axis[0].key);
    for (int i = 0; i < s->n_case; i++) {
        const double *v = plot->value + 3 * (i * plot->n_panel + k);
        if (!isfinite(v[0])) continue;
        double x = place(&p.x, across_of(s, i));
        fprintf(f, "<path d=\"M%.1f %.1fV%.1f\" stroke=\"#56B4E9\" stroke-width=\"2\"/>"
                   "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"#0072B2\"><title>", x,
                place(&p.y, v[0]), place(&p.y, v[1]), x, place(&p.y, v[2]));
        escape(f, s->cases[i].settings);
        fprintf(f, ": %.5g (%.5g to %.5g)</title></circle>\n", v[2], v[0], v[1]);
    }
}

bough_status bough_case_plot_write(const bough_case_plot *plot, const char *folder) {
    char path[BOUGH_PATH_MAX];
    FILE *f;
    bough_status status = open_picture(folder, plot->n_panel, path, &f);
    if (!bough_is_ok(&status)) return status;
    for (int k = 0; k < plot->n_panel; k++) draw_channel(plot, k, f);
    fputs("</svg>\n", f);
    return bough_folder_commit(path, f);
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
    panel p = panel_at(f, i, true);
    for (int64_t k = r->low; r->started && k <= r->high; k++) {
        include(&p.x, exceeded(r, k));
        include(&p.y, width * (double)k);
    }
    draw_frame(&p, l->set->channel[i], l->set->unit[i], "cycles in the life with at least this range");
    if (!r->started) return;
    fputs("<path fill=\"none\" stroke=\"#0072B2\" stroke-width=\"1.6\" d=\"", f);
    for (int64_t k = r->low; k <= r->high; k++) {
        double many = exceeded(r, k);
        if (many > 0) {
            fprintf(f, "%s%.1f %.1f", k == r->low ? "M" : "L", place(&p.x, many),
                    place(&p.y, width * (double)k));
        }
    }
    fputs("\"/>\n", f);
}

bough_status bough_lifetime_plot(const bough_lifetime *l, const char *folder) {
    int n = l->set->n_channel < BOUGH_CASE_PANELS ? l->set->n_channel : BOUGH_CASE_PANELS;
    char path[BOUGH_PATH_MAX];
    FILE *f;
    bough_status status = open_picture(folder, n, path, &f);
    if (!bough_is_ok(&status)) return status;
    for (int i = 0; i < n; i++) draw_ranges(l, i, f);
    fputs("</svg>\n", f);
    return bough_folder_commit(path, f);
}
