// The keys of loads, springs, bushings, closures, markers, sensors and turbine, and the checks of loads.
#include "apps/bough/scene/scene_internal.h"

// -- reading --------------------------------------------------------------------------------------

// field: the load
static void read_load_place(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_load *load = field;
    const char *text = node->kind == BOUGH_SCALAR ? node->text : "";
    char why[160] = "";
    double plain;
    load->place = BOUGH_SCENE_AT_TIP;
    if (strcmp(text, "tip") == 0) return;
    load->place = BOUGH_SCENE_AT_VERTEX;
    if (bough_whole_number(text, &load->vertex)) return;
    load->place = BOUGH_SCENE_AT_SPAN;
    bool unit = !bough_quantity(text, BOUGH_PURE_NUMBER, &plain, why);
    if (unit && bough_quantity(text, BOUGH_LENGTH, &load->span[0], why)) return;
    bough_schema_expected(r, node, "'tip', the number of a vertex or a length with its unit, as '30 m'");
}

static bool is_spread(const bough_scene_load *load) { return bough_node_find(load->node, "along") != NULL; }

// Three numbers, with or without a unit.
static void read_three(bough_schema_reader *r, const bough_node *node, bough_dimension dimension,
                       double *values) {
    const bough_key key = {.kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = dimension};
    bough_schema_value(r, &key, node, values);
}

// field: the load; a table over time in the key's dimension
static void read_load_table(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_load *load = field;
    bough_scene_table table;
    if (!bough_scene_read_table(r, node, r->key->dimension, &table)) return;
    load->n_time = table.n_time;
    load->times = table.times;
    load->values = table.values;
}

// field: the load; a number or a table over time in the key's dimension
static void read_load_amount(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_load *load = field;
    if (node->kind == BOUGH_MAPPING) {
        read_load_table(r, node, load);
    } else {
        load->amount = bough_schema_number(r, node, r->key->dimension);
    }
}

static void read_load_force(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_load *load = field;
    if (bough_node_find(load->node, "body") == NULL) {
        read_load_amount(r, node, load);
    } else {
        read_three(r, node, is_spread(load) ? BOUGH_LINE_FORCE : BOUGH_FORCE, load->wrench);
    }
}

static void read_load_moment(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_load *load = field;
    read_three(r, node, is_spread(load) ? BOUGH_LINE_MOMENT : BOUGH_MOMENT, load->wrench + 3);
}

// -- checks within a load -------------------------------------------------------------------------

// Exactly one of two keys must be given.
static bool check_either(bough_schema_reader *r, const bough_node *load, const char *a, const char *b) {
    const bough_node *first = bough_node_find(load, a), *second = bough_node_find(load, b);
    if ((first == NULL) != (second == NULL)) return true;
    bough_schema_error(r, load, "", "expected either '%s' or '%s'%s", a, b,
                       first == NULL ? "" : ", got both");
    return false;
}

static void check_joint_keys(bough_schema_reader *r, const bough_node *load) {
    check_either(r, load, "torque", "force");
    bough_scene_refuse(r, load, "at|along|moment|frame|factor|point|end_force|end_moment",
                       "only used with 'body'");
}

// Values at the end are by default those at the start.
static void read_ends(bough_schema_reader *r, bough_scene_load *load) {
    if (!is_spread(load)) bough_scene_refuse(r, load->node, "end_force|end_moment", "only used with 'along'");
    for (int c = 0; c < 6; c++)
        if (bough_node_find(load->node, c < 3 ? "end_force" : "end_moment") == NULL)
            load->end[c] = load->wrench[c];
}

static void check_body_keys(bough_schema_reader *r, bough_scene_load *load) {
    bough_scene_refuse(r, load->node, "torque", "only used with 'joint'");
    if (bough_node_find(load->node, "at") != NULL && !check_either(r, load->node, "at", "along")) {
        return;
    }
    if (load->n_time > 0) bough_scene_refuse(r, load->node, "ramp", "only used without 'factor'");
    if (bough_node_find(load->node, "force") == NULL && bough_node_find(load->node, "moment") == NULL &&
        bough_node_find(load->node, "end_force") == NULL &&
        bough_node_find(load->node, "end_moment") == NULL) {
        bough_schema_error(r, load->node, "", "expected a 'force' or a 'moment' or both");
    }
    read_ends(r, load);
    if (!is_spread(load)) return;
    load->place = BOUGH_SCENE_ALONG;
    if (load->span[1] > load->span[0]) return;
    bough_schema_error(r, load->node, "along", "must end after it starts, got [%g m, %g m]", load->span[0],
                       load->span[1]);
}

static void check_load(bough_schema_reader *r, void *item) {
    bough_scene_load *load = item;
    if (!check_either(r, load->node, "joint", "body")) return;
    if (load->body_name == NULL) {
        check_joint_keys(r, load->node);
    } else {
        check_body_keys(r, load);
    }
    bough_scene_check_ramp(r, load->node, load->ramp);
    if (load->input == NULL || (load->n_time == 0 && load->ramp[1] == 0)) return;
    bough_schema_error(r, load->node, "input", "only without a ramp or a table");
}

// -- checks against the body ----------------------------------------------------------------------

double bough_scene_arc_length(const bough_scene_structure *s) {
    double sum = 0;
    if (s->n_station == 1) return s->length;
    for (int k = 1; k < s->n_station; k++) {
        sum += bough_norm(bough_sub(s->station[k].def.position, s->station[k - 1].def.position));
    }
    return sum;
}

// The load must act on the rod, up to rounding of its length.
static void check_place(bough_schema_reader *r, const bough_scene_load *load, const bough_scene_rod *rod) {
    double length = bough_scene_arc_length(&rod->structure), most = length * (1 + 1e-9);
    if (load->place == BOUGH_SCENE_AT_VERTEX && (load->vertex < 0 || load->vertex > rod->n_segment)) {
        bough_schema_error(r, load->node, "at", "'%s' has the vertices 0 to %d, got %d", load->body_name,
                           rod->n_segment, load->vertex);
    }
    if (load->place == BOUGH_SCENE_AT_SPAN && (load->span[0] > most || load->span[0] < 0)) {
        bough_schema_error(r, load->node, "at", "'%s' is %g m long, got %g m", load->body_name, length,
                           load->span[0]);
    }
    if (is_spread(load) && load->span[1] > most) {
        bough_schema_error(r, load->node, "along", "'%s' is %g m long, got %g m", load->body_name, length,
                           load->span[1]);
    }
}

static void check_rigid_load(bough_schema_reader *r, const bough_scene_load *load) {
    bough_scene_refuse(r, load->node, "at|along", "'%s' is rigid: give the 'point'", load->body_name);
    if (load->frame != BOUGH_SCENE_LOAD_FOLLOWER) return;
    bough_schema_error(r, load->node, "frame", "'%s' is rigid: 'frame: body' rotates with it",
                       load->body_name);
}

void bough_scene_check_body_load(bough_schema_reader *r, const bough_scene *scene,
                                 const bough_scene_load *load) {
    const bough_scene_body *body = &scene->body[load->body];
    if (body->fidelity == BOUGH_SCENE_RIGID) check_rigid_load(r, load);
    if (!bough_scene_is_flexible(body)) return;
    if (body->fidelity == BOUGH_SCENE_FMU) {
        bough_schema_error(r, load->node, "body", "'%s' is an FMU: loads act on rigid bodies and rods",
                           load->body_name);
        return;
    }
    bough_scene_refuse(r, load->node, "point", "only used with a rigid body");
    if (!check_either(r, load->node, "at", "along")) return;
    if (body->fidelity != BOUGH_SCENE_ROD && load->frame == BOUGH_SCENE_LOAD_FOLLOWER) {
        bough_schema_error(r, load->node, "frame",
                           "'%s' is a modal body, on which loads do not turn with its sections: make"
                           " it a rod or give 'frame: body'",
                           load->body_name);
    }
    if (body->rod.structure.n_station > 0) check_place(r, load, &body->rod);
}

// -- keys -----------------------------------------------------------------------------------------

// clang-format would give each field of a key a line of its own:
// clang-format off

#define FILLS bough_scene_load
const bough_schema bough_scene_load_schema = {.name = "a load", .check = check_load, KEYS(
    {NAMED("joint", TEXT), AT(joint_name), .example = "hub",
     .help = "load on a joint: name of the body that the joint carries"},
    {NAMED("torque", CUSTOM), .read = read_load_amount, UNIT(MOMENT),
     .form = "number or {times: [...], values: [...]}", .example = "-11.9 MN m",
     .help = "about the axis of a revolute joint"},
    {NAMED("body", TEXT), AT(body_name), .example = "blade1",
     .help = "load on a rod or a rigid body: name of the body"},
    {KEY(VECTOR, point), .count = 3, UNIT(LENGTH), .fallback = ZERO3, .example = "[0, 0, 1.5 m]",
     .help = "of a rigid body, in its frame"},
    {NAMED("at", CUSTOM), .read = read_load_place,
     .form = "tip, a vertex' number or a length as '30 m'", .example = "30 m",
     .help = "place on the rod, counted from the root"},
    {NAMED("along", VECTOR), AT(span), .count = 2, UNIT(LENGTH), .range = ">= 0",
     .example = "[40 m, 61.5 m]", .help = "range of a distributed load; replaces 'at'"},
    {NAMED("force", CUSTOM), .read = read_load_force, UNIT(FORCE),
     .form = "number, {times: [...], values: [...]} or 3 numbers (per metre with 'along')",
     .example = "12 kN", .help = "along the axis of a prismatic joint, or on the body"},
    {NAMED("moment", CUSTOM), .read = read_load_moment,
     .form = "3 numbers in N m, in N m/m with 'along'", .example = "[0, 0, 5 kN m]",
     .help = "on the body"},
    {NAMED("end_force", VECTOR), AT(end), .count = 3, UNIT(LINE_FORCE), .fallback = ZERO3,
     .example = "[2 kN/m, 0, 0]",
     .help = "with 'along': force at the end of the range, if it differs from 'force' at the "
             "start; linear between"},
    {NAMED("end_moment", VECTOR), AT(end[3]), .count = 3, UNIT(LINE_MOMENT), .fallback = ZERO3,
     .example = "[0, 0, 100]",
     .help = "with 'along': moment at the end of the range, if it differs from 'moment' at the "
             "start; linear between"},
    {NAMED("factor", CUSTOM), .read = read_load_table,
     .form = "{times: [...], values: [...]}", .example = "{times: [0, 1, 2], values: [0, 1, 0]}",
     .help = "on a body: factor of the load over time, linear between the times and constant "
             "outside; replaces 'ramp'"},
    {KEY(CHOICE, frame),
     CHOICES([BOUGH_SCENE_LOAD_GROUND] = "ground", [BOUGH_SCENE_LOAD_BODY] = "body",
             [BOUGH_SCENE_LOAD_FOLLOWER] = "follower"), .fallback = "ground",
     .help = "axes of the load on a body: ground, body, or follower: the section axes of a rod, so "
             "that the load rotates with the section"},
    RAMP,
    {KEY(TEXT, input), .example = "brake",
     .help = "name of an input, by which another program sets the load between steps: torque or "
             "force on a joint; on a body six inputs, whose names end with Fx, Fy, Fz, Mx, My, Mz; "
             "the values of the scene are the start values"},
)};
#undef FILLS

#define FILLS bough_scene_connector
const bough_schema bough_scene_spring_schema = {.name = "a spring", KEYS(
    {KEY(TEXT, name), .required = true, .example = "stay",
     .help = "name of its channels, which end with Len and Frc"},
    {NAMED("from", TEXT), AT(body_name[0]), .required = true, .example = "ground",
     .help = "name of a rigid body, or ground"},
    {NAMED("from_point", VECTOR), AT(point[0]), .count = 3, UNIT(LENGTH), .fallback = ZERO3,
     .example = "[10, 0, 0]", .help = "in that body's frame"},
    {NAMED("to", TEXT), AT(body_name[1]), .required = true, .example = "mast",
     .help = "name of another rigid body, or ground"},
    {NAMED("to_point", VECTOR), AT(point[1]), .count = 3, UNIT(LENGTH), .fallback = ZERO3,
     .example = "[0, 0, 20]", .help = "in that body's frame; the two points must never coincide"},
    {NAMED("stiffness", NUMBER), AT(spring.stiffness), UNIT(STIFFNESS), .range = ">= 0", .fallback = "0", .example = "3 kN/m",
     .help = "of the spring"},
    {NAMED("damping", NUMBER), AT(spring.damping), .range = ">= 0", .fallback = "0", .example = "150",
     .help = "of the damper parallel to the spring, in N s/m"},
    {NAMED("length", NUMBER), AT(spring.length), UNIT(LENGTH), .range = ">= 0", .fallback = "0", .example = "21.5 m",
     .help = "length of the spring without force"},
)};

#define THREE(key, member, what)                                                                             \
    {NAMED(key, VECTOR), AT(bushing.member), .count = 3, .range = ">= 0", .fallback = ZERO3,                    \
     .example = "[1e6, 1e6, 2e6]", .help = what}
const bough_schema bough_scene_bushing_schema = {.name = "a bushing", KEYS(
    {KEY(TEXT, name), .required = true, .example = "yaw_bearing",
     .help = "name of its channels FrcX to MomZ: force and moment on the second body, in the first "
             "body's axes"},
    {NAMED("from", TEXT), AT(body_name[0]), .required = true, .example = "tower",
     .help = "name of a rigid body, or ground; the bushing's axes are those of this body"},
    {NAMED("to", TEXT), AT(body_name[1]), .required = true, .example = "nacelle",
     .help = "name of the second body; the bushing is free of force in the initial position"},
    {KEY(VECTOR, point), .count = 3, UNIT(LENGTH), .fallback = ZERO3, .example = "[0, 0, 87.6]",
     .help = "in the first body's frame"},
    THREE("stiffness", stiffness[0], "along x, y, z, in N/m"),
    THREE("damping", damping[0], "along x, y, z, in N s/m"),
    THREE("rotational_stiffness", stiffness[3],
          "about x, y, z, in N m/rad, by the rotation vector (below 180 deg)"),
    THREE("rotational_damping", damping[3], "about x, y, z, in N m s/rad"),
)};
#undef THREE

const bough_schema bough_scene_closure_schema = {.name = "a closure", KEYS(
    {KEY(TEXT, name), .required = true, .example = "pin",
     .help = "name of its channels Fx to Mz: force and moment on 'to', in the joint's frame there"},
    {KEY(CHOICE, kind), .required = true,
     CHOICES("fixed", "revolute", "prismatic", "spherical", "cylindrical", "universal", "planar"),
     .help = "kind of joint; other joints may already prevent some of the motions that it prevents"},
    {NAMED("from", TEXT), AT(body_name[0]), .required = true, .example = "coupler",
     .help = "name of a rigid body, or ground"},
    {NAMED("from_placement", CUSTOM), AT(placement[0]), .read = bough_scene_read_placement,
     .form = PLACEMENT_FORM, .fallback = "[]", .example = "[move x 0.5 m]",
     .help = "placement of the joint's frame in that body's frame"},
    {NAMED("to", TEXT), AT(body_name[1]), .required = true, .example = "ground",
     .help = "name of another rigid body, or ground"},
    {NAMED("to_placement", CUSTOM), AT(placement[1]), .read = bough_scene_read_placement,
     .form = PLACEMENT_FORM, .fallback = "[]", .example = "[move x 1 m]",
     .help = "placement of the joint's frame in that body's frame; the two frames must almost "
             "coincide at the start: small motions of all joints close the rest, and joints "
             "without a speed follow"},
    {KEY(CHOICE, axis), AXIS, .required = true,
     WHEN("kind", "revolute|prismatic|cylindrical|universal|planar"),
     .help = "axis of the motion, as of a joint; of a universal joint in the frame of 'from'"},
    {KEY(CHOICE, second_axis), AXIS, .required = true, WHEN("kind", "universal"),
     .help = "normal to the axis, in the frame of 'to'"},
)};
#undef FILLS

#define FILLS bough_scene_marker
const bough_schema bough_scene_marker_schema = {.name = "a marker", KEYS(
    {KEY(TEXT, name), .required = true, .example = "tower_top",
     .help = "name of its channels X, Y, Z in ground axes"},
    {NAMED("body", TEXT), AT(body_name), .required = true, .example = "nacelle",
     .help = "name of a rigid body, or ground"},
    {KEY(VECTOR, point), .count = 3, UNIT(LENGTH), .fallback = ZERO3, .example = "[0, 0, 1 m]",
     .help = "in that body's frame"},
)};
#undef FILLS

#define FILLS bough_scene_sensor
const bough_schema bough_scene_sensor_schema = {.name = "a sensor", KEYS(
    {NAMED("body", TEXT), AT(body_name), .required = true, .example = "blade1",
     .help = "name of a body of fidelity rod"},
    {KEY(NUMBERS, at), UNIT(LENGTH), .range = ">= 0", .required = true, .count = 1, COUNT_AT(n_at),
     .example = "[20 m, 40 m]",
     .help = "distances from the root, along the rod; the first place is number 1"},
)};
#undef FILLS

#define FILLS bough_scene_turbine
const bough_schema bough_scene_turbine_schema = {.name = "the turbine", KEYS(
    {NAMED("rotor", TEXT), AT(rotor_name), .required = true, .example = "hub",
     .help = "body on the revolute joint of the rotor"},
    {NAMED("blades", TEXTS), AT(blade_name), .required = true, .count = 1, COUNT_AT(n_blade),
     .example = "[blade1, blade2, blade3]", .help = "bodies with a rod, carried by the rotor"},
)};
#undef FILLS
// clang-format on
