// bough import: a model of another program as a scene.
#include "apps/bough/import/import.h"

#include "apps/bough/cli/command.h"

enum { TRIAL_STEPS = 500 };

typedef struct import_options {
    bough_options common;
    bough_import_options model;
} import_options;

#define AT(member) .offset = offsetof(import_options, model.member)
#define MASS BOUGH_MASS, "[1e-3, 1e9]"
static const bough_option rows[] = {
    BOUGH_OPTION_OUT,
    {"wind", "FILE", "wind for the imported model; replaces its own: .bts, .wnd or uniform",
     bough_option_text, AT(wind)},
    {"controller", "FILE", "library with Bladed's interface; replaces the model's own", bough_option_text,
     AT(controller)},
    {"clamp-base", NULL, "imports an offshore turbine as clamped at the base of its tower", bough_option_flag,
     AT(clamp_base)},
    {"hub-mass", "KG", "mass of the hub of a WindIO turbine without one", bough_option_quantity, AT(hub_mass),
     MASS},
    {"nacelle-mass", "KG", "mass of the nacelle of a WindIO turbine without one", bough_option_quantity,
     AT(nacelle_mass), MASS},
    {0},
};

static bough_status import(bough_arena *arena, const void *given) {
    const import_options *options = given;
    const char *kind = options->common.operand, *file = options->common.operands[1];
    bool windio = strcmp(kind, "windio") == 0;
    if (!windio && strcmp(kind, "openfast") != 0) {
        return bough_fail(BOUGH_INVALID, "import: unknown kind '%.80s'; known: openfast, windio", kind);
    }
    bough_options named = options->common; // the folder's name comes from the model's
    named.operand = file;
    const char *folder = bough_out_folder(arena, &named);
    bough_import_options model = options->model;
    model.trial_steps = TRIAL_STEPS;
    if (!windio && (model.hub_mass > 0 || model.nacelle_mass > 0)) {
        return bough_fail(BOUGH_INVALID,
                          "--hub-mass and --nacelle-mass are only for windio: an OpenFAST model has masses");
    }
    bough_status status = windio ? bough_import_windio(file, folder, &model, stdout)
                                 : bough_import_openfast(file, folder, &model, stdout);
    if (bough_is_ok(&status)) printf("scene: %s/scene.yaml\n", folder);
    return status;
}

const bough_command bough_command_import = {
    .name = "import",
    .summary = "converts 'openfast MAIN.fst' or 'windio TURBINE.yaml' to a scene and lists what it took",
    .operands = "KIND FILE",
    .option = rows,
    .size = sizeof(import_options),
    .run = import,
};
