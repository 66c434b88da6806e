// bough help, bough --help and bough --version.
#include "apps/bough/cases/study.h"
#include "apps/bough/cli/command.h"
#include "apps/bough/model/channel_table.h"
#include "apps/bough/scene/scene.h"
#include "cosim/scheme.h"

static void help_coupling(FILE *stream) {
    fprintf(stream, "simulation.coupling.scheme, the exchange between the tree and the flexible "
                    "bodies:\n");
    const char *name;
    for (int i = 0; (name = bough_scheme_name(i)) != NULL; i++) {
        fprintf(stream, "  %-13s %s\n", name, bough_scheme_find(name)->summary);
    }
}

typedef struct topic {
    const char *name, *summary;
    void (*write)(FILE *stream);
    void (*json)(FILE *stream); // NULL: it has no schema
} topic;

static const topic topics[] = {
    {"scene", "every key of a scene with unit, range, default and example", bough_scene_help,
     bough_scene_json_schema},
    {"study", "every key of a study", bough_study_help, bough_study_json_schema},
    {"channels", "every channel that a run can record, with unit, axes, sign", bough_channel_table_help,
     NULL},
    {"coupling", "the coupling schemes", help_coupling, NULL},
};
static const char *const topic_names[] = {"scene", "study", "channels", "coupling", NULL};

static void usage(const bough_command *command, const char *before, FILE *stream) {
    fprintf(stream, "%sbough %s", before, command->name);
    bough_options_usage(command, stream);
    fputc('\n', stream);
}

void bough_help_command(const bough_command *command, FILE *stream) {
    usage(command, "usage: ", stream);
    fprintf(stream, "%s\n", command->summary);
    bough_options_help(command, stream);
}

void bough_help_overview(FILE *stream) {
    fprintf(stream, "bough " BOUGH_VERSION ": flexible multibody dynamics\n\n");
    for (const bough_command *const *c = bough_commands; *c; c++) {
        usage(*c, "  ", stream);
        fprintf(stream, "      %s\n", (*c)->summary);
    }
    fprintf(stream, "  bough --version\n      prints the version\n");
    fprintf(stream, "\ntopics of help, besides the commands:\n");
    for (size_t i = 0; i < sizeof topics / sizeof *topics; i++) {
        fprintf(stream, "  %-13s %s\n", topics[i].name, topics[i].summary);
    }
    fprintf(stream, "\nexit codes: 0 success, 2 invalid input or usage, 3 numerical failure, "
                    "130 interrupted, 1 any other failure\n");
}

typedef struct help_options {
    bough_options common;
    bool json;
} help_options;

static const bough_option rows[] = {
    {"json-schema", NULL, "of scene (default) or study: the keys as JSON Schema, for editors",
     bough_option_flag, .offset = offsetof(help_options, json)},
    {0},
};

static bough_status help(bough_arena *arena, const void *given) {
    (void)arena;
    const help_options *options = given;
    const char *operand = options->common.operand;
    const char *word = operand ? operand : options->json ? "scene" : NULL;
    if (!word) {
        bough_help_overview(stdout);
        return bough_ok();
    }
    for (size_t i = 0; i < sizeof topics / sizeof *topics; i++) {
        void (*write)(FILE * stream) = options->json ? topics[i].json : topics[i].write;
        if (strcmp(topics[i].name, word) != 0 || !write) continue;
        write(stdout);
        return bough_ok();
    }
    if (options->json) {
        return bough_fail(BOUGH_INVALID, "--json-schema: of 'scene' or 'study', got '%.80s'", word);
    }
    const bough_command *command = bough_command_find(word);
    if (!command) return bough_unknown_word("topic", word, topic_names);
    bough_help_command(command, stdout);
    return bough_ok();
}

const bough_command bough_command_help = {
    .name = "help",
    .summary = "explains a command, the keys of scenes and studies, the channels or the coupling schemes",
    .operands = "TOPIC",
    .optional = true,
    .option = rows,
    .size = sizeof(help_options),
    .run = help,
};
