// Input files of OpenFAST as lines "value  Name  - comment", in which values are found by name and tables by
// the names of their columns, since lines come and go between versions. Names count only between the heading,
// whose text is free, and the list of output channels.
//
// The first failure is kept in *status, with file:line, name and what was expected; afterwards all
// reads return 0, so that a reader may check once at its end.
#ifndef BOUGH_APPS_IMPORT_DECK_H
#define BOUGH_APPS_IMPORT_DECK_H

#include "core/base/arena.h"
#include "core/base/status.h"

#include <stdbool.h>

typedef struct bough_deck {
    const char *path;
    const char **line; // (n)
    int n;
    int first, last; // names are looked for in these lines, without the last
    bough_arena *arena;
    bough_status *status;
} bough_deck;

// The lines of a file; NULL after a failure. Refused: files above 16 MB, and those with NUL bytes. The first
// `n_heading` lines that are neither empty nor comments have no names: in the file of a module its heading
// and its title, in that of an airfoil none.
enum { BOUGH_DECK_HEADING = 2 };
bough_deck *bough_deck_open(bough_arena *arena, const char *path, int n_heading, bough_status *status);

// In what follows `names` is a name or several spellings of it, "WakeMod|Wake_Mod"; capitals do not
// matter.

// The line [from 0] that has the name behind its value or its values; -1: none.
int bough_deck_line(const bough_deck *deck, const char *names);

// The deck from the line on that contains the words, for names that it has several times; the whole deck
// where there is no such line.
bough_deck bough_deck_part(const bough_deck *deck, const char *words);

// The value of that name.
double bough_deck_number(const bough_deck *deck, const char *names);
int bough_deck_whole(const bough_deck *deck, const char *names, int least, int most);
bool bough_deck_flag(const bough_deck *deck, const char *names);
const char *bough_deck_text(const bough_deck *deck, const char *names);

// The same, `fallback` where there is no such line or it says "default".
double bough_deck_number_or(const bough_deck *deck, const char *names, double fallback);
int bough_deck_whole_or(const bough_deck *deck, const char *names, int fallback);
double bough_deck_switch_or(const bough_deck *deck, const char *names, double fallback); // True is 1
bool bough_deck_flag_or(const bough_deck *deck, const char *names, bool fallback);

// The path of a file that is named relative to this one, whether it is there or not; refused unless
// it can be read; and the first word of a line as such. Where only capitals differ from what is there,
// the path is as there.
const char *bough_deck_path(const bough_deck *deck, const char *names);
const char *bough_deck_path_at(const bough_deck *deck, int line);
const char *bough_deck_file(const bough_deck *deck, const char *names);
const char *bough_deck_file_at(const bough_deck *deck, int line);

// Whether there is such a line, and it is empty or a comment (!, #, %).
bool bough_deck_is_comment(const bough_deck *deck, int line);

// A table of `n` rows below the line that names all columns, units below it skipped: (n ×
// n_column), NULL after a failure. A column "?Name" need not be there: its entries are then NaN.
const double *bough_deck_table(const bough_deck *deck, const char *const *column, int n_column, int n);

// Reads the first `count` numbers of one line, the first from *line on that is not empty or a comment;
// *line moves behind it. `what` names the row in messages.
void bough_deck_row(const bough_deck *deck, int *line, const char *what, int count, double *to);

// Reads `count` numbers that stand from *line on, which moves behind the last one's; empty lines
// and comments are skipped. `what` names them in messages.
void bough_deck_numbers(const bough_deck *deck, int *line, const char *what, int count, double *to);

// The first line that has the words; -1: none.
int bough_deck_find(const bough_deck *deck, const char *words);

// Keeps a failure at a line [from 0; -1: the file], unless there was one.
void bough_deck_fail(const bough_deck *deck, int line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// The same at the line of that name, which begins the message.
void bough_deck_refuse(const bough_deck *deck, const char *names, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
