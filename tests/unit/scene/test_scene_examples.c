// Every key of a scene has an example, which the key reads.
#include "tests/unit/check.h"

#include "apps/bough/scene/scene_internal.h"

static int n_example;

// Reads "name: example", after the choice on which the key depends, and no other key.
static void check_example(const bough_schema *schema, const bough_key *key) {
    const char *example = bough_key_example(key);
    bough_key pair[2];
    char choice[60] = "";
    int n = 0;
    for (int i = 0; key->when && n == 0; i++) {
        if (strcmp(schema->key[i].name, key->when_key) != 0) continue;
        int first = (int)strcspn(key->when, "|");
        snprintf(choice, sizeof choice, "%s: %.*s\n", key->when_key, first, key->when);
        pair[n++] = schema->key[i];
    }
    pair[n++] = *key;
    bough_schema few = {.name = schema->name, .size = schema->size, .n_key = n, .key = pair};
    bough_arena *arena = bough_arena_create();
    bough_errors errors = {.arena = arena};
    bough_schema_reader reader = {
        .arena = arena, .errors = &errors, .directory = BOUGH_SOURCE_DIR "/apps/turbine/"};
    char text[300];
    int length = snprintf(text, sizeof text, "%s%s: %s\n", choice, key->name, example);
    bough_node *root = bough_text_parse(arena, schema->name, text, (size_t)length, &errors);
    if (root) bough_schema_read(&reader, &few, root, bough_arena_take(arena, schema->size));
    bool different = !key->fallback || strcmp(example, key->fallback) != 0;
    if (errors.n > 0 || example[0] == '\0' || !different) {
        print_error("%s, %s: '%s'\n", schema->name, key->name, example);
    }
    bough_errors_print(&errors, stderr);
    assert_int_equal(errors.n, 0);
    assert_true(example[0] != '\0' && different);
    bough_arena_destroy(arena);
    n_example++;
}

static void check_schema(const bough_schema *schema) {
    for (int i = 0; i < schema->n_key; i++) {
        const bough_key *key = &schema->key[i];
        bool parts_only = key->kind == BOUGH_KEY_MAPPING || key->kind == BOUGH_KEY_LIST;
        if (!parts_only) check_example(schema, key);
        if (key->of) check_schema(key->of);
    }
}

TEST(every_key_reads_its_example) {
    check_schema(&bough_scene_schema);
    assert_true(n_example > 150);
}
