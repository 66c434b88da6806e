// bough import: a foreign model as a scene.
#include "apps/bough/import/import.h"

#include "apps/bough/cli/open.h"
#include "apps/bough/cli/verb.h"

#include <string.h>

enum { TRIAL_STEPS = 500 };

bough_status bough_verb_import(bough_arena *arena, const bough_options *options) {
    bool windio = strcmp(options->operand, "windio") == 0;
    if (!windio && strcmp(options->operand, "openfast") != 0) {
        return bough_fail(BOUGH_INVALID, "import: unknown kind '%.80s'; known: openfast, windio",
                          options->operand);
    }
    bough_options named = *options; // the folder's name comes from the model's
    named.operand = options->second;
    const char *folder = bough_out_folder(arena, &named);
    if (!windio && (options->hub_mass > 0 || options->nacelle_mass > 0)) {
        return bough_fail(BOUGH_INVALID,
                          "--hub-mass and --nacelle-mass are only for windio: an OpenFAST model has masses");
    }
    const bough_import_options given = {.wind = options->wind,
                                        .controller = options->controller,
                                        .clamp_base = options->clamp_base,
                                        .hub_mass = options->hub_mass,
                                        .nacelle_mass = options->nacelle_mass,
                                        .trial_steps = TRIAL_STEPS};
    bough_status status = windio ? bough_import_windio(options->second, folder, &given, stdout)
                                 : bough_import_openfast(options->second, folder, &given, stdout);
    if (bough_is_ok(&status)) printf("scene: %s/scene.yaml\n", folder);
    return status;
}
