// The help text of a schema: nested lists of keys, which are Markdown as they stand.
#include "apps/bough/config/schema.h"

#include "core/base/quote.h"

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

// -- JSON Schema ----------------------------------------------------------------------------------

// A schema as JSON Schema (draft 2020-12), for the completion and checks of editors. Custom
// values are not described further; a key that depends on another key's choice is allowed with any.

// A number, or one with its unit.
static const char quantity[] = "\"type\": [\"number\", \"string\"]";

static void put_choices(const bough_key *key, FILE *stream) {
    const char *choice;
    fputs("\"enum\": [", stream);
    for (int i = 0; (choice = bough_key_choice(key, i)) != NULL; i++) {
        if (i > 0) fputs(", ", stream);
        bough_quote(stream, choice);
    }
    fputc(']', stream);
}

static void put_object(const bough_schema *schema, FILE *stream);

static void put_list(const bough_key *key, FILE *stream) {
    fputs("\"anyOf\": [{\"type\": \"array\", \"items\": ", stream);
    put_object(key->of, stream);
    fprintf(stream, ", \"minItems\": %d}, ", key->count);
    fputs("{\"type\": \"object\", \"properties\": {\"columns\": {\"type\": \"array\", \"items\": "
          "{\"type\": \"string\"}}, \"rows\": {\"type\": \"array\", \"items\": {\"type\": "
          "\"array\"}}}, \"required\": [\"columns\", \"rows\"], \"additionalProperties\": false}]",
          stream);
}

static void put_value(const bough_key *key, FILE *stream) {
    switch (key->kind) {
    case BOUGH_KEY_NUMBER: fputs(quantity, stream); break;
    case BOUGH_KEY_INTEGER: fputs("\"type\": \"integer\"", stream); break;
    case BOUGH_KEY_FILE:
    case BOUGH_KEY_TEXT: fputs(quantity, stream); break;
    case BOUGH_KEY_CHOICE: put_choices(key, stream); break;
    case BOUGH_KEY_BOOLEAN: fputs("\"type\": \"boolean\"", stream); break;
    case BOUGH_KEY_VECTOR:
        fprintf(stream, "\"type\": \"array\", \"items\": {%s}, \"minItems\": %d, \"maxItems\": %d", quantity,
                key->count, key->count);
        break;
    case BOUGH_KEY_NUMBERS:
    case BOUGH_KEY_TEXTS:
        fprintf(stream, "\"type\": \"array\", \"items\": {%s}, \"minItems\": %d", quantity, key->count);
        break;
    case BOUGH_KEY_LIST: put_list(key, stream); break;
    case BOUGH_KEY_MAPPING: // written by put_key
    case BOUGH_KEY_CUSTOM: break;
    }
}

// A key's description: what it is, in which form.
static void put_description(const bough_key *key, FILE *stream) {
    char text[900];
    const char *unit = bough_dimension_unit(key->dimension), *example = bough_key_example(key);
    snprintf(text, sizeof text, "%s%s%s%s%s%s%s%s%s", key->help, key->form ? "; " : "",
             key->form ? key->form : "", unit[0] ? "; in " : "", unit, key->fallback ? "; default " : "",
             key->fallback ? key->fallback : "", example[0] ? "; e.g. " : "", example);
    fputs("\"description\": ", stream);
    bough_quote(stream, text);
}

static void put_key(const bough_key *key, FILE *stream) {
    if (key->of != NULL && (key->kind == BOUGH_KEY_MAPPING || key->kind == BOUGH_KEY_CUSTOM)) {
        put_object(key->of, stream);
        return;
    }
    fputc('{', stream);
    put_description(key, stream);
    if (key->kind != BOUGH_KEY_CUSTOM) fputs(", ", stream);
    put_value(key, stream);
    fputc('}', stream);
}

static bool is_first(const bough_schema *schema, int i) {
    return bough_schema_find(schema, schema->key[i].name) == &schema->key[i];
}

// A key that takes another form with another choice of a key before it stands once, with all forms.
static void put_property(const bough_schema *schema, int first, FILE *stream) {
    int n = 0;
    for (int i = first; i < schema->n_key; i++)
        n += strcmp(schema->key[i].name, schema->key[first].name) == 0;
    bough_quote(stream, schema->key[first].name);
    fputs(n > 1 ? ": {\"anyOf\": [" : ": ", stream);
    for (int i = first; i < schema->n_key; i++) {
        if (strcmp(schema->key[i].name, schema->key[first].name) != 0) continue;
        if (i > first) fputs(", ", stream);
        put_key(&schema->key[i], stream);
    }
    if (n > 1) fputs("]}", stream);
}

static void put_object(const bough_schema *schema, FILE *stream) {
    fputs("{\"type\": \"object\", \"title\": ", stream);
    bough_quote(stream, schema->name);
    fputs(", \"additionalProperties\": false, \"properties\": {\n", stream);
    for (int i = 0, n = 0; i < schema->n_key; i++) {
        if (!is_first(schema, i)) continue;
        if (n++ > 0) fputs(",\n", stream);
        put_property(schema, i, stream);
    }
    fputs("}, \"required\": [", stream);
    for (int i = 0, n = 0; i < schema->n_key; i++) {
        if (!schema->key[i].required || schema->key[i].when || !is_first(schema, i)) continue;
        if (n++ > 0) fputs(", ", stream);
        bough_quote(stream, schema->key[i].name);
    }
    fputs("]}", stream);
}

// A file that builds on a base may have any of the keys, with any values below them.
static void put_on_base(const bough_schema *schema, FILE *stream) {
    fputs(",\n{\"type\": \"object\", \"additionalProperties\": false, \"properties\": {", stream);
    for (int i = 0; i < schema->n_key; i++) {
        if (i > 0) fputs(", ", stream);
        bough_quote(stream, schema->key[i].name);
        fputs(strcmp(schema->key[i].name, "base") == 0 ? ": {\"type\": \"string\"}" : ": {}", stream);
    }
    fputs("}, \"required\": [\"base\"]}", stream);
}

void bough_schema_json(const char *title, const bough_schema *const *schema, int n, FILE *stream) {
    fputs("{\"$schema\": \"https://json-schema.org/draft/2020-12/schema\", \"title\": ", stream);
    bough_quote(stream, title);
    fputs(", \"anyOf\": [\n", stream);
    for (int i = 0; i < n; i++) {
        if (i > 0) fputs(",\n", stream);
        put_object(schema[i], stream);
        if (bough_schema_find(schema[i], "base") != NULL) put_on_base(schema[i], stream);
    }
    fputs("\n]}\n", stream);
}
