// What the readers of OpenFAST's modules share. Each reads the decks of its module and writes its
// part of the scene and of the list.
#pragma once

#include "apps/bough/import/draft.h"
#include "apps/bough/import/import.h"

// -- the format (deck.c) --------------------------------------------------------------------------

// Input files of OpenFAST as lines "value  Name  - comment", in which values are found by name and tables by
// the names of their columns, since lines come and go between versions. Names count only between the heading,
// whose text is free, and the list of output channels.
//
// The first failure is kept in *status, with file:line, name and what was expected; afterwards all
// reads return 0, so that a reader may check once at its end.

typedef struct bough_deck {
    const char *path;
    const char **line; // (n)
    int n;
    int first, last; // lines in which names are searched, without the last
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

// The line [from 0] with the name after its value or its values; -1: none.
int bough_deck_line(const bough_deck *deck, const char *names);

// The deck from the first line on that contains the words, for names that occur several times; the whole deck
// without such a line.
bough_deck bough_deck_part(const bough_deck *deck, const char *words);

// The spellings of a name of the k-th blade: "TipMass(2)|TipMass2".
const char *bough_deck_kth(const bough_deck *deck, const char *stem, int k);

// The value of that name.
double bough_deck_number(const bough_deck *deck, const char *names);
int bough_deck_whole(const bough_deck *deck, const char *names, int least, int most);
const char *bough_deck_text(const bough_deck *deck, const char *names);

// The same, `fallback` where there is no such line or it says "default".
double bough_deck_number_or(const bough_deck *deck, const char *names, double fallback);
int bough_deck_whole_or(const bough_deck *deck, const char *names, int fallback);
double bough_deck_switch_or(const bough_deck *deck, const char *names, double fallback); // True is 1
bool bough_deck_flag_or(const bough_deck *deck, const char *names, bool fallback);

// The path of a file that the deck names relative to itself; _at: named by the first word of a line. Where
// only capitals differ from an existing file, its spelling is taken. bough_deck_path gives it even if there
// is no such file; bough_deck_file refuses one that cannot be read.
const char *bough_deck_path(const bough_deck *deck, const char *names);
const char *bough_deck_path_at(const bough_deck *deck, int line);
const char *bough_deck_file(const bough_deck *deck, const char *names);
const char *bough_deck_file_at(const bough_deck *deck, int line);

// Whether the line exists and is empty or a comment (!, #, %).
bool bough_deck_is_comment(const bough_deck *deck, int line);

// A table of `n` rows below the line that names all columns, units below it skipped: (n ×
// n_column), NULL after a failure. A column "?Name" may be missing: its entries are then NaN.
const double *bough_deck_table(const bough_deck *deck, const char *const *column, int n_column, int n);

// Reads the first `count` numbers of one line, the first from *line on that is not empty or a comment;
// *line moves past it. `what` names the row in messages.
void bough_deck_row(const bough_deck *deck, int *line, const char *what, int count, double *to);

// Reads `count` numbers from *line on, which moves past the line of the last; empty lines and comments are
// skipped. `what` names them in messages.
void bough_deck_numbers(const bough_deck *deck, int *line, const char *what, int count, double *to);

// The first line that has the words; -1: none.
int bough_deck_find(const bough_deck *deck, const char *words);

// Keeps a failure at a line [from 0; -1: the file], unless there was one.
void bough_deck_fail(const bough_deck *deck, int line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// The same at the line of that name, which begins the message.
void bough_deck_refuse(const bough_deck *deck, const char *names, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// What acts on the generator.
typedef enum bough_generator {
    BOUGH_GENERATOR_FREE,    // nothing
    BOUGH_GENERATOR_DRIVEN,  // it turns at the speed of the start
    BOUGH_GENERATOR_LAW,     // a torque over the speed
    BOUGH_GENERATOR_LIBRARY, // a controller in the style of Bladed
} bough_generator;

typedef struct bough_openfast {
    bough_draft *draft;
    bough_deck *main, *elasto, *tower, *servo, *inflow, *aero; // NULL: the model has none
    int n_blade;
    bool beamdyn; // blades by BeamDyn, else by ElastoDyn
    bool rigid_blade, rigid_tower;
    bough_generator generator;
    const char *library;          // of the controller
    const char *unknown_torque;   // which torque is not known, so that the speed is prescribed; NULL: none
    double hub_radius;            // [m]
    double blade_length;          // [m]
    double blade_mass;            // [kg]
    double blade_inertia;         // about the rotor's axis, without cone [kg m2]
    double tower_base, tower_top; // above ground [m]
} bough_openfast;

// Opens and checks the file of a module, and notes its path; from NULL: the main file, whose path is `names`.
bough_deck *bough_openfast_open(bough_openfast *o, const bough_deck *from, const char *names);

// Values of a deck that a scene cannot represent, and the note on them.
typedef struct bough_openfast_rest {
    const char *text;      // NULL: the name alone
    double neutral;        // value without a note; False is 0
    const char *names[12]; // ends with NULL
} bough_openfast_rest;
void bough_openfast_leave(bough_openfast *o, const bough_deck *deck, const bough_openfast_rest *rest,
                          size_t n, int list);

// Tables of blade and tower.
void bough_openfast_beamdyn(bough_openfast *o);
void bough_openfast_blade(bough_openfast *o);
void bough_openfast_tower(bough_openfast *o);

// Adds a slice of a blade to its mass and inertia: from and to [m], mass there [kg/m].
void bough_openfast_weigh(bough_openfast *o, const double span[2], const double mass[2]);

// Tables of airfoils and blade elements, and the part `aero` of the scene; its wind.
void bough_openfast_aero_tables(bough_openfast *o);
void bough_openfast_aero(bough_openfast *o);
void bough_openfast_wind(bough_openfast *o);

// The highest speed of the rotor in the decks [rad/s].
double bough_openfast_rotor_speed(const bough_openfast *o);

// Determines what acts on the generator.
void bough_openfast_generator(bough_openfast *o);

// The parts `bodies` and `turbine` of the scene; `control`.
void bough_openfast_bodies(bough_openfast *o);
void bough_openfast_control(bough_openfast *o);

// The generator's inertia on the slow shaft [kg m2]; whether it turns against the hub.
double bough_openfast_generator_inertia(const bough_openfast *o);
bool bough_openfast_shaft_twists(const bough_openfast *o);
