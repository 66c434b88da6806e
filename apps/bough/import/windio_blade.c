// The blade's structure: 6 × 6 stiffness and inertia over the fraction of its reference line, as rows
// of 21 (version 1) or as one list for each entry (version 2). Section axes: x flapwise, y
// edgewise, turned by the twist; both matrices about the reference line: those of the scene.
#include "apps/bough/import/section.h"
#include "apps/bough/import/windio.h"
#include "core/base/linalg.h"

enum { ENTRIES = 21, MATRIX = BOUGH_IMPORT_MATRIX };

// Damping times where the file has none [s]: a few tenths of a percent in the first modes.
static const double usual_damping = 2e-3;

typedef bough_windio_matrices matrices;

// One entry over the fraction of the blade.
static bough_curve curve_of(const matrices *m, int i, int j) {
    return (bough_curve){m->node, m->n, m->grid, m->entry + (size_t)bough_symmetric6_index(i, j) * m->n};
}

static void matrix_at(const matrices *m, double fraction, double to[MATRIX]) {
    for (int i = 0; i < 6; i++) {
        for (int j = i; j < 6; j++) {
            bough_curve entry = curve_of(m, i, j);
            to[6 * i + j] = to[6 * j + i] = bough_curve_at(&entry, fraction);
        }
    }
}

// -- reading --------------------------------------------------------------------------------------

static matrices read_grid(bough_windio *w, const bough_node *from, const char *path) {
    matrices m = {.node = bough_entry_need(w->draft, from, path)};
    if (m.node) m.grid = bough_entry_numbers(w->draft, m.node, "grid", &m.n);
    if (!m.grid) return (matrices){0};
    m.entry = bough_arena_doubles(w->draft->arena, (size_t)ENTRIES * m.n);
    return m;
}

// Rows of 21.
static void read_rows(bough_windio *w, matrices *m) {
    const bough_node *rows = bough_entry(m->node, "values");
    if (rows->kind != BOUGH_SEQUENCE || rows->n != m->n) {
        bough_entry_fail(w->draft, rows, "values: expected a list of %d rows, as the grid has", m->n);
        return;
    }
    for (int k = 0; k < m->n && bough_is_ok(w->draft->status); k++) {
        int n = ENTRIES;
        const double *row = bough_entry_numbers(w->draft, rows->value[k], "", &n);
        for (int e = 0; row && e < ENTRIES; e++) m->entry[(size_t)e * m->n + k] = row[e];
    }
}

static const double *read_list(bough_windio *w, const matrices *m, const char *key) {
    int n = m->n;
    return bough_entry_numbers(w->draft, m->node, key, &n);
}

static matrices read_stiffness(bough_windio *w, const bough_node *from) {
    matrices m = read_grid(w, from, "stiff_matrix|stiffness_matrix");
    if (!m.node) return m;
    if (bough_entry(m.node, "values")) {
        read_rows(w, &m);
        return m;
    }
    for (int i = 0; i < 6; i++) {
        for (int j = i; j < 6; j++) {
            char key[] = {'K', (char)('1' + i), (char)('1' + j), '\0'};
            if (i != j && !bough_entry(m.node, key)) continue;
            const double *list = read_list(w, &m, key);
            for (int k = 0; list && k < m.n; k++)
                m.entry[(size_t)bough_symmetric6_index(i, j) * m.n + k] = list[k];
        }
    }
    return m;
}

// The inertia of a mass with its centre and inertias about the reference line.
static void put_inertia(matrices *m, int k, const double value[7]) {
    double mass = value[0], x = value[1], y = value[2];
    const struct {
        int i, j;
        double value;
    } entry[] = {{0, 0, mass},     {1, 1, mass},     {2, 2, mass},      {0, 5, -mass * y},
                 {1, 5, mass * x}, {2, 3, mass * y}, {2, 4, -mass * x}, {3, 3, value[3]},
                 {4, 4, value[4]}, {5, 5, value[5]}, {3, 4, -value[6]}};
    for (size_t e = 0; e < sizeof entry / sizeof *entry; e++)
        m->entry[(size_t)bough_symmetric6_index(entry[e].i, entry[e].j) * m->n + k] = entry[e].value;
}

static matrices read_inertia(bough_windio *w, const bough_node *from) {
    static const char *const key[] = {"mass", "cm_x", "cm_y", "i_edge", "i_flap", "i_plr", "i_cp"};
    static const bool needed[] = {true, false, false, true, true, true, false};
    matrices m = read_grid(w, from, "inertia_matrix");
    if (!m.node) return m;
    if (bough_entry(m.node, "values")) {
        read_rows(w, &m);
        return m;
    }
    const double *list[7];
    for (int e = 0; e < 7; e++)
        list[e] = needed[e] || bough_entry(m.node, key[e]) ? read_list(w, &m, key[e]) : NULL;
    for (int k = 0; k < m.n && bough_is_ok(w->draft->status); k++) {
        double value[7];
        for (int e = 0; e < 7; e++) value[e] = list[e] ? list[e][k] : 0;
        put_inertia(&m, k, value);
    }
    return m;
}

// -- stations -------------------------------------------------------------------------------------

// Shear stiffnesses of zero, with nothing beside them, are those of a blade without shear: such a section
// gets its axial stiffness. Whether there are any.
static bool stiffen_shear(double k[MATRIX]) {
    enum { AXIAL = 2 * 7 };
    bool any = false;
    for (int i = 0; i < 2; i++) {
        bool zero = true;
        for (int j = 0; j < 6; j++) zero = zero && k[6 * i + j] == 0;
        if (zero) k[7 * i] = k[AXIAL];
        any = any || zero;
    }
    return any;
}

static void put_station(bough_windio *w, const matrices *stiffness, const matrices *inertia, double fraction,
                        double twist, double *deviation) {
    double k[MATRIX], m[MATRIX];
    matrix_at(stiffness, fraction, k);
    matrix_at(inertia, fraction, m);
    w->shear_stiff = stiffen_shear(k) || w->shear_stiff;
    if (!bough_section_possible(k, m)) {
        bough_entry_fail(w->draft, stiffness->node,
                         "at %.4g of the span: expected stiffness and inertia of a real section, positive "
                         "definite",
                         fraction);
    }
    const bough_section_place at = {bough_curve_at(&w->axis[0], fraction),
                                    bough_curve_at(&w->axis[1], fraction),
                                    bough_curve_at(&w->axis[2], fraction), twist};
    bough_section_matrix_put(w->draft->file[BOUGH_IMPORT_BLADE], &at, k, m);
    *deviation = fmax(*deviation, bough_section_deviation(m));
}

// The mass between two points of the reference line [kg].
static double mass_between(const bough_windio *w, const matrices *inertia, double a, double b) {
    double square = 0;
    bough_curve mass = curve_of(inertia, 0, 0);
    for (int i = 0; i < 3; i++) {
        double step = bough_curve_at(&w->axis[i], b) - bough_curve_at(&w->axis[i], a);
        square += step * step;
    }
    return sqrt(square) * (bough_curve_at(&mass, a) + bough_curve_at(&mass, b)) / 2;
}

const double *bough_windio_damping(bough_windio *w, const bough_node *from, const char *part, double usual) {
    int n = 6;
    double *assumed = bough_arena_doubles(w->draft->arena, 6);
    const double *mu = assumed;
    for (int i = 0; i < 6; i++) assumed[i] = usual;
    if (bough_entry(from, "structural_damping.mu"))
        mu = bough_entry_numbers(w->draft, from, "structural_damping.mu", &n);
    bool any = false;
    for (int i = 0; mu && i < 6; i++) {
        any = any || mu[i] > 0;
        if (mu[i] < 0)
            bough_entry_fail(w->draft, from, "structural_damping.mu: expected times that are not negative");
    }
    if (any && mu != assumed) return mu;
    bough_approximated(w, "%s: no damping given: damping coefficient of %g s assumed for all strains", part,
                       usual);
    return assumed;
}

static void put_damping(bough_windio *w, const bough_node *from) {
    FILE *file = w->draft->file[BOUGH_IMPORT_BLADE];
    fprintf(file, "length: %.10g\ndamping: ", w->blade_length);
    bough_import_list(file, bough_windio_damping(w, from, "blade", usual_damping), 6);
    fputs("  # s\n", file);
    bough_section_matrix_head(file);
}

static void put_stations(bough_windio *w, const bough_node *from, const matrices *stiffness,
                         const matrices *inertia) {
    bough_curve k = curve_of(stiffness, 0, 0), m = curve_of(inertia, 0, 0);
    bough_curve twist = bough_entry_curve(w->draft, bough_entry(from, "twist") ? from : w->shape, "twist");
    bough_windio_check_angles(w, &twist, "twist");
    const bough_curve *all[] = {&k, &m, &twist, &w->axis[0], &w->axis[1], &w->axis[2]};
    double *fraction, deviation = 0;
    int n = bough_curve_fractions(w->draft, all, 6, 1e-6, &fraction); // points of any of the curves
    for (int i = 0; i < n && bough_is_ok(w->draft->status); i++) {
        double turn = bough_curve_at(&twist, fraction[i]) * w->degree;
        put_station(w, stiffness, inertia, fraction[i], turn, &deviation);
        if (i == 0) continue;
        double mass = mass_between(w, inertia, fraction[i - 1], fraction[i]);
        double radius = w->hub_radius + bough_curve_at(&w->axis[2], (fraction[i - 1] + fraction[i]) / 2);
        w->blade_mass += mass;
        w->inertia += w->n_blade * mass * radius * radius;
    }
    bough_taken(w, "%d stations of the blade, %d of them with full stiffness and inertia; it weighs %.7g kg",
                n, stiffness->n, w->blade_mass);
    if (w->shear_stiff) {
        bough_approximated(w, "blade: shear stiffness of zero (K11, K22) is read as no shear: the axial "
                              "stiffness");
    }
    bough_section_note(w->draft, deviation);
}

// The matrices that the file gives; NULL: none.
static const bough_node *find_matrices(const bough_windio *w) {
    static const char *const path[] = {"elastic_properties_mb.six_x_six", "structure.elastic_properties",
                                       "elastic_properties.six_x_six", "elastic_properties"};
    for (size_t i = 0; i < sizeof path / sizeof *path; i++) {
        const bough_node *from = bough_entry(w->blade, path[i]);
        if (bough_entry(from, "stiff_matrix|stiffness_matrix")) return from;
    }
    return NULL;
}

// Whether both are positive definite wherever the file gives one of them.
static bool are_possible(const matrices *stiffness, const matrices *inertia) {
    const matrices *given[] = {stiffness, inertia};
    double k[MATRIX], m[MATRIX];
    for (int g = 0; g < 2; g++) {
        for (int i = 0; i < given[g]->n; i++) {
            matrix_at(stiffness, given[g]->grid[i], k);
            matrix_at(inertia, given[g]->grid[i], m);
            stiffen_shear(k);
            if (!bough_section_possible(k, m)) return false;
        }
    }
    return true;
}

void bough_windio_blade(bough_windio *w) {
    const bough_node *from = find_matrices(w);
    matrices stiffness = {0}, inertia = {0};
    if (!from && !bough_windio_has_layers(w)) {
        bough_entry_fail(w->draft, w->blade,
                         "expected stiffness and inertia of the blade: 'elastic_properties_mb.six_x_six' or "
                         "'structure.elastic_properties', or the layers that it is made of");
        return;
    }
    if (from) {
        stiffness = read_stiffness(w, from);
        inertia = read_inertia(w, from);
    }
    bool good = from && bough_is_ok(w->draft->status) && are_possible(&stiffness, &inertia);
    if (bough_windio_has_layers(w) && !good) {
        if (from) {
            bough_left_out(w, "blade: the matrices of stiffness and inertia, which no section can have: they "
                              "are not positive definite");
        }
        bough_windio_layup(w, &stiffness, &inertia);
        bough_approximated(w, "blade: stiffness and inertia of thin walls, from layers and webs: plane "
                              "sections, shear flow in the cells, no coupling by fibre angles");
    }
    if (bough_is_ok(w->draft->status)) {
        bough_curve_of(w->draft, stiffness.node, stiffness.grid, stiffness.entry, stiffness.n);
        bough_curve_of(w->draft, inertia.node, inertia.grid, inertia.entry, inertia.n);
    }
    if (!bough_is_ok(w->draft->status)) return;
    put_damping(w, from);
    put_stations(w, from, &stiffness, &inertia);
    if (bough_entry_number_or(w->draft, w->blade, "internal_structure_2d_fem.joint.mass", 0) > 0) {
        bough_left_out(w, "the mass of the blade's joint");
    }
}
