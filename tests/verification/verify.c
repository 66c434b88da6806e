// The keys of a study of kind verify and their reading.
#include "tests/verification/verify.h"

#include "apps/bough/config/schema_keys.h"

// -- quantities -----------------------------------------------------------------------------------

static const char quantity_form[] =
    "'tip x|y|z|ux|uy|uz|rx|ry|rz', 'frequency N', 'damping N', 'growth', 'CHANNEL at TIME', "
    "'largest CHANNEL', 'smallest CHANNEL', 'mean CHANNEL from TIME', 'amplitude CHANNEL from "
    "TIME' once per turn of the rotor, 'drift of energy|momentum|"
    "angular momentum from TIME', 'evaluations per step'";

static int word_index(const char *word, const char *const *words, int n) {
    for (int i = 0; i < n; i++) {
        if (strcmp(word, words[i]) == 0) return i;
    }
    return -1;
}

static bool parse_tip(const char *phrase, bough_verify_quantity *q) {
    static const char *const names[] = {"x", "y", "z", "ux", "uy", "uz", "rx", "ry", "rz"};
    if (strncmp(phrase, "tip ", 4) != 0) return false;
    q->what = BOUGH_VERIFY_TIP;
    q->index = word_index(phrase + 4, names, 9);
    return q->index >= 0;
}

static bool parse_mode(const char *phrase, bough_verify_quantity *q) {
    static const char *const names[] = {"frequency", "damping"};
    char word[16];
    int number, end = 0;
    if (strcmp(phrase, "growth") == 0) {
        q->what = BOUGH_VERIFY_GROWTH;
        return true;
    }
    if (sscanf(phrase, "%15s %d%n", word, &number, &end) != 2 || phrase[end]) return false;
    int k = word_index(word, names, 2);
    q->what = (bough_verify_what)(BOUGH_VERIFY_FREQUENCY + k);
    q->index = number - 1;
    return k >= 0 && number >= 1 && number <= 50;
}

static bool parse_drift(const char *phrase, bough_verify_quantity *q) {
    static const char *const names[] = {"energy", "momentum", "angular momentum"};
    char word[32] = "", why[160];
    const char *from = strstr(phrase, " from ");
    if (strncmp(phrase, "drift of ", 9) != 0 || !from || from < phrase + 9) return false;
    snprintf(word, sizeof word, "%.*s", (int)(from - phrase - 9), phrase + 9);
    q->what = BOUGH_VERIFY_DRIFT;
    q->index = word_index(word, names, BOUGH_VERIFY_INVARIANTS);
    return q->index >= 0 && bough_quantity(from + 6, BOUGH_TIME, &q->time, why);
}

static bool parse_work(const char *phrase, bough_verify_quantity *q) {
    if (strcmp(phrase, "evaluations per step") != 0) return false;
    q->what = BOUGH_VERIFY_WORK;
    return true;
}

static bool parse_wave(bough_arena *arena, const char *phrase, bough_verify_quantity *q) {
    char word[16], name[64], why[160];
    int end = 0;
    if (sscanf(phrase, "%15s %63s from%n", word, name, &end) != 2 || end == 0) return false;
    bool mean = strcmp(word, "mean") == 0;
    q->what = mean ? BOUGH_VERIFY_MEAN : BOUGH_VERIFY_AMPLITUDE;
    q->channel = bough_arena_string(arena, name);
    return (mean || strcmp(word, "amplitude") == 0) && phrase[end] == ' ' &&
           bough_quantity(phrase + end + 1, BOUGH_TIME, &q->time, why);
}

static bool parse_channel(bough_arena *arena, const char *phrase, bough_verify_quantity *q) {
    char word[64], name[64], why[160];
    int end = 0;
    if (sscanf(phrase, "%63s %63s%n", word, name, &end) != 2) return false;
    bool largest = strcmp(word, "largest") == 0;
    if (phrase[end] == '\0' && (largest || strcmp(word, "smallest") == 0)) {
        q->what = largest ? BOUGH_VERIFY_LARGEST : BOUGH_VERIFY_SMALLEST;
        q->channel = bough_arena_string(arena, name);
        return true;
    }
    q->what = BOUGH_VERIFY_AT;
    q->channel = bough_arena_string(arena, word);
    return strcmp(name, "at") == 0 && phrase[end] == ' ' &&
           bough_quantity(phrase + end + 1, BOUGH_TIME, &q->time, why);
}

static void check_expect(bough_schema_reader *r, void *item) {
    bough_verify_expect *e = item;
    if ((e->name != NULL) == (e->diagnosis != NULL)) {
        bough_schema_error(r, e->node, "", "expected one of 'quantity' and 'diagnosis'");
        return;
    }
    if (e->diagnosis) return;
    bough_verify_quantity *q = &e->quantity;
    if (!parse_tip(e->name, q) && !parse_mode(e->name, q) && !parse_drift(e->name, q) &&
        !parse_work(e->name, q) && !parse_wave(r->arena, e->name, q) &&
        !parse_channel(r->arena, e->name, q)) {
        bough_schema_error(r, e->node, "quantity", "expected %s, got '%.80s'", quantity_form, e->name);
    }
    if ((e->relative > 0) == (e->absolute > 0)) {
        bough_schema_error(r, e->node, "",
                           "expected one of 'relative' and 'absolute', the "
                           "tolerance");
    }
}

// -- keys -----------------------------------------------------------------------------------------

static void check_meshes(bough_schema_reader *r, const bough_verify_case *x) {
    const bough_node *node = bough_node_find(x->node, "meshes");
    if (x->n_mesh > BOUGH_VERIFY_MESHES) {
        bough_schema_error(r, node, "meshes", "expected at most %d", BOUGH_VERIFY_MESHES);
        return;
    }
    for (int k = 0; k < x->n_mesh; k++) {
        bool whole = x->mesh[k] == floor(x->mesh[k]) && x->mesh[k] <= 1e6;
        bool grows = k == 0 || x->mesh[k] > x->mesh[k - 1];
        if (k > 1) {
            double last = x->mesh[k] / x->mesh[k - 1], first = x->mesh[1] / x->mesh[0];
            grows = grows && fabs(last - first) < 1e-9 * first;
        }
        if (whole && grows) continue;
        bough_schema_error(r, node, "meshes", "expected numbers of segments that grow by a constant factor");
        return;
    }
}

static void check_case(bough_schema_reader *r, void *item) {
    bough_verify_case *x = item;
    check_meshes(r, x);
    for (int i = 0; i < x->n_expect; i++) {
        bough_verify_expect *e = &x->expect[i];
        if (e->extrapolate && x->n_mesh < 2) {
            bough_schema_error(r, e->node, "extrapolate", "needs two 'meshes' or more");
        }
        if (e->diagnosis) continue;
        bool fits = x->action == BOUGH_VERIFY_STATIC ? e->quantity.what == BOUGH_VERIFY_TIP
                    : x->action == BOUGH_VERIFY_MODES
                        ? e->quantity.what > BOUGH_VERIFY_TIP && e->quantity.what < BOUGH_VERIFY_AT
                        : e->quantity.what >= BOUGH_VERIFY_AT;
        if (fits) continue;
        bough_schema_error(r, e->node, "quantity", "'%.60s' does not come from what the case does", e->name);
    }
}

// One line a key would become one line a field:
// clang-format off

#define FILLS bough_verify_expect
static const bough_schema expect_schema = {.name = "an expectation", .check = check_expect, KEYS(
    {.name = "quantity", .kind = BOUGH_KEY_TEXT, AT(name), .help = quantity_form},
    {.name = "value", .kind = BOUGH_KEY_NUMBER, .fallback = "0", AT(value),
     .help = "the reference, in m, rad, Hz or the channel's unit, times the scale"},
    {.name = "scale", .kind = BOUGH_KEY_NUMBER, .fallback = "1", AT(scale),
     .help = "by which the result is multiplied"},
    {.name = "relative", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0", AT(relative),
     .help = "tolerance, as a share of the value"},
    {.name = "absolute", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0", AT(absolute),
     .help = "tolerance"},
    {.name = "extrapolate", .kind = BOUGH_KEY_BOOLEAN, .fallback = "false", AT(extrapolate),
     .help = "the result is extrapolated at second order from the two finest meshes"},
    {.name = "diagnosis", .kind = BOUGH_KEY_TEXT, AT(diagnosis),
     .help = "in place of a quantity: part of the message with which the case must end"},
)};
#undef FILLS

#define FILLS bough_verify_case
static const bough_schema case_schema = {.name = "a case", .check = check_case, KEYS(
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name), .help = "heads its lines"},
    {.name = "scene", .kind = BOUGH_KEY_TEXT, .required = true, AT(scene_name),
     .help = "file of the scene, relative to the study"},
    {.name = "do", .kind = BOUGH_KEY_CHOICE, CHOICES("static", "modes", "run"),
     .required = true, AT(action),
     .help = "equilibrium or modes of the first rod, or the run"},
    {.name = "set", .kind = BOUGH_KEY_CUSTOM, .read = bough_study_read_settings,
     .form = "{KEY: VALUE, ...}", AT(set), .help = "replacements in the scene"},
    {.name = "meshes", .kind = BOUGH_KEY_NUMBERS, .range = ">= 1", .count = 1, AT(mesh),
     COUNT_AT(n_mesh),
     .help = "numbers of segments that grow by a constant factor; default the scene's"},
    {.name = "mesh_key", .kind = BOUGH_KEY_TEXT, .fallback = "bodies[0].rod.segments",
     AT(mesh_key), .help = "key of the scene that takes them"},
    {.name = "mesh_of", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0", AT(mesh_of),
     .help = "what is divided by them for that key, as a time for a step; 0: nothing"},
    {.name = "expect", .kind = BOUGH_KEY_LIST, .of = &expect_schema, .count = 1, .required = true,
     AT(expect), COUNT_AT(n_expect),
     .help = "what should come out"},
)};
#undef FILLS

#define FILLS bough_verify
static const bough_schema verify_schema = {.name = "a study", KEYS(
    {.name = "title", .kind = BOUGH_KEY_TEXT, AT(title), .help = "one line: what is verified"},
    {.name = "kind", .kind = BOUGH_KEY_CHOICE, CHOICES("verify"), .required = true,
     AT(kind), .help = "verify: every case is compared to what it should give"},
    {.name = "cases", .kind = BOUGH_KEY_LIST, .of = &case_schema, .count = 1, .required = true,
     AT(cases), COUNT_AT(n_case), .help = "one after the other"},
)};
#undef FILLS
// clang-format on

// -- reading --------------------------------------------------------------------------------------

bough_status bough_verify_scene(bough_arena *arena, const bough_verify_case *x, int k, bough_errors *errors,
                                bough_scene **scene) {
    const char **set = bough_arena_take(arena, ((size_t)x->set.n + 1) * sizeof *set);
    int n = x->set.n;
    for (int i = 0; i < n; i++) set[i] = x->set.item[i].set;
    if (x->n_mesh > 0) {
        char mesh[160];
        double value = x->mesh_of > 0 ? x->mesh_of / x->mesh[k] : x->mesh[k];
        snprintf(mesh, sizeof mesh, "%.120s=%.15g", x->mesh_key, value);
        set[n++] = bough_arena_string(arena, mesh);
    }
    return bough_scene_read(arena, NULL, x->scene, set, n, errors, scene);
}

// The scene on the first mesh; what is wrong there is reported at the case.
static void check_scene(bough_arena *arena, const bough_verify_case *x, bough_errors *errors) {
    bough_arena *own = bough_arena_child(arena);
    bough_errors found = {.arena = own};
    bough_scene *scene;
    bough_verify_scene(own, x, 0, &found, &scene);
    for (int i = 0; i < found.n; i++) {
        const bough_error *e = &found.item[i];
        bough_errors_add(errors, x->node, x->name, "%.60s:%d: %.80s: %.200s", e->file, e->line, e->path,
                         e->text);
    }
    bough_arena_destroy(own);
}

void *bough_verify_read(bough_arena *arena, const char *path, const bough_node *root, bough_errors *errors) {
    bough_verify *v = bough_arena_take(arena, sizeof *v);
    bough_schema_reader reader = {.arena = arena, .errors = errors, .directory = ""};
    bough_schema_read(&reader, &verify_schema, root, v);
    if (errors->n + errors->dropped > 0) return v;
    for (int i = 0; i < v->n_case; i++) {
        v->cases[i].scene = bough_study_path(arena, path, v->cases[i].scene_name);
        check_scene(arena, &v->cases[i], errors);
    }
    return v;
}
