// A turbine of the WindIO ontology: the paths of its parts in both layouts, and the order of the scene.
#include "apps/bough/import/windio.h"

#include <ctype.h>

static const double duration = 20; // [s]: the file has none

// -- reading --------------------------------------------------------------------------------------

static void find_parts(bough_windio *w) {
    bough_draft *d = w->draft;
    w->parts = bough_entry_need(d, w->root, "components");
    w->blade = bough_entry_need(d, w->parts, "blade");
    w->shape = bough_entry_need(d, w->blade, "outer_shape_bem|outer_shape");
    w->hub = bough_entry_need(d, w->parts, "hub");
    w->second = bough_entry(w->blade, "outer_shape") != NULL;
    w->train = bough_entry_need(d, w->parts, w->second ? "drivetrain" : "nacelle.drivetrain");
    w->tower = bough_entry(w->parts, "tower");
    w->degree = w->second ? 1 : 1 / BOUGH_DEGREE;
    const bough_node *version = bough_entry(w->root, "windIO_version");
    const char *number = version && version->kind == BOUGH_SCALAR ? version->text : "";
    if (version && number[number[0] == 'v'] != (w->second ? '2' : '1'))
        bough_taken(w, "windIO_version %.40s: read in the layout of version %d, which the file has", number,
                    w->second ? 2 : 1);
}

// Pieces of a bent line between two points of the file; fewer points than LEAST are corners.
enum { PIECES = 6, LEAST = 8 };

// A line through the points of the file as a polygon of many pieces, smooth where it is bent: in a polygon of
// the points themselves a mesh finds corners, by which its error does not fall with its order.
static bough_curve smooth_line(bough_draft *d, const bough_curve *c) {
    int n = (c->n - 1) * PIECES + 1, last = c->n - 1;
    double *x = bough_arena_doubles(d->arena, (size_t)n), *y = bough_arena_doubles(d->arena, (size_t)n);
    double *chord = bough_arena_doubles(d->arena, (size_t)c->n), bend = 0;
    for (int k = 0; k < last; k++) chord[k] = (c->y[k + 1] - c->y[k]) / (c->x[k + 1] - c->x[k]);
    for (int k = 1; k < last; k++) bend = fmax(bend, fabs(chord[k] - chord[k - 1]));
    if (c->n < LEAST || bend < 1e-6) return *c;
    double before = chord[0];
    for (int k = 0; k < last; k++) {
        double h = c->x[k + 1] - c->x[k], bent[2];
        double after = k + 1 == last
                           ? chord[k]
                           : bough_cubic_slope(h, chord[k], c->x[k + 2] - c->x[k + 1], chord[k + 1]);
        bough_cubic_bend(chord[k], before, after, h, bent);
        for (int i = 0; i < PIECES; i++) {
            double t = h * i / PIECES;
            x[k * PIECES + i] = c->x[k] + t;
            y[k * PIECES + i] = c->y[k] + t * (before + t * (bent[0] + t * bent[1]));
        }
        before = after;
    }
    x[n - 1] = c->x[last], y[n - 1] = c->y[last];
    return (bough_curve){c->node, n, x, y};
}

static void read_axis(bough_windio *w) {
    static const char *const key[] = {"reference_axis.x", "reference_axis.y", "reference_axis.z"};
    const bough_node *from = w->second ? w->blade : w->shape;
    for (int i = 0; i < 3; i++) w->axis[i] = bough_entry_curve(w->draft, from, key[i]);
    const bough_curve *z = &w->axis[2];
    if (!bough_is_ok(w->draft->status)) return;
    for (int i = 1; i < z->n; i++) {
        if (z->y[i] > z->y[i - 1] && z->x[i] > z->x[i - 1]) continue;
        bough_entry_fail(w->draft, z->node,
                         "reference_axis.z: expected increasing values, but number %d is not larger than the "
                         "one before",
                         i + 1);
    }
    if (z->n < 2 || fabs(z->y[0]) > 1e-6 || z->x[0] != 0 || z->x[z->n - 1] != 1) {
        bough_entry_fail(w->draft, z->node,
                         "reference_axis.z: expected a line from 0 m at the grid's 0 to its 1");
    }
    w->blade_length = z->y[z->n - 1];
    for (int i = 0; i < 2 && bough_is_ok(w->draft->status); i++)
        w->axis[i] = smooth_line(w->draft, &w->axis[i]);
}

// Limits of numbers that a file may lack; those of angles are in degrees.
static const struct {
    const char *path;
    double low, high;
    bool angle;
} limits[] = {
    {"assembly.rated_power", 0, 1e9, false},
    {"environment.air_density", 1e-3, 1e4, false},
    {"environment.shear_exp", 0, 1, false},
    {"components.hub.cone_angle", -80, 80, true},
    {"components.drivetrain.outer_shape.uptilt", -80, 80, true},
    {"components.nacelle.drivetrain.uptilt", -80, 80, true},
    {"components.yaw.elastic_properties.mass", 0, 1e9, false},
    {"components.nacelle.drivetrain.elastic_properties_mb.yaw_mass", 0, 1e9, false},
    {"control.optimal_tsr", 0, 100, false},
    {"control.torque.tsr", 0, 100, false},
};

static void check_limits(bough_windio *w) {
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        double low = limits[i].low, high = limits[i].high, unit = limits[i].angle ? w->degree : 1;
        const bough_node *node = bough_entry(w->root, limits[i].path);
        double value = node ? bough_entry_number(w->draft, node, "") * unit : low;
        if (!(value >= low && value <= high))
            bough_entry_fail(w->draft, node, "%s: expected %g to %g%s, got %g",
                             strrchr(limits[i].path, '.') + 1, low, high, limits[i].angle ? " deg" : "",
                             value);
    }
}

static void read_assembly(bough_windio *w) {
    bough_draft *d = w->draft;
    const bough_node *assembly = bough_entry_need(d, w->root, "assembly");
    double blades = bough_entry_number_or(d, assembly, "number_of_blades", 3);
    if (!(blades >= 1 && blades <= BOUGH_IMPORT_BLADES && blades == floor(blades))) {
        bough_entry_fail(d, assembly, "number_of_blades: expected a whole number from 1 to %d, got %g",
                         (int)BOUGH_IMPORT_BLADES, blades);
    }
    const bough_node *side = bough_entry(assembly, "rotor_orientation");
    int first = side && side->kind == BOUGH_SCALAR ? tolower((unsigned char)side->text[0]) : 'u';
    if (first != 'u' && first != 'd')
        bough_entry_fail(d, side, "rotor_orientation: expected upwind or downwind, got '%.60s'", side->text);
    w->forward = first == 'd' ? -1 : 1;
    w->n_blade = bough_is_ok(d->status) ? (int)blades : 1;
    w->rated_power = bough_entry_number_or(d, assembly, "rated_power", 0);
    w->density = bough_entry_number_or(d, w->root, "environment.air_density", 1.225);
    w->hub_radius = bough_entry_number(d, w->hub, "diameter") / 2;
    if (bough_is_ok(d->status) && !(w->hub_radius > 0)) {
        bough_entry_fail(d, w->hub, "diameter: expected a positive value");
    }
    double cone = bough_entry_number_or(d, w->hub, "cone_angle", 0) * w->degree * BOUGH_DEGREE;
    w->radius = (w->hub_radius + w->blade_length) * cos(cone);
}

double bough_windio_control(bough_windio *w, const char *first, const char *second, double second_unit,
                            double fallback) {
    const bough_node *control = bough_entry(w->root, "control");
    const char *name = bough_entry(control, first) ? first : second;
    double unit = w->second || name == second ? second_unit : 1;
    return bough_entry_number_or(w->draft, control, name, fallback / unit) * unit;
}

const bough_node *bough_windio_material(bough_windio *w, const bough_node *layer) {
    const bough_node *materials = bough_entry_need(w->draft, w->root, "materials");
    const char *name = bough_entry_text(w->draft, layer, "material");
    const bough_node *material = bough_entry_named(materials, name);
    if (materials && !material)
        bough_entry_fail(w->draft, layer, "material: no material is named '%.60s'", name);
    return material;
}

double bough_windio_property(bough_windio *w, const bough_node *material, const char *key, int k) {
    const bough_node *node = bough_entry_need(w->draft, material, key);
    if (node && node->kind == BOUGH_SEQUENCE && node->n > 0)
        node = node->value[k < node->n ? k : node->n - 1];
    double value = node ? bough_entry_number(w->draft, node, "") : 0;
    if (node && !(value > 0)) bough_entry_fail(w->draft, node, "%s: expected a positive value", key);
    return value;
}

// Where the optimal tip speed ratio meets three quarters of the rated speed, the rotor turns in the
// middle of its range, and no pitch is needed.
static void choose_start(bough_windio *w) {
    double tip = bough_windio_control(w, "supervisory.maxTS", "max_allowable_blade_tip_speed", 1, 0);
    double ratio = bough_windio_control(w, "torque.tsr", "optimal_tsr", 1, 0);
    double limit = tip > 0 ? tip / w->radius : HUGE_VAL;
    double given =
        bough_windio_control(w, "torque.VS_maxspd", "rated_rotor_speed|max_rotor_speed", BOUGH_RPM, 0);
    // of both limits the lower one counts; a speed at the limit of the tip is taken, by whatever radius it is
    w->rated_speed = given > 0 && given <= 1.02 * limit ? given : limit;
    if (!isfinite(w->rated_speed)) {
        bough_entry_fail(
            w->draft, w->root,
            "control: expected the rotor's rated speed, 'torque.VS_maxspd' or 'rated_rotor_speed', or its "
            "largest tip speed, 'supervisory.maxTS' or 'max_allowable_blade_tip_speed'");
        return;
    }
    w->speed = 0.75 * w->rated_speed;
    w->wind = ratio > 0 ? w->speed * w->radius / ratio : 8;
    if (!(ratio > 0)) {
        bough_approximated(w, "no optimal tip-speed ratio: wind of 8 m/s assumed");
    }
    bough_approximated(w,
                       "the file has no load case: wind of %.3g m/s and %.3g rpm, at the optimal "
                       "tip-speed ratio",
                       w->wind, w->speed / BOUGH_RPM);
}

// -- writing --------------------------------------------------------------------------------------

static void put_head(bough_windio *w, const char *path) {
    const bough_node *name = bough_entry(w->root, "name");
    const char *title = name && name->kind == BOUGH_SCALAR ? name->text : bough_file_name(path);
    bough_draft_head(w->draft, title, "a WindIO turbine", 9.80665, duration, w->rated_speed);
}

static void note_left(bough_windio *w) {
    static const char *const part[] = {"monopile", "floating_platform", "mooring", "jacket"};
    for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
        if (!bough_entry(w->parts, part[i])) continue;
        bough_left_out(w, "%s: the tower's foot is held", part[i]);
    }
    bough_left_out(w, "strength, costs, site");
}

static void convert(bough_draft *d, const char *path) {
    bough_windio *w = bough_arena_take(d->arena, sizeof *w);
    w->draft = d;
    w->root = bough_entry_read(w->draft, path);
    find_parts(w);
    read_axis(w);
    if (bough_is_ok(w->draft->status)) bough_windio_shape_read(w);
    check_limits(w);
    read_assembly(w);
    if (!bough_is_ok(w->draft->status)) return;
    bough_taken(w, "%s, in the layout of version %d", path, w->second ? 2 : 1);
    choose_start(w);
    if (!bough_is_ok(w->draft->status)) return;
    put_head(w, path);
    bough_windio_blade(w);
    bough_windio_tower(w);
    bough_windio_bodies(w);
    bough_windio_air_tables(w);
    bough_windio_air(w);
    bough_windio_law(w);
    note_left(w);
}

bough_status bough_import_windio(const char *path, const char *folder, const bough_import_options *options,
                                 FILE *echo) {
    return bough_draft_import(convert, path, folder, options, echo);
}
