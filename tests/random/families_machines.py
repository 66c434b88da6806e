"""Machines as other people build them: crane, helicopter rotor, washing machine, vehicle, chains of rods, shafts through
their critical speed, prescribed motions with corners, linkages through a singular position."""
import math

from families import KINDS, decades, digits, flexible, rad, rigid, rod, turn


def crane(rng, scene):
    """A boom on a slewing base, a cable of hinged links or a spring, and a load."""
    length, mass, end = decades(rng, 0, 1.6), decades(rng, 0, 2), scene["duration"]
    slew = {"from": 0, "to": rad(rng.uniform(-1.5, 1.5)), "ramp": ["%.3g s" % (0.1 * end), "%.3g s" % (rng.uniform(0.3, 1) * end)]}
    scene["bodies"].append(rigid("base", {"kind": "revolute", "axis": "z", "parent": "ground", "motion": {"angle": slew}},
                                 10 * mass, 0.3 * length, rng))
    luff = rng.uniform(20, 80)
    scene["bodies"].append({"name": "boom", "fidelity": "rod", "rod": rod(rng, length, mass, rng.randint(2, 5)),
                            "joint": {"kind": "fixed", "parent": "base", "placement": ["rotate y %.3g deg" % luff]}})
    head = {"kind": "fixed", "parent": "boom", "placement": ["rotate y %.3g deg" % -luff]}
    scene["bodies"].append(rigid("head", head, mass * decades(rng, -2, 0), 0.05 * length, rng))
    drop = length * rng.uniform(0.2, 0.6)
    carried = mass * decades(rng, -1, 1)
    if rng.random() < 0.6:
        count = rng.randint(1, 4)
        for k in range(count):
            parent = "link%d" % k if k else "head"
            joint = {"kind": rng.choice(["universal", "spherical"]), "parent": parent}
            if k:
                joint["placement"] = ["move z %.4g m" % (-drop / count)]
            if joint["kind"] == "universal":
                joint.update(axis="x", second_axis="y")
            scene["bodies"].append(rigid("link%d" % (k + 1), joint, carried * (1 if k == count - 1 else decades(rng, -3, -1)),
                                         0.2 * drop / count, rng))
    else:
        joint = {"kind": "free", "parent": "ground",
                 "placement": ["move x %.4g m" % (length * math.sin(math.radians(luff))),
                               "move z %.4g m" % (length * math.cos(math.radians(luff)) - drop)]}
        scene["bodies"].append(rigid("hook", joint, carried, 0.1 * drop, rng))
        stiffness = carried * 9.81 / (drop * decades(rng, -3, -1))
        scene["springs"] = [{"name": "rope", "from": "head", "to": "hook", "stiffness": digits(stiffness),
                             "length": digits(drop), "damping": rng.choice([0, digits(stiffness * 1e-3)])}]


def flapping(rng, scene):
    """A rotor whose blades flap and lag on hinges, driven to a speed or by a torque."""
    length, count = decades(rng, 0, 1), rng.randint(2, 4)
    mass, speed = decades(rng, -0.5, 0.5) * length ** 1.5, rng.uniform(2, 20) / math.sqrt(length)
    joint = {"kind": "revolute", "axis": "z", "parent": "ground"}
    if rng.random() < 0.5:
        joint["motion"] = {"speed": {"from": 0, "to": turn(speed), "ramp": ["0 s", "%.3g s" % scene["duration"]]}}
    else:
        joint["speed"] = turn(speed)
    scene["bodies"].append(rigid("shaft", joint, mass * decades(rng, -1, 1), 0.1 * length, rng))
    one = rod(rng, length, mass, rng.randint(2, 5))
    lags = rng.random() < 0.5
    for k in range(count):
        place = ["rotate z %.6g deg" % (360 * k / count), "move x %.4g m" % (0.05 * length), "rotate y 90 deg"]
        flap = {"kind": "revolute", "axis": "y", "parent": "shaft", "placement": place}
        if rng.random() < 0.4:
            flap["damping"] = digits(mass * length ** 2 * speed * decades(rng, -3, -1))
        light = mass * decades(rng, -4, -1)
        scene["bodies"].append(rigid("flap%d" % (k + 1), flap, light, 0.03 * length, rng))
        parent = "flap%d" % (k + 1)
        if lags:
            lag = {"kind": "revolute", "axis": "x", "parent": parent, "damping": digits(mass * length ** 2 * speed * 0.05)}
            scene["bodies"].append(rigid("lag%d" % (k + 1), lag, light, 0.03 * length, rng))
            parent = "lag%d" % (k + 1)
        scene["bodies"].append(flexible(rng, "blade%d" % (k + 1), {"kind": "fixed", "parent": parent}, one, KINDS))
    if rng.random() < 0.5:
        scene["loads"].append({"body": "blade1", "at": "tip", "frame": "ground",
                               "force": [0, 0, digits(mass * 9.81 * rng.uniform(-1, 3))],
                               "ramp": ["%.4g s" % (0.3 * scene["duration"])] * 2})


def washer(rng, scene):
    """An unbalanced drum in a tub on bushings, brought up through the resonances; a flexible arm on the tub."""
    mass = decades(rng, 0, 2)
    first = 2 * math.pi * rng.uniform(1, 5)
    linear = digits(2 * mass * first ** 2)
    scene["bodies"].append(rigid("tub", {"kind": "free", "parent": "ground"}, mass, 0.5, rng))
    scene["bushings"] = [{"name": "mounts", "from": "ground", "to": "tub", "stiffness": [linear, linear, digits(2 * linear)],
                          "rotational_stiffness": [digits(0.1 * linear)] * 3,
                          "damping": [digits(linear / first * rng.choice([0, 0.02, 0.2]))] * 3}]
    speed = {"from": 0, "to": turn(first * rng.uniform(1, 5)), "ramp": ["0 s", "%.3g s" % scene["duration"]]}
    drum = rigid("drum", {"kind": "revolute", "axis": "x", "parent": "tub", "motion": {"speed": speed}}, 0.5 * mass, 0.4, rng)
    drum["centre_of_mass"] = [0, digits(0.2 * rng.uniform(0.1, 1)), 0]
    scene["bodies"].append(drum)
    scene["bodies"].append(flexible(rng, "pipe", {"kind": "fixed", "parent": rng.choice(["tub", "drum"]),
                                                  "placement": ["rotate y %.3g deg" % rng.uniform(0, 180)]},
                                    rod(rng, decades(rng, -0.5, 0), mass * decades(rng, -3, -0.5), rng.randint(2, 4)), KINDS))


def vehicle(rng, scene):
    """A chassis of rods on springs to the ground, that runs over a bump: a tree with several rods."""
    length, mass = decades(rng, 0, 0.8), decades(rng, 1, 3)
    scene["bodies"].append(rigid("chassis", {"kind": "free", "parent": "ground"}, mass, 0.5 * length, rng))
    scene["springs"], n = [], rng.randint(2, 4)
    first = 2 * math.pi * rng.uniform(0.8, 3)
    one = rod(rng, 0.5 * length, mass * decades(rng, -2, -0.5), rng.randint(2, 3))
    for k in range(n):
        angle = 360 * (k + 0.5) / n
        arm = {"kind": "fixed", "parent": "chassis", "placement": ["rotate z %.4g deg" % angle, "rotate y 90 deg"]}
        scene["bodies"].append({"name": "arm%d" % (k + 1), "fidelity": "rod", "joint": arm, "rod": one})
        wheel = rigid("wheel%d" % (k + 1), {"kind": "fixed", "parent": "arm%d" % (k + 1)}, mass * decades(rng, -2, -0.7), 0.1 * length, rng)
        scene["bodies"].append(wheel)
        x, y = 0.5 * length * math.cos(math.radians(angle)), 0.5 * length * math.sin(math.radians(angle))
        stiffness = digits(mass * first ** 2 / n)
        scene["springs"].append({"name": "tyre%d" % (k + 1), "from": "ground", "from_point": [digits(x), digits(y), digits(-0.4 * length)],
                                 "to": wheel["name"], "stiffness": stiffness, "length": digits(0.4 * length),
                                 "damping": rng.choice([0, digits(0.2 * stiffness / first)])})
    scene["bodies"].append(flexible(rng, "aerial", {"kind": "fixed", "parent": "chassis"},
                                    rod(rng, length, mass * decades(rng, -4, -1.5), rng.randint(2, 4)), KINDS))
    at, short = scene["duration"] * rng.uniform(0.1, 0.5), scene["duration"] * rng.uniform(0.01, 0.1)
    scene["loads"].append({"body": "wheel1", "frame": "ground", "force": [0, 0, digits(mass * 9.81 * rng.uniform(0.3, 3))],
                           "factor": {"times": [digits(at), digits(at + 0.5 * short), digits(at + short)], "values": [0, 1, 0]}})


def rods_chain(rng, scene):
    """Rods hinged to one another in a row, hung or thrown, pinned by balls, hinges or light bodies."""
    count, length, mass = rng.randint(3, 5), decades(rng, -0.5, 0.5), decades(rng, -1, 1)
    parent, placed = "ground", ["rotate y %.3g deg" % rng.uniform(60, 180)]
    for k in range(count):
        joint = {"kind": rng.choice(["revolute", "revolute", "spherical"]), "parent": parent, "placement": placed}
        if joint["kind"] == "revolute":
            joint.update(axis="y", speed=turn(rng.uniform(-2, 2)))
        scene["bodies"].append(rigid("pin%d" % (k + 1), joint, mass * decades(rng, -3, -0.5), 0.1 * length, rng))
        scene["bodies"].append({"name": "rod%d" % (k + 1), "fidelity": "rod",
                                "joint": {"kind": "fixed", "parent": "pin%d" % (k + 1)},
                                "rod": rod(rng, length, mass, rng.randint(2, 3))})
        parent, placed = "rod%d" % (k + 1), ["rotate y %.3g deg" % rng.uniform(-30, 30)]


def whirl(rng, scene):
    """A shaft with a disk out of balance, brought through its critical speed."""
    length, mass = decades(rng, -0.3, 0.7), decades(rng, 0, 2)
    one = rod(rng, length, mass, rng.choice([3, 4, 6]))
    disk = mass * decades(rng, -1, 1)
    critical = math.sqrt(3 * one["stiffness"][3] / length ** 3 / (disk + 0.24 * mass))
    speed = {"from": turn(critical * rng.uniform(0.2, 0.8)), "to": turn(critical * rng.uniform(1.2, 2)),
             "ramp": ["0 s", "%.3g s" % scene["duration"]]}
    scene["bodies"].append(rigid("bearing", {"kind": "revolute", "axis": "z", "parent": "ground", "motion": {"speed": speed}},
                                 mass, 0.1 * length, rng))
    scene["bodies"].append({"name": "shaft", "fidelity": "rod", "joint": {"kind": "fixed", "parent": "bearing"}, "rod": one})
    body = rigid("disk", {"kind": "fixed", "parent": "shaft"}, disk, 0.3 * length, rng)
    body["centre_of_mass"] = [digits(length * decades(rng, -4, -2)), 0, 0]
    scene["bodies"].append(body)


def cornered(rng, scene):
    """Motions prescribed by tables of speeds with corners within macro steps: the acceleration jumps."""
    length, mass, end = decades(rng, -0.3, 1), decades(rng, -1, 2), scene["duration"]
    slides = rng.random() < 0.5
    n = rng.randint(3, 8)
    times = sorted(digits(end * rng.uniform(0.02, 0.95)) for _ in range(n))
    times = [0] + [t for k, t in enumerate(times) if k == 0 or t > times[k - 1]]
    size = length if slides else rng.uniform(0.5, 4)
    unit = "m/s" if slides else "rad/s"
    values = ["%.3g %s" % (rng.uniform(-1, 1) * size if k else 0, unit) for k in range(len(times))]
    joint = {"kind": "prismatic" if slides else "revolute", "axis": rng.choice("xy"), "parent": "ground",
             "motion": {"speed": {"times": times, "values": values}}}
    scene["bodies"].append(rigid("drive", joint, mass, 0.2 * length, rng))
    parent = "drive"
    if rng.random() < 0.5:
        hinge = {"kind": "revolute", "axis": "y", "parent": "drive", "stiffness": digits(mass * length ** 2 * decades(rng, 0, 3))}
        scene["bodies"].append(rigid("hinge", hinge, mass * decades(rng, -3, 0), 0.1 * length, rng))
        parent = "hinge"
    turned = ["rotate y %.3g deg" % rng.uniform(-180, 180)]
    scene["bodies"].append(flexible(rng, "arm", {"kind": "fixed", "parent": parent, "placement": turned},
                                    rod(rng, length, mass * decades(rng, -1.5, 0.5), rng.randint(1, 5)), KINDS))


def parallelogram(rng, scene):
    """Crank and rocker of equal length, driven towards or past the position in which all links lie on one line."""
    mass, side = decades(rng, -1, 1), 0.5
    thin = lambda along: [digits(m * mass) for m in along]
    start = rng.uniform(20, 80)
    speed = rng.choice([-1, 1]) * rng.uniform(1, 8)
    if rng.random() < 0.5:
        joint = {"motion": {"speed": turn(speed)}, "angle": "%.4g deg" % start}
    else:
        joint = {"speed": turn(speed), "angle": "%.4g deg" % start}
    scene["bodies"] += [
        {"name": "crank", "fidelity": "rigid", "mass": mass, "inertia": thin([0.02, 0.02, 0.0003]),
         "joint": dict(joint, kind="revolute", axis="y", parent="ground")},
        {"name": "coupler", "fidelity": "rigid", "mass": mass, "centre_of_mass": [0.5, 0, 0], "inertia": thin([0.001, 0.084, 0.084]),
         "joint": {"kind": "revolute", "axis": "y", "parent": "crank", "placement": ["move z %g m" % side], "angle": "%.4g deg" % -start}},
        {"name": "rocker", "fidelity": "rigid", "mass": mass, "inertia": thin([0.02, 0.02, 0.0003]),
         "joint": {"kind": "revolute", "axis": "y", "parent": "ground", "placement": ["move x 1 m"], "angle": "%.4g deg" % start}}]
    scene["closures"] = [{"name": "pin", "kind": "spherical", "from": "coupler", "from_placement": ["move x 1 m"], "to": "rocker",
                          "to_placement": ["move z %g m" % side]}]
    scene["bodies"].append(flexible(rng, "arm", {"kind": "fixed", "parent": rng.choice(["coupler", "rocker"])},
                                    rod(rng, rng.uniform(0.2, 1), mass * decades(rng, -1.5, 0.5), rng.randint(1, 3)), KINDS))


FAMILIES = [crane, flapping, washer, vehicle, rods_chain, whirl, cornered, parallelogram]
