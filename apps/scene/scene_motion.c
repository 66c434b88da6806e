// The prescribed motion of a joint: its speed or itself, constant, by a ramp or by a table.
#include "apps/scene/scene_internal.h"

#include <math.h>
#include <string.h>

// A cylindrical joint's, whose schema begins with the node of the first
typedef struct motion_pair {
    bough_scene_motion first, second;
} motion_pair;

typedef struct universal_pair {
    const bough_node *node;
    bough_scene_motion first, second;
} universal_pair;

// -- a table or a ramp ----------------------------------------------------------------------------

typedef struct table {
    const bough_node *node;
    int n_time, n_value;
    double *times, *values;
} table;

typedef struct ramp {
    const bough_node *node;
    double from, to, ramp[2];
} ramp;

// clang-format off
#define TABLE(unit)                                                                                \
    (const bough_key[]){                                                                           \
        {.name = "times", .kind = BOUGH_KEY_NUMBERS, .dimension = BOUGH_TIME, .range = ">= 0",     \
         .count = 2, .required = true, .offset = offsetof(table, times),                           \
         .count_offset = offsetof(table, n_time)},                                                 \
        {.name = "values", .kind = BOUGH_KEY_NUMBERS, .dimension = unit, .count = 2,               \
         .required = true, .offset = offsetof(table, values),                                      \
         .count_offset = offsetof(table, n_value)}}
#define RAMP(unit)                                                                                 \
    (const bough_key[]){                                                                           \
        {.name = "from", .kind = BOUGH_KEY_NUMBER, .dimension = unit, .fallback = "0",             \
         .offset = offsetof(ramp, from)},                                                          \
        {.name = "to", .kind = BOUGH_KEY_NUMBER, .dimension = unit, .required = true,              \
         .offset = offsetof(ramp, to)},                                                            \
        {.name = "ramp", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_TIME,            \
         .range = ">= 0", .required = true, .offset = offsetof(ramp, ramp)}}
#define FORMS(unit)                                                                                \
    [unit] = {{.name = "a table", .size = sizeof(table), .n_key = 2, .key = TABLE(unit)},          \
              {.name = "a ramp", .size = sizeof(ramp), .n_key = 3, .key = RAMP(unit)}}
static const struct {
    bough_schema table, ramp;
} forms[] = {FORMS(BOUGH_LENGTH), FORMS(BOUGH_ANGLE), FORMS(BOUGH_SPEED),
             FORMS(BOUGH_ANGULAR_SPEED)};
// clang-format on

static void read_table(bough_schema_reader *r, const bough_node *node, bough_dimension unit,
                       bough_scene_motion *motion) {
    table t = {0};
    int before = r->errors->n + r->errors->dropped;
    bough_schema_read(r, &forms[unit].table, node, &t);
    if (r->errors->n + r->errors->dropped > before || t.times == NULL) return;
    if (t.n_time != t.n_value) {
        bough_schema_error(r, node, "", "%d times, but %d values", t.n_time, t.n_value);
        return;
    }
    for (int i = 1; i < t.n_time; i++) {
        if (t.times[i] > t.times[i - 1]) continue;
        bough_schema_error(r, bough_node_find(node, "times")->value[i], "times", "must increase");
        return;
    }
    motion->def.n = t.n_time;
    motion->def.times = t.times;
    motion->def.values = t.values;
}

static void read_ramp(bough_schema_reader *r, const bough_node *node, bough_dimension unit,
                      bough_scene_motion *motion) {
    ramp x = {0};
    int before = r->errors->n + r->errors->dropped;
    bough_schema_read(r, &forms[unit].ramp, node, &x);
    if (r->errors->n + r->errors->dropped > before) return;
    if (!(x.ramp[1] > x.ramp[0])) {
        bough_schema_error(r, bough_node_find(node, "ramp"), "ramp",
                           "must end after it starts, got [%g s, %g s]", x.ramp[0], x.ramp[1]);
    }
    motion->def.from = x.from;
    motion->def.to = x.to;
    motion->def.start = x.ramp[0];
    motion->def.end = x.ramp[1];
}

// A number, a ramp or a table.
static void read_values(bough_schema_reader *r, const bough_node *node, bough_dimension unit,
                        bough_scene_motion *motion) {
    if (node->kind != BOUGH_MAPPING) {
        motion->def.from = motion->def.to = bough_schema_number(r, node, unit);
    } else if (bough_node_find(node, "times") != NULL || bough_node_find(node, "values") != NULL) {
        read_table(r, node, unit, motion);
    } else {
        read_ramp(r, node, unit, motion);
    }
}

// -- the motion -----------------------------------------------------------------------------------

static void read_angle(bough_schema_reader *r, const bough_node *node, void *field) {
    read_values(r, node, BOUGH_ANGLE, field);
}

static void read_angular_speed(bough_schema_reader *r, const bough_node *node, void *field) {
    read_values(r, node, BOUGH_ANGULAR_SPEED, field);
}

static void read_position(bough_schema_reader *r, const bough_node *node, void *field) {
    read_values(r, node, BOUGH_LENGTH, field);
}

static void read_speed(bough_schema_reader *r, const bough_node *node, void *field) {
    read_values(r, node, BOUGH_SPEED, field);
}

#define FORM .form = "a number, {from: 0, to: ..., ramp: [...]} or {times: [...], values: [...]}"
#define INPUT                                                                                      \
    {.name = "input", .kind = BOUGH_KEY_TEXT, .offset = offsetof(bough_scene_motion, input),       \
     .example = "yaw", .help = "with a constant place: name by which it is set between steps"}
static const bough_key revolute_keys[] = {
    {.name = "speed", .kind = BOUGH_KEY_CUSTOM, .read = read_angular_speed, FORM},
    {.name = "angle", .kind = BOUGH_KEY_CUSTOM, .read = read_angle, FORM},
    INPUT,
};
static const bough_key prismatic_keys[] = {
    {.name = "speed", .kind = BOUGH_KEY_CUSTOM, .read = read_speed, FORM},
    {.name = "position", .kind = BOUGH_KEY_CUSTOM, .read = read_position, FORM},
    INPUT,
};
#undef FORM
#undef INPUT

static const bough_key cylindrical_keys[] = {
    {.name = "speed", .kind = BOUGH_KEY_CUSTOM, .read = read_speed},
    {.name = "position", .kind = BOUGH_KEY_CUSTOM, .read = read_position},
    {.name = "angular_speed", .kind = BOUGH_KEY_CUSTOM, .read = read_angular_speed,
     .offset = offsetof(motion_pair, second)},
    {.name = "angle", .kind = BOUGH_KEY_CUSTOM, .read = read_angle,
     .offset = offsetof(motion_pair, second)},
};

// One of a pair of keys at most, the speed first.
static void check_one(bough_schema_reader *r, const bough_node *node, const char *speed,
                      const char *place, bough_scene_motion *motion) {
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
    if (motion->node == NULL) return;
    motion->def.given = true;
    motion->def.speed = bough_node_find(motion->node, "speed") != NULL;
    bool constant = motion->def.n == 0 && !(motion->def.end > motion->def.start);
    if (motion->input != NULL && (motion->def.speed || !constant)) {
        bough_schema_error(r, bough_node_find(motion->node, "input"), "input",
                           "only with a constant initial position");
    }
    if (motion->node->n == (motion->input != NULL ? 2 : 1)) return;
    bough_schema_error(r, motion->node, "", "expected either the speed or the position of the "
                                        "joint");
}

static void check_pair(bough_schema_reader *r, void *item) {
    motion_pair *pair = item;
    const bough_node *node = pair->first.node;
    check_one(r, node, "speed", "position", &pair->first);
    check_one(r, node, "angular_speed", "angle", &pair->second);
    if (node->n == 0) bough_schema_error(r, node, "", "expected what is prescribed");
}

#define MOTION(what, type, keys, checker)                                                          \
    {.name = what, .size = sizeof(type), .n_key = (int)(sizeof keys / sizeof *keys),               \
     .key = keys, .check = checker}
static const bough_schema revolute_motion =
    MOTION("the motion of a revolute joint", bough_scene_motion, revolute_keys, check_motion);
static const bough_schema prismatic_motion =
    MOTION("the motion of a prismatic joint", bough_scene_motion, prismatic_keys, check_motion);
static const bough_schema cylindrical_motion =
    MOTION("the motion of a cylindrical joint", motion_pair, cylindrical_keys, check_pair);
static const bough_key universal_keys[] = {
    {.name = "first", .kind = BOUGH_KEY_MAPPING, .of = &revolute_motion,
     .offset = offsetof(universal_pair, first)},
    {.name = "second", .kind = BOUGH_KEY_MAPPING, .of = &revolute_motion,
     .offset = offsetof(universal_pair, second)},
};
static const bough_schema universal_motion =
    MOTION("the motion of a universal joint", universal_pair, universal_keys, NULL);

// field: the joint, whose kind is read before
void bough_scene_read_motion(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_joint *joint = field;
    motion_pair pair = {0};
    universal_pair two = {0};
    switch (joint->kind) {
    case BOUGH_JOINT_REVOLUTE:
        bough_schema_read(r, &revolute_motion, node, &joint->motion);
        break;
    case BOUGH_JOINT_PRISMATIC:
        bough_schema_read(r, &prismatic_motion, node, &joint->motion);
        break;
    case BOUGH_JOINT_CYLINDRICAL:
        bough_schema_read(r, &cylindrical_motion, node, &pair);
        joint->motion = pair.first, joint->second_motion = pair.second;
        break;
    default:
        bough_schema_read(r, &universal_motion, node, &two);
        joint->motion = two.first, joint->second_motion = two.second;
        break;
    }
}

static void refuse(bough_schema_reader *r, const bough_scene_joint *joint, const char *key,
                   bool follows) {
    const bough_node *given = bough_node_find(joint->node, key);
    if (given == NULL || !follows) return;
    bough_schema_error(r, given, key, "follows from the joint's motion");
}

// The joint starts where and as fast as its motion says.
void bough_scene_check_motion(bough_schema_reader *r, const bough_scene_joint *joint) {
    const bough_scene_motion *first = &joint->motion, *second = &joint->second_motion;
    bool placed = first->node != NULL && !first->def.speed;
    refuse(r, joint, "speed", first->node != NULL);
    refuse(r, joint, "position", placed);
    if (joint->kind != BOUGH_JOINT_CYLINDRICAL) {
        refuse(r, joint, "angle", placed);
        return;
    }
    refuse(r, joint, "angular_speed", second->node != NULL);
    refuse(r, joint, "angle", second->node != NULL && !second->def.speed);
}
