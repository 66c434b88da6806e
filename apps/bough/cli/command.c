#include "apps/bough/cli/command.h"

#include <errno.h>
#include <getopt.h>
#include <signal.h>

// -- interrupts -----------------------------------------------------------------------------------

// A signal handler can reach nothing but a global.
static volatile sig_atomic_t requested; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

static void request(int signal_number) {
    (void)signal_number;
    requested = 1;
}

// SIGXCPU is sent again for every further second of processor time until the hard limit. `nohup` starts a
// program with SIGHUP ignored, which must stay so.
static const struct {
    int number;
    bool repeated; // a second one does not end the process
    bool ignorable;
} signals[] = {
    {SIGINT, false, false}, {SIGTERM, false, false}, {SIGHUP, false, true}, {SIGXCPU, true, false}};

static bool is_ignored(int number) {
    struct sigaction now;
    return sigaction(number, NULL, &now) == 0 && now.sa_handler == SIG_IGN;
}

void bough_stop_listen(void) {
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        if (signals[i].ignorable && is_ignored(signals[i].number)) continue;
        int once = signals[i].repeated ? 0 : (int)SA_RESETHAND;
        struct sigaction action = {.sa_handler = request, .sa_flags = SA_RESTART | once};
        sigemptyset(&action.sa_mask);
        sigaction(signals[i].number, &action, NULL);
    }
    signal(SIGPIPE, SIG_IGN); // the reader of the output may end before the run
}

bool bough_stop_requested(void) { return requested != 0; }

enum {
    MAX_THREADS = 64,
    MOST_OPTIONS = 16, // of a command
    FIRST = 256,       // codes of long options, above every character
};

// -- errors ---------------------------------------------------------------------------------------

static bool may_repeat(const bough_option *row) { return row->read == bough_option_texts; }

static int count(const bough_command *command) {
    int n = 0;
    while (command->option && command->option[n].name) n++;
    return n;
}

static bough_status unknown_long(const bough_command *command, const char *word) {
    const char *names[MOST_OPTIONS + 1] = {"help"};
    for (int i = 0; i < count(command); i++) names[i + 1] = command->option[i].name;
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);
    const char *near = bough_nearest(name, names, count(command) + 1);
    return bough_fail(BOUGH_INVALID, "unknown option '%.80s'%s%s%s; see --help", word,
                      near ? " (did you mean '--" : "", near ? near : "", near ? "'?)" : "");
}

// The error of an option that getopt_long refused; `word` is its argument.
static bough_status refuse(const bough_command *command, const char *word) {
    if (optopt >= FIRST) {
        return bough_fail(BOUGH_INVALID, "option --%s takes no value", command->option[optopt - FIRST].name);
    }
    if (strncmp(word, "--", 2) == 0) return unknown_long(command, word);
    return bough_fail(BOUGH_INVALID, "unknown option '-%c'; see --help", optopt);
}

static bough_status missing(const bough_command *command) {
    const bough_option *row = &command->option[optopt - FIRST];
    return bough_fail(BOUGH_INVALID, "option --%s needs a value: --%s %s", row->name, row->name,
                      row->argument);
}

// -- values ---------------------------------------------------------------------------------------

bough_status bough_option_text(const bough_option *row, const char *text, void *field) {
    (void)row;
    *(const char **)field = text;
    return bough_ok();
}

bough_status bough_option_texts(const bough_option *row, const char *text, void *field) {
    (void)row;
    bough_texts *texts = field;
    texts->text[texts->n++] = text;
    return bough_ok();
}

bough_status bough_option_flag(const bough_option *row, const char *text, void *field) {
    (void)row, (void)text;
    *(bool *)field = true;
    return bough_ok();
}

bough_status bough_option_quantity(const bough_option *row, const char *text, void *field) {
    char expected[96], why[160];
    const char *range = row->range ? row->range : "";
    double value;
    if (bough_quantity(text, row->dimension, &value, why) && bough_in_range(value, row->range)) {
        *(double *)field = value;
        return bough_ok();
    }
    bough_dimension_expected(row->dimension, expected);
    return bough_fail(BOUGH_INVALID, "--%s expects %s%s%s, got '%.80s'%s%s", row->name, expected,
                      range[0] == '[' ? " in "
                      : range[0]      ? " "
                                      : "",
                      range, text, why[0] ? ": " : "", why);
}

bough_status bough_option_threads(const bough_option *row, const char *text, void *field) {
    int *n = field;
    if (bough_whole_number(text, n) && *n >= 1 && *n <= MAX_THREADS) return bough_ok();
    return bough_fail(BOUGH_INVALID, "--%s expects a whole number from 1 to %d, got '%.80s'", row->name,
                      MAX_THREADS, text);
}

bough_status bough_option_kernels(const bough_option *row, const char *text, void *field) {
    (void)field;
    bough_level level;
    if (setenv("BOUGH_KERNELS", text, 1) != 0) {
        return bough_fail(BOUGH_IO, "cannot set the environment: %s", strerror(errno));
    }
    if (bough_level_choose(&level)) return bough_ok();
    return bough_fail(BOUGH_INVALID, "--%s expects v2, v3 or v4, on this processor at most %s, got '%.80s'",
                      row->name, bough_level_name(level), text);
}

// -- reading --------------------------------------------------------------------------------------

static int count_operands(const bough_command *command) { return strchr(command->operands, ' ') ? 2 : 1; }

static bough_status take_operand(const bough_command *command, const char *word, bough_options *options) {
    if (options->n_operand == count_operands(command) && !command->repeats)
        return bough_fail(BOUGH_INVALID, "unexpected argument '%.200s'", word);
    options->operands[options->n_operand++] = word;
    options->operand = options->operands[0];
    return bough_ok();
}

static void list_options(const bough_command *command, struct option *list) {
    *list++ = (struct option){.name = "help", .val = 'h'};
    for (int i = 0; i < count(command); i++) {
        const bough_option *row = &command->option[i];
        *list++ = (struct option){
            .name = row->name, .has_arg = row->argument ? required_argument : no_argument, .val = FIRST + i};
    }
}

static bough_status take(const bough_command *command, int code, const char *word, bough_options *options) {
    switch (code) {
    case 1: return take_operand(command, optarg, options);
    case 'h': options->help = true; return bough_ok();
    case '?': return refuse(command, word);
    case ':': return missing(command);
    default: break;
    }
    const bough_option *row = &command->option[code - FIRST];
    return row->read(row, optarg, (char *)options + row->offset);
}

// The struct of the command, with room for as many values of a repeated option as there are words.
static bough_options *take_memory(bough_arena *arena, const bough_command *command, int argc) {
    bough_options *options = bough_arena_take(arena, command->size);
    options->operands = bough_arena_take(arena, (size_t)argc * sizeof(char *));
    for (const bough_option *row = command->option; row && row->name; row++) {
        bough_texts *texts = (bough_texts *)((char *)options + row->offset);
        if (may_repeat(row)) texts->text = bough_arena_take(arena, (size_t)argc * sizeof(char *));
    }
    return options;
}

bough_status bough_options_read(bough_arena *arena, int argc, char **argv, const bough_command *command,
                                bough_options **result) {
    bough_options *options = *result = take_memory(arena, command, argc);
    struct option list[MOST_OPTIONS + 2] = {{0}};
    list_options(command, list);
    bough_status status = bough_ok();
    opterr = 0; // messages are ours
    // "-": operands come in order, whatever POSIXLY_CORRECT says; ":": distinguishes missing from unknown.
    for (int code; bough_is_ok(&status) && (code = getopt_long(argc, argv, "-:h", list, NULL)) != -1;) {
        bool separate = code >= FIRST && optarg == argv[optind - 1]; // the value is a separate word
        const char *word = argv[optind - 1 - separate];
        // getopt_long accepts the beginning of a name, which a later option may share.
        bool shortened =
            code >= FIRST && strcspn(word + 2, "=") != strlen(command->option[code - FIRST].name);
        status = shortened ? unknown_long(command, word) : take(command, code, word, options);
    }
    for (; bough_is_ok(&status) && optind < argc; optind++) {
        status = take_operand(command, argv[optind], options); // after "--"
    }
    bool complete = command->optional || options->n_operand >= count_operands(command);
    if (bough_is_ok(&status) && !complete && !options->help) {
        return bough_fail(BOUGH_INVALID, "%s: missing %s; see --help", argv[0], command->operands);
    }
    return status;
}

// -- help -----------------------------------------------------------------------------------------

void bough_options_usage(const bough_command *command, FILE *stream) {
    fprintf(stream, " %s%s%s", command->optional ? "[" : "", command->operands,
            command->optional  ? "]"
            : command->repeats ? "..."
                               : "");
    for (const bough_option *row = command->option; row && row->name; row++) {
        fprintf(stream, " [--%s%s%s]%s", row->name, row->argument ? " " : "",
                row->argument ? row->argument : "", may_repeat(row) ? "..." : "");
    }
}

void bough_options_help(const bough_command *command, FILE *stream) {
    for (const bough_option *row = command->option; row && row->name; row++) {
        char left[40];
        snprintf(left, sizeof left, "--%s %s", row->name, row->argument ? row->argument : "");
        fprintf(stream, "  %-18s %s\n", left, row->help);
    }
    fprintf(stream, "  %-18s %s\n", "-h, --help", "this text");
}
