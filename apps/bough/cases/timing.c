#include "apps/bough/cases/perform.h"

#include "apps/bough/results/folder.h"
#include "apps/bough/results/picture.h"

typedef struct cell_times {
    double wall[BOUGH_STUDY_REPEATS], cpu[BOUGH_STUDY_REPEATS], ratio[BOUGH_STUDY_REPEATS]; // in each round
    double error[BOUGH_STUDY_MEASURES]; // against the reference
} cell_times;

typedef struct timing {
    const bough_study *study;
    const bough_study_options *options;
    cell_times *cell; // (n_case)
    bough_study_series reference, series;
} timing;

// -- runs -----------------------------------------------------------------------------------------

static bough_status run(timing *t, const bough_case *cell, bough_study_drive *drive,
                        bough_study_series *series, bough_case_result *result) {
    BOUGH_TRY(bough_case_run(t->study, cell, 1, drive, series, result));
    return result->outcome;
}

// Each run writes all channels, as `bough run` does. Errors are taken from the first round: all rounds give
// the same bits.
static bough_status run_round(timing *t, int round) {
    bough_study_drive drive = {.stop = t->options->stop, .folder = t->options->folder};
    for (int i = 0; i < t->study->n_case; i++) {
        bough_case_result result = {0};
        BOUGH_TRY(run(t, &t->study->cases[i], &drive, &t->series, &result));
        t->cell[i].wall[round] = result.wall;
        t->cell[i].cpu[round] = result.cpu;
        if (round == 0) bough_study_compare(t->study, &t->series, &t->reference, t->cell[i].error);
    }
    // relative to the cell with the first value of the last axis and the same values of all others
    for (int i = 0; i < t->study->n_case; i++) {
        int first = i - t->study->cases[i].index[t->study->grid.n - 1];
        t->cell[i].ratio[round] = t->cell[first].wall[round] / t->cell[i].wall[round];
    }
    return bough_ok();
}

static bough_status run_all(timing *t) {
    bough_case_result reference = {0};
    bough_study_drive drive = {.stop = t->options->stop,
                               .progress = bough_progress_start(0, t->study->duration, t->options->quiet)};
    drive.progress.label = "reference";
    bough_status status = run(t, t->study->reference_case, &drive, &t->reference, &reference);
    bough_progress_clear(&drive.progress);
    for (int round = 0; round < t->study->repeat && bough_is_ok(&status); round++)
        status = run_round(t, round);
    return status;
}

// -- tables ---------------------------------------------------------------------------------------

static void print_times(const void *self, FILE *f) {
    const timing *t = self;
    const bough_study *s = t->study;
    fprintf(
        f,
        "%s\n%d rounds: medians, quartiles in brackets; ratio: wall time of the first %s to the cell's\n\n",
        s->title ? s->title : s->file, s->repeat, s->grid.axis[s->grid.n - 1].label);
    fprintf(f, "%-52s %9s %9s %17s %21s", "", "cpu [s]", "wall [s]", "x real time", "ratio");
    for (int m = 0; m < s->n_measure; m++) {
        fprintf(f, "  %s [%s]", s->measure[m].name, s->measure[m].unit);
    }
    fprintf(f, "\n");
    for (int i = 0; i < s->n_case; i++) {
        const cell_times *c = &t->cell[i];
        bough_spread wall = bough_spread_of(c->wall, s->repeat), cpu = bough_spread_of(c->cpu, s->repeat);
        bough_spread ratio = bough_spread_of(c->ratio, s->repeat);
        double x = s->duration;
        fprintf(f, "%-52s %9.3f %9.3f %5.1f [%4.1f, %4.1f] %6.3f [%.3f, %.3f]", s->cases[i].settings,
                cpu.median, wall.median, x / wall.median, x / wall.high, x / wall.low, ratio.median,
                ratio.low, ratio.high);
        for (int m = 0; m < s->n_measure; m++) {
            int width = (int)(strlen(s->measure[m].name) + strlen(s->measure[m].unit)) + 3;
            fprintf(f, "  %*.1e", width, c->error[m]);
        }
        fprintf(f, "\n");
    }
}

static void write_csv(const void *self, FILE *f) {
    const timing *t = self;
    const bough_study *s = t->study;
    fprintf(f, "settings,round,cpu (s),wall (s),ratio\n");
    for (int i = 0; i < s->n_case; i++) {
        for (int k = 0; k < s->repeat; k++) {
            bough_csv_text(f, s->cases[i].settings);
            fprintf(f, ",%d,%.6g,%.6g,%.6g\n", k + 1, t->cell[i].cpu[k], t->cell[i].wall[k],
                    t->cell[i].ratio[k]);
        }
    }
}

// -- plot.svg: CPU time over the numbers of each axis -----------------------------------------------

// A value as a pure number; 0: it is not one.
static double number_of(const bough_study_axis *axis, int k) {
    char *end;
    double number = strtod(axis->value.item[k].value, &end);
    return *end == '\0' ? number : 0;
}

// Number of cells between neighbouring values of the axis.
static int stride_of(const bough_study *s, int axis) {
    int stride = 1;
    for (int k = axis + 1; k < s->grid.n; k++) stride *= s->grid.axis[k].value.n;
    return stride;
}

static bool is_of_numbers(const bough_study_axis *axis) {
    for (int k = 0; k < axis->value.n; k++)
        if (!(number_of(axis, k) > 0)) return false;
    return axis->value.n > 1;
}

static double cpu_of(const timing *t, int cell) {
    return bough_spread_of(t->cell[cell].cpu, t->study->repeat).median;
}

// The line from a cell along the axis, labelled with the values of the other axes and the exponent of its
// growth.
static void add_growth(bough_arena *arena, const timing *t, int first, int axis, int colour,
                       bough_chart *chart) {
    const bough_study *s = t->study;
    const bough_study_axis *numbers = &s->grid.axis[axis];
    int last = numbers->value.n - 1, stride = stride_of(s, axis), end = first + last * stride;
    const char *name = bough_grid_others(arena, s, &s->cases[first], axis);
    double exponent =
        log(cpu_of(t, end) / cpu_of(t, first)) / log(number_of(numbers, last) / number_of(numbers, 0));
    name = bough_arena_print(arena, "%s%sexponent %.2f", name, name[0] ? ": " : "", exponent);
    bough_chart_add_line(chart, (bough_chart_line){NULL, colour, true, true, 0});
    for (int k = 0; k <= last; k++) {
        int cell = first + k * stride;
        bough_chart_add(chart, (bough_chart_point){.x = number_of(numbers, k),
                                                   .y = cpu_of(t, cell) / s->duration,
                                                   .label = k == last ? name : NULL});
    }
}

static bough_status plot(bough_arena *arena, const timing *t) {
    const bough_study *s = t->study;
    bough_chart chart = bough_chart_start(arena, s->title ? s->title : s->file, 2);
    chart.right = 130;
    for (int axis = 0; axis < s->grid.n; axis++) {
        if (!is_of_numbers(&s->grid.axis[axis])) continue;
        int colour = 0;
        bough_chart_add_panel(&chart, "CPU time per simulated second [s]", s->grid.axis[axis].label, true,
                              true);
        for (int i = 0; i < s->n_case; i++) {
            if (s->cases[i].index[axis] == 0) add_growth(arena, t, i, axis, colour++, &chart);
        }
    }
    if (chart.n_panel == 0) return bough_ok();
    return bough_folder_write(t->options->folder, "plot.svg", bough_chart_write, &chart);
}

bough_status bough_timing_conclude(bough_arena *arena, const bough_study_results *results) {
    const bough_study *study = results->study;
    const bough_study_options *options = results->options;
    timing t = {.study = study, .options = options};
    t.cell = bough_arena_take(arena, (size_t)study->n_case * sizeof *t.cell);
    t.reference = bough_study_series_take(arena, study);
    t.series = bough_study_series_take(arena, study);
    BOUGH_TRY(run_all(&t));
    BOUGH_TRY(bough_folder_write(options->folder, "timing.csv", write_csv, &t));
    BOUGH_TRY(bough_folder_write(options->folder, "table.txt", print_times, &t));
    BOUGH_TRY(plot(arena, &t));
    print_times(&t, options->stream);
    return bough_ok();
}
