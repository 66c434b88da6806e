// Reading one value by its key: numbers, texts, choices, lists of them. Errors name the path.
#include "apps/bough/config/schema.h"

enum { MAX_ITEMS = 10000 }; // of a list: names are looked up one by one
enum { MAX_CHOICES = 32 };  // of a key

// -- errors ---------------------------------------------------------------------------------------

size_t bough_schema_push(bough_schema_reader *r, const char *format, ...) {
    size_t length = strlen(r->path);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(r->path + length, sizeof r->path - length, format, arguments);
    va_end(arguments);
    return length;
}

size_t bough_schema_push_key(bough_schema_reader *r, const char *name) {
    return bough_schema_push(r, r->path[0] == '\0' ? "%s" : ".%s", name);
}

void bough_schema_pop(bough_schema_reader *r, size_t length) { r->path[length] = '\0'; }

void bough_schema_error(bough_schema_reader *reader, const bough_node *node, const char *key,
                        const char *format, ...) {
    char text[400];
    BOUGH_PRINT(text, format);
    size_t length = key[0] == '\0' ? strlen(reader->path) : bough_schema_push_key(reader, key);
    bough_node_below(node, key, &node);
    bough_errors_add(reader->errors, node, reader->path, "%s", text);
    bough_schema_pop(reader, length);
}

void bough_schema_expected(bough_schema_reader *r, const bough_node *node, const char *what) {
    char shown[64];
    bough_schema_error(r, node, "", "expected %s, got %s", what, bough_node_shown(node, shown));
}

void bough_schema_not_more(bough_schema_reader *r, const char *key, const bough_node *before,
                           const bough_node *node) {
    char shown[2][64];
    r->out_of_order++;
    bough_schema_error(r, node, key, "must be more than %s before it, got %s",
                       bough_node_shown(before, shown[0]), bough_node_shown(node, shown[1]));
}

// -- numbers --------------------------------------------------------------------------------------

static bool is_word(const bough_node *node, const char *word) {
    return node->kind == BOUGH_SCALAR && strcmp(node->text, word) == 0;
}

// The column's unit holds for a plain number; a number with its own unit fails with it appended.
static bool quantity(const bough_schema_reader *r, const char *text, bough_dimension dimension, double *value,
                     char why[160]) {
    double plain;
    char ignored[160], joined[96];
    if (r->unit == NULL || !bough_quantity(text, BOUGH_PURE_NUMBER, &plain, ignored)) {
        return bough_quantity(text, dimension, value, why);
    }
    snprintf(joined, sizeof joined, "%s %s", text, r->unit);
    return bough_quantity(joined, dimension, value, why);
}

double bough_schema_number(bough_schema_reader *reader, const bough_node *node, bough_dimension dimension) {
    double value;
    char why[160] = "", what[96], shown[64];
    if (node->kind == BOUGH_SCALAR && quantity(reader, node->text, dimension, &value, why)) {
        return value;
    }
    bough_dimension_expected(dimension, what);
    bough_schema_error(reader, node, "", "expected %s, got %s%s%s", what, bough_node_shown(node, shown),
                       why[0] == '\0' ? "" : ": ", why);
    return NAN;
}

int bough_schema_numbers(bough_schema_reader *reader, const bough_node *node, int few, int many,
                         double *values, const char *what) {
    char shown[64];
    if (node->kind != BOUGH_SEQUENCE) {
        bough_schema_expected(reader, node, what);
        return -1;
    }
    if (node->n != few && node->n != many) {
        bough_schema_error(reader, node, "", "expected %s, got %d items", what, node->n);
        return -1;
    }
    char why[160];
    int n = node->n;
    for (int i = 0; i < node->n; i++) {
        const bough_node *item = node->value[i];
        if (item->kind == BOUGH_SCALAR && bough_quantity(item->text, BOUGH_PURE_NUMBER, &values[i], why)) {
            continue;
        }
        size_t length = bough_schema_push(reader, "[%d]", i);
        bough_schema_error(reader, item, "", "expected a plain number in SI units, got %s",
                           bough_node_shown(item, shown));
        bough_schema_pop(reader, length);
        n = -1;
    }
    return n;
}

// Ranges are those of the tables of keys, which are not checked.
bool bough_in_range(double value, const char *range) {
    if (range == NULL) return true;
    if (range[0] == '[' || range[0] == '(') {
        char *end;
        double low = strtod(range + 1, &end);
        return (value > low || (value == low && range[0] == '[')) && value <= strtod(end + 1, NULL);
    }
    if (range[1] == '=') return value >= strtod(range + 2, NULL);
    return value > strtod(range + 1, NULL);
}

static bool check_range(bough_schema_reader *r, const bough_key *key, const bough_node *node, double value) {
    if (isnan(value) || bough_in_range(value, key->range)) return true;
    char shown[64];
    const char *unit = bough_dimension_unit(key->dimension);
    bough_schema_error(r, node, "", "must be %s%s%s%s, got %s", strchr("[(", key->range[0]) ? "in " : "",
                       key->range, unit[0] == '\0' ? "" : " ", unit, bough_node_shown(node, shown));
    return false;
}

static void read_number(bough_schema_reader *r, const bough_key *key, const bough_node *node, double *field) {
    if (key->word != NULL && is_word(node, key->word)) {
        *field = 0;
        return;
    }
    double value = bough_schema_number(r, node, key->dimension);
    *field = check_range(r, key, node, value) ? value : (double)NAN;
}

static void read_integer(bough_schema_reader *r, const bough_key *key, const bough_node *node, int *field) {
    const char *text = node->kind == BOUGH_SCALAR ? node->text : "";
    double value = strtod(text, NULL);
    char shown[64];
    if (bough_whole_number(text, field)) {
        check_range(r, key, node, *field);
    } else if (strspn(text, "-0123456789") < strlen(text) || !(fabs(value) > BOUGH_MOST_WHOLE)) {
        bough_schema_expected(r, node, "a whole number");
    } else if (check_range(r, key, node, value)) {
        bough_schema_error(r, node, "", "must be in [%d, %d], got %s", -BOUGH_MOST_WHOLE, BOUGH_MOST_WHOLE,
                           bough_node_shown(node, shown));
    }
}

// -- texts ----------------------------------------------------------------------------------------

static void read_text(bough_schema_reader *r, const bough_node *node, const char **field) {
    if (node->kind != BOUGH_SCALAR || node->text[0] == '\0') {
        bough_schema_expected(r, node, "text");
        *field = NULL;
    } else {
        *field = node->text;
    }
}

const char *bough_key_choice(const bough_key *key, int index) {
    if (key->kind != BOUGH_KEY_CHOICE) return NULL;
    return key->choice != NULL ? key->choice(index) : key->choices[index];
}

static void read_choice(bough_schema_reader *r, const bough_key *key, const bough_node *node, int *field) {
    char list[200] = "", shown[64];
    const char *choices[MAX_CHOICES];
    int n = 0;
    for (; n < MAX_CHOICES && (choices[n] = bough_key_choice(key, n)) != NULL; n++) {
        if (is_word(node, choices[n])) {
            *field = n;
            return;
        }
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", n == 0 ? "" : ", ", choices[n]);
    }
    *field = -1;
    const char *word = node->kind == BOUGH_SCALAR ? node->text : "";
    bough_schema_error(r, node, "", "expected %s%s, got %s%s", n > 1 ? "one of " : "", list,
                       bough_node_shown(node, shown), bough_suggest(word, choices, n).text);
}

static void read_boolean(bough_schema_reader *r, const bough_node *node, bool *field) {
    *field = !node->quoted && is_word(node, "true");
    if (*field || (!node->quoted && is_word(node, "false"))) return;
    bough_schema_expected(r, node, "true or false");
}

void *bough_schema_items(bough_schema_reader *r, const bough_key *key, const bough_node *node, size_t size,
                         void *item) {
    if (node->kind != BOUGH_SEQUENCE) {
        bool mappings = key->kind == BOUGH_KEY_LIST;
        bough_schema_expected(r, node, mappings ? "a list of mappings" : "a list");
        return NULL;
    }
    if (node->n < key->count) {
        bough_schema_error(r, node, "", "expected at least %d item%s, got %d", key->count,
                           key->count == 1 ? "" : "s", node->n);
        return NULL;
    }
    if (node->n > MAX_ITEMS) {
        bough_schema_error(r, node, "", "expected at most %d items, got %d", MAX_ITEMS, node->n);
        return NULL;
    }
    *(int *)bough_field_at(item, key->count_offset) = node->n;
    return *(void **)bough_field_at(item, key->offset) = bough_arena_take(r->arena, (size_t)node->n * size);
}

static void read_texts(bough_schema_reader *r, const bough_key *key, const bough_node *node, void *item) {
    const char **texts = bough_schema_items(r, key, node, sizeof *texts, item);
    for (int i = 0; texts != NULL && i < node->n; i++) {
        size_t length = bough_schema_push(r, "[%d]", i);
        read_text(r, node->value[i], &texts[i]);
        bough_schema_pop(r, length);
    }
}

// -- lists of numbers -----------------------------------------------------------------------------

static void read_components(bough_schema_reader *r, const bough_key *key, const bough_node *node,
                            double *values) {
    for (int i = 0; i < node->n; i++) {
        size_t length = bough_schema_push(r, "[%d]", i);
        read_number(r, key, node->value[i], &values[i]);
        if (key->increasing && i > 0 && values[i] <= values[i - 1])
            bough_schema_not_more(r, "", node->value[i - 1], node->value[i]);
        bough_schema_pop(r, length);
    }
}

static void read_vector(bough_schema_reader *r, const bough_key *key, const bough_node *node,
                        double *values) {
    char what[40];
    snprintf(what, sizeof what, "a list of %d numbers", key->count);
    if (node->kind != BOUGH_SEQUENCE) {
        bough_schema_expected(r, node, what);
    } else if (node->n != key->count) {
        bough_schema_error(r, node, "", "expected %s, got %d", what, node->n);
    } else {
        read_components(r, key, node, values);
        return;
    }
    for (int i = 0; i < key->count; i++) values[i] = NAN;
}

static void read_numbers(bough_schema_reader *r, const bough_key *key, const bough_node *node, void *item) {
    double *values = bough_schema_items(r, key, node, sizeof *values, item);
    if (values != NULL) read_components(r, key, node, values);
}

// -- any of them ----------------------------------------------------------------------------------

void bough_schema_value(bough_schema_reader *r, const bough_key *key, const bough_node *node, void *item) {
    void *field = bough_field_at(item, key->offset);
    switch (key->kind) {
    case BOUGH_KEY_NUMBER: read_number(r, key, node, field); break;
    case BOUGH_KEY_INTEGER: read_integer(r, key, node, field); break;
    case BOUGH_KEY_TEXT: read_text(r, node, field); break;
    case BOUGH_KEY_CHOICE: read_choice(r, key, node, field); break;
    case BOUGH_KEY_BOOLEAN: read_boolean(r, node, field); break;
    case BOUGH_KEY_VECTOR: read_vector(r, key, node, field); break;
    case BOUGH_KEY_NUMBERS: read_numbers(r, key, node, item); break;
    case BOUGH_KEY_TEXTS: read_texts(r, key, node, item); break;
    default: assert(false);
    }
}

// -- words: suggestions for misspelt ones ---------------------------------------------------------

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

bool bough_word_is_among(const char *word, const char *list, char separator) {
    size_t length = strlen(word);
    for (const char *c = list; length > 0 && c != NULL; c = strchr(c, separator)) {
        if (*c == separator) c++;
        if (strncmp(c, word, length) == 0 && (c[length] == separator || c[length] == '\0')) return true;
    }
    return false;
}

static int same_beginning(const char *a, const char *b) {
    int n = 0;
    while (a[n] != '\0' && a[n] == b[n]) n++;
    return n;
}

// Among equally near words, the one with the longest common beginning: typing errors are rare there.
const char *bough_nearest(const char *word, const char *const *candidates, int n) {
    size_t length = strlen(word);
    if (length >= WORD) return NULL;
    int best = length < 4 ? 2 : length < 8 ? 3 : 4; // one more than what counts as near
    const char *nearest = NULL;
    for (int i = 0; i < n; i++) {
        if (candidates[i] == NULL || strlen(candidates[i]) >= WORD) continue;
        int distance = bough_word_is_among(word, candidates[i], '-') ? 1 : edit_distance(word, candidates[i]);
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
