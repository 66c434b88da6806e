// bough static: the shape of each rod and the angles of the joints at rest, or in steady rotation,
// under gravity and the whole of the scene's loads.
#include "apps/bough/analysis/steady.h"
#include "apps/bough/cli/command.h"
#include "apps/bough/model/companion.h"
#include "apps/bough/model/equilibrium.h"
#include "apps/bough/model/section_loads.h"
#include "apps/bough/results/channels.h"
#include "apps/bough/results/folder.h"

typedef struct equilibrium {
    bough_simulation *simulation;
    bool one_by_one; // each rod is found by itself
    double time;     // of the loads [s]
    bough_equilibrium_work work;
    int n;
    bough_section_loads *rod; // (n)
    bough_channels channels;
    double *value; // (channels.count)
} equilibrium;

enum {
    STATIC_DISPLACEMENT, // of the tip [m]
    STATIC_ROTATION,     // of the tip [rad]
    STATIC_FORCE,        // at the root [N]
    STATIC_MOMENT,       // at the root [N m]
    STATIC_RESULTS,
};

// The error of the mesh of an equilibrium.
typedef struct mesh_error {
    const equilibrium *of;
    char unknown[BOUGH_MESSAGE + 40]; // reason why it is not known; "": it is known
    double *rod;                      // (n × STATIC_RESULTS) norms
    double *largest;                  // (channels.count) of each channel, in its unit
} mesh_error;

// -- the equilibrium ------------------------------------------------------------------------------

static bough_status find_rods(bough_arena *arena, equilibrium *x) {
    bough_simulation *s = x->simulation;
    const bough_assembly *a = s->master->assembly;
    const bough_turning rest = {0};
    bough_steady rod;
    double *state = bough_arena_doubles(arena, (size_t)a->n_state + 1);
    bough_assembly_states(a, state);
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].rod == NULL) continue;
        BOUGH_TRY(bough_steady_find(arena, s, &s->beam[k], &rest, &rod));
        size_t size = BOUGH_ROD_STATES * (size_t)rod.model->n;
        memcpy(state + a->state_offset[rod.beam->port + 1], rod.state, size * sizeof *state);
        x->work.steps += rod.work.iterations;
    }
    bough_equilibrium_set_state(s, x->time, state);
    return bough_ok();
}

// If the search for a single rod fails, as for a slack one, the whole scene is searched.
static bough_status balance(bough_arena *arena, int how, equilibrium *x) {
    bough_status status = bough_ok();
    if (x->one_by_one) status = find_rods(arena, x);
    if (x->one_by_one && status.code != BOUGH_FAILED) return status;
    x->one_by_one = false;
    return bough_simulation_equilibrium(x->simulation, x->time, how, &x->work);
}

// The equilibrium and the values of the run's channels there.
static bough_status find_equilibrium(bough_arena *arena, bough_simulation *s, bool one_by_one, int how,
                                     equilibrium *x) {
    const bough_coupling *c = s->master->coupling;
    *x = (equilibrium){.simulation = s,
                       .one_by_one = one_by_one,
                       .time = bough_equilibrium_time(s),
                       .channels = bough_channels_start(arena)};
    x->rod = bough_arena_take(arena, ((size_t)s->n_rod + 1) * sizeof *x->rod);
    BOUGH_TRY(balance(arena, how, x));
    BOUGH_TRY(bough_simulation_channels(s, &x->channels));
    x->value = bough_arena_doubles(arena, (size_t)x->channels.count + 1);
    bough_assembly_outputs(s->master->assembly, x->time, c->output, c->input);
    bough_simulation_update(s);
    bough_channels_sample(&x->channels, x->time, x->value);
    // bodies at rest or in steady rotation, also where a joint is held against a torque
    bough_simulation_accelerate(s, x->time);
    memset(s->view->acceleration, 0, (size_t)s->tree->n_links * sizeof *s->view->acceleration);
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].rod == NULL) continue;
        x->rod[x->n] = bough_section_loads_create(arena, s, &s->beam[k]);
        bough_section_loads_evaluate(&x->rod[x->n++], x->time);
    }
    return bough_ok();
}

static bough_status find_growth(const equilibrium *x, bough_growth *growth) {
    return bough_simulation_growth(x->simulation, x->time, false, growth);
}

// If rods that were found one by one are unstable, the search of the whole scene may find a stable
// equilibrium.
static void seek_stable(bough_arena *arena, equilibrium *x, bough_growth *growth) {
    bough_simulation *s;
    equilibrium whole;
    bough_growth other;
    bough_status status = bough_simulation_build(arena, x->simulation->scene, &s);
    if (bough_is_ok(&status)) status = find_equilibrium(arena, s, false, BOUGH_EQUILIBRIUM_UNSTABLE, &whole);
    if (bough_is_ok(&status)) status = find_growth(&whole, &other);
    if (bough_is_ok(&status) && other.rate == 0) *x = whole, *growth = other;
}

// Displacement and rotation of the tip, force and moment at the root.
static void find_results(const bough_section_loads *rod, bough_vec3 result[STATIC_RESULTS]) {
    const bough_rod_def *def = &rod->beam->def;
    bough_simulation_shift(rod->simulation, rod->beam, def->n_segment, &result[STATIC_DISPLACEMENT],
                           &result[STATIC_ROTATION]);
    result[STATIC_FORCE] = rod->root.force;
    result[STATIC_MOMENT] = bough_add(rod->root.moment, bough_cross(def->position[0], rod->root.force));
}

// -- a finer mesh ---------------------------------------------------------------------------------

static const double fraction = 16.0 / 15; // of the difference to four times the segments, at order 2

static void compare(const mesh_error *c, equilibrium *fine) {
    const equilibrium *coarse = c->of;
    bough_vec3 here[STATIC_RESULTS], there[STATIC_RESULTS];
    for (int k = 0; k < fine->n; k++) {
        find_results(&coarse->rod[k], here);
        find_results(&fine->rod[k], there);
        for (int i = 0; i < STATIC_RESULTS; i++) {
            c->rod[STATIC_RESULTS * k + i] = fraction * bough_norm(bough_sub(here[i], there[i]));
        }
    }
    for (int i = 0; i < fine->simulation->n_motion_channel; i++)
        c->largest[i] = fraction * fabs(coarse->value[i] - fine->value[i]);
}

// Segments of the finer mesh relative to the scene's: with a factor of two it would still miss details of a
// table, such as the last metre of a blade.
enum { TIMES = 4 };

// False, with the reason, if a finer mesh gives no estimate.
static bool refine(bough_scene *scene, mesh_error *mesh) {
    bool any = false;
    for (int i = 0; i < scene->n_body; i++) {
        bough_scene_body *body = &scene->body[i];
        if (!bough_scene_has_mesh(body)) continue;
        if (body->fidelity != BOUGH_SCENE_ROD) {
            snprintf(mesh->unknown, sizeof mesh->unknown,
                     "%.60s is a modal body, whose shapes have errors of their own", body->name);
            return false;
        }
        body->rod.n_segment *= TIMES;
        any = true;
    }
    if (!any) snprintf(mesh->unknown, sizeof mesh->unknown, "no body has a mesh");
    return any;
}

static bough_status find_finer(bough_arena *arena, void *self) {
    mesh_error *c = self;
    bough_scene *scene = bough_coarser_scene(arena, c->of->simulation->scene, 0);
    bough_simulation *s;
    equilibrium fine;
    if (!refine(scene, c)) return bough_ok();
    BOUGH_TRY(bough_simulation_build(arena, scene, &s));
    // start from the equilibrium found, since there may be several
    bough_simulation_take_shape(c->of->simulation, s);
    BOUGH_TRY(find_equilibrium(arena, s, c->of->one_by_one, BOUGH_EQUILIBRIUM_FINER, &fine));
    compare(c, &fine);
    return bough_ok();
}

// By the difference to four times the segments.
static void find_mesh_error(bough_arena *arena, const equilibrium *x, mesh_error *mesh) {
    *mesh = (mesh_error){.of = x,
                         .rod = bough_arena_doubles(arena, STATIC_RESULTS * ((size_t)x->n + 1)),
                         .largest = bough_arena_doubles(arena, (size_t)x->channels.count + 1)};
    bough_status status = bough_arena_use(find_finer, mesh);
    if (!bough_is_ok(&status))
        snprintf(mesh->unknown, sizeof mesh->unknown, "with %d times the segments: %s", TIMES,
                 status.message);
}

// -- tables of a rod: displacements of its vertices, loads in the middle of its segments ------------

enum { VERTICES, MIDDLES, TABLES, COLUMNS = 7 };

// Names and units.
static const char *const heads[TABLES][2][COLUMNS] = {
    {{"span", "ux", "uy", "uz", "rx", "ry", "rz"}, {"(m)", "(m)", "(m)", "(m)", "(deg)", "(deg)", "(deg)"}},
    {{"middle", "shear x", "shear y", "axial", "bend x", "bend y", "twist"},
     {"(m)", "(N)", "(N)", "(N)", "(N m)", "(N m)", "(N m)"}},
};

static int count_rows(const bough_section_loads *x, int table) {
    return x->beam->def.n_segment + (table == VERTICES);
}

static void find_row(const bough_section_loads *x, int table, int i, double value[COLUMNS]) {
    const double *span = x->beam->def.span;
    bough_vec3 shift, turn;
    value[0] = table == VERTICES ? span[i] : 0.5 * (span[i] + span[i + 1]);
    if (table == MIDDLES) {
        bough_rod_place middle = bough_section_loads_place(x, i, 0.5);
        bough_wrench load = bough_section_loads_at(x, &middle);
        bough_mat3 axes = bough_section_loads_axes(x, &middle, &turn);
        bough_v3_store(bough_mat3_tmul(axes, load.force), value + 1);
        bough_v3_store(bough_mat3_tmul(axes, load.moment), value + 4);
        return;
    }
    bough_simulation_shift(x->simulation, x->beam, i, &shift, &turn);
    bough_v3_store(shift, value + 1);
    bough_v3_store(bough_scale(1 / BOUGH_DEGREE, turn), value + 4);
}

static void print_table(const bough_section_loads *x, int table) {
    double value[COLUMNS];
    for (int k = 0; k < 2; k++) {
        for (int c = 0; c < COLUMNS; c++) printf(c == 0 ? "%10s" : " %12s", heads[table][k][c]);
        putchar('\n');
    }
    for (int i = 0; i < count_rows(x, table); i++) {
        find_row(x, table, i, value);
        for (int c = 0; c < COLUMNS; c++) printf(c == 0 ? "%10.4f" : " %12.6g", value[c]);
        putchar('\n');
    }
}

// Empty fields after the last row.
static void write_row(const bough_section_loads *x, int table, int i, FILE *file) {
    double value[COLUMNS];
    bool there = i < count_rows(x, table);
    if (there) find_row(x, table, i, value);
    for (int c = 0; c < COLUMNS; c++) {
        fputc(',', file);
        if (there) fprintf(file, "%.10g", value[c]);
    }
}

// A row is a vertex and the segment that begins there.
static void write_rods(const void *self, FILE *file) {
    const equilibrium *x = self;
    fputs("rod", file);
    for (int table = 0; table < TABLES; table++)
        for (int c = 0; c < COLUMNS; c++) fprintf(file, ",%s %s", heads[table][0][c], heads[table][1][c]);
    fputc('\n', file);
    for (int k = 0; k < x->n; k++) {
        for (int i = 0; i < count_rows(&x->rod[k], VERTICES); i++) {
            fputs(x->rod[k].beam->body->name, file);
            for (int table = 0; table < TABLES; table++) write_row(&x->rod[k], table, i, file);
            fputc('\n', file);
        }
    }
}

// -- output ---------------------------------------------------------------------------------------

static void print_rod(const bough_section_loads *x) {
    const bough_rod_model *m = x->beam->mesh;
    printf("rod %s: %d segments, %.9g m\n", m->name, m->n_segment, m->span[m->n_segment]);
    for (int table = 0; table < TABLES; table++) print_table(x, table);
    bough_vec3 result[STATIC_RESULTS];
    find_results(x, result);
    bough_vec3 u = result[STATIC_DISPLACEMENT], r = bough_scale(1 / BOUGH_DEGREE, result[STATIC_ROTATION]);
    bough_vec3 f = result[STATIC_FORCE], n = result[STATIC_MOMENT];
    printf("tip %s: u %.7g %.7g %.7g m, r %.7g %.7g %.7g deg\n", m->name, u.x, u.y, u.z, r.x, r.y, r.z);
    printf("root %s: force %.7g %.7g %.7g N, moment %.7g %.7g %.7g N m\n", m->name, f.x, f.y, f.z, n.x, n.y,
           n.z);
}

// Whether the link is the end of a rod, not a joint of the scene.
static bool is_end(const bough_tree *tree, int link) {
    bool end = false;
    for (int k = 0; k < tree->n_ends; k++) end = end || tree->ends[k].link == link;
    return end;
}

// Coordinates of the scene's joints, and the speeds that stay as they are.
static void print_joints(const bough_simulation *s) {
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        if (is_end(s->tree, i)) continue;
        const double *q = s->leader.state + link->first_coordinate;
        const double *v = s->leader.state + s->tree->n_q + link->first_speed;
        bool turns = link->joint.kind == BOUGH_JOINT_REVOLUTE,
             slides = link->joint.kind == BOUGH_JOINT_PRISMATIC;
        printf("joint %s: %s", s->tree->bodies[link->body].name, bough_joint_name(link->joint.kind));
        for (int k = 0; k < link->n_coordinates; k++) printf(" %.7g", turns ? q[k] / BOUGH_DEGREE : q[k]);
        printf("%s", turns ? " deg" : slides ? " m" : "");
        for (int k = 0; k < link->n_speeds; k++) {
            if (s->tree->initial[s->tree->n_q + link->first_speed + k] == 0) continue;
            printf(", keeps its speed of %.6g%s", v[k], turns ? " rad/s" : slides ? " m/s" : "");
        }
        putchar('\n');
    }
}

static void warn_of_growth(const bough_status *found, const bough_growth *growth) {
    static const char unstable[] = "bough: warning: the equilibrium is unstable:";
    if (!bough_is_ok(found))
        fprintf(stderr, "bough: warning: the stability of the equilibrium is not known: %s\n",
                found->message);
    if (growth->rate > 0) fprintf(stderr, "%s motions from it grow at %.3g 1/s\n", unstable, growth->rate);
    if (growth->twisting)
        fprintf(
            stderr,
            "bough: warning: the sections of rod '%s' twist in this equilibrium only because its segments are too long for its torsional stiffness: try rod.segments: %d, or more torsional stiffness\n",
            growth->twisting, growth->segments);
    if (growth->oscillation > 0)
        fprintf(stderr, "%s oscillations of %.4g Hz grow at %.3g 1/s\n", unstable, growth->frequency,
                growth->oscillation);
}

static void print_whole(const equilibrium *x) {
    printf("%s: %d steps", x->one_by_one ? "rods one by one" : "whole scene", x->work.steps);
    if (x->work.samples > 0) printf(", %d samples of the air", x->work.samples);
    if (x->time > 0) printf(", loads at %.6g s", x->time);
    putchar('\n');
    print_joints(x->simulation);
}

// Writes and prints the values of the run's channels in the equilibrium.
static bough_status write_channels(const equilibrium *x, const mesh_error *mesh, const char *folder) {
    char path[BOUGH_PATH_MAX];
    FILE *file = NULL;
    BOUGH_TRY(bough_folder_open(folder, "static-channels.csv", path, &file));
    fputs("channel,unit,value,mesh error\n", file);
    for (int i = 0; i < x->channels.count; i++) {
        const bough_channel *c = &x->channels.channel[i];
        bool known = mesh->unknown[0] == '\0' && i < x->simulation->n_motion_channel;
        printf("%s: %.7g %s", c->name, x->value[i], c->unit);
        fprintf(file, "%s,%s,%.10g,", c->name, c->unit, x->value[i]);
        if (known) printf(", mesh error %.2g", mesh->largest[i]);
        if (known) fprintf(file, "%.3g", mesh->largest[i]);
        putchar('\n');
        fputc('\n', file);
    }
    return bough_folder_close(path, file, bough_ok());
}

// -- a path: equilibria while the loads grow, with their limit points -----------------------------

typedef struct path_table {
    FILE *file;
    const bough_channels *channels;
    double *value; // (channels->count)
    int point;
} path_table;

static void write_path_head(const path_table *t) {
    fputs("point,limit,load factor (-)", t->file);
    for (int i = 0; i < t->channels->count; i++)
        fprintf(t->file, ",%s (%s)", t->channels->channel[i].name, t->channels->channel[i].unit);
    fputc('\n', t->file);
}

static bough_status write_path_point(void *self, double time, double factor, bool limit) {
    path_table *t = self;
    bough_channels_sample(t->channels, time, t->value);
    fprintf(t->file, "%d,%d,%.10g", t->point, limit, factor);
    for (int i = 0; i < t->channels->count; i++) fprintf(t->file, ",%.10g", t->value[i]);
    fputc('\n', t->file);
    if (limit) printf("limit point: %.7g of the loads, point %d\n", factor, t->point);
    t->point++;
    return bough_ok();
}

// Prints the limit points and writes every channel at every point to static-path.csv in the folder, also if
// the path ends before the full loads; the failure is returned.
static bough_status follow_path(bough_arena *arena, bough_simulation *s, const char *folder) {
    char path[BOUGH_PATH_MAX];
    bough_path_report report;
    bough_channels channels = bough_channels_start(arena);
    BOUGH_TRY(bough_simulation_channels(s, &channels));
    path_table t = {.channels = &channels};
    t.value = bough_arena_doubles(arena, (size_t)channels.count + 1);
    BOUGH_TRY(bough_folder_open(folder, "static-path.csv", path, &t.file));
    write_path_head(&t);
    bough_status followed = bough_simulation_path(s, (bough_path_listener){&t, write_path_point}, &report);
    if (report.points == 0) return bough_folder_close(path, t.file, followed);
    printf("path: %d points, %d limit points, %d steps, ", report.points, report.limits, report.steps);
    printf("to %.7g of the loads\nmesh error: not estimated along a path\n", report.factor);
    BOUGH_TRY(bough_folder_close(path, t.file, bough_ok()));
    printf("out: %s\n", path);
    return followed;
}

// -- the command ----------------------------------------------------------------------------------

// Displacements and rotations of the tips of modal bodies.
static void print_modal(bough_simulation *s) {
    bough_simulation_update(s);
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        if (beam->modal == NULL) continue;
        bough_vec3 u, r;
        bough_simulation_shift(s, beam, beam->def.n_segment, &u, &r);
        r = bough_scale(1 / BOUGH_DEGREE, r);
        printf("modal %s: tip moved by %.9g %.9g %.9g m, turned by %.9g %.9g %.9g deg\n", beam->body->name,
               u.x, u.y, u.z, r.x, r.y, r.z);
    }
}

typedef struct static_options {
    bough_options common;
    bool path;
} static_options;

static const bough_option rows[] = {
    BOUGH_OPTION_SET,
    BOUGH_OPTION_OUT,
    {"path", NULL, "follows the equilibria while the loads grow along their ramps, past limit points",
     bough_option_flag, .offset = offsetof(static_options, path)},
    {0},
};

static bough_status find(bough_arena *arena, const void *given) {
    const static_options *own = given;
    const bough_options *options = &own->common;
    bough_simulation *s;
    BOUGH_TRY(bough_open(arena, options, &s));
    BOUGH_TRY(bough_simulation_known(s, "it has no equilibrium"));
    if (s->n_rod == 0 && s->tree->n_v == 0) {
        return bough_fail(BOUGH_INVALID, "%.200s: no body of the scene can move or bend", s->scene->file);
    }
    const char *folder = bough_out_folder(arena, options);
    if (own->path) return follow_path(arena, s, folder);
    equilibrium x;
    mesh_error mesh;
    // modal bodies need the whole scene
    bool one_by_one = bough_rods_are_independent(s) && bough_steady_rods(s) == s->n_rod;
    bough_growth growth;
    BOUGH_TRY(find_equilibrium(arena, s, one_by_one, BOUGH_EQUILIBRIUM_UNSTABLE, &x));
    bough_status stability = find_growth(&x, &growth);
    if (x.one_by_one && growth.rate > 0) seek_stable(arena, &x, &growth);
    warn_of_growth(&stability, &growth);
    find_mesh_error(arena, &x, &mesh);
    print_whole(&x);
    for (int k = 0; k < x.n; k++) {
        print_rod(&x.rod[k]);
        const double *e = mesh.rod + STATIC_RESULTS * k;
        if (mesh.unknown[0] == '\0')
            printf("mesh error %s: tip u %.2g m, r %.2g deg, root force %.2g N, moment %.2g N m\n",
                   x.rod[k].beam->body->name, e[STATIC_DISPLACEMENT], e[STATIC_ROTATION] / BOUGH_DEGREE,
                   e[STATIC_FORCE], e[STATIC_MOMENT]);
    }
    print_modal(x.simulation);
    if (mesh.unknown[0]) printf("mesh error: not estimated: %s\n", mesh.unknown);
    BOUGH_TRY(bough_folder_write(folder, "static.csv", write_rods, &x));
    BOUGH_TRY(write_channels(&x, &mesh, folder));
    printf("out: %s\n", folder);
    return bough_ok();
}

const bough_command bough_command_static = {
    .name = "static",
    .summary = "computes the equilibrium of rods and joints under gravity, loads and air",
    .operands = "SCENE",
    .option = rows,
    .size = sizeof(static_options),
    .run = find,
};
