// The Campbell diagram: frequencies and damping of the modes over the operating points, with the
// multiples of the rotor's speed.
#include "apps/bough/modes_sweep.h"
#include "apps/output/picture.h"

#include <math.h>

// Of the picture [px].
enum { WIDTH = 900, HEIGHT = 380, LEFT = 64, RIGHT = 190, TOP = 40, GAP = 56, BOTTOM = 56 };

static const char *const colours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                      "#E69F00", "#56B4E9", "#000000"};
enum { N_COLOUR = sizeof colours / sizeof *colours };

// What is drawn upwards.
typedef struct panel {
    const bough_sweep *sweep;
    FILE *svg;
    double top, low, high; // [px], values at the bottom and the top
    bool damping;
    bool by_speed; // x is the rotor's speed, else the first key's number
    double x_low, x_high;
} panel;

static double x_of(const panel *p, int point) {
    return p->by_speed ? p->sweep->speed[point] : p->sweep->x[point];
}

static double right(const panel *p, double x) {
    double width = p->x_high > p->x_low ? p->x_high - p->x_low : 1;
    return LEFT + (x - p->x_low) / width * (WIDTH - LEFT - RIGHT);
}

static double down(const panel *p, double y) {
    return p->top + HEIGHT * (p->high - y) / (p->high - p->low);
}

static double value_of(const panel *p, const bough_sweep_mode *m) {
    return p->damping ? 100 * m->damping : m->frequency;
}

// 1, 2 or 5 times a power of ten, so that there are at most ten.
static double tick_of(double range) {
    double power = pow(10, floor(log10(range / 5)));
    double ratio = range / 5 / power;
    return power * (ratio < 2 ? 1 : ratio < 5 ? 2 : 5);
}

static void draw_axes(const panel *p, const char *title) {
    double step = tick_of(p->high - p->low), first = ceil(p->low / step);
    for (int k = 0; (first + k) * step <= p->high * (1 + 1e-9); k++) {
        double y = down(p, (first + k) * step);
        fprintf(p->svg, "<path class=\"grid\" d=\"M%d %.1fH%d\"/>\n", LEFT, y, WIDTH - RIGHT);
        fprintf(p->svg, "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n", LEFT - 6, y + 4,
                (first + k) * step);
    }
    double x_step = tick_of(fmax(p->x_high - p->x_low, 1e-9)), from = ceil(p->x_low / x_step);
    for (int k = 0; (from + k) * x_step <= p->x_high * (1 + 1e-9); k++) {
        double x = right(p, (from + k) * x_step);
        fprintf(p->svg, "<path class=\"grid\" d=\"M%.1f %.1fv%d\"/>\n", x, p->top, HEIGHT);
        fprintf(p->svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%g</text>\n", x,
                p->top + HEIGHT + 17, (from + k) * x_step);
    }
    fprintf(p->svg, "<text x=\"%d\" y=\"%.1f\">%s</text>\n", LEFT, p->top - 12, title);
    fprintf(p->svg, "<path class=\"axis\" d=\"M%d %.1fv%dH%d\"/>\n", LEFT, p->top, HEIGHT,
            WIDTH - RIGHT);
}

// n Ω for n = 1, 3, 6, … over the rotor's speed.
static void draw_multiples(const panel *p) {
    static const int multiples[] = {1, 2, 3, 6, 9};
    for (size_t k = 0; p->by_speed && k < sizeof multiples / sizeof *multiples; k++) {
        double slope = multiples[k] / 60., end = fmin(p->x_high, p->high / slope);
        if (end <= p->x_low) continue;
        fprintf(p->svg, "<path class=\"times\" d=\"M%.1f %.1fL%.1f %.1f\"/>\n", right(p, p->x_low),
                down(p, slope * p->x_low), right(p, end), down(p, slope * end));
        fprintf(p->svg, "<text class=\"times\" x=\"%.1f\" y=\"%.1f\">%dP</text>\n",
                right(p, end) - 22, down(p, slope * end) + 12, multiples[k]);
    }
}

static void draw_line(const panel *p, int line) {
    const bough_sweep *s = p->sweep;
    const char *colour = colours[line % N_COLOUR];
    const bough_sweep_mode *last = NULL;
    fprintf(p->svg, "<polyline fill=\"none\" stroke-width=\"1.6\" stroke=\"%s\" points=\"", colour);
    for (int i = 0; i < s->n_mode; i++) {
        const bough_sweep_mode *m = &s->mode[i];
        if (m->line != line) continue;
        double y = fmin(fmax(value_of(p, m), p->low), p->high);
        fprintf(p->svg, "%.1f,%.1f ", right(p, x_of(p, m->point)), down(p, y));
        last = m;
    }
    fputs("\"/>\n", p->svg);
    for (int i = 0; i < s->n_mode; i++) {
        const bough_sweep_mode *m = &s->mode[i];
        double y = value_of(p, m);
        if (m->line != line || y < p->low || y > p->high) continue;
        fprintf(p->svg, "<circle r=\"3\" fill=\"%s\" cx=\"%.1f\" cy=\"%.1f\"/>\n", colour,
                right(p, x_of(p, m->point)), down(p, y));
    }
    double y = last ? value_of(p, last) : p->high + 1;
    if (y < p->low || y > p->high) return;
    fprintf(p->svg, "<text x=\"%.1f\" y=\"%.1f\" fill=\"%s\">%d %s %s %s</text>\n",
            right(p, x_of(p, last->point)) + 8, down(p, y) + 4, colour, line + 1, last->body,
            last->shape, last->pattern);
}

static void draw_panel(panel *p, const char *title) {
    draw_axes(p, title);
    if (!p->damping) draw_multiples(p);
    for (int line = 0; line < p->sweep->n_line; line++) draw_line(p, line);
}

void bough_modes_plot(const bough_sweep *s, FILE *svg) {
    panel p = {.sweep = s, .svg = svg, .top = TOP, .x_low = HUGE_VAL, .x_high = -HUGE_VAL};
    for (int i = 1; i < s->n_point; i++) p.by_speed = p.by_speed || s->speed[i] != s->speed[0];
    for (int i = 0; i < s->n_point; i++) {
        p.x_low = fmin(p.x_low, x_of(&p, i));
        p.x_high = fmax(p.x_high, x_of(&p, i));
    }
    double frequency = 0, damping = 0, least = 0;
    for (int i = 0; i < s->n_mode; i++) {
        frequency = fmax(frequency, s->mode[i].frequency);
        if (s->mode[i].damped == 0) continue; // it does not oscillate
        damping = fmax(damping, 100 * s->mode[i].damping);
        least = fmin(least, 100 * s->mode[i].damping);
    }
    fprintf(svg, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" "
                 "font-family=\"sans-serif\" font-size=\"12\">\n" BOUGH_PICTURE_STYLE
                 "<style>.times{stroke:#999;stroke-dasharray:5 4}text.times{stroke:none;fill:#777}</style>\n",
            WIDTH, TOP + 2 * HEIGHT + GAP + BOTTOM);
    p.high = 1.05 * fmax(frequency, 1e-3);
    draw_panel(&p, "frequency [Hz]");
    p.damping = true;
    p.top = TOP + HEIGHT + GAP;
    p.high = fmax(1.05 * damping, 0.1);
    p.low = 1.05 * least;
    draw_panel(&p, "damping ratio [%]");
    fprintf(svg, "<text x=\"%d\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n</svg>\n",
            (LEFT + WIDTH - RIGHT) / 2, p.top + HEIGHT + 40,
            p.by_speed ? "rotor speed [rpm]" : s->key[0]);
}
