// YAML 1.2 text as a tree of nodes that know where they stand. The only user of libyaml.
//
// Refused, with a position: files above 16 MB, nesting deeper than 64, more than a million values
// (aliases counted as often as they expand), duplicate keys, keys that are not plain text, tags,
// a second document, anything that is not UTF-8.
#pragma once

#include "core/base/arena.h"

typedef enum bough_node_kind {
    BOUGH_SCALAR,
    BOUGH_SEQUENCE,
    BOUGH_MAPPING,
} bough_node_kind;

// A value in a file. A node that an alias repeats is shared, not copied.
typedef struct bough_node {
    bough_node_kind kind;
    bool quoted;               // a scalar in quotes or a block scalar
    int n;                     // items of a sequence, pairs of a mapping
    struct bough_node **key;   // (n) scalars; NULL in a sequence
    struct bough_node **value; // (n)
    const char *text;          // of a scalar
    const char *file;
    int line, column;   // from 1; line 0: no position
    int height, weight; // as read: levels below; values below, this one included, aliases expanded
} bough_node;

typedef struct bough_error {
    const char *file;
    int line, column; // from 1; line 0: none
    const char *path; // "bodies[2].joint.axis"; "" for the whole file
    const char *text; // what was expected
} bough_error;

// The errors found in a scene. Start with {.arena = arena}; all memory is the arena's.
typedef struct bough_errors {
    bough_arena *arena;
    bough_error *item; // (n)
    int n, capacity;
    int dropped; // beyond the hundred that are kept
} bough_errors;

// Adds an error with a printf-style text at the node.
void bough_errors_add(bough_errors *errors, const bough_node *where, const char *path, const char *format,
                      ...) __attribute__((format(printf, 4, 5)));

// Orders them: without position first, then the file `first`, then other files by name; by line
// and column within a file. Of equal errors at one place, which several values share, the first stays.
void bough_errors_sort(bough_errors *errors, const char *first);

// BOUGH_INVALID with their number where there are any, which are then in order: "FILE: 2 errors in the
// scene".
bough_status bough_errors_status(bough_errors *errors, const char *file, const char *what);

// Writes one line each: "file:line:col: error: path: text".
void bough_errors_print(const bough_errors *errors, FILE *stream);

// Prints them on stderr in place of the status's message, which becomes empty.
void bough_errors_report(const bough_errors *errors, bough_status *status);

// The tree of a file; NULL after adding to `errors` why not.
bough_node *bough_text_read(bough_arena *arena, const char *path, bough_errors *errors);

// The tree of `size` bytes at `text`, called `file` in messages.
bough_node *bough_text_parse(bough_arena *arena, const char *file, const char *text, size_t size,
                             bough_errors *errors);

// The name of the i-th value: its key in a mapping, the text of its own key 'name' in a list; NULL: it has
// none.
const char *bough_node_name(const bough_node *node, int i);

// The place of the first value of that name; −1: there is none, or no node.
int bough_node_index(const bough_node *node, const char *name);

// The value of a key in a mapping, NULL when there is none or the node is no mapping (or NULL).
bough_node *bough_node_find(const bough_node *node, const char *key);

// The value at "output.frames" below a mapping, NULL where a key of it is left out. *last (NULL: not
// wanted): the last value found on the way there, the mapping itself at least.
const bough_node *bough_node_below(const bough_node *node, const char *path, const bough_node **last);
