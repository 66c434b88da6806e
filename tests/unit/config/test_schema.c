#include "apps/bough/config/schema.h"
#include "apps/bough/config/schema_keys.h"

#include "tests/unit/check.h"
#include "tests/unit/printed.h"

#include <time.h>

// A small schema with every kind of key.
typedef struct part {
    const bough_node *node;
    double length;
    const char *label;
} part;

typedef struct thing {
    const bough_node *node;
    int kind, count, n_weight, n_tag, n_part, sum;
    double angle, speed, share;
    const char *label;
    bool on;
    double vector[3], *weight;
    const char **tag;
    part inner, *part;
} thing;

static void read_sum(bough_schema_reader *r, const bough_node *node, void *field) {
    double v[3];
    int n = bough_schema_numbers(r, node, 2, 3, v, "a list of 2 or 3 numbers");
    for (int i = 0; i < n; i++) *(int *)field += (int)v[i];
}

static void check_part(bough_schema_reader *r, void *item) {
    if (((part *)item)->length > 99) {
        bough_schema_error(r, ((part *)item)->node, "length", "a long part");
    }
}

// clang-format off
#define FILLS part
static const bough_schema part_schema = {.name = "a part", .check = check_part, KEYS(
    {KEY(NUMBER, length), UNIT(LENGTH), .range = "> 0", .required = true, .help = "length of the part"},
    {KEY(TEXT, label), .fallback = "none", .help = "label of the part"},
)};
#undef FILLS

#define FILLS thing
static const bough_schema thing_schema = {.name = "a thing", KEYS(
    {KEY(CHOICE, kind), .required = true, CHOICES("turning", "sliding", "fixed"), .help = "its kind"},
    {KEY(NUMBER, angle), UNIT(ANGLE), .fallback = "90 deg", WHEN("kind", "turning"), .help = "its angle"},
    {KEY(NUMBER, speed), UNIT(ANGULAR_SPEED), WHEN("kind", "turning"), .help = "turning"},
    {KEY(NUMBER, speed), UNIT(SPEED), WHEN("kind", "sliding"), .help = "sliding"},
    {KEY(INTEGER, count), .range = "[0, 9]", .fallback = "4", .help = "how many"},
    {KEY(NUMBER, share), .range = "[0.5, 1]", .word = "auto", .fallback = "auto", .help = "how much"},
    {KEY(TEXT, label), .help = "a label"},
    {KEY(BOOLEAN, on), .fallback = "true", .help = "on or off"},
    {KEY(VECTOR, vector), .count = 3, UNIT(LENGTH), .fallback = "[0, 0, 2 m]", .help = "a vector"},
    {NAMED("weights", NUMBERS), AT(weight), UNIT(MASS), .range = ">= 0", .count = 2, COUNT_AT(n_weight),
     .help = "weights"},
    {NAMED("tags", TEXTS), AT(tag), .count = 1, COUNT_AT(n_tag), .help = "tags"},
    {KEY(MAPPING, inner), .of = &part_schema, .help = "an inner part"},
    {NAMED("parts", LIST), AT(part), .of = &part_schema, COUNT_AT(n_part), .help = "parts"},
    {KEY(CUSTOM, sum), .read = read_sum, .form = "numbers to add", .help = "a sum"},
)};
#undef FILLS
// clang-format on

typedef struct fixture {
    bough_arena *arena;
    bough_errors errors;
    thing thing;
    const char *printed;
} fixture;

static fixture read_thing(const char *text) {
    fixture f = {.arena = check_memory()};
    f.errors.arena = f.arena;
    bough_node *root = bough_text_parse(f.arena, "f", text, strlen(text), &f.errors);
    assert_non_null(root);
    bough_schema_reader reader = {.arena = f.arena, .errors = &f.errors, .directory = ""};
    bough_schema_read(&reader, &thing_schema, root, &f.thing);
    bough_errors_sort(&f.errors, "f");
    f.printed = printed_errors(&f.errors);
    return f;
}

static void refuses(const char *text, const char *lines) {
    fixture f = read_thing(text);
    assert_string_equal(f.printed, lines);
}

TEST(every_kind_is_read) {
    fixture f = read_thing("kind: sliding\nspeed: 36 km/h\ncount: 7\nshare: 0.75\nlabel: a b\n"
                           "on: false\nvector: [1 mm, 2, -3]\nweights: [1 t, 2, 3 g]\n"
                           "tags: [x, '1']\ninner: {length: 5 cm, label: l}\n"
                           "parts:\n  - {length: 1}\n  - length: 2\nsum: [1, 2, 3]\n");
    assert_string_equal(f.printed, "");
    const thing *t = &f.thing;
    assert_int_equal(t->kind, 1);
    check_near(t->speed, 10, 1e-15, 0);
    assert_int_equal(t->count, 7);
    check_near(t->share, 0.75, 0, 0);
    assert_string_equal(t->label, "a b");
    assert_false(t->on);
    check_near(t->vector[0], 1e-3, 1e-15, 0);
    check_near(t->vector[2], -3, 0, 0);
    assert_int_equal(t->n_weight, 3);
    check_near(t->weight[0], 1000, 0, 0);
    check_near(t->weight[2], 3e-3, 1e-15, 0);
    assert_int_equal(t->n_tag, 2);
    assert_string_equal(t->tag[1], "1");
    check_near(t->inner.length, 0.05, 1e-15, 0);
    assert_int_equal(t->inner.node->line, 10);
    assert_int_equal(t->n_part, 2);
    check_near(t->part[1].length, 2, 0, 0);
    assert_int_equal(t->part[1].node->line, 13);
    assert_int_equal(t->sum, 6);
}

TEST(defaults_are_filled) {
    fixture f = read_thing("kind: turning\n");
    assert_string_equal(f.printed, "");
    check_near(f.thing.angle, 1.5707963267948966, 1e-15, 0);
    assert_int_equal(f.thing.count, 4);
    check_near(f.thing.share, 0, 0, 0);
    assert_true(f.thing.on);
    check_near(f.thing.vector[2], 2, 0, 0);
    assert_null(f.thing.inner.node); // left out: no error about its required key, its defaults stand
    assert_string_equal(f.thing.inner.label, "none");
    assert_int_equal(f.thing.n_part, 0);
    assert_null(f.thing.label);
}

TEST(tables_are_read_by_columns) {
    fixture f = read_thing("kind: fixed\nparts:\n  columns: [label, length cm]\n  rows:\n"
                           "    - [a, 5]\n    - [b, 1 m]\n");
    assert_string_equal(f.printed, "");
    assert_int_equal(f.thing.n_part, 2);
    check_near(f.thing.part[0].length, 0.05, 1e-15, 0);
    check_near(f.thing.part[1].length, 1, 0, 0);
    assert_string_equal(f.thing.part[1].label, "b");
    assert_int_equal(f.thing.part[1].node->line, 6);
}

TEST(bad_tables_are_refused) {
    refuses("kind: fixed\nparts: {columns: [lable, length kg, label m, 3], rows: []}\n",
            "f:2:19: error: parts.columns: unknown key 'lable' (did you mean 'label'?)\n"
            "f:2:26: error: parts.columns: column 'length': the unit 'kg' does not fit\n"
            "f:2:37: error: parts.columns: column 'label' takes no unit\n"
            "f:2:46: error: parts.columns: unknown key '3'\n");
    refuses("kind: fixed\nparts:\n  columns: [length, length]\n  rows: []\n",
            "f:3:21: error: parts.columns: column 'length' is given twice\n");
    refuses("kind: fixed\nparts:\n  columns: [length, label]\n  rows:\n    - [1]\n    - 2\n"
            "    - [x, y]\n    - {length: 1}\n",
            "f:5:7: error: parts.rows[0]: expected a list of 2 values, one per column, got 1\n"
            "f:6:7: error: parts.rows[1]: expected a list of 2 values, one per column, got '2'\n"
            "f:7:8: error: parts.rows[2].length: expected a length (in m, or with a unit, as "
            "'61.5 m'), got 'x'\n"
            "f:8:7: error: parts.rows[3]: expected a list of 2 values, one per column, got a mapping\n");
    refuses("kind: fixed\nparts: {columns: [label], rows: [[x]], more: 1}\n",
            "f:2:34: error: parts.rows[0]: required key 'length' is missing\n"
            "f:2:40: error: parts: unknown key 'more': a table has 'columns' and 'rows'\n");
    refuses("kind: fixed\nparts: {rows: []}\n",
            "f:2:8: error: parts: expected a list of mappings, or 'columns' and 'rows'\n");
    refuses("kind: fixed\nparts: {columns: 3, rows: []}\n",
            "f:2:18: error: parts.columns: expected a list of column names, got '3'\n");
}

TEST(misspelt_words_get_a_hint) {
    refuses("kind: turnign\n", "f:1:7: error: kind: expected one of turning, sliding, fixed, got "
                               "'turnign' (did you mean 'turning'?)\n");
    refuses("kind: zzz\n", "f:1:7: error: kind: expected one of turning, sliding, fixed, got 'zzz'\n");
    refuses("kind: fixed\ncuont: 3\nxyzzy: 1\ninner: {length: 1, lable: x}\n",
            "f:2:1: error: unknown key 'cuont' (did you mean 'count'?)\n"
            "f:3:1: error: unknown key 'xyzzy'\n"
            "f:4:20: error: inner: unknown key 'lable' (did you mean 'label'?)\n");
}

TEST(wrong_types_are_refused) {
    refuses("kind: [fixed]\n", "f:1:7: error: kind: expected one of turning, sliding, fixed, got a list\n");
    refuses("kind: fixed\ncount: 1.5\n", "f:2:8: error: count: expected a whole number, got '1.5'\n");
    refuses("kind: fixed\ncount: {}\n", "f:2:8: error: count: expected a whole number, got an "
                                        "empty mapping\n");
    refuses("kind: fixed\ncount: 0x3\n", "f:2:8: error: count: expected a whole number, got '0x3'\n");
    refuses("kind: fixed\nlabel:\n", "f:2:7: error: label: expected text, got nothing\n");
    refuses("kind: fixed\nlabel: ''\n", "f:2:8: error: label: expected text, got ''\n");
    refuses("kind: fixed\nlabel: [a]\n", "f:2:8: error: label: expected text, got a list\n");
    refuses("kind: fixed\nvector: 1\n", "f:2:9: error: vector: expected a list of 3 numbers, got '1'\n");
    refuses("kind: fixed\nvector: [1, 2]\n", "f:2:9: error: vector: expected a list of 3 numbers, got 2\n");
    refuses("kind: fixed\nvector: [1, x, 2]\n",
            "f:2:13: error: vector[1]: expected a length (in m, or with a unit, as '61.5 m'), got 'x'\n");
    refuses("kind: fixed\nweights: [1]\n", "f:2:10: error: weights: expected at least 2 items, got 1\n");
    refuses("kind: fixed\nweights: 3\n", "f:2:10: error: weights: expected a list, got '3'\n");
    refuses("kind: fixed\ntags: []\n", "f:2:7: error: tags: expected at least 1 item, got 0\n");
    refuses("kind: fixed\ntags: [a, [b]]\n", "f:2:11: error: tags[1]: expected text, got a list\n");
    refuses("kind: fixed\ninner: 5\n", "f:2:8: error: inner: expected a part (a mapping of keys), got '5'\n");
    refuses("kind: fixed\nparts: 5\n", "f:2:8: error: parts: expected a list of mappings, got '5'\n");
    refuses("kind: fixed\nparts: [5]\n", "f:2:9: error: parts[0]: expected a part (a mapping of "
                                         "keys), got '5'\n");
    refuses("kind: fixed\nsum: [1, 2 m]\n", "f:2:10: error: sum[1]: expected a plain number in SI "
                                            "units, got '2 m'\n");
    refuses("kind: fixed\nsum: [1, 2, 3, 4, 5]\n", "f:2:6: error: sum: expected a list of 2 or 3 "
                                                   "numbers, got 5 items\n");
    refuses("- kind\n", "f:1:1: error: expected a thing (a mapping of keys), got a list\n");
}

TEST(only_true_and_false_are_booleans) {
    const char *const others[] = {"yes", "no", "on", "off", "True", "FALSE", "1", "0", "y", "~"};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        char text[60], line[80];
        snprintf(text, sizeof text, "kind: fixed\non: %s\n", others[i]);
        snprintf(line, sizeof line, "f:2:5: error: on: expected true or false, got '%s'\n", others[i]);
        refuses(text, line);
    }
    refuses("kind: fixed\non: 'true'\n", "f:2:5: error: on: expected true or false, got 'true'\n");
}

TEST(missing_keys_are_reported_at_the_mapping) {
    refuses("label: x\n", "f:1:1: error: required key 'kind' is missing\n");
    refuses("kind: fixed\ninner:\n  label: x\nparts:\n  - label: y\n",
            "f:3:3: error: inner: required key 'length' is missing\n"
            "f:5:5: error: parts[0]: required key 'length' is missing\n");
}

TEST(ranges_are_checked) {
    refuses("kind: fixed\ncount: 10\nshare: 0.4\nweights: [1, -2 kg]\ninner: {length: 0}\n",
            "f:2:8: error: count: must be in [0, 9], got '10'\n"
            "f:3:8: error: share: must be in [0.5, 1], got '0.4'\n"
            "f:4:14: error: weights[1]: must be >= 0 kg, got '-2 kg'\n"
            "f:5:17: error: inner.length: must be > 0 m, got '0'\n");
    fixture f = read_thing("kind: fixed\ncount: 9\nshare: 0.5\nweights: [0, 1]\n");
    assert_string_equal(f.printed, "");
}

TEST(keys_depend_on_choices) {
    refuses("kind: fixed\nangle: 1\nspeed: 1\n",
            "f:2:1: error: angle: only used with 'kind: turning'\n"
            "f:3:1: error: speed: only used with 'kind: turning/sliding'\n");
    refuses("kind: sliding\nspeed: 12 rpm\n",
            "f:2:8: error: speed: expected a speed (in m/s, or with a unit, as '20 m/s'), got '12 "
            "rpm': the unit 'rpm' does not fit\n");
    // A wrong choice raises no errors about the keys that hang on it.
    refuses("kind: xyz\nangle: 1\n", "f:1:7: error: kind: expected one of turning, sliding, "
                                     "fixed, got 'xyz'\n");
}

TEST(checks_run_on_clean_mappings_only) {
    refuses("kind: fixed\ninner: {length: 100}\n", "f:2:17: error: inner.length: a long part\n");
    refuses("kind: fixed\ninner: {length: 100, x: 1}\n", "f:2:22: error: inner: unknown key 'x'\n");
}

TEST(long_values_are_cut) {
    char text[400] = "kind: fixed\ncount: ", line[200];
    for (int i = 0; i < 100; i++) strcat(text, "é");
    strcpy(line, "f:2:8: error: count: expected a whole number, got '");
    for (int i = 0; i < 22; i++) strcat(line, "é");
    strcat(line, "...'\n");
    refuses(text, line);
}

static void quantity_is(const char *text, bough_dimension dimension, double expected) {
    double value = NAN;
    char why[160];
    if (!bough_quantity(text, dimension, &value, why)) fail_msg("'%s' refused: %s", text, why);
    check_near(value, expected, 1e-15, 0);
}

TEST(units_are_converted) {
    quantity_is("12.1 rpm", BOUGH_ANGULAR_SPEED, 12.1 * 3.14159265358979323846 / 30);
    quantity_is("5 deg", BOUGH_ANGLE, 5 * 3.14159265358979323846 / 180);
    quantity_is("2 mrad", BOUGH_ANGLE, 2e-3);
    quantity_is("30 deg/s", BOUGH_ANGULAR_SPEED, 3.14159265358979323846 / 6);
    quantity_is("20 ms", BOUGH_TIME, 0.02);
    quantity_is("3 us", BOUGH_TIME, 3e-6);
    quantity_is("3 µs", BOUGH_TIME, 3e-6);
    quantity_is("2 min", BOUGH_TIME, 120);
    quantity_is("1 h", BOUGH_TIME, 3600);
    quantity_is("-11.9 MN m", BOUGH_MOMENT, -11.9e6);
    quantity_is("5.3 MW", BOUGH_POWER, 5.3e6);
    quantity_is("5296610", BOUGH_POWER, 5296610);
    quantity_is("11.9 MN*m", BOUGH_MOMENT, 11.9e6);
    quantity_is("1 kg m^2/s^2", BOUGH_MOMENT, 1);
    quantity_is("50 Hz", BOUGH_FREQUENCY, 50);
    quantity_is("2 1/s", BOUGH_FREQUENCY, 2);
    quantity_is("56.78 t", BOUGH_MASS, 56780);
    quantity_is("250 g", BOUGH_MASS, 0.25);
    quantity_is("1.2 kg/m^3", BOUGH_DENSITY, 1.2);
    quantity_is("1.2 kg/m3", BOUGH_DENSITY, 1.2);
    quantity_is("1.2 kg/m³", BOUGH_DENSITY, 1.2);
    quantity_is("1 g/cm^3", BOUGH_DENSITY, 1000);
    quantity_is("72 km/h", BOUGH_SPEED, 20);
    quantity_is("9.81 m/s²", BOUGH_ACCELERATION, 9.81);
    quantity_is("3 kN/mm", BOUGH_STIFFNESS, 3e6);
    quantity_is("12 kN", BOUGH_FORCE, 12e3);
    quantity_is("12 kg m^2", BOUGH_INERTIA, 12);
    quantity_is("7", BOUGH_INERTIA, 7);
    quantity_is("61.5m", BOUGH_LENGTH, 61.5);
    quantity_is("10s", BOUGH_TIME, 10);
}

static void quantity_fails(const char *text, bough_dimension dimension, const char *reason) {
    double value = 0;
    char why[160];
    if (bough_quantity(text, dimension, &value, why)) fail_msg("'%s' read as %g", text, value);
    assert_string_equal(why, reason);
}

TEST(wrong_units_are_refused) {
    quantity_fails("5 kg", BOUGH_LENGTH, "the unit 'kg' does not fit");
    quantity_fails("5 Hz", BOUGH_ANGULAR_SPEED, "the unit 'Hz' does not fit");
    quantity_fails("5 N", BOUGH_MOMENT, "the unit 'N' does not fit");
    quantity_fails("5 rad", BOUGH_PURE_NUMBER, "the unit 'rad' does not fit");
    quantity_fails("5 furlong", BOUGH_LENGTH, "unknown unit 'furlong'");
    quantity_fails("5 M", BOUGH_LENGTH, "unknown unit 'M'");
    quantity_fails("5 kmin", BOUGH_TIME, "unknown unit 'kmin'");
    quantity_fails("5 m/", BOUGH_LENGTH, "the unit 'm/' does not fit");
    quantity_fails("5 m//s", BOUGH_SPEED, "the unit 'm//s' does not fit");
    quantity_fails("61.5kg", BOUGH_LENGTH, "the unit 'kg' does not fit");
    quantity_fails("61.5/m", BOUGH_LENGTH, "");
    quantity_fails("5 deg", BOUGH_TIME, "the unit 'deg' does not fit");
}

// What is radians to one reader and degrees to the next is no number alone; 0 is the same to both.
TEST(angles_need_a_unit) {
    quantity_is("0", BOUGH_ANGLE, 0);
    quantity_is("-0.0", BOUGH_ANGULAR_SPEED, 0);
    quantity_is("6.5 rad", BOUGH_ANGLE, 6.5);
    quantity_fails("6.5", BOUGH_ANGLE, "6.5 rad is 372.4 deg; write '6.5 deg' or '6.5 rad'");
    quantity_fails("2", BOUGH_ANGULAR_SPEED, "2 rad/s is 19.1 rpm; write '2 rpm' or '2 rad/s'");
}

TEST(numbers_are_strict) {
    quantity_is("0", BOUGH_PURE_NUMBER, 0);
    quantity_is("-0.5e-3", BOUGH_PURE_NUMBER, -5e-4);
    quantity_is("+1.E5", BOUGH_PURE_NUMBER, 1e5);
    quantity_is(".5", BOUGH_PURE_NUMBER, 0.5);
    quantity_is("1e-400", BOUGH_PURE_NUMBER, 0);
    const char *const bad[] = {"0x3d", "010",   "00",    "nan", ".nan", "inf", "-.inf", "1e",
                               "e5",   "1,5",   "1_000", "--1", "",     " 1",  ".",     "-",
                               "1 2",  "1.2.3", "1e5.5", "0b1", "0o7",  "1d5", "1:30"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        double value;
        char why[160];
        if (bough_quantity(bad[i], BOUGH_PURE_NUMBER, &value, why)) {
            fail_msg("'%s' read as %g", bad[i], value);
        }
    }
    quantity_fails("1e999", BOUGH_PURE_NUMBER, "out of the range of numbers");
    quantity_fails("-1e999", BOUGH_TIME, "out of the range of numbers");
    double value;
    char why[160];
    assert_false(bough_quantity("1e300 Gm", BOUGH_LENGTH, &value, why));
}

TEST(nearest_words_are_found) {
    const char *const words[] = {"duration", NULL, "macro_step", "hub", "x"};
    assert_string_equal(bough_nearest("durration", words, 5), "duration");
    assert_string_equal(bough_nearest("makrostep", words, 5), "macro_step");
    assert_string_equal(bough_nearest("hbu", words, 5), "hub");
    static const char *const methods[] = {"ida", "cvode-bdf", "generalized-alpha"};
    assert_string_equal(bough_nearest("cvode", methods, 3), "cvode-bdf");
    assert_string_equal(bough_nearest("alpha", methods, 3), "generalized-alpha");
    assert_null(bough_nearest("general", methods, 3));
    assert_null(bough_nearest("velocity", words, 5));
    assert_null(bough_nearest("abc", words, 5));
    const char *const equal[] = {"seed", "speed", "sped up"};
    assert_string_equal(bough_nearest("sped", equal, 3), "speed"); // one slip from each, it begins alike
    assert_string_equal(bough_nearest("sped", &equal[1], 2), "speed");
    char text[300];
    memset(text, 'a', 299);
    text[299] = '\0';
    assert_null(bough_nearest(text, words, 5));
}

// Half a million unknown keys must not cost half a million searches for a near word.
TEST(hostile_keys_end_fast) {
    enum { N = 300000 };
    char *text = malloc(16 * N + 20), *next = text + sprintf(text, "kind: fixed\n");
    for (int i = 0; i < N; i++) next += sprintf(next, "cuont%d: 1\n", i);
    clock_t begin = clock();
    fixture f = read_thing(text);
    assert_int_equal(f.errors.n + f.errors.dropped, N);
    assert_true((double)(clock() - begin) / CLOCKS_PER_SEC < 10);
    free(text);
}

TEST(help_names_every_key) {
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    bough_schema_help(&thing_schema, 0, stream);
    fclose(stream);
    const char *const lines[] = {
        "- kind: (turning|sliding|fixed; required; e.g. turning)\n  its kind\n",
        "angle: (number in rad; default 90 deg; with kind: turning)\n",
        "count: (whole number, [0, 9]; default 4)\n",
        "share: (number or auto, [0.5, 1]; default auto)\n",
        "vector: (3 numbers in m; default [0, 0, 2 m])\n",
        "parts: (list of mappings)\n  parts\n  - length: (number in m, > 0; required)\n",
        "sum: (numbers to add)\n",
    };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        if (strstr(text, lines[i]) == NULL) fail_msg("not in the help: %s", lines[i]);
    }
    free(text);
}
