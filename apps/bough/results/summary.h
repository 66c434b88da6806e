// A small JSON writer for summary.json. The caller states the fields in order; the file appears
// under its name only when it is complete.
#pragma once

#include "apps/bough/results/folder.h"

typedef struct bough_summary {
    FILE *file;
    char path[BOUGH_PATH_MAX];
    char closing[16]; // the brackets still open, outermost first
    int depth;
    bool first; // nothing written yet inside the innermost bracket
} bough_summary;

// Begins folder/name with its outermost object.
bough_status bough_summary_open(bough_summary *s, const char *folder, const char *name);

// A field of the innermost object, or, with the key NULL, an element of the innermost array.
// JSON knows no NaN and no infinity: such a number becomes null, as does a NULL text.
void bough_summary_number(bough_summary *s, const char *key, double value);
void bough_summary_integer(bough_summary *s, const char *key, long long value);
void bough_summary_text(bough_summary *s, const char *key, const char *text);

// An object or array as a field or element, up to bough_summary_end.
void bough_summary_object(bough_summary *s, const char *key);
void bough_summary_array(bough_summary *s, const char *key);
void bough_summary_end(bough_summary *s);

// Ends what is still open and gives the file its name, replacing an older one.
bough_status bough_summary_close(bough_summary *s);
