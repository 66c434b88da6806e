#include "tests/verification/map.h"

#include "apps/bough/results/folder.h"
#include "apps/bough/results/picture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Of the picture [px].
enum { LEFT = 12, TOP = 84, ROW = 20, PER_CHARACTER = 7, GAP = 10 };

static int longest_row(const bough_map *m) {
    size_t longest = 0;
    for (int i = 0; i < m->n_row; i++) {
        if (m->row[i] && strlen(m->row[i]) > longest) longest = strlen(m->row[i]);
    }
    return LEFT + PER_CHARACTER * (int)longest + 10;
}

static int height_of(const bough_map *m) {
    int height = TOP + GAP;
    for (int i = 0; i < m->n_row; i++) height += m->row[i] ? ROW : GAP;
    return height;
}

// From pale to dark blue, or red.
static void put_colour(FILE *svg, const bough_map_cell *c) {
    double s = fmin(fmax(c->shade, 0), 1);
    if (c->kind == BOUGH_MAP_STOPPED) {
        fputs("#D55E00", svg);
    } else {
        fprintf(svg, "rgb(%.0f,%.0f,%.0f)", 226 - 226 * s, 236 - 122 * s, 244 - 66 * s);
    }
}

static void draw_cell(FILE *svg, const bough_map *m, const bough_map_cell *c, double x, double y) {
    if (c->kind == BOUGH_MAP_EMPTY) return;
    bool dark = c->kind == BOUGH_MAP_STOPPED || c->shade > 0.5;
    fprintf(svg, "<g><title>");
    bough_picture_text(svg, c->hint ? c->hint : c->text);
    fprintf(svg, "</title><rect x=\"%.1f\" y=\"%.1f\" width=\"%d\" height=\"%d\" fill=\"", x, y,
            m->column_width, ROW);
    put_colour(svg, c);
    fputs("\"/>", svg);
    if (PER_CHARACTER * (int)strlen(c->text) <= m->column_width + 4) {
        fprintf(svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\" font-size=\"10\"%s>",
                x + 0.5 * m->column_width, y + 14, dark ? " fill=\"#fff\"" : " fill=\"#222\"");
        bough_picture_text(svg, c->text);
        fputs("</text>", svg);
    }
    fputs("</g>\n", svg);
}

// As many names as have room.
static void draw_columns(FILE *svg, const bough_map *m, int left) {
    size_t longest = 1;
    for (int k = 0; k < m->n_column; k++) {
        if (strlen(m->column[k]) > longest) longest = strlen(m->column[k]);
    }
    int every = (int)ceil((double)(PER_CHARACTER * (longest + 1)) / m->column_width);
    fprintf(svg, "<text x=\"%d\" y=\"%d\">", left, TOP - 22);
    bough_picture_text(svg, m->across);
    fputs("</text>\n", svg);
    for (int k = 0; k < m->n_column; k += every) {
        fprintf(svg, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">", left + (k + 0.5) * m->column_width,
                TOP - 6);
        bough_picture_text(svg, m->column[k]);
        fputs("</text>\n", svg);
    }
}

static void draw(const void *self, FILE *svg) {
    const bough_map *m = self;
    int left = longest_row(m), width = left + m->n_column * m->column_width + 2 * LEFT;
    int height = height_of(m), y = TOP;
    bough_picture_begin(svg, width, height);
    bough_picture_title(svg, LEFT, m->title);
    fprintf(svg, "<text x=\"%d\" y=\"42\" class=\"weak\">", LEFT);
    bough_picture_text(svg, m->legend);
    fputs("</text>\n", svg);
    draw_columns(svg, m, left);
    for (int i = 0; i < m->n_row; y += m->row[i++] ? ROW : GAP) {
        if (!m->row[i]) continue;
        fprintf(svg, "<text x=\"%d\" y=\"%d\">", LEFT, y + 14);
        bough_picture_text(svg, m->row[i]);
        fputs("</text>\n", svg);
        for (int k = 0; k < m->n_column; k++) {
            draw_cell(svg, m, &m->cell[i * m->n_column + k], left + k * m->column_width, y);
        }
    }
    fputs("</svg>\n", svg);
}

bough_status bough_map_write(const bough_map *map, const char *folder, const char *name) {
    return bough_folder_write(folder, name, draw, map);
}
