// The files that a scene is made of: what a copy of it needs and what its results depend on.
#ifndef BOUGH_APPS_SCENE_SCENE_FILES_H
#define BOUGH_APPS_SCENE_SCENE_FILES_H

#include "apps/bough/scene/scene.h"

typedef struct bough_scene_file {
    const char *key;  // that names it, "control.library"; "" of the scene itself
    const char *path; // as it is opened
    bool absolute;    // named by a path that begins at the root
} bough_scene_file;

typedef struct bough_scene_files {
    int n;
    bough_scene_file *item; // (n)
} bough_scene_files;

// The scene itself, then every file that a key names, in the order of reading and each once; of an FMU the
// files of its folder. A controller's input file has a form that only the controller knows: every word
// of it that is the name of a file beside it counts.
bough_scene_files bough_scene_list_files(bough_arena *arena, const bough_scene *scene);

#endif
