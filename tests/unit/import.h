// Importing changed decks, and what comes of it.
#pragma once

#include "tests/unit/scratch.h"

#include "apps/bough/config/text.h"
#include "apps/bough/exchange/bough.h"
#include "apps/bough/import/import.h"

typedef struct edit {
    const char *file, *from, *to;
} edit;

typedef struct trial {
    char folder[SCRATCH_NAME], out[SCRATCH_NAME + 8];
    bough_arena *arena;
    bough_status status;
} trial;

enum { DECK = 1 << 14 }; // characters, with room for changes

// The text of a deck of tests/data/decks.
static inline void read_deck(const char *name, char text[DECK]) {
    FILE *in = scratch_open(BOUGH_SOURCE_DIR "/tests/data/decks", name, "r");
    text[fread(text, 1, DECK - 1, in)] = '\0';
    fclose(in);
}

// Replaces the first place of `from` in the text of that file.
static inline void apply(const edit *change, const char *name, char text[DECK]) {
    if (!change || strcmp(change->file, name) != 0) return;
    char *at = strstr(text, change->from), rest[DECK];
    assert_non_null(at);
    strcpy(rest, at + strlen(change->from));
    snprintf(at, (size_t)(text + DECK - at), "%s%s", change->to, rest);
}

// Writes a deck of tests/data/decks into the folder, changed.
static inline void copy_deck(const char *folder, const char *name, const edit *one, const edit *two) {
    char text[DECK];
    read_deck(name, text);
    apply(one, name, text);
    apply(two, name, text);
    scratch_write(folder, name, text);
}

static inline void remove_folder(void *folder) { scratch_empty(folder); }

// A trial with its folder, which goes with its memory.
static inline trial begin_trial(void) {
    trial t = {.arena = check_memory()};
    assert_non_null(mkdtemp(scratch_name(t.folder)));
    bough_arena_on_destroy(t.arena, remove_folder, (void *)bough_arena_string(t.arena, t.folder));
    snprintf(t.out, sizeof t.out, "%s/out", t.folder);
    return t;
}

// An attempt that must succeed.
static inline trial imported(trial t) {
    assert_string_equal(t.status.message, "");
    return t;
}

// It must fail with this message, and write nothing.
static inline void check_refused(trial t, bough_code code, const char *says) {
    check_fails(t.status, code, says);
    assert_false(scratch_has(t.folder, "out"));
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
    char *all = scratch_read(t->out, "import.txt");
    assert_non_null(all);
    bool said = strstr(all, words) != NULL;
    free(all);
    return said;
}

// What was imported opens and steps; the rotor's speed then [rpm].
static inline double steps(trial *t, int n) {
    char path[SCRATCH_PATH];
    snprintf(path, sizeof path, "%s/scene.yaml", t->out);
    bough_session *s = bough_session_open(path, NULL, 0);
    assert_string_equal(bough_session_error(s), "");
    for (int i = 0; i < n; i++) assert_int_equal(bough_session_step(s), BOUGH_SESSION_OK);
    double speed = bough_session_read(s, bough_session_find(s, "RotSpeed"));
    bough_session_close(s);
    return speed;
}

static inline void check_same_file(const trial *a, const trial *b, const char *name) {
    char *one = scratch_read(a->out, name), *two = scratch_read(b->out, name);
    assert_non_null(one);
    assert_non_null(two);
    assert_string_equal(one, two);
    free(one);
    free(two);
}

// What an import writes for a whole turbine.
static const char *const results[] = {"scene.yaml", "blade-structure.yaml", "airfoils.yaml",
                                      "tower-structure.yaml", "blade-aero.yaml"};
enum { N_RESULT = sizeof results / sizeof *results };
