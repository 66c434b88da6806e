#include "apps/bough/results/report.h"
#include "tests/fuzz/fuzz.h"

// Any bytes as each file of a results folder.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    bool found;
    fuzz_file("channels.out", data, size);
    fuzz_file("frames.pvd", data, size);
    fuzz_file("frame.vtp", data, size);
    FILE *out = tmpfile();
    fuzz_demand(out != NULL, "a file");
    bough_report_channels(fuzz_folder(), out, &found);
    bough_report_frames(fuzz_folder(), out, &found);
    fclose(out);
    return 0;
}
