#include "apps/bough/cli/memory.h"

#include <stdio.h>
#include <sys/resource.h>

// getrusage alone would not do: on Linux its figure survives exec, so that a large program that
// starts this one passes its own memory on.
long long bough_peak_memory(void) {
    long long kilobytes = 0;
    char line[128];
    FILE *file = fopen("/proc/self/status", "r");
    while (file && kilobytes == 0 && fgets(line, sizeof line, file)) {
        if (sscanf(line, "VmHWM: %lld kB", &kilobytes) != 1) kilobytes = 0;
    }
    if (file) fclose(file);
    struct rusage usage;
    if (kilobytes == 0 && getrusage(RUSAGE_SELF, &usage) == 0) kilobytes = usage.ru_maxrss;
    return 1024 * kilobytes;
}
