#include "apps/bough/scene/fingerprint.h"

#include "apps/bough/scene/scene_files.h"
#include "core/base/input_file.h"

#include <stdio.h>
#include <string.h>

void bough_mix(uint64_t *hash, const void *bytes, size_t n) {
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < n; i++) *hash = (*hash ^ byte[i]) * UINT64_C(1099511628211);
}

void bough_mix_text(uint64_t *hash, const char *text) { bough_mix(hash, text, strlen(text) + 1); }

void bough_mix_file(uint64_t *hash, const char *path) {
    char block[4096], why[BOUGH_INPUT_REASON];
    FILE *file = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (!file) return;
    for (size_t n; (n = fread(block, 1, sizeof block, file)) > 0;) bough_mix(hash, block, n);
    fclose(file);
}

struct bough_file_sum {
    struct bough_file_sum *next;
    const char *path;
    uint64_t sum;
};

static uint64_t sum_of(bough_file_sums *sums, const char *path) {
    for (const struct bough_file_sum *s = sums->known; s; s = s->next) {
        if (strcmp(s->path, path) == 0) return s->sum;
    }
    struct bough_file_sum *s = bough_arena_take(sums->arena, sizeof *s);
    *s = (struct bough_file_sum){sums->known, bough_arena_string(sums->arena, path), BOUGH_FINGERPRINT_START};
    bough_mix_file(&s->sum, path);
    sums->known = s;
    return s->sum;
}

void bough_mix_scene(uint64_t *hash, bough_file_sums *sums, const bough_scene *scene) {
    bough_arena *own = bough_arena_child(sums->arena);
    bough_scene_files files = bough_scene_list_files(own, scene);
    for (int k = 0; k < files.n; k++) {
        uint64_t sum = sum_of(sums, files.item[k].path);
        bough_mix_text(hash, files.item[k].key);
        bough_mix(hash, &sum, sizeof sum);
    }
    bough_arena_destroy(own);
}

void bough_mix_program(uint64_t *hash) { bough_mix_file(hash, "/proc/self/exe"); }
