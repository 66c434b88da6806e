// Tables that say what a file may hold. One table of keys gives the reading into plain structs, the
// defaults, the errors and the help text.
//
// A struct that a schema fills begins with `const bough_node *node`, its place in the text.
#pragma once

#include "apps/bough/config/text.h"

#include <locale.h>

typedef enum bough_dimension {
    BOUGH_PURE_NUMBER,
    BOUGH_TIME,
    BOUGH_LENGTH,
    BOUGH_ANGLE,
    BOUGH_ANGULAR_SPEED,
    BOUGH_SPEED,
    BOUGH_ACCELERATION,
    BOUGH_FREQUENCY,
    BOUGH_MASS,
    BOUGH_INERTIA,
    BOUGH_DENSITY,
    BOUGH_FORCE,
    BOUGH_MOMENT,
    BOUGH_STIFFNESS,
    BOUGH_LINE_FORCE,
    BOUGH_LINE_MOMENT,
    BOUGH_POWER,
} bough_dimension;

// How a value is written, and what its field in the struct is.
typedef enum bough_key_kind {
    BOUGH_KEY_NUMBER,  // double, SI
    BOUGH_KEY_INTEGER, // int
    BOUGH_KEY_TEXT,    // const char *
    BOUGH_KEY_CHOICE,  // int: index in choices; −1 after an error
    BOUGH_KEY_BOOLEAN, // bool
    BOUGH_KEY_VECTOR,  // double[count]
    BOUGH_KEY_NUMBERS, // double *, and an int at count_offset
    BOUGH_KEY_TEXTS,   // const char **, and an int at count_offset
    BOUGH_KEY_MAPPING, // the struct of schema `of`
    BOUGH_KEY_LIST,    // pointer to structs of schema `of`, and an int at count_offset. Written as a
                       // list of mappings, or {columns: [span, twist deg, …], rows: [[…], …]}
    BOUGH_KEY_FILE,    // the struct of schema `of`, read from the file of that name
    BOUGH_KEY_CUSTOM,  // read by `read`
} bough_key_kind;

typedef struct bough_schema bough_schema;
typedef struct bough_schema_reader bough_schema_reader;

typedef struct bough_key {
    const char *name;
    bough_key_kind kind;
    bough_dimension dimension;
    const char *range;                // of numbers, SI: "> 0", ">= 0", "[0, 2]"; NULL: any
    const char *word;                 // a word in place of a number, stored as 0
    const char *const *choices;       // ends with NULL
    const char *(*choice)(int index); // in place of it; NULL beyond the end
    const char *when_key;             // the key applies only where this earlier choice …
    const char *when;                 // … is one of these, "revolute|prismatic"; NULL: always
    const char *fallback;             // default as it would be written
    bool required;
    bool increasing; // a number of the rows of a list, or numbers
    int count;       // of a vector; least number of items of a list
    const bough_schema *of;
    void (*read)(bough_schema_reader *reader, const bough_node *node, void *field);
    size_t offset, count_offset; // of the field in the struct
    const char *form;            // of a custom key, for the help
    const char *example;         // as it would be written; not of choices: bough_key_example
    const char *help;
} bough_key;

struct bough_schema {
    const char *name; // "a body"
    size_t size;      // of the struct
    int n_key;
    const bough_key *key;
    // Checks across keys; called when all keys were read without an error.
    void (*check)(bough_schema_reader *reader, void *item);
};

// A file that a key names.
typedef struct bough_schema_file {
    struct bough_schema_file *next;
    const char *key, *path;     // "bodies[0].rod.structure"; as it is opened
    bool absolute;              // the key has an absolute path
    const bough_schema *schema; // by which its struct `item` was read; NULL: only the name is known
    void *item;
} bough_schema_file;

// What was read from files, for several scenes that share it and do not change it. The arena outlives them.
typedef struct bough_schema_shared {
    bough_arena *arena;
    bough_schema_file *file; // NULL at the beginning; `item` NULL: it has errors, which each scene reports
    bool complete;           // files are looked up but not added, so that several threads may read scenes
} bough_schema_shared;

// A file on which the scene builds: see config/base.h.
typedef struct bough_schema_base {
    struct bough_schema_base *next; // the base of this one, NULL: it has none
    const char *path;               // as it is opened, and as its nodes name it
    const char *directory;          // of the paths in it, with its last slash; "" for the current one
    bool absolute;                  // its path, or that of a file between it and the first one, is absolute
} bough_schema_base;

// What the readers of values share: memory and errors, where files are named from, the place that is read.
struct bough_schema_reader {
    bough_arena *arena;
    bough_errors *errors;
    const char *directory;          // with its last slash, "" for the current one
    const bough_schema_base *bases; // of the scene, whose values name files from directories of their own
    const char *unit;               // of plain numbers, from the head of a column; NULL: SI
    char path[256];                 // of the value being read
    const bough_key *key;           // whose value `read` of the key is called for
    int out_of_order;               // errors of values that do not increase
    bough_schema_file *files;       // named so far, once each without a schema, once with each that read it
    bough_schema_shared *shared;    // with other scenes; NULL: nothing
};

// Fills `item` (zeroed, of the schema's size) from a mapping; NULL fills the defaults.
void bough_schema_read(bough_schema_reader *reader, const bough_schema *schema, const bough_node *node,
                       void *item);

// Adds an error with the path of the value being read, then `.key` unless key is "", "output.frames". It
// is placed at the key's value below `node`; without one, at the nearest value above.
void bough_schema_error(bough_schema_reader *reader, const bough_node *node, const char *key,
                        const char *format, ...) __attribute__((format(printf, 4, 5)));

// Appends to the path of errors, a key or what is printed; the length before, for pop.
size_t bough_schema_push(bough_schema_reader *r, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
size_t bough_schema_push_key(bough_schema_reader *r, const char *name);
void bough_schema_pop(bough_schema_reader *r, size_t length);

// An error at the node: it is not `what`.
void bough_schema_expected(bough_schema_reader *r, const bough_node *node, const char *what);

// The path of a file that the scene names by the value `node` being read or, unless key is "", by its `.key`:
// relative to the directory of the scene, or of the base in which the name stands. Every name of a file comes
// by here and is then in reader->files.
const char *bough_schema_path(bough_schema_reader *reader, const bough_node *node, const char *key,
                              const char *name);

// Records a file that the scene is made of and that no value of it names.
void bough_schema_add_file(bough_schema_reader *reader, const char *key, const char *path, bool absolute);

// Reads a value that is no mapping, table, file or custom one into its field of the struct.
void bough_schema_value(bough_schema_reader *r, const bough_key *key, const bough_node *node, void *item);

// Reads a number with or without a unit; NaN after adding an error.
double bough_schema_number(bough_schema_reader *reader, const bough_node *node, bough_dimension dimension);

// Reads a list of `few` or of `many` plain numbers; its length, or −1 after adding an error. `expected` says
// what the list should be.
int bough_schema_numbers(bough_schema_reader *reader, const bough_node *node, int few, int many,
                         double *values, const char *expected);

// Makes the C locale that of the calling thread, so that numbers have a decimal point whatever locale its
// program or a library has set; returns the one that uselocale() restores.
locale_t bough_c_locale(void);

// The value in SI of a number followed by a unit of that dimension, or by none. False when it is
// not one; `why` then receives the reason.
bool bough_quantity(const char *text, bough_dimension dimension, double *value, char why[160]);

// What is expected of it: "a length (in m, or with a unit, as '61.5 m')".
void bough_dimension_expected(bough_dimension dimension, char text[96]);

// A unit such as "kN", "rad/s", "kg m^2" in base units: its factor and the exponents of m, kg, s and rad.
// False with a reason for a text that is not one.
enum { BOUGH_BASE_UNITS = 4 };
bool bough_unit_base(const char *text, double *factor, int exponent[BOUGH_BASE_UNITS], char why[160]);

// Whether the value is in a range "> 0", ">= 0", "[0, 2]", "(0, 2]"; NULL: any is.
bool bough_in_range(double value, const char *range);

// A whole number of at most nine digits.
enum { BOUGH_MOST_WHOLE = 999999999 };
bool bough_whole_number(const char *text, int *value);

// The candidate nearest to a misspelt word, NULL when none is near. Candidates may be NULL.
const char *bough_nearest(const char *word, const char *const *candidates, int n);

// The same for the end of a message: " (did you mean 'hub'?)", or "" when none is near.
typedef struct bough_suggestion {
    char text[64];
} bough_suggestion;
bough_suggestion bough_suggest(const char *word, const char *const *candidates, int n);

// What a node holds, for messages: "'12 x'", "a list", "nothing".
const char *bough_node_shown(const bough_node *node, char buffer[64]);

// The choice of that index; NULL beyond the end and of other kinds.
const char *bough_key_choice(const bough_key *key, int index);

// How the key's value may be written, other than its default; "" of a mapping or a list of
// mappings, whose keys have their own.
const char *bough_key_example(const bough_key *key);

// Writes every key below the schema as a list in Markdown, indented by `indent`.
void bough_schema_help(const bough_schema *schema, int indent, FILE *stream);

// Writes a JSON Schema of the files that any of the n schemas describes.
void bough_schema_json(const char *title, const bough_schema *const *schema, int n, FILE *stream);

// "rad/s"; "" for a pure number.
const char *bough_dimension_unit(bough_dimension dimension);

// Writes the SI unit of every dimension and an example with another, as a list in Markdown.
void bough_schema_help_units(FILE *stream);

// -- what the files of the schema share among themselves: units and ranges --------------------------

// Whether the text is a unit of the dimension, and its factor; otherwise `why` has the reason.
bool bough_unit_fits(const char *text, bough_dimension dimension, double *factor, char why[160]);

// Memory for the items of a list, which is then in the key's field of the struct `item` with its count; NULL
// (and an error) when the node is not one long enough.
void *bough_schema_items(bough_schema_reader *r, const bough_key *key, const bough_node *node, size_t size,
                         void *item);

// An error: the value of a key that increases is not more than the one before it.
void bough_schema_not_more(bough_schema_reader *r, const char *key, const bough_node *before,
                           const bough_node *node);

// Whether the word is one of a list, of "a|b|c" with the separator '|'.
bool bough_word_is_among(const char *word, const char *list, char separator);

// The first key of that name; NULL: there is none.
const bough_key *bough_schema_find(const bough_schema *schema, const char *name);

static inline void *bough_field_at(void *item, size_t offset) { return (char *)item + offset; }
