// InflowWind: the wind of the scene; a steady wind where its file is missing.
#include "apps/bough/import/openfast.h"
#include "apps/bough/import/wind.h"

enum { STEADY = 1, UNIFORM, TURBSIM, BLADED, HAWC, NATIVE_BLADED = 7 };

// -- which file -----------------------------------------------------------------------------------

// The section of a type: before version 3.1 sections share the names of their lines.
static bough_deck section_of(const bough_deck *w, int type) {
    static const char *const title[] = {[UNIFORM] = "Parameters for Uniform",
                                        [TURBSIM] = "Parameters for Binary Turb",
                                        [BLADED] = "Parameters for Binary Bladed",
                                        [HAWC] = "Parameters for HAWC"};
    return bough_deck_part(w, title[type]);
}

// The line that names the file of a type; -1: none.
static int file_line(const bough_deck *w, int type) {
    static const char *const name[] = {[UNIFORM] = "FileName_Uni|Filename",
                                       [TURBSIM] = "FileName_BTS|Filename",
                                       [BLADED] = "FileNameRoot|FilenameRoot",
                                       [HAWC] = "FileName_u"};
    bough_deck section = section_of(w, type);
    return bough_deck_line(&section, name[type]);
}

// -- what is written ------------------------------------------------------------------------------

static double rotor_diameter(const bough_openfast *o) { return 2 * (o->hub_radius + o->blade_length); }

static double hub_height(const bough_openfast *o) {
    return o->tower_top + bough_deck_number_or(o->elasto, "Twr2Shft", 0);
}

// The number of a name above zero, else the fallback.
static double positive(const bough_deck *w, const char *names, double fallback) {
    double value = w ? bough_deck_number_or(w, names, fallback) : fallback;
    return value > 0 ? value : fallback;
}

static void put_steady(bough_openfast *o, double speed) {
    double power = o->inflow ? bough_deck_number_or(o->inflow, "PLExp|PLexp", 0) : 0;
    bough_put(o, "  wind: {kind: %s, speed: %.10g m/s", power > 0 ? "power" : "uniform", speed);
    if (power > 0) {
        bough_put(o, ", exponent: %.10g, reference_height: %.10g m", power,
                  positive(o->inflow, "RefHt", hub_height(o)));
    }
}

// A steady wind in place of one that cannot be read, with a comment in the scene and a note.
static void put_substitute(bough_openfast *o, const char *why) {
    const double usual = 8; // [m/s]
    double speed = positive(o->inflow, "HWindSpeed", positive(o->inflow, "URef", usual));
    bough_put(o, "  # This scene lacks its wind, to be given to the import by --wind FILE:\n  # %s\n", why);
    put_steady(o, speed);
    bough_other_case(o,
                     "its wind, to be given to the import by --wind FILE (%s): steady wind of %g m/s instead",
                     why, speed);
}

// -- files ----------------------------------------------------------------------------------------

static bough_status read_hawc(bough_openfast *o, bough_wind_box *box) {
    static const char *const names[] = {"FileName_u", "FileName_v", "FileName_w"};
    static const char *const factor[] = {"SFx", "SFy", "SFz"};
    static const char *const sigma[] = {"SigmaFx", "SigmaFy", "SigmaFz"};
    bough_deck section = section_of(o->inflow, HAWC), *w = &section;
    bough_hawc_def d = {.nx = bough_deck_whole(w, "nx", 2, 1 << 24),
                        .ny = bough_deck_whole(w, "ny", 2, 4096),
                        .nz = bough_deck_whole(w, "nz", 2, 4096),
                        .dx = bough_deck_number(w, "dx"),
                        .dy = bough_deck_number(w, "dy"),
                        .dz = bough_deck_number(w, "dz"),
                        .height = bough_deck_number(w, "RefHt_Hawc|RefHt"),
                        .mean = bough_deck_number(w, "URef"),
                        .profile = bough_deck_whole_or(w, "WindProfile", 0),
                        .exponent = bough_deck_number_or(w, "PLExp_Hawc|PLExp", 0),
                        .roughness = bough_deck_number_or(w, "Z0", 0),
                        .scaling = bough_deck_whole_or(w, "ScaleMethod", 0)};
    for (int c = 0; c < 3; c++) {
        d.file[c] = bough_deck_path(w, names[c]);
        d.factor[c] = bough_deck_number_or(w, factor[c], 1);
        d.sigma[c] = bough_deck_number_or(w, sigma[c], 1);
    }
    if (!bough_is_ok(o->draft->status)) return bough_ok();
    return bough_wind_hawc_read(o->draft->arena, &d, box);
}

// A file that cannot be read is replaced by a steady wind, unless the user gave it.
static void take_status(bough_openfast *o, bough_status status) {
    if (bough_is_ok(&status) || !bough_is_ok(o->draft->status)) return;
    if (status.code == BOUGH_INVALID && !o->draft->options->wind) {
        put_substitute(o, status.message);
    } else {
        *o->draft->status = status;
    }
}

static void put_file(bough_openfast *o, bough_wind_form form, const char *path) {
    bough_deck uniform = {0};
    if (o->inflow) uniform = section_of(o->inflow, UNIFORM);
    const bough_deck *w = o->inflow ? &uniform : NULL;
    take_status(o, bough_wind_given(o->draft, form, path, positive(w, "RefHt_Uni|RefHt", hub_height(o)),
                                    positive(w, "RefLength", rotor_diameter(o))));
}

static void put_hawc(bough_openfast *o, const char *path) {
    bough_wind_box *box = bough_arena_take(o->draft->arena, sizeof *box);
    bough_status status = read_hawc(o, box);
    if (bough_is_ok(&status) && bough_is_ok(o->draft->status)) bough_wind_made(o->draft, box, path);
    take_status(o, status);
}

// Fails where a length that a type needs is not positive.
static void check_lengths(const bough_deck *w, int type) {
    static const char *const name[][2] = {[STEADY] = {"RefHt"}, [UNIFORM] = {"RefHt_Uni|RefHt", "RefLength"}};
    bough_deck section = type == UNIFORM ? section_of(w, type) : *w;
    for (int k = 0; k < 2 && type <= UNIFORM && name[type][k]; k++) {
        double length = bough_deck_number_or(&section, name[type][k], 1);
        if (!(length > 0))
            bough_deck_refuse(&section, name[type][k], "expected a length above 0 m, got %g", length);
    }
}

// What the scene's boxes of wind do not have.
static void leave_rest(bough_openfast *o, int type) {
    static const bough_openfast_rest rest[] = {
        {"the lidar", 0, {"SensorType"}},
        {"the wind is linear between its times", 0, {"VelInterpCubic"}},
        {"the points below the grid", 0, {"TowerFile"}},
        {"the run starts at the beginning of the box", 0, {"XOffset"}},
    };
    bough_openfast_leave(o, o->inflow, rest, type == STEADY ? 1 : 2, BOUGH_LEFT_OUT);
    if (type == BLADED || type == HAWC)
        bough_openfast_leave(o, o->inflow, rest + (type == HAWC ? 3 : 2), 1, BOUGH_LEFT_OUT);
}

static void put_type(bough_openfast *o, int type) {
    if (!bough_is_ok(o->draft->status)) return; // no such type
    check_lengths(o->inflow, type);
    leave_rest(o, type);
    if (type == STEADY) {
        double speed = bough_deck_number(o->inflow, "HWindSpeed");
        put_steady(o, speed);
        bough_taken(o, "steady wind of %g m/s", speed);
        return;
    }
    if (type == NATIVE_BLADED || type == 6) {
        put_substitute(o, type == 6 ? "WindType 6, the user's own routine"
                                    : "WindType 7, Bladed's native files");
        return;
    }
    int line = file_line(o->inflow, type);
    if (line < 0) {
        bough_deck_fail(o->inflow, bough_deck_line(o->inflow, "WindType"),
                        "WindType %d: expected a line with the name of its file", type);
        return;
    }
    static const bough_wind_form form[] = {
        [UNIFORM] = BOUGH_WIND_UNIFORM_FILE, [TURBSIM] = BOUGH_WIND_TURBSIM, [BLADED] = BOUGH_WIND_BLADED};
    const char *path = bough_deck_path_at(o->inflow, line);
    if (!bough_is_ok(o->draft->status)) return;
    if (type == HAWC)
        put_hawc(o, path);
    else
        put_file(o, form[type], path);
}

void bough_openfast_wind(bough_openfast *o) {
    const char *given = o->draft->options->wind;
    double to = 0, up = 0;
    if (o->inflow) {
        to = bough_deck_number_or(o->inflow, "PropagationDir|PropogationDir", 0);
        up = bough_deck_number_or(o->inflow, "VFlowAng", 0);
    }
    if (given) {
        put_file(o, bough_wind_form_of(given), given);
    } else if (o->inflow) {
        put_type(o, bough_deck_whole(o->inflow, "WindType", 1, 7));
    } else if (bough_deck_whole_or(o->main, "CompInflow", 0) == 0) {
        bough_put(o, "  wind: {kind: uniform, speed: 0 m/s");
        bough_approximated(o, "without InflowWind the air is still");
    } else {
        put_substitute(o, "CompInflow 2, the wind of another program");
    }
    if (to != 0) bough_put(o, ", direction: %.10g deg", -to);
    if (up != 0) bough_put(o, ", upflow: %.10g deg", up);
    bough_put(o, "}\n");
}
