#include "apps/bough/results/report.h"
#include "tests/fuzz/fuzz.h"

// Any bytes as each file of a results folder.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    bough_arena *arena = bough_arena_create();
    bool found;
    fuzz_file("channels.out", data, size);
    fuzz_file("frames.pvd", data, size);
    fuzz_file("frame.vtp", data, size);
    FILE *out = tmpfile();
    fuzz_demand(arena && out, "memory and a file");
    bough_report_channels(arena, fuzz_folder(), out, &found);
    bough_report_frames(arena, fuzz_folder(), out, &found);
    fclose(out);
    bough_arena_destroy(arena);
    return 0;
}
