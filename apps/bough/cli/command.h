// A command of the program: its operands, its options as rows of a table, and its function. Each has a file
// of its own; main.c lists them. The commands share the reading and building of scenes, and the signals.
#pragma once

#include "apps/bough/config/schema.h"
#include "apps/bough/model/simulation.h"

// In `bough --version` and summary.json; tests/cli/test_cli.sh compares it with the version of the build.
#define BOUGH_VERSION "0.1.0"

// -- options --------------------------------------------------------------------------------------

// The values of an option that may be repeated, in their order.
typedef struct bough_texts {
    int n;
    const char **text; // (n)
} bough_texts;

// The command line. A command with options of its own has a struct that begins with this one.
typedef struct bough_options {
    const char *operand; // the first operand: scene or topic; NULL: none
    int n_operand;
    const char **operands; // (n_operand)
    bough_texts set;       // replacements "key=value"
    const char *out;       // NULL: named after the operand
    int threads;           // 0: that of the scene
    bool quiet, help;
} bough_options;

typedef struct bough_option {
    const char *name, *argument; // "out", "DIR"; argument NULL: none
    const char *help;
    // Reads the value into its field.
    bough_status (*read)(const struct bough_option *row, const char *text, void *field);
    size_t offset; // of the field in the command's struct
    // of a quantity
    bough_dimension dimension;
    const char *range;
} bough_option;

// Readers of options: const char *; bough_texts; bool; a quantity, double, SI; a number of threads, int.
bough_status bough_option_text(const bough_option *row, const char *text, void *field);
bough_status bough_option_texts(const bough_option *row, const char *text, void *field);
bough_status bough_option_flag(const bough_option *row, const char *text, void *field);
bough_status bough_option_quantity(const bough_option *row, const char *text, void *field);
bough_status bough_option_threads(const bough_option *row, const char *text, void *field);
bough_status bough_option_kernels(const bough_option *row, const char *text,
                                  void *field); // sets the environment

// Rows of several commands.
#define BOUGH_COMMON(name, argument, help, reader, member)                                                   \
    { name, argument, help, bough_option_##reader, .offset = offsetof(bough_options, member) }
#define BOUGH_OPTION_SET                                                                                     \
    BOUGH_COMMON("set", "KEY=VALUE", "replaces or adds a value of the scene: 'bodies[blade1].pitch=5 deg'",  \
                 texts, set)
#define BOUGH_OPTION_OUT                                                                                     \
    BOUGH_COMMON("out", "DIR", "folder for the results; default out/<name of the file>", text, out)
#define BOUGH_OPTION_THREADS                                                                                 \
    BOUGH_COMMON("threads", "N", "1 to 64; replaces the scene's number", threads, threads)
#define BOUGH_OPTION_KERNELS                                                                                 \
    {                                                                                                        \
        "kernels", "LEVEL", "v2, v3 or v4: level of the instruction set, default the processor's highest",   \
            .read = bough_option_kernels                                                                     \
    }
#define BOUGH_OPTION_QUIET BOUGH_COMMON("quiet", NULL, "no progress line", flag, quiet)

// -- commands -------------------------------------------------------------------------------------

typedef struct bough_command {
    const char *name, *summary;
    const char *operands;       // one or two, as printed in the usage: "SCENE", "KIND FILE"
    bool optional;              // the operand may be left out
    bool repeats;               // or given several times
    const bough_option *option; // ended by a row without a name; NULL: only --help, which all commands have
    size_t size;                // of the struct of the options
    // Performs the command. The message of a failure is empty if it is already printed.
    bough_status (*run)(bough_arena *arena, const void *options);
} bough_command;

extern const bough_command bough_command_run, bough_command_check, bough_command_static, bough_command_modes,
    bough_command_study, bough_command_tune, bough_command_wind, bough_command_report, bough_command_diff,
    bough_command_new, bough_command_import, bough_command_export, bough_command_help;

// A file of the scenes that `bough new` writes.
typedef struct bough_template {
    const char *name; // "beam/scene.yaml"
    const char *text;
} bough_template;

extern const bough_template bough_templates[]; // ended by a row without a name; made by templates.cmake

// All commands, ended by NULL (main.c).
extern const bough_command *const bough_commands[];

// The command of that name; NULL when there is none.
const bough_command *bough_command_find(const char *name);

// Reads argv[1] and what follows; argv[0] is the command's name. BOUGH_INVALID names what is wrong
// and the nearest valid option. Texts are borrowed from argv.
bough_status bough_options_read(bough_arena *arena, int argc, char **argv, const bough_command *command,
                                bough_options **options);

// Writes " SCENE [--set KEY=VALUE]... [--out DIR]", and one line for each option.
void bough_options_usage(const bough_command *command, FILE *stream);
void bough_options_help(const bough_command *command, FILE *stream);

// Writes the help of the program, and that of a command (help.c).
void bough_help_overview(FILE *stream);
void bough_help_command(const bough_command *command, FILE *stream);

// The failure of an unknown word: "unknown command 'rnu' (did you mean 'run'?)", and all commands and the
// words `more` (NULL-terminated, or NULL).
bough_status bough_unknown_word(const char *what, const char *word, const char *const *more);

// -- from the command line to a built scene (open.c) ----------------------------------------------

// Replaces an operand that is a directory by its only scene, by its scene.yaml or by the scene with the name
// of the directory. BOUGH_INVALID lists the candidates if there are others.
bough_status bough_find_scene(bough_arena *arena, bough_options *options);

// Reads the scene with the options' replacements and threads. Errors in it are written to stderr, one on each
// line; the status then has no message.
bough_status bough_open_scene(bough_arena *arena, const bough_options *options, bough_scene **scene);

// Reads and builds the scene.
bough_status bough_open(bough_arena *arena, const bough_options *options, bough_simulation **simulation);

// The channels of `all`, which must outlive the list, that the scene records. BOUGH_INVALID if no channel
// matches a name or pattern.
bough_status bough_open_channels(const bough_scene *scene, const bough_channels *all,
                                 bough_channels *recorded);

// The folder for results: that of the options, or else out/ and the file name of the operand without its
// extension.
const char *bough_out_folder(bough_arena *arena, const bough_options *options);

// -- SIGINT, SIGTERM, SIGHUP and SIGXCPU stop a run after the current step (command.c) ------------

// Starts to catch these signals: the first is remembered; a second one ends the process at once, except
// SIGXCPU. SIGPIPE is ignored.
void bough_stop_listen(void);

bool bough_stop_requested(void);
