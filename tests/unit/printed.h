// What errors print, in their arena.
#pragma once

#include "apps/bough/config/text.h"

static inline const char *printed_errors(const bough_errors *errors) {
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    bough_errors_print(errors, stream);
    fclose(stream);
    const char *copy = bough_arena_string(errors->arena, text);
    free(text);
    return copy;
}
