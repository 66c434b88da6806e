// The keys of loads, of what joins bodies beside the tree, and of the turbine's names.
#include "apps/scene/scene_tables.h"

// One line a key would become one line a field:
// clang-format off

#define AT(member) .offset = offsetof(bough_scene_load, member)
static const bough_key load_keys[] = {
    {.name = "joint", .kind = BOUGH_KEY_TEXT, AT(joint_name),
     .example = "hub", .help = "load on a joint: name of the body that the joint carries"},
    {.name = "torque", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_load_torque,
     .form = "number in N m, or {times: [...], values: [...]}", .offset = 0,
     .example = "-11.9 MN m", .help = "about the axis of a revolute joint"},
    {.name = "body", .kind = BOUGH_KEY_TEXT, AT(body_name),
     .example = "blade1", .help = "load on a rod or a rigid body: name of the body"},
    {.name = "point", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = ZERO3, AT(point), .example = "[0, 0, 1.5 m]",
     .help = "of a rigid body, in its frame"},
    {.name = "at", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_load_place,
     .form = "tip, a vertex' number or a length as '30 m'", .offset = 0,
     .example = "30 m", .help = "place on the rod, counted from the root"},
    {.name = "along", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_LENGTH,
     .range = ">= 0", AT(span), .example = "[40 m, 61.5 m]",
     .help = "range of a distributed load; replaces 'at'"},
    {.name = "force", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_load_force,
     .form = "number in N, {times: [...], values: [...]}, or 3 numbers in N, in N/m with 'along'",
     .offset = 0,
     .example = "12 kN", .help = "along the axis of a prismatic joint, or on the body"},
    {.name = "moment", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_load_moment,
     .form = "3 numbers in N m, in N m/m with 'along'", .offset = 0, .example = "[0, 0, 5 kN m]",
     .help = "on the body"},
    {.name = "end_force", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LINE_FORCE,
     .fallback = ZERO3, AT(end_force), .example = "[2 kN/m, 0, 0]",
     .help = "with 'along': force at the end of the range, if it differs from 'force' at the "
             "start; linear between"},
    {.name = "end_moment", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LINE_MOMENT,
     .fallback = ZERO3, AT(end_moment), .example = "[0, 0, 100]",
     .help = "with 'along': moment at the end of the range, if it differs from 'moment' at the "
             "start; linear between"},
    {.name = "factor", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_load_factor,
     .form = "{times: [...], values: [...]}", .offset = 0,
     .example = "{times: [0, 1, 2], values: [0, 1, 0]}",
     .help = "on a body: factor of the load over time, linear between the times and constant "
             "outside; replaces 'ramp'"},
    {.name = "frame", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("ground", "body", "follower"),
     .fallback = "ground", AT(frame),
     .help = "axes of the load on a body: ground, body, or follower: the section axes of a rod, so "
             "that the load rotates with the section"},
    RAMP(bough_scene_load),
    {.name = "input", .kind = BOUGH_KEY_TEXT, AT(input), .example = "brake",
     .help = "name of an input, by which another program sets the load between steps: torque or "
             "force on a joint; on a body six inputs, whose names end with Fx, Fy, Fz, Mx, My, Mz; "
             "the values of the scene are the start values"},
};
#undef AT
const bough_schema bough_scene_load_schema = {SCHEMA("a load", bough_scene_load, load_keys),
                                         .check = bough_scene_check_load};

#define AT(member) .offset = offsetof(bough_scene_spring, member)
static const bough_key spring_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name),
     .example = "stay",
     .help = "name of its channels, which end with Len and Frc"},
    {.name = "from", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name[0]),
     .example = "ground", .help = "name of a rigid body, or ground"},
    {.name = "from_point", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = ZERO3, AT(point[0]), .example = "[10, 0, 0]", .help = "in that body's frame"},
    {.name = "to", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name[1]),
     .example = "mast", .help = "name of another rigid body, or ground"},
    {.name = "to_point", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = ZERO3, AT(point[1]), .example = "[0, 0, 20]",
     .help = "in that body's frame; the two points must never coincide"},
    {.name = "stiffness", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_STIFFNESS, .range = ">= 0",
     .fallback = "0", AT(stiffness), .example = "3 kN/m", .help = "of the spring"},
    {.name = "damping", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0", AT(damping),
     .example = "150", .help = "of the damper parallel to the spring, in N s/m"},
    {.name = "length", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = ">= 0",
     .fallback = "0", AT(length), .example = "21.5 m", .help = "length of the spring without force"},
};
#undef AT
const bough_schema bough_scene_spring_schema = {
    SCHEMA("a spring", bough_scene_spring, spring_keys)};

#define AT(member) .offset = offsetof(bough_scene_bushing, member)
#define THREE(member, what)                                                                        \
    {.name = #member, .kind = BOUGH_KEY_VECTOR, .count = 3, .range = ">= 0", .fallback = ZERO3,    \
     .example = "[1e6, 1e6, 2e6]", AT(member), .help = what}
static const bough_key bushing_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name),
     .example = "yaw_bearing",
     .help = "name of its channels FrcX to MomZ: force and moment on the second body, in the "
             "first body's axes"},
    {.name = "from", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name[0]),
     .example = "tower",
     .help = "name of a rigid body, or ground; the bushing's axes are those of this body"},
    {.name = "to", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name[1]),
     .example = "nacelle", .help = "name of the second body; the bushing is free of force in the "
                                   "initial position"},
    {.name = "point", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = ZERO3, AT(point), .example = "[0, 0, 87.6]", .help = "in the first body's frame"},
    THREE(stiffness, "along x, y, z, in N/m"),
    THREE(damping, "along x, y, z, in N s/m"),
    THREE(rotational_stiffness, "about x, y, z, in N m/rad, by the rotation vector (below 180 "
                                "deg)"),
    THREE(rotational_damping, "about x, y, z, in N m s/rad"),
};
#undef THREE
#undef AT
const bough_schema bough_scene_bushing_schema = {
    SCHEMA("a bushing", bough_scene_bushing, bushing_keys)};

#define AT(member) .offset = offsetof(bough_scene_closure, member)
static const bough_key closure_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name),
     .example = "pin",
     .help = "name of its channels Fx to Mz: force and moment on 'to', in the joint's frame there"},
    {.name = "kind", .kind = BOUGH_KEY_CHOICE, .required = true, AT(kind),
     .choices = CHOICES("fixed", "revolute", "prismatic", "spherical", "cylindrical", "universal",
                        "planar"),
     .help = "kind of joint; other joints may already prevent some of the motions that it "
             "prevents"},
    {.name = "from", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name[0]),
     .example = "coupler", .help = "name of a rigid body, or ground"},
    {.name = "from_placement", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_steps,
     .form = PLACEMENT_FORM, AT(placement[0]), .example = "[move x 0.5 m]",
     .help = "placement of the joint's frame in that body's frame"},
    {.name = "to", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name[1]),
     .example = "ground", .help = "name of another rigid body, or ground"},
    {.name = "to_placement", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_steps,
     .form = PLACEMENT_FORM, AT(placement[1]),
     .example = "[move x 1 m]",
     .help = "placement of the joint's frame in that body's frame; the two frames must almost "
             "coincide at the start: small motions of all joints close the rest, and joints without "
             "a speed follow"},
    {.name = "axis", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("x", "y", "z"), .required = true,
     .when_key = "kind", .when = "revolute|prismatic|cylindrical|universal|planar", AT(axis),
     .help = "axis of the motion, as of a joint; of a universal joint in the frame of 'from'"},
    {.name = "second_axis", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("x", "y", "z"),
     .required = true, .when_key = "kind", .when = "universal", AT(second_axis),
     .help = "normal to the axis, in the frame of 'to'"},
};
#undef AT
const bough_schema bough_scene_closure_schema = {
    SCHEMA("a closure", bough_scene_closure, closure_keys)};

#define AT(member) .offset = offsetof(bough_scene_marker, member)
static const bough_key marker_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name),
     .example = "tower_top", .help = "name of its channels X, Y, Z in ground axes"},
    {.name = "body", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name),
     .example = "nacelle", .help = "name of a rigid body, or ground"},
    {.name = "point", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = ZERO3, AT(point), .example = "[0, 0, 1 m]", .help = "in that body's frame"},
};
#undef AT
const bough_schema bough_scene_marker_schema = {
    SCHEMA("a marker", bough_scene_marker, marker_keys)};

#define AT(member) .offset = offsetof(bough_scene_sensor, member)
static const bough_key sensor_keys[] = {
    {.name = "body", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name), .example = "blade1",
     .help = "name of a body of fidelity rod"},
    {.name = "at", .kind = BOUGH_KEY_NUMBERS, .dimension = BOUGH_LENGTH, .range = ">= 0",
     .required = true, .count = 1, AT(at), .count_offset = offsetof(bough_scene_sensor, n_at),
     .example = "[20 m, 40 m]", .help = "distances from the root, along the rod; the first place "
                                        "is number 1"},
};
#undef AT
const bough_schema bough_scene_sensor_schema = {
    SCHEMA("a sensor", bough_scene_sensor, sensor_keys)};

#define AT(member) .offset = offsetof(bough_scene_turbine, member)
static const bough_key turbine_keys[] = {
    {.name = "rotor", .kind = BOUGH_KEY_TEXT, .required = true, AT(rotor_name),
     .example = "hub", .help = "body on the revolute joint of the rotor"},
    {.name = "blades", .kind = BOUGH_KEY_TEXTS, .required = true, .count = 1, AT(blade_name),
     .count_offset = offsetof(bough_scene_turbine, n_blade),
     .example = "[blade1, blade2, blade3]", .help = "bodies with a rod, carried by the rotor"},
};
#undef AT
const bough_schema bough_scene_turbine_schema = {
    SCHEMA("the turbine", bough_scene_turbine, turbine_keys)};
// clang-format on
