#include "apps/bough/cli/run.h"
#include "tests/fuzz/fuzz.h"

#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { ROOM = 1 << 17 };

static const char scene[] = BOUGH_SOURCE_DIR "/apps/beams/rubber-bar.yaml";
static const char *set[] = {"bodies[0].rod.segments=4", "simulation.duration=1000 s"};
static bough_run_options options = {.common = {.operand = scene, .set = {2, set}, .quiet = true}};
static bough_run_command command;
static uint8_t good[ROOM], changed[ROOM];
static size_t good_size;

static size_t load(uint8_t *bytes) {
    char path[SCRATCH_PATH];
    snprintf(path, sizeof path, "%s/checkpoint.bin", fuzz_folder());
    FILE *file = fopen(path, "rb");
    size_t size = file ? fread(bytes, 1, ROOM, file) : 0;
    if (file) fclose(file);
    return size;
}

// A run that is killed leaves it.
static void make_good(void) {
    options.common.out = fuzz_folder();
    pid_t child = fork();
    if (child == 0) {
        options.checkpoint = 1e-3;
        bough_command_run.run(bough_arena_create(), &options);
        _exit(1);
    }
    while (good_size == 0 && waitpid(child, NULL, WNOHANG) == 0) {
        good_size = load(good);
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    fuzz_demand(good_size > 0 && good_size < ROOM, "a checkpoint");
}

static void start(void) {
    if (command.arena) return;
    make_good();
    options.resume = true;
    command =
        (bough_run_command){.options = &options, .arena = bough_arena_create(), .folder = fuzz_folder()};
    bough_status status = bough_run_command_build(&command);
    fuzz_demand(bough_is_ok(&status), "a run");
}

// Three bytes are a change of the good file: where, and by what; by nothing: it ends there. Any
// other bytes are the whole file.
static size_t change(const uint8_t *data, size_t size) {
    size_t n = good_size;
    if (size > 0 && data[0] >= 0x80) {
        memcpy(changed, data, size < ROOM ? size : ROOM);
        return size < ROOM ? size : ROOM;
    }
    memcpy(changed, good, good_size);
    for (size_t i = 0; i + 3 <= size && n > 0; i += 3) {
        size_t at = ((size_t)data[i] << 8 | data[i + 1]) % n;
        changed[at] ^= data[i + 2];
        if (data[i + 2] == 0) n = at;
    }
    return n;
}

// Only the checkpoint itself is accepted.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    start();
    size_t n = change(data, size);
    fuzz_file("checkpoint.bin", changed, n);
    bough_arena *arena = command.arena;
    command.arena = bough_arena_create();
    command.checkpoint = (bough_checkpoint){0};
    bough_status status = bough_checkpoint_open(&command);
    bough_arena_destroy(command.arena);
    command.arena = arena;
    bool same = n == good_size && memcmp(changed, good, n) == 0;
    fuzz_demand(bough_is_ok(&status) == same, "accepted as it was written, else refused");
    fuzz_demand(same || (status.code == BOUGH_INVALID && status.message[0]), "a reason");
    return 0;
}
