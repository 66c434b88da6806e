// Hub, nacelle and their bearings; wind; the generator's torque.
#include "aero/control/discon.h"
#include "apps/bough/import/wind.h"
#include "apps/bough/import/windio.h"

// A rigid body's mass properties in the axes of its frame.
typedef struct lump {
    double mass;       // [kg]
    double centre[3];  // [m]
    double inertia[6]; // xx, yy, zz, xy, xz, yz of the matrix about the centre of mass [kg m2]
} lump;

// -- masses ---------------------------------------------------------------------------------------

// Adds the inertia of a mass at c about the origin.
static void add_offset(double inertia[6], double mass, const double c[3]) {
    double square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
    for (int i = 0; i < 3; i++) inertia[i] += mass * (square - c[i] * c[i]);
    inertia[3] -= mass * c[0] * c[1];
    inertia[4] -= mass * c[0] * c[2];
    inertia[5] -= mass * c[1] * c[2];
}

// Moves an inertia from the frame's origin to the centre of mass, unless it is too small to be about the
// origin.
static void move_to_centre(lump *l) {
    double moved[6];
    memcpy(moved, l->inertia, sizeof moved);
    add_offset(moved, -l->mass, l->centre);
    if (moved[0] > 0 && moved[1] > 0 && moved[2] > 0) memcpy(l->inertia, moved, sizeof moved);
}

// Three or six numbers.
static void read_inertia(bough_windio *w, const bough_node *from, const char *path, double to[6]) {
    const bough_node *node = bough_entry(from, path);
    int n = node && node->n == 3 ? 3 : 6;
    const double *row = node ? bough_entry_numbers(w->draft, node, "", &n) : NULL;
    for (int i = 0; i < 6; i++) to[i] = row && i < n ? row[i] : 0;
}

// Version 1: elastic_properties_mb {system_mass, system_inertia, system_center_mass}; version 2:
// elastic_properties {mass, inertia, location}. False: there are none.
static bool read_lump(bough_windio *w, const bough_node *part, lump *l) {
    bough_draft *d = w->draft;
    const bough_node *from = bough_entry(part, "elastic_properties_mb|elastic_properties");
    if (!bough_entry(from, "system_mass|mass")) return false;
    *l = (lump){.mass = bough_entry_number(d, from, "system_mass|mass")};
    const bough_node *centre = bough_entry(from, "system_center_mass|center_mass|location");
    int n = 3;
    const double *at = centre ? bough_entry_numbers(d, centre, "", &n) : NULL;
    if (at) memcpy(l->centre, at, sizeof l->centre);
    read_inertia(w, from, "system_inertia|inertia", l->inertia);
    if (l->mass < 0) bough_entry_fail(d, from, "mass: expected a value that is not negative");
    if (!bough_scene_semidefinite(l->inertia)) {
        bough_entry_fail(
            d, bough_entry(from, "system_inertia|inertia"),
            "inertia: expected xx, yy, zz, xy, xz, yz of a matrix that is not negative about any axis");
    }
    return true;
}

// The yaw bearing's mass sits at the tower's top.
static void add_yaw(bough_windio *w, lump *l) {
    double mass = bough_entry_number_or(w->draft, w->train, "elastic_properties_mb.yaw_mass", 0);
    mass = bough_entry_number_or(w->draft, w->parts, "yaw.elastic_properties.mass", mass);
    double sum = l->mass + mass;
    if (!(mass > 0)) return;
    add_offset(l->inertia, l->mass * mass / sum, l->centre);
    for (int i = 0; i < 3; i++) l->centre[i] *= l->mass / sum;
    l->mass = sum;
}

// The user's mass of a part for which the file has none.
static double given_mass(bough_windio *w, const bough_node *part, const char *name, double given) {
    if (!(given > 0)) {
        bough_entry_fail(w->draft, part,
                         "expected the mass of the %s, 'elastic_properties.mass'; --%s-mass KG gives it",
                         name, name);
    }
    return given;
}

// The file's mass takes precedence over the user's.
static void leave_given(bough_windio *w, const char *name, double given) {
    if (!(given > 0)) return;
    bough_left_out(w, "--%s-mass: the file has the mass of the %s", name, name);
}

static lump hub_lump(bough_windio *w) {
    lump l;
    if (read_lump(w, w->hub, &l)) {
        leave_given(w, "hub", w->draft->options->hub_mass);
        return l;
    }
    double mass = given_mass(w, w->hub, "hub", w->draft->options->hub_mass);
    double inertia = 2.0 / 3 * mass * w->hub_radius * w->hub_radius;
    bough_approximated(w, "hub: its inertia is that of a shell of its radius");
    return (lump){mass, {0}, {inertia, inertia, inertia}};
}

// The rotor-nacelle assembly without hub and blades.
static bool assembly_lump(bough_windio *w, double overhang, double hub, lump *l) {
    const bough_node *part = bough_entry(w->parts, "RNA|rna");
    lump all;
    if (!part || !read_lump(w, part, &all)) return false;
    double head = hub + w->n_blade * w->blade_mass, mass = all.mass - head;
    if (!(mass > 0)) {
        bough_entry_fail(w->draft, part, "mass: %g kg, which is less than the mass of hub and blades, %g kg",
                         all.mass, head);
        return false;
    }
    double inertia = mass * overhang * overhang / 4;
    const double at[] = {-w->forward * overhang, 0, w->hub_height};
    *l = (lump){.mass = mass, .inertia = {inertia, inertia, inertia}};
    for (int i = 0; i < 3; i++) l->centre[i] = (all.mass * all.centre[i] - head * at[i]) / mass;
    bough_approximated(w, "nacelle: mass and centre of RNA without hub and blades, its radius of gyration "
                          "half the overhang");
    return true;
}

// The file's mass of the nacelle; false: there is none.
static bool read_nacelle(bough_windio *w, double overhang, double hub, lump *l) {
    bool own = bough_entry(w->train, "elastic_properties_mb|elastic_properties.system_mass|mass");
    if (!own && assembly_lump(w, overhang, hub, l)) return true;
    if (!read_lump(w, w->train, l)) return false;
    if (w->second && !bough_entry(w->train, "elastic_properties.inertia_tt")) move_to_centre(l);
    add_yaw(w, l);
    return true;
}

static lump nacelle_lump(bough_windio *w, double overhang, double hub) {
    lump l;
    if (read_nacelle(w, overhang, hub, &l)) {
        leave_given(w, "nacelle", w->draft->options->nacelle_mass);
        return l;
    }
    double mass = given_mass(w, w->train, "nacelle", w->draft->options->nacelle_mass);
    double inertia = mass * overhang * overhang / 4;
    bough_approximated(w, "nacelle: its centre of mass is at half the hub's height above the tower, its "
                          "radius of gyration half the overhang");
    l = (lump){mass, {0, 0, w->hub_height / 2}, {inertia, inertia, inertia}};
    add_yaw(w, &l);
    return l;
}

static double generator_inertia(bough_windio *w, double ratio) {
    double inertia[6];
    read_inertia(w, w->train, "generator.elastic_properties.inertia", inertia);
    if (inertia[0] == 0) {
        bough_left_out(w, "inertia of the generator: not given");
    }
    return inertia[0] * ratio * ratio;
}

// -- bodies ---------------------------------------------------------------------------------------

static void put_lump(bough_windio *w, const lump *l) {
    FILE *file = w->draft->file[BOUGH_IMPORT_SCENE];
    fprintf(file, "    mass: %.10g kg\n    centre_of_mass: ", l->mass);
    bough_import_list(file, l->centre, 3);
    fputs("\n    inertia: ", file);
    bough_import_list(file, l->inertia, 6);
    fputc('\n', file);
}

static void put_nacelle(bough_windio *w, bool on_rod, const lump *l) {
    bough_put(w, "  - name: nacelle\n    fidelity: rigid\n    joint: {kind: fixed, parent: %s",
              on_rod ? "tower" : "ground");
    if (!on_rod) bough_put(w, ", placement: [move z %.10g m]", w->tower_top);
    bough_put(w, "}\n");
    put_lump(w, l);
}

// The hub, fixed to the generator, which is a body of its own if its inertia is given; the body on the
// rotor's joint.
static const char *put_hub(bough_windio *w, const lump *l, double overhang, double tilt, double ratio) {
    double generator = generator_inertia(w, ratio);
    const char *first = generator > 0 ? "generator" : "hub";
    w->inertia += l->inertia[0] + generator;
    bough_put(w,
              "  - name: %s\n    fidelity: rigid\n    joint:\n      kind: revolute\n"
              "      parent: nacelle\n      placement: [move z %.10g m, move x %.10g m, "
              "rotate y %.10g deg]\n      axis: x\n      speed: %.10g rad/s\n",
              first, w->hub_height, -w->forward * overhang, w->forward * tilt, w->speed);
    if (generator > 0) {
        bough_put(w,
                  "    inertia: [%.10g, 0, 0] # on the slow shaft\n"
                  "  - name: hub\n    fidelity: rigid\n    joint: {kind: fixed, parent: generator}\n",
                  generator);
    }
    put_lump(w, l);
    return first;
}

static void put_blades(bough_windio *w, const char *rotor, double cone, double pitch) {
    bool steered = w->rated_power > 0 || w->draft->options->controller;
    for (int k = 1; k <= w->n_blade; k++) {
        bough_put(w,
                  "  - name: blade%d\n    fidelity: rod\n    joint: {%s, parent: hub, "
                  "placement: [rotate x %.10g deg, rotate y %.10g deg, move z %.10g m]}\n"
                  "    pitch: %.10g deg\n",
                  k, steered ? "kind: revolute, axis: z, motion: {angle: 0 deg}" : "kind: fixed",
                  360.0 * (k - 1) / w->n_blade, -w->forward * cone, w->hub_radius, pitch);
        bough_draft_blade_rod(w->draft);
    }
    bough_draft_turbine(w->draft, rotor, w->n_blade);
}

static double gear_ratio(bough_windio *w) {
    const char *path = w->second ? "gearbox.gear_ratio" : "gear_ratio";
    double ratio = bough_entry_number_or(w->draft, w->train, path, 1);
    if (!(ratio > 0)) bough_entry_fail(w->draft, w->train, "gear_ratio: expected a positive value");
    return ratio;
}

void bough_windio_bodies(bough_windio *w) {
    bough_draft *d = w->draft;
    if (!bough_is_ok(d->status)) return;
    const bough_node *from = w->second ? bough_entry_need(d, w->train, "outer_shape") : w->train;
    double overhang = bough_entry_number(d, from, "overhang");
    double tilt = bough_entry_number_or(d, from, "uptilt", 0) * w->degree;
    double cone = bough_entry_number_or(d, w->hub, "cone_angle", 0) * w->degree;
    double pitch = bough_windio_control(w, "pitch.min_pitch", "fine_pitch|min_pitch_limit", BOUGH_DEGREE, 0);
    double above = bough_entry_number_or(d, w->root, "assembly.hub_height", NAN) - w->tower_top;
    w->hub_height = w->tower && above > 0 ? bough_entry_number_or(d, from, "distance_tt_hub", above)
                                          : bough_entry_number(d, from, "distance_tt_hub");
    fflush(d->file[BOUGH_IMPORT_TOWER]);
    bool rod = d->size[BOUGH_IMPORT_TOWER] > 0;
    if (!w->tower) w->tower_top -= w->hub_height;
    bough_put(w, "bodies:\n");
    if (rod) bough_draft_tower(d, w->tower_base); // a rigid one is only a place
    lump hub = hub_lump(w), nacelle = nacelle_lump(w, overhang, hub.mass);
    put_nacelle(w, rod, &nacelle);
    const char *rotor = put_hub(w, &hub, overhang, tilt, gear_ratio(w));
    if (!bough_entry(w->train, w->second ? "gearbox.gear_ratio" : "gear_ratio"))
        bough_taken(w, "the file has no gear_ratio: 1 is taken");
    put_blades(w, rotor, cone, pitch / BOUGH_DEGREE);
    bough_taken(w, "hub radius %g m, cone %.4g deg, tilt %.4g deg, overhang %g m, pitch %.4g deg",
                w->hub_radius, cone, tilt, overhang, pitch / BOUGH_DEGREE);
    bough_left_out(w, "yaw bearing and drive train are rigid");
}

// -- air ------------------------------------------------------------------------------------------

static void put_wind(bough_windio *w) {
    bough_draft *d = w->draft;
    const char *given = w->draft->options->wind;
    double shear = bough_entry_number_or(d, w->root, "environment.shear_exp", 0);
    double height = w->tower_top + w->hub_height;
    if (given) {
        bough_status status = bough_wind_given(d, bough_wind_form_of(given), given, height, 2 * w->radius);
        if (bough_is_ok(d->status)) *d->status = status;
        return;
    }
    bough_put(w, "  wind: {kind: %s, speed: %.6g m/s", shear > 0 ? "power" : "uniform", w->wind);
    if (shear > 0) {
        bough_put(w, ", exponent: %.10g, reference_height: %.10g m", shear, height);
        bough_taken(w, "wind that grows with height^%g", shear);
    }
}

void bough_windio_air(bough_windio *w) {
    bough_draft *d = w->draft;
    if (!bough_is_ok(d->status)) return;
    bough_put(w, "aero:\n  rate: %.10g Hz\n  air_density: %.10g\n", 1 / d->macro_step, w->density);
    put_wind(w);
    bough_put(w,
              "}\n  ramp: [0 s, 2 s]\n  blade: %s\n  polars: %s\n  hub_radius: %.10g m\n"
              "  induction: {high_thrust: smooth, skew: pitt-peters}\n  dynamic_stall: hgm\n",
              bough_import_name[BOUGH_IMPORT_AERO], bough_import_name[BOUGH_IMPORT_POLARS], w->hub_radius);
    bough_approximated(w, "dynamic stall by Hansen, Gaunaa and Madsen's model, which also damps the blade's "
                          "torsion");
    bough_windio_tower_air(w);
}

// -- control --------------------------------------------------------------------------------------

// The limits of the pitch, whose law no file has.
static void put_pitch(bough_windio *w, double ratio) {
    double least = bough_windio_control(w, "pitch.min_pitch", "min_pitch_limit|fine_pitch", BOUGH_DEGREE, 0);
    double most = bough_windio_control(w, "pitch.max_pitch", "max_pitch_limit", BOUGH_DEGREE, BOUGH_PI / 2);
    double rate = bough_windio_control(w, "pitch.max_pitch_rate", "max_pitch_rate", BOUGH_DEGREE, 0.1);
    bough_put(w,
              "    reference_speed: %.10g rad/s\n    least_pitch: %.10g rad\n    most_pitch: %.10g rad\n"
              "    pitch_rate: %.10g rad/s\n",
              w->rated_speed * ratio, least, most, rate);
    bool gains = bough_entry(w->root, "control.pitch_kp") != NULL;
    bough_left_out(w,
                   "pitch control: %s, so the pitch is held, which is right below rated wind; "
                   "--controller FILE, or control.pitch: true with control.law.proportional, integral and "
                   "halving_pitch",
                   gains ? "the gains of the file, a table over the pitch, are not read"
                         : "the file has no gains");
    if (bough_entry(w->root, "control.min_pitch_table"))
        bough_left_out(w, "min_pitch_table: one least pitch at all wind speeds");
}

// The gain of the speed's square [N m s2/rad2], at most the one that gives rated power just below rated
// speed.
static double optimal_gain(bough_windio *w, double ratio, double most) {
    const bough_node *given = bough_entry(w->root, "control.region2_k");
    if (!given) return most;
    double gain = bough_entry_number(w->draft, given, "") / (BOUGH_RPM * BOUGH_RPM * ratio * ratio);
    if (!(gain > 0)) bough_entry_fail(w->draft, given, "region2_k: expected a value above 0");
    if (gain > most)
        bough_approximated(w, "region2_k: would exceed rated power below rated speed; %.3g of it",
                           most / gain);
    else
        bough_taken(w, "region2_k: the gain of the torque below rated speed");
    return fmin(gain, most);
}

static double efficiency_of(bough_windio *w) {
    const char *path = w->second ? "gearbox.efficiency" : "gearbox_efficiency";
    double efficiency = bough_entry_number_or(w->draft, w->train, path, 1);
    if (!(efficiency > 0 && efficiency <= 1)) {
        bough_entry_fail(w->draft, w->train, "efficiency: expected a value above 0 and at most 1");
    }
    return efficiency;
}

// The library that the user gives.
static void put_library(bough_windio *w) {
    bough_draft *d = w->draft;
    bough_discon *discon;
    bough_status status = bough_discon_open(d->arena, w->draft->options->controller, "", false, &discon);
    if (!bough_is_ok(&status)) {
        *d->status = bough_fail(status.code, "--controller: %.200s", status.message);
        return;
    }
    bough_draft_library(d, w->draft->options->controller, NULL, gear_ratio(w), efficiency_of(w));
    bough_taken(w, "controller: %s, by its path", w->draft->options->controller);
}

void bough_windio_law(bough_windio *w) {
    bough_draft *d = w->draft;
    if (!bough_is_ok(d->status)) return;
    if (w->draft->options->controller) {
        put_library(w);
        return;
    }
    if (!(w->rated_power > 0)) {
        bough_left_out(w, "no rated_power: no torque acts on the generator");
        return;
    }
    double ratio = gear_ratio(w);
    double efficiency = efficiency_of(w);
    double power = w->rated_power / efficiency, held = w->rated_speed * ratio;
    double rated = 0.99 * held; // so that torque and pitch do not compete
    double rate = bough_windio_control(w, "torque.max_torque_rate", "max_torque_rate", 1, 1e9);
    double gain = optimal_gain(w, ratio, 0.99 * power / (rated * rated * rated));
    bough_put(
        w,
        "control:\n  kind: variable-speed\n  rate: %.10g Hz\n  gear_ratio: %.10g\n"
        "  efficiency: %.10g\n  pitch: false\n  law:\n    cut_in: 0 rad/s\n    optimal_from: 1e-3 rad/s\n"
        "    optimal_gain: %.10g\n    rated_speed: %.10g rad/s\n    rated_power: %.10g\n"
        "    most_torque: %.10g\n    torque_rate: %.10g\n",
        1 / d->macro_step, ratio, efficiency, gain, rated, power, 1.1 * power / rated, rate);
    bough_taken(w, "rated power %g MW at %.4g rpm of the rotor", w->rated_power / 1e6,
                w->rated_speed / BOUGH_RPM);
    bough_approximated(
        w, "torque grows with the square of the speed to its rated value, then constant power; no "
           "loss in the generator");
    put_pitch(w, ratio);
}
