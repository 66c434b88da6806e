// bough run: steps a scene through its duration and records its channels.
#include "apps/bough/cli/run.h"

#include "apps/bough/model/validity.h"

#include <sys/statvfs.h>

// -- forecast -------------------------------------------------------------------------------------

static const double long_run = 1e6;    // macro steps
static const double much_data = 1e9;   // [bytes]
static const double frame_head = 900;  // bytes of the file of a frame without its points
static const double frame_point = 110; // bytes of one of its points
enum { COLUMN = 18 };                  // bytes of a value in channels.out

bough_forecast bough_run_results(const bough_simulation *simulation, const bough_channels *channels,
                                 const bough_shape *shape) {
    const bough_scene_output *output = &simulation->scene->simulation.output;
    double duration = simulation->master->duration, n_point = 0;
    for (int k = 0; k < shape->n_line; k++) n_point += shape->line[k].n_point;
    double row = COLUMN * (channels->count + 1.0) + 1 + (output->binary ? 2 * channels->count : 0);
    double rows = 1 + ceil(duration / output->interval - 1e-9); // the end is recorded too
    double frames = output->frames > 0 ? 1 + floor(duration / output->frames + 1e-9) : 0;
    return (bough_forecast){rows, row * rows + (frame_head + frame_point * n_point) * frames};
}

void bough_forecast_print(bough_forecast f, const bough_channels *channels) {
    printf("results: %.10g rows of %d columns, %.3g MB\n", f.rows, channels->count + 1, 1e-6 * f.bytes);
}

double bough_forecast_derivative(const bough_coupling *c, int member, int tries, double *rate) {
    const bough_assembly *a = c->assembly;
    const bough_member *m = a->member[member];
    const bough_system *s = &m->system;
    double shortest = HUGE_VAL;
    for (int k = 0; k < tries; k++) {
        double began = bough_wall_clock();
        s->ops->derivative(s->self, m->time, m->state, c->input + a->input_offset[member], rate);
        shortest = fmin(shortest, bough_wall_clock() - began);
    }
    return shortest;
}

// Each macro step evaluates every member at least twice [s].
static double least_step_time(const bough_run_command *command) {
    const bough_coupling *c = command->run.simulation->master->coupling;
    double sum = 0, *rate = bough_arena_doubles(command->arena, (size_t)c->assembly->n_state + 1);
    for (int i = 0; i < c->assembly->n_member; i++) sum += bough_forecast_derivative(c, i, 5, rate);
    return 2 * sum;
}

// Prints the size of the results and, on stderr, steps and time of a long run (more than a million macro
// steps or a gigabyte). BOUGH_INVALID if the results do not fit on the disk of their folder.
static bough_status run_forecast(const bough_run_command *command) {
    const bough_run *run = &command->run;
    const bough_master *m = run->simulation->master;
    bough_forecast results = bough_run_results(run->simulation, &command->recorded, &command->shape);
    double steps = m->duration / m->macro_step, bytes = results.bytes;
    struct statvfs disk;
    double room =
        statvfs(command->folder, &disk) == 0 ? (double)disk.f_bavail * (double)disk.f_frsize : HUGE_VAL;
    if (bytes > much_data && bytes > room) {
        return bough_fail(
            BOUGH_INVALID,
            "the results take about %.3g GB, '%.200s' has room for %.3g GB: take a longer simulation.output.interval or a shorter duration",
            1e-9 * bytes, command->folder, 1e-9 * room);
    }
    bough_forecast_print(results, &command->recorded);
    fflush(stdout);
    if (steps <= long_run && bytes <= much_data) return bough_ok();
    fprintf(stderr, "bough: %.3g macro steps, more than %.2g hours\n", steps,
            steps * least_step_time(command) / 3600);
    return bough_ok();
}

// -- recording ------------------------------------------------------------------------------------

static bough_status sample_row(void *self, double t) {
    bough_run_command *command = self;
    bough_status status = bough_recorder_sample(command->recorder, t);
    const bough_simulation *s = command->run.simulation;
    if (t < s->scene->simulation.output.from - 1e-6 * s->master->macro_step) return status;
    const double *value = bough_recorder_values(command->recorder);
    for (int i = 0; i < command->recorded.count; i++)
        bough_sample_statistics_add(&command->statistics[i], t, value[i]);
    return status;
}

static bough_status sample_frame(void *self, double t) {
    return bough_frames_sample(((bough_run_command *)self)->frames, t);
}

static void record(bough_run_command *command) {
    const bough_scene_output *output = &command->run.simulation->scene->simulation.output;
    bough_run_record rows = {output->interval, true, .sample = sample_row, .self = command};
    bough_run_record frames = {output->frames, .sample = sample_frame, .self = command};
    bough_run_record_at(&command->run, rows);
    if (output->frames > 0) bough_run_record_at(&command->run, frames);
}

// -- results --------------------------------------------------------------------------------------

static bough_status open_frames(bough_run_command *command) {
    const bough_scene_output *output = &command->run.simulation->scene->simulation.output;
    if (!(output->frames > 0)) return bough_ok();
    bough_shape_create(command->arena, command->run.simulation, &command->shape);
    bough_frames_def def = {.folder = command->folder,
                            .n_line = command->shape.n_line,
                            .line = command->shape.line,
                            .points = bough_shape_points,
                            .loads = bough_shape_loads,
                            .self = &command->shape,
                            .kept = command->frames_kept};
    return bough_frames_open(command->arena, &def, &command->frames);
}

static const char *title(const bough_run_command *command) {
    const bough_scene *scene = command->run.simulation->scene;
    return scene->title ? scene->title : scene->file;
}

// Removes partial files of a run that was killed; the rows stay if it is resumed.
static bough_status clean(const bough_run_command *command) {
    char frames[BOUGH_PATH_MAX];
    BOUGH_TRY(bough_folder_path(command->folder, "frames", frames));
    if (!command->options->resume) bough_folder_clean(command->folder);
    bough_folder_clean(frames);
    return bough_ok();
}

// Results of an earlier run stay until this one replaces them, except its checkpoint.
static bough_status open_results(bough_run_command *command) {
    command->folder = bough_out_folder(command->arena, &command->options->common);
    BOUGH_TRY(bough_checkpoint_open(command));
    BOUGH_TRY(bough_folder_make(command->folder));
    BOUGH_TRY(bough_lock_folder(command->arena, command->folder));
    BOUGH_TRY(clean(command));
    BOUGH_TRY(command->options->resume ? bough_folder_remove(command->folder, "summary.json")
                                       : bough_checkpoint_remove(command->folder));
    bough_recorder_def def = {.folder = command->folder,
                              .title = title(command),
                              .channels = &command->recorded,
                              .kept = command->rows};
    BOUGH_TRY(bough_recorder_open(command->arena, &def, &command->recorder));
    BOUGH_TRY(open_frames(command));
    return run_forecast(command);
}

bough_status bough_run_command_build(bough_run_command *command) {
    double began = bough_wall_clock();
    bough_scene *scene;
    BOUGH_TRY(bough_open_scene(command->arena, &command->options->common, &scene));
    BOUGH_TRY(bough_run_create(command->arena, scene, &command->run));
    BOUGH_TRY(bough_open_channels(scene, &command->run.channels, &command->recorded));
    record(command);
    size_t n = (size_t)command->recorded.count;
    command->statistics = bough_arena_take(command->arena, (n + 1) * sizeof *command->statistics);
    command->build_s = bough_wall_clock() - began;
    return bough_ok();
}

static bough_status write_binary(const bough_run_command *command) {
    const bough_scene_output *output = &command->run.simulation->scene->simulation.output;
    if (!output->binary || !bough_is_ok(&command->run.outcome)) return bough_ok();
    return bough_binary_write(&(bough_binary_def){.folder = command->folder,
                                                  .title = title(command),
                                                  .channels = &command->recorded,
                                                  .interval = output->interval});
}

// Neither an older summary may stay beside new channels nor a new one beside older channels.
static bough_status replace_older(const bough_run_command *command) {
    static const char *const older[] = {"summary.json", "channels.outb", "report.html", "shape.svg"};
    for (size_t i = 0; i < sizeof older / sizeof *older; i++)
        BOUGH_TRY(bough_folder_remove(command->folder, older[i]));
    BOUGH_TRY(command->frames ? bough_frames_finish(command->frames) : bough_frames_remove(command->folder));
    return write_binary(command);
}

// Ends the files; the first failure is the outcome.
static bough_status close_results(bough_run_command *command) {
    bough_status *outcome = &command->run.outcome;
    bough_status status = bough_recorder_finish(command->recorder, outcome);
    bool finished = bough_is_ok(&status);
    if (finished) status = replace_older(command);
    if (bough_is_ok(outcome)) *outcome = status;
    if (!finished) return *outcome;
    status = bough_run_summarise(command);
    if (bough_is_ok(outcome)) *outcome = status;
    return bough_is_ok(outcome) ? bough_checkpoint_remove(command->folder) : *outcome;
}

// Warns during the run if short steps of the solver make it slow.
static void warn_of_work(bough_run_command *command) {
    const bough_simulation *s = command->run.simulation;
    if (command->warned || !s->validity->limit[BOUGH_LIMIT_STEPS].passed) return;
    char text[512];
    command->warned = true;
    bough_validity_describe(s, BOUGH_LIMIT_STEPS, text, sizeof text);
    if (command->run.progress) bough_progress_clear(command->run.progress);
    fprintf(stderr, "bough: warning: %s\n", text);
}

// After each step.
static bough_status after_step(void *self) {
    bough_run_command *command = self;
    warn_of_work(command);
    return bough_checkpoint_update(command);
}

// Finds the separate errors by further runs if the scene asks for them, and judges the error.
static bough_status judge(bough_run_command *command) {
    const bough_scene_simulation *x = &command->run.simulation->scene->simulation;
    bough_companion *c = command->run.companion;
    bough_error_shares *shares = &command->shares;
    if (x->error_shares) BOUGH_TRY(bough_error_shares_find(command->arena, c, bough_stop_requested, shares));
    return bough_error_judge(command->arena, c, bough_stop_requested, x->error_bound, shares,
                             command->warning);
}

static void step_all(bough_run_command *command) {
    bough_run *run = &command->run;
    const bough_master *m = run->simulation->master;
    if (m->verdict[0]) fprintf(stderr, "bough: warning: %s\n", m->verdict);
    bough_progress progress = bough_progress_start(m->time, m->duration, command->options->common.quiet);
    run->progress = &progress;
    run->stop = bough_stop_requested;
    run->after = after_step;
    run->steps_together = !(command->checkpoint.interval > 0);
    run->self = command;
    bough_run_all(run);
    bough_progress_clear(&progress);
    if (run->outcome.code != BOUGH_INTERRUPTED) return;
    run->outcome = bough_fail(BOUGH_INTERRUPTED, "%s; the results so far are in %.200s", run->outcome.message,
                              command->folder);
}

static const bough_option rows[] = {
    BOUGH_OPTION_SET,
    BOUGH_OPTION_OUT,
    BOUGH_OPTION_THREADS,
    BOUGH_OPTION_KERNELS,
    {"checkpoint", "TIME", "stores the state of the run at this interval of simulated time",
     bough_option_quantity, .offset = offsetof(bough_run_options, checkpoint), .dimension = BOUGH_TIME,
     .range = "> 0"},
    {"resume", NULL, "continues from the last checkpoint in the results folder", bough_option_flag,
     .offset = offsetof(bough_run_options, resume)},
    BOUGH_OPTION_QUIET,
    {0},
};

static bough_status run(bough_arena *arena, const void *options) {
    bough_run_command command = {.options = options, .arena = arena, .verdict = bough_ok()};
    BOUGH_TRY(bough_run_command_build(&command));
    bough_stop_listen();
    BOUGH_TRY(open_results(&command));
    step_all(&command);
    if (bough_is_ok(&command.run.outcome)) command.verdict = judge(&command);
    bough_status status = close_results(&command);
    bough_run_report(&command);
    return bough_is_ok(&status) ? command.verdict : status;
}

const bough_command bough_command_run = {
    .name = "run",
    .summary = "simulates a scene and writes its results",
    .operands = "SCENE",
    .option = rows,
    .size = sizeof(bough_run_options),
    .run = run,
};
