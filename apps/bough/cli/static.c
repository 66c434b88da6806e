// bough static: the shape of each rod and the angles of the joints at rest, or in steady rotation,
// under gravity and the whole of the scene's loads.
#include "apps/bough/cli/open.h"
#include "apps/bough/cli/static_find.h"
#include "apps/bough/cli/static_path.h"
#include "apps/bough/cli/verb.h"
#include "apps/bough/results/folder.h"

enum { MOTION = 6 }; // displacement and rotation, or force and moment

static const double degree = BOUGH_PI / 180;

// -- values ---------------------------------------------------------------------------------------

// Displacement [m] and rotation [deg] of vertex i.
static void motion_of(const bough_steady *x, int i, double value[MOTION]) {
    bough_vec3 shift, turn;
    bough_steady_displacement(x, i, &shift, &turn);
    const double values[MOTION] = {shift.x,         shift.y,         shift.z,
                                   turn.x / degree, turn.y / degree, turn.z / degree};
    for (int c = 0; c < MOTION; c++) value[c] = values[c];
}

static double middle_of(const bough_steady *x, int n) {
    return 0.5 * (x->model->span[n] + x->model->span[n + 1]);
}

static void stress_of(const bough_steady *x, int n, double value[MOTION]) {
    bough_rod_stress(x->model, &x->work.scratch, n, value);
}

// -- table ----------------------------------------------------------------------------------------

static void print_row(double span, const double value[MOTION]) {
    printf("%10.4f", span);
    for (int c = 0; c < MOTION; c++) printf(" %12.6g", value[c]);
    putchar('\n');
}

static void print_three(const char *what, bough_vec3 v, const char *unit) {
    printf("%s %.7g %.7g %.7g %s", what, v.x, v.y, v.z, unit);
}

static void print_rod(bough_steady *x) {
    const bough_rod_model *m = x->model;
    double value[MOTION];
    printf("rod %s: %d segments, %.9g m", m->name, m->n_segment, m->span[m->n_segment]);
    if (x->work.iterations > 0) printf(", %d iterations", x->work.iterations);
    putchar('\n');
    printf("%10s %12s %12s %12s %12s %12s %12s\n", "span", "ux", "uy", "uz", "rx", "ry", "rz");
    printf("%10s %12s %12s %12s %12s %12s %12s\n", "(m)", "(m)", "(m)", "(m)", "(deg)", "(deg)", "(deg)");
    for (int i = 0; i <= m->n_segment; i++) {
        motion_of(x, i, value);
        print_row(m->span[i], value);
    }
    printf("%10s %12s %12s %12s %12s %12s %12s\n", "middle", "shear x", "shear y", "axial", "bend x",
           "bend y", "twist");
    printf("%10s %12s %12s %12s %12s %12s %12s\n", "(m)", "(N)", "(N)", "(N)", "(N m)", "(N m)", "(N m)");
    for (int n = 0; n < m->n_segment; n++) {
        stress_of(x, n, value);
        print_row(middle_of(x, n), value);
    }
    bough_vec3 result[BOUGH_STATIC_RESULTS];
    bough_static_results(x, result);
    printf("tip %s:", m->name);
    print_three(" u", result[BOUGH_STATIC_DISPLACEMENT], "m,");
    print_three(" r", bough_scale(1 / degree, result[BOUGH_STATIC_ROTATION]), "deg\n");
    printf("root %s:", m->name);
    print_three(" force", result[BOUGH_STATIC_FORCE], "N,");
    print_three(" moment", result[BOUGH_STATIC_MOMENT], "N m\n");
}

static void print_mesh_error(const bough_steady *x, const double error[BOUGH_STATIC_RESULTS]) {
    printf("mesh error %s: tip u %.2g m, r %.2g deg, root force %.2g N, moment %.2g N m\n", x->model->name,
           error[BOUGH_STATIC_DISPLACEMENT], error[BOUGH_STATIC_ROTATION] / degree, error[BOUGH_STATIC_FORCE],
           error[BOUGH_STATIC_MOMENT]);
}

// Coordinates and speeds of the joints, and the speeds that are kept.
static void print_joints(const bough_simulation *s) {
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        const double *q = s->leader.state + link->first_coordinate;
        const double *v = s->leader.state + s->tree->n_q + link->first_speed;
        printf("joint %s: %s", s->tree->bodies[link->body].name, bough_joint_name(link->joint.kind));
        if (link->joint.kind == BOUGH_JOINT_REVOLUTE) {
            printf(" %.7g deg", q[0] / degree);
        } else {
            for (int k = 0; k < link->n_coordinates; k++) printf(" %.7g", q[k]);
        }
        for (int k = 0; k < link->n_speeds; k++) {
            if (s->tree->initial[s->tree->n_q + link->first_speed + k] == 0) continue;
            printf(", keeps its speed %.6g", v[k]);
        }
        putchar('\n');
    }
}

static void print_whole(const bough_static *x) {
    printf("whole scene: %d steps", x->work.steps);
    if (x->work.samples > 0) printf(", %d samples of the air", x->work.samples);
    if (x->time > 0) printf(", loads at %.6g s", x->time);
    putchar('\n');
    print_joints(x->simulation);
}

// -- file -----------------------------------------------------------------------------------------

static const char header[] =
    "rod,span (m),ux (m),uy (m),uz (m),rx (deg),ry (deg),rz (deg),middle (m),shear x (N),"
    "shear y (N),axial (N),bend x (N m),bend y (N m),twist (N m)\n";

static void write_values(FILE *file, double span, const double value[MOTION]) {
    fprintf(file, ",%.10g", span);
    for (int c = 0; c < MOTION; c++) fprintf(file, ",%.10g", value[c]);
}

// A row is a vertex and the segment that begins there.
static void write_rod(FILE *file, const bough_steady *x) {
    const bough_rod_model *m = x->model;
    double value[MOTION];
    for (int i = 0; i <= m->n_segment; i++) {
        fputs(m->name, file);
        motion_of(x, i, value);
        write_values(file, m->span[i], value);
        if (i < m->n_segment) {
            stress_of(x, i, value);
            write_values(file, middle_of(x, i), value);
        } else {
            fputs(",,,,,,,", file);
        }
        fputc('\n', file);
    }
}

// What the run's channels are in the equilibrium: joints, drives, closures, markers, roots, rotor.
static bough_status write_channels(const bough_static *x, const bough_mesh_error *mesh, const char *folder) {
    char path[BOUGH_PATH_MAX];
    FILE *file = NULL;
    bough_status status = bough_folder_open(folder, "static-channels.csv", path, &file);
    if (!bough_is_ok(&status)) return status;
    fputs("channel,unit,value,mesh error\n", file);
    for (int i = 0; i < x->channels.count; i++) {
        const bough_channel *c = &x->channels.channel[i];
        bool told = mesh->unknown[0] == '\0' && i < x->simulation->n_motion_channel;
        printf("%s: %.7g %s", c->name, x->value[i], c->unit);
        fprintf(file, "%s,%s,%.10g,", c->name, c->unit, x->value[i]);
        if (told) printf(", mesh error %.2g", mesh->largest[i]);
        if (told) fprintf(file, "%.3g", mesh->largest[i]);
        putchar('\n');
        fputc('\n', file);
    }
    return bough_folder_commit(path, file);
}

static void write_rods(const void *self, FILE *file) {
    const bough_static *x = self;
    fputs(header, file);
    for (int k = 0; k < x->n; k++) write_rod(file, &x->rod[k]);
}

// -- the command ----------------------------------------------------------------------------------

// Where the tips of modal bodies are.
static void print_modal(bough_simulation *s) {
    bough_simulation_update(s);
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        if (beam->modal == NULL) continue;
        int n = beam->def.n_segment;
        bough_quaternion p, undeformed = bough_quaternion_conjugate(beam->def.rotation[n]);
        bough_vec3 x = bough_simulation_beam_tip(s, beam, &p);
        bough_vec3 u = bough_sub(x, beam->def.position[n]);
        bough_vec3 r = bough_quaternion_logarithm(bough_quaternion_product(p, undeformed));
        r = bough_scale(180 / BOUGH_PI, r);
        printf("modal %s: tip moved by %.9g %.9g %.9g m, turned by %.9g %.9g %.9g deg\n", beam->body->name,
               u.x, u.y, u.z, r.x, r.y, r.z);
    }
}

bough_status bough_verb_static(bough_arena *arena, const bough_options *options) {
    bough_simulation *s;
    bough_status status = bough_open(arena, options, &s);
    if (bough_is_ok(&status)) status = bough_simulation_known(s, "it has no equilibrium");
    if (!bough_is_ok(&status)) return status;
    if (s->n_rod == 0 && s->tree->n_v == 0) {
        return bough_fail(BOUGH_INVALID, "%.200s: no body of the scene can move or bend", s->scene->file);
    }
    const char *folder = bough_out_folder(arena, options);
    if (options->path) return bough_static_path(arena, s, folder);
    bough_static x;
    bough_mesh_error mesh;
    status = bough_static_find(arena, s, &x);
    if (!bough_is_ok(&status)) return status;
    const double *error = bough_static_mesh_error(arena, &x, &mesh);
    if (!x.apart) print_whole(&x);
    for (int k = 0; k < x.n; k++) {
        print_rod(&x.rod[k]);
        if (mesh.unknown[0] == '\0') print_mesh_error(&x.rod[k], error + BOUGH_STATIC_RESULTS * k);
    }
    print_modal(s);
    if (mesh.unknown[0]) printf("mesh error: not estimated: %s\n", mesh.unknown);
    status = bough_folder_make(folder);
    if (bough_is_ok(&status)) status = bough_folder_write(folder, "static.csv", write_rods, &x);
    if (bough_is_ok(&status) && !x.apart) status = write_channels(&x, &mesh, folder);
    if (bough_is_ok(&status)) printf("out: %s\n", folder);
    return status;
}
