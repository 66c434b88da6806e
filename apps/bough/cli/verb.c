#include "apps/bough/cli/verb.h"

#include "apps/bough/config/schema.h"

#include <string.h>

enum { MAX_WORDS = 32 };

const bough_verb *bough_verb_find(const char *name) {
    for (const bough_verb *verb = bough_verbs; verb->name; verb++) {
        if (strcmp(verb->name, name) == 0) return verb;
    }
    return NULL;
}

bough_status bough_verb_unknown(const char *what, const char *word, const char *const *more) {
    const char *known[MAX_WORDS];
    char list[160] = "";
    int n = 0;
    for (const bough_verb *v = bough_verbs; v->name && n < MAX_WORDS; v++) known[n++] = v->name;
    for (; more && *more && n < MAX_WORDS; more++) known[n++] = *more;
    for (int i = 0; i < n; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i == 0 ? "" : ", ", known[i]);
    }
    return bough_fail(BOUGH_INVALID, "unknown %s '%.80s'%s; known: %s", what, word,
                      bough_suggest(word, known, n).text, list);
}
