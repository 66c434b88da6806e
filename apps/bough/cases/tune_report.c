// The results of tuning a scene: the table, the diagram and the settings.
#include "apps/bough/cases/tune.h"

#include "apps/bough/results/folder.h"
#include "apps/bough/results/picture.h"

// -- table ----------------------------------------------------------------------------------------

// The largest number of segments of any rod.
static int segments_of(const bough_tune_state *t, const bough_tune_settings *s) {
    int most = 0;
    for (int i = 0; i < t->scene->n_body; i++) {
        int n = bough_tune_segments(t->scene, i, s);
        if (n > most) most = n;
    }
    return most;
}

static void print_part(const bough_tune_point *p, int k, FILE *stream) {
    if (p->separate && p->part[k] > 0) {
        fprintf(stream, "  %7.1e", p->part[k]);
    } else {
        fputs("        -", stream);
    }
}

void bough_tune_print(const bough_tune_state *t, int k, FILE *stream) {
    if (k < 0) {
        fprintf(stream, "error to be met: %.3g of a channel's range (forces and moments: %.3g)\n", t->error,
                4 * t->error);
        fprintf(stream, "%3s  %-12s %-10s %8s %9s %8s %7s %8s %8s  %8s  %8s  %7s  %7s  %7s\n", "run",
                "scheme", "solver", "segments", "macro[ms]", "step[ms]", "rtol", "air[Hz]", "cpu[s]",
                "motion", "force", "mesh", "air", "time");
        return;
    }
    const bough_tune_point *p = &t->point[k];
    const bough_tune_settings *s = &p->settings;
    fprintf(stream, "%3d  %-12s %-10.10s %8d %9.4g %8.4g %7.1e %8.4g ", k + 1, bough_scheme_name(s->scheme),
            bough_integrator_name(s->solver), segments_of(t, s), 1e3 * s->macro_step,
            1e3 * bough_tune_step(s), s->rtol, s->rate);
    if (bough_tune_ended(p)) {
        fprintf(stream, "%8.3g  %8.1e  %8.1e", p->cpu, p->motion, p->force);
        for (int i = 0; i < 3; i++) print_part(p, i, stream);
        fputs(s->own ? "  as written\n" : "\n", stream);
    } else {
        fprintf(stream, "failed: %s\n", p->outcome.message);
    }
    fflush(stream);
}

static void write_table(const void *self, FILE *file) {
    const bough_tune_state *t = self;
    fputs(
        "run,scheme,solver,segments,macro_step [s],step [s],rtol,air [Hz],cpu [s],motion,force,channel,best,chosen\n",
        file);
    for (int k = 0; k < t->n; k++) {
        const bough_tune_point *p = &t->point[k];
        const bough_tune_settings *s = &p->settings;
        fprintf(file, "%d,%s,%s,%d,%.9g,%.9g,%.3g,%.9g,", k + 1, bough_scheme_name(s->scheme),
                bough_integrator_name(s->solver), segments_of(t, s), s->macro_step, bough_tune_step(s),
                s->rtol, s->rate);
        if (bough_tune_ended(p))
            fprintf(file, "%.6g,%.3g,%.3g,%s,", p->cpu, p->motion, p->force, p->channel);
        else
            fputs("failed,,,,", file);
        fprintf(file, "%s,%s\n", p->best ? "yes" : "no", k == t->chosen ? "yes" : "no");
    }
}

// -- picture --------------------------------------------------------------------------------------

// The Pareto front, from its fastest run to its most accurate.
static void add_front(bough_chart *chart, const bough_tune_state *t) {
    const bough_tune_point *next = NULL;
    bough_chart_add_line(chart, (bough_chart_line){.joined = true});
    for (double after = 0;; after = next->cpu) {
        next = NULL;
        for (int k = 0; k < t->n; k++) {
            const bough_tune_point *p = &t->point[k];
            if (p->best && bough_tune_ended(p) && p->cpu > after && (!next || p->cpu < next->cpu)) next = p;
        }
        if (!next) return;
        bough_chart_add(chart, (bough_chart_point){.x = next->error, .y = next->cpu});
    }
}

// Each run with its number, and a line at the error bound.
static void add_runs(bough_chart *chart, const bough_tune_state *t) {
    double least = HUGE_VAL, most = 0;
    for (int k = 0; k < t->n; k++) {
        const bough_tune_point *p = &t->point[k];
        if (!bough_tune_ended(p)) continue;
        const char *label =
            bough_arena_print(chart->arena, "%d%s", k + 1, p->settings.own ? " (as written)" : "");
        bough_chart_add_line(chart, (bough_chart_line){.colour = !p->best, .marked = true});
        bough_chart_add(chart,
                        (bough_chart_point){
                            .x = p->error, .y = p->cpu, .label = label, .size = k == t->chosen ? 1.5 : 1});
        least = fmin(least, p->cpu);
        most = fmax(most, p->cpu);
    }
    bough_chart_add_line(chart, (bough_chart_line){.colour = -1, .joined = true});
    bough_chart_add(chart, (bough_chart_point){.x = t->error, .y = least});
    bough_chart_add(chart, (bough_chart_point){.x = t->error, .y = most});
}

static bough_status draw(bough_arena *arena, void *self) {
    const bough_tune_state *t = self;
    const char *heading = bough_arena_print(arena, "CPU time of %.4g s [s]", t->options->span);
    bough_chart chart = bough_chart_start(arena, t->scene->title ? t->scene->title : t->scene->file, 1);
    bough_chart_add_panel(&chart, heading, "whole error over the range (forces and moments: a quarter)", true,
                          true);
    add_front(&chart, t);
    add_runs(&chart, t);
    return bough_folder_write(t->options->folder, "tune.svg", bough_chart_write, &chart);
}

// -- settings -------------------------------------------------------------------------------------

static void print_solver(const bough_tune_settings *s, FILE *stream) {
    fprintf(stream, "{solver: %s, rtol: %.2g", bough_integrator_name(s->solver), s->rtol);
    if (s->step > 0) fprintf(stream, ", step: %.4g ms", 1e3 * s->step);
    fputc('}', stream);
}

static const char *name_in_text(const bough_scene *scene, int body) {
    const bough_node *name = bough_node_find(scene->body[body].node, "name");
    return name && name->text ? name->text : scene->body[body].name;
}

// Whether the body is the first of its place in the text, with another number of segments than the scene's.
static bool has_new_mesh(const bough_tune_state *t, int body) {
    const bough_scene *s = t->scene;
    for (int i = 0; i < body; i++) {
        if (s->body[i].node == s->body[body].node) return false;
    }
    int n = bough_tune_segments(s, body, &t->point[t->chosen].settings);
    return n > 0 && n != s->body[body].rod.n_segment;
}

// As in a scene, or as words of a command line.
static void print_chosen(const bough_tune_state *t, bool words, FILE *stream) {
    const bough_tune_settings *s = &t->point[t->chosen].settings;
    bool whole = bough_scheme_at(s->scheme)->one_system;
    if (words) fprintf(stream, "# bough run %s", t->scene->file);
    for (int k = 0; words && k < t->options->n_set; k++) fprintf(stream, " --set '%s'", t->options->set[k]);
    fprintf(stream,
            words ? " --set 'simulation.macro_step=%.9g ms' --set 'simulation.coupling={scheme: %s}'"
                    " --set 'simulation.%s="
                  : "simulation:\n  macro_step: %.9g ms\n  coupling: {scheme: %s}\n  %s: ",
            1e3 * s->macro_step, bough_scheme_name(s->scheme), whole ? "master" : "micro");
    print_solver(s, stream);
    if (words) fputc('\'', stream);
    if (s->rate > 0)
        fprintf(stream, words ? " --set 'aero.rate=%.9g Hz'" : "\naero:\n  rate: %.9g Hz", s->rate);
    if (!words) fputc('\n', stream);
    for (int i = 0; i < t->scene->n_body; i++) {
        if (has_new_mesh(t, i))
            fprintf(stream, words ? " --set 'bodies[%s].rod.segments=%d'" : "# %s: rod: segments: %d\n",
                    name_in_text(t->scene, i), bough_tune_segments(t->scene, i, s));
    }
    if (words) fputc('\n', stream);
}

void bough_tune_print_settings(const void *self, FILE *stream) {
    const bough_tune_state *t = self;
    const bough_tune_point *p = &t->point[t->chosen];
    fprintf(stream, "# run %d: error %.2g (%s), forces %.2g; %.3g s of CPU for %.4g s\n", t->chosen + 1,
            p->motion, p->channel[0] ? p->channel : "-", p->force, p->cpu, t->options->span);
    if (p->settings.own) {
        fputs("# the settings of the scene as it is written\n", stream);
        return;
    }
    print_chosen(t, false, stream);
    print_chosen(t, true, stream);
}

bough_status bough_tune_write(bough_tune_state *t) {
    const char *folder = t->options->folder;
    BOUGH_TRY(bough_folder_write(folder, "tune.csv", write_table, t));
    BOUGH_TRY(bough_arena_use(draw, t));
    return bough_folder_write(folder, "tune.yaml", bough_tune_print_settings, t);
}
