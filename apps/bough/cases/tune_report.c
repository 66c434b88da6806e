// What a tuned scene's user gets: the table, the picture and the settings.
#include "apps/bough/cases/tune_internal.h"

#include "apps/bough/results/folder.h"
#include "apps/bough/results/picture.h"

#include <math.h>
#include <string.h>

// -- table ----------------------------------------------------------------------------------------

// The most of any rod.
static int segments_of(const bough_tune_state *t, const bough_tune_settings *s) {
    int most = 0;
    for (int i = 0; i < t->scene->n_body; i++) {
        int n = bough_tune_segments(t->scene, i, s);
        if (n > most) most = n;
    }
    return most;
}

static double longest_step(const bough_tune_settings *s) {
    return s->step > 0 ? fmin(s->step, s->macro_step) : s->macro_step;
}

static void print_share(const bough_tune_point *p, int k, FILE *stream) {
    if (p->shared && p->share[k] > 0) {
        fprintf(stream, "  %7.1e", p->share[k]);
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
            bough_integrator_name(s->solver), segments_of(t, s), 1e3 * s->macro_step, 1e3 * longest_step(s),
            s->rtol, s->rate);
    if (bough_tune_ended(p)) {
        fprintf(stream, "%8.3g  %8.1e  %8.1e", p->cpu, p->motion, p->force);
        for (int i = 0; i < 3; i++) print_share(p, i, stream);
        fputs(s->own ? "  as written\n" : "\n", stream);
    } else {
        fprintf(stream, "failed: %.120s\n", p->outcome.message);
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
                bough_integrator_name(s->solver), segments_of(t, s), s->macro_step, longest_step(s), s->rtol,
                s->rate);
        if (bough_tune_ended(p))
            fprintf(file, "%.6g,%.3g,%.3g,%s,", p->cpu, p->motion, p->force, p->channel);
        else
            fputs("failed,,,,", file);
        fprintf(file, "%s,%s\n", p->best ? "yes" : "no", k == t->chosen ? "yes" : "no");
    }
}

// -- picture --------------------------------------------------------------------------------------

enum { WIDTH = 620, HEIGHT = 480, LEFT = 76, RIGHT = 44, TOP = 72, BOTTOM = 56 };

static bool has_place(const bough_tune_point *p) { return bough_tune_ended(p) && p->error > 0; }

// The front, from its fastest run to its most accurate.
static void draw_front(const bough_tune_state *t, const bough_panel *at) {
    double after = 0;
    fprintf(at->svg, "<polyline fill=\"none\" stroke-width=\"1.6\" stroke=\"%s\" points=\"",
            bough_picture_colour(0));
    for (;;) {
        const bough_tune_point *next = NULL;
        for (int k = 0; k < t->n; k++) {
            const bough_tune_point *p = &t->point[k];
            if (p->best && has_place(p) && p->cpu > after && (!next || p->cpu < next->cpu)) next = p;
        }
        if (!next) break;
        fprintf(at->svg, "%.1f,%.1f ", bough_axis_place(&at->x, next->error),
                bough_axis_place(&at->y, next->cpu));
        after = next->cpu;
    }
    fputs("\"/>\n", at->svg);
}

static void draw_points(const bough_tune_state *t, const bough_panel *at) {
    for (int k = 0; k < t->n; k++) {
        const bough_tune_point *p = &t->point[k];
        if (!has_place(p)) continue;
        double x = bough_axis_place(&at->x, p->error), y = bough_axis_place(&at->y, p->cpu);
        fprintf(at->svg, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\"/>\n", x, y,
                k == t->chosen ? 6.5 : 4, bough_picture_colour(p->best ? 0 : 1));
        fprintf(at->svg, "<text class=\"weak\" font-size=\"10\" x=\"%.1f\" y=\"%.1f\">%d%s</text>\n", x + 8,
                y - 5, k + 1, p->settings.own ? " (as written)" : "");
    }
}

static void draw(const void *self, FILE *svg) {
    const bough_tune_state *t = self;
    bough_panel at = {svg, bough_axis_between(LEFT, WIDTH - RIGHT, true),
                      bough_axis_between(HEIGHT - BOTTOM, TOP, true)};
    char title[64];
    for (int k = 0; k < t->n; k++) {
        if (!has_place(&t->point[k])) continue;
        bough_axis_include(&at.x, t->point[k].error);
        bough_axis_include(&at.y, t->point[k].cpu);
    }
    bough_axis_include(&at.x, t->error);
    bough_axis_widen(&at.x, 0.08);
    bough_axis_widen(&at.y, 0.08);
    bough_picture_begin(svg, WIDTH, HEIGHT);
    bough_picture_title(svg, LEFT, t->scene->title ? t->scene->title : t->options->scene);
    snprintf(title, sizeof title, "CPU time of %.4g s [s]", t->options->span);
    bough_panel_axes(&at, title, "whole error over the range (forces and moments: a quarter)");
    fprintf(svg, "<path class=\"axis\" stroke-dasharray=\"4 4\" d=\"M%.1f %dV%d\"/>\n",
            bough_axis_place(&at.x, t->error), TOP, HEIGHT - BOTTOM);
    draw_front(t, &at);
    draw_points(t, &at);
    fputs("</svg>\n", svg);
}

// -- settings -------------------------------------------------------------------------------------

static void print_solver(const bough_tune_settings *s, FILE *stream) {
    fprintf(stream, "{solver: %s, rtol: %.2g", bough_integrator_name(s->solver), s->rtol);
    if (s->step > 0) fprintf(stream, ", step: %.4g ms", 1e3 * s->step);
    fputc('}', stream);
}

static bool is_whole(const bough_tune_settings *s) {
    return bough_scheme_find(bough_scheme_name(s->scheme))->one_system;
}

static const char *name_in_text(const bough_scene *scene, int body) {
    const bough_node *name = bough_node_find(scene->body[body].node, "name");
    return name && name->text ? name->text : scene->body[body].name;
}

// Whether the body is the first of those that one place of the text describes, and its rod's segments differ
// from it.
static bool has_new_mesh(const bough_tune_state *t, int body) {
    const bough_scene *s = t->scene;
    for (int i = 0; i < body; i++) {
        if (s->body[i].node == s->body[body].node) return false;
    }
    int n = bough_tune_segments(s, body, &t->point[t->chosen].settings);
    return n > 0 && n != s->body[body].rod.n_segment;
}

static void print_block(const bough_tune_state *t, FILE *stream) {
    const bough_tune_settings *s = &t->point[t->chosen].settings;
    fprintf(stream,
            "simulation:\n  macro_step: %.9g ms\n  coupling: {scheme: %s}\n  %s: ", 1e3 * s->macro_step,
            bough_scheme_name(s->scheme), is_whole(s) ? "master" : "micro");
    print_solver(s, stream);
    if (s->rate > 0) fprintf(stream, "\naero:\n  rate: %.9g Hz", s->rate);
    fputc('\n', stream);
    for (int i = 0; i < t->scene->n_body; i++) {
        if (has_new_mesh(t, i))
            fprintf(stream, "# %s: rod: segments: %d\n", name_in_text(t->scene, i),
                    bough_tune_segments(t->scene, i, s));
    }
}

// The same as replacements in the scene.
static void print_words(const bough_tune_state *t, FILE *stream) {
    const bough_tune_settings *s = &t->point[t->chosen].settings;
    fprintf(stream, "bough run %s", t->options->scene);
    fprintf(
        stream,
        " --set 'simulation.macro_step=%.9g ms' --set 'simulation.coupling={scheme: %s}' --set 'simulation.%s=",
        1e3 * s->macro_step, bough_scheme_name(s->scheme), is_whole(s) ? "master" : "micro");
    print_solver(s, stream);
    fputc('\'', stream);
    if (s->rate > 0) fprintf(stream, " --set 'aero.rate=%.9g Hz'", s->rate);
    for (int i = 0; i < t->scene->n_body; i++) {
        if (has_new_mesh(t, i))
            fprintf(stream, " --set 'bodies[%s].rod.segments=%d'", name_in_text(t->scene, i),
                    bough_tune_segments(t->scene, i, s));
    }
    fputc('\n', stream);
}

void bough_tune_print_settings(const bough_tune_state *t, FILE *stream) {
    const bough_tune_point *p = &t->point[t->chosen];
    fprintf(stream, "# run %d: error %.2g (%s), forces %.2g; %.3g s of CPU for %.4g s\n", t->chosen + 1,
            p->motion, p->channel[0] ? p->channel : "-", p->force, p->cpu, t->options->span);
    if (p->settings.own) {
        fputs("# the settings of the scene as it is written\n", stream);
        return;
    }
    print_block(t, stream);
    fputs("# ", stream);
    print_words(t, stream);
}

static void write_settings(const void *self, FILE *file) { bough_tune_print_settings(self, file); }

bough_status bough_tune_write(const bough_tune_state *t) {
    const char *folder = t->options->folder;
    bough_status status = bough_folder_make(folder);
    if (bough_is_ok(&status)) status = bough_folder_write(folder, "tune.csv", write_table, t);
    if (bough_is_ok(&status)) status = bough_folder_write(folder, "tune.svg", draw, t);
    return bough_is_ok(&status) ? bough_folder_write(folder, "tune.yaml", write_settings, t) : status;
}
