#include "apps/bough/config/text.h"

#include "tests/unit/check.h"
#include "tests/unit/printed.h"
#include "tests/unit/scratch_name.h"

#include <time.h>

typedef struct fixture {
    bough_arena *arena;
    bough_errors errors;
} fixture;

static fixture start(void) {
    fixture f = {.arena = check_memory()};
    f.errors.arena = f.arena;
    return f;
}

// Parsing the bytes must fail with exactly these lines.
static void refuses_bytes(const char *text, size_t size, const char *lines) {
    fixture f = start();
    assert_null(bough_text_parse(f.arena, "f", text, size, &f.errors));
    assert_string_equal(printed_errors(&f.errors), lines);
}

static void refuses(const char *text, const char *lines) { refuses_bytes(text, strlen(text), lines); }

static double seconds_since(clock_t begin) { return (double)(clock() - begin) / CLOCKS_PER_SEC; }

TEST(nodes_know_their_place) {
    fixture f = start();
    const char *text = "\xEF\xBB\xBF# comment\na: 1\nb:\n  - x y\n  - {c: 'q'}\n";
    bough_node *root = bough_text_parse(f.arena, "f", text, strlen(text), &f.errors);
    assert_non_null(root);
    assert_int_equal(root->kind, BOUGH_MAPPING);
    assert_int_equal(root->n, 2);
    assert_string_equal(bough_node_find(root, "a")->text, "1");
    const bough_node *list = bough_node_find(root, "b");
    assert_int_equal(list->kind, BOUGH_SEQUENCE);
    assert_int_equal(list->n, 2);
    assert_string_equal(list->value[0]->text, "x y");
    assert_false(list->value[0]->quoted);
    assert_int_equal(list->value[0]->line, 4);
    assert_int_equal(list->value[0]->column, 5);
    const bough_node *c = bough_node_find(list->value[1], "c");
    assert_true(c->quoted);
    assert_int_equal(c->line, 5);
    assert_int_equal(c->column, 9);
    assert_string_equal(c->file, "f");
    assert_null(bough_node_find(root, "z"));
    assert_null(bough_node_find(NULL, "z"));
    assert_null(bough_node_find(list, "z"));
}

TEST(aliases_share_nodes) {
    fixture f = start();
    const char *text = "a: &x [1, 2]\nb: *x\nc: &x 3\nd: *x\n";
    bough_node *root = bough_text_parse(f.arena, "f", text, strlen(text), &f.errors);
    assert_non_null(root);
    assert_ptr_equal(bough_node_find(root, "a"), bough_node_find(root, "b"));
    assert_string_equal(bough_node_find(root, "d")->text, "3"); // the newest anchor counts
    assert_int_equal(root->weight, 1 + 3 + 3 + 1 + 1);
}

TEST(syntax_errors_are_readable) {
    refuses("a:\n\tb: 1\n", "f:2:1: error: unexpected character here (tabs cannot indent; quote "
                            "text that starts with @, `, % or a bracket)\n");
    refuses("a: b: c\n", "f:1:5: error: unexpected ':' (two keys on one line, or a line that is "
                         "indented too far)\n");
    refuses("a: [1, 2\nb: 3\n", "f:2:2: error: expected ',' or ']' to end the list\n");
    refuses("a: {b: 1\nc: 3\n", "f:2:2: error: expected ',' or '}' to end the mapping\n");
    refuses("b: 1\na: 'x\nc: 2\n", "f:2:4: error: the text that this quote opens has no end\n");
    refuses("a: \"x\nb: \"y\"\n",
            "f:1:4: error: the text that this quote opens ends some lines below: is a quote missing?\n"
            "f:2:5: error: expected 'key: value' here (check the indentation)\n");
    refuses("a: &x {b: 1}\nc:\n  <<: *x\n",
            "f:3:3: error: merge keys (<<) are not read; 'base: FILE' takes the keys of another scene\n");
    refuses("a:\n  - 1\n  b: 2\n", "f:3:3: error: expected '- ' here (check the indentation of the list)\n");
    refuses("a: 1\n  b\n c: 2\n", "f:3:3: error: unexpected ':' (two keys on one line, or a line "
                                  "that is indented too far)\n");
}

TEST(structure_errors_are_refused) {
    refuses("", "f:1:1: error: the file is empty\n");
    refuses("# only a comment\n", "f:1:1: error: the file is empty\n");
    refuses("a: 1\nb: 2\na: 3\nb: 4\na: 5\n", "f:3:1: error: key 'a' is given twice (first in line 1)\n"
                                              "f:5:1: error: key 'a' is given twice (first in line 3)\n"
                                              "f:4:1: error: key 'b' is given twice (first in line 2)\n");
    refuses("a: 1\n---\nb: 2\n", "f:2:1: error: a file holds one document only\n");
    refuses("[a]: 1\n", "f:1:1: error: a key must be plain text, not a list or a mapping\n");
    refuses("x: &k [a]\n*k : 1\n", "f:2:1: error: a key must be plain text, not a list or a mapping\n");
    refuses("a: !!int 3\n", "f:1:4: error: tags (!...) are not used here\n");
    refuses("a: !x [3]\n", "f:1:4: error: tags (!...) are not used here\n");
    refuses("a: *b\n", "f:1:4: error: this alias has no anchor before it\n");
    refuses("a: &b [1, *b]\n", "f:1:11: error: this alias contains itself\n");
}

TEST(other_encodings_are_refused) {
    refuses("ab: \xFF\n", "f:1:5: error: this is not UTF-8 text\n");
    refuses("a: 1\nb: \xC3(\n", "f:2:5: error: this is not UTF-8 text\n");
    refuses_bytes("\xFF\xFE"
                  "a\0:\0",
                  6, "f:1:1: error: this is not UTF-8 text\n");
    refuses_bytes("a: x\0y\n", 7, "f:1:5: error: a control character is not allowed\n");
    refuses("a: \"x\\0y\"\n", "f:1:4: error: a control character is not allowed\n");
    refuses("a: \x1b[31m\n", "f:1:4: error: a control character is not allowed\n");
}

TEST(depth_is_limited) {
    char text[140];
    memset(text, '[', 64);
    memset(text + 64, ']', 64);
    fixture f = start();
    assert_non_null(bough_text_parse(f.arena, "f", text, 128, &f.errors));
    memset(text, '[', 65);
    refuses_bytes(text, 65, "f:1:65: error: nesting is deeper than 64 levels\n");
}

TEST(deep_files_end_fast) {
    enum { N = 100000 };
    char *text = malloc(2 * N + 1);
    const char *const openings[] = {"[", "{", "- ", "? "};
    for (int k = 0; k < 4; k++) {
        size_t width = strlen(openings[k]);
        for (int i = 0; i < N; i++) memcpy(text + width * (size_t)i, openings[k], width);
        clock_t begin = clock();
        fixture f = start();
        assert_null(bough_text_parse(f.arena, "f", text, width * N, &f.errors));
        assert_int_equal(f.errors.n, 1);
        assert_true(seconds_since(begin) < 2);
    }
    free(text);
}

TEST(alias_bombs_end_fast) {
    char text[2000] = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
    for (int i = 1; i < 10; i++) {
        char line[160];
        snprintf(line, sizeof line, "a%d: &a%d [", i, i);
        for (int k = 0; k < 10; k++) {
            snprintf(line + strlen(line), sizeof line - strlen(line), "*a%d%s", i - 1, k < 9 ? ", " : "]\n");
        }
        strcat(text, line);
    }
    clock_t begin = clock();
    refuses(text, "f:6:5: error: aliases expand to more than a million values\n");
    assert_true(seconds_since(begin) < 1);
}

// Depth must not grow by aliases of aliases either: whoever walks the tree recurses.
TEST(alias_chains_count_as_depth) {
    char text[8000] = "a0: &a0 [x]\n";
    for (int i = 1; i < 100; i++) {
        char line[60];
        snprintf(line, sizeof line, "a%d: &a%d [*a%d]\n", i, i, i - 1);
        strcat(text, line);
    }
    refuses(text, "f:64:12: error: nesting is deeper than 64 levels\n");
}

TEST(many_values_are_refused) {
    size_t size = 2100001;
    char *text = malloc(size);
    text[0] = '[';
    for (size_t i = 1; i < size; i += 2) memcpy(text + i, "1,", 2);
    clock_t begin = clock();
    refuses_bytes(text, size, "f:1:2000000: error: more than a million values\n");
    assert_true(seconds_since(begin) < 10);
    free(text);
}

TEST(many_duplicate_keys_end_fast) {
    enum { N = 100000 };
    char *text = malloc(7 * N + 1);
    for (int i = 0; i < N; i++) memcpy(text + 7 * i, "key: 1\n", 7);
    clock_t begin = clock();
    fixture f = start();
    assert_null(bough_text_parse(f.arena, "f", text, 7 * N, &f.errors));
    assert_int_equal(f.errors.n, 100);
    assert_non_null(strstr(printed_errors(&f.errors),
                           "f:101:1: error: key 'key' is given twice (first in line "
                           "100)\n99899 more errors\n"));
    assert_true(seconds_since(begin) < 5);
    free(text);
}

TEST(unreadable_files_are_named) {
    fixture f = start();
    assert_null(bough_text_read(f.arena, "/nonexistent/x.yaml", &f.errors));
    assert_null(bough_text_read(f.arena, "/", &f.errors));
    assert_string_equal(printed_errors(&f.errors),
                        "/nonexistent/x.yaml: error: cannot be read: No such file or directory\n"
                        "/: error: cannot be read: Is a directory\n");
}

TEST(large_files_are_refused) {
    char path[SCRATCH_NAME];
    int descriptor = mkstemp(scratch_name(path));
    FILE *stream = fdopen(descriptor, "w");
    char line[1024];
    memset(line, '#', sizeof line);
    for (int i = 0; i < 17 * 1024; i++) fwrite(line, 1, sizeof line, stream);
    fclose(stream);
    char expected[SCRATCH_PATH];
    snprintf(expected, sizeof expected, "%s: error: cannot be read: the file is larger than 16 MB\n", path);
    fixture f = start();
    clock_t begin = clock();
    assert_null(bough_text_read(f.arena, path, &f.errors));
    assert_string_equal(printed_errors(&f.errors), expected);
    assert_true(seconds_since(begin) < 1);
    remove(path);
}

TEST(errors_are_sorted_by_place) {
    fixture f = start();
    const bough_node places[] = {
        {.file = "b", .line = 1, .column = 1},    {.file = "main", .line = 9, .column = 2},
        {.file = "main", .line = 9, .column = 1}, {.file = "a", .line = 7, .column = 1},
        {.file = "main", .line = 2, .column = 5}, {.file = "--set"},
        {.file = "main", .line = 2, .column = 5}};
    for (int i = 0; i < 7; i++) bough_errors_add(&f.errors, &places[i], i == 1 ? "p" : "", "%d", i);
    bough_errors_sort(&f.errors, "main");
    assert_string_equal(printed_errors(&f.errors),
                        "--set: error: 5\nmain:2:5: error: 4\nmain:2:5: error: 6\n"
                        "main:9:1: error: 2\nmain:9:2: error: p: 1\na:7:1: error: 3\n"
                        "b:1:1: error: 0\n");
}

TEST(control_characters_are_not_printed) {
    fixture f = start();
    bough_node where = {.file = "f", .line = 1, .column = 1};
    bough_errors_add(&f.errors, &where, "", "got '%s'", "\x1b[31m\n");
    assert_string_equal(printed_errors(&f.errors), "f:1:1: error: got '?[31m?'\n");
}
