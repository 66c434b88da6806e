// Springs, bushings, closures, applied wrenches and recorded points of a scene as parts of the tree.
#ifndef BOUGH_APPS_SIMULATION_FORCE_LINK_H
#define BOUGH_APPS_SIMULATION_FORCE_LINK_H

#include "apps/bough/scene/scene.h"
#include "core/tree/tree.h"

// The markers of the tree and the elements between them. The first markers are those of the beams, which the
// caller fills.
typedef struct bough_force_link {
    int n_marker;   // of the tree, those of the beams included
    int first_own;  // the first of those that the scene names
    int hub;        // on which the hub's drag acts; −1: none
    bough_marker_def *marker;
    bough_spring_def *spring;
    bough_bushing_def *bushing;
    bough_closure_def *closure;
    int n_applied;
    bough_applied_def *applied;
} bough_force_link;

// Takes the memory, with room for so many markers of beams.
void bough_force_link_take(bough_arena *arena, const bough_scene *scene, int n_beam,
                           bough_force_link *link);

// Fills everything, the markers from n_marker on.
void bough_force_link_fill(const bough_scene *scene, bough_force_link *link);

// Turns the second markers of the bushings so that nothing acts at the state of `data`.
void bough_force_link_rest(const bough_scene *scene, const bough_tree_data *data, bough_tree *tree);

#endif
