// BeamDyn's blade: key points of the reference line, and two 6 × 6 matrices at each station.
#include "apps/bough/import/openfast.h"
#include "apps/bough/import/section.h"

static const double close_enough = 1e-4; // of fractions of the length

enum { MOST = 1000, MATRIX = BOUGH_IMPORT_MATRIX, STATION = 1 + 2 * MATRIX };

// Bending stiffness and mass along the span, for the first frequencies.
typedef struct beam {
    int n;
    double *span, *flap, *edge, *mass; // (n) [m, N m2, N m2, kg/m]
} beam;

typedef bough_section_place line_point;

static double distance(line_point a, line_point b) {
    double x = b.x - a.x, y = b.y - a.y, z = b.z - a.z;
    return sqrt(x * x + y * y + z * z);
}

// The reference line at a fraction of its arc length [0 to 1].
static line_point at_fraction(const line_point *p, int n, double fraction) {
    double length = 0;
    for (int i = 1; i < n; i++) length += distance(p[i - 1], p[i]);
    double left = fraction * length;
    int i = 1;
    for (; i < n - 1 && left > distance(p[i - 1], p[i]); i++) left -= distance(p[i - 1], p[i]);
    line_point a = p[i - 1], b = p[i];
    double s = fmin(left / distance(a, b), 1);
    return (line_point){a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z),
                        a.twist + s * (b.twist - a.twist)};
}

static const line_point *read_line(bough_openfast *o, const bough_deck *deck, int *n) {
    *n = bough_deck_whole(deck, "kp_total", 2, MOST);
    if (bough_deck_whole_or(deck, "member_total", 1) != 1) {
        bough_approximated(o, "BeamDyn's members: joined to one row of points");
    }
    const char *const column[] = {"kp_xr", "kp_yr", "kp_zr", "initial_twist"};
    const line_point *p = (const line_point *)bough_deck_table(deck, column, 4, *n);
    for (int i = 1; p && i < *n; i++) {
        if (p[i].z > p[i - 1].z) continue;
        bough_deck_fail(deck, bough_deck_line(deck, "kp_total"),
                        "kp_zr: expected increasing values, but number %d is not larger than the one before",
                        i + 1);
    }
    if (p && fabs(p[0].z) > 1e-9) {
        bough_deck_fail(deck, bough_deck_line(deck, "kp_total"),
                        "kp_zr: expected the first point at 0, got %g", p[0].z);
    }
    return p;
}

// Writes the section `s` at a fraction of the line, and adds it to the beam and to the blade's mass.
static void add_station(bough_openfast *o, const bough_deck *deck, const line_point *p, int n_point,
                        double fraction, const double *s, int line, beam *b) {
    const double *k = s + 1, *m = s + 1 + MATRIX;
    line_point at = at_fraction(p, n_point, fraction);
    int i = b->n++;
    if (!bough_section_possible(k, m)) {
        bough_deck_fail(deck, line,
                        "the station: expected stiffness and inertia of a real section, positive definite");
    }
    bough_section_matrix_put(o->draft->file[BOUGH_IMPORT_BLADE], &at, k, m);
    b->span[i] = at.z;
    b->flap[i] = s[1 + 4 * 7];
    b->edge[i] = s[1 + 3 * 7];
    b->mass[i] = s[1 + MATRIX];
    if (i > 0) bough_openfast_weigh(o, b->span + i - 1, b->mass + i - 1);
}

static void put_stations(bough_openfast *o, const bough_deck *deck, const line_point *p, int n_point,
                         beam *b) {
    int n = bough_deck_whole(deck, "station_total", 1, MOST);
    int line = bough_deck_find(deck, "DISTRIBUTED PROPERTIES") + 1;
    if (bough_is_ok(o->draft->status) && line == 0) {
        bough_deck_fail(deck, -1, "no section 'DISTRIBUTED PROPERTIES'");
    }
    double first = 0, last = 0, s[STATION], deviation = 0;
    bough_section_matrix_head(o->draft->file[BOUGH_IMPORT_BLADE]);
    for (int i = 0; i < n && bough_is_ok(o->draft->status); i++) {
        bough_deck_numbers(deck, &line, "a station's fraction of the length", 1, s);
        int start = line - 1;
        bough_deck_numbers(deck, &line, "a station's two matrices", 2 * MATRIX, s + 1);
        bool good = i == 0 ? s[0] >= -close_enough : s[0] > last;
        if (!good || s[0] > 1 + close_enough) {
            bough_deck_fail(deck, start, "the station is at %g: expected increasing fractions from 0 to 1",
                            s[0]);
        }
        last = s[0];
        if (i == 0) first = last;
        if (fabs(s[0]) <= close_enough) s[0] = 0;
        if (fabs(s[0] - 1) <= close_enough) s[0] = 1;
        if (i == 0 && s[0] > 0) add_station(o, deck, p, n_point, 0, s, start, b);
        if (bough_is_ok(o->draft->status)) add_station(o, deck, p, n_point, s[0], s, start, b);
        deviation = fmax(deviation, bough_section_deviation(s + 1 + MATRIX));
        if (i == n - 1 && s[0] < 1) add_station(o, deck, p, n_point, 1, s, start, b);
    }
    if (bough_is_ok(o->draft->status) && (fabs(first) > close_enough || fabs(last - 1) > close_enough)) {
        bough_approximated(o, "stations from %g to %g of the length: extended with the values at their ends",
                           first, last);
    }
    bough_taken(o, "%d stations with full stiffness and mass; the blade weighs %.7g kg", n, o->blade_mass);
    bough_section_note(o->draft, deviation);
}

// Damping times by which the first flapwise and edgewise mode have the deck's ratios.
static const double *modal_damping(bough_openfast *o, const bough_deck *deck, const beam *b) {
    int n = bough_deck_whole(deck, "n_modes", 1, MOST), line = bough_deck_line(deck, "n_modes") + 1;
    double ratio[2] = {0}, *mu = bough_arena_doubles(o->draft->arena, 6);
    bough_deck_numbers(deck, &line, "zeta", n < 2 ? 1 : 2, ratio);
    if (!bough_is_ok(o->draft->status)) return NULL;
    double flap = 2 * ratio[0] / bough_section_frequency(b->n, b->span, b->flap, b->mass);
    double edge = 2 * ratio[n > 1] / bough_section_frequency(b->n, b->span, b->edge, b->mass);
    mu[0] = mu[2] = mu[4] = mu[5] = flap;
    mu[1] = mu[3] = edge;
    bough_approximated(o,
                       "damp_type 2: damping grows with the frequency from the first flapwise and "
                       "edgewise mode's zeta %g and %g",
                       ratio[0], ratio[n > 1]);
    return mu;
}

static void put_damping(bough_openfast *o, const bough_deck *deck, const beam *b) {
    const char *const column[] = {"mu1", "mu2", "mu3", "mu4", "mu5", "mu6"};
    static const double none[6] = {0};
    const double *mu = none;
    int kind = bough_deck_whole_or(deck, "damp_type", 1);
    if (kind == 1) mu = bough_deck_table(deck, column, 6, 1);
    if (kind == 2) mu = modal_damping(o, deck, b);
    if (!mu) return;
    fputs("damping: ", o->draft->file[BOUGH_IMPORT_BLADE]);
    bough_import_list(o->draft->file[BOUGH_IMPORT_BLADE], mu, 6);
    fputs("  # s\n", o->draft->file[BOUGH_IMPORT_BLADE]);
}

void bough_openfast_beamdyn(bough_openfast *o) {
    bough_deck *deck = bough_openfast_open(o, o->main, "BDBldFile(1)|BDBldFile1");
    if (!bough_is_ok(o->draft->status)) return;
    int n;
    const line_point *p = read_line(o, deck, &n);
    static const bough_openfast_rest rest[] = {{"the pitch actuator", 0, {"UsePitchAct"}}};
    bough_openfast_leave(o, deck, rest, 1, BOUGH_LEFT_OUT);
    bough_deck *blade = bough_openfast_open(o, deck, "BldFile");
    if (!bough_is_ok(o->draft->status)) return;
    o->blade_length = p[n - 1].z;
    fprintf(o->draft->file[BOUGH_IMPORT_BLADE], "length: %.10g\n", o->blade_length);
    beam b = {0};
    bough_arena_each(o->draft->arena, MOST + 2, &b.span, &b.flap, &b.edge, &b.mass);
    put_stations(o, blade, p, n, &b);
    if (bough_is_ok(o->draft->status)) put_damping(o, blade, &b);
}
