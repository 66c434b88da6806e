// AeroDyn 15: airfoils, blade elements, options of the theory, tower.
#include "apps/bough/import/openfast.h"

enum { MOST_AIRFOILS = 200, MOST_ROWS = 2000, MOST_COLUMNS = 20, NAME = BOUGH_AIRFOIL_NAME };

// -- airfoils -------------------------------------------------------------------------------------

enum { POLAR = BOUGH_POLAR_COLUMNS };

// The rows (n × POLAR) of a file's first table.
static double *read_polar(bough_openfast *o, const bough_deck *deck, int *n) {
    int column[POLAR] = {
        bough_deck_whole_or(o->aero, "InCol_Alfa", 1), bough_deck_whole_or(o->aero, "InCol_Cl", 2),
        bough_deck_whole_or(o->aero, "InCol_Cd", 3), bough_deck_whole_or(o->aero, "InCol_Cm", 0)};
    int width = 0, line = bough_deck_line(deck, "NumAlf") + 1;
    *n = bough_deck_whole(deck, "NumAlf", 1, MOST_ROWS);
    for (int k = 0; k < POLAR; k++) {
        width = column[k] > width ? column[k] : width;
        if (column[k] >= (k < 3) && column[k] <= MOST_COLUMNS) continue;
        bough_deck_fail(o->aero, bough_deck_line(o->aero, "InCol_Alfa"),
                        "InCol_Alfa, InCol_Cl, InCol_Cd, InCol_Cm: expected columns from 1 to %d",
                        (int)MOST_COLUMNS);
    }
    if (!bough_is_ok(o->draft->status)) return NULL;
    double *table = bough_arena_doubles(o->draft->arena, (size_t)POLAR * (size_t)*n), row[MOST_COLUMNS];
    for (int i = 0; i < *n && bough_is_ok(o->draft->status); i++) {
        bough_deck_row(deck, &line, "a row of the polar", width, row);
        for (int k = 0; k < POLAR; k++) table[POLAR * i + k] = column[k] > 0 ? row[column[k] - 1] : 0;
        double angle = table[POLAR * i];
        if (fabs(angle) <= 180 + 1e-3 && (i == 0 || angle > table[POLAR * (i - 1)])) continue;
        bough_deck_fail(deck, line - 1, "alpha: expected increasing angles from -180 to 180 deg, got %g",
                        angle);
    }
    return bough_is_ok(o->draft->status) ? table : NULL;
}

static bool dynamic_stall(const bough_deck *aero) {
    if (bough_deck_line(aero, "UA_Mod") >= 0) return bough_deck_whole_or(aero, "UA_Mod", 0) > 0;
    return bough_deck_whole_or(aero, "AFAeroMod", 1) == 2;
}

static void put_polar(bough_openfast *o, const bough_deck *deck, const char *name) {
    int n;
    const double *table = read_polar(o, deck, &n);
    if (!table) return;
    // The defaults are AeroDyn's.
    const double indicial[] = {bough_deck_number_or(deck, "A1", 0.3), bough_deck_number_or(deck, "A2", 0.7),
                               bough_deck_number_or(deck, "b1", 0.14),
                               bough_deck_number_or(deck, "b2", 0.53)};
    if (!bough_is_ok(o->draft->status)) return;
    bough_draft_polar(o->draft, name, table, n, dynamic_stall(o->aero) ? indicial : NULL);
    if (bough_deck_whole_or(deck, "NumTabs", 1) > 1) {
        bough_approximated(o, "%s: the first of its tables is used for all Reynolds numbers", name);
    }
}

// Opens the airfoil file named on the first line from *line on that is no comment; *line moves past it.
// `name`: of its polar in the scene. NULL: not opened, the draft's status says why.
static bough_deck *open_airfoil(bough_openfast *o, int *line, int number, char name[NAME]) {
    while (bough_deck_is_comment(o->aero, *line)) ++*line;
    const char *path = bough_deck_file_at(o->aero, (*line)++);
    bough_deck *deck = bough_deck_open(o->draft->arena, path, 0, o->draft->status);
    const char *own = bough_file_name(path);
    if (deck) bough_draft_airfoil_name(own, strcspn(own, "."), number, name);
    return deck;
}

static int put_polars(bough_openfast *o, char (*name)[NAME]) {
    int n = bough_deck_whole(o->aero, "NumAFfiles", 1, MOST_AIRFOILS);
    int line = bough_deck_line(o->aero, "AFNames");
    if (line < 0) line = bough_deck_line(o->aero, "NumAFfiles") + 1; // the label may be missing
    bool given = false;
    fputs("polars:\n", o->draft->file[BOUGH_IMPORT_POLARS]);
    for (int i = 0; i < n && bough_is_ok(o->draft->status); i++) {
        bough_deck *deck = open_airfoil(o, &line, i + 1, name[i]);
        if (!deck) return 0;
        put_polar(o, deck, name[i]);
        given = bough_deck_flag_or(deck, "InclUAdata", false) || given;
    }
    if (given && dynamic_stall(o->aero))
        bough_left_out(o, "InclUAdata: constants of dynamic stall beside A1, A2, b1 and b2");
    bough_taken(o, "%d airfoils: lift, drag, moment", n);
    return n;
}

// -- blade elements -------------------------------------------------------------------------------

// Columns of a table: span [m], curve, sweep [m], angle of the curve [deg], twist [deg], chord [m], airfoil
// from 1.
enum { SPAN, CURVE, SWEEP, CURVE_ANGLE, TWIST, CHORD, AIRFOIL, N_COLUMN };

static void put_element(FILE *file, const double *row, double span, const char *name) {
    fprintf(file, "    - [%.10g, %.10g, %.10g, %.10g, %.10g, %s]\n", span, row[CURVE], row[SWEEP], row[TWIST],
            row[CHORD], name);
}

// Writes the elements from root to tip: a table that reaches beyond the tip is cut, one that ends before it
// is extended with its last row. A station within a millimetre of an end is at it.
static void put_span(bough_openfast *o, const double *row, int n, char (*name)[NAME]) {
    FILE *file = o->draft->file[BOUGH_IMPORT_AERO];
    const double close = 1e-3, length = o->blade_length; // [m]
    double first = row[SPAN], last = row[(n - 1) * N_COLUMN + SPAN];
    if (first > close) put_element(file, row, 0, name[(int)row[AIRFOIL] - 1]);
    for (int i = 0; i < n; i++, row += N_COLUMN) {
        double before = i > 0 ? row[SPAN - N_COLUMN] : row[SPAN], at = row[SPAN];
        if (before >= length - close && i > 0) break;
        if (at < close && i == 0) at = 0;
        if (at < length - close) {
            put_element(file, row, at, name[(int)row[AIRFOIL] - 1]);
            continue;
        }
        double cut[N_COLUMN], fraction = at > before ? fmin((length - before) / (at - before), 1) : 1;
        for (int c = 0; c < N_COLUMN; c++)
            cut[c] = i > 0 ? row[c - N_COLUMN] + fraction * (row[c] - row[c - N_COLUMN]) : row[c];
        put_element(file, cut, length, name[(int)row[AIRFOIL] - 1]);
    }
    if (last < length - close) {
        row -= N_COLUMN;
        put_element(file, row, length, name[(int)row[AIRFOIL] - 1]);
    }
    if (first > close || fabs(last - length) > close) {
        bough_approximated(o,
                           "blade elements from %g to %g m on a blade of %g m: cut at its tip, or "
                           "extended with the last element",
                           first, last, length);
    }
}

static void put_elements(bough_openfast *o, const bough_deck *deck, char (*name)[NAME], int n_name) {
    const char *const column[] = {"BlSpn", "BlCrvAC", "BlSwpAC", "?BlCrvAng", "BlTwist", "BlChord", "BlAFID"};
    int n = bough_deck_whole(deck, "NumBlNds", 1, MOST_ROWS);
    const double *row = bough_deck_table(deck, column, N_COLUMN, n);
    fputs("stations:\n  columns: [span, ac_x, ac_y, twist deg, chord, polar]\n  rows:\n",
          o->draft->file[BOUGH_IMPORT_AERO]);
    double angle = 0, last = -1;
    int line = bough_deck_line(deck, "NumBlNds");
    for (int i = 0; row && i < n; i++) {
        const double *r = row + N_COLUMN * i;
        int id = r[AIRFOIL] >= 1 && r[AIRFOIL] <= n_name ? (int)r[AIRFOIL] : 0;
        if (id != r[AIRFOIL]) {
            bough_deck_fail(deck, line, "BlAFID: row %d: expected an airfoil from 1 to %d, got %g", i + 1,
                            n_name, r[AIRFOIL]);
        } else if (!(r[SPAN] > last)) {
            bough_deck_fail(deck, line, "BlSpn: row %d: expected increasing spans from 0, got %g m", i + 1,
                            r[SPAN]);
        } else if (!(r[CHORD] > 0)) {
            bough_deck_fail(deck, line, "BlChord: row %d: expected a positive chord, got %g m", i + 1,
                            r[CHORD]);
        }
        last = r[SPAN];
        angle = fmax(angle, isnan(r[CURVE_ANGLE]) ? 0 : fabs(r[CURVE_ANGLE]));
    }
    if (!row || !bough_is_ok(o->draft->status)) return;
    put_span(o, row, n, name);
    bough_taken(o, "%d blade elements", n);
    if (angle > 0) {
        bough_left_out(o, "BlCrvAng, up to %g deg: elements are normal to the structure's axis", angle);
    }
}

void bough_openfast_aero_tables(bough_openfast *o) {
    if (!o->aero || !bough_is_ok(o->draft->status)) return;
    char(*name)[NAME] = bough_arena_take(o->draft->arena, MOST_AIRFOILS * sizeof *name);
    int n = put_polars(o, name);
    bough_deck *deck = bough_openfast_open(o, o->aero, "ADBlFile(1)|ADBlFile1");
    if (bough_is_ok(o->draft->status)) put_elements(o, deck, name, n);
}

// -- theory ---------------------------------------------------------------------------------------

static const char *truth(bool flag) { return flag ? "true" : "false"; }

static void put_induction(bough_openfast *o) {
    const bough_deck *a = o->aero;
    int wake = bough_deck_whole_or(a, "WakeMod|Wake_Mod", 1);
    int dynamic = bough_deck_whole_or(a, "DBEMT_Mod", 2);
    int skew = bough_deck_whole_or(a, "SkewMod|Skew_Mod", 1);
    bool new_skew = bough_deck_line(a, "Skew_Mod") >= 0;
    bool may = wake == 2 || (wake == 1 && bough_deck_line(a, "Wake_Mod") >= 0), oye = may && dynamic > 0;
    bool pitt = new_skew ? skew == 1 && bough_deck_whole_or(a, "SkewRedistr_Mod", 1) != 0 : skew == 2;
    int balance = bough_deck_whole_or(a, "BEM_Mod", 0);
    bough_put(o,
              "  induction: {tip_loss: %s, hub_loss: %s, tangential: %s, drag: %s, skew: %s, "
              "high_thrust: %s",
              truth(bough_deck_flag_or(a, "TipLoss", true)), truth(bough_deck_flag_or(a, "HubLoss", true)),
              truth(bough_deck_flag_or(a, "TanInd", true)), truth(bough_deck_flag_or(a, "AIDrag", true)),
              pitt ? "pitt-peters" : "none", balance == 1 ? "buhl" : "smooth");
    bool momentum = bough_deck_flag_or(a, "SkewMomCorr", false);
    if (momentum && balance != 1) bough_put(o, ", skewed_momentum: true");
    if (oye) bough_put(o, ", inflow: oye");
    double time = oye && dynamic != 2 ? bough_deck_number_or(a, "tau1_const", (double)NAN) : (double)NAN;
    if (time > 0) bough_put(o, ", inflow_time: %.10g s", time);
    if (time <= 0) bough_deck_refuse(a, "tau1_const", "expected a time above 0 s, got %g", time);
    bough_put(o, "}\n");
    if (momentum && balance == 1) {
        bough_left_out(o, "SkewMomCorr is only used with BEM_Mod 2");
    }
    if (bough_deck_flag_or(a, "AIDrag", true) != bough_deck_flag_or(a, "TIDrag", true)) {
        bough_approximated(o, "TIDrag: drag in the tangential induction follows AIDrag");
    }
    if (balance == 1) {
        bough_approximated(o, "BEM_Mod 1: Buhl's high-thrust correction, and otherwise the momentum balance "
                              "of BEM_Mod 2");
    } else if (balance == 0) {
        bough_approximated(o, "no BEM_Mod: smooth high-thrust correction, in place of Buhl's in AeroDyn "
                              "before version 4");
    }
    if (wake == 0) bough_other_case(o, "WakeMod 0, no induction: it is computed");
    if (may && dynamic < 0) bough_other_case(o, "DBEMT_Mod -1, frozen wake: it follows the load at once");
    if (skew == -new_skew) {
        bough_approximated(o, "%s %d: the whole wind acts, not only its part along the shaft",
                           new_skew ? "Skew_Mod" : "SkewMod", skew);
    }
    const double usual = 15 * BOUGH_PI / 32;
    double factor = bough_deck_number_or(a, "SkewModFactor|SkewRedistrFactor", usual);
    if (pitt && fabs(factor - usual) > 1e-3)
        bough_approximated(o, "SkewModFactor %g: %.4g, its default", factor, usual);
    if (wake == 3) {
        bough_approximated(o, "OLAF: replaced by blade element momentum theory");
    }
    if (oye) {
        bough_approximated(o, "DBEMT_Mod %d: Oye's dynamic inflow, for each element separately", dynamic);
    }
}

static void put_stall(bough_openfast *o) {
    const bough_deck *a = o->aero;
    int model = bough_deck_whole_or(a, "UAMod|UA_Mod", 4);
    bool on = dynamic_stall(a), rotated = bough_deck_flag_or(a, "AoA34", on);
    if (on) bough_put(o, "  dynamic_stall: hgm\n");
    if (on && model == 0) bough_deck_refuse(a, "UAMod", "expected one of 1 to 8 with AFAeroMod 2, got 0");
    if (on != rotated) {
        bough_approximated(o, "AoA34 %s: the angle of attack is that at %s", rotated ? "True" : "False",
                           on ? "three quarters of the chord" : "the aerodynamic centre");
    }
    if (on && model != 4) {
        bough_approximated(o,
                           "UAMod %d: dynamic stall by Hansen, Gaunaa and Madsen's model (4), its "
                           "constants from the polars",
                           model);
    }
    static const bough_openfast_rest rest[] = {
        {"dynamic stall acts on all elements", 0, {"UAStartRad"}},
        {"dynamic stall acts on all elements", 1, {"UAEndRad"}},
    };
    if (on) bough_openfast_leave(o, a, rest, 2, BOUGH_LEFT_OUT);
    if (!bough_deck_flag_or(a, "UseBlCm", true)) bough_put(o, "  pitching_moment: false\n");
}

// The rows above the ground, and the last below it, moved to the ground.
static const double *above_ground(bough_openfast *o, const double *row, int *n) {
    double *kept = bough_arena_doubles(o->draft->arena, 3 * ((size_t)*n + 1));
    int m = 0;
    for (int i = 0; i < *n; i++) {
        const double *r = row + 3 * i;
        if (i + 1 < *n && r[3] <= 0) continue;
        double height = fmax(r[0], 0);
        if (!(r[1] > 0) || r[2] < 0 || (m > 0 && !(height > kept[3 * (m - 1)]))) {
            bough_deck_fail(o->aero, bough_deck_line(o->aero, "NumTwrNds"),
                            "TwrElev, TwrDiam, TwrCd: row %d: expected increasing heights, positive "
                            "diameters, drag not negative",
                            i + 1);
        }
        const double own[] = {height, r[1], r[2]};
        memcpy(kept + 3 * m++, own, sizeof own);
    }
    if (m == 1) { // one for the whole height
        const double own[] = {fmax(o->tower_top, kept[0] + 1), kept[1], kept[2]};
        memcpy(kept + 3 * m++, own, sizeof own);
    }
    *n = m;
    return kept;
}

static void put_tower(bough_openfast *o) {
    const bough_deck *a = o->aero;
    const char *const column[] = {"TwrElev", "TwrDiam", "TwrCd"};
    int potential = bough_deck_whole_or(a, "TwrPotent", 0);
    int shadow = (int)bough_deck_switch_or(a, "TwrShadow", 0); // a flag before AeroDyn 15.04
    bool drag = bough_deck_flag_or(a, "TwrAero", false) && !o->rigid_tower;
    if (potential == 0 && shadow == 0 && !drag) return;
    int n = bough_deck_whole(a, "NumTwrNds", 1, MOST_ROWS);
    const double *row = bough_deck_table(a, column, 3, n);
    if (row) row = above_ground(o, row, &n);
    if (!row) return;
    bough_put(o, "  tower:\n    influence: %s\n", potential == 2 ? "bak" : "potential");
    if (shadow > 0) bough_put(o, "    shadow: powles\n");
    if (drag) bough_put(o, "    body: tower\n");
    bough_draft_tower_list(o->draft, "height", row, 3, n);
    bough_draft_tower_list(o->draft, "diameter", row + 1, 3, n);
    bough_draft_tower_list(o->draft, "drag", row + 2, 3, n);
    bough_taken(o, "the tower's influence on the wind%s", drag ? " and its drag" : "");
    if (potential == 0) {
        bough_approximated(o, "TwrPotent 0: potential flow about the tower is included with its shadow or "
                              "drag");
    }
    if (shadow == 2) {
        bough_approximated(o, "TwrShadow 2: Powles' model replaces Eames'");
    }
}

void bough_openfast_aero(bough_openfast *o) {
    const bough_deck *a = o->aero;
    if (!a || !bough_is_ok(o->draft->status)) return;
    double density = bough_deck_number_or(o->main, "AirDens", 1.225);
    bough_put(o, "aero:\n  rate: %.10g Hz\n  air_density: %.10g\n", 1 / o->draft->macro_step,
              bough_deck_number_or(a, "AirDens", density));
    bough_openfast_wind(o);
    bough_put(o, "  blade: %s\n  polars: %s\n  hub_radius: %.10g m\n", bough_import_name[BOUGH_IMPORT_AERO],
              bough_import_name[BOUGH_IMPORT_POLARS], o->hub_radius);
    put_induction(o);
    put_stall(o);
    put_tower(o);
    static const bough_openfast_rest rest[] = {
        {NULL, 0, {"CavitCheck", "Buoyancy", "CompAA", "TFinAero", "NacelleDrag", "SectAvg"}}};
    bough_openfast_leave(o, a, rest, 1, BOUGH_LEFT_OUT);
}
