#include "tests/verification/verification.h"

#include "apps/bough/config/schema.h"
#include "tests/verification/blade_models.h"
#include "tests/verification/verify.h"

static const bough_verification_kind kinds[] = {
    {"verify", bough_verify_read, bough_verify_perform},
    {"blade-models", bough_blade_models_read, bough_blade_models_perform},
};

static const bough_verification_kind *find_kind(const bough_node *root, bough_errors *errors) {
    const bough_node *kind = bough_node_find(root, "kind");
    char shown[64];
    for (size_t i = 0; kind && kind->kind == BOUGH_SCALAR && i < sizeof kinds / sizeof *kinds; i++) {
        if (strcmp(kind->text, kinds[i].name) == 0) return &kinds[i];
    }
    bough_errors_add(errors, kind ? kind : root, "kind", "expected verify or blade-models, got %s",
                     kind ? bough_node_shown(kind, shown) : "none");
    return NULL;
}

bough_status bough_verification_read(bough_arena *arena, const char *path, bough_errors *errors,
                                     bough_verification *verification) {
    *verification = (bough_verification){0};
    const bough_node *root = bough_text_read(arena, path, errors);
    if (root) verification->kind = find_kind(root, errors);
    if (verification->kind) {
        verification->study = verification->kind->read(arena, path, root, errors);
    }
    return bough_errors_status(errors, path, "study");
}

bough_status bough_verification_perform(bough_arena *arena, const bough_verification *verification,
                                        const bough_verification_options *options) {
    return verification->kind->perform(arena, verification->study, options);
}
