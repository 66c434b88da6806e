// bough modes --sweep: the modes of the whole scene over a list of operating points, as a table and a
// Campbell diagram.
#include "apps/bough/analysis/vibration.h"
#include "apps/bough/cases/perform.h"
#include "apps/bough/cli/modes_internal.h"
#include "apps/bough/model/companion.h"
#include "apps/bough/results/folder.h"
#include "apps/bough/results/picture.h"
#include "core/base/linalg.h"

enum { MOST_POINTS = 500 };

// Least similarity of shapes (0 to 1) of the same mode.
static const double least_alike = 0.3;

static const double rounding = 1e-6; // smaller damping ratios are rounding

// A mode at an operating point.
typedef struct sweep_mode {
    int point, line;     // a line connects equal modes of neighbouring points
    bough_scene_mode is; // without its shares and shape
    const char *body, *shape;
    const char *name; // of both and of the pattern
} sweep_mode;

typedef struct sweep {
    int n_key, n_point;
    int n_solved;       // points, the first ones
    int n_blade;        // of the turbine; 0: none
    bool free;          // its rotor turns freely
    const char **key;   // (n_key)
    const char **value; // (n_key × n_point) as written
    double *x, *speed;  // (n_point) of the first key, else its place in the list;
                        // of the rotor [rpm]
    int n_mode, n_line;
    sweep_mode *mode;         // (n_mode) point after point
    const sweep_mode **named; // (n_line) a mode with the most frequent name of the line
} sweep;

// The modes of a point, to be found again at the next one.
typedef struct tracks {
    bough_arena *arena; // of all that follows; NULL before the first point
    bough_simulation *simulation;
    bough_vibration modes;
    int *line;      // (modes.found)
    double *weight; // (n_state) W of products: states count in units of their scales
} tracks;

// -- operating points -----------------------------------------------------------------------------

// The next part of a list, up to a comma outside brackets and quotes; NULL at its end.
static const char *next_value(bough_arena *arena, const char **rest) {
    const char *from = *rest + strspn(*rest, " ");
    int depth = 0;
    char quote = '\0'; // the one that is open
    size_t n = 0;
    if (*from == '\0') return NULL;
    for (; from[n] != '\0' && (quote || depth > 0 || from[n] != ','); n++) {
        if (quote ? from[n] == quote : from[n] == '"' || from[n] == '\'')
            quote = (char)(quote ? '\0' : from[n]);
        if (!quote) depth += (from[n] == '[' || from[n] == '{') - (from[n] == ']' || from[n] == '}');
    }
    *rest = from + n + (from[n] == ',');
    return bough_arena_print(arena, "%.*s", (int)n, from);
}

static int count_values(bough_arena *arena, const char *list) {
    int n = 0;
    while (next_value(arena, &list) != NULL) n++;
    return n;
}

// 'KEY=V1, V2, ...', as many values of every key.
static bough_status read_points(bough_arena *arena, const bough_texts *sweeps, sweep *s) {
    s->n_key = sweeps->n;
    s->key = bough_arena_take(arena, (size_t)s->n_key * sizeof *s->key);
    for (int k = 0; k < s->n_key; k++) {
        const char *text = sweeps->text[k], *list = strchr(text, '=');
        int n = list ? count_values(arena, list + 1) : 0;
        if (n == 0 || n > MOST_POINTS) {
            return bough_fail(BOUGH_INVALID,
                              "--sweep expects KEY=V1, V2, ... of at most %d values, got "
                              "'%.80s'",
                              MOST_POINTS, text);
        }
        if (k > 0 && n != s->n_point) {
            return bough_fail(BOUGH_INVALID, "--sweep: '%.80s' has %d values, the first %d", text, n,
                              s->n_point);
        }
        s->n_point = n;
        if (k == 0) s->value = bough_arena_take(arena, (size_t)s->n_key * (size_t)n * sizeof *s->value);
        s->key[k] = bough_arena_print(arena, "%.*s", (int)(list - text), text);
        list++;
        for (int i = 0; i < n; i++) s->value[k * n + i] = next_value(arena, &list);
    }
    bough_arena_each(arena, (size_t)s->n_point, &s->x, &s->speed);
    return bough_ok();
}

static bough_options options_at(bough_arena *arena, const bough_options *options, const sweep *s, int point) {
    bough_options at = *options;
    at.set.text = bough_arena_take(arena, (size_t)(options->set.n + s->n_key) * sizeof(char *));
    for (int k = 0; k < options->set.n; k++) at.set.text[k] = options->set.text[k];
    for (int k = 0; k < s->n_key; k++)
        at.set.text[at.set.n++] =
            bough_arena_print(arena, "%s=%s", s->key[k], s->value[k * s->n_point + point]);
    return at;
}

// -- lines ----------------------------------------------------------------------------------------

static int count_states(const tracks *t) { return t->simulation->master->assembly->n_state; }

// aᴴ W b of the shapes of two modes, real and imaginary part.
static void product(const tracks *t, const bough_eigen_pair *a, const bough_eigen_pair *b, double value[2]) {
    value[0] = value[1] = 0;
    for (int i = 0; i < count_states(t); i++) {
        value[0] +=
            t->weight[i] * (a->shape_real[i] * b->shape_real[i] + a->shape_imag[i] * b->shape_imag[i]);
        value[1] +=
            t->weight[i] * (a->shape_real[i] * b->shape_imag[i] - a->shape_imag[i] * b->shape_real[i]);
    }
}

// Similarity of each mode of `now` to each mode of `before`, theory (103): alike (before × now), 0 to 1.
// Products alone do not distinguish shapes that are far from orthogonal, as near flutter.
static void compare(const tracks *before, const tracks *now, double *alike) {
    bough_arena *arena = now->arena;
    const bough_eigen_pair *pair = before->modes.pair;
    size_t n = (size_t)before->modes.found;
    double *matrix = bough_arena_doubles(arena, 2 * n * n + 1), *part = bough_arena_doubles(arena, 2 * n + 1);
    int *pivot = bough_arena_take(arena, (n + 1) * sizeof *pivot);
    double *size = bough_arena_doubles(arena, n + 1);
    for (size_t k = 0; k < n; k++) {
        for (size_t i = 0; i < n; i++) product(before, &pair[i], &pair[k], matrix + 2 * (k * n + i));
        size[k] = matrix[2 * (k * n + k)];
    }
    bool independent = bough_complex_factor((int)n, matrix, pivot);
    for (int j = 0; j < now->modes.found; j++) {
        double sum = 0, *to = alike + (size_t)j * n;
        for (size_t k = 0; k < n; k++) product(before, &pair[k], &now->modes.pair[j], part + 2 * k);
        if (independent) bough_complex_solve((int)n, matrix, pivot, part);
        for (size_t k = 0; k < n; k++) {
            double square = part[2 * k] * part[2 * k] + part[2 * k + 1] * part[2 * k + 1];
            sum += to[k] = independent ? square * size[k] : square / size[k];
        }
        for (size_t k = 0; k < n; k++) to[k] /= sum;
    }
}

// Continues the lines of the most similar modes, the most similar first; other modes begin new lines.
static void find_lines(const tracks *before, tracks *now, sweep *s) {
    size_t n = (size_t)before->modes.found, n_now = (size_t)now->modes.found;
    double *alike = bough_arena_doubles(now->arena, n * n_now + 1);
    bool *taken = bough_arena_take(now->arena, n + 1);
    now->line = bough_arena_take(now->arena, n_now * sizeof *now->line);
    compare(before, now, alike);
    for (size_t j = 0; j < n_now; j++) now->line[j] = -1;
    for (;;) {
        double most = least_alike;
        int from = -1, to = -1;
        for (size_t j = 0; j < n_now; j++) {
            for (size_t k = 0; k < n && now->line[j] < 0; k++)
                if (!taken[k] && alike[j * n + k] > most) most = alike[j * n + k], from = (int)k, to = (int)j;
        }
        if (from < 0) break;
        taken[from] = true;
        now->line[to] = before->line[from];
    }
    for (size_t j = 0; j < n_now; j++)
        if (now->line[j] < 0) now->line[j] = s->n_line++;
}

// The modes of a point into the sweep.
static void add_modes(bough_arena *keep, int point, const tracks *before, tracks *now, sweep *s) {
    const bough_simulation *sim = now->simulation;
    size_t n = (size_t)count_states(now);
    now->weight = bough_arena_doubles(now->arena, n);
    bough_assembly_scales(sim->master->assembly, now->weight);
    for (size_t i = 0; i < n; i++) now->weight[i] = 1 / (now->weight[i] * now->weight[i]);
    find_lines(before, now, s);
    for (int k = 0; k < now->modes.found; k++) {
        const bough_scene_mode *m = &now->modes.mode[k];
        sweep_mode *to = &s->mode[s->n_mode++];
        *to = (sweep_mode){.point = point,
                           .line = now->line[k],
                           .is = *m,
                           .body = bough_arena_string(keep, bough_modes_body(sim, m)),
                           .shape = bough_modes_shape(sim, m)};
        to->name = bough_arena_print(keep, "%s %s%s%s", to->body, to->shape, m->pattern ? " " : "",
                                     bough_pattern_names[m->pattern]);
    }
}

// -- points ---------------------------------------------------------------------------------------

// At a point; with `ratio` (NULL: without) those of the other mesh, and the error over the difference of
// both.
static bough_status find_modes(bough_arena *arena, const bough_options *options, int point, const sweep *s,
                               double *ratio, bough_simulation **sim, bough_vibration *v) {
    bough_options at = options_at(arena, options, s, point);
    bough_scene *scene;
    BOUGH_TRY(bough_open_scene(arena, &at, &scene));
    if (ratio) {
        bough_scene *coarser = bough_coarser_scene(arena, scene, BOUGH_COARSER_MESH);
        *ratio = bough_coarser_ratio(scene, coarser);
        scene = coarser;
    }
    BOUGH_TRY(bough_simulation_build(arena, scene, sim));
    BOUGH_TRY(bough_simulation_known(*sim, "it has no modes"));
    return bough_vibration_find(arena, *sim, (*sim)->scene->modes.count, v);
}

static bough_status add_point(bough_arena *keep, int point, const tracks *before, tracks *now, sweep *s) {
    const bough_simulation *sim = now->simulation;
    int most = sim->scene->modes.count * s->n_point;
    if (point == 0) {
        s->mode = bough_arena_take(keep, (size_t)most * sizeof *s->mode);
    } else if (count_states(now) != count_states(before) || now->modes.found > most - s->n_mode) {
        return bough_fail(BOUGH_INVALID,
                          "--sweep cannot change the bodies, their mesh or the number of modes");
    }
    add_modes(keep, point, before, now, s);
    s->speed[point] = fabs(now->modes.spin) / BOUGH_RPM;
    s->n_blade = sim->scene->turbine.n_blade;
    s->free = bough_modes_rotor_is_free(sim);
    char *end;
    s->x[point] = strtod(s->value[point], &end);
    if (end == s->value[point]) s->x[point] = point + 1;
    return bough_ok();
}

// `last`: the point before, which this one replaces.
static bough_status solve_point(bough_arena *keep, const bough_options *options, int point, tracks *last,
                                sweep *s) {
    tracks now = {.arena = bough_arena_child(keep)};
    bough_status status = find_modes(now.arena, options, point, s, NULL, &now.simulation, &now.modes);
    if (!bough_is_ok(&status) && status.message[0])
        return bough_fail(status.code, "%s=%s: %s", s->key[0], s->value[point], status.message);
    BOUGH_TRY(status);
    BOUGH_TRY(add_point(keep, point, last, &now, s));
    bough_arena_destroy(last->arena);
    *last = now;
    return status;
}

static void print_point(const sweep *s, int point, int first) {
    for (int k = 0; k < s->n_key; k++) {
        printf("%s%s=%s", k > 0 ? ", " : "", s->key[k], s->value[k * s->n_point + point]);
    }
    putchar('\n');
    for (int k = first; k < s->n_mode; k++) {
        const sweep_mode *m = &s->mode[k];
        printf("%4d", m->line + 1);
        bough_modes_print_value(m->is.frequency, m->is.damped_frequency, m->is.damping);
        printf("%-12s %-8s %s%s%s\n", m->body, m->shape, bough_pattern_names[m->is.pattern],
               m->is.damping < -rounding ? "  unstable" : "",
               m->is.damping_change > 0 && m->is.damping_change >= fabs(m->is.damping)
                   ? "  damping changes with the azimuth by as much as its own value"
                   : "");
    }
}

static bool has_name(const sweep_mode *a, const sweep_mode *b) {
    return a->line == b->line && strcmp(a->name, b->name) == 0;
}

// Names each line by the most frequent name of its modes: modes with nearly equal frequencies exchange their
// names.
static void name_lines(bough_arena *arena, sweep *s) {
    s->named = bough_arena_take(arena, ((size_t)s->n_line + 1) * sizeof *s->named);
    int *most = bough_arena_take(arena, ((size_t)s->n_line + 1) * sizeof *most);
    for (int i = 0; i < s->n_mode; i++) {
        int alike = 0, line = s->mode[i].line;
        for (int k = 0; k < s->n_mode; k++) alike += has_name(&s->mode[i], &s->mode[k]);
        if (alike > most[line]) most[line] = alike, s->named[line] = &s->mode[i];
    }
}

static void write_table(const void *self, FILE *file) {
    const sweep *s = self;
    fputs("point", file);
    for (int k = 0; k < s->n_key; k++) bough_csv_next(file, s->key[k]);
    fputs(
        ",rotor speed (rpm),line,branch,frequency (Hz),damped frequency (Hz),damping ratio (-),decrement (-),"
        "change of damping ratio over azimuths (-),body,shape,pattern\n",
        file);
    for (int i = 0; i < s->n_mode; i++) {
        const sweep_mode *m = &s->mode[i];
        fprintf(file, "%d", m->point + 1);
        for (int k = 0; k < s->n_key; k++) bough_csv_next(file, s->value[k * s->n_point + m->point]);
        fprintf(file, ",%.10g,%d,%s", s->speed[m->point], m->line + 1, s->named[m->line]->name);
        bough_modes_write_value(file, m->is.frequency, m->is.damped_frequency, m->is.damping);
        fprintf(file, ",%.2g,%s,%s,%s\n", m->is.damping_change, m->body, m->shape,
                bough_pattern_names[m->is.pattern]);
    }
}

// -- the Campbell diagram, with the multiples of the rotor's speed --------------------------------

typedef struct diagram {
    const sweep *sweep;
    bough_chart chart;
    bool damping;
    bool by_speed; // x is the rotor's speed, else the first key's number
} diagram;

static double x_of(const diagram *d, int point) {
    return d->by_speed ? d->sweep->speed[point] : d->sweep->x[point];
}

// n Ω for n = 1 and multiples of the number of blades over the rotor's speed, up to the highest frequency.
static void add_multiples(diagram *d, double frequency) {
    double low = HUGE_VAL, high = 0;
    int blades = d->sweep->n_blade > 1 ? d->sweep->n_blade : 2;
    for (int i = 0; i < d->sweep->n_solved; i++) {
        low = fmin(low, d->sweep->speed[i]);
        high = fmax(high, d->sweep->speed[i]);
    }
    for (int k = 0; d->by_speed && k <= 3; k++) {
        int n = k == 0 ? 1 : k * blades;
        double slope = n / 60., end = fmin(high, frequency / slope);
        if (end <= low) continue;
        const char *label = bough_arena_print(d->chart.arena, "%dP", n);
        bough_chart_add_line(&d->chart, (bough_chart_line){.colour = -1, .joined = true});
        bough_chart_add(&d->chart, (bough_chart_point){.x = low, .y = slope * low});
        bough_chart_add(&d->chart, (bough_chart_point){.x = end, .y = slope * end, .label = label});
    }
}

// A mode that does not oscillate has no point in the diagram of damping ratios.
static void add_line(diagram *d, int line) {
    const sweep *s = d->sweep;
    const sweep_mode *last = NULL;
    for (int i = 0; i < s->n_mode; i++)
        if (s->mode[i].line == line && !(d->damping && s->mode[i].is.damped_frequency == 0))
            last = &s->mode[i];
    bough_chart_add_line(&d->chart, (bough_chart_line){.colour = line, .joined = true, .marked = true});
    for (const sweep_mode *m = s->mode; last && m <= last; m++) {
        if (m->line != line || (d->damping && m->is.damped_frequency == 0)) continue;
        const char *label = bough_arena_print(d->chart.arena, "%d %s", line + 1, s->named[line]->name);
        bough_chart_add(&d->chart,
                        (bough_chart_point){.x = x_of(d, m->point),
                                            .y = d->damping ? 100 * m->is.damping : m->is.frequency,
                                            .label = m == last ? label : NULL});
    }
}

static bough_status draw(bough_arena *arena, const sweep *s, const char *folder) {
    diagram d = {.sweep = s, .chart = bough_chart_start(arena, NULL, 1)};
    double frequency = 0;
    d.chart.right = 190;
    for (int i = 1; i < s->n_solved; i++) d.by_speed = d.by_speed || s->speed[i] != s->speed[0];
    for (int i = 0; i < s->n_mode; i++) frequency = fmax(frequency, s->mode[i].is.frequency);
    bough_chart_add_panel(&d.chart, "frequency [Hz]", NULL, false, false);
    add_multiples(&d, frequency);
    for (int line = 0; line < s->n_line; line++) add_line(&d, line);
    d.damping = true;
    bough_chart_add_panel(&d.chart, "damping ratio [%]", d.by_speed ? "rotor speed [rpm]" : s->key[0], false,
                          false);
    for (int line = 0; line < s->n_line; line++) add_line(&d, line);
    return bough_folder_write(folder, "campbell.svg", bough_chart_write, &d.chart);
}

// -- the boundary of stability --------------------------------------------------------------------

enum { MOST_TRIALS = 40 };

static const double accurate = 1e-5; // of the boundary, relative to the first key's values

// Growth of a motion [1/s].
static double growth_of(const bough_scene_mode *m) { return fabs(m->damping) > rounding ? m->growth : 0; }

// Whether growth of the mode ends the sweep: oscillations do, and divergences unless the rotor is free, whose
// speed may grow under constant torque.
static bool counts(bool free, const bough_scene_mode *m) { return m->damped_frequency > 0 || !free; }

static const sweep_mode *most_growing(const sweep *s, int point) {
    const sweep_mode *most = NULL;
    for (int i = 0; i < s->n_mode; i++) {
        const sweep_mode *m = &s->mode[i];
        bool taken = m->point == point && counts(s->free, &m->is);
        if (taken && (!most || growth_of(&m->is) > growth_of(&most->is))) most = m;
    }
    return most;
}

// Beyond rounding.
static bool grows(const sweep_mode *m) { return m && m->is.damping < -rounding; }

static bool begins_number(const char *text) {
    return strchr("+-.0123456789", *text) != NULL && *text != '\0';
}

// The value between those of a point and the next, "139.6 m/s": all numbers in it; NULL where the texts
// differ in anything else.
static const char *between(bough_arena *arena, const char *a, const char *b, double part) {
    const char *value = "";
    while (*a != '\0') {
        char *end_a, *end_b;
        double first = begins_number(a) ? strtod(a, &end_a) : 0,
               second = begins_number(b) ? strtod(b, &end_b) : 0;
        if (begins_number(a) && begins_number(b) && end_a != a && end_b != b) {
            value = bough_arena_print(arena, "%s%.8g", value, first + part * (second - first));
            a = end_a, b = end_b;
        } else {
            if (*a != *b) return NULL;
            value = bough_arena_print(arena, "%s%c", value, *a);
            a++, b++;
        }
    }
    return *b == '\0' ? value : NULL;
}

// The growth at a place between two points, or at the boundary.
typedef struct growth {
    double part;      // of the way from the first point to the next
    double rate;      // of the fastest growing motion [1/s]; 0: rounding
    double frequency; // of that, damped [Hz]; 0: a divergence
    const char *name; // of the moving body and shape
    double slope;     // at the boundary: of the rate over that part [1/s]
    double ratio;     // with the other mesh: the error of the scene's mesh over the difference of the two
} growth;

// Growth at a part of the way behind the point, with the scene's mesh or the other one.
static bough_status grow(bough_arena *keep, const bough_options *options, const sweep *s, int point,
                         double part, bool other, growth *to) {
    bough_arena *arena = bough_arena_child(keep);
    sweep one = {.n_key = s->n_key, .n_point = 1, .key = s->key};
    one.value = bough_arena_take(arena, (size_t)s->n_key * sizeof *one.value);
    for (int k = 0; k < s->n_key; k++) {
        const char *const *value = s->value + k * s->n_point + point;
        one.value[k] = between(arena, value[0], value[1], part);
        if (!one.value[k])
            return bough_fail(BOUGH_INVALID, "--until needs numbers with one unit, got %s=%s, %s", s->key[k],
                              value[0], value[1]);
    }
    bough_simulation *sim;
    bough_vibration v;
    *to = (growth){.part = part, .rate = -HUGE_VAL};
    bough_status status = find_modes(arena, options, 0, &one, other ? &to->ratio : NULL, &sim, &v);
    for (int k = 0; bough_is_ok(&status) && k < v.found; k++) {
        const bough_scene_mode *m = &v.mode[k];
        double rate = growth_of(m);
        if (!counts(s->free, m) || rate <= to->rate) continue;
        to->rate = rate;
        to->frequency = m->damped_frequency;
        to->name = bough_arena_print(keep, "%s %s", bough_modes_body(sim, m), bough_modes_shape(sim, m));
    }
    bough_arena_destroy(arena);
    return status;
}

// Between a stable point and the next one, where growths are low and high, by the Illinois rule; in halves
// where low is 0: without damping, up to the boundary, and before a divergence, of which nothing is listed.
static bough_status find_boundary(bough_arena *arena, const bough_options *options, const sweep *s, int point,
                                  double low, double high, bool other, growth *to) {
    double a = 0, b = 1, first = s->x[point], second = s->x[point + 1];
    double width = accurate * fmax(fabs(first), fabs(second)) / fabs(second - first);
    for (int trial = 0; trial < MOST_TRIALS && b - a > width; trial++) {
        bool halves = trial % 4 == 3 || !(low < 0);
        double x = halves ? (a + b) / 2 : a + (b - a) * low / (low - high);
        growth at;
        x = fmin(fmax(x, a + width / 4), b - width / 4);
        BOUGH_TRY(grow(arena, options, s, point, x, other, &at));
        to->slope = (at.rate - (at.rate > 0 ? low : high)) / (x - (at.rate > 0 ? a : b));
        to->ratio = at.ratio;
        if (at.rate > 0) {
            b = x, high = at.rate, low /= 2, to->frequency = at.frequency, to->name = at.name;
        } else {
            a = x, low = at.rate, high /= 2;
        }
    }
    to->part = (a + b) / 2;
    return bough_ok();
}

// Change of the boundary by the mesh, as a fraction of the interval: by the growth with the other mesh there
// and the slope, or, if growth starts with a jump, by its own boundary.
static bough_status find_error(bough_arena *arena, const bough_options *options, const sweep *s, int point,
                               double low, double high, const growth *at, double *error) {
    growth other;
    BOUGH_TRY(grow(arena, options, s, point, at->part, true, &other));
    *error = fabs(other.ratio * other.rate / at->slope);
    if (low < 0) return bough_ok();
    BOUGH_TRY(find_boundary(arena, options, s, point, low, high, true, &other));
    *error = fabs(other.ratio * (other.part - at->part));
    return bough_ok();
}

// Prints the boundary of stability and its change by the mesh.
static bough_status print_boundary(bough_arena *arena, const bough_options *options, const sweep *s,
                                   int last) {
    const sweep_mode *m = most_growing(s, last), *before = last > 0 ? most_growing(s, last - 1) : NULL;
    if (!grows(m) || last == 0) {
        if (grows(m))
            printf("unstable at the first point: %s=%s\n", s->key[0], s->value[last]);
        else
            printf("%s grows up to %s=%s among the %d modes followed (modes.count)\n",
                   s->free ? "no oscillation" : "nothing", s->key[0], s->value[last], s->n_line);
        return bough_ok();
    }
    growth at = {.frequency = m->is.damped_frequency,
                 .name = bough_arena_print(arena, "%s %s", m->body, m->shape)};
    double low = m->is.damped_frequency > 0 && before ? growth_of(&before->is) : 0, high = growth_of(&m->is),
           error;
    BOUGH_TRY(find_boundary(arena, options, s, last - 1, low, high, false, &at));
    BOUGH_TRY(find_error(arena, options, s, last - 1, low, high, &at, &error));
    bool number = begins_number(s->value[last]);
    error *= fabs(s->x[last] - s->x[last - 1]);
    const char *value = between(arena, s->value[last - 1], s->value[last], at.part);
    printf("unstable from %s=%s on, mesh +- %.2g%s: ", s->key[0], value, error, number ? "" : " of the step");
    if ((m->is.damped_frequency > 0) == (at.frequency > 0)) printf("line %d, ", m->line + 1);
    if (at.frequency > 0)
        printf("%.6g Hz, %s\n", at.frequency, at.name);
    else
        printf("divergence, %s\n", at.name);
    return bough_ok();
}

// -- the sweep ------------------------------------------------------------------------------------

bough_status bough_modes_sweep(bough_arena *arena, const bough_options *options, const bough_texts *sweeps,
                               bool until_unstable) {
    sweep s = {0};
    tracks last = {0};
    const char *folder = bough_out_folder(arena, options);
    BOUGH_TRY(read_points(arena, sweeps, &s));
    printf("%4s %12s %12s %11s %11s  %-12s %-8s pattern\n", "line", "frequency", "damped", "damping",
           "decrement", "body", "shape");
    for (bool ends = false; s.n_solved < s.n_point && !ends; s.n_solved++) {
        int first = s.n_mode;
        BOUGH_TRY(solve_point(arena, options, s.n_solved, &last, &s));
        print_point(&s, s.n_solved, first);
        ends = until_unstable && grows(most_growing(&s, s.n_solved));
    }
    if (until_unstable) BOUGH_TRY(print_boundary(arena, options, &s, s.n_solved - 1));
    name_lines(arena, &s);
    BOUGH_TRY(bough_folder_write(folder, "campbell.csv", write_table, &s));
    BOUGH_TRY(draw(arena, &s, folder));
    printf("out: %s\n", folder);
    return bough_ok();
}
