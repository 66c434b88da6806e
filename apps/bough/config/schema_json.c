// A schema as JSON Schema (draft 2020-12), for the completion and checks of editors. Values of a kind
// of their own are not described further; what depends on another key's choice is only allowed.
#include "apps/bough/config/schema_internal.h"

#include <string.h>

// A number, or one with its unit.
static const char quantity[] = "\"type\": [\"number\", \"string\"]";

static void put_choices(const bough_key *key, FILE *stream) {
    const char *choice;
    fputs("\"enum\": [", stream);
    for (int i = 0; (choice = bough_key_choice(key, i)) != NULL; i++) {
        if (i > 0) fputs(", ", stream);
        bough_text_quoted(stream, choice);
    }
    fputc(']', stream);
}

static void put_list(const bough_key *key, FILE *stream) {
    fputs("\"anyOf\": [{\"type\": \"array\", \"items\": ", stream);
    bough_schema_json_object(key->of, stream);
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
    bough_text_quoted(stream, text);
}

static void put_key(const bough_key *key, FILE *stream) {
    if (key->kind == BOUGH_KEY_MAPPING) {
        bough_schema_json_object(key->of, stream);
        return;
    }
    fputc('{', stream);
    put_description(key, stream);
    if (key->kind != BOUGH_KEY_CUSTOM) fputs(", ", stream);
    put_value(key, stream);
    fputc('}', stream);
}

static bool comes_again(const bough_schema *schema, int i, int step) {
    for (int k = i + step; k >= 0 && k < schema->n_key; k += step) {
        if (strcmp(schema->key[k].name, schema->key[i].name) == 0) return true;
    }
    return false;
}

// A key that takes another form with another choice of a key before it stands once, with all forms.
static void put_property(const bough_schema *schema, int first, FILE *stream) {
    bough_text_quoted(stream, schema->key[first].name);
    fputs(": ", stream);
    if (!comes_again(schema, first, 1)) {
        put_key(&schema->key[first], stream);
        return;
    }
    fputs("{\"anyOf\": [", stream);
    for (int i = first; i < schema->n_key; i++) {
        if (strcmp(schema->key[i].name, schema->key[first].name) != 0) continue;
        if (i > first) fputs(", ", stream);
        put_key(&schema->key[i], stream);
    }
    fputs("]}", stream);
}

void bough_schema_json_object(const bough_schema *schema, FILE *stream) {
    fputs("{\"type\": \"object\", \"title\": ", stream);
    bough_text_quoted(stream, schema->name);
    fputs(", \"additionalProperties\": false, \"properties\": {\n", stream);
    for (int i = 0, n = 0; i < schema->n_key; i++) {
        if (comes_again(schema, i, -1)) continue;
        if (n++ > 0) fputs(",\n", stream);
        put_property(schema, i, stream);
    }
    fputs("}, \"required\": [", stream);
    for (int i = 0, n = 0; i < schema->n_key; i++) {
        if (!schema->key[i].required || schema->key[i].when || comes_again(schema, i, -1)) continue;
        if (n++ > 0) fputs(", ", stream);
        bough_text_quoted(stream, schema->key[i].name);
    }
    fputs("]}", stream);
}

void bough_schema_json(const char *title, const bough_schema *const *schema, int n, FILE *stream) {
    fputs("{\"$schema\": \"https://json-schema.org/draft/2020-12/schema\", \"title\": ", stream);
    bough_text_quoted(stream, title);
    fputs(", \"anyOf\": [\n", stream);
    for (int i = 0; i < n; i++) {
        if (i > 0) fputs(",\n", stream);
        bough_schema_json_object(schema[i], stream);
    }
    fputs("\n]}\n", stream);
}
