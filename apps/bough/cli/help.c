// bough help, bough --help and bough --version.
#include "apps/bough/cases/study.h"
#include "apps/bough/cli/verb.h"
#include "apps/bough/cli/version.h"
#include "apps/bough/model/channel_table.h"
#include "apps/bough/scene/scene.h"
#include "cosim/scheme.h"

#include <string.h>

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

static void usage(const bough_verb *verb, const char *before, FILE *stream) {
    fprintf(stream, "%sbough %s", before, verb->name);
    bough_options_usage(&verb->syntax, stream);
    fputc('\n', stream);
}

void bough_help_verb(const bough_verb *verb, FILE *stream) {
    usage(verb, "usage: ", stream);
    fprintf(stream, "%s\n", verb->summary);
    bough_options_help(&verb->syntax, stream);
}

void bough_help_overview(FILE *stream) {
    fprintf(stream, "bough " BOUGH_VERSION ": flexible multibody dynamics\n\n");
    for (const bough_verb *verb = bough_verbs; verb->name; verb++) {
        usage(verb, "  ", stream);
        fprintf(stream, "      %s\n", verb->summary);
    }
    fprintf(stream, "\ntopics of help, besides the commands:\n");
    for (size_t i = 0; i < sizeof topics / sizeof *topics; i++) {
        fprintf(stream, "  %-13s %s\n", topics[i].name, topics[i].summary);
    }
    fprintf(stream, "\nexit codes: 0 success, 2 invalid input or usage, 3 numerical failure, "
                    "130 interrupted, 1 any other failure\n");
}

bough_status bough_verb_help(bough_arena *arena, const bough_options *options) {
    (void)arena;
    const char *word = options->operand ? options->operand : options->json ? "scene" : NULL;
    if (!word) {
        bough_help_overview(stdout);
        return bough_ok();
    }
    for (size_t i = 0; i < sizeof topics / sizeof *topics; i++) {
        if (strcmp(topics[i].name, word) != 0) continue;
        if (!options->json) {
            topics[i].write(stdout);
        } else if (topics[i].json) {
            topics[i].json(stdout);
        } else {
            break;
        }
        return bough_ok();
    }
    if (options->json) {
        return bough_fail(BOUGH_INVALID, "--json-schema: of 'scene' or 'study', got '%.80s'", word);
    }
    const bough_verb *verb = bough_verb_find(word);
    if (!verb) return bough_verb_unknown("topic", word, topic_names);
    bough_help_verb(verb, stdout);
    return bough_ok();
}

bough_status bough_verb_version(bough_arena *arena, const bough_options *options) {
    (void)arena;
    (void)options;
    printf("bough " BOUGH_VERSION "\n");
    return bough_ok();
}
