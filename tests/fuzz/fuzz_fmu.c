#include "apps/bough/scene/scene_internal.h"
#include "tests/fuzz/fuzz.h"

#include <dirent.h>

// How many files and folders a folder has.
static int entries(const char *path) {
    DIR *folder = opendir(path);
    fuzz_demand(folder != NULL, path);
    int n = -2; // itself and the one above
    while (readdir(folder)) n++;
    closedir(folder);
    return n;
}

static void demand_reason(const bough_status *status) {
    bool reasoned = status->code == BOUGH_INVALID || status->code == BOUGH_IO;
    fuzz_demand(bough_is_ok(status) || (reasoned && status->message[0]), "a reason");
}

// Any bytes as an archive: all of it is unpacked into a folder of its own, beside which nothing is written
// and of which nothing is left.
static void as_archive(const uint8_t *data, size_t size) {
    const char *path = fuzz_file("some.fmu", data, size), *folder = NULL;
    bough_arena *arena = bough_arena_create();
    int before = entries(fuzz_folder());
    setenv("TMPDIR", fuzz_folder(), 1);
    bough_status status = bough_fmu_archive_unpack(arena, path, &folder);
    demand_reason(&status);
    fuzz_demand(entries(fuzz_folder()) == before + 1, "one folder");
    bough_arena_destroy(arena);
    fuzz_demand(entries(fuzz_folder()) == before, "no folder");
}

// The same bytes as the description of an FMU that is unpacked.
static void as_description(const uint8_t *data, size_t size) {
    bough_arena *arena = bough_arena_create();
    bough_fmu_description d;
    fuzz_file("modelDescription.xml", data, size);
    bough_status status = bough_fmu_describe(arena, "some.fmu", fuzz_folder(), &d);
    demand_reason(&status);
    for (int k = 0; bough_is_ok(&status) && k < d.n_variable; k++) {
        const char *name = d.variable[k].name;
        bough_fmu_scaled(&d, &d.variable[k]);
        fuzz_demand(!name || bough_fmu_find(&d, name) != NULL, "every variable by its name");
    }
    bough_arena_destroy(arena);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    as_archive(data, size);
    as_description(data, size);
    return 0;
}
