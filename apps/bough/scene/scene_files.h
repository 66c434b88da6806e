// The files that a scene is made of: what a copy of it needs and what its results depend on.
#pragma once

#include "apps/bough/scene/scene.h"

typedef struct bough_scene_file {
    const char *key;  // key that names the file, "control.library"; "" for the scene itself
    const char *path; // as it is opened
    bool absolute;    // the scene names it by an absolute path
} bough_scene_file;

typedef struct bough_scene_files {
    int n;
    bough_scene_file *item; // (n)
} bough_scene_files;

// The scene itself, then every file that a key names, in the order of reading and each once; of an FMU the
// files of its folder. A controller's input file has a form that only the controller knows: every word
// of it that is the name of a file beside it counts.
bough_scene_files bough_scene_list_files(bough_arena *arena, const bough_scene *scene);

// -- fingerprints: FNV-1a, against mistakes, not against malice -----------------------------------

#define BOUGH_FINGERPRINT_START UINT64_C(14695981039346656037)

void bough_mix(uint64_t *hash, const void *bytes, size_t n);
void bough_mix_text(uint64_t *hash, const char *text);

// Fingerprints of files, so that each is read once for all scenes that share it.
typedef struct bough_file_sums {
    bough_arena *arena;
    struct bough_file_sum *known; // NULL at the beginning
} bough_file_sums;

// Adds the content of all files of bough_scene_list_files.
void bough_mix_scene(uint64_t *hash, bough_file_sums *sums, const bough_scene *scene);

// Adds the running program, on systems that give access to it.
void bough_mix_program(uint64_t *hash);
