// The Campbell diagram: frequencies and damping of the modes over the operating points, with the
// multiples of the rotor's speed.
#include "apps/bough/cli/modes_sweep.h"
#include "apps/bough/results/picture.h"

#include <math.h>

// Of the picture [px].
enum { WIDTH = 900, HEIGHT = 380, LEFT = 64, RIGHT = 190, TOP = 40, GAP = 56, BOTTOM = 56 };

// What is drawn upwards.
typedef struct panel {
    const bough_sweep *sweep;
    bough_panel at;
    bool damping;
    bool by_speed; // x is the rotor's speed, else the first key's number
} panel;

static double x_of(const panel *p, int point) {
    return p->by_speed ? p->sweep->speed[point] : p->sweep->x[point];
}

static double right(const panel *p, double x) { return bough_axis_place(&p->at.x, x); }

static double down(const panel *p, double y) { return bough_axis_place(&p->at.y, y); }

static double value_of(const panel *p, const bough_sweep_mode *m) {
    return p->damping ? 100 * m->damping : m->frequency;
}

// n Ω for n = 1, 3, 6, … over the rotor's speed.
static void draw_multiples(const panel *p) {
    static const int multiples[] = {1, 2, 3, 6, 9};
    for (size_t k = 0; p->by_speed && k < sizeof multiples / sizeof *multiples; k++) {
        double slope = multiples[k] / 60., end = fmin(p->at.x.high, p->at.y.high / slope);
        if (end <= p->at.x.low) continue;
        fprintf(p->at.svg, "<path class=\"times\" d=\"M%.1f %.1fL%.1f %.1f\"/>\n", right(p, p->at.x.low),
                down(p, slope * p->at.x.low), right(p, end), down(p, slope * end));
        fprintf(p->at.svg, "<text class=\"times\" x=\"%.1f\" y=\"%.1f\">%dP</text>\n", right(p, end) - 22,
                down(p, slope * end) + 12, multiples[k]);
    }
}

static void draw_line(const panel *p, int line) {
    const bough_sweep *s = p->sweep;
    const char *colour = bough_picture_colour(line);
    const bough_sweep_mode *last = NULL;
    fprintf(p->at.svg, "<polyline fill=\"none\" stroke-width=\"1.6\" stroke=\"%s\" points=\"", colour);
    for (int i = 0; i < s->n_mode; i++) {
        const bough_sweep_mode *m = &s->mode[i];
        if (m->line != line) continue;
        double y = fmin(fmax(value_of(p, m), p->at.y.low), p->at.y.high);
        fprintf(p->at.svg, "%.1f,%.1f ", right(p, x_of(p, m->point)), down(p, y));
        last = m;
    }
    fputs("\"/>\n", p->at.svg);
    for (int i = 0; i < s->n_mode; i++) {
        const bough_sweep_mode *m = &s->mode[i];
        double y = value_of(p, m);
        if (m->line != line || y < p->at.y.low || y > p->at.y.high) continue;
        fprintf(p->at.svg, "<circle r=\"3\" fill=\"%s\" cx=\"%.1f\" cy=\"%.1f\"/>\n", colour,
                right(p, x_of(p, m->point)), down(p, y));
    }
    double y = last ? value_of(p, last) : p->at.y.high + 1;
    if (y < p->at.y.low || y > p->at.y.high) return;
    fprintf(p->at.svg, "<text x=\"%.1f\" y=\"%.1f\" fill=\"%s\">%d %s %s %s</text>\n",
            right(p, x_of(p, last->point)) + 8, down(p, y) + 4, colour, line + 1, last->body, last->shape,
            last->pattern);
}

static void draw_panel(const panel *p, const char *title, const char *across) {
    bough_panel_axes(&p->at, title, across);
    if (!p->damping) draw_multiples(p);
    for (int line = 0; line < p->sweep->n_line; line++) draw_line(p, line);
}

void bough_modes_plot(const void *self, FILE *svg) {
    const bough_sweep *s = self;
    panel p = {.sweep = s};
    p.at = (bough_panel){svg, bough_axis_between(LEFT, WIDTH - RIGHT, false),
                         bough_axis_between(TOP + HEIGHT, TOP, false)};
    for (int i = 1; i < s->n_point; i++) p.by_speed = p.by_speed || s->speed[i] != s->speed[0];
    for (int i = 0; i < s->n_point; i++) bough_axis_include(&p.at.x, x_of(&p, i));
    if (!(p.at.x.high > p.at.x.low)) bough_axis_widen(&p.at.x, 0.05);
    double frequency = 0, damping = 0, least = 0;
    for (int i = 0; i < s->n_mode; i++) {
        frequency = fmax(frequency, s->mode[i].frequency);
        if (s->mode[i].damped == 0) continue; // it does not oscillate
        damping = fmax(damping, 100 * s->mode[i].damping);
        least = fmin(least, 100 * s->mode[i].damping);
    }
    bough_picture_begin(svg, WIDTH, TOP + 2 * HEIGHT + GAP + BOTTOM);
    fputs("<style>.times{stroke:#999;stroke-dasharray:5 4}text.times{stroke:none;fill:#777}</style>\n", svg);
    p.at.y.low = 0;
    p.at.y.high = 1.05 * fmax(frequency, 1e-3);
    draw_panel(&p, "frequency [Hz]", NULL);
    p.damping = true;
    p.at.y = (bough_axis){1.05 * least, fmax(1.05 * damping, 0.1), TOP + 2 * HEIGHT + GAP, TOP + HEIGHT + GAP,
                          false};
    draw_panel(&p, "damping ratio [%]", p.by_speed ? "rotor speed [rpm]" : s->key[0]);
    fputs("</svg>\n", svg);
}
