// Importing changed decks, and what comes of it.
#ifndef BOUGH_TESTS_UNIT_IMPORT_H
#define BOUGH_TESTS_UNIT_IMPORT_H

#include "tests/unit/check.h"
#include "tests/unit/scratch_name.h"

#include "apps/bough/config/text.h"
#include "apps/bough/import/import.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct edit {
    const char *file, *from, *to;
} edit;

typedef struct trial {
    char folder[SCRATCH_NAME], out[SCRATCH_NAME + 8];
    bough_arena *arena;
    bough_status status;
} trial;

// Replaces the first place of `from` in the text of that file.
static inline void apply(const edit *change, const char *name, char text[8192]) {
    if (!change || strcmp(change->file, name) != 0) return;
    char *at = strstr(text, change->from), rest[8192];
    assert_non_null(at);
    strcpy(rest, at + strlen(change->from));
    snprintf(at, (size_t)(text + 8192 - at), "%s%s", change->to, rest);
}

// Writes a deck of tests/data/decks into the folder, changed.
static inline void copy_deck(const char *folder, const char *name, const edit *one, const edit *two) {
    char path[SCRATCH_PATH], text[8192];
    snprintf(path, sizeof path, "%s/tests/data/decks/%s", BOUGH_SOURCE_DIR, name);
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    text[fread(text, 1, sizeof text - 1, in)] = '\0';
    fclose(in);
    apply(one, name, text);
    apply(two, name, text);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs(text, out);
    fclose(out);
}

static inline void remove_folder(void *folder) {
    char command[SCRATCH_PATH];
    snprintf(command, sizeof command, "rm -rf %s", (const char *)folder);
    assert_int_equal(system(command), 0);
}

// A trial with its folder, which goes with its memory.
static inline trial begin_trial(void) {
    trial t = {.arena = check_memory()};
    assert_non_null(mkdtemp(scratch_name(t.folder)));
    bough_arena_on_destroy(t.arena, remove_folder, (void *)bough_arena_string(t.arena, t.folder));
    return t;
}

static inline const bough_node *read_file(trial *t, const char *name) {
    char path[SCRATCH_PATH];
    snprintf(path, sizeof path, "%s/%s", t->out, name);
    bough_errors errors = {.arena = t->arena};
    const bough_node *node = bough_text_read(t->arena, path, &errors);
    assert_non_null(node);
    return node;
}

// The node at "key.3.key": keys of mappings and places in sequences.
static inline const bough_node *at(const bough_node *node, const char *path) {
    char word[64];
    while (*path) {
        size_t n = strcspn(path, ".");
        snprintf(word, sizeof word, "%.*s", (int)n, path);
        node = node->kind == BOUGH_SEQUENCE ? node->value[atoi(word)] : bough_node_find(node, word);
        if (!node) fail_msg("no '%s'", word);
        path += n + (path[n] == '.');
    }
    return node;
}

static inline double number(const bough_node *node, const char *path) {
    return strtod(at(node, path)->text, NULL);
}

static inline const char *text(const bough_node *node, const char *path) { return at(node, path)->text; }

static inline bool list_says(trial *t, const char *words) {
    char path[SCRATCH_PATH], all[8192];
    snprintf(path, sizeof path, "%s/import.txt", t->out);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    all[fread(all, 1, sizeof all - 1, file)] = '\0';
    fclose(file);
    return strstr(all, words) != NULL;
}

#endif
