// A blade from its layers: outlines from airfoils in either order, arcs said in every way of both
// layouts, sections against tubes and against the thin-walled section that they are.
#include "tests/unit/import.h"

static const double pi = 3.14159265358979323846;

// Replaces every place of `from` in the text of `size` bytes.
static void replace(char *text, size_t size, const char *from, const char *to) {
    char *at = text, *rest = malloc(size);
    assert_non_null(rest);
    while ((at = strstr(at, from))) {
        strcpy(rest, at + strlen(from));
        snprintf(at, size - (size_t)(at - text), "%s%s", to, rest);
        at += strlen(to);
    }
    free(rest);
}

// Points of a circle of unit diameter about (0.5, 0), from the trailing edge above or below.
static void put_circle(FILE *out, const char *name, bool above, double flat) {
    enum { N = 120 };
    fprintf(out, "  - name: %s-shape\n    coordinates:\n      x: [", name);
    for (int i = 0; i <= N; i++) fprintf(out, "%s%.9g", i ? ", " : "", 0.5 + 0.5 * cos(2 * pi * i / N));
    fputs("]\n      y: [", out);
    for (int i = 0; i <= N; i++) {
        double y = 0.5 * flat * sin(2 * pi * i / N) * (above ? 1 : -1);
        fprintf(out, "%s%.9g", i ? ", " : "", y);
    }
    fputs("]\n", out);
}

// A text of the coordinates that both airfoils get.
static void circle(char *text, size_t size, bool above) {
    FILE *out = fmemopen(text, size, "w");
    assert_non_null(out);
    put_circle(out, "", above, 1);
    fclose(out);
}

typedef struct options {
    const char *structure; // of the blade
    bool above;            // the airfoils' points begin on the suction side
} options;

// The small turbine with layers in place of matrices and round airfoils of constant chord.
static trial attempt(options o) {
    enum { SIZE = 65536 };
    trial t = begin_trial();
    char path[SCRATCH_PATH], *text = malloc(SIZE), shape[16384], *body;
    assert_non_null(text);
    read_deck("turbine-1.yaml", text);
    circle(shape, sizeof shape, o.above);
    body = strstr(shape, "    coordinates:");
    char *from = strstr(text, "    elastic_properties_mb:\n      six_x_six"), *to = strstr(text, "  hub:\n");
    char *rest = strdup(to);
    snprintf(from, SIZE - (size_t)(from - text), "    internal_structure_2d_fem:\n%s%s", o.structure, rest);
    free(rest);
    char flat[16500], round[16500];
    snprintf(flat, sizeof flat, "  - name: flat\n%s", body);
    snprintf(round, sizeof round, "  - name: round\n%s", body);
    replace(text, SIZE, "  - name: flat\n", flat);
    replace(text, SIZE, "  - name: round\n", round);
    replace(text, SIZE, "values: [1.0, 1.0, 1.2, 0.4]", "values: [2.0, 2.0, 2.0, 2.0]");
    replace(text, SIZE, "pitch_axis: {grid: [0.0, 1.0], values: [0.5, 0.25]}",
            "pitch_axis: {grid: [0.0, 1.0], values: [0.5, 0.5]}");
    scratch_write(t.folder, "turbine.yaml", text);
    free(text);
    snprintf(path, sizeof path, "%s/turbine.yaml", t.folder);
    t.status = bough_import_windio(path, t.out, &(bough_import_options){0}, NULL);
    return t;
}

static trial import_layers(options o) { return imported(attempt(o)); }

#define WALL                                                                                                 \
    "      layers:\n"                                                                                        \
    "        - {name: wall, material: steel, thickness: {grid: [0, 1], values: [0.01, 0.01]}}\n"

// The station's k-th number of stiffness [21, or its six] and mass [7].
static double stiffness(const bough_node *row, int diagonal) {
    static const int place[] = {0, 6, 11, 15, 18, 20};
    const bough_node *k = row->value[3];
    return strtod(k->value[k->n == 21 ? place[diagonal] : diagonal]->text, NULL);
}

TEST(tube_of_one_layer) {
    for (int above = 0; above < 2; above++) {
        trial t = import_layers((options){WALL, above});
        assert_true(list_says(&t, "stiffness and inertia of thin walls"));
        const bough_node *rows = at(read_file(&t, "blade-structure.yaml"), "stations.rows");
        double area = pi * (1 - 0.99 * 0.99), second = pi / 4 * (1 - pow(0.99, 4));
        for (int i = 0; i < rows->n; i += 7) {
            const bough_node *row = rows->value[i];
            check_near(stiffness(row, 2), 2e11 * area, 2e-3, 0);
            check_near(stiffness(row, 3), 2e11 * second, 3e-3, 0);
            check_near(stiffness(row, 4), 2e11 * second, 3e-3, 0);
            check_near(stiffness(row, 5), 2 * 8e10 * second, 3e-3, 0);
            check_near(stiffness(row, 0), 8e10 * area / 2, 5e-3, 0);
            check_near(number(row, "4.0"), 8000 * area, 2e-3, 0);
            check_near(number(row, "4.1"), 0, 0, 1e-4);
            check_near(number(row, "4.2"), 0, 0, 1e-4);
        }
        steps(&t, 1);
    }
}

// A tube with a cap whose place is said by `cap`, and anchors of which one lies as `anchor` says.
static trial import_cap(const char *anchor, const char *cap) {
    char structure[4096];
    snprintf(structure, sizeof structure,
             "      anchors:\n        - {name: cap-place, %s}\n"
             "        - {name: before, %s}\n        - {name: behind, %s}\n" WALL
             "        - {name: cap, material: steel, thickness: {grid: [0, 1], values: [0.03, 0.03]}, %s}\n",
             anchor,
             // ends where the cap begins, and begins where it ends
             "start_nd_arc: {fixed: TE}, end_nd_arc: {anchor: {name: cap-place, handle: start_nd_arc}}",
             "start_nd_arc: {anchor: {name: cap-place, handle: end_nd_arc}}, end_nd_arc: {fixed: TE}", cap);
    return import_layers((options){structure, true});
}

// Mass centre of the section with a cap at 0.1 m behind the axis.
static void find_centre(trial *t, double centre[2]) {
    const bough_node *rows = at(read_file(t, "blade-structure.yaml"), "stations.rows");
    const bough_node *tip = rows->value[rows->n - 1];
    double own = 8000 * (pi * (1 - 0.99 * 0.99) + 0.4 * 0.03 * (1 - 0.025));
    check_near(number(tip, "4.0"), own, 5e-3, 0);
    centre[0] = number(tip, "4.1");
    centre[1] = number(tip, "4.2");
    assert_true(centre[0] > 0.1 && centre[1] > 0); // towards suction side and trailing edge
    check_near(centre[1] / centre[0], tan(asin(0.1)), 0.03, 0);
}

// A cap of 0.4 m about the middle of the suction side, 0.1 m behind the axis: one place said in each
// way. At no twist the arc of the middle follows from sin = 0.1.
TEST(arcs_are_said_in_many_ways) {
    double middle = (pi / 2 - asin(0.1)) / (2 * pi), half = 0.2 / (2 * pi);
    char values[4][400];
    snprintf(values[0], sizeof values[0],
             "start_nd_arc: {grid: [0, 1], values: [%.9g, %.9g]}, end_nd_arc: {grid: [0, 1], values: "
             "[%.9g, %.9g]}",
             middle - half, middle - half, middle + half, middle + half);
    snprintf(values[1], sizeof values[1],
             "midpoint_nd_arc: {grid: [0, 1], values: [%.9g, %.9g]}, width: {grid: [0, 1], values: [0.4, "
             "0.4]}",
             middle, middle);
    snprintf(values[2], sizeof values[2],
             "start_nd_arc: {grid: [0, 1], values: [%.9g, %.9g]}, width: {grid: [0, 1], values: [0.4, 0.4]}",
             middle - half, middle - half);
    snprintf(
        values[3], sizeof values[3],
        "start_nd_arc: {grid: [0, 1], values: [%.9g, %.9g]}, end_nd_arc: {grid: [0, 1], values: [1, 1]}, "
        "width: {grid: [0, 1], values: [0.4, 0.4], defines: [end_nd_arc]}",
        middle - half, middle - half);
    const char *const ways[] = {
        values[0],
        values[1],
        values[2],
        values[3],
        "start_nd_arc: {grid: [0, 1], values: [0, 0]}, end_nd_arc: {grid: [0, 1], values: [1, 1]}, "
        "width: {grid: [0, 1], values: [0.4, 0.4], defines: [start_nd_arc, end_nd_arc]}, plane_intersection: "
        "{side: suction, defines: [midpoint_nd_arc], plane_type1: {rotation: 0}, offset: {grid: [0, 1], "
        "values: [0.1, 0.1]}}",
        "offset_y_pa: {grid: [0, 1], values: [0.1, 0.1]}, rotation: {grid: [0, 1], values: [0, 0]}, "
        "side: suction, width: {grid: [0, 1], values: [0.4, 0.4]}",
        "start_nd_arc: {anchor: {name: cap-place, handle: start_nd_arc}}, "
        "end_nd_arc: {anchor: {name: cap-place, handle: end_nd_arc}}",
        "start_nd_arc: {fixed: before}, end_nd_arc: {fixed: behind}"};
    double first[2];
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        trial t = import_cap(values[1], ways[i]);
        double centre[2];
        find_centre(&t, centre);
        if (i == 0) memcpy(first, centre, sizeof first);
        for (int c = 0; c < 2; c++) check_near(centre[c], first[c], 5e-3, 0);
    }
}

// A plate of 2 m across the tube: half a metre behind the axis it is √3/2 of that.
TEST(webs_cross_the_section) {
    static const char *const place[] = {
        "offset_y_pa: {grid: [0, 1], values: [0.5, 0.5]}, rotation: {grid: [0, 1], values: [0, 0]}",
        "start_nd_arc: {grid: [0, 1], values: [0.16666667, 0.16666667]}, end_nd_arc: {grid: [0, 1], "
        "values: [0.83333333, 0.83333333]}",
        "start_nd_arc: {grid: [0, 1], values: [0.2, 0.2]}, end_nd_arc: {grid: [0, 1], values: [0.7, 0.7]}, "
        "plane_intersection: {side: both, defines: [start_nd_arc, end_nd_arc], plane_type1: {rotation: 0}, "
        "offset: {grid: [0, 1], values: [0.5, 0.5]}}"};
    for (size_t i = 0; i < sizeof place / sizeof *place; i++) {
        char structure[2048];
        snprintf(structure, sizeof structure,
                 "      webs:\n        - {name: plate, %s}\n" WALL
                 "        - {name: skin, web: plate, material: steel, n_plies: {grid: [0, 1], values: "
                 "[4, 4]}}\n",
                 place[i]);
        check_refused(attempt((options){structure, false}), BOUGH_INVALID, "ply_t"); // steel has none here
        snprintf(structure, sizeof structure,
                 "      webs:\n        - {name: plate, %s}\n" WALL
                 "        - {name: skin, web: plate, material: steel, thickness: {grid: [0, 1], values: "
                 "[0.02, 0.02]}}\n",
                 place[i]);
        trial t = import_layers((options){structure, false});
        const bough_node *rows = at(read_file(&t, "blade-structure.yaml"), "stations.rows");
        const bough_node *tip = rows->value[rows->n - 1];
        double plate = 0.02 * sqrt(3.0), tube = pi * (1 - 0.99 * 0.99);
        check_near(number(tip, "4.0"), 8000 * (tube + plate), 1e-2, 0);
        check_near(number(tip, "4.2"), 0.5 * plate / (tube + plate), 2e-2, 0);
    }
}

// Real files have matrices whose inertia misses an entry beside layers that are right.
TEST(impossible_matrices_give_way_to_layers) {
    static const char matrix[] =
        "{grid: [0, 1], values: [[1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, "
        "0, 0, 1], [1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1]]}";
    char structure[2048];
    snprintf(
        structure, sizeof structure,
        WALL
        "    elastic_properties_mb:\n      six_x_six:\n        stiff_matrix: %s\n        inertia_matrix: %s\n",
        matrix, matrix);
    trial t = import_layers((options){structure, true});
    assert_true(list_says(&t, "blade: the matrices of stiffness and inertia, which no section can have"));
    const bough_node *rows = at(read_file(&t, "blade-structure.yaml"), "stations.rows");
    check_near(number(rows, "0.4.0"), 8000 * pi * (1 - 0.99 * 0.99), 2e-3, 0);
}

TEST(bad_layers_are_reported) {
    const struct {
        const char *structure, *says;
    } bad[] = {
        {"      layers:\n        - {name: wall, material: wood, thickness: {grid: [0, 1], values: [1, 1]}}\n",
         "material: no material is named 'wood'"},
        {"      layers:\n        - {name: wall, material: steel}\n", "expected a key 'thickness' here"},
        {WALL "        - {name: skin, web: plate, material: steel, thickness: {grid: [0, 1], values: [1, "
              "1]}}\n",
         "web: no web is named 'plate'"},
        {WALL "        - {name: a, material: steel, thickness: {grid: [0, 1], values: [0.1, 0.1]}, "
              "start_nd_arc: {fixed: b}, end_nd_arc: {fixed: b}}\n"
              "        - {name: b, material: steel, thickness: {grid: [0, 1], values: [0.1, 0.1]}, "
              "start_nd_arc: {fixed: a}, end_nd_arc: {fixed: a}}\n",
         "it refers to itself"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        check_refused(attempt((options){bad[i].structure, true}), BOUGH_INVALID, bad[i].says);
    }
}
