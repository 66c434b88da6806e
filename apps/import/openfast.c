// The main file of an OpenFAST model, and the order in which the scene is written.
#include "apps/import/import.h"

#include "apps/import/openfast.h"
#include "apps/output/folder.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double macro_step = 0.02; // [s]

const char *const bough_import_name[BOUGH_N_IMPORT_FILE] = {
    "scene.yaml",      "blade-structure.yaml", "tower-structure.yaml",
    "blade-aero.yaml", "airfoils.yaml",        "import.txt"};

void bough_openfast_note(bough_openfast *o, bough_import_note kind, const char *format, ...) {
    va_list list;
    va_start(list, format);
    fputs("  ", o->note[kind]);
    vfprintf(o->note[kind], format, list);
    fputc('\n', o->note[kind]);
    va_end(list);
}

void bough_import_list(FILE *file, const double *value, int n) {
    for (int i = 0; i < n; i++)
        fprintf(file, "%s%.10g", i == 0 ? "[" : ", ", value[i] + 0.0);
    fputc(']', file);
}

void bough_import_quoted(FILE *file, const char *text) {
    fputc('"', file);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\') fputc('\\', file);
        if ((unsigned char)*text >= ' ') fputc(*text, file);
    }
    fputc('"', file);
}

void bough_import_path(FILE *file, const char *path) {
    char here[BOUGH_PATH_MAX], whole[2 * BOUGH_PATH_MAX];
    bool relative = path[0] != '/' && getcwd(here, sizeof here);
    snprintf(whole, sizeof whole, "%s%s%s", relative ? here : "", relative ? "/" : "", path);
    bough_import_quoted(file, whole);
}

bough_deck *bough_openfast_open(bough_openfast *o, const bough_deck *from, const char *names) {
    const char *path = bough_deck_file(from, names);
    bough_deck *deck = bough_deck_open(o->arena, path, o->status);
    if (deck)
        bough_openfast_note(o, BOUGH_TAKEN, "%.*s: %s", (int)strcspn(names, "|"), names, path);
    return deck;
}

// -- reading --------------------------------------------------------------------------------------

static void refuse_water(const bough_openfast *o) {
    static const char *const part[] = {"CompHydro", "CompSub", "CompMooring", "CompIce", "MHK"};
    for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
        if (bough_deck_whole_or(o->main, part[i], 0) == 0) continue;
        bough_deck_fail(o->main, bough_deck_line(o->main, part[i]),
                        "%s: expected 0, a turbine on land", part[i]);
    }
}

static void open_modules(bough_openfast *o) {
    int elastic = bough_deck_whole(o->main, "CompElast", 1, 2);
    int air = bough_deck_whole(o->main, "CompAero", 0, 3);
    refuse_water(o);
    o->beamdyn = elastic == 2;
    o->elasto = bough_openfast_open(o, o->main, "EDFile");
    if (bough_deck_whole(o->main, "CompInflow", 0, 2) == 1) {
        o->inflow = bough_openfast_open(o, o->main, "InflowFile");
    } else if (air != 0) {
        bough_openfast_note(o, BOUGH_APPROXIMATED, "without InflowWind the air is still");
    }
    if (air == 2) o->aero = bough_openfast_open(o, o->main, "AeroFile");
    if (air == 1 || air == 3) {
        bough_deck_fail(o->main, bough_deck_line(o->main, "CompAero"),
                        "CompAero: expected 0 or 2 (AeroDyn 15), got %d", air);
    }
    if (bough_deck_whole_or(o->main, "CompServo", 0) == 1) {
        o->servo = bough_openfast_open(o, o->main, "ServoFile");
    }
}

// A blade or tower bends if one of its motions is wanted.
static bool any(const bough_deck *deck, const char *const *name) {
    for (; *name; name++) {
        if (bough_deck_flag_or(deck, *name, false)) return true;
    }
    return false;
}

static void read_shape(bough_openfast *o) {
    static const char *const blade[] = {"FlapDOF1", "FlapDOF2", "EdgeDOF", NULL};
    static const char *const tower[] = {"TwFADOF1", "TwFADOF2", "TwSSDOF1", "TwSSDOF2", NULL};
    const bough_deck *e = o->elasto;
    o->n_blade = bough_deck_whole(e, "NumBl", 1, BOUGH_IMPORT_BLADES);
    o->hub_radius = bough_deck_number(e, "HubRad");
    o->tower_top = bough_deck_number(e, "TowerHt");
    o->tower_base = bough_deck_number_or(e, "TowerBsHt", 0);
    if (!bough_is_ok(o->status)) return;
    if (!(o->tower_top > o->tower_base)) {
        bough_deck_fail(e, bough_deck_line(e, "TowerHt"), "TowerHt: expected more than TowerBsHt");
    }
    o->rigid_blade = !o->beamdyn && !any(e, blade);
    o->rigid_tower = !any(e, tower);
}

// -- writing --------------------------------------------------------------------------------------

static void put_head(bough_openfast *o, const char *path) {
    FILE *file = o->file[BOUGH_IMPORT_SCENE];
    double g = bough_deck_number_or(o->main, "Gravity",
                                    bough_deck_number_or(o->elasto, "Gravity", 9.80665));
    double most = bough_deck_number(o->main, "TMax");
    double steps = fmax(ceil(most / macro_step - 1e-6), 1);
    const char *slash = strrchr(path, '/');
    fprintf(file, "# Imported from an OpenFAST model: import.txt tells what was taken.\n"
                  "# Ground axes: x downwind, z up. The rotor turns positive about the shaft's x.\n"
                  "title: ");
    bough_import_quoted(file, slash ? slash + 1 : path);
    fprintf(file,
            "\ngravity: [0, 0, %.10g]\nsimulation:\n  duration: %.10g s\n"
            "  macro_step: %g s\n  coupling: {scheme: ramp, theta: auto}\n"
            "  master: {solver: ida, rtol: 1e-6}\n"
            "  micro: {solver: rosenbrock, step: 10 ms, rtol: 1e-3}\n  threads: 2\n",
            -g, steps * macro_step, macro_step);
    bough_openfast_note(o, BOUGH_LEFT_OUT,
                        "solver settings, output channels, visualisation, "
                        "linearisation: the scene has its own");
}

static void note_other_blades(bough_openfast *o, const bough_deck *deck, const char *stem) {
    char name[64], first[64];
    snprintf(first, sizeof first, "%s(1)|%s1", stem, stem);
    for (int k = 2; k <= o->n_blade && bough_is_ok(o->status); k++) {
        snprintf(name, sizeof name, "%s(%d)|%s%d", stem, k, stem, k);
        if (bough_deck_line(deck, name) < 0) continue;
        if (strcmp(bough_deck_text(deck, name), bough_deck_text(deck, first)) == 0) continue;
        bough_openfast_note(o, BOUGH_APPROXIMATED, "%s(%d): blade %d is as the first", stem, k, k);
    }
}

static void write_scene(bough_openfast *o, const char *path) {
    if (!bough_is_ok(o->status)) return;
    put_head(o, path);
    if (o->beamdyn)
        bough_openfast_beamdyn(o);
    else
        bough_openfast_blade(o);
    bough_openfast_library(o);
    bough_openfast_bodies(o);
    bough_openfast_aero_tables(o);
    bough_openfast_aero(o);
    bough_openfast_control(o);
    note_other_blades(o, o->beamdyn ? o->main : o->elasto, o->beamdyn ? "BDBldFile" : "BldFile");
    if (o->aero) note_other_blades(o, o->aero, "ADBlFile");
}

static bough_status write_file(const char *folder, int kind, const char *text) {
    char path[BOUGH_PATH_MAX];
    FILE *file;
    bough_status status = bough_folder_path(folder, bough_import_name[kind], path);
    if (bough_is_ok(&status)) status = bough_folder_open_partial(path, &file);
    if (!bough_is_ok(&status)) return status;
    fputs(text, file);
    return bough_folder_commit(path, file);
}

// The scene last: with it the model is whole.
static bough_status write_files(const char *folder, char *const *text) {
    bough_status status = bough_folder_make(folder);
    for (int i = BOUGH_N_IMPORT_FILE - 1; i >= 0 && bough_is_ok(&status); i--) {
        if (text[i][0]) status = write_file(folder, i, text[i]);
    }
    return status;
}

static void put_list(bough_openfast *o, char *const *note) {
    static const char *const head[BOUGH_N_NOTE] = {"taken", "approximated", "left out"};
    for (int i = 0; i < BOUGH_N_NOTE; i++)
        fprintf(o->file[BOUGH_IMPORT_LIST], "%s:\n%s", head[i],
                note[i][0] ? note[i] : "  nothing\n");
}

// Closes texts; whether all were written whole.
static bool close_all(FILE **file, int n) {
    bool good = true;
    for (int i = 0; i < n; i++) {
        if (file[i] && (ferror(file[i]) || fclose(file[i]) != 0)) good = false;
    }
    return good;
}

static void convert(bough_openfast *o, const char *path) {
    o->main = bough_deck_open(o->arena, path, o->status);
    if (o->main) open_modules(o);
    if (bough_is_ok(o->status)) read_shape(o);
    write_scene(o, path);
}

bough_status bough_import_openfast(const char *path, const char *folder, FILE *echo) {
    char *note[BOUGH_N_NOTE] = {NULL}, *text[BOUGH_N_IMPORT_FILE] = {NULL};
    size_t note_size[BOUGH_N_NOTE], size[BOUGH_N_IMPORT_FILE];
    bough_status status = bough_ok();
    bough_openfast o = {.arena = bough_arena_create(), .status = &status};
    bool good = o.arena != NULL;
    for (int i = 0; i < BOUGH_N_NOTE; i++)
        good = (o.note[i] = open_memstream(&note[i], &note_size[i])) && good;
    for (int i = 0; i < BOUGH_N_IMPORT_FILE; i++)
        good = (o.file[i] = open_memstream(&text[i], &size[i])) && good;
    if (good) convert(&o, path);
    good = close_all(o.note, BOUGH_N_NOTE) && good;
    if (good) put_list(&o, note);
    good = close_all(o.file, BOUGH_N_IMPORT_FILE) && good;
    if (!good) status = bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    if (bough_is_ok(&status)) status = write_files(folder, text);
    if (bough_is_ok(&status) && echo) fputs(text[BOUGH_IMPORT_LIST], echo);
    for (int i = 0; i < BOUGH_N_NOTE; i++)
        free(note[i]);
    for (int i = 0; i < BOUGH_N_IMPORT_FILE; i++)
        free(text[i]);
    bough_arena_destroy(o.arena);
    return status;
}
