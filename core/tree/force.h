// Forces on the rigid tree besides those of joints and ports: springs and bushings between markers,
// applied wrenches. Wrenches are on the tree at the marker's origin in marker axes; changes are
// those along small changes of the markers' poses (twists in marker axes) and of their twists.
#pragma once

#include "core/tree/tree.h"

// Elements act between two markers. They have numbers, the springs before the bushings.

// The wrenches on the two ends of an element.
typedef struct bough_force_pair {
    bough_wrench on[2];
} bough_force_pair;

static inline int bough_tree_n_elements(const bough_tree *tree) { return tree->n_springs + tree->n_bushings; }

// The frame of an element's end 0 or 1.
const bough_frame *bough_element_frame(const bough_tree *tree, int element, int end);

// Its wrenches and the energy it stores [J], after bough_tree_kinematics.
bough_force_pair bough_element_force(const bough_tree *tree, const bough_tree_data *data, int element,
                                     double *energy);

// Their change along changes of the two poses and twists.
bough_force_pair bough_element_change(const bough_tree *tree, const bough_tree_data *data, int element,
                                      const bough_twist shift[2], const bough_twist rate[2]);

// Length of a spring [m] and the force that draws its ends together [N]; `direction` is the unit
// vector in the ground from its first marker to its second.
double bough_tree_spring(const bough_tree *tree, const bough_tree_data *data, int spring, double *tension,
                         bough_vec3 *direction);

// The applied wrench k at t, and its change along a change of the marker's pose.
bough_wrench bough_applied_force(const bough_tree *tree, const bough_tree_data *data, int k, double t);
bough_wrench bough_applied_change(const bough_tree *tree, const bough_tree_data *data, int k, double t,
                                  bough_twist shift);
