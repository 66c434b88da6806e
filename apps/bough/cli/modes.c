// bough modes: frequencies, damping and shapes of the whole scene, or of each rod, clamped at its root, about
// equilibrium at rest or in steady rotation.
#include "apps/bough/analysis/state_space.h"
#include "apps/bough/analysis/steady.h"
#include "apps/bough/cli/modes_internal.h"
#include "apps/bough/results/folder.h"
#include "apps/bough/results/summary.h"

static const double unstable = 1e-6; // relative to |λ|: smaller growth is rounding
static const double fine = 0.01;     // residuals and changes by another mesh that need no warning

static const char *const blade_shapes[BOUGH_ROD_DIRECTIONS] = {
    [BOUGH_ROD_FLAP] = "flap",
    [BOUGH_ROD_EDGE] = "edge",
    [BOUGH_ROD_AXIAL] = "axial",
    [BOUGH_ROD_TORSION] = "torsion",
};

// Head of shapes.csv after the first column.
static const char shape_columns[] =
    "mode,span (m),ux (m),uy (m),uz (m),rx (rad),ry (rad),rz (rad),imaginary ux (m),imaginary uy (m),"
    "imaginary uz (m),imaginary rx (rad),imaginary ry (rad),imaginary rz (rad)\n";

// -- each rod, clamped at its root ----------------------------------------------------------------

// A rod in its steady state, and its modes.
typedef struct rod_modes {
    bough_steady steady;
    bough_turning turning;
    bough_rod_mode_list list;
} rod_modes;

typedef struct rod_list {
    int n;
    rod_modes *rod; // (n)
} rod_list;

// -- table ----------------------------------------------------------------------------------------

// −Re λ over the damped frequency; NaN of a motion that does not oscillate.
static double decrement(double frequency, double damped_frequency, double damping) {
    return damped_frequency > 0 ? 2 * BOUGH_PI * frequency * damping / damped_frequency : (double)NAN;
}

void bough_modes_print_value(double frequency, double damped_frequency, double damping) {
    double ratio = decrement(frequency, damped_frequency, damping);
    printf(" %12.6g %12.6g %11.5f", frequency, damped_frequency, 100 * damping);
    if (isnan(ratio))
        printf(" %11s  ", "-");
    else
        printf(" %11.5f  ", ratio);
}

void bough_modes_write_value(FILE *file, double frequency, double damped_frequency, double damping) {
    fprintf(file, ",%.10g,%.10g,%.10g,%.10g", frequency, damped_frequency, damping,
            decrement(frequency, damped_frequency, damping));
}

static void print_rod_head(const rod_modes *x) {
    const bough_rod_model *m = x->steady.model;
    printf("rod %s: %d segments, %.9g m, root held", m->name, m->n, m->span[m->n]);
    if (x->turning.speed != 0) {
        bough_vec3 a = x->turning.axis;
        printf(", turning at %.9g rpm about (%.6g, %.6g, %.6g), seen from the rotating frame; gravity "
               "averaged over a revolution",
               x->turning.speed / BOUGH_RPM, a.x, a.y, a.z);
    }
    printf("\n%4s %12s %12s %11s %11s  %-8s %7s %7s %7s %7s\n", "mode", "frequency", "damped", "damping",
           "decrement", "shape", "flap", "edge", "axial", "torsion");
    printf("%4s %12s %12s %11s %11s  %-8s %7s %7s %7s\n", "", "(Hz)", "(Hz)", "(%)", "(-)", "", "x", "y",
           "z");
}

static void print_rod(const rod_modes *x) {
    print_rod_head(x);
    for (int k = 0; k < x->list.found; k++) {
        const bough_rod_mode *m = &x->list.mode[k];
        printf("%4d", k + 1);
        bough_modes_print_value(m->frequency, m->damped_frequency, m->damping);
        printf("%-8s", blade_shapes[m->dominant]);
        for (int c = 0; c < BOUGH_ROD_DIRECTIONS; c++) printf(" %7.4f", m->share[c]);
        putchar('\n');
    }
    for (int k = 0; k < x->list.found; k++) {
        const bough_rod_mode *m = &x->list.mode[k];
        if (m->damping >= -unstable) continue;
        printf("unstable %s: mode %d grows at %.6g /s\n", x->steady.model->name, k + 1,
               -m->damping * m->frequency * 2 * BOUGH_PI);
    }
}

static void write_rod_modes(const void *self, FILE *file) {
    const rod_list *rods = self;
    fputs(
        "rod,mode,frequency (Hz),damped frequency (Hz),damping ratio (-),decrement (-),shape,flap x (-),edge y (-),"
        "axial z (-),torsion (-)\n",
        file);
    for (const rod_modes *x = rods->rod; x < rods->rod + rods->n; x++) {
        for (int k = 0; k < x->list.found; k++) {
            const bough_rod_mode *m = &x->list.mode[k];
            fprintf(file, "%s,%d", x->steady.model->name, k + 1);
            bough_modes_write_value(file, m->frequency, m->damped_frequency, m->damping);
            fprintf(file, ",%s", blade_shapes[m->dominant]);
            for (int c = 0; c < BOUGH_ROD_DIRECTIONS; c++) fprintf(file, ",%.6g", m->share[c]);
            fputc('\n', file);
        }
    }
}

static void write_rod_shapes(const void *self, FILE *file) {
    const rod_list *rods = self;
    fprintf(file, "rod,%s", shape_columns);
    for (const rod_modes *x = rods->rod; x < rods->rod + rods->n; x++) {
        const bough_rod_model *m = x->steady.model;
        for (int row = 0; row < x->list.found * (m->n + 1); row++) {
            int k = row / (m->n + 1), i = row % (m->n + 1); // vertex 0 is held
            const double *const part[2] = {x->list.mode[k].real, x->list.mode[k].imaginary};
            fprintf(file, "%s,%d,%.10g", m->name, k + 1, m->span[i]);
            for (int c = 0; c < 12; c++)
                fprintf(file, ",%.10g", i == 0 ? 0 : part[c / 6][(c % 6) * m->n + i - 1]);
            fputc('\n', file);
        }
    }
}

static bough_status solve_rod(bough_arena *arena, const bough_simulation *s, const bough_beam *beam,
                              rod_modes *x) {
    x->list.wanted = s->scene->modes.count;
    BOUGH_TRY(bough_steady_turning(s, beam, &x->turning));
    BOUGH_TRY(bough_steady_find(arena, s, beam, &x->turning, &x->steady));
    return bough_rod_modes(arena, x->steady.model, &x->steady.work, x->steady.input, x->steady.state,
                           &x->list);
}

static bough_status solve_rods(bough_arena *arena, const bough_simulation *s, rod_modes *rods) {
    int n = 0;
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].rod == NULL) continue;
        BOUGH_TRY(solve_rod(arena, s, &s->beam[k], &rods[n]));
        print_rod(&rods[n++]);
    }
    return bough_ok();
}

// -- the whole scene ------------------------------------------------------------------------------

// Directions are those of the body's axes for rods, of the ground's axes for rigid bodies.
const char *bough_modes_shape(const bough_simulation *s, const bough_scene_mode *mode) {
    static const char *const rod[] = {"x", "y", "z", "torsion"};
    static const char *const rigid[] = {"x", "y", "z", "turn"};
    const bough_beam *beam = bough_simulation_beam(s, mode->body);
    if (beam == NULL || beam->port < 0) return rigid[mode->direction];
    bool is_blade = mode->blades || bough_scene_blade(s->scene, mode->body) >= 0;
    return (is_blade ? blade_shapes : rod)[mode->direction];
}

const char *bough_modes_body(const bough_simulation *s, const bough_scene_mode *mode) {
    return mode->blades ? "blades" : s->scene->body[mode->body].name;
}

bool bough_modes_rotor_is_free(const bough_simulation *s) {
    if (s->scene->turbine.node == NULL) return false;
    const bough_scene_joint *joint = &s->scene->body[s->scene->turbine.rotor].joint;
    return joint->spring.stiffness == 0 && joint->motion[0].node == NULL;
}

// Whether all blades move alike in their plane, or the hub rotates: against each other if the rotor is free,
// otherwise against its support.
static bool turns_rotor(const bough_scene_mode *mode) {
    enum { TURN = 3 };
    if (mode->pattern != BOUGH_PATTERN_COLLECTIVE) return false;
    return mode->direction == (mode->blades ? BOUGH_ROD_EDGE : TURN);
}

// -- table ----------------------------------------------------------------------------------------

static void print_head(const bough_simulation *s, const bough_vibration *v) {
    printf("whole scene: %d states, about %s", s->master->assembly->n_state,
           s->scene->modes.at == BOUGH_SCENE_IN_EQUILIBRIUM ? "equilibrium" : "its initial state");
    if (v->spin != 0) printf(", rotor at %.6g rpm", v->spin / BOUGH_RPM);
    if (v->frozen) printf(", at the present azimuth, rotating bodies as seen in their own axes");
    if (v->spin != 0 && v->n_blade > 0) printf(", seen by an observer at rest");
    if (bough_modes_rotor_is_free(s)) printf(", rotor free to turn");
    static const char *const air[] = {"do not follow", "follow at once", "follow in time"};
    if (s->aero) printf("; the air's forces %s", air[s->scene->modes.air]);
    if (v->n_azimuth > 1) printf(", in the mean over %d azimuths", v->n_azimuth);
    bool by_azimuth = v->n_azimuth > 1;
    printf("\n%4s %12s %12s %11s %11s  ", "mode", "frequency", "damped", "damping", "decrement");
    printf("%s%-12s %s", by_azimuth ? "azimuth   " : "", "body", "shape");
    if (v->n_blade > 0) printf("    %-12s %8s %8s %8s", "pattern", "collect.", "forward", "backward");
    printf("\n%4s %12s %12s %11s %11s%s\n", "", "(Hz)", "(Hz)", "(%)", "(-)", by_azimuth ? "  (+-%)" : "");
}

static double largest_residual(const bough_vibration *v) {
    double largest = 0;
    for (int k = 0; k < v->found; k++) largest = fmax(largest, v->mode[k].residual);
    return largest;
}

// Chooses modes to be listed.
typedef bool mode_choice(const bough_scene_mode *mode);
static bool is_inexact(const bough_scene_mode *mode) { return mode->residual > fine; }
static bool is_moved(const bough_scene_mode *mode) { return mode->moved > fine && !isinf(mode->moved); }

// Whether the damping at one azimuth differs from the mean by its own value, or is unknown without a left
// vector.
static bool is_of_azimuth(const bough_scene_mode *mode) {
    return isnan(mode->damping_change) || mode->damping_change >= fabs(mode->damping);
}

static bool print_numbers(const char *head, const bough_vibration *v, mode_choice *chosen) {
    int n = 0;
    for (int k = 0; k < v->found; k++)
        if (chosen(&v->mode[k])) printf("%s %d", n++ == 0 ? head : ",", k + 1);
    if (n > 0) printf("\n");
    return n > 0;
}

// Prints how many of the wanted modes are missing and why, and the accuracy of the others.
static void print_search(const bough_vibration *v) {
    bool converged = v->count.converged >= v->count.wanted;
    if (v->found < v->asked && converged)
        printf("%d of the %d modes asked for: the scene has no others that oscillate or grow\n", v->found,
               v->asked);
    if (v->found < v->asked && !converged)
        printf("%d of the %d modes asked for: the iteration converges for no more than %d eigenvalues\n",
               v->found, v->asked, v->count.converged);
    if (v->found == v->asked && !converged && v->count.converged < v->asked)
        printf("the highest modes are less exact: the iteration converges for no more than %d eigenvalues\n",
               v->count.converged);
    if (v->unpaired > 0)
        printf("%d eigenvectors are left out of the motion in the air: their left or right partner did not "
               "converge\n",
               v->unpaired);
    printf("largest residual of a mode: %.2g of its eigenvalue\n", largest_residual(v));
    print_numbers("warning: not exact, with a residual above 1 %: mode", v, is_inexact);
}

// Prints the largest changes over the azimuths.
static void print_azimuths(const bough_vibration *v) {
    double most = 0;
    if (v->n_azimuth == 1) return;
    for (int k = 0; k < v->found; k++) most = fmax(most, v->mode[k].frequency_change);
    printf("over the azimuths no frequency changes by more than %.2g %%\n", 100 * most);
    print_numbers(
        "warning: over the azimuths the damping changes by as much as its own value, or by an unknown amount: mode",
        v, is_of_azimuth);
}

static bool is_not_compared(const bough_scene_mode *mode) { return isnan(mode->moved); }
static bool is_alone(const bough_scene_mode *mode) { return isinf(mode->moved); }

static void print_mesh(const bough_vibration *v) {
    double most = -1; // of those that have a partner
    for (int k = 0; k < v->found; k++)
        if (!is_alone(&v->mode[k])) most = fmax(most, v->mode[k].moved);
    bool changed =
        print_numbers("warning: changed by more than 1 % with half the segments: mode", v, is_moved);
    if (print_numbers("warning: not found with half the segments: mode", v, is_alone)) changed = true;
    if (!changed && most >= 0)
        printf("no mode changes by more than %.2g %% with half the segments\n", 100 * most);
    print_numbers("not compared with half the segments: mode", v, is_not_compared);
}

static void print_modes(const bough_simulation *s, const bough_vibration *v) {
    print_head(s, v);
    for (int k = 0; k < v->found; k++) {
        const bough_scene_mode *m = &v->mode[k];
        printf("%4d", k + 1);
        bough_modes_print_value(m->frequency, m->damped_frequency, m->damping);
        if (v->n_azimuth > 1) printf("%-9.2g ", 100 * m->damping_change);
        printf("%-12s %-8s", bough_modes_body(s, m), bough_modes_shape(s, m));
        if (v->n_blade > 0) printf(" %-12s", bough_pattern_names[m->pattern]);
        for (int c = 0; v->n_blade > 0 && c < 3; c++) printf(" %8.4f", m->whirl[c]);
        if (bough_modes_rotor_is_free(s) && turns_rotor(m)) printf("  free rotor");
        putchar('\n');
    }
    print_search(v);
    print_azimuths(v);
    for (int k = 0; k < v->found; k++) {
        const bough_scene_mode *m = &v->mode[k];
        if (m->growth <= fmax(unstable, m->residual) * 2 * BOUGH_PI * m->frequency) continue;
        printf(
            "unstable: mode %d grows at %.6g /s%s\n", k + 1, m->growth,
            m->damped_frequency == 0 && s->aero && bough_modes_rotor_is_free(s)
                ? " without oscillation: the rotor runs away where the torque of the air grows with its speed (at one azimuth also by its weight); generator torque and pitch are held"
                : "");
    }
}

// -- files ----------------------------------------------------------------------------------------

typedef struct solution {
    const bough_simulation *simulation;
    const bough_vibration *found;
} solution;

static void write_modes(const void *self, FILE *file) {
    const solution *x = self;
    const bough_simulation *s = x->simulation;
    const bough_vibration *v = x->found;
    int n_body = s->scene->n_body;
    fputs(
        "mode,frequency (Hz),damped frequency (Hz),damping ratio (-),decrement (-),residual (-),change by "
        "mesh (-),change of frequency over azimuths (-),change of damping ratio over azimuths (-),body,shape,pattern,collective (-),forward (-),backward (-)",
        file);
    for (int i = 0; i < n_body; i++) fprintf(file, ",%s (-)", s->scene->body[i].name);
    fputc('\n', file);
    for (int k = 0; k < v->found; k++) {
        const bough_scene_mode *m = &v->mode[k];
        fprintf(file, "%d", k + 1);
        bough_modes_write_value(file, m->frequency, m->damped_frequency, m->damping);
        fprintf(file, ",%.2g,%.2g,%.2g,%.2g", m->residual, m->moved, m->frequency_change, m->damping_change);
        fprintf(file, ",%s,%s,%s", bough_modes_body(s, m), bough_modes_shape(s, m),
                bough_pattern_names[m->pattern]);
        for (int c = 0; c < 3; c++) fprintf(file, ",%.6g", m->whirl[c]);
        for (int i = 0; i < n_body; i++) fprintf(file, ",%.6g", m->share[i]);
        fputc('\n', file);
    }
}

static void write_shapes(const void *self, FILE *file) {
    const solution *x = self;
    const bough_simulation *s = x->simulation;
    const bough_vibration *v = x->found;
    fprintf(file, "body,%s", shape_columns);
    for (int k = 0; k < v->found; k++) {
        for (int i = 0; i < v->n_row; i++) {
            const bough_shape_row *row = &v->mode[k].shape[i];
            fprintf(file, "%s,%d,%.10g", s->scene->body[row->body].name, k + 1, row->span);
            for (int c = 0; c < 12; c++) fprintf(file, ",%.10g", row->motion[c / 6][c % 6]);
            fputc('\n', file);
        }
    }
}

static void add_dependence(bough_summary *s, const bough_modes_dependence *x) {
    bough_summary_object(s, "sensitivity");
    bough_summary_integer(s, "mode", x->mode + 1);
    bough_summary_array(s, "parameters");
    for (int i = 0; i < x->of.n; i++) {
        bough_summary_object(s, NULL);
        bough_summary_text(s, "name", x->of.list[i].name);
        bough_summary_text(s, "by", x->of.list[i].by);
        bough_summary_number(s, "frequency", x->of.list[i].frequency);
        bough_summary_number(s, "damping", x->of.list[i].damping);
        bough_summary_end(s);
    }
    bough_summary_end(s);
    bough_summary_end(s);
}

static bough_status write_search(const bough_vibration *v, const bough_modes_dependence *dependence,
                                 const char *folder) {
    bough_summary s;
    BOUGH_TRY(bough_summary_open(&s, folder, "modes.json"));
    bough_summary_integer(&s, "modes_asked", v->asked);
    bough_summary_integer(&s, "modes_found", v->found);
    bough_summary_integer(&s, "eigenvalues_sought", v->count.wanted);
    bough_summary_integer(&s, "eigenvalues_converged", v->count.converged);
    bough_summary_integer(&s, "eigenvectors_unpaired", v->unpaired);
    bough_summary_number(&s, "largest_residual", largest_residual(v));
    bough_summary_integer(&s, "azimuths", v->n_azimuth);
    if (dependence->mode >= 0) add_dependence(&s, dependence);
    return bough_summary_close(&s);
}

// -- the linear state space -----------------------------------------------------------------------

// Either a matrix or a list of names.
typedef struct content {
    const char *name;
    int rows, columns;
    const double *matrix;
    const bough_signal_name *list; // (rows)
} content;

static void write_matrix(const void *self, FILE *file) {
    const content *x = self;
    long entries = 0, all = (long)x->rows * x->columns;
    for (long k = 0; k < all; k++) entries += x->matrix[k] != 0;
    fprintf(file, "%%%%MatrixMarket matrix coordinate real general\n%d %d %ld\n", x->rows, x->columns,
            entries);
    for (long k = 0; k < all; k++) {
        if (x->matrix[k] == 0) continue;
        fprintf(file, "%ld %ld %.12g\n", k % x->rows + 1, k / x->rows + 1, x->matrix[k]);
    }
}

static void write_list(const void *self, FILE *file) {
    const content *x = self;
    fputs("number,name,unit,value\n", file);
    for (int k = 0; k < x->rows; k++)
        fprintf(file, "%d,\"%s\",%s,%.12g\n", k + 1, x->list[k].name, x->list[k].unit, x->list[k].value);
}

// Writes A.mtx to D.mtx (Matrix Market, coordinates of the entries that are not 0) and states.csv,
// inputs.csv and outputs.csv, row k of which names row or column k of the matrices.
static bough_status write_linear(bough_arena *arena, bough_simulation *s, double time, const char *folder) {
    bough_state_space x;
    BOUGH_TRY(bough_state_space_find(arena, s, time, &x));
    const content contents[] = {
        {"A.mtx", x.n, x.n, x.a, NULL},
        {"B.mtx", x.n, x.n_input, x.b, NULL},
        {"C.mtx", x.n_output, x.n, x.c, NULL},
        {"D.mtx", x.n_output, x.n_input, x.d, NULL},
        {"states.csv", x.n, 1, NULL, x.state},
        {"inputs.csv", x.n_input, 1, NULL, x.input},
        {"outputs.csv", x.n_output, 1, NULL, x.output},
    };
    for (int k = 0; k < 7; k++) {
        const content *c = &contents[k];
        BOUGH_TRY(bough_folder_write(folder, c->name, c->matrix ? write_matrix : write_list, c));
    }
    printf("linear system: %d states, %d inputs, %d outputs\n", x.n, x.n_input, x.n_output);
    return bough_ok();
}

static bough_status find_whole(bough_arena *arena, const bough_options *options, bough_simulation *s,
                               const char *sensitivity) {
    bough_vibration v;
    const char *folder = bough_out_folder(arena, options);
    if (s->master->assembly->n_state == 0) {
        return bough_fail(BOUGH_INVALID, "%.200s: no body of the scene can move or bend", s->scene->file);
    }
    BOUGH_TRY(bough_vibration_find(arena, s, s->scene->modes.count, &v));
    const solution x = {s, &v};
    print_modes(s, &v);
    bool compared;
    bough_status status = bough_vibration_compare(arena, s, &v, &compared);
    if (!bough_is_ok(&status)) printf("no modes of another mesh: %s\n", status.message);
    if (bough_is_ok(&status) && compared) print_mesh(&v);
    BOUGH_TRY(bough_folder_write(folder, "modes.csv", write_modes, &x));
    if (s->scene->modes.shapes) BOUGH_TRY(bough_folder_write(folder, "shapes.csv", write_shapes, &x));
    if (s->scene->modes.linear) BOUGH_TRY(write_linear(arena, s, v.time, folder));
    bough_modes_dependence dependence = {.mode = -1};
    status = bough_ok();
    if (sensitivity) status = bough_modes_sensitivity(arena, s, &v, sensitivity, folder, &dependence);
    BOUGH_TRY(write_search(&v, &dependence, folder));
    if (!bough_is_ok(&status)) return status;
    printf("out: %s\n", folder);
    return bough_ok();
}

// -- the command ----------------------------------------------------------------------------------

typedef struct modes_options {
    bough_options common;
    bough_texts sweep;       // "key=value, value, ..."
    bool until;              // unstable
    const char *sensitivity; // of this mode; NULL: not wanted
} modes_options;

static bough_status read_until(const bough_option *row, const char *text, void *field) {
    *(bool *)field = true;
    if (strcmp(text, "unstable") == 0) return bough_ok();
    return bough_fail(BOUGH_INVALID, "--%s expects unstable, got '%.80s'", row->name, text);
}

static const bough_option rows[] = {
    BOUGH_OPTION_SET,
    BOUGH_OPTION_OUT,
    {"until", "unstable",
     "ends the sweep where an oscillation or a divergence begins to grow, and finds that place", read_until,
     .offset = offsetof(modes_options, until)},
    {"sweep", "KEY=V1, V2, ...", "modes over operating points; the values of several --sweep vary together",
     bough_option_texts, .offset = offsetof(modes_options, sweep)},
    {"sensitivity", "MODE",
     "parameters that change a mode most; MODE: its number or words of its row, such as 'edge forward'",
     bough_option_text, .offset = offsetof(modes_options, sensitivity)},
    {0},
};

static bough_status find(bough_arena *arena, const void *given) {
    const modes_options *own = given;
    const bough_options *options = &own->common;
    if (own->sweep.n > 0 && own->sensitivity)
        return bough_fail(BOUGH_INVALID, "--sensitivity belongs to one operating point: leave out --sweep");
    if (own->sweep.n > 0) return bough_modes_sweep(arena, options, &own->sweep, own->until);
    if (own->until) return bough_fail(BOUGH_INVALID, "--until unstable needs a --sweep");
    bough_simulation *s;
    BOUGH_TRY(bough_open(arena, options, &s));
    BOUGH_TRY(bough_simulation_known(s, "it has no modes"));
    if (bough_vibration_wanted(s)) return find_whole(arena, options, s, own->sensitivity);
    if (own->sensitivity)
        return bough_fail(BOUGH_INVALID, "--sensitivity needs modes of the whole scene: modes.of: scene");
    if (bough_steady_rods(s) == 0) {
        return bough_scene_blame(bough_node_find(s->scene->modes.node, "of"), "modes.of",
                                 bough_fail(BOUGH_INVALID, "no body has fidelity rod"));
    }
    const char *folder = bough_out_folder(arena, options);
    rod_list rods = {bough_steady_rods(s), bough_arena_take(arena, (size_t)s->n_rod * sizeof *rods.rod)};
    BOUGH_TRY(solve_rods(arena, s, rods.rod));
    BOUGH_TRY(bough_folder_write(folder, "modes.csv", write_rod_modes, &rods));
    if (s->scene->modes.shapes) BOUGH_TRY(bough_folder_write(folder, "shapes.csv", write_rod_shapes, &rods));
    printf("out: %s\n", folder);
    return bough_ok();
}

const bough_command bough_command_modes = {
    .name = "modes",
    .summary = "computes frequencies, damping and shapes of the whole scene or of each rod, at rest or "
               "rotating",
    .operands = "SCENE",
    .option = rows,
    .size = sizeof(modes_options),
    .run = find,
};
