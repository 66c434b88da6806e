// bough check: what a scene builds, and why. Nothing is run or written.
#include "apps/bough/cli/command.h"
#include "apps/bough/cli/run.h"
#include "apps/bough/config/base.h"
#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/control_link.h"
#include "apps/bough/model/validity.h"

static const char *body_name(const bough_scene *scene, int body) {
    return body == BOUGH_GROUND ? "ground" : scene->body[body].name;
}

static const char *plural(long n) { return n == 1 ? "" : "s"; }

// -- bodies ---------------------------------------------------------------------------------------

static bool is_rod(const bough_scene *scene, int body) {
    return body != BOUGH_GROUND && scene->body[body].fidelity == BOUGH_SCENE_ROD;
}

// What a fixed body moves with: the first of its carriers on a joint that moves, a rod, or the ground.
static int carrier(const bough_scene *scene, int body) {
    do {
        body = scene->body[body].joint.parent;
    } while (body != BOUGH_GROUND && !is_rod(scene, body) &&
             scene->body[body].joint.kind == BOUGH_JOINT_FIXED);
    return body;
}

static void print_spring(const bough_scene_joint *joint) {
    const char *of = joint->kind == BOUGH_JOINT_REVOLUTE ? "N m/rad" : "N/m";
    const char *rate = joint->kind == BOUGH_JOINT_REVOLUTE ? "N m s/rad" : "N s/m";
    if (joint->spring.stiffness > 0) printf(", spring %.6g %s", joint->spring.stiffness, of);
    if (joint->spring.damping > 0) printf(", damper %.6g %s", joint->spring.damping, rate);
    if (joint->spring.stop_stiffness > 0) printf(", stops %.6g %s", joint->spring.stop_stiffness, of);
}

static void print_joint(const bough_scene *scene, int body) {
    static const char *const words[] = {[BOUGH_JOINT_REVOLUTE] = "about", // before the axis
                                        [BOUGH_JOINT_PRISMATIC] = "along",
                                        [BOUGH_JOINT_CYLINDRICAL] = "along and about",
                                        [BOUGH_JOINT_UNIVERSAL] = "about",
                                        [BOUGH_JOINT_PLANAR] = "normal to"};
    const bough_scene_joint *joint = &scene->body[body].joint;
    if (joint->kind == BOUGH_JOINT_FIXED) {
        int on = carrier(scene, body);
        bool through = on != joint->parent;
        printf("; fixed to %s%s", is_rod(scene, joint->parent) ? "the end of " : "",
               body_name(scene, joint->parent));
        if (through) printf(" and so to %s%s", is_rod(scene, on) ? "the end of " : "", body_name(scene, on));
        printf(": no states in the tree");
        return;
    }
    bough_joint_kind kind = (bough_joint_kind)joint->kind;
    int n = bough_joint_n_speeds(kind);
    const char *word = words[kind];
    printf("; %s", bough_joint_name(kind));
    if (word != NULL) printf(" %s %c", word, "xyz"[joint->axis]);
    if (joint->kind == BOUGH_JOINT_UNIVERSAL) printf(" and %c", "xyz"[joint->second_axis]);
    printf(" on %s: %d degree%s of freedom", body_name(scene, joint->parent), n, plural(n));
    int driven = (joint->motion[0].node != NULL) + (joint->motion[1].node != NULL);
    if (driven > 0) printf(", %d of them prescribed", driven);
    print_spring(joint);
}

static double beam_mass(const bough_beam *beam) {
    double mass = 0;
    for (int i = 0; i <= beam->def.n_segment; i++) mass += beam->def.inertia[i].mass;
    return mass;
}

static void print_rod(const bough_simulation *s, const bough_beam *beam) {
    const bough_member *rod = &s->rod[beam->port];
    const double *span = beam->def.span;
    int n = beam->def.n_segment;
    printf("; %d segments", n);
    if (beam->body->rod.grading > 0) printf(" of %.4g to %.4g m", span[1] - span[0], span[n] - span[n - 1]);
    printf(", %d states", rod->system.n_state);
    if (bough_scheme_whole(s->master->coupling)) return;
    printf(", %s, rtol %.6g", rod->solver, bough_scene_micro(s->scene, beam->body)->rtol);
}

static void print_body(const bough_simulation *s, int body) {
    const bough_beam *beam = bough_simulation_beam(s, body);
    bool flexible = beam && beam->port >= 0;
    printf("body %s: %s", s->scene->body[body].name,
           flexible                                           ? s->rod[beam->port].system.kind
           : beam                                             ? "rigid, with mass and inertia of its rod"
           : s->scene->body[body].fidelity == BOUGH_SCENE_FMU ? "FMU"
                                                              : "rigid");
    print_joint(s->scene, body);
    if (flexible) print_rod(s, beam);
    printf("; mass %.6g kg", beam ? beam_mass(beam) : s->scene->body[body].mass);
    if (beam) printf(", length %.6g m", beam->def.span[beam->def.n_segment]);
    putchar('\n');
}

static void print_closures(const bough_tree *tree) {
    int redundant = tree->n_rows - tree->closure_rank;
    printf("closures: %d, %d equation%s, %d independent", tree->n_closures, tree->n_rows,
           plural(tree->n_rows), tree->closure_rank);
    if (redundant > 0) {
        printf("; %d depend%s on the others: the smallest of the possible constraint forces are computed",
               redundant, redundant == 1 ? "s" : "");
    }
    int freedoms = tree->n_v - tree->closure_rank;
    for (int i = 0; i < tree->n_links; i++) freedoms -= tree->links[i].motion != NULL;
    printf("\ndegrees of freedom: %d\n", freedoms);
    if (tree->closure_moved > 1e-9) {
        printf("closures: assembled, moving joints by up to %.3g (rad or m)\n", tree->closure_moved);
    }
}

static void print_bodies(const bough_simulation *s) {
    const bough_tree *tree = s->tree;
    int n = s->scene->n_body;
    printf("bodies: %d\n", n);
    for (int i = 0; i < n; i++) print_body(s, i);
    int moving = bough_simulation_n_joints(s);
    printf("joints: %d moving, %d fixed\n", moving, n - moving);
    const bough_member *whole = bough_scheme_whole(s->master->coupling);
    double rtol = s->scene->simulation.master.rtol;
    printf("tree: %d state%s (%d of position, %d of speed)", tree->n_q + tree->n_v,
           plural(tree->n_q + tree->n_v), tree->n_q, tree->n_v);
    if (!whole) printf(", %s, rtol %.6g", s->leader.solver, rtol);
    printf("\nstates: %d", s->master->assembly->n_state);
    putchar('\n');
    if (whole) printf("integrated as a whole: %s, rtol %.6g\n", whole->solver, rtol);
    if (tree->n_springs > 0) printf("springs: %d\n", tree->n_springs);
    if (tree->n_bushings > 0) printf("bushings: %d\n", tree->n_bushings);
    if (tree->n_closures > 0) print_closures(tree);
}

// -- coupling -------------------------------------------------------------------------------------

// Steps of the run: those of equal length, and one more for each corner of a load between their ends.
static long count_steps(const bough_master *m) {
    double eps = 1e-9;
    long steps = (long)ceil(m->duration / m->macro_step - eps);
    double last = 0;
    for (int i = 0; i < m->n_event; i++) {
        double grid = m->event[i] / m->macro_step;
        bool inside = m->event[i] > last && m->event[i] < m->duration;
        if (inside && fabs(grid - round(grid)) > eps) steps++;
        if (inside) last = m->event[i];
    }
    return steps;
}

static void print_coupling(const bough_simulation *s) {
    const bough_master *m = s->master;
    const bough_scheme *scheme = m->coupling->scheme;
    char text[BOUGH_SCHEME_TEXT];
    bough_scheme_describe(scheme, &m->coupling->options, text);
    printf("coupling: %s (%s)\n", text, scheme->summary);
    printf("ports: %d, each %d components of velocity and gravity to the rod, %d of force and moment back\n",
           s->tree->n_ports, BOUGH_PORT_OUTPUTS, BOUGH_PORT_INPUTS);
    if (s->n_end > 0) {
        printf(
            "ends of rods that carry: %d, each %d components of velocity and pose to the rod, %d of force and "
            "moment back\n",
            s->n_end, BOUGH_END_OUTPUTS, BOUGH_END_INPUTS);
    }
    printf("duration: %.9g s\n", m->duration);
    printf("macro_step: %.9g s\n", m->macro_step);
    printf("macro_steps: %ld\n", count_steps(m));
    printf("threads: %d\n", bough_pool_threads(m->coupling->pool));
}

// -- loads ----------------------------------------------------------------------------------------

static void print_vector(const double v[3], const char *unit) {
    if (v[0] != 0 || v[1] != 0 || v[2] != 0) printf(", [%.6g, %.6g, %.6g] %s", v[0], v[1], v[2], unit);
}

static void print_load(const bough_scene *scene, const bough_scene_load *load) {
    static const char *const frames[] = {"ground", "body", "section"};
    const char *input = load->input;
    if (load->joint_name != NULL) {
        bool turns = scene->body[load->joint].joint.kind == BOUGH_JOINT_REVOLUTE;
        printf("load on joint %s: ", load->joint_name);
        if (load->n_time > 0 && input == NULL) {
            printf("table from %.6g to %.6g s", load->times[0], load->times[load->n_time - 1]);
        } else {
            printf("%.6g %s", load->amount, turns ? "N m" : "N");
        }
    } else {
        bool along = load->place == BOUGH_SCENE_ALONG;
        printf("load on %s: %s axes", load->body_name, frames[load->frame]);
        print_vector(load->wrench, along ? "N/m" : "N");
        print_vector(load->wrench + 3, along ? "N m/m" : "N m");
        if (load->n_time > 0 && input == NULL) printf(", by a table over time");
    }
    if (load->ramp[1] > 0) printf(", ramp from %.6g to %.6g s", load->ramp[0], load->ramp[1]);
    if (input != NULL) printf(", set by the input %s", input);
    putchar('\n');
}

static void print_loads(const bough_simulation *s) {
    enum { SHOWN = 12 };
    int n = s->scene->n_load;
    const double *g = s->scene->gravity;
    printf("gravity: [%.6g, %.6g, %.6g] m/s^2\n", g[0], g[1], g[2]);
    printf("loads: %d\n", n);
    for (int i = 0; i < n && i < SHOWN; i++) print_load(s->scene, &s->scene->load[i]);
    if (n > SHOWN) printf("and %d more loads\n", n - SHOWN);
}

// -- cost -----------------------------------------------------------------------------------------

static void print_cost(const bough_simulation *s, bough_arena *arena) {
    const bough_assembly *a = s->master->assembly;
    printf("model_bytes: %zu\n", bough_arena_bytes(arena));
    double *rate = bough_arena_doubles(arena, (size_t)a->n_state + 1);
    for (int i = 0; i < a->n_member; i++) {
        if (a->member[i]->opaque) continue;
        double time = bough_forecast_derivative(s->master->coupling, i, 200, rate);
        printf("derivative_us %s: %.3g\n", a->member[i]->system.name, 1e6 * time);
    }
}

// -- geometry of the turbine ----------------------------------------------------------------------

// A point of the vertical from which the overhang is measured: the tower's top, or else the ground's origin.
static bough_vec3 tower_axis(const bough_simulation *s) {
    if (s->tower_top == NULL) return bough_v3(0, 0, 0);
    const bough_rod_def *top = &s->tower_top->def;
    bough_transform foot = bough_tree_frame_pose(s->view, &s->tree->markers[s->tower_top->marker]);
    return bough_add(foot.position, bough_mat3_mul(foot.rotation, top->position[top->n_segment]));
}

static void print_rotor(const bough_simulation *s, const bough_rotor_place *r) {
    bough_vec3 from = bough_sub(r->hub, tower_axis(s));
    double level = hypot(r->axis.x, r->axis.y);
    printf("rotor: %d blade%s, radius %.6g m, hub height %.6g m, tilt %.6g deg, ", s->scene->turbine.n_blade,
           plural(s->scene->turbine.n_blade), r->radius, r->hub.z, atan2(-r->axis.z, level) / BOUGH_DEGREE);
    if (level > 1e-6) {
        double along = (from.x * r->axis.x + from.y * r->axis.y) / (level * level);
        printf("overhang %.6g m %s", fabs(along), along < 0 ? "upwind" : "downwind");
    }
    printf(" along the shaft\n");
}

static void print_blades(const bough_simulation *s, const bough_rotor_place *r) {
    for (int k = 0; k < s->scene->turbine.n_blade; k++) {
        const bough_beam *blade = bough_simulation_beam(s, s->scene->turbine.blade[k]);
        bough_transform root = bough_tree_frame_pose(s->view, &s->tree->markers[blade->marker]);
        bough_vec3 z = bough_mat3_mul(root.rotation, bough_v3(0, 0, 1));
        bough_vec3 offset = bough_sub(root.position, r->hub);
        double cone = -asin(fmax(-1, fmin(1, bough_dot(z, r->axis)))); // positive upwind, as the key
        double shown = fabs(cone) < 1e-9 ? 0 : cone / BOUGH_DEGREE;
        printf("blade %s: pitch %.6g deg, cone %.6g deg, root at %.6g m\n", blade->body->name,
               bough_simulation_pitch(s, blade) / BOUGH_DEGREE, shown, bough_dot(offset, z));
    }
}

// -- air ------------------------------------------------------------------------------------------

static void print_box(const bough_simulation *s, const bough_wind_box *box, const bough_rotor_place *r) {
    const bough_rotor *air = bough_aero_link_rotor(s->aero);
    bool covered = bough_wind_covers(bough_rotor_wind(air), r->hub, r->radius);
    bool lasts = bough_wind_box_lasts(box, s->master->duration);
    printf(", mean %.6g m/s, %.6g s%s, heights %.6g to %.6g m, width %.6g m: %s the rotor%s", box->mean,
           box->duration, box->periodic ? " and repeats" : "", box->bottom,
           box->bottom + box->dz * (box->n_z - 1), 2 * box->half_width, covered ? "covers" : "does not cover",
           lasts ? "" : ", ends before the run");
}

// Mean speed of a hub-height file over its time, by the trapezoidal rule.
static void print_hub_file(const bough_simulation *s, const bough_wind_hub *hub) {
    double last = hub->row[hub->n - 1].time, span = last - hub->row[0].time, mean = 0;
    for (int i = 1; i < hub->n; i++) {
        const bough_wind_hub_row *a = &hub->row[i - 1], *b = &hub->row[i];
        mean += (b->time - a->time) * (a->speed + b->speed) / 2 / span;
    }
    printf(", mean %.6g m/s, %.6g s, the whole space at once%s", hub->n > 1 ? mean : hub->row[0].speed, span,
           last < s->master->duration ? ", then as its last row" : "");
}

static void print_wind(const bough_simulation *s, const bough_rotor_place *r) {
    static const char *const kinds[] = {
        [BOUGH_SCENE_WIND_UNIFORM] = "uniform",     [BOUGH_SCENE_WIND_POWER] = "power law",
        [BOUGH_SCENE_WIND_LOG] = "logarithmic law", [BOUGH_SCENE_WIND_WND] = "hub-height file",
        [BOUGH_SCENE_WIND_BTS] = "box file",        [BOUGH_SCENE_WIND_IEC] = "IEC 61400-1",
    };
    const bough_scene_wind *given = &s->scene->aero.wind;
    const bough_wind *wind = bough_rotor_wind(bough_aero_link_rotor(s->aero));
    const bough_scene_wind_table *table = &given->table;
    bool from_file = given->kind == BOUGH_SCENE_WIND_WND || given->kind == BOUGH_SCENE_WIND_BTS;
    printf("wind: %s", kinds[given->kind]);
    if (from_file) printf(" %s", given->def.file);
    if (table->node) {
        printf(", %d speeds from %.6g s to %.6g s", table->n_time, table->time[0],
               table->time[table->n_time - 1]);
    } else if (!from_file) {
        printf(", %.6g m/s", given->def.speed);
    }
    if (wind->box) print_box(s, wind->box, r);
    if (wind->hub) print_hub_file(s, wind->hub);
    printf(", to %.6g deg from x, %.6g m/s upwards", given->def.direction / BOUGH_DEGREE,
           given->def.vertical);
    bough_vec3 hub = bough_aero_link_hub_wind(s->aero, 0);
    printf("; at the hub at 0 s [%.6g, %.6g, %.6g] m/s\n", hub.x, hub.y, hub.z);
}

static const char *tower_words(const bough_scene_tower *tower) {
    if (!tower->node) return "off";
    return tower->def.influence == BOUGH_TOWER_BAK ? "on (Bak)" : "on";
}

static void print_aero(const bough_simulation *s, const bough_rotor_place *r) {
    const bough_scene_aero *aero = &s->scene->aero;
    if (!s->aero) {
        printf("aero: not built: no aero block\n");
        return;
    }
    long every = bough_master_multiple(1 / aero->rate, s->master->macro_step);
    printf("aero: built, %d blades of %d stations, %d polars, %.6g Hz (every %ld macro step%s), "
           "%s between samples, tower influence %s%s%s%s\n",
           s->scene->turbine.n_blade, aero->blade.n_station, aero->polars.n_polar, aero->rate, every,
           plural(every), aero->hold == BOUGH_SCENE_LINEAR ? "linear" : "constant", tower_words(&aero->tower),
           aero->tower.def.shadow == BOUGH_TOWER_SHADOW_POWLES ? ", Powles shadow" : "",
           aero->induction.inflow.kind == BOUGH_INFLOW_OYE ? ", dynamic inflow" : "",
           aero->dynamic_stall != BOUGH_STALL_NONE ? ", dynamic stall" : "");
    print_wind(s, r);
}

// -- control --------------------------------------------------------------------------------------

static void print_control(const bough_simulation *s) {
    static const char *const kind[] = {[BOUGH_SCENE_VARIABLE_SPEED] = "variable-speed law",
                                       [BOUGH_SCENE_BLADED] = "library ",
                                       [BOUGH_SCENE_EXTERNAL] = "by inputs from outside",
                                       [BOUGH_SCENE_CONTROL_FMU] = "FMU "};
    const bough_scene_control *c = &s->scene->control;
    if (c->node == NULL) {
        printf("control: not built: no control block\n");
        return;
    }
    printf("control: built, %s%s, %.6g Hz, gear ratio %.6g, generator torque%s, %d event%s\n", kind[c->kind],
           c->kind == BOUGH_SCENE_BLADED        ? c->library
           : c->kind == BOUGH_SCENE_CONTROL_FMU ? c->fmu.model.folder
                                                : "",
           c->rate, c->gear_ratio, bough_control_link_pitches(s->control) ? " and pitch" : " only",
           c->n_event, plural(c->n_event));
}

static void print_turbine(bough_simulation *s) {
    bough_simulation_update(s);
    bool turbine = s->scene->turbine.node != NULL;
    bough_rotor_place r = {0};
    if (turbine) {
        r = bough_simulation_rotor(s);
        print_rotor(s, &r);
        print_blades(s, &r);
    }
    print_aero(s, &r);
    if (turbine) print_control(s);
}

// -- the command ----------------------------------------------------------------------------------

typedef struct check_options {
    bough_options common;
    bool full;
} check_options;

static const bough_option rows[] = {
    BOUGH_OPTION_SET,
    {"full", NULL, "prints the scene with base and --set merged into it, as a scene that runs",
     bough_option_flag, .offset = offsetof(check_options, full)},
    {0},
};

// A scalar as it must be written beside the scene: a base names files relative to itself.
static const char *written(void *self, const bough_node *scalar) {
    const bough_scene *scene = self;
    size_t length = (size_t)(bough_file_name(scene->file) - scene->file);
    const bough_schema_base *base = scene->bases;
    while (base && strcmp(base->path, scalar->file) != 0) base = base->next;
    size_t inner = base ? strlen(base->directory) : 0;
    for (const bough_schema_file *f = scene->named; base && f; f = f->next) {
        bool same =
            strncmp(f->path, base->directory, inner) == 0 && strcmp(f->path + inner, scalar->text) == 0;
        if (same) return f->path + (base->absolute ? 0 : length);
    }
    return scalar->text;
}

static bough_status check(bough_arena *arena, const void *options) {
    if (((const check_options *)options)->full) {
        bough_scene *scene;
        bough_status status = bough_open_scene(arena, options, &scene);
        if (bough_is_ok(&status)) bough_node_write(scene->node, written, scene, stdout);
        return status;
    }
    bough_simulation *s;
    BOUGH_TRY(bough_open(arena, options, &s));
    bough_channels channels = bough_channels_start(arena);
    const bough_scene_output *output = &s->scene->simulation.output;
    bough_channels recorded;
    bough_shape shape;
    BOUGH_TRY(bough_simulation_channels(s, &channels));
    BOUGH_TRY(bough_open_channels(s->scene, &channels, &recorded));
    printf("scene: %s\n", s->scene->file);
    printf("title: %s\n", s->scene->title ? s->scene->title : "");
    print_bodies(s);
    print_coupling(s);
    print_turbine(s);
    print_loads(s);
    bough_validity_print(s, stdout);
    printf("channels: %d every %.9g s\n", recorded.count, output->interval);
    bough_shape_create(arena, s, &shape);
    bough_forecast_print(bough_run_results(s, &recorded, &shape), &recorded);
    print_cost(s, arena);
    return bough_ok();
}

const bough_command bough_command_check = {
    .name = "check",
    .summary = "shows what a scene builds; nothing is run or written",
    .operands = "SCENE",
    .option = rows,
    .size = sizeof(check_options),
    .run = check,
};
