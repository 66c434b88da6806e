#include "apps/scene/fingerprint.h"

#include "apps/config/schema.h"
#include "core/input_file.h"

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

static void mix_node_file(uint64_t *hash, const bough_node *node) {
    if (node) bough_mix_file(hash, node->file);
}

void bough_mix_scene(uint64_t *hash, const bough_scene *scene) {
    bough_mix_file(hash, scene->file);
    for (int i = 0; i < scene->n_body; i++) mix_node_file(hash, scene->body[i].rod.structure.node);
    mix_node_file(hash, scene->aero.blade.node);
    mix_node_file(hash, scene->aero.polars.node);
    if (scene->aero.wind.def.file) bough_mix_file(hash, scene->aero.wind.def.file);
}

void bough_mix_program(uint64_t *hash) { bough_mix_file(hash, "/proc/self/exe"); }
