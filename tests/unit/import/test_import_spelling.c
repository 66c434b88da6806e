// The same decks spelled otherwise, as people, programs and systems do: line ends, tabs, comments,
// quotes, capitals, numbers, order. Each of many mixtures of such changes gives the same scene.
#include "tests/unit/import_deck.h"

#include <ctype.h>

enum { SEEDS = 24 };

static uint32_t state;

static unsigned chance(unsigned n) {
    state = state * 1664525u + 1013904223u;
    return (state >> 16) % n;
}

// -- words of a line ------------------------------------------------------------------------------

// The word at *at, with its quotes; its end is put into *at.
static size_t word(const char **at, const char **from) {
    const char *p = *at + strspn(*at, " \t");
    size_t n = *p == '"' || *p == '\'' ? strcspn(p + 1, "\"'") + 2 : strcspn(p, " \t");
    *from = p;
    *at = p + n;
    return n;
}

static bool is_number(const char *w, size_t n) {
    return n > 0 && strspn(w, "0123456789.-") >= n && isdigit((unsigned char)w[n - 1]);
}

// A line "value  Name": its value another way.
static void put_value(FILE *out, const char *w, size_t n) {
    bool file = w[0] == '"' || w[0] == '\'';
    if (is_number(w, n)) {
        unsigned how = chance(5);
        fprintf(out, "%s%.*s%s", how == 1 && w[0] != '-' ? "+" : "", (int)n, w,
                how == 2   ? "E+00"
                : how == 3 ? "d0"
                : how == 4 ? "+000"
                           : "");
    } else if (n >= 4 && strncmp(w, "True", 4) == 0) {
        static const char *const flag[] = {"True", "T", ".TRUE.", "true", "t"};
        fputs(flag[chance(5)], out);
    } else if (n >= 5 && strncmp(w, "False", 5) == 0) {
        static const char *const flag[] = {"False", "F", ".false.", "FALSE", "f"};
        fputs(flag[chance(5)], out);
    } else if (file && n > 2) {
        static const char quotes[] = {'"', '\'', ' '};
        bool capitals = chance(2), backslash = chance(2);
        char quote = quotes[chance(3)];
        fputc(quote, out);
        for (size_t i = 1; i + 1 < n; i++) {
            char c = capitals ? (char)toupper((unsigned char)w[i]) : w[i];
            fputc(backslash && c == '/' ? '\\' : c, out);
        }
        fputc(quote, out);
    } else {
        fprintf(out, "%.*s", (int)n, w);
    }
}

// Whether the line is a value and a name that begins with a letter.
static bool is_entry(const char *line) {
    const char *at = line, *value, *name;
    return word(&at, &value) > 0 && word(&at, &name) > 0 && isalpha((unsigned char)*name) &&
           (is_number(value, strcspn(value, " \t")) || strchr("\"'", *value) ||
            strncmp(value, "True ", 5) == 0 || strncmp(value, "False ", 6) == 0);
}

static void put_entry(FILE *out, const char *line, bool low) {
    const char *at = line, *value, *name;
    size_t n = word(&at, &value), m = word(&at, &name);
    fputs(chance(2) ? "\t" : "   ", out);
    put_value(out, value, n);
    fputs(chance(2) ? "\t\t" : "  ", out);
    for (size_t i = 0; i < m; i++) fputc(low ? tolower((unsigned char)name[i]) : name[i], out);
    if (chance(2)) fputs(at, out);
    if (chance(4) == 0) fputs(" - \xb5m, d\xc3\xa9j\xc3\xa0 vu (\"quoted\")", out);
}

// -- files ----------------------------------------------------------------------------------------

static const char *const ends[] = {"\n", "\r\n", "\r"};

// Copies a deck with its lines spelled otherwise.
static void respell(const char *folder, const char *name) {
    char text[DECK];
    read_deck(name, text);
    FILE *out = scratch_open(folder, name, "w");
    const char *end = ends[chance(3)];
    bool comments = chance(2), blank = chance(2), low = chance(2);
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        if (comments && chance(3) == 0) fprintf(out, "%c 9 NumBl - a comment%s", "!#%"[chance(3)], end);
        if (blank && chance(4) == 0) fputs(end, out);
        if (is_entry(line))
            put_entry(out, line, low);
        else
            fputs(line, out);
        fputs(end, out);
    }
    fclose(out);
}

// Decks without tables, whose lines may stand in any order below heading and title.
static void reverse(const char *folder, const char *name) {
    char text[DECK], *line[200] = {""};
    int n = 0;
    read_deck(name, text);
    for (char *at = strtok(text, "\n"); at && n < 200; at = strtok(NULL, "\n")) line[n++] = at;
    FILE *out = scratch_open(folder, name, "w");
    fprintf(out, "%s\n%s\n", line[0], line[1]);
    for (int i = n - 1; i > 1; i--) fprintf(out, "%s\n", line[i]);
    fclose(out);
}

static void same_results(const trial *a, const trial *b) {
    for (int i = 0; i < N_RESULT; i++) check_same_file(a, b, results[i]);
}

static void again(trial *t, const char *main) {
    char path[SCRATCH_PATH];
    snprintf(path, sizeof path, "%s/%s", t->folder, main);
    t->status = bough_import_openfast(path, t->out, &(bough_import_options){0}, NULL);
}

TEST(every_spelling_gives_the_same_scene) {
    static const char *const mains[] = {"main.fst", "v4/main.fst", "v5/main.fst"};
    for (int m = 0; m < 3; m++) {
        trial base = import_main(mains[m], NULL, NULL);
        trial t = import_main(mains[m], NULL, NULL);
        for (int seed = 0; seed < SEEDS; seed++) {
            state = (uint32_t)(1000 * m + seed);
            for (int i = 0; i < N_DECK; i++) respell(t.folder, decks[i]);
            again(&t, mains[m]);
            if (!bough_is_ok(&t.status)) fail_msg("seed %d: %s", seed, t.status.message);
            same_results(&base, &t);
        }
    }
}

TEST(order_does_not_matter) {
    static const char *const plain[] = {"main.fst",       "parts/elasto.dat", "parts/servo.dat",
                                        "parts/wind.dat", "v4/elasto.dat",    "v5/servo.dat"};
    trial base = import_main("main.fst", NULL, NULL), t = import_main("main.fst", NULL, NULL);
    for (size_t i = 0; i < sizeof plain / sizeof *plain; i++) reverse(t.folder, plain[i]);
    again(&t, "main.fst");
    same_results(&base, &t);
}

// The names of airfoils without their label; every optional entry of AeroDyn as "default".
TEST(labels_and_defaults) {
    trial base = import_main("main.fst", NULL, NULL);
    trial t = import(
        &(edit){"parts/aero.dat", "\"foils/round.dat\"    AFNames  - airfoils", "\"foils/round.dat\""});
    same_results(&base, &t);
    static const char *const optional[] = {"          2   WakeMod",    "          2   SkewMod",
                                           "True          TipLoss",    "          4   UAMod",
                                           "        2.5   tau1_const", "          1   DBEMT_Mod"};
    for (size_t i = 0; i < sizeof optional / sizeof *optional; i++) {
        char to[64];
        snprintf(to, sizeof to, "\"DEFAULT\"   %s", optional[i] + 14);
        t = import(&(edit){"parts/aero.dat", optional[i], to});
    }
    t = import(&(edit){"parts/aero.dat", "          0   TwrShadow", "TRUE   TwrShadow"});
    assert_string_equal(text(read_file(&t, "scene.yaml"), "aero.tower.shadow"), "powles");
}
