// The keys of loads, of what joins bodies beside the tree, and of the turbine's names.
#include "apps/bough/scene/scene_internal.h"

// clang-format would give each field of a key a line of its own:
// clang-format off

#define FILLS bough_scene_load
static const bough_key load_keys[] = {
    {NAMED("joint", TEXT), AT(joint_name), .example = "hub",
     .help = "load on a joint: name of the body that the joint carries"},
    {NAMED("torque", CUSTOM), .read = bough_scene_read_load_amount, UNIT(MOMENT),
     .form = "number or {times: [...], values: [...]}", .example = "-11.9 MN m",
     .help = "about the axis of a revolute joint"},
    {NAMED("body", TEXT), AT(body_name), .example = "blade1",
     .help = "load on a rod or a rigid body: name of the body"},
    {KEY(VECTOR, point), .count = 3, UNIT(LENGTH), .fallback = ZERO3, .example = "[0, 0, 1.5 m]",
     .help = "of a rigid body, in its frame"},
    {NAMED("at", CUSTOM), .read = bough_scene_read_load_place,
     .form = "tip, a vertex' number or a length as '30 m'", .example = "30 m",
     .help = "place on the rod, counted from the root"},
    {NAMED("along", VECTOR), AT(span), .count = 2, UNIT(LENGTH), .range = ">= 0",
     .example = "[40 m, 61.5 m]", .help = "range of a distributed load; replaces 'at'"},
    {NAMED("force", CUSTOM), .read = bough_scene_read_load_force, UNIT(FORCE),
     .form = "number, {times: [...], values: [...]} or 3 numbers (per metre with 'along')",
     .example = "12 kN", .help = "along the axis of a prismatic joint, or on the body"},
    {NAMED("moment", CUSTOM), .read = bough_scene_read_load_moment,
     .form = "3 numbers in N m, in N m/m with 'along'", .example = "[0, 0, 5 kN m]",
     .help = "on the body"},
    {KEY(VECTOR, end_force), .count = 3, UNIT(LINE_FORCE), .fallback = ZERO3,
     .example = "[2 kN/m, 0, 0]",
     .help = "with 'along': force at the end of the range, if it differs from 'force' at the "
             "start; linear between"},
    {KEY(VECTOR, end_moment), .count = 3, UNIT(LINE_MOMENT), .fallback = ZERO3,
     .example = "[0, 0, 100]",
     .help = "with 'along': moment at the end of the range, if it differs from 'moment' at the "
             "start; linear between"},
    {NAMED("factor", CUSTOM), .read = bough_scene_read_load_table,
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
};
#undef FILLS
const bough_schema bough_scene_load_schema = {SCHEMA("a load", bough_scene_load, load_keys),
                                         .check = bough_scene_check_load};

#define FILLS bough_scene_spring
static const bough_key spring_keys[] = {
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
    {NAMED("stiffness", NUMBER), AT(def.stiffness), UNIT(STIFFNESS), .range = ">= 0", .fallback = "0", .example = "3 kN/m",
     .help = "of the spring"},
    {NAMED("damping", NUMBER), AT(def.damping), .range = ">= 0", .fallback = "0", .example = "150",
     .help = "of the damper parallel to the spring, in N s/m"},
    {NAMED("length", NUMBER), AT(def.length), UNIT(LENGTH), .range = ">= 0", .fallback = "0", .example = "21.5 m",
     .help = "length of the spring without force"},
};
#undef FILLS
const bough_schema bough_scene_spring_schema = {
    SCHEMA("a spring", bough_scene_spring, spring_keys)};

#define FILLS bough_scene_bushing
#define THREE(key, member, what)                                                                             \
    {NAMED(key, VECTOR), AT(def.member), .count = 3, .range = ">= 0", .fallback = ZERO3,                    \
     .example = "[1e6, 1e6, 2e6]", .help = what}
static const bough_key bushing_keys[] = {
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
};
#undef THREE
#undef FILLS
const bough_schema bough_scene_bushing_schema = {
    SCHEMA("a bushing", bough_scene_bushing, bushing_keys)};

#define FILLS bough_scene_closure
static const bough_key closure_keys[] = {
    {KEY(TEXT, name), .required = true, .example = "pin",
     .help = "name of its channels Fx to Mz: force and moment on 'to', in the joint's frame there"},
    {KEY(CHOICE, kind), .required = true,
     CHOICES("fixed", "revolute", "prismatic", "spherical", "cylindrical", "universal", "planar"),
     .help = "kind of joint; other joints may already prevent some of the motions that it "
             "prevents"},
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
};
#undef FILLS
const bough_schema bough_scene_closure_schema = {
    SCHEMA("a closure", bough_scene_closure, closure_keys)};

#define FILLS bough_scene_marker
static const bough_key marker_keys[] = {
    {KEY(TEXT, name), .required = true, .example = "tower_top",
     .help = "name of its channels X, Y, Z in ground axes"},
    {NAMED("body", TEXT), AT(body_name), .required = true, .example = "nacelle",
     .help = "name of a rigid body, or ground"},
    {KEY(VECTOR, point), .count = 3, UNIT(LENGTH), .fallback = ZERO3, .example = "[0, 0, 1 m]",
     .help = "in that body's frame"},
};
#undef FILLS
const bough_schema bough_scene_marker_schema = {
    SCHEMA("a marker", bough_scene_marker, marker_keys)};

#define FILLS bough_scene_sensor
static const bough_key sensor_keys[] = {
    {NAMED("body", TEXT), AT(body_name), .required = true, .example = "blade1",
     .help = "name of a body of fidelity rod"},
    {KEY(NUMBERS, at), UNIT(LENGTH), .range = ">= 0", .required = true, .count = 1, COUNT_AT(n_at),
     .example = "[20 m, 40 m]",
     .help = "distances from the root, along the rod; the first place is number 1"},
};
#undef FILLS
const bough_schema bough_scene_sensor_schema = {
    SCHEMA("a sensor", bough_scene_sensor, sensor_keys)};

#define FILLS bough_scene_turbine
static const bough_key turbine_keys[] = {
    {NAMED("rotor", TEXT), AT(rotor_name), .required = true, .example = "hub",
     .help = "body on the revolute joint of the rotor"},
    {NAMED("blades", TEXTS), AT(blade_name), .required = true, .count = 1, COUNT_AT(n_blade),
     .example = "[blade1, blade2, blade3]", .help = "bodies with a rod, carried by the rotor"},
};
#undef FILLS
const bough_schema bough_scene_turbine_schema = {
    SCHEMA("the turbine", bough_scene_turbine, turbine_keys)};
// clang-format on
