// InflowWind and AeroDyn 15: wind, airfoils, blade elements, what the theory counts.
#include "apps/import/openfast.h"

#include <math.h>
#include <string.h>

enum { MOST_ROWS = 2000, MOST_AIRFOILS = 200, MOST_COLUMNS = 20, NAME = 64 };

// -- airfoils -------------------------------------------------------------------------------------

// The file's name without folder and ending, in letters that a scene's names have; numbered.
static void airfoil_name(const char *path, int number, char name[NAME]) {
    const char *slash = strrchr(path, '/');
    int n = snprintf(name, NAME, "%d-", number);
    for (const char *p = slash ? slash + 1 : path; *p && *p != '.' && n < NAME - 1; p++)
        name[n++] = bough_import_letter(*p);
    name[n] = '\0';
}

static void put_polar(bough_openfast *o, const bough_deck *deck, const char *name) {
    int column[4] = {bough_deck_whole(o->aero, "InCol_Alfa", 1, MOST_COLUMNS),
                     bough_deck_whole(o->aero, "InCol_Cl", 1, MOST_COLUMNS),
                     bough_deck_whole(o->aero, "InCol_Cd", 1, MOST_COLUMNS),
                     bough_deck_whole(o->aero, "InCol_Cm", 0, MOST_COLUMNS)};
    int n = bough_deck_whole(deck, "NumAlf", 2, MOST_ROWS), width = 0;
    int first = bough_deck_line(deck, "NumAlf"), line = first + 1;
    for (int k = 0; k < 4; k++)
        width = column[k] > width ? column[k] : width;
    FILE *file = o->draft.file[BOUGH_IMPORT_POLARS];
    fprintf(file, "  - name: %s\n    table:\n      columns: [alpha deg, cl, cd, cm]\n      rows:\n",
            name);
    double row[MOST_COLUMNS] = {0}, last = 0;
    for (int i = 0; i < n && bough_is_ok(o->draft.status); i++) {
        bough_deck_numbers(deck, &line, "a row of the polar", width, row);
        double value[4];
        for (int k = 0; k < 4; k++)
            value[k] = column[k] > 0 ? row[column[k] - 1] : 0;
        bool good = i == 0 ? value[0] == -180 : value[0] > last;
        if (!good || (i == n - 1 && value[0] != 180)) {
            bough_deck_fail(deck, line - 1,
                            "alpha: expected angles that grow from -180 to 180 deg, "
                            "got %g",
                            value[0]);
        }
        last = value[0];
        fputs("        - ", file);
        bough_import_list(file, value, 4);
        fputc('\n', file);
    }
    if (bough_deck_whole_or(deck, "NumTabs", 1) > 1) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                         "%s: the first of its tables, whatever the "
                         "Reynolds number",
                         name);
    }
}

static int put_polars(bough_openfast *o, char (*name)[NAME]) {
    int n = bough_deck_whole(o->aero, "NumAFfiles", 1, MOST_AIRFOILS);
    int line = bough_deck_line(o->aero, "AFNames");
    if (line < 0) bough_deck_fail(o->aero, -1, "no 'AFNames': expected a line '\"file\"  AFNames'");
    fputs("polars:\n", o->draft.file[BOUGH_IMPORT_POLARS]);
    for (int i = 0; i < n && bough_is_ok(o->draft.status); i++) {
        const char *path = bough_deck_file_at(o->aero, line + i);
        bough_deck *deck = bough_deck_open(o->draft.arena, path, o->draft.status);
        if (!deck) return 0;
        airfoil_name(path, i + 1, name[i]);
        put_polar(o, deck, name[i]);
    }
    bough_draft_note(&o->draft, BOUGH_TAKEN, "%d airfoils: lift, drag, moment", n);
    return n;
}

// -- blade elements -------------------------------------------------------------------------------

enum { SPAN, CURVE, SWEEP, CURVE_ANGLE, TWIST, CHORD, AIRFOIL, N_COLUMN };

static void put_elements(bough_openfast *o, const bough_deck *deck, char (*name)[NAME],
                         int n_name) {
    const char *const column[] = {"BlSpn",   "BlCrvAC", "BlSwpAC", "BlCrvAng",
                                  "BlTwist", "BlChord", "BlAFID"};
    int n = bough_deck_whole(deck, "NumBlNds", 2, MOST_ROWS);
    const double *row = bough_deck_table(deck, column, N_COLUMN, n);
    FILE *file = o->draft.file[BOUGH_IMPORT_AERO];
    fputs("stations:\n  columns: [span, ac_x, ac_y, twist deg, chord, polar]\n  rows:\n", file);
    double angle = 0;
    for (int i = 0; row && i < n; i++, row += N_COLUMN) {
        int id = (int)row[AIRFOIL];
        if (id < 1 || id > n_name || id != row[AIRFOIL]) {
            bough_deck_fail(deck, bough_deck_line(deck, "NumBlNds"),
                            "BlAFID: row %d: expected an airfoil from 1 to %d, got %g", i + 1,
                            n_name, row[AIRFOIL]);
            return;
        }
        angle = fmax(angle, fabs(row[CURVE_ANGLE]));
        fprintf(file, "    - [%.10g, %.10g, %.10g, %.10g, %.10g, %s]\n", row[SPAN], row[CURVE],
                row[SWEEP], row[TWIST], row[CHORD], name[id - 1]);
    }
    bough_draft_note(&o->draft, BOUGH_TAKEN, "%d blade elements", n);
    if (angle > 0) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT,
                         "BlCrvAng, up to %g deg: elements stand across the "
                         "structure's axis",
                         angle);
    }
}

void bough_openfast_aero_tables(bough_openfast *o) {
    if (!o->aero || !bough_is_ok(o->draft.status)) return;
    char(*name)[NAME] = bough_arena_take(o->draft.arena, MOST_AIRFOILS * sizeof *name);
    if (!name) *o->draft.status = bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    int n = name ? put_polars(o, name) : 0;
    bough_deck *deck = bough_openfast_open(o, o->aero, "ADBlFile(1)|ADBlFile1");
    if (bough_is_ok(o->draft.status)) put_elements(o, deck, name, n);
}

// -- wind -----------------------------------------------------------------------------------------

// A wind file stays where it is.
static void put_wind_file(bough_openfast *o, const char *kind, const char *names) {
    const char *path = bough_deck_file(o->inflow, names);
    fprintf(o->draft.file[BOUGH_IMPORT_SCENE], "  wind: {kind: %s, file: ", kind);
    bough_import_path(o->draft.file[BOUGH_IMPORT_SCENE], path);
    bough_draft_note(&o->draft, BOUGH_TAKEN, "wind of %s, by its path", path);
}

static void put_steady(bough_openfast *o, double up) {
    double speed = bough_deck_number(o->inflow, "HWindSpeed");
    double power = bough_deck_number_or(o->inflow, "PLExp|PLexp", 0);
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    fprintf(file, "  wind: {kind: %s, speed: %.10g m/s", power > 0 ? "power" : "uniform",
            speed * cos(up));
    if (power > 0) {
        fprintf(file, ", exponent: %.10g, reference_height: %.10g m", power,
                bough_deck_number(o->inflow, "RefHt"));
    }
    if (up != 0) fprintf(file, ", vertical: %.10g m/s", speed * sin(up));
    bough_draft_note(&o->draft, BOUGH_TAKEN, "steady wind of %g m/s", speed);
}

static void put_wind(bough_openfast *o) {
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    if (!o->inflow) {
        fputs("  wind: {kind: uniform, speed: 0 m/s}\n", file);
        return;
    }
    double radian = acos(-1.0) / 180;
    double to = bough_deck_number_or(o->inflow, "PropagationDir|PropogationDir", 0);
    double up = bough_deck_number_or(o->inflow, "VFlowAng", 0) * radian;
    switch (bough_deck_whole(o->inflow, "WindType", 1, 7)) {
    case 1: put_steady(o, up); break;
    case 2:
        put_wind_file(o, "wnd", "Filename_Uni|FileName_Uni|Filename");
        fprintf(file, ", reference_height: %.10g m, reference_length: %.10g m",
                bough_deck_number(o->inflow, "RefHt_Uni"),
                bough_deck_number(o->inflow, "RefLength"));
        break;
    case 3: put_wind_file(o, "bts", "FileName_BTS|Filename_BTS"); break;
    default:
        bough_deck_fail(o->inflow, bough_deck_line(o->inflow, "WindType"),
                        "WindType: expected 1 (steady), 2 (uniform) or 3 (TurbSim): others cannot "
                        "be read");
    }
    if (to != 0) fprintf(file, ", direction: %.10g deg", -to);
    fputs("}\n", file);
}

// -- theory ---------------------------------------------------------------------------------------

static const char *truth(bool flag) { return flag ? "true" : "false"; }

static void put_induction(bough_openfast *o) {
    const bough_deck *a = o->aero;
    int wake = bough_deck_whole_or(a, "WakeMod|Wake_Mod", 1);
    int dynamic = bough_deck_whole_or(a, "DBEMT_Mod", 2);
    int skew = bough_deck_whole_or(a, "SkewMod|Skew_Mod", 1);
    bool new_skew = bough_deck_line(a, "Skew_Mod") >= 0;
    bool oye = wake == 2 || (wake == 1 && bough_deck_line(a, "Wake_Mod") >= 0 && dynamic > 0);
    bool pitt =
        new_skew ? skew == 1 && bough_deck_whole_or(a, "SkewRedistr_Mod", 1) != 0 : skew == 2;
    int balance = bough_deck_whole_or(a, "BEM_Mod", 0);
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    fprintf(file,
            "  induction: {tip_loss: %s, hub_loss: %s, tangential: %s, drag: %s, skew: %s, "
            "high_thrust: %s",
            truth(bough_deck_flag_or(a, "TipLoss", true)),
            truth(bough_deck_flag_or(a, "HubLoss", true)),
            truth(bough_deck_flag_or(a, "TanInd", true)),
            truth(bough_deck_flag_or(a, "AIDrag", true)), pitt ? "pitt-peters" : "none",
            balance == 1 ? "buhl" : "smooth");
    bool momentum = bough_deck_flag_or(a, "SkewMomCorr", false);
    if (momentum && balance != 1) fputs(", skewed_momentum: true", file);
    if (oye) fputs(", inflow: oye", file);
    if (oye && dynamic != 2) {
        fprintf(file, ", inflow_time: %.10g s", bough_deck_number(a, "tau1_const"));
    }
    fputs("}\n", file);
    if (momentum && balance == 1) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "AeroDyn's SkewMomCorr: of BEM_Mod 2 only");
    }
    if (bough_deck_flag_or(a, "AIDrag", true) != bough_deck_flag_or(a, "TIDrag", true)) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                         "TIDrag: drag in the tangential induction as "
                         "AIDrag has it in the axial one");
    }
    if (balance == 1) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                         "BEM_Mod 1: Buhl's high thrust as there, the momentum balance else that of "
                         "BEM_Mod 2");
    } else if (balance == 0) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                         "no BEM_Mod: high thrust by a smooth parabola, where AeroDyn before "
                         "version 4 has Buhl's");
    }
    if (wake == 0)
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED, "WakeMod 0: induction is computed");
    if (wake == 3) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                         "OLAF: blade element momentum theory instead");
    }
    if (oye) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                         "DBEMT_Mod %d: Oye's dynamic inflow, each element "
                         "by itself",
                         dynamic);
    }
}

static void put_stall(bough_openfast *o) {
    const bough_deck *a = o->aero;
    bool newer = bough_deck_line(a, "UA_Mod") >= 0;
    int model = bough_deck_whole_or(a, "UAMod|UA_Mod", 0);
    bool on = newer ? model > 0 : bough_deck_whole_or(a, "AFAeroMod", 1) == 2;
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    if (on) fputs("  dynamic_stall: hgm\n", file);
    if (on && model != 4) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                         "UAMod %d: dynamic stall by Hansen, Gaunaa and "
                         "Madsen's model (4), its constants from the polars",
                         model);
    }
    if (on && bough_deck_number_or(a, "UAStartRad", 0) > 0) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT,
                         "UAStartRad: dynamic stall acts on all elements");
    }
    if (!bough_deck_flag_or(a, "UseBlCm", true)) fputs("  pitching_moment: false\n", file);
}

static void put_column(FILE *file, const char *key, const double *row, int column, int n) {
    fprintf(file, "    %s: [", key);
    for (int i = 0; i < n; i++)
        fprintf(file, "%s%.10g", i > 0 ? ", " : "", row[3 * i + column]);
    fputs("]\n", file);
}

static void put_tower(bough_openfast *o) {
    const bough_deck *a = o->aero;
    const char *const column[] = {"TwrElev", "TwrDiam", "TwrCd"};
    int potential = bough_deck_whole_or(a, "TwrPotent", 0);
    int shadow = bough_deck_whole_or(a, "TwrShadow", 0);
    bool drag = bough_deck_flag_or(a, "TwrAero", false) && !o->rigid_tower;
    if (potential == 0 && shadow == 0 && !drag) return;
    int n = bough_deck_whole(a, "NumTwrNds", 1, MOST_ROWS);
    const double *row = bough_deck_table(a, column, 3, n);
    if (!row) return;
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    fprintf(file, "  tower:\n    influence: %s\n", potential == 2 ? "bak" : "potential");
    if (shadow > 0) fputs("    shadow: powles\n", file);
    if (drag) fputs("    body: tower\n", file);
    put_column(file, "height", row, 0, n);
    put_column(file, "diameter", row, 1, n);
    put_column(file, "drag", row, 2, n);
    bough_draft_note(&o->draft, BOUGH_TAKEN, "the tower's influence on the wind%s",
                     drag ? " and its drag" : "");
    if (potential == 0) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                         "TwrPotent 0: potential flow about the tower "
                         "nevertheless, with its shadow or drag");
    }
    if (shadow == 2) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED, "TwrShadow 2: Powles' shadow, not Eames'");
    }
}

void bough_openfast_aero(bough_openfast *o) {
    const bough_deck *a = o->aero;
    if (!a || !bough_is_ok(o->draft.status)) return;
    double density = bough_deck_number_or(o->main, "AirDens", 1.225);
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    fprintf(file, "aero:\n  rate: 50 Hz\n  air_density: %.10g\n",
            bough_deck_number_or(a, "AirDens", density));
    put_wind(o);
    fprintf(file, "  blade: %s\n  polars: %s\n  hub_radius: %.10g m\n",
            bough_import_name[BOUGH_IMPORT_AERO], bough_import_name[BOUGH_IMPORT_POLARS],
            o->hub_radius);
    put_induction(o);
    put_stall(o);
    put_tower(o);
    static const char *const left[] = {"CavitCheck",  "Buoyancy",    "CompAA", "TFinAero",
                                       "NacelleDrag", "SectAvg"};
    for (size_t i = 0; i < sizeof left / sizeof *left; i++) {
        if (bough_deck_flag_or(a, left[i], false)) {
            bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "AeroDyn's %s", left[i]);
        }
    }
}
