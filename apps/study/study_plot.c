#include "apps/study/study_plot.h"

#include "apps/output/folder.h"
#include "apps/output/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Of the picture [px].
enum {
    PANEL_WIDTH = 460,
    PANEL_HEIGHT = 400,
    LEFT = 76,
    RIGHT = 44,
    TOP = 24,
    BOTTOM = 56,
    TITLE_HEIGHT = 34,
    LEGEND_LINE = 20,
    LETTER = 7, // of the legend, rather wide; of the title a third more
    PER_ROW = 2,
};

// The palette of Okabe and Ito, told apart by colour-blind readers, without yellow, which is too pale on
// white, and with grey in place of black, which is none on dark pages.
static const char *const colours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                      "#E69F00", "#56B4E9", "#7A7A7A"};
enum { N_COLOUR = sizeof colours / sizeof *colours, N_SHAPE = 4 };

// An axis from `low` to `high`, logarithms to base 10, drawn from pixel `from` to `to`.
typedef struct scale {
    double low, high;
    double from, to;
} scale;

typedef struct panel {
    const bough_study_results *results;
    int measure;
    scale x, y;
    FILE *svg;
} panel;

// -- data -----------------------------------------------------------------------------------------

static int along(const bough_study *s) { return s->grid.axis[s->grid.n - 1].value.n; }

static int count_lines(const bough_study *s) { return s->n_cell / along(s); }

static double cost(const bough_study_result *r) { return r->cpu / r->time; }

// A logarithm needs a positive number: a run that equals the reference has no place.
static bool has_point(const bough_study_result *r, int measure) {
    return r->done && bough_is_ok(&r->outcome) && r->error[measure] > 0 && cost(r) > 0;
}

static void include(scale *s, double value) {
    s->low = fmin(s->low, log10(value));
    s->high = fmax(s->high, log10(value));
}

// A margin, and at least a factor of ten.
static void widen(scale *s) {
    if (s->low > s->high) s->low = s->high = 0;
    double margin = fmax(0.08 * (s->high - s->low), 0.5 * (1 - (s->high - s->low)));
    s->low -= margin;
    s->high += margin;
}

static void find_ranges(panel *p) {
    p->x.low = p->y.low = HUGE_VAL;
    p->x.high = p->y.high = -HUGE_VAL;
    for (int i = 0; i < p->results->study->n_cell; i++) {
        const bough_study_result *r = &p->results->result[i];
        if (!has_point(r, p->measure)) continue;
        include(&p->x, r->error[p->measure]);
        include(&p->y, cost(r));
    }
    widen(&p->x);
    widen(&p->y);
}

static double place(const scale *s, double value) {
    return s->from + (s->to - s->from) * (log10(value) - s->low) / (s->high - s->low);
}

// -- text -----------------------------------------------------------------------------------------

// Characters of a text in UTF-8.
static int letters(const char *text) {
    int n = 0;
    for (; *text; text++) n += (*text & 0xC0) != 0x80;
    return n;
}

static void put_text(FILE *svg, const char *text) {
    for (; *text; text++) {
        switch (*text) {
        case '&': fputs("&amp;", svg); break;
        case '<': fputs("&lt;", svg); break;
        case '>': fputs("&gt;", svg); break;
        default: fputc(*text, svg);
        }
    }
}

// Plain near 1, a power of ten elsewhere.
static void put_tick_label(FILE *svg, int factor, int decade) {
    if (decade >= -2 && decade <= 2) {
        fprintf(svg, "%.*f", decade < 0 ? -decade : 0, factor * pow(10, decade));
        return;
    }
    if (factor > 1) fprintf(svg, "%d·", factor);
    fprintf(svg, "10<tspan dy=\"-5\" font-size=\"9\">%s%d</tspan>", decade < 0 ? "−" : "",
            decade < 0 ? -decade : decade);
}

// -- axes -----------------------------------------------------------------------------------------

static void draw_tick_x(const panel *p, double at, int factor, int decade) {
    fprintf(p->svg, "<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>\n", at, p->y.from, p->y.to);
    fprintf(p->svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">", at, p->y.from + 17);
    put_tick_label(p->svg, factor, decade);
    fputs("</text>\n", p->svg);
}

static void draw_tick_y(const panel *p, double at, int factor, int decade) {
    fprintf(p->svg, "<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>\n", p->x.from, at, p->x.to);
    fprintf(p->svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">", p->x.from - 6, at + 4);
    put_tick_label(p->svg, factor, decade);
    fputs("</text>\n", p->svg);
}

// Every decade is labelled; on a short axis also its double and fivefold.
static void draw_ticks(const panel *p, const scale *s,
                       void (*draw)(const panel *, double, int, int)) {
    static const int factors[] = {1, 2, 5};
    int n = s->high - s->low < 2 ? 3 : 1;
    for (int decade = (int)floor(s->low); decade <= (int)ceil(s->high); decade++) {
        for (int i = 0; i < n; i++) {
            double value = factors[i] * pow(10, decade);
            if (log10(value) < s->low || log10(value) > s->high) continue;
            draw(p, place(s, value), factors[i], decade);
        }
    }
}

static void draw_axes(const panel *p) {
    const bough_study_measure *m = &p->results->study->measure[p->measure];
    draw_ticks(p, &p->x, draw_tick_x);
    draw_ticks(p, &p->y, draw_tick_y);
    fprintf(p->svg, "<path class=\"axis\" d=\"M%.1f %.1fV%.1fH%.1f\"/>\n", p->x.from, p->y.to,
            p->y.from, p->x.to);
    fprintf(p->svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">largest difference: ",
            0.5 * (p->x.from + p->x.to), p->y.from + 40);
    put_text(p->svg, m->name);
    fputs(" [", p->svg);
    put_text(p->svg, m->unit);
    fputs("]</text>\n", p->svg);
    double x = p->x.from - 52, y = 0.5 * (p->y.from + p->y.to);
    fprintf(p->svg,
            "<text transform=\"translate(%.1f %.1f) rotate(-90)\" text-anchor=\"middle\">"
            "CPU time per simulated second [s]</text>\n",
            x, y);
}

// -- lines ----------------------------------------------------------------------------------------

// Shapes differ as well as colours.
static void draw_marker(FILE *svg, double x, double y, int line) {
    fprintf(svg, "<path fill=\"%s\" d=\"", colours[line % N_COLOUR]);
    switch (line % N_SHAPE) {
    case 0: fprintf(svg, "M%.1f %.1fa4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0", x - 4.5, y); break;
    case 1: fprintf(svg, "M%.1f %.1fh8v8h-8z", x - 4, y - 4); break;
    case 2: fprintf(svg, "M%.1f %.1fl5.5 9.5h-11z", x, y - 6); break;
    default: fprintf(svg, "M%.1f %.1fl6 6l-6 6l-6 -6z", x, y - 6); break;
    }
    fputs("\"/>\n", svg);
}

static void draw_polyline(const panel *p, int line, int first, int n) {
    fprintf(p->svg, "<polyline fill=\"none\" stroke-width=\"1.6\" stroke=\"%s\" points=\"",
            colours[line % N_COLOUR]);
    for (int i = first; i < first + n; i++) {
        const bough_study_result *r = &p->results->result[i];
        if (!has_point(r, p->measure)) continue;
        fprintf(p->svg, "%.1f,%.1f ", place(&p->x, r->error[p->measure]), place(&p->y, cost(r)));
    }
    fputs("\"/>\n", p->svg);
}

static void draw_points(const panel *p, int line, int first, int n) {
    const bough_study *s = p->results->study;
    for (int i = first; i < first + n; i++) {
        const bough_study_result *r = &p->results->result[i];
        if (!has_point(r, p->measure)) continue;
        double x = place(&p->x, r->error[p->measure]), y = place(&p->y, cost(r));
        const char *value = bough_study_value(s, &s->cell[i], s->grid.n - 1);
        bool before = x + 7 + letters(value) * LETTER > p->x.to + RIGHT; // no room behind the point
        draw_marker(p->svg, x, y, line);
        fprintf(p->svg, "<text class=\"weak\" font-size=\"10\" x=\"%.1f\" y=\"%.1f\"%s>",
                before ? x - 7 : x + 7, y - 5, before ? " text-anchor=\"end\"" : "");
        put_text(p->svg, value);
        fputs("</text>\n", p->svg);
    }
}

static void draw_panel(panel *p) {
    int n = along(p->results->study);
    find_ranges(p);
    draw_axes(p);
    for (int line = 0; line < count_lines(p->results->study); line++)
        draw_polyline(p, line, line * n, n);
    for (int line = 0; line < count_lines(p->results->study); line++)
        draw_points(p, line, line * n, n);
}

// -- legend ---------------------------------------------------------------------------------------

// The settings that tell the line from others.
static void put_line_name(FILE *svg, const bough_study *s, int line) {
    const bough_study_cell *cell = &s->cell[line * along(s)];
    int said = 0;
    for (int i = 0; i + 1 < s->grid.n; i++) {
        if (s->grid.axis[i].value.n < 2) continue;
        if (said++) fputs(", ", svg);
        put_text(svg, bough_study_value(s, cell, i));
    }
    if (!said) put_text(svg, s->grid.axis[s->grid.n - 1].label);
}

// Runs of the line that have no point, and why.
static void put_missing(FILE *svg, const bough_study_results *results, int line) {
    const bough_study *s = results->study;
    int n = along(s), said = 0;
    for (int i = line * n; i < (line + 1) * n; i++) {
        const bough_study_result *r = &results->result[i];
        if (has_point(r, 0)) continue;
        char status[40];
        bough_study_status(r, status);
        fputs(said++ ? "; " : " — ", svg);
        put_text(svg, bough_study_value(s, &s->cell[i], s->grid.n - 1));
        fputc(' ', svg);
        put_text(svg, strcmp(status, "ok") == 0 ? "equals the reference" : status);
    }
}

static void draw_legend(FILE *svg, const bough_study_results *results, double y) {
    for (int line = 0; line < count_lines(results->study); line++, y += LEGEND_LINE) {
        fprintf(svg, "<path stroke=\"%s\" stroke-width=\"1.6\" d=\"M%d %.1fh28\"/>\n",
                colours[line % N_COLOUR], LEFT, y);
        draw_marker(svg, LEFT + 14, y, line);
        fprintf(svg, "<text x=\"%d\" y=\"%.1f\">", LEFT + 36, y + 4);
        put_line_name(svg, results->study, line);
        put_missing(svg, results, line);
        fputs("</text>\n", svg);
    }
}

// -- picture --------------------------------------------------------------------------------------

static const char *title_of(const bough_study *s) { return s->title ? s->title : s->file; }

static void begin(FILE *svg, const bough_study *s, int width, int height) {
    fprintf(svg,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
            "viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" font-size=\"12\">\n" BOUGH_PICTURE_STYLE,
            width, height, width, height);
    fprintf(svg, "<text x=\"%d\" y=\"22\" font-size=\"15\" font-weight=\"bold\">", LEFT);
    put_text(svg, title_of(s));
    fputs("</text>\n", svg);
}

// That of the panels side by side, or more where the title or a line of the legend needs it.
static int width_of(const bough_study_results *results, int n_column) {
    const bough_study *s = results->study;
    int title = LEFT + letters(title_of(s)) * LETTER * 4 / 3 + RIGHT;
    int width = n_column * PANEL_WIDTH > title ? n_column * PANEL_WIDTH : title;
    for (int i = 0; i < count_lines(s); i++) {
        char *text = NULL;
        size_t size = 0;
        FILE *line = open_memstream(&text, &size);
        if (!line) return width;
        put_line_name(line, s, i);
        put_missing(line, results, i);
        fclose(line);
        int needed = text ? LEFT + 36 + letters(text) * LETTER + RIGHT : 0;
        free(text);
        if (needed > width) width = needed;
    }
    return width;
}

static void draw(FILE *svg, const bough_study_results *results) {
    const bough_study *s = results->study;
    int n_column = s->n_measure < PER_ROW ? s->n_measure : PER_ROW;
    int n_row = (s->n_measure + PER_ROW - 1) / PER_ROW;
    int panels_end = TITLE_HEIGHT + n_row * PANEL_HEIGHT;
    int height = panels_end + (count_lines(s) + 1) * LEGEND_LINE;
    begin(svg, s, width_of(results, n_column), height);
    for (int i = 0; i < s->n_measure; i++) {
        int x = i % PER_ROW * PANEL_WIDTH, y = TITLE_HEIGHT + i / PER_ROW * PANEL_HEIGHT;
        panel p = {.results = results,
                   .measure = i,
                   .x = {.from = x + LEFT, .to = x + PANEL_WIDTH - RIGHT},
                   .y = {.from = y + PANEL_HEIGHT - BOTTOM, .to = y + TOP},
                   .svg = svg};
        draw_panel(&p);
    }
    draw_legend(svg, results, panels_end + 0.5 * LEGEND_LINE);
    fputs("</svg>\n", svg);
}

bough_status bough_study_plot(const bough_study_results *results, const char *folder) {
    char path[BOUGH_PATH_MAX];
    FILE *file = NULL;
    bough_status status = bough_folder_open(folder, "plot.svg", path, &file);
    if (!bough_is_ok(&status)) return status;
    draw(file, results);
    return bough_folder_commit(path, file);
}
