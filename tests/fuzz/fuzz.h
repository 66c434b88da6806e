// What a fuzz target is given and must give; the same for libFuzzer and for tests/fuzz/driver.c.
#pragma once

#include "tests/unit/scratch_name.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

// Reads one input; must end, whatever it holds. Returns 0.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

// A condition that every input must meet.
static inline void fuzz_demand(int met, const char *what) {
    if (met) return;
    fprintf(stderr, "broken promise: %s\n", what);
    abort();
}

static inline const char *fuzz_folder(void);

static inline void fuzz_clean(void) {
    char command[SCRATCH_PATH];
    snprintf(command, sizeof command, "rm -rf %s", fuzz_folder());
    if (system(command) != 0) fputs("files of the test are left\n", stderr);
}

// A folder of this process for parsers that read files, until it ends.
static inline const char *fuzz_folder(void) {
    static char folder[SCRATCH_NAME];
    static int made;
    if (made) return folder;
    fuzz_demand(mkdtemp(scratch_name(folder)) != NULL, "a folder for files");
    made = 1;
    atexit(fuzz_clean);
    return folder;
}

// Writes the folder's file of that name; its path.
static inline const char *fuzz_file(const char *name, const void *data, size_t size) {
    static char path[SCRATCH_PATH];
    snprintf(path, sizeof path, "%s/%s", fuzz_folder(), name);
    remove(path); // emptying a file instead makes some file systems write it to the disk
    FILE *file = fopen(path, "wb");
    fuzz_demand(file && fwrite(data, 1, size, file) == size, "a file");
    fclose(file);
    return path;
}
