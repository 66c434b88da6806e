// The commands of the program: each is a row of the table in main.c and a file of its own.
#ifndef BOUGH_APPS_BOUGH_VERB_H
#define BOUGH_APPS_BOUGH_VERB_H

#include "apps/bough/cli/options.h"

typedef struct bough_verb {
    const char *name;
    bough_syntax syntax;
    const char *summary;
    // Does the work. A failure without a message has already been told to the user.
    bough_status (*run)(bough_arena *arena, const bough_options *options);
} bough_verb;

// All commands; the last has no name.
extern const bough_verb bough_verbs[];

// The command of that name; NULL when there is none.
const bough_verb *bough_verb_find(const char *name);

// What is wrong with an unknown word: "unknown command 'rnu' (did you mean 'run'?)" and all that
// are known, `more` among them (NULL-terminated, or NULL).
bough_status bough_verb_unknown(const char *what, const char *word, const char *const *more);

bough_status bough_verb_run(bough_arena *arena, const bough_options *options);
bough_status bough_verb_check(bough_arena *arena, const bough_options *options);
bough_status bough_verb_static(bough_arena *arena, const bough_options *options);
bough_status bough_verb_modes(bough_arena *arena, const bough_options *options);
bough_status bough_verb_study(bough_arena *arena, const bough_options *options);
bough_status bough_verb_report(bough_arena *arena, const bough_options *options);
bough_status bough_verb_import(bough_arena *arena, const bough_options *options);
bough_status bough_verb_export(bough_arena *arena, const bough_options *options);
bough_status bough_verb_wind(bough_arena *arena, const bough_options *options);
bough_status bough_verb_help(bough_arena *arena, const bough_options *options);
bough_status bough_verb_version(bough_arena *arena, const bough_options *options);

// Writes what the program can do, and what one command can.
void bough_help_overview(FILE *stream);
void bough_help_verb(const bough_verb *verb, FILE *stream);

#endif
