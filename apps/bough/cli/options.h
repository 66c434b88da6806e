// What the user asks for on the command line, read by getopt_long.
#ifndef BOUGH_APPS_BOUGH_OPTIONS_H
#define BOUGH_APPS_BOUGH_OPTIONS_H

#include "core/base/arena.h"
#include "core/base/status.h"

#include <stdbool.h>
#include <stdio.h>

// Options that a command may accept; every command accepts --help.
typedef enum bough_option_flag {
    BOUGH_OPTION_SET = 1 << 0,
    BOUGH_OPTION_OUT = 1 << 1,
    BOUGH_OPTION_THREADS = 1 << 2,
    BOUGH_OPTION_QUIET = 1 << 3,
    BOUGH_OPTION_PART = 1 << 4,
    BOUGH_OPTION_CHECKPOINT = 1 << 5,
    BOUGH_OPTION_RESUME = 1 << 6,
    BOUGH_OPTION_CASE = 1 << 7,
    BOUGH_OPTION_WIND = 1 << 8,
    BOUGH_OPTION_CONTROLLER = 1 << 9,
    BOUGH_OPTION_CLAMP_BASE = 1 << 10,
    BOUGH_OPTION_JSON = 1 << 11,
    BOUGH_OPTION_SWEEP = 1 << 12,
    BOUGH_OPTION_PATH = 1 << 14,
    BOUGH_OPTION_HUB_MASS = 1 << 15,
    BOUGH_OPTION_NACELLE_MASS = 1 << 16,
} bough_option_flag;

typedef enum bough_operand {
    BOUGH_OPERAND_NONE,
    BOUGH_OPERAND_OPTIONAL,
    BOUGH_OPERAND_REQUIRED,
    BOUGH_OPERAND_TWO,
    BOUGH_OPERAND_SOME, // one or more
} bough_operand;

// What a command accepts.
typedef struct bough_syntax {
    bough_operand operand;
    const char *operand_name; // "SCENE"; NULL without operand
    unsigned options;         // set of bough_option_flag
} bough_syntax;

typedef struct bough_options {
    const char *operand; // the scene or the topic; NULL: not given
    const char *second;  // of two operands
    int n_operand;
    const char **operands; // (n_operand) of one or more
    int n_set;
    const char **set; // (n_set) replacements "key=value", in their order
    int n_sweep;
    const char **sweep;            // (n_sweep) "key=value, value, ..."
    const char *out;               // NULL: named after the scene
    int threads;                   // 0: as the scene says
    const char *only;              // load case of a study; NULL: all
    int part, parts;               // of a study, from 1; 0: all of it
    const char *checkpoint;        // simulated time between checkpoints; NULL: none
    bool resume;                   // from the last one
    const char *wind, *controller; // files for an imported model; NULL: its own
    bool clamp_base;               // of an imported offshore turbine
    double hub_mass, nacelle_mass; // of an imported turbine [kg]; 0: its own
    bool path;                     // of equilibria
    bool json;                     // of help: a schema for editors
    bool quiet, help;
} bough_options;

// Reads argv[1] and what follows; argv[0] is the command's name. BOUGH_INVALID names what is wrong
// and the nearest valid option. Texts are borrowed from argv.
bough_status bough_options_read(bough_arena *arena, int argc, char **argv, const bough_syntax *syntax,
                                bough_options *options);

// Writes " SCENE [--set KEY=VALUE]... [--out DIR]", and one line for each option.
void bough_options_usage(const bough_syntax *syntax, FILE *stream);
void bough_options_help(const bough_syntax *syntax, FILE *stream);

#endif
