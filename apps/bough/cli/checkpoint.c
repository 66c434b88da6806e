#include "apps/bough/cli/run.h"

#include "apps/bough/results/folder.h"
#include "apps/bough/scene/scene_files.h"
#include "core/base/input_file.h"
#include "core/base/level.h"

#include <errno.h>
#include <unistd.h>

static const char name[] = "checkpoint.bin";

// The head of the file; the copy follows.
typedef struct head {
    char magic[16];
    uint64_t program, input; // fingerprints
    double interval;         // [s]
    uint64_t size;           // of the copy [bytes]
    uint64_t sum;            // of the copy and of the members above
} head;

static const char magic[sizeof((head *)0)->magic] = "bough state 2";

static uint64_t sum_of(const head *h, const char *copy) {
    uint64_t sum = BOUGH_FINGERPRINT_START;
    bough_mix(&sum, h, offsetof(head, sum));
    bough_mix(&sum, copy, h->size);
    return sum;
}

// -- the copy -------------------------------------------------------------------------------------

static void take_state(bough_run_command *command, bough_snapshot *s) {
    bough_run *run = &command->run;
    bough_run_snapshot(run, s);
    BOUGH_SNAPSHOT(s, command->rows, command->frames_kept);
    bough_snapshot_take(s, command->statistics,
                        (size_t)command->recorded.count * sizeof *command->statistics);
    BOUGH_SNAPSHOT(s, run->wall_s, run->cpu_s);
}

static void move(bough_run_command *command, bough_snapshot_move direction) {
    take_state(command, &(bough_snapshot){direction, command->checkpoint.copy, 0});
}

// -- options --------------------------------------------------------------------------------------

static bough_status check_samples(const bough_master *m, const char *of, double interval) {
    for (int i = 0; i < m->n_load; i++) {
        double period = m->load[i].period;
        if (!m->load[i].sample || bough_master_multiple(interval, period) > 0) continue;
        return bough_fail(BOUGH_INVALID,
                          "--checkpoint %.9g s is not a multiple of the %.9g s between the samples "
                          "of the air or the control%s",
                          interval, period, of);
    }
    return bough_ok();
}

// Between two samples a load depends on memory that is not in the copy.
static bough_status check_interval(const bough_run_command *command, double interval) {
    const bough_master *m = command->run.simulation->master;
    BOUGH_TRY(bough_simulation_storable(command->run.simulation));
    if (interval > m->duration) {
        return bough_fail(BOUGH_INVALID,
                          "--checkpoint %.9g s is longer than the run, %.9g s: there would be no checkpoint",
                          interval, m->duration);
    }
    if (bough_master_multiple(interval, m->macro_step) == 0) {
        return bough_fail(BOUGH_INVALID, "--checkpoint %.9g s is not a multiple of the macro step %.9g s",
                          interval, m->macro_step);
    }
    BOUGH_TRY(check_samples(m, "", interval));
    const bough_simulation *companion = command->run.companion->coarser.simulation;
    return companion ? check_samples(companion->master, " of the companion", interval) : bough_ok();
}

// Threads and folder do not count: they change no result. Kernels of another level round differently.
static void find_fingerprints(bough_run_command *command) {
    bough_checkpoint *c = &command->checkpoint;
    c->program = c->input = BOUGH_FINGERPRINT_START;
    bough_mix_program(&c->program);
    bough_mix_text(&c->program, bough_level_name(bough_level_chosen()));
    bough_mix_scene(&c->input, &(bough_file_sums){.arena = command->arena}, command->run.simulation->scene);
    for (int i = 0; i < command->options->common.set.n; i++)
        bough_mix_text(&c->input, command->options->common.set.text[i]);
}

static void take_memory(bough_run_command *command) {
    bough_snapshot measure = {.move = BOUGH_SNAPSHOT_MEASURE};
    take_state(command, &measure);
    command->checkpoint.size = measure.used;
    command->checkpoint.copy = bough_arena_take(command->arena, measure.used);
}

// -- reading --------------------------------------------------------------------------------------

static bough_status refuse(const char *path, const char *what) {
    return bough_fail(BOUGH_INVALID, "the checkpoint '%.200s' is %s; without --resume the run starts anew",
                      path, what);
}

// The sum is checked before all other members of the head are used.
static bough_status read_copy(bough_run_command *command, const char *path, FILE *file) {
    static const char damaged[] = "damaged";
    bough_checkpoint *c = &command->checkpoint;
    head h;
    if (fread(&h, sizeof h, 1, file) != 1) return refuse(path, damaged);
    if (memcmp(h.magic, magic, sizeof magic) != 0) {
        return bough_fail(BOUGH_INVALID, "'%.200s' is not a checkpoint of this version", path);
    }
    bool fits = h.size == c->size;
    if (fits &&
        (fread(c->copy, 1, c->size, file) != c->size || fgetc(file) != EOF || sum_of(&h, c->copy) != h.sum)) {
        return refuse(path, damaged);
    }
    if (h.program != c->program)
        return refuse(path, "of another version of the program or of other --kernels");
    if (h.input != c->input) return refuse(path, "of another scene or other settings");
    if (!fits) return refuse(path, damaged);
    if (c->interval > 0 && c->interval != h.interval) {
        return bough_fail(BOUGH_INVALID, "the run to resume has --checkpoint %.9g s, not %.9g s", h.interval,
                          c->interval);
    }
    c->interval = h.interval;
    return bough_ok();
}

static bough_status resume(bough_run_command *command) {
    char path[BOUGH_PATH_MAX];
    BOUGH_TRY(bough_folder_path(command->folder, name, path));
    char why[BOUGH_INPUT_REASON];
    FILE *file = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (!file && errno == ENOENT) {
        return bough_fail(
            BOUGH_INVALID,
            "nothing to resume: there is no '%.200s'; a run with --checkpoint writes it and removes it at its end",
            path);
    }
    if (!file) return bough_fail(BOUGH_IO, "cannot read '%.200s': %s", path, why);
    bough_status status = read_copy(command, path, file);
    fclose(file);
    BOUGH_TRY(status);
    BOUGH_TRY(check_interval(command, command->checkpoint.interval));
    move(command, BOUGH_SNAPSHOT_RESTORE);
    return bough_ok();
}

bough_status bough_checkpoint_open(bough_run_command *command) {
    const bough_run_options *o = command->options;
    bough_checkpoint *c = &command->checkpoint;
    c->interval = o->checkpoint;
    if (!(c->interval > 0) && !o->resume) return bough_ok();
    if (c->interval > 0) BOUGH_TRY(check_interval(command, c->interval));
    take_memory(command);
    find_fingerprints(command);
    return o->resume ? resume(command) : bough_ok();
}

// -- writing --------------------------------------------------------------------------------------

static bough_status write_copy(const bough_run_command *command) {
    const bough_checkpoint *c = &command->checkpoint;
    char path[BOUGH_PATH_MAX];
    FILE *file;
    head h = {.program = c->program, .input = c->input, .interval = c->interval, .size = c->size};
    memcpy(h.magic, magic, sizeof magic);
    h.sum = sum_of(&h, c->copy);
    BOUGH_TRY(bough_folder_open(command->folder, name, path, &file));
    errno = 0;
    bool good = fwrite(&h, sizeof h, 1, file) == 1 && fwrite(c->copy, 1, c->size, file) == c->size &&
                fflush(file) == 0 && fsync(fileno(file)) == 0;
    bough_status status =
        good ? bough_ok() : bough_fail(BOUGH_IO, "cannot write '%.200s': %s", path, strerror(errno));
    return bough_folder_close(path, file, status);
}

static bool is_due(const bough_run_command *command) {
    const bough_master *m = command->run.simulation->master;
    double intervals = m->time / command->checkpoint.interval;
    double off = fabs(intervals - round(intervals)) * command->checkpoint.interval;
    return off <= 1e-6 * m->macro_step && !bough_master_done(m);
}

// The rows that it refers to are on the disk before it is.
bough_status bough_checkpoint_update(void *self) {
    bough_run_command *command = self;
    if (!(command->checkpoint.interval > 0) || !is_due(command)) return bough_ok();
    bough_run_update_clock(&command->run);
    BOUGH_TRY(bough_recorder_keep(command->recorder, &command->rows));
    if (command->frames) BOUGH_TRY(bough_frames_keep(command->frames, &command->frames_kept));
    move(command, BOUGH_SNAPSHOT_SAVE);
    bough_status status = write_copy(command);
    move(command, BOUGH_SNAPSHOT_RESTORE);
    return status;
}

bough_status bough_checkpoint_remove(const char *folder) { return bough_folder_remove(folder, name); }
