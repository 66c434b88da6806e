// Words in messages: what a value looks like, and which known word a misspelt one is near to.
#include "apps/bough/config/schema.h"

#include <string.h>

const char *bough_node_shown(const bough_node *node, char buffer[64]) {
    if (node->kind == BOUGH_MAPPING) return node->n > 0 ? "a mapping" : "an empty mapping";
    if (node->kind == BOUGH_SEQUENCE) return node->n > 0 ? "a list" : "an empty list";
    if (node->text[0] == '\0') return node->quoted ? "''" : "nothing";
    size_t length = strlen(node->text);
    if (length <= 48) {
        snprintf(buffer, 64, "'%s'", node->text);
        return buffer;
    }
    length = 45;
    while (((unsigned char)node->text[length] & 0xC0) == 0x80) length--; // not inside a character
    snprintf(buffer, 64, "'%.*s...'", (int)length, node->text);
    return buffer;
}

enum { WORD = 40 };

// Edit distance of two words shorter than WORD, an exchange of neighbours counting as one edit.
static int edit_distance(const char *a, const char *b) {
    int n = (int)strlen(a), m = (int)strlen(b), d[WORD + 1][WORD + 1];
    for (int i = 0; i <= n; i++) d[i][0] = i;
    for (int j = 0; j <= m; j++) d[0][j] = j;
    for (int i = 1; i <= n; i++) {
        for (int j = 1; j <= m; j++) {
            int best = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
            if (d[i - 1][j] + 1 < best) best = d[i - 1][j] + 1;
            if (d[i][j - 1] + 1 < best) best = d[i][j - 1] + 1;
            bool swap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swap && d[i - 2][j - 2] + 1 < best) best = d[i - 2][j - 2] + 1;
            d[i][j] = best;
        }
    }
    return d[n][m];
}

// Whether the word is one of those that hyphens join in the candidate: cvode of cvode-bdf.
static bool is_part(const char *word, const char *candidate) {
    size_t length = strlen(word);
    for (const char *c = candidate; length > 0 && c != NULL; c = strchr(c, '-')) {
        if (*c == '-') c++;
        if (strncmp(c, word, length) == 0 && (c[length] == '-' || c[length] == '\0')) return true;
    }
    return false;
}

static int same_beginning(const char *a, const char *b) {
    int n = 0;
    while (a[n] != '\0' && a[n] == b[n]) n++;
    return n;
}

// Of equally near words the one that begins alike: slips are rare at the beginning.
const char *bough_nearest(const char *word, const char *const *candidates, int n) {
    size_t length = strlen(word);
    if (length >= WORD) return NULL;
    int best = length < 4 ? 2 : length < 8 ? 3 : 4; // one more than what counts as near
    const char *nearest = NULL;
    for (int i = 0; i < n; i++) {
        if (candidates[i] == NULL || strlen(candidates[i]) >= WORD) continue;
        int distance = is_part(word, candidates[i]) ? 1 : edit_distance(word, candidates[i]);
        bool alike = nearest != NULL && distance == best &&
                     same_beginning(word, candidates[i]) > same_beginning(word, nearest);
        if (distance < best || alike) {
            best = distance;
            nearest = candidates[i];
        }
    }
    return nearest;
}

bough_suggestion bough_suggest(const char *word, const char *const *candidates, int n) {
    bough_suggestion s = {""};
    const char *near = bough_nearest(word, candidates, n);
    if (near) snprintf(s.text, sizeof s.text, " (did you mean '%s'?)", near);
    return s;
}
