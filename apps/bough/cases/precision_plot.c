#include "apps/bough/cases/perform.h"

#include "apps/bough/results/folder.h"
#include "apps/bough/results/picture.h"

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

typedef struct panel {
    const bough_study_results *results;
    int measure;
    bough_panel at;
} panel;

// -- data -----------------------------------------------------------------------------------------

static int along(const bough_study *s) { return s->grid.axis[s->grid.n - 1].value.n; }

static int count_lines(const bough_study *s) { return s->n_case / along(s); }

static double cost(const bough_case_result *r) { return r->cpu / r->time; }

// A logarithm needs a positive number: a run that equals the reference has no place.
static bool has_point(const bough_case_result *r, int measure) {
    return r->done && bough_is_ok(&r->outcome) && r->error[measure] > 0 && cost(r) > 0;
}

static void find_ranges(panel *p) {
    bough_axis *x = &p->at.x, *y = &p->at.y;
    for (int i = 0; i < p->results->study->n_case; i++) {
        const bough_case_result *r = &p->results->result[i];
        if (!has_point(r, p->measure)) continue;
        bough_axis_include(x, r->error[p->measure]);
        bough_axis_include(y, cost(r));
    }
    bough_axis_widen(x, 0.08);
    bough_axis_widen(y, 0.08);
}

static void draw_axes(const panel *p) {
    const bough_study_measure *m = &p->results->study->measure[p->measure];
    char across[200];
    snprintf(across, sizeof across, "largest difference: %.120s [%.40s]", m->name, m->unit);
    bough_panel_axes(&p->at, "CPU time per simulated second [s]", across);
}

// -- lines ----------------------------------------------------------------------------------------

// Shapes differ as well as colours.
static void draw_marker(FILE *svg, double x, double y, int line) {
    fprintf(svg, "<path fill=\"%s\" d=\"", bough_picture_colour(line));
    switch (line % 4) {
    case 0: fprintf(svg, "M%.1f %.1fa4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0", x - 4.5, y); break;
    case 1: fprintf(svg, "M%.1f %.1fh8v8h-8z", x - 4, y - 4); break;
    case 2: fprintf(svg, "M%.1f %.1fl5.5 9.5h-11z", x, y - 6); break;
    default: fprintf(svg, "M%.1f %.1fl6 6l-6 6l-6 -6z", x, y - 6); break;
    }
    fputs("\"/>\n", svg);
}

static void draw_polyline(const panel *p, int line, int first, int n) {
    fprintf(p->at.svg, "<polyline fill=\"none\" stroke-width=\"1.6\" stroke=\"%s\" points=\"",
            bough_picture_colour(line));
    for (int i = first; i < first + n; i++) {
        const bough_case_result *r = &p->results->result[i];
        if (!has_point(r, p->measure)) continue;
        fprintf(p->at.svg, "%.1f,%.1f ", bough_axis_place(&p->at.x, r->error[p->measure]),
                bough_axis_place(&p->at.y, cost(r)));
    }
    fputs("\"/>\n", p->at.svg);
}

static void draw_points(const panel *p, int line, int first, int n) {
    const bough_study *s = p->results->study;
    for (int i = first; i < first + n; i++) {
        const bough_case_result *r = &p->results->result[i];
        if (!has_point(r, p->measure)) continue;
        double x = bough_axis_place(&p->at.x, r->error[p->measure]);
        double y = bough_axis_place(&p->at.y, cost(r));
        const char *value = bough_study_value(s, &s->cases[i], s->grid.n - 1);
        bool before = x + 7 + bough_picture_letters(value) * LETTER > p->at.x.to + RIGHT; // no room
        draw_marker(p->at.svg, x, y, line);
        fprintf(p->at.svg, "<text class=\"weak\" font-size=\"10\" x=\"%.1f\" y=\"%.1f\"%s>",
                before ? x - 7 : x + 7, y - 5, before ? " text-anchor=\"end\"" : "");
        bough_picture_text(p->at.svg, value);
        fputs("</text>\n", p->at.svg);
    }
}

static void draw_panel(panel *p) {
    int n = along(p->results->study);
    find_ranges(p);
    draw_axes(p);
    for (int line = 0; line < count_lines(p->results->study); line++) draw_polyline(p, line, line * n, n);
    for (int line = 0; line < count_lines(p->results->study); line++) draw_points(p, line, line * n, n);
}

// -- legend ---------------------------------------------------------------------------------------

// The settings that tell the line from others.
static void put_line_name(FILE *svg, const bough_study *s, int line) {
    const bough_case *cell = &s->cases[line * along(s)];
    int said = 0;
    for (int i = 0; i + 1 < s->grid.n; i++) {
        if (s->grid.axis[i].value.n < 2) continue;
        if (said++) fputs(", ", svg);
        bough_picture_text(svg, bough_study_value(s, cell, i));
    }
    if (!said) bough_picture_text(svg, s->grid.axis[s->grid.n - 1].label);
}

// Runs of the line that have no point, and why.
static void put_missing(FILE *svg, const bough_study_results *results, int line) {
    const bough_study *s = results->study;
    int n = along(s), said = 0;
    for (int i = line * n; i < (line + 1) * n; i++) {
        const bough_case_result *r = &results->result[i];
        if (has_point(r, 0)) continue;
        char status[40];
        bough_case_status(r, status);
        fputs(said++ ? "; " : " — ", svg);
        bough_picture_text(svg, bough_study_value(s, &s->cases[i], s->grid.n - 1));
        fputc(' ', svg);
        bough_picture_text(svg, strcmp(status, "ok") == 0 ? "equals the reference" : status);
    }
}

static void draw_legend(FILE *svg, const bough_study_results *results, double y) {
    for (int line = 0; line < count_lines(results->study); line++, y += LEGEND_LINE) {
        fprintf(svg, "<path stroke=\"%s\" stroke-width=\"1.6\" d=\"M%d %.1fh28\"/>\n",
                bough_picture_colour(line), LEFT, y);
        draw_marker(svg, LEFT + 14, y, line);
        fprintf(svg, "<text x=\"%d\" y=\"%.1f\">", LEFT + 36, y + 4);
        put_line_name(svg, results->study, line);
        put_missing(svg, results, line);
        fputs("</text>\n", svg);
    }
}

// -- picture --------------------------------------------------------------------------------------

static const char *title_of(const bough_study *s) { return s->title ? s->title : s->file; }

// That of the panels side by side, or more where the title or a line of the legend needs it.
static int width_of(const bough_study_results *results, int n_column) {
    const bough_study *s = results->study;
    int title = LEFT + bough_picture_letters(title_of(s)) * LETTER * 4 / 3 + RIGHT;
    int width = n_column * PANEL_WIDTH > title ? n_column * PANEL_WIDTH : title;
    for (int i = 0; i < count_lines(s); i++) {
        char *text = NULL;
        size_t size = 0;
        FILE *line = open_memstream(&text, &size);
        if (!line) return width;
        put_line_name(line, s, i);
        put_missing(line, results, i);
        fclose(line);
        int needed = text ? LEFT + 36 + bough_picture_letters(text) * LETTER + RIGHT : 0;
        free(text);
        if (needed > width) width = needed;
    }
    return width;
}

static void draw(const void *self, FILE *svg) {
    const bough_study_results *results = self;
    const bough_study *s = results->study;
    int n_column = s->n_measure < PER_ROW ? s->n_measure : PER_ROW;
    int n_row = (s->n_measure + PER_ROW - 1) / PER_ROW;
    int panels_end = TITLE_HEIGHT + n_row * PANEL_HEIGHT;
    int height = panels_end + (count_lines(s) + 1) * LEGEND_LINE;
    bough_picture_begin(svg, width_of(results, n_column), height);
    bough_picture_title(svg, LEFT, title_of(s));
    for (int i = 0; i < s->n_measure; i++) {
        int x = i % PER_ROW * PANEL_WIDTH, y = TITLE_HEIGHT + i / PER_ROW * PANEL_HEIGHT;
        bough_panel at = {svg, bough_axis_between(x + LEFT, x + PANEL_WIDTH - RIGHT, true),
                          bough_axis_between(y + PANEL_HEIGHT - BOTTOM, y + TOP, true)};
        panel p = {results, i, at};
        draw_panel(&p);
    }
    draw_legend(svg, results, panels_end + 0.5 * LEGEND_LINE);
    fputs("</svg>\n", svg);
}

bough_status bough_precision_plot(const bough_study_results *results, const char *folder) {
    return bough_folder_write(folder, "plot.svg", draw, results);
}
