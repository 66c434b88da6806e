#include "apps/bough/checkpoint.h"

#include "apps/bough/run.h"
#include "apps/config/schema.h"
#include "apps/output/folder.h"
#include "apps/scene/fingerprint.h"
#include "core/input_file.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

static const char name[] = "checkpoint.bin";

// What the file begins with; the copy follows.
typedef struct head {
    char magic[16];
    uint64_t program, input; // fingerprints
    double interval;         // [s]
    uint64_t size;           // of the copy [bytes]
    uint64_t sum;            // of the copy and of what is above
} head;

static const char magic[sizeof((head *)0)->magic] = "bough state 1";

static uint64_t sum_of(const head *h, const char *copy) {
    uint64_t sum = BOUGH_FINGERPRINT_START;
    bough_mix(&sum, h, offsetof(head, sum));
    bough_mix(&sum, copy, h->size);
    return sum;
}

// -- what is in it --------------------------------------------------------------------------------

// Work is counted by the solvers of this process; `earlier` adds that of the ones before it.
static void take_statistics(bough_run *run, bough_snapshot *s) {
    const bough_assembly *a = run->simulation->master->assembly;
    for (int i = 0; i < a->n_member; i++) {
        bough_statistics *earlier = &run->earlier[i];
        bough_statistics total = bough_run_statistics(run, i), now = total;
        bough_statistics_subtract(&now, earlier);
        bough_snapshot_take(s, &total, sizeof total);
        bough_statistics_subtract(&total, &now);
        *earlier = total;
    }
}

static void take_probe(bough_error_probe *probe, int n, bough_snapshot *s) {
    bough_snapshot_take(s, &probe->batches, sizeof probe->batches);
    bough_snapshot_doubles(s, probe->largest, n);
    bough_snapshot_doubles(s, probe->low, n);
    bough_snapshot_doubles(s, probe->high, n);
}

static void take_run(bough_run *run, bough_snapshot *s) {
    bough_simulation_snapshot(run->simulation, s);
    take_statistics(run, s);
    take_probe(&run->probe, run->channels.count, s);
    bough_snapshot_take(s, &run->next_row, sizeof run->next_row);
    bough_snapshot_take(s, &run->recorded, sizeof run->recorded);
    bough_snapshot_take(s, &run->next_frame, sizeof run->next_frame);
    bough_snapshot_take(s, &run->rows, sizeof run->rows);
    bough_snapshot_take(s, &run->frames_kept, sizeof run->frames_kept);
    bough_snapshot_take(s, &run->wall_s, sizeof run->wall_s);
    bough_snapshot_take(s, &run->cpu_s, sizeof run->cpu_s);
}

static void move(bough_run *run, bough_snapshot_move direction) {
    take_run(run, &(bough_snapshot){direction, run->checkpoint.copy, 0});
}

// -- options --------------------------------------------------------------------------------------

static bough_status read_interval(const char *text, double *interval) {
    char why[160];
    if (bough_quantity(text, BOUGH_TIME, interval, why) && *interval > 0) return bough_ok();
    return bough_fail(BOUGH_INVALID, "--checkpoint expects a time such as 5s, got '%.80s'", text);
}

// Between samples a load has a past that is not in the copy.
static bough_status check_interval(const bough_run *run, double interval) {
    const bough_master *m = run->simulation->master;
    bough_status status = bough_simulation_storable(run->simulation);
    if (!bough_is_ok(&status)) return status;
    if (run->simulation->scene->simulation.output.vertices > 0) {
        return bough_fail(BOUGH_INVALID, "--checkpoint: vertices.h5 cannot be continued; leave out "
                                         "simulation.output.vertices, or store frames");
    }
    if (interval > m->duration) {
        return bough_fail(BOUGH_INVALID, "--checkpoint %.9g s is longer than the run, %.9g s: none "
                                         "would be written", interval, m->duration);
    }
    if (bough_master_multiple(interval, m->macro_step) == 0) {
        return bough_fail(BOUGH_INVALID,
                          "--checkpoint %.9g s is not a multiple of the macro step %.9g s",
                          interval, m->macro_step);
    }
    for (int i = 0; i < m->n_load; i++) {
        if (bough_master_multiple(interval, m->load[i].period) > 0) continue;
        return bough_fail(BOUGH_INVALID,
                          "--checkpoint %.9g s is not a multiple of the %.9g s between the samples "
                          "of the air or the control",
                          interval, m->load[i].period);
    }
    return bough_ok();
}

// Threads and the folder change no result.
static void find_fingerprints(bough_run *run) {
    bough_checkpoint *c = &run->checkpoint;
    c->program = c->input = BOUGH_FINGERPRINT_START;
    bough_mix_program(&c->program);
    bough_mix_scene(&c->input, run->simulation->scene);
    for (int i = 0; i < run->options->n_set; i++) bough_mix_text(&c->input, run->options->set[i]);
}

static bough_status take_memory(bough_run *run) {
    bough_snapshot measure = {.move = BOUGH_SNAPSHOT_MEASURE};
    take_run(run, &measure);
    run->checkpoint.size = measure.used;
    run->checkpoint.copy = bough_arena_take(run->arena, measure.used);
    return run->checkpoint.copy ? bough_ok() : bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
}

// -- reading --------------------------------------------------------------------------------------

static bough_status damaged(const char *path) {
    return bough_fail(BOUGH_INVALID, "the checkpoint '%.200s' is damaged; without --resume the run "
                                     "starts anew",
                      path);
}

static bough_status other(const char *path, const char *what) {
    return bough_fail(BOUGH_INVALID, "the checkpoint '%.200s' is of %s; without --resume the run "
                                     "starts anew",
                      path, what);
}

// The sum is looked at first: only then the rest means what it says.
static bough_status read_copy(bough_run *run, const char *path, FILE *file) {
    bough_checkpoint *c = &run->checkpoint;
    head h;
    if (fread(&h, sizeof h, 1, file) != 1) return damaged(path);
    if (memcmp(h.magic, magic, sizeof magic) != 0) {
        return bough_fail(BOUGH_INVALID, "'%.200s' is no checkpoint of this version", path);
    }
    bool fits = h.size == c->size;
    if (fits && (fread(c->copy, 1, c->size, file) != c->size || fgetc(file) != EOF ||
                 sum_of(&h, c->copy) != h.sum)) {
        return damaged(path);
    }
    if (h.program != c->program) return other(path, "another version of the program");
    if (h.input != c->input) return other(path, "another scene or other settings");
    if (!fits) return damaged(path);
    if (c->interval > 0 && c->interval != h.interval) {
        return bough_fail(BOUGH_INVALID, "the run to resume has --checkpoint %.9g s, not %.9g s",
                          h.interval, c->interval);
    }
    c->interval = h.interval;
    return bough_ok();
}

static bough_status resume(bough_run *run) {
    char path[BOUGH_PATH_MAX];
    bough_status status = bough_folder_path(run->folder, name, path);
    if (!bough_is_ok(&status)) return status;
    char why[BOUGH_INPUT_REASON];
    FILE *file = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (!file && errno == ENOENT) {
        return bough_fail(BOUGH_INVALID, "nothing to resume: there is no '%.200s'; a run with "
                                         "--checkpoint writes it and removes it at its end",
                          path);
    }
    if (!file) {
        return bough_fail(BOUGH_IO, "cannot read '%.200s': %s", path, why);
    }
    status = read_copy(run, path, file);
    fclose(file);
    if (bough_is_ok(&status)) status = check_interval(run, run->checkpoint.interval);
    if (bough_is_ok(&status)) move(run, BOUGH_SNAPSHOT_RESTORE);
    return status;
}

bough_status bough_checkpoint_open(bough_run *run) {
    const bough_options *o = run->options;
    bough_checkpoint *c = &run->checkpoint;
    if (!o->checkpoint && !o->resume) return bough_ok();
    bough_status status = o->checkpoint ? read_interval(o->checkpoint, &c->interval) : bough_ok();
    if (bough_is_ok(&status) && o->checkpoint) status = check_interval(run, c->interval);
    if (bough_is_ok(&status)) status = take_memory(run);
    if (!bough_is_ok(&status)) return status;
    find_fingerprints(run);
    return o->resume ? resume(run) : status;
}

// -- writing --------------------------------------------------------------------------------------

static bough_status write_copy(const bough_run *run) {
    const bough_checkpoint *c = &run->checkpoint;
    char path[BOUGH_PATH_MAX];
    FILE *file;
    head h = {.program = c->program, .input = c->input, .interval = c->interval, .size = c->size};
    memcpy(h.magic, magic, sizeof magic);
    h.sum = sum_of(&h, c->copy);
    bough_status status = bough_folder_path(run->folder, name, path);
    if (bough_is_ok(&status)) status = bough_folder_open_partial(path, &file);
    if (!bough_is_ok(&status)) return status;
    errno = 0;
    bool good = fwrite(&h, sizeof h, 1, file) == 1 &&
                fwrite(c->copy, 1, c->size, file) == c->size && fflush(file) == 0 &&
                fsync(fileno(file)) == 0;
    if (good) return bough_folder_commit(path, file);
    status = bough_fail(BOUGH_IO, "cannot write '%.200s': %s", path, strerror(errno));
    bough_folder_discard(path, file);
    return status;
}

static bool is_due(const bough_run *run) {
    const bough_master *m = run->simulation->master;
    double turns = m->time / run->checkpoint.interval;
    double off = fabs(turns - round(turns)) * run->checkpoint.interval;
    return off <= 1e-6 * m->macro_step && !bough_master_done(m);
}

// The rows that it counts on are on the disk before it is.
bough_status bough_checkpoint_update(bough_run *run) {
    if (!(run->checkpoint.interval > 0) || !is_due(run)) return bough_ok();
    bough_run_settle_clock(run);
    bough_status status = bough_recorder_keep(run->recorder, &run->rows);
    if (bough_is_ok(&status) && run->frames) {
        status = bough_frames_keep(run->frames, &run->frames_kept);
    }
    if (!bough_is_ok(&status)) return status;
    move(run, BOUGH_SNAPSHOT_SAVE);
    status = write_copy(run);
    move(run, BOUGH_SNAPSHOT_RESTORE);
    return status;
}

bough_status bough_checkpoint_remove(const char *folder) {
    return bough_folder_remove(folder, name);
}
