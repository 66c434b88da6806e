// AeroDyn 14 and 13: the same by elements of constant length, with airfoils in files of their own form.
#include "apps/import/openfast.h"

#include <math.h>
#include <string.h>
#include <strings.h>

enum { MOST_ROWS = 2000, POLAR = BOUGH_POLAR_COLUMNS, MOST_WORDS = 40, NAME = BOUGH_AIRFOIL_NAME };

// -- airfoils -------------------------------------------------------------------------------------

// The rows (n × POLAR) of the first table: the lines that are numbers only, angle, lift, drag and moment. Of
// files with several tables side by side a row has 1 + 3 k numbers, or 1 + 2 k without moments.
static double *read_polar(bough_openfast *o, const bough_deck *deck, bool moments, int *n) {
    double *table = bough_arena_doubles(o->draft.arena, POLAR * MOST_ROWS), value[MOST_WORDS];
    *n = 0;
    for (int line = 2; line < deck->n && *n < MOST_ROWS; line++) {
        int count = bough_deck_only_numbers(deck, line, MOST_WORDS, value);
        if (bough_deck_is_comment(deck, line)) continue;
        if (count < 3 && *n > 0) break;
        if (count < 3) continue;
        double *row = table + POLAR * *n;
        row[0] = value[0], row[1] = value[1], row[2] = value[2];
        row[3] = moments && count > 3 ? value[3] : 0;
        if (fabs(row[0]) > 180 + 1e-3 || (*n > 0 && row[0] <= row[-POLAR])) {
            bough_deck_fail(deck, line, "expected increasing angles of attack from -180 to 180 deg, got %g",
                            row[0]);
        }
        ++*n;
    }
    if (*n == 0) bough_deck_fail(deck, -1, "no table of an airfoil: expected rows of angle, lift and drag");
    return bough_is_ok(o->draft.status) ? table : NULL;
}

static int put_polars(bough_openfast *o, char (*name)[NAME]) {
    int n = bough_deck_whole(o->aero, "NumFoil", 1, BOUGH_MOST_AIRFOILS);
    int line = bough_deck_line(o->aero, "NumFoil") + 1;
    bool moments = strncasecmp(bough_deck_text(o->aero, "UseCm"), "USE", 3) == 0;
    fputs("polars:\n", o->draft.file[BOUGH_IMPORT_POLARS]);
    for (int i = 0; i < n && bough_is_ok(o->draft.status); i++) {
        int rows;
        bough_deck *deck = bough_openfast_open_airfoil(o, &line, i + 1, name[i]);
        if (!deck) return 0;
        const double *table = read_polar(o, deck, moments, &rows);
        if (table) bough_draft_polar(&o->draft, name[i], table, rows);
    }
    bough_draft_note(&o->draft, BOUGH_TAKEN, "%d airfoils: lift, drag%s, the first table of each file", n,
                     moments ? ", moment" : "");
    return n;
}

// -- blade elements -------------------------------------------------------------------------------

// The elements' middles, counted from the blade's root.
void bough_openfast_aero14_tables(bough_openfast *o) {
    static const char *const column[] = {"RNodes", "AeroTwst", "Chord", "NFoil"};
    enum { RADIUS, TURN, WIDTH, FOIL, N };
    char(*name)[NAME] = bough_arena_take(o->draft.arena, BOUGH_MOST_AIRFOILS * sizeof *name);
    int n_name = put_polars(o, name), n = bough_deck_whole(o->aero, "BldNodes", 1, MOST_ROWS);
    const double *table = bough_deck_table(o->aero, column, N, n);
    if (!table) return;
    double *row = bough_arena_doubles(o->draft.arena, (size_t)n * BOUGH_N_ELEMENT_COLUMN);
    for (int i = 0; i < n; i++) {
        double *to = row + BOUGH_N_ELEMENT_COLUMN * i;
        const double *from = table + N * i;
        to[BOUGH_ELEMENT_SPAN] = from[RADIUS] - o->hub_radius;
        to[BOUGH_ELEMENT_TWIST] = from[TURN];
        to[BOUGH_ELEMENT_CHORD] = from[WIDTH];
        to[BOUGH_ELEMENT_AIRFOIL] = from[FOIL];
    }
    bough_openfast_put_elements(o, o->aero, "BldNodes", row, n, name, n_name);
    bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                     "elements of constant twist, chord and airfoil: linear between their "
                     "middles");
}

// -- theory ---------------------------------------------------------------------------------------

static bool says(const bough_openfast *o, const char *key, const char *word) {
    return strncasecmp(bough_deck_text(o->aero, key), word, strlen(word)) == 0;
}

void bough_openfast_aero14(bough_openfast *o) {
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    bool dynamic = says(o, "InfModel", "DYN"), stall = says(o, "StallMod", "BED");
    fprintf(file,
            "  induction: {tip_loss: %s, hub_loss: %s, tangential: %s, drag: false, skew: pitt-peters, "
            "high_thrust: smooth%s}\n",
            says(o, "TLModel", "NONE") ? "false" : "true", says(o, "HLModel", "NONE") ? "false" : "true",
            says(o, "IndModel", "SWIRL") ? "true" : "false", dynamic ? ", inflow: oye" : "");
    if (stall) fputs("  dynamic_stall: hgm\n", file);
    if (says(o, "UseCm", "NO")) fputs("  pitching_moment: false\n", file);
    bough_draft_note(
        &o->draft, BOUGH_APPROXIMATED,
        "AeroDyn 14: momentum balance with smooth high-thrust correction, without drag in the induction");
    if (dynamic) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                         "InfModel DYNIN: Oye's dynamic inflow for the generalised "
                         "dynamic wake");
    }
    if (stall) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                         "StallMod BEDDOES: dynamic stall by Hansen, Gaunaa and Madsen's "
                         "model, its constants from the polars");
    }
    if (says(o, "IndModel", "NONE")) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED, "IndModel NONE: axial induction is computed");
    }
    const char *shadow = bough_deck_line(o->aero, "TwrShad") >= 0 ? bough_deck_text(o->aero, "TwrShad") : "0";
    if (shadow[strspn(shadow, "+-.0eEdD")] != '\0') { // a deficit, or NEWTOWER
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "the tower's influence on the wind");
    }
}
