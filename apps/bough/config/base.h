// A file that builds on another one. Its key `base` names that file, relative to itself; the rest is what
// differs:
//   - a mapping changes the keys that it has and keeps the base's others; null removes a key;
//   - a list of mappings with names changes the items of those names and appends others; a mapping in place
//     of the list has these names as keys, and null removes an item;
//   - any other value replaces the base's.
#pragma once

#include "apps/bough/config/schema.h"

// The tree of a file, merged with those of its bases, which are then in *bases; NULL after adding to `errors`
// why not. Each node keeps the place where it stands.
bough_node *bough_base_read(bough_arena *arena, const char *path, bough_errors *errors,
                            bough_schema_base **bases);

// The value of a base as another one changes it, by the same rules; NULL: it is removed. `path` is that of
// the value in messages.
bough_node *bough_node_merge(bough_arena *arena, bough_errors *errors, const char *path, bough_node *base,
                             bough_node *over);

// A container as `like`, empty, with room for so many values.
bough_node *bough_node_start(bough_arena *arena, const bough_node *like, int room);

// Appends to a container that has room; `key` NULL in a sequence.
void bough_node_append(bough_node *node, bough_node *key, bough_node *value);

// The name in the container that is nearest to a misspelt one.
bough_suggestion bough_node_suggest(bough_arena *arena, const bough_node *node, const char *name);

// Gives the node, and all below it, the position of another one.
void bough_node_move(bough_node *node, const bough_node *at);

// Whether the value is a plain null or ~, which removes a key.
bool bough_node_is_null(const bough_node *node);

// The directory of a path, with its slash; "" for the current one.
const char *bough_directory_of(bough_arena *arena, const char *path);

// Writes a tree as a file that reads as the same tree, without `base`, whose values are in it. `text` gives
// what is written for a scalar.
void bough_node_write(const bough_node *node, const char *(*text)(void *self, const bough_node *scalar),
                      void *self, FILE *stream);
