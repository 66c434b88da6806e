// A controller for the tests: torque proportional to the generator's speed, one pitch for all. Its
// input file's name says what else it does.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void DISCON(float *swap, int *fail, char *input, char *output, char *message);

// Puts one more letter into the file: how many it has.
static long marks(const char *path) {
    FILE *file = fopen(path, "a");
    if (!file) return 0;
    fputc('x', file);
    long n = ftell(file);
    fclose(file);
    return n;
}

void DISCON(float *swap, int *fail, char *input, char *output, char *message) {
    int n = (int)swap[49];
    (void)output;
    *fail = 0;
    FILE *file = n > 3 && strcmp(input + n - 3, ".in") == 0 ? fopen(input, "r") : NULL;
    float gain = 100; // or the first number of the input file
    if (file && fscanf(file, "%f", &gain) != 1) *fail = -1;
    if (file) fclose(file);
    swap[46] = gain * swap[19];
    swap[44] = 0.1f + 0.001f * swap[1];
    for (int b = 0; b < 3; b++) swap[41 + b] = 0.2f + 0.1f * (float)b;
    static float before; // of which a library has one
    if (strcmp(input, "memory") == 0) swap[46] = 50 * (swap[19] + before);
    before = swap[19];
    if (n != (int)strlen(input)) *fail = -1;
    if (strcmp(input, "individual") == 0) swap[27] = 1;
    if (strcmp(input, "count") == 0) swap[46] = swap[0];
    if (strncmp(input, "record ", 7) == 0) swap[46] = swap[atoi(input + 7) - 1];
    if (strcmp(input, "nan") == 0) swap[46] = NAN;
    if (strcmp(input, "warn") == 0) *fail = 1;
    const char *slash = strrchr(input, '/');
    if (slash && strcmp(slash, "/crash") == 0) abort();
    if (slash && strcmp(slash, "/refuse") == 0) *fail = -1;
    if (slash && strcmp(slash, "/often") == 0 && swap[2] > 0.015f) *fail = -1; // its sampling time
    // a run and its companion each begin once
    if (slash && strcmp(slash, "/fifth") == 0 && swap[0] == 0) *fail = marks(input) < 5 ? -1 : 0;
    if (strcmp(input, "fail") == 0 && swap[1] > 0.5f) {
        *fail = -1;
        snprintf(message, (size_t)swap[48], "too late");
    }
}
