// Warnings: values that are valid but probably an error.
#include "apps/bough/scene/scene_internal.h"

#include "core/solve/integrator.h"
#include "cosim/scheme.h"

__attribute__((format(printf, 3, 4))) static void warn(const bough_node *at, FILE *stream, const char *format,
                                                       ...) {
    char place[300], text[600];
    BOUGH_PRINT(text, format);
    fprintf(stream, "%swarning: %s\n", bough_scene_place(at, place, sizeof place), text);
}

// -- bodies ---------------------------------------------------------------------------------------

// The inertia matrix is J = ∫(|r|² 1 − r rᵀ)dm, so that tr(J)/2 1 − J = ∫r rᵀdm is positive semidefinite: no
// principal moment exceeds the sum of the other two. Published data of thin bodies exceed it by up to a
// thousandth.
static bool has_distribution(const double v[6]) {
    double half = 0.505 * (v[0] + v[1] + v[2]);
    double spread[6] = {half - v[0], half - v[1], half - v[2], -v[3], -v[4], -v[5]};
    return bough_scene_semidefinite(spread);
}

// Whether the inertia is given about one axis only, as for plane mechanisms and shafts.
static bool is_about_one_axis(const double v[6]) { return (v[0] != 0) + (v[1] != 0) + (v[2] != 0) == 1; }

static void warn_inertia(const bough_scene_body *b, FILE *stream) {
    if (b->fidelity == BOUGH_SCENE_FMU) return; // its carrier takes the mass over
    const double *v = b->inertia;
    if (has_distribution(v) || is_about_one_axis(v)) return;
    warn(
        bough_node_find(b->node, "inertia"), stream,
        "body '%s': no mass distribution has the inertia [%g, %g, %g] about principal or other axes: none may "
        "exceed the sum of the other two. Right if it holds gears or a generator referred to this shaft",
        b->name, v[0], v[1], v[2]);
}

// -- loads ----------------------------------------------------------------------------------------

static bool is_vertex(const bough_scene_rod *rod, double span) {
    double length = bough_scene_arc_length(&rod->structure);
    for (int i = 0; i <= rod->n_segment; i++) {
        double vertex = length * bough_section_graded(rod->grading, (double)i / rod->n_segment);
        if (fabs(span - vertex) < 1e-9 * length) return true;
    }
    return false;
}

// The angle by which a couple bends a segment of mean length [rad].
static double bend_of_segment(const bough_scene_rod *rod, const bough_scene_load *couple) {
    const bough_section_station *root = &rod->structure.station[0].def;
    double stiffness = fmin(root->stiffness[15], root->stiffness[18]);
    double length = bough_scene_arc_length(&rod->structure) / rod->n_segment;
    return hypot(couple->wrench[3], couple->wrench[4]) * length / stiffness;
}

// A follower within a segment turns as the mean of its ends, which a couple at the same place turns
// differently.
static void warn_follower(const bough_scene *scene, const bough_scene_load *load, FILE *stream) {
    static const double small = 1e-3; // of the load, as an error of its direction [rad]
    bool force = load->wrench[0] != 0 || load->wrench[1] != 0 || load->wrench[2] != 0;
    if (load->frame != BOUGH_SCENE_LOAD_FOLLOWER || load->place != BOUGH_SCENE_AT_SPAN || !force) return;
    const bough_scene_body *b = &scene->body[load->body];
    double bend = 0;
    for (int k = 0; k < scene->n_load; k++) {
        const bough_scene_load *couple = &scene->load[k];
        if (couple->body_name == NULL || couple->body != load->body || couple->place != BOUGH_SCENE_AT_SPAN ||
            couple->span[0] != load->span[0])
            continue;
        bend += bend_of_segment(&b->rod, couple);
    }
    if (!(bend / 4 > small) || is_vertex(&b->rod, load->span[0])) return;
    warn(
        load->node, stream,
        "body '%s': the direction of this follower errs by about %.1g rad, because a couple acts at the same "
        "place within a segment, and no estimate contains it: put a vertex there (rod.part or rod.segments)",
        b->name, bend / 4);
}

// -- air and control ------------------------------------------------------------------------------

// A negative drag coefficient means swapped columns or a wrong sign.
static void warn_polars(const bough_scene_polars *polars, FILE *stream) {
    for (int i = 0; i < polars->n_polar; i++) {
        const bough_scene_polar *p = &polars->polar[i];
        int least = 0;
        for (int k = 1; k < p->n_row; k++) least = p->row[k].cd < p->row[least].cd ? k : least;
        if (p->row[least].cd >= 0) continue;
        warn(p->row[least].node, stream,
             "polar '%s': the drag coefficient is negative, %g at %g deg: the air would drive the section",
             p->name, p->row[least].cd, p->row[least].alpha / BOUGH_DEGREE);
    }
}

// Gear ratio of the turbine to which the defaults of the built-in law belong.
static const double ratio_of_defaults = 97;

static void warn_law(const bough_scene_control *control, FILE *stream) {
    static const char *const keys[] = {"cut_in",      "optimal_from", "optimal_gain",    "rated_speed",
                                       "rated_power", "most_torque",  "reference_speed", "proportional",
                                       "integral",    "halving_pitch"};
    enum { OF_TORQUE = 6, ALL = sizeof keys / sizeof *keys };
    const bough_node *law = bough_node_find(control->node, "law");
    char list[200] = "";
    if (control->kind != BOUGH_SCENE_VARIABLE_SPEED || control->gear_ratio == ratio_of_defaults) return;
    for (int i = 0; i < (control->pitch ? ALL : OF_TORQUE); i++) {
        if (law && bough_node_find(law, keys[i])) continue;
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", used == 0 ? "" : ", ", keys[i]);
    }
    if (list[0] == '\0') return;
    warn(law ? law : control->node, stream,
         "control.law: %s not given: the values of the NREL 5 MW turbine, whose gear ratio is %g, not %g",
         list, ratio_of_defaults, control->gear_ratio);
}

// -- settings that are not used -------------------------------------------------------------------

// Whether to warn about a setting that the choice does not use: not where the command line, or a file that
// builds on the setting's, replaces the choice alone, since the setting is given for the earlier choice.
static bool is_unused(const bough_node *given, const bough_node *choice) {
    bool replaced = choice && given && (choice->line == 0 || strcmp(choice->file, given->file) != 0);
    return given != NULL && !(given->line > 0 && replaced);
}

// Settings in `mapping` that only some values of another key use.
static const struct {
    const char *mapping, *keys, *choice;
    const char *usual,
        *users; // the value of the choice that is not given, the values with which they are used
} settings[] = {
    {"control.law",
     "corner|cut_in|optimal_from|optimal_gain|above_rated|rated_power|slip|most_torque|motoring|torque_rate|"
     "reference_speed|proportional|integral|halving_pitch|least_pitch|most_pitch",
     "control.kind", NULL, "variable-speed"},
    {"control.law",
     "power_pitch|reference_speed|proportional|integral|halving_pitch|least_pitch|most_pitch|pitch_rate",
     "control.pitch", "true", "true"},
    {"aero.wind", "start", "aero.wind.condition", NULL, "eog|edc|ecd|ews"},
    {"aero.wind", "sense", "aero.wind.condition", NULL, "edc|ecd|ews"},
    {"aero.wind", "shear", "aero.wind.condition", NULL, "ews"},
    {"aero.wind", "recurrence", "aero.wind.condition", NULL, "ewm|ewm-steady"},
    {"aero.wind", "seed|points|width|time_step|period", "aero.wind.condition", NULL, "ntm|etm|ewm"},
    {"aero.wind", "intensity|rotor_diameter", "aero.wind.condition", NULL, "ntm|etm|ewm|eog|edc|ews"},
    {"aero.wind", "class", "aero.wind.condition", NULL, "ntm|etm|ewm|ewm-steady|eog|edc|ews"},
    {"modes", "at|air|linear", "modes.of", "auto", "auto|scene"},
    {"simulation", "error_bound|error_shares", "simulation.error_estimate", "companion", "companion"},
};

static void warn_settings(const bough_scene *scene, FILE *stream) {
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        const char *keys = settings[i].keys, *users = settings[i].users;
        const bough_node *choice = bough_node_below(scene->node, settings[i].choice, NULL);
        const char *chosen = choice ? choice->text : settings[i].usual;
        if (chosen == NULL || bough_word_is_among(chosen, users, '|')) continue;
        for (size_t n; *keys != '\0'; keys += n + (keys[n] == '|')) {
            char path[64];
            n = strcspn(keys, "|");
            snprintf(path, sizeof path, "%s.%.*s", settings[i].mapping, (int)n, keys);
            const bough_node *given = bough_node_below(scene->node, path, NULL);
            if (!is_unused(given, choice)) continue;
            warn(given, stream, "%s: not used with '%s: %s', only with %s", path,
                 strrchr(settings[i].choice, '.') + 1, chosen, users);
        }
    }
}

// Settings that are used only if another is not zero, or one of several is given.
static void warn_companions(const bough_scene *scene, FILE *stream) {
    const bough_scene_tower *tower = &scene->aero.tower;
    const bough_scene_step_control *control = &scene->simulation.step_control;
    const bough_node *drag = bough_node_find(tower->node, "drag");
    const bough_node *least = bough_node_find(control->node, "min");
    bool has_drag = tower->def.influence == BOUGH_TOWER_BAK || tower->def.shadow != BOUGH_TOWER_SHADOW_NONE ||
                    tower->body_name != NULL;
    if (!has_drag && is_unused(drag, bough_node_find(tower->node, "influence")))
        warn(drag, stream,
             "aero.tower.drag: not used, only with 'influence: bak', 'shadow: powles' or a 'body'");
    if (least && !(control->tolerance > 0))
        warn(least, stream, "simulation.step_control.min: not used without a 'tolerance'");
    for (int k = 0; k < scene->n_connector[BOUGH_SCENE_SPRING]; k++) {
        const bough_scene_connector *spring = &scene->connector[BOUGH_SCENE_SPRING][k];
        const bough_node *length = bough_node_find(spring->node, "length");
        if (length && spring->spring.stiffness == 0)
            warn(length, stream, "springs[%d].length: not used without a 'stiffness'", k);
    }
}

static void warn_output(const bough_scene_simulation *s, FILE *stream) {
    static const char *const keys[] = {"interval", "from", "frames"};
    const bough_scene_output *output = &s->output;
    const double time[] = {output->interval, output->from, output->frames};
    for (int i = 0; i < 3; i++) {
        const bough_node *given = bough_node_find(output->node, keys[i]);
        if (!(time[i] > s->duration) || !is_unused(given, bough_node_find(s->node, "duration"))) continue;
        warn(given, stream, "simulation.output.%s: %g s is longer than the run, %g s", keys[i], time[i],
             s->duration);
    }
}

static void warn_scheme(const bough_scene_simulation *s, FILE *stream) {
    const bough_scheme *scheme = bough_scheme_at(s->coupling.scheme), *reader;
    const bough_scheme_key *key;
    for (int i = 0; (key = bough_scheme_key_at(i)) != NULL; i++) {
        const bough_node *given = bough_node_below(s->node, key->path, NULL);
        if (bough_scheme_reads(scheme, key->option)) continue;
        if (!is_unused(given, bough_node_below(s->node, "coupling.scheme", NULL))) continue;
        char readers[160] = "";
        for (int k = 0; (reader = bough_scheme_at(k)) != NULL; k++) {
            if (!bough_scheme_reads(reader, key->option)) continue;
            size_t used = strlen(readers);
            snprintf(readers + used, sizeof readers - used, "%s%s", used == 0 ? "" : ", ", reader->name);
        }
        warn(given, stream, "simulation.%s: not used with 'scheme: %s', only with %s", key->path,
             scheme->name, readers);
    }
}

static void warn_solver(const bough_scene_solver *s, const char *path, FILE *stream) {
    static const struct {
        const char *key;
        unsigned option;
    } keys[] = {{"step", BOUGH_METHOD_READS_STEP}, {"rho", BOUGH_METHOD_READS_RHO}};
    const bough_integrator_ops *method = bough_integrator_find((bough_integrator_kind)s->solver);
    for (int i = 0; i < 2; i++) {
        const bough_node *given = bough_node_find(s->node, keys[i].key);
        if (method->reads & keys[i].option || !is_unused(given, bough_node_find(s->node, "solver"))) continue;
        warn(given, stream, "%s.%s: not used with 'solver: %s'", path, keys[i].key, method->name);
    }
}

static void warn_micro(const bough_scene *scene, const bough_scene_body *b, FILE *stream) {
    const bough_scene_simulation *s = &scene->simulation;
    const bough_scheme *scheme = bough_scheme_at(s->coupling.scheme);
    char path[64];
    snprintf(path, sizeof path, "body '%.40s': micro", b->name);
    if (bough_scheme_reads(scheme, BOUGH_READS_MEMBERS)) {
        warn_solver(&b->micro, path, stream);
    } else if (is_unused(b->micro.node, bough_node_below(s->node, "coupling.scheme", NULL))) {
        warn(b->micro.node, stream, "%s: not used with 'scheme: %s'", path, scheme->name);
    }
}

// -- the whole ------------------------------------------------------------------------------------

void bough_scene_warn(const bough_scene *scene, FILE *stream) {
    const bough_node *last = NULL;
    for (int i = 0; i < scene->n_body; i++) {
        const bough_scene_body *b = &scene->body[i];
        if (b->node == last) continue; // repeated
        last = b->node;
        if (bough_node_find(b->node, "inertia")) warn_inertia(b, stream);
        if (b->micro.node) warn_micro(scene, b, stream);
        const bough_node *rest = bough_node_find(b->joint.node, "rest");
        if (rest && b->joint.spring.stiffness == 0)
            warn(rest, stream, "body '%s': joint.rest: not used without a 'stiffness'", b->name);
    }
    for (int k = 0; k < scene->n_load; k++) {
        if (scene->load[k].body_name != NULL) warn_follower(scene, &scene->load[k], stream);
    }
    if (scene->aero.node) warn_polars(&scene->aero.polars, stream);
    if (scene->control.node) warn_law(&scene->control, stream);
    const bough_scene_simulation *s = &scene->simulation;
    warn_settings(scene, stream);
    warn_companions(scene, stream);
    warn_output(s, stream);
    warn_scheme(s, stream);
    warn_solver(&s->master, "simulation.master", stream);
    bool members = bough_scheme_reads(bough_scheme_at(s->coupling.scheme), BOUGH_READS_MEMBERS);
    if (members) warn_solver(&s->micro, "simulation.micro", stream);
}
