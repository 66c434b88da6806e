// What a scene may say but seldom means.
#include "apps/scene/scene_internal.h"

#include <math.h>

// An inertia matrix is ∫(|r|² 1 − r rᵀ)dm, so that half its trace less itself is ∫r rᵀdm: not below
// zero about any axis, where no principal moment exceeds the sum of the other two. Thin bodies come
// close to that, in published data by a part in a thousand beyond it.
static bool has_distribution(const double v[6]) {
    double half = 0.505 * (v[0] + v[1] + v[2]);
    double spread[6] = {half - v[0], half - v[1], half - v[2], -v[3], -v[4], -v[5]};
    return bough_scene_semidefinite(spread);
}

// Known about one axis only, as of mechanisms in a plane and of shafts.
static bool is_about_one_axis(const double v[6]) { return (v[0] != 0) + (v[1] != 0) + (v[2] != 0) == 1; }

static void warn_inertia(const bough_scene_body *b, FILE *stream) {
    if (b->fidelity == BOUGH_SCENE_FMU) return; // what is left to the carrier is no body by itself
    const double *v = b->inertia;
    if (has_distribution(v) || is_about_one_axis(v)) return;
    const bough_node *at = bough_link_value(b->node, "inertia");
    if (at->line > 0) fprintf(stream, "%s:%d:%d: ", at->file, at->line, at->column);
    fprintf(stream,
            "warning: body '%s': no mass distribution has the inertia [%g, %g, %g] about principal "
            "or other axes: none may exceed the sum of the other two. Right if it holds gears or a "
            "generator referred to this shaft\n",
            b->name, v[0], v[1], v[2]);
}

void bough_scene_warn(const bough_scene *scene, FILE *stream) {
    const bough_node *last = NULL;
    for (int i = 0; i < scene->n_body; i++) {
        const bough_scene_body *b = &scene->body[i];
        if (b->node == last) continue; // repeated
        last = b->node;
        if (bough_node_find(b->node, "inertia")) warn_inertia(b, stream);
    }
}
