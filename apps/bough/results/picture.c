#include "apps/bough/results/picture.h"

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

// XML has no control characters, not even escaped ones.
void bough_picture_text(FILE *svg, const char *text) {
    for (; *text; text++) {
        switch (*text) {
        case '&': fputs("&amp;", svg); break;
        case '<': fputs("&lt;", svg); break;
        case '>': fputs("&gt;", svg); break;
        case '"': fputs("&quot;", svg); break;
        default: fputc((unsigned char)*text < ' ' ? ' ' : *text, svg);
        }
    }
}

// An element of text, whose attributes are printed.
__attribute__((format(printf, 3, 4))) static void put_text(FILE *svg, const char *text, const char *format,
                                                           ...) {
    char attributes[160];
    BOUGH_PRINT(attributes, format);
    fprintf(svg, "<text %s>", attributes);
    bough_picture_text(svg, text);
    fputs("</text>\n", svg);
}

// Characters in UTF-8.
int bough_picture_letters(const char *text) {
    int n = 0;
    for (; *text; text++) n += ((unsigned char)*text & 0xC0) != 0x80;
    return n;
}

// The palette of Okabe and Ito without yellow, which is too pale on white, and with grey in place of black,
// which does not show on dark pages.
static const char *colour_of(int k) {
    static const char *const colours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                          "#E69F00", "#56B4E9", "#7A7A7A"};
    return k < 0 ? "#888" : colours[k % (sizeof colours / sizeof *colours)];
}

// -- axes -----------------------------------------------------------------------------------------

// Extends an axis to a value, unless it cannot be drawn there.
static void include(bough_axis *axis, double value) {
    if (axis->logarithmic) value = value > 0 ? log10(value) : (double)NAN;
    if (!isfinite(value)) return;
    axis->low = fmin(axis->low, value);
    axis->high = fmax(axis->high, value);
}

// A margin at both ends, but not below 0; a logarithmic axis covers at least a factor of ten.
static void widen(bough_axis *axis) {
    const double ratio = 0.08; // to the length
    if (!(axis->low <= axis->high)) axis->low = 0, axis->high = axis->logarithmic ? 0 : 1;
    double length = axis->high - axis->low, margin = ratio * length;
    if (axis->logarithmic) margin = fmax(margin, 0.5 * (1 - length));
    if (!(margin > 0)) margin = axis->low != 0 ? ratio * fabs(axis->low) : 1;
    if (axis->logarithmic || axis->low != 0) axis->low -= margin;
    axis->high += margin;
}

static double place(const bough_axis *axis, double value) {
    return axis->from + (axis->to - axis->from) * (value - axis->low) / (axis->high - axis->low);
}

static double place_of(const bough_axis *axis, double value) {
    return place(axis, axis->logarithmic ? log10(value) : value);
}

static bool has_place(const bough_axis *axis, double value) {
    return isfinite(axis->logarithmic ? log10(value) : value);
}

// -- panels ---------------------------------------------------------------------------------------

// A line of the grid; what is written next is its number.
static void begin_tick(const bough_chart_panel *p, const bough_axis *axis, double at, FILE *svg) {
    if (axis == &p->x) {
        fprintf(svg, "<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>\n", at, p->y.from, p->y.to);
        fprintf(svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">", at, p->y.from + 17);
    } else {
        fprintf(svg, "<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>\n", p->x.from, at, p->x.to);
        fprintf(svg, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">", p->x.from - 6, at + 4);
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
static void draw_decades(const bough_chart_panel *p, const bough_axis *axis, FILE *svg) {
    static const int factors[] = {1, 2, 5};
    int n = axis->high - axis->low < 2 ? 3 : 1, step = (int)ceil((axis->high - axis->low) / 8);
    for (int decade = (int)floor(axis->low); decade <= axis->high; decade += step) {
        for (int i = 0; i < n; i++) {
            double value = decade + log10(factors[i]);
            if (value < axis->low || value > axis->high) continue;
            begin_tick(p, axis, place(axis, value), svg);
            put_decade(svg, factors[i], decade);
            fputs("</text>\n", svg);
        }
    }
}

// Multiples of 1, 2 or 5 times a power of ten, at most ten.
static void draw_multiples(const bough_chart_panel *p, const bough_axis *axis, FILE *svg) {
    double range = axis->high - axis->low, power = pow(10, floor(log10(range / 5)));
    double ratio = range / 5 / power, step = power * (ratio < 2 ? 1 : ratio < 5 ? 2 : 5);
    double first = ceil(axis->low / step - 1e-9);
    for (int k = 0; (first + k) * step <= axis->high + 1e-9 * range; k++) {
        begin_tick(p, axis, place(axis, (first + k) * step), svg);
        fprintf(svg, "%.4g</text>\n", (first + k) * step);
    }
}

static void draw_axes(const bough_chart_panel *p, FILE *svg) {
    const bough_axis *const axes[] = {&p->x, &p->y};
    for (int i = 0; i < 2; i++) {
        if (axes[i]->logarithmic)
            draw_decades(p, axes[i], svg);
        else
            draw_multiples(p, axes[i], svg);
    }
    fprintf(svg, "<path class=\"axis\" d=\"M%.1f %.1fV%.1fH%.1f\"/>\n", p->x.from, p->y.to, p->y.from,
            p->x.to);
    put_text(svg, p->heading, "x=\"%.1f\" y=\"%.1f\"", p->x.from, p->y.to - 10);
    if (p->across)
        put_text(svg, p->across, "x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\"", (p->x.from + p->x.to) / 2,
                 p->y.from + 36);
}

// -- charts ---------------------------------------------------------------------------------------

// [px]
enum { WIDTH = 416, ALONE = 640, HEIGHT = 380, LEFT = 76, TOP = 28, BOTTOM = 56, TITLE = 34, LEGEND = 20 };
enum { LETTER = 7 }; // of a label, rather wide; of the title a third more
enum { SPACING = 11, MOST_LABELS = 100 };

// Where labels of a panel stand [px].
typedef struct labels {
    int n;
    double left[MOST_LABELS], right[MOST_LABELS], y[MOST_LABELS]; // of the text's base line
} labels;

bough_chart bough_chart_start(bough_arena *arena, const char *title, int per_row) {
    return (bough_chart){.arena = arena, .title = title, .per_row = per_row, .right = 44};
}

void bough_chart_add_panel(bough_chart *c, const char *heading, const char *across, bool log_x, bool log_y) {
    bough_axis x = {HUGE_VAL, -HUGE_VAL, .logarithmic = log_x}, y = x;
    y.logarithmic = log_y;
    c->panel = bough_arena_grow(c->arena, c->panel, c->n_panel, &c->room[0], sizeof *c->panel);
    c->panel[c->n_panel++] = (bough_chart_panel){heading, across, x, y, c->n_line};
}

void bough_chart_add_line(bough_chart *c, bough_chart_line line) {
    c->line = bough_arena_grow(c->arena, c->line, c->n_line, &c->room[1], sizeof *c->line);
    line.end = c->n_point;
    c->line[c->n_line++] = line;
    c->panel[c->n_panel - 1].end = c->n_line;
}

void bough_chart_add(bough_chart *c, bough_chart_point point) {
    bough_chart_panel *p = &c->panel[c->n_panel - 1];
    c->point = bough_arena_grow(c->arena, c->point, c->n_point, &c->room[2], sizeof *c->point);
    c->point[c->n_point++] = point;
    c->line[c->n_line - 1].end = c->n_point;
    include(&p->x, point.x);
    include(&p->y, point.y);
    for (int k = 0; k < 2 && point.bar[0] != point.bar[1]; k++) include(&p->y, point.bar[k]);
}

// Shapes differ as well as colours.
static void draw_mark(FILE *svg, double x, double y, int colour, double size) {
    static const char *const shapes[] = {"M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0", "M-4 -4h8v8h-8z",
                                         "M0 -6l5.5 9.5h-11z", "M0 -6l6 6l-6 6l-6 -6z"};
    fprintf(svg, "<path fill=\"%s\" transform=\"translate(%.1f,%.1f) scale(%.3g)\" d=\"%s\">",
            colour_of(colour), x, y, size > 0 ? size : 1, shapes[colour % 4]);
}

// The nearest place above or below y [px] where no label of the panel is yet, and records it.
static double free_place(labels *used, double left, double right, double y) {
    double at = y;
    for (int tried = 0; tried < 2 * MOST_LABELS; tried++) {
        at = y + (tried % 2 ? -1 : 1) * (tried + 1) / 2 * SPACING / 2.0;
        bool taken = false;
        for (int k = 0; k < used->n && !taken; k++) {
            bool beside = left > used->right[k] || right < used->left[k];
            taken = !beside && fabs(at - used->y[k]) < SPACING;
        }
        if (!taken) break;
    }
    if (used->n < MOST_LABELS) {
        used->left[used->n] = left, used->right[used->n] = right;
        used->y[used->n++] = at;
    }
    return at;
}

// Right of the point, or left of it where there is no room, and beside no other label.
static void draw_label(const bough_chart *c, const bough_chart_panel *p, labels *used, double x, double y,
                       int colour, const char *label, FILE *svg) {
    double width = bough_picture_letters(label) * LETTER;
    bool before = x + 7 + width > p->x.to + c->right;
    double left = before ? x - 7 - width : x + 7, at = free_place(used, left, left + width, y - 5);
    put_text(svg, label, "fill=\"%s\" font-size=\"10\" x=\"%.1f\" y=\"%.1f\"%s", colour_of(colour),
             before ? x - 7 : x + 7, at, before ? " text-anchor=\"end\"" : "");
}

static void draw_point(const bough_chart *c, const bough_chart_panel *p, labels *used,
                       const bough_chart_line *l, const bough_chart_point *at, FILE *svg) {
    double x = place_of(&p->x, at->x), y = place_of(&p->y, at->y);
    if (at->bar[0] != at->bar[1])
        fprintf(svg, "<path d=\"M%.1f %.1fV%.1f\" stroke=\"#56B4E9\" stroke-width=\"2\"/>", x,
                place_of(&p->y, at->bar[0]), place_of(&p->y, at->bar[1]));
    if (l->marked && l->colour >= 0) {
        draw_mark(svg, x, y, l->colour, at->size);
        if (at->hint) fputs("<title>", svg), bough_picture_text(svg, at->hint), fputs("</title>", svg);
        fputs("</path>\n", svg);
    }
    if (at->label) draw_label(c, p, used, x, y, l->colour, at->label, svg);
}

static void draw_line(const bough_chart *c, const bough_chart_panel *p, labels *used, int line, FILE *svg) {
    const bough_chart_line *l = &c->line[line];
    int first = line > 0 ? l[-1].end : 0;
    if (l->joined)
        fprintf(svg, "<polyline fill=\"none\" stroke-width=\"1.6\" stroke=\"%s\"%s points=\"",
                colour_of(l->colour), l->colour < 0 ? " stroke-dasharray=\"5 4\"" : "");
    for (int pass = !l->joined; pass < 2; pass++) {
        for (int i = first; i < l->end; i++) {
            const bough_chart_point *at = &c->point[i];
            if (!has_place(&p->x, at->x) || !has_place(&p->y, at->y)) continue;
            if (pass == 0) fprintf(svg, "%.1f,%.1f ", place_of(&p->x, at->x), place_of(&p->y, at->y));
            if (pass == 1) draw_point(c, p, used, l, at, svg);
        }
        if (pass == 0) fputs("\"/>\n", svg);
    }
}

static int panel_width(const bough_chart *c) { return (c->per_row == 1 ? ALONE : WIDTH) + c->right; }

static void draw_panel(const bough_chart *c, int k, FILE *svg) {
    bough_chart_panel p = c->panel[k];
    int width = panel_width(c), left = k % c->per_row * width;
    int top = (c->title ? TITLE : 0) + k / c->per_row * HEIGHT;
    p.x.from = left + LEFT, p.x.to = left + width - c->right;
    p.y.from = top + HEIGHT - BOTTOM, p.y.to = top + TOP;
    widen(&p.x);
    widen(&p.y);
    draw_axes(&p, svg);
    labels used = {0};
    for (int i = k > 0 ? c->panel[k - 1].end : 0; i < p.end; i++) draw_line(c, &p, &used, i, svg);
}

// Lines of the first panel that have a name: their number.
static int count_names(const bough_chart *c) {
    int n = 0;
    for (int i = 0; c->n_panel > 0 && i < c->panel[0].end; i++) n += c->line[i].name != NULL;
    return n;
}

static void draw_legend(const bough_chart *c, double y, FILE *svg) {
    for (int i = 0; c->n_panel > 0 && i < c->panel[0].end; i++) {
        const bough_chart_line *l = &c->line[i];
        if (!l->name) continue;
        fprintf(svg, "<path stroke=\"%s\" stroke-width=\"1.6\" d=\"M%d %.1fh28\"/>\n", colour_of(l->colour),
                LEFT, y);
        draw_mark(svg, LEFT + 14, y, l->colour, 1);
        fputs("</path>\n", svg);
        put_text(svg, l->name, "x=\"%d\" y=\"%.1f\"", LEFT + 36, y + 4);
        y += LEGEND;
    }
}

// The width of the panels side by side, or of title or legend where they are wider.
static int width_of(const bough_chart *c) {
    int columns = c->n_panel < c->per_row ? c->n_panel : c->per_row;
    int width = columns * panel_width(c);
    int title = c->title ? LEFT + bough_picture_letters(c->title) * LETTER * 4 / 3 + c->right : 0;
    if (title > width) width = title;
    for (int i = 0; c->n_panel > 0 && i < c->panel[0].end; i++) {
        int needed =
            c->line[i].name ? LEFT + 36 + bough_picture_letters(c->line[i].name) * LETTER + c->right : 0;
        if (needed > width) width = needed;
    }
    return width;
}

void bough_chart_write(const void *chart, FILE *svg) {
    const bough_chart *c = chart;
    int names = count_names(c), rows = (c->n_panel + c->per_row - 1) / c->per_row;
    int end = (c->title ? TITLE : 0) + rows * HEIGHT;
    bough_picture_begin(svg, width_of(c), end + (names > 0 ? (names + 1) * LEGEND : 0));
    if (c->title) put_text(svg, c->title, "x=\"%d\" y=\"22\" font-size=\"15\" font-weight=\"bold\"", LEFT);
    for (int k = 0; k < c->n_panel; k++) draw_panel(c, k, svg);
    draw_legend(c, end + 0.5 * LEGEND, svg);
    fputs("</svg>\n", svg);
}
