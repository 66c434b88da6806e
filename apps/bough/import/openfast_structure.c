// ElastoDyn's blade and tower: mass and two bending stiffnesses along the span, and mode shapes, whose
// frequencies convert damping ratios to times.
#include "apps/bough/import/openfast.h"
#include "apps/bough/import/section.h"

enum { MOST = 1000, GRID = 400, FIRST = 2, COEFFICIENTS = 5 };

// E/ρ [m²/s²] where the deck has no axial stiffness: of a blade's laminates, of steel with paint,
// bolts and flanges counted as density.
static const double laminate = 1e7, steel = 210e9 / 8500;

typedef struct slender {
    int n;
    const double *row;        // (n × width): fraction of the span, then as below
    int width, mass, bending; // columns
    double mass_factor, bending_factor;
    double length;       // [m]
    const double *shape; // (COEFFICIENTS) of x² to x⁶
} slender;

static double at(const slender *b, int column, double x) {
    const double *r = b->row;
    int w = b->width, i = bough_table_row(b->n, r, w, x);
    double s = (x - r[i * w]) / (r[(i + 1) * w] - r[i * w]);
    return r[i * w + column] + s * (r[(i + 1) * w + column] - r[i * w + column]);
}

// The frequency of the mode by Rayleigh's quotient, ∫ E I φ''² / ∫ m φ² [rad/s]. That of a tower is without
// its top: ElastoDyn's damping ratio refers to it.
static double frequency(const slender *b) {
    double stiffness = 0, mass = 0;
    for (int i = 0; i <= GRID; i++) {
        double x = (double)i / GRID, weight = (i == 0 || i == GRID ? 0.5 : 1) * b->length / GRID;
        double value = 0, curvature = 0;
        for (int k = 0; k < COEFFICIENTS; k++) {
            int power = FIRST + k;
            value += b->shape[k] * pow(x, power);
            curvature += b->shape[k] * power * (power - 1) * pow(x, power - 2);
        }
        curvature /= b->length * b->length;
        stiffness += weight * b->bending_factor * at(b, b->bending, x) * curvature * curvature;
        mass += weight * b->mass_factor * at(b, b->mass, x) * value * value;
    }
    return sqrt(stiffness / mass);
}

// The frequency of the mode whose shape is `stem`(2) to (6) [rad/s].
static double frequency_of(const bough_deck *deck, slender b, const char *stem) {
    double shape[COEFFICIENTS];
    for (int k = 0; k < COEFFICIENTS; k++) {
        shape[k] = bough_deck_number(deck, bough_arena_print(deck->arena, "%s(%d)", stem, FIRST + k));
    }
    b.shape = shape;
    return bough_is_ok(deck->status) ? frequency(&b) : 0;
}

// The damping time of that mode: 2 ζ/ω with its ratio ζ [%] [s].
static double damping(const bough_deck *deck, slender b, const char *ratio, const char *stem) {
    double omega = frequency_of(deck, b, stem), zeta = bough_deck_number(deck, ratio) / 100;
    return bough_is_ok(deck->status) && zeta > 0 && omega > 0 ? 2 * zeta / omega : 0;
}

// Half a per cent at the first flapwise mode [s].
static double least_damping(const bough_deck *deck, const slender *b) {
    const double least = 0.005;
    double omega = frequency_of(deck, *b, "BldFl1Sh");
    return omega > 0 ? 2 * least / omega : 0;
}

// The factor of a bending stiffness: that of the table, times the tuner of the first mode's stiffness.
static double stiffness_factor(bough_openfast *o, const bough_deck *deck, const char *adjust,
                               const char *tuner) {
    double first = bough_deck_number_or(deck, bough_deck_kth(deck, tuner, 1), 1);
    double second = bough_deck_number_or(deck, bough_deck_kth(deck, tuner, 2), first);
    if (second != first) bough_approximated(o, "%s(2): that of the first mode is used", tuner);
    return first * bough_deck_number_or(deck, adjust, 1);
}

static double total_mass(const slender *b) {
    double sum = 0;
    for (int i = 1; i < b->n; i++) {
        const double *r = &b->row[(i - 1) * b->width];
        sum += (r[b->width] - r[0]) * (r[b->mass] + r[b->width + b->mass]) / 2;
    }
    return sum * b->mass_factor * b->length;
}

void bough_openfast_weigh(bough_openfast *o, const double span[2], const double mass[2]) {
    double own = (span[1] - span[0]) * (mass[0] + mass[1]) / 2;
    double radius = o->hub_radius + (span[0] + span[1]) / 2;
    o->blade_mass += own;
    o->blade_inertia += own * radius * radius;
}

// Extends the table to 0 and 1 with its first and last rows; a single station holds for the whole span.
static void extend(bough_openfast *o, const bough_deck *deck, slender *b, const char *count) {
    const double close = 1e-4;
    if (!b->row || b->n < 1) return;
    size_t width = (size_t)b->width;
    double *row = bough_arena_doubles(o->draft->arena, width * ((size_t)b->n + 2));
    const double *last = b->row + width * (size_t)(b->n - 1);
    double first = b->n == 1 ? 1 : b->row[0], end = b->n == 1 ? 0 : last[0];
    int before = first > close, after = end < 1 - close;
    memcpy(row, b->row, width * sizeof *row);
    memcpy(row + width * (size_t)before, b->row, width * (size_t)b->n * sizeof *row);
    memcpy(row + width * (size_t)(b->n + before), last, width * sizeof *row);
    if (b->n == 1) before = 0;
    b->n += before + after;
    b->row = row;
    row[0] = 0;
    row[width * (size_t)(b->n - 1)] = 1;
    if (before || after) {
        bough_approximated(o, "%s: the table is extended to both ends with its first and last values", count);
    }
    if (end > 1 + close || first < -close) {
        bough_deck_refuse(deck, count, "expected fractions of the span from 0 to 1, got %g to %g", first,
                          end);
    }
}

static void check_rows(const bough_deck *deck, const slender *b, const char *count, int second) {
    int line = bough_deck_line(deck, count);
    for (int i = 0; i < b->n; i++) {
        const double *r = &b->row[i * b->width];
        bool grows = i == 0 || r[0] > r[-b->width];
        if (grows && r[b->mass] > 0 && r[b->bending] > 0 && r[second] > 0) continue;
        bough_deck_fail(deck, line,
                        "%s: row %d of its table: expected increasing fractions of the span from 0 to 1, "
                        "positive mass and stiffness",
                        count, i + 1);
    }
}

// -- blade ----------------------------------------------------------------------------------------

enum { FRACTION, TWIST, MASS, FLAP, EDGE, AXIAL, N_BLADE_COLUMN };

static void put_blade(bough_openfast *o, const bough_deck *deck, const slender *b, double edge) {
    const double flap_time = damping(deck, *b, "BldFlDmp(1)|BldFlDmp1", "BldFl1Sh");
    slender edgewise = *b;
    edgewise.bending = EDGE;
    edgewise.bending_factor = edge;
    double edge_time = damping(deck, edgewise, "BldEdDmp(1)|BldEdDmp1", "BldEdgSh");
    if (!bough_is_ok(o->draft->status)) return;
    // ElastoDyn has no shear, stretch and twist: undamped, they would ring on at high frequencies
    double other = fmax(flap_time, least_damping(deck, b));
    const double time[] = {other, fmax(edge_time, other), other, edge_time, flap_time, other};
    FILE *file = o->draft->file[BOUGH_IMPORT_BLADE];
    bough_section_head(file, b->length, time);
    for (int i = 0; i < b->n; i++) {
        const double *r = &b->row[i * b->width];
        double mass = r[MASS] * b->mass_factor;
        double axial = r[AXIAL] > 0 ? r[AXIAL] : laminate * mass;
        double bend_x = r[EDGE] * edge, bend_y = r[FLAP] * b->bending_factor;
        bough_section s = {r[0] * b->length, r[TWIST], mass, axial, axial / 10, bend_x, bend_y, bend_x};
        bough_section_put(file, &s);
    }
}

void bough_openfast_blade(bough_openfast *o) {
    bough_deck *deck = bough_openfast_open(o, o->elasto, "BldFile(1)|BldFile1");
    if (!deck) return;
    const char *const column[] = {"BlFract", "StrcTwst", "BMassDen", "FlpStff", "EdgStff", "?EAStff"};
    int n = bough_deck_whole(deck, "NBlInpSt", 1, MOST);
    slender b = {.n = n,
                 .width = N_BLADE_COLUMN,
                 .mass = MASS,
                 .bending = FLAP,
                 .row = bough_deck_table(deck, column, N_BLADE_COLUMN, n),
                 .mass_factor = bough_deck_number_or(deck, "AdjBlMs", 1),
                 .bending_factor = stiffness_factor(o, deck, "AdjFlSt", "FlStTunr"),
                 .length = bough_deck_number(o->elasto, "TipRad") - o->hub_radius};
    double edge = bough_deck_number_or(deck, "AdjEdSt", 1);
    extend(o, deck, &b, "NBlInpSt");
    if (!bough_is_ok(o->draft->status)) return;
    if (!(b.length > 0)) {
        bough_deck_refuse(o->elasto, "TipRad", "expected more than HubRad");
    }
    check_rows(deck, &b, "NBlInpSt", EDGE);
    put_blade(o, deck, &b, edge);
    o->blade_length = b.length;
    for (int i = 1; i < b.n; i++) {
        const double *r = &b.row[i * b.width];
        bough_openfast_weigh(o, (const double[]){r[-b.width] * b.length, r[0] * b.length},
                             (const double[]){r[MASS - b.width] * b.mass_factor, r[MASS] * b.mass_factor});
    }
    bough_taken(o, "%d stations, mass times AdjBlMs %g: the blade weighs %.7g kg, without tip mass", n,
                b.mass_factor, o->blade_mass);
    if (o->rigid_blade) {
        bough_taken(o, "FlapDOF1, FlapDOF2, EdgeDOF False: the blades are rigid");
        return;
    }
    bough_approximated(o, "blade: geometrically exact instead of ElastoDyn's modes; its damping ratio grows "
                          "with the frequency, from that of the first mode");
    if (!(b.row[AXIAL] > 0)) {
        bough_approximated(o,
                           "blade: axial stiffness is mass x %.3g m2/s2, shear stiffness a tenth of it, "
                           "rotary inertia as for one material",
                           laminate);
    }
    bough_approximated(o, "blade: ElastoDyn has no torsion, so the torsional stiffness is the edgewise one, "
                          "which is stiff; no offsets of mass and shear centre");
}

// -- tower ----------------------------------------------------------------------------------------

enum { FORE = 2, SIDE, N_TOWER_COLUMN };

void bough_openfast_tower(bough_openfast *o) {
    bough_deck *deck = bough_openfast_open(o, o->elasto, "TwrFile");
    if (!deck) return;
    const char *const column[] = {"HtFract", "TMassDen", "TwFAStif", "TwSSStif"};
    int n = bough_deck_whole(deck, "NTwInpSt", 1, MOST);
    slender b = {.n = n,
                 .width = N_TOWER_COLUMN,
                 .mass = 1,
                 .bending = FORE,
                 .row = bough_deck_table(deck, column, N_TOWER_COLUMN, n),
                 .mass_factor = bough_deck_number_or(deck, "AdjTwMa", 1),
                 .bending_factor = stiffness_factor(o, deck, "AdjFASt", "FAStTunr"),
                 .length = o->tower_top - o->tower_base};
    double side = stiffness_factor(o, deck, "AdjSSSt", "SSStTunr");
    extend(o, deck, &b, "NTwInpSt");
    if (!bough_is_ok(o->draft->status)) return;
    check_rows(deck, &b, "NTwInpSt", SIDE);
    slender sideways = b;
    sideways.bending = SIDE;
    sideways.bending_factor = side;
    double fore_time = damping(deck, b, "TwrFADmp(1)|TwrFADmp1", "TwFAM1Sh");
    bool has_side = bough_deck_line(deck, "TwSSM1Sh(2)") >= 0;
    double side_time = has_side ? damping(deck, sideways, "TwrSSDmp(1)|TwrSSDmp1", "TwSSM1Sh") : fore_time;
    if (!bough_is_ok(o->draft->status)) return;
    double other = fmax(fore_time, side_time); // ElastoDyn's tower does not shear, stretch and twist
    const double times[] = {other, other, other, side_time, fore_time, other};
    FILE *file = o->draft->file[BOUGH_IMPORT_TOWER];
    bough_section_head(file, b.length, times);
    for (int i = 0; i < b.n; i++) {
        const double *r = &b.row[i * b.width];
        double mass = r[1] * b.mass_factor, axial = steel * mass;
        double x = r[SIDE] * side, y = r[FORE] * b.bending_factor, ratio = 80.8 / 210;
        bough_section s = {r[0] * b.length, 0, mass, axial, axial * ratio / 2, x, y, (x + y) * ratio};
        bough_section_put(file, &s);
    }
    bough_taken(o, "%d stations of the tower, which weighs %.7g kg", n, total_mass(&b));
    bough_approximated(o, "tower: axial, shear and torsional stiffness of a thin steel tube; the damping "
                          "ratio grows with the frequency, from that of the first mode of the tower without "
                          "its top");
}
