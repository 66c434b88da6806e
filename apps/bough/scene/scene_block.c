// A turbine in one block, `turbine: {blades: 3, ...}`, is replaced in the tree of the text by the bodies
// tower, nacelle, hub, blade1, blade2, ... before the scene is read. The block's keys for a part are merged
// into its body, then those of `bodies` of the same name.
#include "apps/bough/config/base.h"
#include "apps/bough/scene/scene_internal.h"

typedef struct block {
    const bough_node *node;
    int n_blade;
    double hub_radius, overhang, shaft_height, height; // [m]
    double tilt, cone, pitch;                          // [rad]
    double speed;                                      // [rad/s]
    bough_node *tower, *nacelle, *hub, *blade; // keys that are merged into the bodies below; NULL: none
} block;

static void keep(bough_schema_reader *r, const bough_node *node, void *field) {
    if (node->kind != BOUGH_MAPPING) {
        bough_schema_error(r, node, "", "expected a mapping with keys of a body");
    } else if (bough_node_find(node, "name") != NULL) {
        bough_schema_error(r, node, "name", "the block names its bodies itself");
    } else {
        *(const bough_node **)field = node;
    }
}

// clang-format off
#define PART .form = "mapping with keys of a body", .read = keep
#define FILLS block
const bough_schema bough_scene_block_schema = {.name = "a turbine in one block", KEYS(
    {NAMED("blades", INTEGER), AT(n_blade), .range = "[1, 48]", .required = true, .example = "3",
     .help = "their number; they are equal and evenly spaced, blade1 points up"},
    {KEY(NUMBER, hub_radius), UNIT(LENGTH), .range = "> 0", .required = true, .example = "1.5 m",
     .help = "from the shaft's axis to the blade roots; aero.hub_radius too where that is not given"},
    {KEY(NUMBER, overhang), UNIT(LENGTH), .fallback = "0", .example = "5.0191 m",
     .help = "along the shaft from the tower's axis upwind to the rotor's centre; downwind rotors: negative"},
    {KEY(NUMBER, tilt), UNIT(ANGLE), .fallback = "0", .example = "5 deg",
     .help = "of the shaft, positive: its upwind end is higher"},
    {KEY(NUMBER, cone), UNIT(ANGLE), .fallback = "0", .example = "2.5 deg",
     .help = "of the blades out of the rotor's plane, positive: upwind"},
    {KEY(NUMBER, shaft_height), UNIT(LENGTH), .fallback = "0", .example = "1.96256 m",
     .help = "of the shaft above the tower's top, on the tower's axis"},
    {NAMED("tower_height", NUMBER), AT(height), UNIT(LENGTH), .range = ">= 0", .fallback = "0", .example = "87.6 m",
     .help = "of a rigid tower; a tower with a rod ends where the rod ends"},
    {KEY(NUMBER, pitch), UNIT(ANGLE), .word = "controlled", .fallback = "0", .example = "6.5 deg",
     .help = "of all blades, positive towards feather; controlled: they hang on joints about their axes that "
             "'control' steers"},
    {KEY(NUMBER, speed), UNIT(ANGULAR_SPEED), .fallback = "0", .example = "9.16 rpm",
     .help = "of the rotor at the start, positive: clockwise seen from upwind"},
    {KEY(CUSTOM, tower), PART, .example = "{rod: {table: tower-structure.yaml, segments: 10}}",
     .help = "a rod where it has one, else rigid"},
    {KEY(CUSTOM, nacelle), PART, .example = "{mass: 240 t, centre_of_mass: [1.9, 0, 1.75]}",
     .help = "rigid, fixed to the tower's top unless it has a joint of another kind"},
    {KEY(CUSTOM, hub), PART, .example = "{mass: 56780 kg, inertia: [5.14e6, 2.6e6, 2.6e6]}",
     .help = "rigid, on the shaft's revolute joint about x"},
    {KEY(CUSTOM, blade), PART, .required = true, .example = "{rod: {table: blade-structure.yaml, segments: 24}}",
     .help = "each of them a rod"},
)};
#undef FILLS
// clang-format on

// -- text -----------------------------------------------------------------------------------------

// A value as text, with the fewest digits that give the same number when it is read.
static const char *written(bough_arena *arena, double value, double unit, const char *name,
                           bough_dimension dimension) {
    char text[60], why[160];
    for (int digits = 1; digits <= 17; digits++) {
        double again;
        snprintf(text, sizeof text, "%.*g %s", digits, value / unit, name);
        if (bough_quantity(text, dimension, &again, why) && again == value)
            return bough_arena_string(arena, text);
    }
    const char *si = bough_dimension_unit(dimension);
    return bough_arena_print(arena, "%.17g %s", value, si);
}

static const char *length(bough_arena *arena, double value) {
    return written(arena, value, 1, "m", BOUGH_LENGTH);
}

static const char *angle(bough_arena *arena, double value) {
    return written(arena, value, BOUGH_DEGREE, "deg", BOUGH_ANGLE);
}

static const char *support_text(bough_arena *arena, const block *b) {
    bool rod = bough_node_find(b->tower, "rod") != NULL;
    const char *top = rod ? "" : bough_arena_print(arena, "move z %s", length(arena, b->height));
    const char *speed =
        bough_arena_print(arena, ", speed: %s", written(arena, b->speed, 1, "rad/s", BOUGH_ANGULAR_SPEED));
    return bough_arena_print(
        arena,
        "- {name: tower, fidelity: %s, joint: {kind: fixed, parent: ground}}\n"
        "- {name: nacelle, fidelity: rigid, joint: {kind: fixed, parent: tower, placement: [%s]}}\n"
        "- {name: hub, fidelity: rigid, joint: {kind: revolute, parent: nacelle, axis: x, placement: "
        "[move z %s, rotate y %s, move x %s]%s}}\n",
        rod ? "rod" : "rigid", top, length(arena, b->shaft_height), angle(arena, b->tilt),
        length(arena, -b->overhang), bough_node_find(b->node, "speed") ? speed : "");
}

static const char *blade_text(bough_arena *arena, const block *b, int k) {
    const bough_node *pitch = bough_node_find(b->node, "pitch");
    bool controlled = pitch != NULL && strcmp(pitch->text, "controlled") == 0;
    const char *fixed =
        pitch == NULL || controlled ? "" : bough_arena_print(arena, ", pitch: %s", angle(arena, b->pitch));
    return bough_arena_print(arena,
                             "- {name: blade%d, fidelity: rod, joint: {kind: %s, parent: hub, "
                             "placement: [rotate x %.17g deg, rotate y %s, move z %s]}%s}\n",
                             k + 1, controlled ? "revolute, axis: z, motion: {angle: 0 deg}" : "fixed",
                             360.0 * k / b->n_blade, angle(arena, -b->cone), length(arena, b->hub_radius),
                             fixed);
}

// -- the tree -------------------------------------------------------------------------------------

static void merge_parts(bough_schema_reader *r, const block *b, bough_node *list) {
    for (int i = 0; i < list->n; i++) {
        bough_node *const part[] = {b->tower, b->nacelle, b->hub, b->blade};
        bough_node *differs = part[i < 3 ? i : 3];
        if (differs != NULL)
            list->value[i] = bough_node_merge(r->arena, r->errors, "turbine", list->value[i], differs);
    }
}

// {bodies: ..., turbine: {rotor: hub, blades: [blade1, ...]}, aero: ...}
static bough_node *generate(bough_schema_reader *r, const block *b) {
    const char *bodies = support_text(r->arena, b), *names = "blade1";
    for (int k = 0; k < b->n_blade; k++) {
        bodies = bough_arena_print(r->arena, "%s%s", bodies, blade_text(r->arena, b, k));
        if (k > 0) names = bough_arena_print(r->arena, "%s, blade%d", names, k + 1);
    }
    const char *text = bough_arena_print(
        r->arena, "bodies:\n%sturbine: {rotor: hub, blades: [%s]}\naero: {hub_radius: %s}\n", bodies, names,
        length(r->arena, b->hub_radius));
    bough_node *tree = bough_text_parse(r->arena, "turbine", text, strlen(text), r->errors);
    if (tree == NULL) return NULL;
    bough_node_move(tree, b->node);
    merge_parts(r, b, bough_node_find(tree, "bodies"));
    return tree;
}

// The scene with the block's bodies, into which its own bodies of the same name are merged.
static bough_node *expand(bough_schema_reader *r, const block *b, const bough_node *root) {
    bough_node *made = generate(r, b), *scene = bough_node_start(r->arena, root, root->n + 1);
    if (made == NULL) return NULL;
    if (bough_node_find(root, "bodies") == NULL) bough_node_append(scene, made->key[0], made->value[0]);
    for (int i = 0; i < root->n; i++) {
        bough_node *value = root->value[i], *base = bough_node_find(made, root->key[i]->text);
        if (strcmp(root->key[i]->text, "turbine") == 0) {
            value = base;
        } else if (base != NULL) {
            value = bough_node_merge(r->arena, r->errors, root->key[i]->text, base, value);
        }
        if (value != NULL) bough_node_append(scene, root->key[i], value);
    }
    return scene;
}

bough_node *bough_scene_expand(bough_schema_reader *r, bough_node *root) {
    const bough_node *turbine = bough_node_find(root, "turbine"),
                     *blades = bough_node_find(turbine, "blades");
    if (blades == NULL || blades->kind != BOUGH_SCALAR) return root;
    int before = r->errors->n;
    block b = {0};
    bough_link_at(r, "turbine");
    bough_schema_read(r, &bough_scene_block_schema, turbine, &b);
    bough_link_at(r, "%s", "");
    if (r->errors->n != before) return NULL;
    if (b.height > 0 && bough_node_find(b.tower, "rod") != NULL)
        bough_schema_error(r, root, "turbine.tower_height", "only of a rigid tower: this one has a rod");
    return expand(r, &b, root);
}
