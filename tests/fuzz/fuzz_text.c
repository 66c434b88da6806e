#include "apps/bough/config/text.h"
#include "tests/fuzz/fuzz.h"

// The tree of any text: memory in proportion to its size.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    bough_arena *arena = bough_arena_create();
    bough_errors errors = {.arena = arena};
    bough_node *root = bough_text_parse(arena, "f", (const char *)data, size, &errors);
    fuzz_demand((root == NULL) == (errors.n > 0), "a tree, or why there is none");
    fuzz_demand(bough_arena_bytes(arena) < 400 * size + 300000, "memory in proportion");
    bough_arena_destroy(arena);
    return 0;
}
