// Whether two runs are of the same input: FNV-1a, against mistakes, not against malice.
#ifndef BOUGH_APPS_SCENE_FINGERPRINT_H
#define BOUGH_APPS_SCENE_FINGERPRINT_H

#include "apps/bough/scene/scene.h"

#include <stdint.h>

#define BOUGH_FINGERPRINT_START UINT64_C(14695981039346656037)

void bough_mix(uint64_t *hash, const void *bytes, size_t n);
void bough_mix_text(uint64_t *hash, const char *text);

// What the file holds; nothing of one that cannot be read.
void bough_mix_file(uint64_t *hash, const char *path);

// Sums of files, so that each is read once for scenes that share it.
typedef struct bough_file_sums {
    bough_arena *arena;
    struct bough_file_sum *known; // NULL at the beginning
} bough_file_sums;

// What all files of bough_scene_list_files hold.
void bough_mix_scene(uint64_t *hash, bough_file_sums *sums, const bough_scene *scene);

// The running program, where the system shows it.
void bough_mix_program(uint64_t *hash);

#endif
