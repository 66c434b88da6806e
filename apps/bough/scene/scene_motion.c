// The prescribed motion of a joint: its speed or its position, constant, by a ramp or by a table.
#include "apps/bough/scene/scene_internal.h"

// The two motions of a joint; each table of keys begins at the first.
typedef struct motions {
    bough_scene_motion first, second;
} motions;

// -- a table or a ramp ----------------------------------------------------------------------------

// Reads a mapping of such keys; false after an error.
static bool read_form(bough_schema_reader *r, const bough_node *node, const bough_schema *schema,
                      void *item) {
    int before = r->errors->n + r->errors->dropped;
    bough_schema_read(r, schema, node, item);
    return r->errors->n + r->errors->dropped == before;
}

// clang-format off
bool bough_scene_read_table(bough_schema_reader *r, const bough_node *node, bough_dimension unit,
                            bough_scene_table *table) {
#define FILLS bough_scene_table
    const bough_schema schema = {.name = "a table", KEYS(
        {KEY(NUMBERS, times), UNIT(TIME), .range = ">= 0", .count = 2, .required = true, .increasing = true,
         COUNT_AT(n_time)},
        {KEY(NUMBERS, values), .dimension = unit, .count = 2, .required = true, COUNT_AT(n_value)},
    )};
#undef FILLS
    *table = (bough_scene_table){0};
    if (!read_form(r, node, &schema, table)) return false;
    if (table->n_time != table->n_value) {
        bough_schema_error(r, node, "", "%d times, but %d values", table->n_time, table->n_value);
        return false;
    }
    return true;
}

typedef struct ramp {
    const bough_node *node;
    double from, to, ramp[2];
} ramp;

static void read_ramp(bough_schema_reader *r, const bough_node *node, bough_dimension unit,
                      bough_motion_def *def) {
#define FILLS ramp
    const bough_schema schema = {.name = "a ramp", KEYS(
        {KEY(NUMBER, from), .dimension = unit, .fallback = "0"},
        {KEY(NUMBER, to), .dimension = unit, .required = true},
        {KEY(VECTOR, ramp), UNIT(TIME), .count = 2, .range = ">= 0", .required = true},
    )};
#undef FILLS
    ramp x = {0};
    if (!read_form(r, node, &schema, &x)) return;
    if (!(x.ramp[1] > x.ramp[0])) {
        bough_schema_error(r, node, "ramp",
                           "must end after it starts, got [%g s, %g s]", x.ramp[0], x.ramp[1]);
    }
    def->from = x.from;
    def->to = x.to;
    def->start = x.ramp[0];
    def->end = x.ramp[1];
}
// clang-format on

// A number, a ramp or a table, in the key's dimension.
static void read_values(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_motion *motion = field;
    bough_dimension unit = r->key->dimension;
    if (node->kind != BOUGH_MAPPING) {
        motion->def.from = motion->def.to = bough_schema_number(r, node, unit);
    } else if (bough_node_find(node, "times") != NULL || bough_node_find(node, "values") != NULL) {
        bough_scene_table table;
        if (!bough_scene_read_table(r, node, unit, &table)) return;
        motion->def.n = table.n_time;
        motion->def.times = table.times;
        motion->def.values = table.values;
    } else {
        read_ramp(r, node, unit, &motion->def);
    }
}

// -- the motion -----------------------------------------------------------------------------------

// Speed or position may be given, not both.
static void check_one(bough_schema_reader *r, const bough_node *node, const char *speed, const char *place,
                      bough_scene_motion *motion) {
    bool of_speed = bough_node_find(node, speed) != NULL;
    bool of_place = bough_node_find(node, place) != NULL;
    motion->def.speed = of_speed;
    motion->def.given = of_speed || of_place;
    motion->node = motion->def.given ? node : NULL;
    if (of_speed && of_place) {
        bough_schema_error(r, node, "", "expected either '%s' or '%s', got both", speed, place);
    }
}

static void check_motion(bough_schema_reader *r, void *item) {
    bough_scene_motion *motion = item;
    const bough_node *node = motion->node;
    check_one(r, node, "speed", bough_node_find(node, "angle") ? "angle" : "position", motion);
    bool constant = motion->def.n == 0 && !(motion->def.end > motion->def.start);
    if (motion->input != NULL && (motion->def.speed || !constant)) {
        bough_schema_error(r, node, "input", "only with a constant initial position");
    }
    if (motion->def.given) return;
    bough_schema_error(r, node, "", "expected the speed or the position of the joint");
}

static void check_pair(bough_schema_reader *r, void *item) {
    motions *pair = item;
    const bough_node *node = pair->first.node;
    check_one(r, node, "speed", "position", &pair->first);
    check_one(r, node, "angular_speed", "angle", &pair->second);
    if (node->n == 0) bough_schema_error(r, node, "", "expected a speed or a position");
}

// clang-format off
#define FORM .form = "a number, {from: 0, to: ..., ramp: [...]} or {times: [...], values: [...]}"
#define FILLS bough_scene_motion
#define INPUT                                                                                      \
    {KEY(TEXT, input), .example = "yaw",                                                           \
     .help = "with a constant place: name by which it is set between steps"}
#define TURN                                                                                       \
    {NAMED("speed", CUSTOM), .read = read_values, UNIT(ANGULAR_SPEED), FORM},                      \
    {NAMED("angle", CUSTOM), .read = read_values, UNIT(ANGLE), FORM}
static const bough_schema revolute_motion = {
    .name = "the motion of a revolute joint", .check = check_motion, KEYS(TURN, INPUT)};
static const bough_schema axis_motion = {
    .name = "the motion about an axis", .check = check_motion, KEYS(TURN)};
static const bough_schema prismatic_motion = {
    .name = "the motion of a prismatic joint", .check = check_motion, KEYS(
    {NAMED("speed", CUSTOM), .read = read_values, UNIT(SPEED), FORM},
    {NAMED("position", CUSTOM), .read = read_values, UNIT(LENGTH), FORM},
    INPUT,
)};
#undef FILLS
#define FILLS motions
static const bough_schema cylindrical_motion = {
    .name = "the motion of a cylindrical joint", .check = check_pair, KEYS(
    {NAMED("speed", CUSTOM), .read = read_values, UNIT(SPEED)},
    {NAMED("position", CUSTOM), .read = read_values, UNIT(LENGTH)},
    {NAMED("angular_speed", CUSTOM), AT(second), .read = read_values, UNIT(ANGULAR_SPEED)},
    {NAMED("angle", CUSTOM), AT(second), .read = read_values, UNIT(ANGLE)},
)};
static const bough_schema universal_motion = {.name = "the motion of a universal joint", KEYS(
    {KEY(MAPPING, first), .of = &axis_motion},
    {KEY(MAPPING, second), .of = &axis_motion},
)};
#undef FILLS
// clang-format on

// field: the joint, whose kind is read before
void bough_scene_read_motion(bough_schema_reader *r, const bough_node *node, void *field) {
    static const bough_schema *const of_kind[] = {[BOUGH_JOINT_REVOLUTE] = &revolute_motion,
                                                  [BOUGH_JOINT_PRISMATIC] = &prismatic_motion,
                                                  [BOUGH_JOINT_CYLINDRICAL] = &cylindrical_motion,
                                                  [BOUGH_JOINT_UNIVERSAL] = &universal_motion};
    bough_scene_joint *joint = field;
    bough_schema_read(r, of_kind[joint->kind], node, joint->motion);
}

// Initial position and speed follow from the motion and must not be given.
void bough_scene_check_motion(bough_schema_reader *r, const bough_scene_joint *joint) {
    static const char why[] = "not allowed with the joint's motion, from which it follows";
    const bough_scene_motion *first = &joint->motion[0], *second = &joint->motion[1];
    bool placed = first->node != NULL && !first->def.speed;
    bool cylindrical = joint->kind == BOUGH_JOINT_CYLINDRICAL; // its angle is the second motion's
    if (first->node != NULL) bough_scene_refuse(r, joint->node, "speed", why);
    if (placed) bough_scene_refuse(r, joint->node, cylindrical ? "position" : "position|angle", why);
    if (!cylindrical || second->node == NULL) return;
    bough_scene_refuse(r, joint->node, second->def.speed ? "angular_speed" : "angular_speed|angle", why);
}
