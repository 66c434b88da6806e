#include "apps/bough/results/summary.h"

#include "core/base/quote.h"

static void indent(bough_summary *s) { fprintf(s->file, "\n%*s", 2 * s->depth, ""); }

// The comma, the line and the key before a value.
static void begin(bough_summary *s, const char *key) {
    assert((key == NULL) == (s->closing[s->depth - 1] == ']'));
    if (!s->first) fputc(',', s->file);
    s->first = false;
    indent(s);
    if (!key) return;
    bough_quote(s->file, key);
    fputs(": ", s->file);
}

static void open_bracket(bough_summary *s, char opening, char closing) {
    assert(s->depth < (int)sizeof s->closing);
    fputc(opening, s->file);
    s->closing[s->depth++] = closing;
    s->first = true;
}

bough_status bough_summary_open(bough_summary *s, const char *folder, const char *name) {
    *s = (bough_summary){.file = NULL};
    BOUGH_TRY(bough_folder_open(folder, name, s->path, &s->file));
    open_bracket(s, '{', '}');
    return bough_ok();
}

void bough_summary_number(bough_summary *s, const char *key, double value) {
    begin(s, key);
    if (!isfinite(value)) {
        fputs("null", s->file);
        return;
    }
    char text[32];
    snprintf(text, sizeof text, "%.15g", value); // 0.1 rather than 0.10000000000000001
    if (strtod(text, NULL) < value || strtod(text, NULL) > value) {
        snprintf(text, sizeof text, "%.17g", value);
    }
    fputs(text, s->file);
}

void bough_summary_integer(bough_summary *s, const char *key, long long value) {
    begin(s, key);
    fprintf(s->file, "%lld", value);
}

void bough_summary_text(bough_summary *s, const char *key, const char *text) {
    begin(s, key);
    if (text) {
        bough_quote(s->file, text);
    } else {
        fputs("null", s->file);
    }
}

void bough_summary_object(bough_summary *s, const char *key) {
    begin(s, key);
    open_bracket(s, '{', '}');
}

void bough_summary_array(bough_summary *s, const char *key) {
    begin(s, key);
    open_bracket(s, '[', ']');
}

void bough_summary_end(bough_summary *s) {
    assert(s->depth > 0);
    s->depth--;
    if (!s->first) indent(s);
    fputc(s->closing[s->depth], s->file);
    s->first = false;
}

bough_status bough_summary_close(bough_summary *s) {
    while (s->depth > 0) bough_summary_end(s);
    fputc('\n', s->file);
    FILE *file = s->file;
    s->file = NULL;
    return bough_folder_close(s->path, file, bough_ok());
}
