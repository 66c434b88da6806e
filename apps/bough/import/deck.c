#include "apps/bough/import/openfast.h"

#include "apps/bough/results/folder.h"
#include "core/base/input_file.h"

#include <dirent.h>
#include <strings.h>
#include <unistd.h>

enum { MOST_BYTES = 16 << 20, WORD = 1024, MOST_WORDS = 64 };

void bough_deck_fail(const bough_deck *deck, int line, const char *format, ...) {
    if (!bough_is_ok(deck->status)) return;
    char text[300], at[24] = "";
    BOUGH_PRINT(text, format);
    if (line >= 0) snprintf(at, sizeof at, "%d:", line + 1);
    *deck->status = bough_fail(BOUGH_INVALID, "%.150s:%s %s", deck->path, at, text);
}

void bough_deck_refuse(const bough_deck *deck, const char *names, const char *format, ...) {
    char text[300];
    BOUGH_PRINT(text, format);
    bough_deck_fail(deck, bough_deck_line(deck, names), "%.*s: %s", (int)strcspn(names, "|"), names, text);
}

// -- words ----------------------------------------------------------------------------------------

// Reads the word at *at, without quotes, and moves past it; false at the end of the line.
static bool next_word(const char **at, char word[WORD]) {
    const char *p = *at + strspn(*at, " \t,");
    if (*p == '\0') return false;
    bool quoted = *p == '"' || *p == '\'';
    size_t length = quoted ? strcspn(p + 1, *p == '"' ? "\"" : "'") : strcspn(p, " \t,");
    const char *from = p + quoted;
    *at = from + length + (quoted && from[length] != '\0');
    if (length >= WORD) length = WORD - 1;
    memcpy(word, from, length);
    word[length] = '\0';
    return true;
}

// Fortran's spellings, 1.5D+3 and 1.5+100, are known; hexadecimal, infinity and NaN are not.
static bool read_number(const char *word, double *value) {
    char copy[64], *end, last = '\0';
    size_t length = strlen(word), n = 0;
    if (length == 0 || length >= sizeof copy - 1) return false;
    if (strspn(word, "+-.0123456789eEdD") != length) return false;
    for (size_t i = 0; i <= length; i++) {
        char letter = word[i];
        if (letter && strchr("dDE", letter)) letter = 'e';
        bool sign = letter == '+' || letter == '-';
        if (sign && last && last != 'e') {
            if (memchr(copy, 'e', n) || n + 2 >= sizeof copy) return false;
            copy[n++] = 'e';
        }
        copy[n++] = last = letter;
    }
    *value = strtod(copy, &end);
    return *end == '\0' && isfinite(*value);
}

// Whether the word is one of "A|B".
static bool is_one_of(const char *word, const char *names) {
    size_t length = strlen(word);
    for (const char *p = names;; p++) {
        size_t n = strcspn(p, "|");
        if (n == length && strncasecmp(p, word, n) == 0) return true;
        p += n;
        if (*p == '\0') return false;
    }
}

static bool is_comment(const char *line) {
    line += strspn(line, " \t");
    return *line == '\0' || strchr("!#%", *line);
}

// Whether the line is a rule or a comment.
static bool has_no_value(const char *line) {
    line += strspn(line, " \t");
    return strncmp(line, "---", 3) == 0 || strncmp(line, "===", 3) == 0 || is_comment(line);
}

// -- reading --------------------------------------------------------------------------------------

// Lines of a text may end with \n, \r\n or \r; the number of lines when all end with \n.
static int mend_line_ends(char *text) {
    char *to = text;
    int n = 1;
    for (const char *from = text; *from; from++) {
        if (from[0] == '\r' && from[1] == '\n') continue;
        *to = *from;
        if (*to == '\r') *to = '\n';
        n += *to++ == '\n';
    }
    *to = '\0';
    return n;
}

// The line after the first `n` that are not comments.
static int line_after(const bough_deck *deck, int n) {
    int i = 0;
    for (; i < deck->n && n > 0; i++) n -= !is_comment(deck->line[i]);
    return i;
}

// The line of the list of output channels, after which no line has a name; the number of lines without one.
static int output_list(const bough_deck *deck) {
    char word[WORD];
    int i = deck->first;
    for (; i < deck->n; i++) {
        const char *at = deck->line[i];
        if (next_word(&at, word) && strcasecmp(word, "OutList") == 0) break;
    }
    return i;
}

bough_deck *bough_deck_open(bough_arena *arena, const char *path, int n_heading, bough_status *status) {
    if (!bough_is_ok(status)) return NULL;
    // the whole file as text
    char why[BOUGH_INPUT_REASON];
    size_t size;
    char *text = bough_input_read(arena, path, MOST_BYTES, &size, why);
    if (!text) *status = bough_fail(BOUGH_INVALID, "cannot read '%.250s': %s", path, why);
    if (text && strlen(text) != size)
        *status = bough_fail(BOUGH_INVALID, "'%.250s' is not a text file", path);
    if (!bough_is_ok(status)) return NULL;
    int n = mend_line_ends(text);
    bough_deck *deck = bough_arena_take(arena, sizeof *deck);
    const char **line = bough_arena_take(arena, (size_t)n * sizeof *line);
    const char *copy = bough_arena_string(arena, path);
    *deck = (bough_deck){.path = copy, .line = line, .n = n, .arena = arena, .status = status};
    // its lines, and those that have names
    for (int i = 0; i < n; i++) {
        line[i] = text;
        text += strcspn(text, "\n");
        if (*text) *text++ = '\0';
    }
    deck->first = line_after(deck, n_heading);
    deck->last = output_list(deck);
    return deck;
}

int bough_deck_line(const bough_deck *deck, const char *names) {
    char word[WORD];
    double rest; // a line may have several numbers before its name, of which the first counts
    for (int i = deck ? deck->first : 0; deck && i < deck->last; i++) {
        const char *at = deck->line[i];
        if (has_no_value(at) || !next_word(&at, word)) continue;
        bool more = next_word(&at, word);
        while (more && read_number(word, &rest)) more = next_word(&at, word);
        if (more && is_one_of(word, names)) return i;
    }
    return -1;
}

int bough_deck_find(const bough_deck *deck, const char *words) {
    for (int i = deck->first; i < deck->last; i++) {
        for (const char *p = deck->line[i]; *p; p++) {
            if (strncasecmp(p, words, strlen(words)) == 0) return i;
        }
    }
    return -1;
}

bough_deck bough_deck_part(const bough_deck *deck, const char *words) {
    bough_deck part = *deck;
    int line = bough_deck_find(deck, words);
    if (line >= 0) part.first = line;
    return part;
}

// The first word of the line with that name; returns the line, -1 after a failure.
static int value_of(const bough_deck *deck, const char *names, const char *what, char word[WORD]) {
    if (!deck || !bough_is_ok(deck->status)) return -1;
    int line = bough_deck_line(deck, names);
    if (line < 0) {
        bough_deck_fail(deck, -1, "no '%.*s': expected a line '%s  %.*s'", (int)strcspn(names, "|"), names,
                        what, (int)strcspn(names, "|"), names);
        return -1;
    }
    const char *at = deck->line[line];
    next_word(&at, word);
    return line;
}

static bool is_default(const bough_deck *deck, const char *names) {
    char word[WORD];
    int line = bough_deck_line(deck, names);
    if (line < 0) return true;
    const char *at = deck->line[line];
    return next_word(&at, word) && strcasecmp(word, "default") == 0;
}

const char *bough_deck_kth(const bough_deck *deck, const char *stem, int k) {
    return bough_arena_print(deck->arena, "%s(%d)|%s%d", stem, k, stem, k);
}

// -- values ---------------------------------------------------------------------------------------

double bough_deck_number(const bough_deck *deck, const char *names) {
    char word[WORD];
    double value = 0;
    if (value_of(deck, names, "number", word) < 0 || read_number(word, &value)) return value;
    bough_deck_refuse(deck, names, "expected a number, got '%.60s'", word);
    return 0;
}

int bough_deck_whole(const bough_deck *deck, const char *names, int least, int most) {
    double value = bough_deck_number(deck, names);
    if (!deck || !bough_is_ok(deck->status)) return 0;
    if (value == floor(value) && value >= least && value <= most) return (int)value;
    bough_deck_refuse(deck, names, "expected a whole number from %d to %d, got %g", least, most, value);
    return 0;
}

static bool deck_flag(const bough_deck *deck, const char *names) {
    char word[WORD];
    if (value_of(deck, names, "True", word) < 0) return false;
    const char *first = word + (word[0] == '.'); // Fortran reads no further
    if (*first == 't' || *first == 'T') return true;
    if (*first == 'f' || *first == 'F') return false;
    bough_deck_refuse(deck, names, "expected True or False, got '%.60s'", word);
    return false;
}

const char *bough_deck_text(const bough_deck *deck, const char *names) {
    char word[WORD];
    return value_of(deck, names, "\"text\"", word) < 0 ? "" : bough_arena_string(deck->arena, word);
}

double bough_deck_number_or(const bough_deck *deck, const char *names, double fallback) {
    return is_default(deck, names) ? fallback : bough_deck_number(deck, names);
}

int bough_deck_whole_or(const bough_deck *deck, const char *names, int fallback) {
    return is_default(deck, names) ? fallback : bough_deck_whole(deck, names, -1000, 1000000);
}

bool bough_deck_flag_or(const bough_deck *deck, const char *names, bool fallback) {
    return is_default(deck, names) ? fallback : deck_flag(deck, names);
}

// A switch was a flag in some versions and is a number in others.
double bough_deck_switch_or(const bough_deck *deck, const char *names, double fallback) {
    if (is_default(deck, names)) return fallback;
    const char *text = bough_deck_text(deck, names);
    return strchr("tTfF", text[text[0] == '.']) ? deck_flag(deck, names) : bough_deck_number(deck, names);
}

// -- files ----------------------------------------------------------------------------------------

// Replaces *name (of `size`) by its spelling in the folder where only capitals differ: decks come from
// systems that do not distinguish them.
static void respell(const char *folder, char *name, size_t size) {
    DIR *stream = opendir(folder);
    if (!stream) return;
    for (const struct dirent *entry; (entry = readdir(stream));) {
        if (strcasecmp(entry->d_name, name) != 0 || strlen(entry->d_name) >= size) continue;
        strcpy(name, entry->d_name);
        break;
    }
    closedir(stream);
}

// Respells the names of a path from left to right, as far as they exist.
static void respell_path(char path[BOUGH_PATH_MAX]) {
    char part[BOUGH_PATH_MAX];
    for (size_t from = 0, n; path[from]; from += n + (path[from + n] == '/')) {
        n = strcspn(path + from, "/");
        snprintf(part, sizeof part, "%.*s", (int)(from + n), path);
        if (n == 0 || access(part, F_OK) == 0) continue;
        snprintf(part, sizeof part, "%.*s", (int)n, path + from);
        char folder[BOUGH_PATH_MAX];
        snprintf(folder, sizeof folder, "%.*s", (int)from, path);
        respell(from > 0 ? folder : ".", part, n + 1);
        memcpy(path + from, part, n);
    }
}

const char *bough_deck_path_at(const bough_deck *deck, int line) {
    char word[WORD], path[BOUGH_PATH_MAX];
    const char *at = line >= 0 && line < deck->n ? deck->line[line] : "";
    if (!bough_is_ok(deck->status)) return "";
    if (!next_word(&at, word)) {
        bough_deck_fail(deck, line, "expected the name of a file");
        return "";
    }
    for (char *p = word; *p; p++) {
        if (*p == '\\') *p = '/';
    }
    int folder = word[0] != '/' ? (int)(bough_file_name(deck->path) - deck->path) : 0;
    snprintf(path, sizeof path, "%.*s%s", folder, deck->path, word);
    if (access(path, F_OK) != 0) respell_path(path);
    return bough_arena_string(deck->arena, path);
}

const char *bough_deck_file_at(const bough_deck *deck, int line) {
    const char *path = bough_deck_path_at(deck, line);
    if (!bough_is_ok(deck->status)) return "";
    char why[BOUGH_INPUT_REASON];
    FILE *file = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (!file) {
        bough_deck_fail(deck, line, "cannot read '%.150s': %s", path, why);
        return "";
    }
    fclose(file);
    return path;
}

const char *bough_deck_file(const bough_deck *deck, const char *names) {
    char word[WORD];
    int line = value_of(deck, names, "\"file\"", word);
    return line < 0 ? "" : bough_deck_file_at(deck, line);
}

const char *bough_deck_path(const bough_deck *deck, const char *names) {
    char word[WORD];
    int line = value_of(deck, names, "\"file\"", word);
    return line < 0 ? "" : bough_deck_path_at(deck, line);
}

// -- tables ---------------------------------------------------------------------------------------

// The position of each column in a line; false when a required one is missing.
static bool find_columns(const char *line, const char *const *column, int n_column, int *place) {
    char word[WORD];
    for (int k = 0; k < n_column; k++) place[k] = -1;
    for (int i = 0; i < MOST_WORDS && next_word(&line, word); i++) {
        for (int k = 0; k < n_column; k++) {
            if (place[k] < 0 && is_one_of(word, column[k] + (column[k][0] == '?'))) place[k] = i;
        }
    }
    for (int k = 0; k < n_column; k++) {
        if (place[k] < 0 && column[k][0] != '?') return false;
    }
    return true;
}

bool bough_deck_is_comment(const bough_deck *deck, int line) {
    return line >= 0 && line < deck->n && is_comment(deck->line[line]);
}

// Whether the line is a comment, or has the units below the columns' names.
static bool skipped(const char *line) { return is_comment(line) || line[strspn(line, " \t")] == '('; }

static void read_row(const bough_deck *deck, int line, const char *const *column, int n_column,
                     const int *place, double *row) {
    char word[WORD];
    const char *at = line < deck->n ? deck->line[line] : "";
    for (int k = 0; k < n_column; k++) row[k] = (double)NAN;
    for (int i = 0; i < MOST_WORDS && next_word(&at, word); i++) {
        for (int k = 0; k < n_column; k++) {
            if (place[k] == i && !read_number(word, &row[k])) {
                bough_deck_fail(deck, line, "%s: expected a number, got '%.60s'",
                                column[k] + (column[k][0] == '?'), word);
            }
        }
    }
    for (int k = 0; k < n_column; k++) {
        if (place[k] >= 0 && isnan(row[k])) {
            bough_deck_fail(deck, line, "%s: expected a number, the row has none",
                            column[k] + (column[k][0] == '?'));
        }
    }
}

static bool begins_with_number(const char *line) {
    char word[WORD];
    double value;
    return next_word(&line, word) && read_number(word, &value);
}

const double *bough_deck_table(const bough_deck *deck, const char *const *column, int n_column, int n) {
    if (!deck || !bough_is_ok(deck->status)) return NULL;
    // the line that names all columns
    int place[MOST_WORDS], line = deck->first;
    while (line < deck->last && !find_columns(deck->line[line], column, n_column, place)) line++;
    if (line == deck->last) {
        bough_deck_fail(deck, -1, "no table with the columns %s, %s, ...", column[0],
                        n_column > 1 ? column[1] : "");
        return NULL;
    }
    // the rows below it
    double *table = bough_arena_doubles(deck->arena, (size_t)n * n_column);
    for (int i = 0; i < n && bough_is_ok(deck->status); i++) {
        do line++;
        while (line < deck->n && skipped(deck->line[line]));
        if (i == 0 && line < deck->n && !begins_with_number(deck->line[line]))
            line++; // units, in any spelling
        if (line >= deck->n) bough_deck_fail(deck, deck->n - 1, "%s: %d rows, expected %d", column[0], i, n);
        read_row(deck, line, column, n_column, place, &table[i * n_column]);
    }
    return bough_is_ok(deck->status) ? table : NULL;
}

void bough_deck_row(const bough_deck *deck, int *line, const char *what, int count, double *to) {
    char word[WORD];
    int got = 0;
    while (*line < deck->n && skipped(deck->line[*line])) ++*line;
    const char *at = *line < deck->n ? deck->line[*line] : "";
    while (got < count && next_word(&at, word) && read_number(word, &to[got])) got++;
    if (got < count) {
        bough_deck_fail(deck, *line < deck->n ? *line : deck->n - 1,
                        "%s: expected %d numbers in the line, got %d", what, count, got);
    }
    ++*line;
}

void bough_deck_numbers(const bough_deck *deck, int *line, const char *what, int count, double *to) {
    char word[WORD];
    for (int got = 0; got < count && bough_is_ok(deck->status); ++*line) {
        if (*line >= deck->n) {
            bough_deck_fail(deck, deck->n - 1, "%s: the file ends, expected %d more numbers", what,
                            count - got);
            return;
        }
        const char *at = deck->line[*line];
        if (skipped(at)) continue;
        while (got < count && next_word(&at, word)) {
            if (read_number(word, &to[got++])) continue;
            bough_deck_fail(deck, *line, "%s: expected a number, got '%.60s'", what, word);
            return;
        }
    }
}
