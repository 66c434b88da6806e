#include "apps/bough/results/picture.h"

#include <math.h>

// -- text -----------------------------------------------------------------------------------------

void bough_picture_begin(FILE *svg, int width, int height) {
    fprintf(svg,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
            "viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" font-size=\"12\">\n"
            "<style>svg{fill:#222}.paper{fill:#fff}.weak{fill:#555}.grid{stroke:#ddd;fill:none}"
            ".axis{stroke:#222;fill:none}@media (prefers-color-scheme:dark){svg{fill:#e6e6e6}"
            ".paper{fill:#12161a}.weak{fill:#aaa}.grid{stroke:#333a42}.axis{stroke:#e6e6e6}}</style>\n"
            "<rect class=\"paper\" width=\"100%%\" height=\"100%%\"/>\n",
            width, height, width, height);
}

void bough_picture_title(FILE *svg, int left, const char *title) {
    fprintf(svg, "<text x=\"%d\" y=\"22\" font-size=\"15\" font-weight=\"bold\">", left);
    bough_picture_text(svg, title);
    fputs("</text>\n", svg);
}

void bough_picture_text(FILE *svg, const char *text) {
    for (; *text; text++) {
        switch (*text) {
        case '&': fputs("&amp;", svg); break;
        case '<': fputs("&lt;", svg); break;
        case '>': fputs("&gt;", svg); break;
        case '"': fputs("&quot;", svg); break;
        default: fputc(*text, svg);
        }
    }
}

int bough_picture_letters(const char *text) {
    int n = 0;
    for (; *text; text++) n += ((unsigned char)*text & 0xC0) != 0x80;
    return n;
}

// The palette of Okabe and Ito without yellow, which is too pale on white, and with grey in place of black,
// which is none on dark pages.
const char *bough_picture_colour(int k) {
    static const char *const colours[BOUGH_PICTURE_COLOURS] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                               "#E69F00", "#56B4E9", "#7A7A7A"};
    return colours[k % BOUGH_PICTURE_COLOURS];
}

// -- axes -----------------------------------------------------------------------------------------

bough_axis bough_axis_between(double from, double to, bool logarithmic) {
    return (bough_axis){HUGE_VAL, -HUGE_VAL, from, to, logarithmic};
}

void bough_axis_include(bough_axis *axis, double value) {
    if (axis->logarithmic) value = value > 0 ? log10(value) : (double)NAN;
    if (!isfinite(value)) return;
    axis->low = fmin(axis->low, value);
    axis->high = fmax(axis->high, value);
}

void bough_axis_widen(bough_axis *axis, double share) {
    if (!(axis->low <= axis->high)) axis->low = 0, axis->high = axis->logarithmic ? 0 : 1;
    double length = axis->high - axis->low, margin = share * length;
    if (axis->logarithmic) margin = fmax(margin, 0.5 * (1 - length));
    if (!(margin > 0)) margin = axis->low != 0 ? share * fabs(axis->low) : 1;
    axis->low -= margin;
    axis->high += margin;
}

static double place(const bough_axis *axis, double value) {
    return axis->from + (axis->to - axis->from) * (value - axis->low) / (axis->high - axis->low);
}

double bough_axis_place(const bough_axis *axis, double value) {
    return place(axis, axis->logarithmic ? log10(value) : value);
}

// -- panels ---------------------------------------------------------------------------------------

// A line of the grid; what is written to `p->svg` next is its number.
static void begin_tick(const bough_panel *p, const bough_axis *axis, double at) {
    if (axis == &p->x) {
        fprintf(p->svg, "<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>\n", at, p->y.from, p->y.to);
        fprintf(p->svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">", at, p->y.from + 17);
    } else {
        fprintf(p->svg, "<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>\n", p->x.from, at, p->x.to);
        fprintf(p->svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">", p->x.from - 6, at + 4);
    }
}

// Plain near 1, a power of ten elsewhere.
static void put_decade(FILE *svg, int factor, int decade) {
    if (decade >= -2 && decade <= 2) {
        fprintf(svg, "%.*f", decade < 0 ? -decade : 0, factor * pow(10, decade));
        return;
    }
    if (factor > 1) fprintf(svg, "%d·", factor);
    fprintf(svg, "10<tspan dy=\"-5\" font-size=\"9\">%s%d</tspan>", decade < 0 ? "−" : "",
            decade < 0 ? -decade : decade);
}

// The decades, at most eight; on a short axis also their doubles and fivefolds.
static void draw_decades(const bough_panel *p, const bough_axis *axis) {
    static const int factors[] = {1, 2, 5};
    int n = axis->high - axis->low < 2 ? 3 : 1, step = (int)ceil((axis->high - axis->low) / 8);
    for (int decade = (int)floor(axis->low); decade <= axis->high; decade += step) {
        for (int i = 0; i < n; i++) {
            double value = decade + log10(factors[i]);
            if (value < axis->low || value > axis->high) continue;
            begin_tick(p, axis, place(axis, value));
            put_decade(p->svg, factors[i], decade);
            fputs("</text>\n", p->svg);
        }
    }
}

// Multiples of 1, 2 or 5 times a power of ten, at most ten.
static void draw_multiples(const bough_panel *p, const bough_axis *axis) {
    double range = axis->high - axis->low, power = pow(10, floor(log10(range / 5)));
    double ratio = range / 5 / power, step = power * (ratio < 2 ? 1 : ratio < 5 ? 2 : 5);
    double first = ceil(axis->low / step - 1e-9);
    for (int k = 0; (first + k) * step <= axis->high + 1e-9 * range; k++) {
        begin_tick(p, axis, place(axis, (first + k) * step));
        fprintf(p->svg, "%.4g</text>\n", (first + k) * step);
    }
}

void bough_panel_axes(const bough_panel *p, const char *title, const char *across) {
    const bough_axis *const axes[] = {&p->x, &p->y};
    for (int i = 0; i < 2; i++) {
        if (axes[i]->logarithmic)
            draw_decades(p, axes[i]);
        else
            draw_multiples(p, axes[i]);
    }
    fprintf(p->svg, "<path class=\"axis\" d=\"M%.1f %.1fV%.1fH%.1f\"/>\n", p->x.from, p->y.to, p->y.from,
            p->x.to);
    fprintf(p->svg, "<text x=\"%.1f\" y=\"%.1f\">", p->x.from, p->y.to - 10);
    bough_picture_text(p->svg, title);
    fputs("</text>\n", p->svg);
    if (!across) return;
    fprintf(p->svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">", (p->x.from + p->x.to) / 2,
            p->y.from + 36);
    bough_picture_text(p->svg, across);
    fputs("</text>\n", p->svg);
}
