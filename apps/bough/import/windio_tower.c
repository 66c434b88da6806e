// The tower: a tube of layers, from which its stiffness and mass follow; without layers it is
// rigid.
#include "apps/bough/import/section.h"
#include "apps/bough/import/windio.h"

enum { MOST_LAYERS = 20 };

static const double least_step = 1e-6; // of the fractions at which curves have points

static const double usual_damping = 5e-3; // [s]

typedef struct layer {
    double young, shear, density; // [Pa, Pa, kg/m3]
    bough_curve thickness;        // [m]
} layer;

typedef struct tube {
    int n;
    layer layer[MOST_LAYERS]; // from outside
    double mass_factor;
} tube;

// -- reading --------------------------------------------------------------------------------------

static layer read_layer(bough_windio *w, const bough_node *from) {
    const bough_node *material = bough_windio_material(w, from);
    layer l = {.thickness = bough_entry_curve(w->draft, from, "thickness")};
    if (!material) return l;
    l.young = bough_windio_property(w, material, "E", 0);
    l.density = bough_windio_property(w, material, "rho", 0);
    double ratio = bough_entry(material, "G") ? 0 : bough_windio_property(w, material, "nu", 0);
    l.shear = ratio > 0 ? l.young / (2 * (1 + ratio)) : bough_windio_property(w, material, "G", 0);
    return l;
}

static bough_curve read_height(bough_windio *w) {
    const char *path = w->second ? "reference_axis.z" : "outer_shape_bem.reference_axis.z";
    bough_curve z = bough_entry_curve(w->draft, w->tower, path);
    for (int i = 1; i < z.n; i++) {
        if (z.y[i] > z.y[i - 1] && z.x[i] > z.x[i - 1]) continue;
        bough_entry_fail(w->draft, z.node, "reference_axis.z: expected increasing heights");
    }
    if (z.n < 2 || z.y[0] < 0) {
        bough_entry_fail(w->draft, w->tower, "reference_axis.z: expected a tower above the ground");
    }
    return z;
}

static void read_tube(bough_windio *w, tube *t) {
    const bough_node *from = bough_entry(w->tower, "internal_structure_2d_fem|structure");
    const bough_node *layers = bough_entry(from, "layers");
    t->mass_factor = bough_entry_number_or(w->draft, from, "outfitting_factor", 1);
    if (layers && (layers->kind != BOUGH_SEQUENCE || layers->n > MOST_LAYERS)) {
        bough_entry_fail(w->draft, layers, "layers: expected at most %d", (int)MOST_LAYERS);
        return;
    }
    for (; layers && t->n < layers->n && bough_is_ok(w->draft->status); t->n++)
        t->layer[t->n] = read_layer(w, layers->value[t->n]);
    bool matrices = bough_entry(from, "elastic_properties") != NULL;
    if (t->n == 0)
        bough_approximated(w, "tower: no layers, so it is rigid%s",
                           matrices ? "; its matrices are not read" : "");
    else if (matrices)
        bough_left_out(w, "tower: its matrices; mass and stiffness are those of its layers");
}

// -- writing --------------------------------------------------------------------------------------

// A layer ends where its grid does.
static double thickness_at(const layer *l, double fraction) {
    const bough_curve *c = &l->thickness;
    bool there = c->n > 0 && fraction > c->x[0] - least_step && fraction < c->x[c->n - 1] + least_step;
    return there ? bough_curve_at(c, fraction) : 0;
}

// Sums the layers' rings, from outside inwards.
static bough_section section_at(bough_windio *w, const tube *t, double fraction) {
    double outer = bough_curve_at(&w->diameter, fraction);
    bough_section s = {.span = bough_curve_at(&w->height, fraction) - w->tower_base};
    for (int i = 0; i < t->n; i++) {
        const layer *l = &t->layer[i];
        double thickness = thickness_at(l, fraction), inner = outer - 2 * thickness;
        if (!(thickness >= 0) || !(inner >= 0)) {
            bough_entry_fail(w->draft, l->thickness.node,
                             "thickness: expected a value from 0 to the tower's radius, got %g m", thickness);
        }
        double area = BOUGH_PI / 4 * (outer * outer - inner * inner);
        double second = BOUGH_PI / 64 * (pow(outer, 4) - pow(inner, 4));
        s.mass += l->density * area * t->mass_factor;
        s.axial += l->young * area;
        s.shear += l->shear * area / 2;
        s.bend_x += l->young * second;
        s.torsion += 2 * l->shear * second;
        outer = inner;
    }
    s.bend_y = s.bend_x;
    if (!(s.axial > 0) || !(s.mass > 0)) {
        bough_entry_fail(w->draft, w->diameter.node, "the tower has no wall at %g m", s.span);
    }
    return s;
}

static void put_tube(bough_windio *w, const tube *t) {
    const bough_curve *curve[MOST_LAYERS + 2] = {&w->height, &w->diameter};
    for (int i = 0; i < t->n; i++) curve[2 + i] = &t->layer[i].thickness;
    double *place;
    int n = bough_curve_fractions(w->draft, curve, t->n + 2, least_step, &place);
    const bough_node *matrices = bough_entry(w->tower, "structure.elastic_properties");
    const double *times = bough_windio_damping(w, matrices, "tower", usual_damping);
    FILE *file = w->draft->file[BOUGH_IMPORT_TOWER];
    double mass = 0;
    bough_section last = {0};
    bough_section_head(file, w->tower_top - w->tower_base, times);
    for (int i = 0; i < n && bough_is_ok(w->draft->status); i++) {
        bough_section s = section_at(w, t, place[i]);
        bough_section_put(file, &s);
        if (i > 0) mass += (s.span - last.span) * (s.mass + last.mass) / 2;
        last = s;
    }
    bough_taken(w,
                "%d stations of the tower, a tube of %d layers with outfitting_factor %g; it weighs %.7g "
                "kg",
                n, t->n, t->mass_factor, mass);
    bough_approximated(w, "tower: wall thickness linear between stations; shear stiffness of a thin tube");
}

void bough_windio_tower(bough_windio *w) {
    if (!bough_is_ok(w->draft->status)) return;
    if (!w->tower) {
        w->tower_base = 0;
        w->tower_top = bough_entry_number(w->draft, w->root, "assembly.hub_height");
        bough_left_out(w, "no tower: the hub is fixed at its height");
        return;
    }
    tube t = {0};
    w->height = read_height(w);
    w->diameter = bough_entry_curve(w->draft, w->tower, "outer_shape_bem|outer_shape.outer_diameter");
    read_tube(w, &t);
    if (!bough_is_ok(w->draft->status)) return;
    w->tower_base = w->height.y[0];
    w->tower_top = w->height.y[w->height.n - 1];
    if (t.n > 0) put_tube(w, &t);
}

void bough_windio_tower_air(bough_windio *w) {
    if (!w->tower || !bough_is_ok(w->draft->status)) return;
    bough_put(w, "  tower:\n    influence: potential\n");
    const bough_curve *const curve[] = {&w->height, &w->diameter};
    double *place;
    int n = bough_curve_fractions(w->draft, curve, 2, least_step, &place);
    double *high = bough_arena_doubles(w->draft->arena, 2 * (size_t)n), *wide = high + n;
    for (int i = 0; i < n; i++) {
        high[i] = bough_curve_at(&w->height, place[i]);
        wide[i] = bough_curve_at(&w->diameter, place[i]);
    }
    bough_draft_tower_list(w->draft, "height", high, 1, n);
    bough_draft_tower_list(w->draft, "diameter", wide, 1, n);
    bough_taken(w, "the tower's influence on the wind, without its drag");
}
