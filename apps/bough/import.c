// bough import: a foreign model as a scene.
#include "apps/import/import.h"

#include "apps/bough/verb.h"

#include <string.h>

bough_status bough_verb_import(bough_arena *arena, const bough_options *options) {
    (void)arena;
    if (strcmp(options->operand, "openfast") != 0) {
        return bough_fail(BOUGH_INVALID, "import: unknown kind '%.80s'; known: openfast",
                          options->operand);
    }
    if (!options->out) return bough_fail(BOUGH_INVALID, "import: missing --out DIR");
    bough_status status = bough_import_openfast(options->second, options->out, stdout);
    if (bough_is_ok(&status)) printf("scene: %s/scene.yaml\n", options->out);
    return status;
}
