// Stiffness and inertia of the blade's sections from its layers and webs: outlines, positions on their arc,
// walls.
#include "apps/bough/import/section.h"
#include "apps/bough/import/windio.h"
#include "core/base/linalg.h"

// -- outlines of sections -------------------------------------------------------------------------

// The outline of a blade's section: interpolated between the two nearest airfoils, whose sides have points at
// equal distances along their arcs, and scaled.

enum { SIDE = 80, ROUND = 2 * SIDE, POINTS = ROUND + 1 };

// Points from the trailing edge along the suction side to the leading edge and back along the pressure
// side, the last at the first one; in section axes about the reference line: x towards the suction
// side, y towards the trailing edge.
typedef struct outline {
    double x[POINTS], y[POINTS]; // [m]
    double arc[POINTS];          // from 0 to 1
    double length;               // perimeter [m]
} outline;

// -- airfoils -------------------------------------------------------------------------------------

// Points of an airfoil from its trailing edge along the suction side.
typedef struct points {
    int n;
    double *x, *y; // (n + 2)
} points;

// The mean height of some points.
static double mean(const double *y, int from, int to) {
    double sum = 0;
    for (int i = from; i < to; i++) sum += y[i];
    return to > from ? sum / (to - from) : 0;
}

static int leading_edge(const points *p) {
    int least = 0;
    for (int i = 1; i < p->n; i++) {
        if (p->x[i] < p->x[least]) least = i;
    }
    return least;
}

static void reverse(double *value, int n) {
    for (int i = 0; i < n / 2; i++) {
        double kept = value[i];
        value[i] = value[n - 1 - i];
        value[n - 1 - i] = kept;
    }
}

// An airfoil with a blunt trailing edge begins and ends in the middle of it.
static void close_edge(points *p) {
    double x = (p->x[0] + p->x[p->n - 1]) / 2, y = (p->y[0] + p->y[p->n - 1]) / 2;
    if (hypot(p->x[0] - x, p->y[0] - y) > 1e-9) {
        memmove(p->x + 1, p->x, (size_t)p->n * sizeof(double));
        memmove(p->y + 1, p->y, (size_t)p->n * sizeof(double));
        p->n += 2;
        p->x[0] = p->x[p->n - 1] = x;
        p->y[0] = p->y[p->n - 1] = y;
    }
}

static points read_points(bough_windio *w, const bough_node *airfoil) {
    bough_draft *d = w->draft;
    points p = {0};
    const double *x = bough_entry_numbers(d, airfoil, "coordinates.x", &p.n);
    const double *y = x ? bough_entry_numbers(d, airfoil, "coordinates.y", &p.n) : NULL;
    if (!y) return (points){0};
    bough_arena_each(d->arena, (size_t)p.n + 2, &p.x, &p.y);
    memcpy(p.x, x, (size_t)p.n * sizeof(double));
    memcpy(p.y, y, (size_t)p.n * sizeof(double));
    int edge = leading_edge(&p);
    if (p.n < 5 || edge < 2 || edge > p.n - 3) {
        bough_entry_fail(d, airfoil,
                         "coordinates: expected points around the airfoil from its trailing edge");
        return (points){0};
    }
    if (mean(p.y, 0, edge) < mean(p.y, edge + 1, p.n)) {
        reverse(p.x, p.n);
        reverse(p.y, p.n);
    }
    close_edge(&p);
    return p;
}

// SIDE + 1 points at equal distances along the arc from point `from` to point `to`.
static void draw_side(const points *p, int from, int to, double *x, double *y) {
    double length = 0, done = 0;
    for (int i = from; i < to; i++) length += hypot(p->x[i + 1] - p->x[i], p->y[i + 1] - p->y[i]);
    int i = from;
    for (int k = 0; k <= SIDE; k++) {
        double wanted = length * k / SIDE, part;
        while (part = hypot(p->x[i + 1] - p->x[i], p->y[i + 1] - p->y[i]),
               i < to - 1 && done + part < wanted) {
            done += part;
            i++;
        }
        double s = part > 0 ? fmin((wanted - done) / part, 1) : 0;
        x[k] = p->x[i] + s * (p->x[i + 1] - p->x[i]);
        y[k] = p->y[i] + s * (p->y[i + 1] - p->y[i]);
    }
}

static void draw(const points *p, double *x, double *y) {
    int edge = leading_edge(p);
    draw_side(p, 0, edge, x, y);
    draw_side(p, edge, p->n - 1, x + SIDE, y + SIDE);
    double least = x[SIDE], chord = fmax(x[0] - least, 1e-9);
    for (int k = 0; k < POINTS; k++) {
        x[k] = (x[k] - least) / chord;
        y[k] /= chord;
    }
}

// Airfoils of unit chord, (n × 2 × POINTS): x along the chord, y towards the suction side,
// of each place of the shape; NULL after a failure.
static const double *read_airfoils(bough_windio *w) {
    const bough_windio_shape *a = &w->outline;
    double *all = bough_arena_doubles(w->draft->arena, (size_t)a->n * 2 * POINTS);
    for (int i = 0; i < a->n && bough_is_ok(w->draft->status); i++) {
        points p = read_points(w, a->place[i].airfoil);
        if (p.n > 0) draw(&p, all + (size_t)i * 2 * POINTS, all + (size_t)i * 2 * POINTS + POINTS);
    }
    return bough_is_ok(w->draft->status) ? all : NULL;
}

// -- the section ----------------------------------------------------------------------------------

// The outline at a fraction of the blade.
static void outline_at(const bough_windio *w, const double *airfoils, double fraction, outline *to) {
    double mix, chord = bough_curve_at(&w->outline.chord, fraction);
    int i = bough_windio_neighbours(&w->outline, fraction, &mix);
    const double *one = airfoils + (size_t)i * 2 * POINTS, *two = mix > 0 ? one + 2 * POINTS : one;
    double line = bough_windio_line(&w->outline, fraction);
    double up = bough_curve_at(&w->outline.offset_x, fraction);
    for (int k = 0; k < POINTS; k++) {
        to->y[k] = chord * ((1 - mix) * one[k] + mix * two[k]) - line;
        to->x[k] = chord * ((1 - mix) * one[POINTS + k] + mix * two[POINTS + k]) + up;
    }
    to->arc[0] = 0;
    for (int k = 1; k < POINTS; k++)
        to->arc[k] = to->arc[k - 1] + hypot(to->x[k] - to->x[k - 1], to->y[k] - to->y[k - 1]);
    to->length = to->arc[ROUND];
    for (int k = 1; k < POINTS; k++) to->arc[k] /= to->length;
}

// The arc where a straight line crosses a side (0 suction, 1 pressure). The line is normal to the direction
// that is turned from the chord towards the suction side by `turn` [rad]; `offset` is its distance from the
// reference line in that direction [m]. Without a crossing: the nearest point.
static double outline_crossing(const outline *o, int side, double turn, double offset) {
    double nearest = HUGE_VAL, found = side ? 0.75 : 0.25;
    for (int k = side * SIDE; k < (side + 1) * SIDE; k++) {
        double a = o->y[k] * cos(turn) + o->x[k] * sin(turn) - offset;
        double b = o->y[k + 1] * cos(turn) + o->x[k + 1] * sin(turn) - offset;
        if ((a <= 0) != (b <= 0)) return o->arc[k] + a / (a - b) * (o->arc[k + 1] - o->arc[k]);
        if (fabs(a) >= nearest) continue;
        nearest = fabs(a);
        found = o->arc[k];
    }
    return found;
}

enum {
    MOST_LAYERS = 100,
    MOST_WEBS = 10,
    WEB = 10, // walls of a web
    MOST_NODES = ROUND + MOST_WEBS * (WEB - 1),
    MOST_WALLS = ROUND + MOST_WEBS * WEB,
    DEEPEST = 20 // parts that refer to parts
};

typedef enum handle { START, END } handle;
static const char *const arc_name[] = {"start_nd_arc", "end_nd_arc"};

typedef struct layer {
    const bough_node *node;
    int web;                      // −1: on the outline
    bough_ply ply;                // thickness and angle by the curves
    bough_curve thickness, angle; // [m], [rad or deg]; of none nothing
} layer;

typedef struct parts {
    bough_windio *w;
    const bough_node *layers, *webs, *anchors; // lists; NULL: none
    int n_layer;
    layer layer[MOST_LAYERS];
    const double *airfoils;
    outline outline;        // at the present fraction
    double fraction, twist; // twist [rad]
} parts;

// -- where on the arc -----------------------------------------------------------------------------

static double arc_of(parts *p, const bough_node *part, handle end, int depth);

static const bough_node *find_part(const parts *p, const char *name) {
    const bough_node *list[] = {p->anchors, p->webs, p->layers};
    for (int i = 0; i < 3; i++) {
        const bough_node *part = bough_entry_named(list[i], name);
        if (part) return part;
    }
    return NULL;
}

static double curve_at(parts *p, const bough_node *from, const char *key) {
    bough_curve c = bough_entry_curve(p->w->draft, from, key);
    return bough_curve_at(&c, p->fraction);
}

static handle handle_of(const bough_node *node) {
    return node && node->kind == BOUGH_SCALAR && strncmp(node->text, "start", 5) == 0 ? START : END;
}

// {anchor: {name: ..., handle: ...}}; NAN: there is none.
static double anchor_of(parts *p, const bough_node *node, int depth) {
    const bough_node *name = bough_entry(node, "anchor.name");
    const bough_node *part = name && name->kind == BOUGH_SCALAR ? find_part(p, name->text) : NULL;
    const bough_node *which = bough_entry(node, "anchor.handle");
    if (!part) return NAN;
    bool middle = which && which->kind == BOUGH_SCALAR && strncmp(which->text, "mid", 3) == 0;
    if (!middle) return arc_of(p, part, handle_of(which), depth + 1);
    return (arc_of(p, part, START, depth + 1) + arc_of(p, part, END, depth + 1)) / 2;
}

// An end that the file gives directly: by values, by an anchor, or by the name of an adjacent part.
static double given_end(parts *p, const bough_node *node, handle end, int depth) {
    if (!node || node->kind != BOUGH_MAPPING) return NAN;
    const bough_node *fixed = bough_entry(node, "fixed");
    if (fixed && fixed->kind == BOUGH_SCALAR) {
        if (strcmp(fixed->text, "TE") == 0) return end == START ? 0 : 1;
        if (strcmp(fixed->text, "LE") == 0) return p->outline.arc[SIDE];
    }
    if (bough_entry(node, "values")) return curve_at(p, node, "");
    const bough_node *part = fixed && fixed->kind == BOUGH_SCALAR ? find_part(p, fixed->text) : NULL;
    if (part) return arc_of(p, part, end == START ? END : START, depth + 1);
    return anchor_of(p, node, depth);
}

// The angle from the chord to the direction in which offsets of planes are measured [rad].
static double turn_of(parts *p, const bough_node *part) {
    double degree = p->w->degree * BOUGH_DEGREE;
    const bough_node *rotation = bough_entry(part, "rotation");
    if (bough_entry(rotation, "values")) return curve_at(p, part, "rotation") * degree;
    return -p->twist;
}

// Where a plane crosses: version 1 by offset_y_pa, version 2 by plane_intersection; NAN: none.
static double crossing(parts *p, const bough_node *part, int side) {
    if (bough_entry(part, "offset_y_pa")) {
        return outline_crossing(&p->outline, side, turn_of(p, part), curve_at(p, part, "offset_y_pa"));
    }
    const bough_node *plane = bough_entry(part, "plane_intersection");
    if (!plane || !bough_entry(plane, "offset")) return NAN;
    double turn = bough_entry_number_or(p->w->draft, plane, "plane_type1|plane_type2.rotation", 0);
    return outline_crossing(&p->outline, side, -p->twist + turn * BOUGH_DEGREE, curve_at(p, plane, "offset"));
}

static int side_of(const bough_node *part, handle end) {
    const bough_node *side = bough_entry(part, "side");
    if (!side) side = bough_entry(part, "plane_intersection.side");
    if (!side || side->kind != BOUGH_SCALAR || strcmp(side->text, "both") == 0) return end == END;
    return side->text[0] == 'p' || side->text[0] == 'P';
}

// From another anchor by a length along the arc, in metres or relative to the perimeter; NAN: none.
static double offset_from(parts *p, const bough_node *part, handle end, int depth) {
    static const char *const keys[] = {"offset_arc", "offset_nd_arc"};
    for (int k = 0; k < 2; k++) {
        const bough_node *node = bough_entry(part, keys[k]), *what = bough_entry(node, "defines");
        if (!node || (what && handle_of(what) != end)) continue;
        double way = curve_at(p, node, "");
        return anchor_of(p, node, depth) + (k == 0 ? way / p->outline.length : way);
    }
    return NAN;
}

// By the width of the part and its middle or its other end; NAN: none.
static double by_width(parts *p, const bough_node *part, handle end, int depth) {
    if (!bough_entry(part, "width")) return NAN;
    double half = curve_at(p, part, "width") / p->outline.length / 2, sign = end == START ? -1 : 1;
    double middle = given_end(p, bough_entry(part, "midpoint_nd_arc"), end, depth);
    if (isnan(middle)) middle = crossing(p, part, side_of(part, end));
    if (!isnan(middle)) return middle + sign * half;
    handle other = end == START ? END : START;
    return given_end(p, bough_entry(part, arc_name[other]), other, depth) + sign * 2 * half;
}

// Whether the part's width or plane is declared to define this end: values of the end are then results of
// another program.
static bool defines(const bough_node *part, const char *key, handle end) {
    const bough_node *what = bough_entry(bough_entry(part, key), "defines");
    bool list = what && what->kind == BOUGH_SEQUENCE;
    for (int i = 0; what && i < (list ? what->n : 1); i++) {
        const bough_node *one = list ? what->value[i] : what;
        if (one->kind == BOUGH_SCALAR && strcmp(one->text, arc_name[end]) == 0) return true;
    }
    return false;
}

static double arc_of(parts *p, const bough_node *part, handle end, int depth) {
    if (depth > DEEPEST) {
        bough_entry_fail(p->w->draft, part, "%s: it refers to itself", arc_name[end]);
        return 0;
    }
    double arc = NAN;
    if (defines(part, "plane_intersection", end)) arc = crossing(p, part, side_of(part, end));
    if (isnan(arc) && defines(part, "width", end)) arc = by_width(p, part, end, depth);
    if (isnan(arc)) arc = given_end(p, bough_entry(part, arc_name[end]), end, depth);
    if (isnan(arc)) arc = offset_from(p, part, end, depth);
    if (isnan(arc)) arc = by_width(p, part, end, depth);
    if (isnan(arc)) arc = crossing(p, part, side_of(part, end));
    if (isnan(arc)) arc = end == START ? 0 : 1;
    return bough_clamp(arc, 0, 1);
}

// -- layers ---------------------------------------------------------------------------------------

// The moduli must be those of a material: ν² below E1/E2.
static bough_ply read_material(parts *p, const bough_node *material) {
    bough_draft *d = p->w->draft;
    bough_ply ply = {.density = bough_windio_property(p->w, material, "rho", 0)};
    const bough_node *ratio = bough_entry(material, "nu");
    if (ratio && ratio->kind == BOUGH_SEQUENCE && ratio->n > 0) ratio = ratio->value[0];
    ply.poisson = ratio ? bough_entry_number(d, ratio, "") : 0.3;
    for (int k = 0; k < 2; k++) ply.young[k] = bough_windio_property(p->w, material, "E", k);
    ply.shear = bough_entry(material, "G") ? bough_windio_property(p->w, material, "G", 0)
                                           : ply.young[0] / (2 * (1 + ply.poisson));
    if (bough_is_ok(d->status) && !(ply.poisson * ply.poisson * ply.young[1] < 0.99 * ply.young[0])) {
        bough_entry_fail(d, material, "nu: %g is too large for these moduli", ply.poisson);
    }
    return ply;
}

// The thickness of a layer by its number of plies, whose thickness is the material's.
static bough_curve read_plies(parts *p, const bough_node *node, const bough_node *material) {
    bough_draft *d = p->w->draft;
    bough_curve c = bough_entry_curve(d, node, "n_plies");
    double *thick = bough_arena_doubles(d->arena, (size_t)c.n + 1);
    double each = bough_entry_number(d, material, "ply_t");
    for (int i = 0; i < c.n; i++) thick[i] = each * c.y[i];
    return (bough_curve){c.node, c.n, c.x, thick};
}

static void read_layer(parts *p, const bough_node *node, layer *l) {
    bough_draft *d = p->w->draft;
    const bough_node *material = bough_windio_material(p->w, node);
    *l = (layer){.node = node, .web = -1};
    if (!material) return;
    l->ply = read_material(p, material);
    bool plies = !bough_entry(node, "thickness") && bough_entry(node, "n_plies");
    l->thickness = plies ? read_plies(p, node, material) : bough_entry_curve(d, node, "thickness");
    if (bough_entry(node, "fiber_orientation.values"))
        l->angle = bough_entry_curve(d, node, "fiber_orientation");
    const bough_node *web = bough_entry(node, "web");
    if (!web || web->kind != BOUGH_SCALAR) return;
    if (bough_entry_named(p->webs, web->text)) l->web = bough_node_index(p->webs, web->text);
    if (l->web < 0) bough_entry_fail(d, web, "web: no web is named '%.60s'", web->text);
}

static const bough_node *structure_of(const bough_windio *w) {
    return bough_entry(w->blade, "internal_structure_2d_fem|structure");
}

bool bough_windio_has_layers(const bough_windio *w) {
    const bough_node *layers = bough_entry(structure_of(w), "layers");
    return layers && layers->kind == BOUGH_SEQUENCE && layers->n > 0;
}

static void read_parts(parts *p) {
    bough_draft *d = p->w->draft;
    const bough_node *from = structure_of(p->w);
    p->layers = bough_entry(from, "layers");
    p->webs = bough_entry(from, "webs");
    p->anchors = bough_entry(from, "anchors");
    if (p->webs && (p->webs->kind != BOUGH_SEQUENCE || p->webs->n > MOST_WEBS)) {
        bough_entry_fail(d, p->webs, "webs: expected a list of at most %d", (int)MOST_WEBS);
    }
    if (p->layers->n > MOST_LAYERS) {
        bough_entry_fail(d, p->layers, "layers: expected at most %d", (int)MOST_LAYERS);
    }
    for (; p->n_layer < p->layers->n && bough_is_ok(d->status); p->n_layer++)
        read_layer(p, p->layers->value[p->n_layer], &p->layer[p->n_layer]);
    p->airfoils = bough_is_ok(d->status) ? read_airfoils(p->w) : NULL;
}

// Zero outside of the curve's range.
static double thickness_at(const layer *l, double fraction) {
    const bough_curve *c = &l->thickness;
    if (c->n == 0 || fraction < c->x[0] - 1e-9 || fraction > c->x[c->n - 1] + 1e-9) return 0;
    return bough_curve_at(c, fraction);
}

// -- walls ----------------------------------------------------------------------------------------

typedef struct section {
    int n_node, n_wall;
    double x[MOST_NODES], y[MOST_NODES];
    bough_wall wall[MOST_WALLS];
    bough_ply ply[MOST_WALLS * 4 + ROUND * MOST_LAYERS];
    int n_ply;
} section;

static bough_ply ply_of(const parts *p, const layer *l, double thickness) {
    bough_ply ply = l->ply;
    double degree = p->w->degree * BOUGH_DEGREE;
    ply.thickness = thickness;
    ply.angle = l->angle.n > 0 ? bough_curve_at(&l->angle, p->fraction) * degree : 0;
    return ply;
}

// Where there is no layer, a massless film closes the outline.
static const bough_ply film = {{1e7, 1e7}, 4e6, 0.25, 0, 0, 1e-4};

// Node k is the outline's point k; walls run against the outline, so that their plies lie inside.
static void put_skin(parts *p, section *s) {
    double from[MOST_LAYERS], to[MOST_LAYERS], thick[MOST_LAYERS];
    const outline *o = &p->outline;
    for (int i = 0; i < p->n_layer; i++) {
        thick[i] = p->layer[i].web < 0 ? thickness_at(&p->layer[i], p->fraction) : 0;
        if (!(thick[i] > 0)) continue;
        from[i] = arc_of(p, p->layer[i].node, START, 0);
        to[i] = arc_of(p, p->layer[i].node, END, 0);
    }
    memcpy(s->x, o->x, ROUND * sizeof(double));
    memcpy(s->y, o->y, ROUND * sizeof(double));
    s->n_node = ROUND;
    for (int k = 0; k < ROUND; k++) {
        bough_wall *wall = &s->wall[s->n_wall++];
        *wall = (bough_wall){(k + 1) % ROUND, k, 0, s->ply + s->n_ply, 0};
        double width = o->arc[k + 1] - o->arc[k];
        for (int i = 0; i < p->n_layer; i++) {
            if (!(thick[i] > 0)) continue;
            double covered = fmin(to[i], o->arc[k + 1]) - fmax(from[i], o->arc[k]);
            if (!(covered > 1e-6 * width)) continue;
            s->ply[s->n_ply++] = ply_of(p, &p->layer[i], thick[i] * covered / width);
            wall->n_ply++;
        }
        if (wall->n_ply > 0) continue;
        s->ply[s->n_ply++] = film;
        wall->n_ply = 1;
    }
}

// The outline's point at an arc.
static int node_at(const outline *o, double arc) {
    int k = 0;
    while (k < ROUND - 1 && o->arc[k + 1] < arc) k++;
    if (arc - o->arc[k] > o->arc[k + 1] - arc) k++;
    return k % ROUND;
}

static void put_web(parts *p, section *s, int web) {
    const bough_ply *ply = s->ply + s->n_ply;
    int n_ply = 0;
    for (int i = 0; i < p->n_layer; i++) {
        double thick = p->layer[i].web == web ? thickness_at(&p->layer[i], p->fraction) : 0;
        if (thick > 0) s->ply[s->n_ply + n_ply++] = ply_of(p, &p->layer[i], thick);
    }
    int from = node_at(&p->outline, arc_of(p, p->webs->value[web], START, 0));
    int to = node_at(&p->outline, arc_of(p, p->webs->value[web], END, 0));
    double length = hypot(s->x[to] - s->x[from], s->y[to] - s->y[from]);
    if (n_ply == 0 || abs(to - from) < 3 || length < 1e-3) return;
    s->n_ply += n_ply;
    for (int k = 1, last = from; k <= WEB; k++) {
        int next = k < WEB ? s->n_node++ : to;
        if (k < WEB) {
            s->x[next] = s->x[from] + (s->x[to] - s->x[from]) * k / WEB;
            s->y[next] = s->y[from] + (s->y[to] - s->y[from]) * k / WEB;
        }
        s->wall[s->n_wall++] = (bough_wall){last, next, n_ply, ply, 1};
        last = next;
    }
}

// -- stations -------------------------------------------------------------------------------------

static void solve_station(parts *p, section *s, double stiffness[36], double mass[36]) {
    bough_draft *d = p->w->draft;
    bough_arena *scratch = bough_arena_child(d->arena);
    outline_at(p->w, p->airfoils, p->fraction, &p->outline);
    p->twist = bough_curve_at(&p->w->outline.twist, p->fraction) * p->w->degree * BOUGH_DEGREE;
    s->n_wall = s->n_ply = 0;
    put_skin(p, s);
    for (int i = 0; p->webs && i < p->webs->n; i++) put_web(p, s, i);
    bough_status status = bough_is_ok(d->status) ? bough_wall_section(scratch, s->n_node, s->x, s->y,
                                                                      s->n_wall, s->wall, stiffness, mass)
                                                 : bough_ok();
    if (!bough_is_ok(&status)) {
        bough_entry_fail(d, p->layers, "layers at %.4g of the span: %s", p->fraction, status.message);
    }
    bough_arena_destroy(scratch);
}

// The points of chord and layers, at least a hundredth and at most a thirtieth of the blade apart.
static int choose_fractions(parts *p, double **fraction) {
    enum { MOST = 30 };
    double even[MOST];
    const bough_curve *curve[MOST_LAYERS + 2], between = {.n = MOST, .x = even};
    for (int i = 0; i < MOST; i++) even[i] = (double)i / MOST;
    for (int l = 0; l < p->n_layer; l++) curve[l] = &p->layer[l].thickness;
    curve[p->n_layer] = &p->w->outline.chord;
    curve[p->n_layer + 1] = &between;
    return bough_curve_fractions(p->w->draft, curve, p->n_layer + 2, 0.01, fraction);
}

static void put_matrix(const double from[36], int station, const bough_windio_matrices *to) {
    for (int i = 0; i < 6; i++) {
        for (int j = i; j < 6; j++)
            to->entry[(size_t)bough_symmetric6_index(i, j) * to->n + station] = from[6 * i + j];
    }
}

void bough_windio_layup(bough_windio *w, bough_windio_matrices *stiffness, bough_windio_matrices *mass) {
    bough_draft *d = w->draft;
    parts *p = bough_arena_take(d->arena, sizeof *p);
    section *s = bough_arena_take(d->arena, sizeof *s);
    if (!bough_is_ok(d->status)) return;
    p->w = w;
    read_parts(p);
    if (!bough_is_ok(d->status)) return;
    double *fraction, k[36], m[36];
    int n = choose_fractions(p, &fraction);
    *stiffness = *mass = (bough_windio_matrices){.node = w->blade, .n = n, .grid = fraction};
    bough_arena_each(d->arena, 21 * (size_t)n, &stiffness->entry, &mass->entry);
    for (int i = 0; i < n && bough_is_ok(d->status); i++) {
        p->fraction = fraction[i];
        solve_station(p, s, k, m);
        put_matrix(k, i, stiffness);
        put_matrix(m, i, mass);
    }
}
