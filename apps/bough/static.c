// bough static: the shape of each rod at rest under gravity and the scene's loads.
#include "apps/bough/open.h"
#include "apps/bough/verb.h"
#include "apps/output/folder.h"
#include "apps/scene/steady.h"

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

static void print_three(const char *what, const double *v, const char *unit) {
    printf("%s %.7g %.7g %.7g %s", what, v[0], v[1], v[2], unit);
}

static void print_rod(bough_steady *x) {
    const bough_rod_model *m = x->model;
    double value[MOTION];
    printf("rod %s: %d segments, %.9g m, %d iterations\n", m->name, m->n, m->span[m->n],
           x->work.iterations);
    printf("%10s %12s %12s %12s %12s %12s %12s\n", "span", "ux", "uy", "uz", "rx", "ry", "rz");
    printf("%10s %12s %12s %12s %12s %12s %12s\n", "(m)", "(m)", "(m)", "(m)", "(deg)", "(deg)",
           "(deg)");
    for (int i = 0; i <= m->n; i++) {
        motion_of(x, i, value);
        print_row(m->span[i], value);
    }
    printf("%10s %12s %12s %12s %12s %12s %12s\n", "middle", "shear x", "shear y", "axial",
           "bend x", "bend y", "twist");
    printf("%10s %12s %12s %12s %12s %12s %12s\n", "(m)", "(N)", "(N)", "(N)", "(N m)", "(N m)",
           "(N m)");
    for (int n = 0; n < m->n; n++) {
        stress_of(x, n, value);
        print_row(middle_of(x, n), value);
    }
    motion_of(x, m->n, value);
    printf("tip %s:", m->name);
    print_three(" u", value, "m,");
    print_three(" r", value + 3, "deg\n");
    bough_rod_root_wrench(m, &x->work.scaled, 0, x->state, x->input, &x->work.scratch, value);
    printf("root %s:", m->name);
    print_three(" force", value, "N,");
    print_three(" moment", value + 3, "N m\n");
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
    for (int i = 0; i <= m->n; i++) {
        fputs(m->name, file);
        motion_of(x, i, value);
        write_values(file, m->span[i], value);
        if (i < m->n) {
            stress_of(x, i, value);
            write_values(file, middle_of(x, i), value);
        } else {
            fputs(",,,,,,,", file);
        }
        fputc('\n', file);
    }
}

static bough_status write_file(const char *folder, const bough_steady *steady, int n) {
    char path[BOUGH_PATH_MAX];
    FILE *file = NULL;
    bough_status status = bough_folder_make(folder);
    if (bough_is_ok(&status)) status = bough_folder_path(folder, "static.csv", path);
    if (bough_is_ok(&status)) status = bough_folder_open_partial(path, &file);
    if (!bough_is_ok(&status)) return status;
    fputs(header, file);
    for (int k = 0; k < n; k++) write_rod(file, &steady[k]);
    return bough_folder_commit(path, file);
}

// -- the command ----------------------------------------------------------------------------------

static bough_status check_rods(const bough_simulation *s) {
    if (s->n_rod == 0) {
        return bough_fail(BOUGH_INVALID, "%.200s: no body has fidelity rod", s->scene->file);
    }
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].rod == NULL) continue;
        const bough_scene_body *mover = bough_beam_mover(s, &s->beam[k]);
        if (mover == NULL) continue;
        return bough_fail(BOUGH_INVALID, "rod %s: the joint of '%s' moves; static equilibrium of"
                          " moving trees is not built yet: make that joint fixed",
                          s->beam[k].body->name, mover->name);
    }
    return bough_ok();
}

bough_status bough_verb_static(bough_arena *arena, const bough_options *options) {
    const bough_turning rest = {0};
    bough_simulation *s;
    bough_status status = bough_open(arena, options, &s);
    if (bough_is_ok(&status)) status = check_rods(s);
    if (!bough_is_ok(&status)) return status;
    const char *folder = bough_out_folder(arena, options);
    bough_steady *steady = bough_arena_take(arena, (size_t)s->n_rod * sizeof *steady);
    if (!steady || !folder) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    int n = 0;
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].rod == NULL) continue;
        status = bough_steady_find(arena, s, &s->beam[k], &rest, &steady[n]);
        if (!bough_is_ok(&status)) return status;
        print_rod(&steady[n++]);
    }
    status = write_file(folder, steady, n);
    if (bough_is_ok(&status)) printf("out: %s\n", folder);
    return status;
}
