// The help text of a schema: nested lists of keys, which are Markdown as they stand.
#include "apps/bough/config/schema_internal.h"

#include <string.h>

static const char *const kind_names[] = {
    [BOUGH_KEY_NUMBER] = "number",
    [BOUGH_KEY_INTEGER] = "whole number",
    [BOUGH_KEY_TEXT] = "text",
    [BOUGH_KEY_CHOICE] = "choice",
    [BOUGH_KEY_BOOLEAN] = "true|false",
    [BOUGH_KEY_VECTOR] = "numbers",
    [BOUGH_KEY_NUMBERS] = "list of numbers",
    [BOUGH_KEY_TEXTS] = "list of texts",
    [BOUGH_KEY_MAPPING] = "mapping",
    [BOUGH_KEY_LIST] = "list of mappings",
    [BOUGH_KEY_FILE] = "file",
    [BOUGH_KEY_CUSTOM] = "",
};

static void append(char *line, size_t size, const char *a, const char *b) {
    size_t used = strlen(line);
    snprintf(line + used, size - used, "%s%s", a, b);
}

// "number [m], > 0", "choice fixed|revolute", …
static void describe_kind(const bough_key *key, char *line, size_t size) {
    if (key->form != NULL) {
        append(line, size, key->form, "");
    } else if (key->kind == BOUGH_KEY_CHOICE) {
        const char *choice;
        for (int i = 0; (choice = bough_key_choice(key, i)) != NULL; i++) {
            append(line, size, i == 0 ? "" : "|", choice);
        }
    } else if (key->kind == BOUGH_KEY_VECTOR) {
        snprintf(line, size, "%d numbers", key->count);
    } else {
        append(line, size, kind_names[key->kind], "");
    }
    const char *unit = bough_dimension_unit(key->dimension);
    if (unit[0] != '\0') append(line, size, " in ", unit);
    if (key->word != NULL) append(line, size, " or ", key->word);
    if (key->range != NULL) append(line, size, ", ", key->range);
}

const char *bough_key_example(const bough_key *key) {
    bool no = key->fallback != NULL && strcmp(key->fallback, "true") == 0;
    if (key->example != NULL) return key->example;
    if (key->kind == BOUGH_KEY_BOOLEAN) return no ? "false" : "true";
    if (key->kind != BOUGH_KEY_CHOICE) return "";
    const char *first = bough_key_choice(key, 0);
    bool is_default = key->fallback != NULL && strcmp(key->fallback, first) == 0;
    return is_default ? bough_key_choice(key, 1) : first;
}

static void describe_need(const bough_key *key, char *line, size_t size) {
    if (key->required) append(line, size, "; required", "");
    if (key->fallback != NULL) append(line, size, "; default ", key->fallback);
    if (key->when != NULL) {
        append(line, size, "; with ", key->when_key);
        append(line, size, ": ", key->when);
    }
    if (bough_key_example(key)[0] != '\0') append(line, size, "; e.g. ", bough_key_example(key));
}

void bough_schema_help(const bough_schema *schema, int indent, FILE *stream) {
    for (int i = 0; i < schema->n_key; i++) {
        const bough_key *key = &schema->key[i];
        char line[600] = "";
        describe_kind(key, line, sizeof line);
        describe_need(key, line, sizeof line);
        fprintf(stream, "%*s- %s: (%s)\n", indent, "", key->name, line);
        fprintf(stream, "%*s%s\n", indent + 2, "", key->help);
        if (key->of != NULL) bough_schema_help(key->of, indent + 2, stream);
    }
}
