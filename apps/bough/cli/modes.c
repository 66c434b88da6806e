// bough modes: frequencies, damping and shapes of the whole scene (modes_whole.c), or of each rod,
// clamped at its root, about equilibrium at rest or in steady rotation.
#include "apps/bough/cli/modes.h"
#include "apps/bough/analysis/steady.h"
#include "apps/bough/analysis/vibration.h"
#include "apps/bough/results/folder.h"
#include "flexbody/rod/rod_modes.h"

// One rod and what was found.
typedef struct rod_modes {
    bough_steady steady;
    bough_turning turning;
    bough_rod_mode_list list;
} rod_modes;

static const char *const directions[BOUGH_ROD_DIRECTIONS] = {
    [BOUGH_ROD_FLAP] = "flap",
    [BOUGH_ROD_EDGE] = "edge",
    [BOUGH_ROD_AXIAL] = "axial",
    [BOUGH_ROD_TORSION] = "torsion",
};

static const double unstable = -1e-6; // damping ratios below it are no rounding

// -- table ----------------------------------------------------------------------------------------

static void print_head(const rod_modes *x) {
    const bough_rod_model *m = x->steady.model;
    printf("rod %s: %d segments, %.9g m, root held", m->name, m->n, m->span[m->n]);
    if (x->turning.speed != 0) {
        bough_vec3 a = x->turning.axis;
        printf(", turning at %.9g rpm about (%.6g, %.6g, %.6g), seen from the rotating frame; gravity "
               "in the mean of a turn",
               x->turning.speed * 30 / BOUGH_PI, a.x, a.y, a.z);
    }
    printf("\n%4s %12s %12s %11s  %-8s %7s %7s %7s %7s\n", "mode", "frequency", "damped", "damping", "shape",
           "flap", "edge", "axial", "torsion");
    printf("%4s %12s %12s %11s  %-8s %7s %7s %7s\n", "", "(Hz)", "(Hz)", "(%)", "", "x", "y", "z");
}

static void print_rod(const rod_modes *x) {
    print_head(x);
    for (int k = 0; k < x->list.found; k++) {
        const bough_rod_mode *m = &x->list.mode[k];
        printf("%4d %12.6g %12.6g %11.5f  %-8s", k + 1, m->frequency, m->damped_frequency, 100 * m->damping,
               directions[m->dominant]);
        for (int c = 0; c < BOUGH_ROD_DIRECTIONS; c++) printf(" %7.4f", m->share[c]);
        putchar('\n');
    }
    for (int k = 0; k < x->list.found; k++) {
        const bough_rod_mode *m = &x->list.mode[k];
        if (m->damping >= unstable) continue;
        printf("unstable %s: mode %d grows at %.6g /s\n", x->steady.model->name, k + 1,
               -m->damping * m->frequency * 2 * BOUGH_PI);
    }
}

// -- files ----------------------------------------------------------------------------------------

static void write_modes(FILE *file, const rod_modes *x) {
    for (int k = 0; k < x->list.found; k++) {
        const bough_rod_mode *m = &x->list.mode[k];
        fprintf(file, "%s,%d,%.10g,%.10g,%.10g,%s", x->steady.model->name, k + 1, m->frequency,
                m->damped_frequency, m->damping, directions[m->dominant]);
        for (int c = 0; c < BOUGH_ROD_DIRECTIONS; c++) fprintf(file, ",%.6g", m->share[c]);
        fputc('\n', file);
    }
}

static void write_shapes(FILE *file, const rod_modes *x) {
    const bough_rod_model *m = x->steady.model;
    for (int k = 0; k < x->list.found; k++) {
        const bough_rod_mode *mode = &x->list.mode[k];
        const double *const part[2] = {mode->real, mode->imaginary};
        for (int i = 0; i <= m->n; i++) { // vertex 0 is held
            fprintf(file, "%s,%d,%.10g", m->name, k + 1, m->span[i]);
            for (int c = 0; c < 12; c++) {
                double value = i == 0 ? 0 : part[c / 6][(c % 6) * m->n + i - 1];
                fprintf(file, ",%.10g", value);
            }
            fputc('\n', file);
        }
    }
}

typedef struct table {
    const char *name, *header;
    void (*write)(FILE *file, const rod_modes *x);
} table;

static const table tables[] = {
    {"modes.csv",
     "rod,mode,frequency (Hz),damped frequency (Hz),damping ratio (-),shape,flap x (-),edge y (-),"
     "axial z (-),torsion (-)\n",
     write_modes},
    {"shapes.csv",
     "rod,mode,span (m),ux (m),uy (m),uz (m),rx (rad),ry (rad),rz (rad),imaginary ux (m),"
     "imaginary uy (m),imaginary uz (m),imaginary rx (rad),imaginary ry (rad),imaginary rz (rad)\n",
     write_shapes},
};

static bough_status write_table(const table *t, const char *folder, const rod_modes *rods, int n) {
    char path[BOUGH_PATH_MAX];
    FILE *file = NULL;
    bough_status status = bough_folder_open(folder, t->name, path, &file);
    if (!bough_is_ok(&status)) return status;
    fputs(t->header, file);
    for (int k = 0; k < n; k++) t->write(file, &rods[k]);
    return bough_folder_commit(path, file);
}

// -- the command ----------------------------------------------------------------------------------

static bough_status solve(bough_arena *arena, const bough_simulation *s, const bough_beam *beam,
                          rod_modes *x) {
    x->list.wanted = s->scene->modes.count;
    bough_status status = bough_steady_turning(s, beam, &x->turning);
    if (bough_is_ok(&status)) {
        status = bough_steady_find(arena, s, beam, &x->turning, &x->steady);
    }
    if (!bough_is_ok(&status)) return status;
    return bough_rod_modes(arena, x->steady.model, &x->steady.work, x->steady.input, x->steady.state,
                           &x->list);
}

static bough_status solve_all(bough_arena *arena, const bough_simulation *s, rod_modes *rods) {
    int n = 0;
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].rod == NULL) continue;
        bough_status status = solve(arena, s, &s->beam[k], &rods[n]);
        if (!bough_is_ok(&status)) return status;
        print_rod(&rods[n++]);
    }
    return bough_ok();
}

typedef struct modes_options {
    bough_options common;
    bough_texts sweep; // "key=value, value, ..."
} modes_options;

static const bough_option rows[] = {
    BOUGH_OPTION_SET,
    BOUGH_OPTION_OUT,
    {"sweep", "KEY=V1, V2, ...", "modes over operating points; the values of several --sweep vary together",
     bough_option_texts, offsetof(modes_options, sweep), true},
    {0},
};

static bough_status find(bough_arena *arena, const void *given) {
    const modes_options *own = given;
    const bough_options *options = &own->common;
    if (own->sweep.n > 0) return bough_modes_sweep(arena, options, &own->sweep);
    bough_simulation *s;
    bough_status status = bough_open(arena, options, &s);
    if (bough_is_ok(&status)) status = bough_simulation_known(s, "it has no modes");
    if (!bough_is_ok(&status)) return status;
    if (bough_vibration_wanted(s)) return bough_modes_whole(arena, options, s);
    if (bough_steady_rods(s) == 0) {
        return bough_fail(BOUGH_INVALID, "%.200s: no body has fidelity rod", s->scene->file);
    }
    const char *folder = bough_out_folder(arena, options);
    rod_modes *rods = bough_arena_take(arena, (size_t)s->n_rod * sizeof *rods);
    status = solve_all(arena, s, rods);
    if (bough_is_ok(&status)) status = bough_folder_make(folder);
    for (int k = 0; k <= (s->scene->modes.shapes ? 1 : 0) && bough_is_ok(&status); k++) {
        status = write_table(&tables[k], folder, rods, bough_steady_rods(s));
    }
    if (bough_is_ok(&status)) printf("out: %s\n", folder);
    return status;
}

const bough_command bough_command_modes = {
    .name = "modes",
    .summary = "computes frequencies, damping and shapes of the whole scene or of each rod, at rest or "
               "rotating",
    .operand = BOUGH_OPERAND_REQUIRED,
    .operand_name = "SCENE",
    .option = rows,
    .size = sizeof(modes_options),
    .run = find,
};
