#include "apps/bough/cli/options.h"

#include "apps/bough/config/schema.h"

#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_THREADS = 64, FIRST = 256 }; // FIRST: codes of long options, above every character

typedef struct option_row {
    const char *name, *argument; // argument NULL: none
    const char *help;
    bough_option_flag flag;
    bool repeats;
} option_row;

static const option_row rows[] = {
    {"set", "KEY=VALUE", "replaces or adds a value of the scene: 'bodies[blade1].pitch=5 deg'",
     BOUGH_OPTION_SET, true},
    {"out", "DIR", "folder for the results; default out/<name of the scene>", BOUGH_OPTION_OUT, false},
    {"sweep", "KEY=V1, V2, ...",
     "modes over operating points; the values of several --sweep vary "
     "together",
     BOUGH_OPTION_SWEEP, true},
    {"threads", "N", "1 to 64; replaces the scene's number", BOUGH_OPTION_THREADS, false},
    {"part", "K/N", "of a study (stability, sweep, load-set) only the K-th of N shares of its runs",
     BOUGH_OPTION_PART, false},
    {"case", "NAME", "of a load set only the load case of that name", BOUGH_OPTION_CASE, false},
    {"checkpoint", "TIME", "stores the state of the run at this interval of simulated time",
     BOUGH_OPTION_CHECKPOINT, false},
    {"resume", NULL, "continues from the last checkpoint in the results folder", BOUGH_OPTION_RESUME, false},
    {"wind", "FILE", "wind for the imported model; replaces its own: .bts, .wnd or uniform",
     BOUGH_OPTION_WIND, false},
    {"controller", "FILE", "library with Bladed's interface; replaces the model's own",
     BOUGH_OPTION_CONTROLLER, false},
    {"clamp-base", NULL, "imports an offshore turbine as clamped at the base of its tower",
     BOUGH_OPTION_CLAMP_BASE, false},
    {"hub-mass", "KG", "mass of the hub of a WindIO turbine without one", BOUGH_OPTION_HUB_MASS, false},
    {"nacelle-mass", "KG", "mass of the nacelle of a WindIO turbine without one", BOUGH_OPTION_NACELLE_MASS,
     false},
    {"json-schema", NULL, "of scene (default) or study: the keys as JSON Schema, for editors",
     BOUGH_OPTION_JSON, false},
    {"path", NULL, "follows the equilibria while the loads grow along their ramps, past limit points",
     BOUGH_OPTION_PATH, false},
    {"quiet", NULL, "no progress line", BOUGH_OPTION_QUIET, false},
};
enum { N_ROW = sizeof rows / sizeof *rows };

// -- errors ---------------------------------------------------------------------------------------

static bough_status unknown_long(const bough_syntax *syntax, const char *word) {
    const char *names[N_ROW + 1] = {"help"};
    for (int i = 0; i < N_ROW; i++) {
        if (syntax->options & rows[i].flag) names[i + 1] = rows[i].name;
    }
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);
    const char *near = bough_nearest(name, names, N_ROW + 1);
    return bough_fail(BOUGH_INVALID, "unknown option '%.80s'%s%s%s; see --help", word,
                      near ? " (did you mean '--" : "", near ? near : "", near ? "'?)" : "");
}

// What getopt_long did not accept; `word` is the argument it stopped at.
static bough_status refuse(const bough_syntax *syntax, const char *word) {
    if (optopt >= FIRST) {
        return bough_fail(BOUGH_INVALID, "option --%s takes no value", rows[optopt - FIRST].name);
    }
    if (strncmp(word, "--", 2) == 0) return unknown_long(syntax, word);
    return bough_fail(BOUGH_INVALID, "unknown option '-%c'; see --help", optopt);
}

static bough_status missing(void) {
    const option_row *row = &rows[optopt - FIRST];
    return bough_fail(BOUGH_INVALID, "option --%s needs a value: --%s %s", row->name, row->name,
                      row->argument);
}

// -- reading --------------------------------------------------------------------------------------

static bough_status take_operand(const bough_syntax *syntax, const char *word, bough_options *options) {
    if (syntax->operand == BOUGH_OPERAND_TWO && options->operand && !options->second) {
        options->second = word;
        return bough_ok();
    }
    if (syntax->operand == BOUGH_OPERAND_SOME) {
        options->operands[options->n_operand++] = word;
        options->operand = options->operands[0];
        return bough_ok();
    }
    if (syntax->operand == BOUGH_OPERAND_NONE || options->operand) {
        return bough_fail(BOUGH_INVALID, "unexpected argument '%.200s'", word);
    }
    options->operand = word;
    return bough_ok();
}

static bough_status take_threads(const char *text, bough_options *options) {
    char *end;
    errno = 0;
    long n = strtol(text, &end, 10);
    if (end == text || *end != '\0' || errno || n < 1 || n > MAX_THREADS) {
        return bough_fail(BOUGH_INVALID, "--threads expects a whole number from 1 to %d, got '%.80s'",
                          MAX_THREADS, text);
    }
    options->threads = (int)n;
    return bough_ok();
}

static bough_status take_mass(const char *name, const char *text, double *mass) {
    char *end;
    *mass = strtod(text, &end);
    if (end != text && *end == '\0' && *mass > 0 && *mass <= 1e9) return bough_ok();
    return bough_fail(BOUGH_INVALID, "--%s expects a mass in kg up to 1e9, got '%.80s'", name, text);
}

static bough_status take_part(const char *text, bough_options *options) {
    char rest;
    bool good = sscanf(text, "%d/%d%c", &options->part, &options->parts, &rest) == 2 && options->part >= 1 &&
                options->part <= options->parts;
    return good ? bough_ok() : bough_fail(BOUGH_INVALID, "--part expects K/N such as 1/4, got '%.80s'", text);
}

static bough_status take_option(bough_option_flag flag, const char *text, bough_options *options) {
    switch (flag) {
    case BOUGH_OPTION_SET: options->set[options->n_set++] = text; break;
    case BOUGH_OPTION_SWEEP: options->sweep[options->n_sweep++] = text; break;
    case BOUGH_OPTION_OUT: options->out = text; break;
    case BOUGH_OPTION_THREADS: return take_threads(text, options);
    case BOUGH_OPTION_PART: return take_part(text, options);
    case BOUGH_OPTION_CASE: options->only = text; break;
    case BOUGH_OPTION_CHECKPOINT: options->checkpoint = text; break;
    case BOUGH_OPTION_RESUME: options->resume = true; break;
    case BOUGH_OPTION_WIND: options->wind = text; break;
    case BOUGH_OPTION_CONTROLLER: options->controller = text; break;
    case BOUGH_OPTION_CLAMP_BASE: options->clamp_base = true; break;
    case BOUGH_OPTION_HUB_MASS: return take_mass("hub-mass", text, &options->hub_mass);
    case BOUGH_OPTION_NACELLE_MASS: return take_mass("nacelle-mass", text, &options->nacelle_mass);
    case BOUGH_OPTION_PATH: options->path = true; break;
    case BOUGH_OPTION_JSON: options->json = true; break;
    case BOUGH_OPTION_QUIET: options->quiet = true; break;
    }
    return bough_ok();
}

static void list_options(const bough_syntax *syntax, struct option *list) {
    *list++ = (struct option){.name = "help", .val = 'h'};
    for (int i = 0; i < N_ROW; i++) {
        if (!(syntax->options & rows[i].flag)) continue;
        *list++ = (struct option){.name = rows[i].name,
                                  .has_arg = rows[i].argument ? required_argument : no_argument,
                                  .val = FIRST + i};
    }
}

// getopt_long accepts the beginning of a name, which a later option may share.
static bool is_shortened(const char *word, const char *name) {
    return strcspn(word + 2, "=") != strlen(name);
}

static bough_status take(const bough_syntax *syntax, int code, const char *word, bough_options *options) {
    switch (code) {
    case 1: return take_operand(syntax, optarg, options);
    case 'h': options->help = true; return bough_ok();
    case '?': return refuse(syntax, word);
    case ':': return missing();
    default: return take_option(rows[code - FIRST].flag, optarg, options);
    }
}

bough_status bough_options_read(bough_arena *arena, int argc, char **argv, const bough_syntax *syntax,
                                bough_options *options) {
    *options = (bough_options){.set = bough_arena_take(arena, (size_t)argc * sizeof(char *)),
                               .sweep = bough_arena_take(arena, (size_t)argc * sizeof(char *)),
                               .operands = bough_arena_take(arena, (size_t)argc * sizeof(char *))};
    struct option list[N_ROW + 2] = {{0}};
    list_options(syntax, list);
    bough_status status = bough_ok();
    opterr = 0; // messages are ours
    // "-": operands come in order, whatever POSIXLY_CORRECT says; ":": tell missing from unknown.
    for (int code; bough_is_ok(&status) && (code = getopt_long(argc, argv, "-:h", list, NULL)) != -1;) {
        bool apart = code >= FIRST && optarg == argv[optind - 1]; // the value is a word of its own
        const char *word = argv[optind - 1 - apart];
        bool shortened = code >= FIRST && is_shortened(word, rows[code - FIRST].name);
        status = shortened ? unknown_long(syntax, word) : take(syntax, code, word, options);
    }
    for (; bough_is_ok(&status) && optind < argc; optind++) {
        status = take_operand(syntax, argv[optind], options); // after "--"
    }
    const char *last = syntax->operand == BOUGH_OPERAND_TWO ? options->second : options->operand;
    bool needed = syntax->operand != BOUGH_OPERAND_NONE && syntax->operand != BOUGH_OPERAND_OPTIONAL;
    if (bough_is_ok(&status) && needed && !last && !options->help) {
        return bough_fail(BOUGH_INVALID, "%s: missing %s; see --help", argv[0], syntax->operand_name);
    }
    return status;
}

// -- help -----------------------------------------------------------------------------------------

void bough_options_usage(const bough_syntax *syntax, FILE *stream) {
    if (syntax->operand == BOUGH_OPERAND_REQUIRED || syntax->operand == BOUGH_OPERAND_TWO)
        fprintf(stream, " %s", syntax->operand_name);
    if (syntax->operand == BOUGH_OPERAND_SOME) fprintf(stream, " %s...", syntax->operand_name);
    if (syntax->operand == BOUGH_OPERAND_OPTIONAL) fprintf(stream, " [%s]", syntax->operand_name);
    for (int i = 0; i < N_ROW; i++) {
        if (!(syntax->options & rows[i].flag)) continue;
        fprintf(stream, " [--%s%s%s]%s", rows[i].name, rows[i].argument ? " " : "",
                rows[i].argument ? rows[i].argument : "", rows[i].repeats ? "..." : "");
    }
}

void bough_options_help(const bough_syntax *syntax, FILE *stream) {
    for (int i = 0; i < N_ROW; i++) {
        if (!(syntax->options & rows[i].flag)) continue;
        char left[40];
        snprintf(left, sizeof left, "--%s %s", rows[i].name, rows[i].argument ? rows[i].argument : "");
        fprintf(stream, "  %-18s %s\n", left, rows[i].help);
    }
    fprintf(stream, "  %-18s %s\n", "-h, --help", "this text");
}
