// What the files that build a simulation share among themselves.
#ifndef BOUGH_APPS_SIMULATION_BUILD_INTERNAL_H
#define BOUGH_APPS_SIMULATION_BUILD_INTERNAL_H

#include "apps/bough/model/simulation.h"
#include "apps/bough/model/force_link.h"

// What is gathered while building; the pieces point into the arena.
typedef struct bough_builder {
    bough_arena *arena;
    const bough_scene *scene;
    bough_simulation *s;
    bough_body_def *body;       // (n_body + n_end): the tree's body i is the scene's body i; after
                                // them what each carrying rod ends in
    bough_end_def *end;         // (n_end)
    bough_force_link force;     // markers, those of the beams first, and what acts on them
    bough_port_def *port;       // (n_rod)
    bough_joint_load_def *load; // (n_load): those on joints
    int n_load;
    bough_assembly_member *member; // leader, then rods
    bough_connection *connection; // two per rod, two more of one that carries bodies
    int n_connection;
    double *event; // corners of loads and of the aerodynamics
    int n_event;
} bough_builder;

// The beams' meshes, and the bodies of the tree.
bough_status bough_build_bodies(bough_builder *b);

#endif
