// channels.out for the page.
#include "apps/bough/results/recorder.h"
#include "apps/bough/results/report.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

enum { MOST_ROWS = 4000 };

// The words as strings. Brackets around a unit are left out.
static void put_words(int n, const char *const *words, FILE *out) {
    for (int k = 0; k < n; k++) {
        const char *word = words[k];
        size_t length = strlen(word);
        bool bracket = length > 1 && word[0] == '(' && word[length - 1] == ')';
        fputs(k > 0 ? ",\"" : "[\"", out);
        for (size_t i = bracket; i < length - bracket; i++) {
            if (isalnum((unsigned char)word[i]) || strchr("_-/.^*% ", word[i])) fputc(word[i], out);
        }
        fputc('"', out);
    }
    fputc(']', out);
}

static bough_status put_row(const bough_rows *r, FILE *out) {
    for (int k = 0; k < r->n; k++) {
        if (!isfinite(r->value[k])) return bough_rows_damaged(r);
        fprintf(out, k > 0 ? ",%.6g" : "[%.9g", r->value[k]);
    }
    fputs("],\n", out);
    return bough_ok();
}

bough_status bough_report_channels(bough_arena *arena, const char *folder, FILE *out, bool *found) {
    bough_rows *r;
    bough_status status = bough_rows_open(arena, folder, &r);
    *found = r != NULL;
    if (!bough_is_ok(&status) || !r) return status;
    fputs("{names: ", out);
    put_words(r->n, r->name, out);
    fputs(", units: ", out);
    put_words(r->n, r->unit, out);
    fputs(", rows: [\n", out);
    long stride = 1 + r->n_row / MOST_ROWS;
    for (long k = 0; bough_rows_line(r); k++) {
        if (k % stride != 0) continue;
        BOUGH_TRY(bough_rows_read(r));
        BOUGH_TRY(put_row(r, out));
    }
    fputs("]}", out);
    return bough_ok();
}
