// bough modes --sensitivity: the parameters to which frequency and damping of a mode are most sensitive.
#include "apps/bough/cli/modes_internal.h"
#include "apps/bough/results/folder.h"

enum { PRINTED = 10 };

// -- the mode -------------------------------------------------------------------------------------

static bool has_word(const bough_simulation *s, const bough_scene_mode *mode, const char *word,
                     size_t length) {
    const char *const words[] = {bough_modes_body(s, mode), bough_modes_shape(s, mode),
                                 bough_pattern_names[mode->pattern]};
    for (int k = 0; k < 3; k++)
        if (strlen(words[k]) == length && strncmp(words[k], word, length) == 0) return true;
    return false;
}

// Whether the mode has all words; a number among them, *number.
static bool has_words(const bough_simulation *s, const bough_scene_mode *mode, const char *text,
                      long *number) {
    for (;;) {
        text += strspn(text, " ");
        size_t length = strcspn(text, " ");
        if (length == 0) return true;
        char *end;
        long value = strtol(text, &end, 10);
        if (end == text + length)
            *number = value;
        else if (!has_word(s, mode, text, length))
            return false;
        text += length;
    }
}

// The index of the mode; below 0: there is none.
static int find_mode(const bough_simulation *s, const bough_vibration *v, const char *text) {
    char *end;
    long number = strtol(text, &end, 10);
    if (end > text && *end == 0) return number >= 1 && number <= v->found ? (int)number - 1 : -1;
    int found = 0;
    for (int k = 0; k < v->found; k++) {
        number = 1;
        if (has_words(s, &v->mode[k], text, &number) && ++found == number) return k;
    }
    return -1;
}

// -- results --------------------------------------------------------------------------------------

static void print(const bough_vibration *v, int k, const bough_sensitivities *found) {
    const bough_scene_mode *mode = &v->mode[k];
    printf(
        "sensitivity of mode %d, %.6g Hz, damping %.4f %%; change of its frequency and, in percentage points, of "
        "its damping ratio:\n%-44s %8s %12s %12s\n",
        k + 1, mode->frequency, 100 * mode->damping, "parameter", "by", "frequency %", "damping %");
    for (int i = 0; i < found->n && i < PRINTED; i++) {
        const bough_sensitivity *x = &found->list[i];
        printf("%-44s %8s %12.5f %12.5f\n", x->name, x->by, 100 * x->frequency, 100 * x->damping);
    }
}

static void write(const void *self, FILE *file) {
    const bough_sensitivities *found = self;
    fputs("parameter,changed by,change of the frequency relative to it (-),change of the damping ratio (-)\n",
          file);
    for (int i = 0; i < found->n; i++) {
        const bough_sensitivity *x = &found->list[i];
        fprintf(file, "%s,%s,%.6g,%.6g\n", x->name, x->by, x->frequency, x->damping);
    }
}

bough_status bough_modes_sensitivity(bough_arena *arena, bough_simulation *s, const bough_vibration *v,
                                     const char *wanted, const char *folder, bough_modes_dependence *found) {
    int k = find_mode(s, v, wanted);
    if (k < 0)
        return bough_fail(
            BOUGH_INVALID,
            "--sensitivity: none of the %d modes is '%.80s': take a number, or words of a row of the "
            "table, such as 'edge forward' or 'edge forward 2' for the second of them",
            v->found, wanted);
    bough_status status = bough_sensitivity_find(arena, s, v->time, &v->mode[k], &found->of);
    if (!bough_is_ok(&status)) return bough_fail(status.code, "mode %d: %.380s", k + 1, status.message);
    found->mode = k;
    print(v, k, &found->of);
    return bough_folder_write(folder, "sensitivity.csv", write, &found->of);
}
