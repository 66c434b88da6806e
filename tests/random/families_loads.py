"""Loads and sizes that the other families do not have: columns through their buckling load, loads that come at the end,
resonance, shaken bases, strings, gusts, brakes, tapered and coupled sections, and rods from 10 µm to 10 km."""
import math

import families
import families_hard
from families import JOINTS, KINDS, decades, digits, flexible, moving, rad, rigid, rod, turn


def draw(rng, segments, damping=None, low=-0.5, high=1):
    """Length, mass and rod."""
    length, mass = decades(rng, low, high), decades(rng, -1, 2)
    return length, mass, rod(rng, length, mass, rng.randint(*segments), damping)


def based(rng, scene, joint, mass, length, name="base"):
    scene["bodies"].append(rigid(name, joint, mass * decades(rng, -1, 2), 0.2 * length, rng))
    return name


def add(rng, scene, name, parent, one, kinds=("rod",), turned=0.0):
    joint = {"kind": "fixed", "parent": parent}
    if turned:
        joint["placement"] = ["rotate %s %.4g deg" % (rng.choice("xy"), turned)]
    scene["bodies"].append(flexible(rng, name, joint, one, kinds))


def bending_force(rng, one, low, high):
    return digits(one["stiffness"][3] / one["length"] ** 2 * decades(rng, low, high))


def table(times, values):
    return {"times": [float("%.9g" % t) for t in times], "values": [digits(v) for v in values]}


def buckling(rng, scene):
    """A column under an end load that grows through its buckling load, with an imperfection of 1e-6 to 1e-2."""
    length, mass, one = draw(rng, (2, 8))
    parent = "ground"
    if rng.random() < 0.4:
        parent = based(rng, scene, moving(rng, rng.choice(("revolute", "prismatic")), "ground", size=length), mass, length)
    add(rng, scene, "column", parent, one)
    load = {"body": "column", "at": "tip", "frame": rng.choice(["ground", "body", "follower"])}
    if rng.random() < 0.5:
        scene["bodies"].append(rigid("top", {"kind": "fixed", "parent": "column"}, mass * decades(rng, -2, 0.5), 0.1 * length, rng))
        load = {"body": "top", "frame": rng.choice(["ground", "body"])}
    force = math.pi ** 2 * one["stiffness"][3] / (4 * length ** 2) * rng.uniform(0.7, 3)
    load.update(force=[digits(force * decades(rng, -6, -2)), 0, digits(-force)],
                ramp=["0 s", "%.4g s" % (scene["duration"] * rng.uniform(0.1, 0.8))])
    scene["loads"].append(load)
    scene["gravity"] = [0, 0, 0]


def late(rng, scene):
    """Nothing moves until a load comes near the end."""
    length, mass, one = draw(rng, (2, 12))
    joint = moving(rng, rng.choice(("revolute", "prismatic", "spherical")), "ground", size=length)
    for key in ("speed", "angular_velocity"):
        joint.pop(key, None)
    scene["gravity"] = [0, 0, 0]
    add(rng, scene, "arm", based(rng, scene, joint, mass, length), one, KINDS)
    force = bending_force(rng, one, -2, -0.3)
    start = scene["duration"] * rng.uniform(0.8, 0.98)
    end = start + (scene["duration"] - start) * rng.choice([1e-3, 0.1, 0.5])
    scene["loads"].append({"body": "arm", "at": "tip", "frame": "body", "force": [force, digits(0.2 * force), 0],
                           "factor": table([start, end], [0, 1])})


def shaken(rng, scene):
    """A base whose motion follows a table, faster or slower than macro steps."""
    length, mass, one = draw(rng, (2, 8))
    period = scene["step"] * decades(rng, -0.3, 1.3)
    count = min(60, max(5, int(scene["duration"] / period)))
    kind = rng.choice(["prismatic", "revolute"])
    of_speed = rng.random() < 0.4
    size = (0.25 if of_speed else 0.05) * (length if kind == "prismatic" else 1)
    write = digits if kind == "prismatic" else turn if of_speed else rad
    values = [0] + [write(rng.uniform(-size, size)) for _ in range(count - 2)] + [0]
    key = "speed" if of_speed else "position" if kind == "prismatic" else "angle"
    motion = {key: {"times": [float("%.9g" % (k * period)) for k in range(count)], "values": values}}
    joint = {"kind": kind, "axis": rng.choice("xy"), "parent": "ground", "motion": motion}
    add(rng, scene, "arm", based(rng, scene, joint, mass, length), one)
    if rng.random() < 0.5:
        joint = moving(rng, rng.choice(("revolute", "spherical")), "arm")
        scene["bodies"].append(rigid("bob", joint, mass * decades(rng, -2, 1), 0.1 * length, rng))


def resonance(rng, scene):
    """A small load at or near a frequency of a rod of little damping."""
    length, mass, one = draw(rng, (2, 12), rng.choice([0, 0, 1e-5, 5e-4]))
    joint = {"kind": rng.choice(["prismatic", "revolute"]), "axis": rng.choice("xy"), "parent": "ground"}
    add(rng, scene, "arm", based(rng, scene, joint, mass, length), one, KINDS)
    first = math.sqrt(one["stiffness"][3] / one["mass"][0]) * 3.516 / length ** 2 / (2 * math.pi)
    frequency = first * rng.choice([1, 1, 1.1, 2, 6.27])
    count = int(max(8, min(400, scene["duration"] * frequency * 8)))
    force = bending_force(rng, one, -4, -2)
    factor = table([k / (8 * frequency) for k in range(count)], [math.sin(2 * math.pi * k / 8) for k in range(count)])
    scene["loads"].append({"body": "arm", "at": "tip", "frame": "body", "force": [force, digits(0.3 * force), 0], "factor": factor})


def string(rng, scene):
    """A taut or hanging string that is struck."""
    length, mass = decades(rng, 0, 1.5), decades(rng, -1, 1)
    one = rod(rng, length, mass, rng.randint(4, 16), rng.choice([0, 1e-4, 1e-2]))
    softer = decades(rng, -4, -1)
    one["stiffness"][3:] = [digits(softer * s) for s in one["stiffness"][3:]]
    joint = {"kind": "spherical", "parent": "ground", "placement": ["rotate y 90 deg"]}
    scene["bodies"].append(rigid("pin", joint, mass * decades(rng, -3, -1), 0.05 * length, rng))
    add(rng, scene, "cable", "pin", one)
    scene["bodies"].append(rigid("end", {"kind": "fixed", "parent": "cable"}, mass * decades(rng, -2, 1), 0.05 * length, rng))
    if rng.random() < 0.7:
        scene["closures"] = [{"name": "held", "kind": "spherical", "from": "end", "to": "ground",
                              "to_placement": ["move x %.12g m" % one["length"]]}]
    force = digits(mass * 9.81 * decades(rng, -1, 1))
    scene["loads"].append({"body": "cable", "at": rng.randint(1, one["segments"] - 1), "force": [0, digits(0.3 * force), force],
                           "factor": families_hard.pulse(rng, scene["duration"], scene["step"])})


def thrown(rng, scene):
    """A free body with rods, some of which carry bodies, thrown and spinning."""
    length, mass = decades(rng, -0.5, 1), decades(rng, -1, 2)
    scene["gravity"] = rng.choice([[0, 0, 0], [0, 0, -9.81]])
    joint = {"kind": "free", "parent": "ground", "velocity": [digits(length * rng.uniform(-20, 20)) for _ in range(3)],
             "angular_velocity": [turn(rng.uniform(-6, 6)) for _ in range(3)]}
    based(rng, scene, joint, mass, length, "hull")
    for k in range(rng.randint(1, 3)):
        add(rng, scene, "boom%d" % k, "hull", rod(rng, length, mass, rng.randint(2, 9)), turned=rng.uniform(-180, 180))
        if rng.random() < 0.6:
            joint = moving(rng, rng.choice(("revolute", "spherical", "prismatic")), "boom%d" % k)
            scene["bodies"].append(rigid("bob%d" % k, joint, mass * decades(rng, -2, 0.5), 0.1 * length, rng))


def gust(rng, scene):
    """A small rotor in transient winds of the standard, or in a wind that jumps."""
    families_hard.small_rotor(rng, scene)
    for body in scene["bodies"]:
        if "rod" in body:
            body["rod"] = dict(body["rod"], segments=rng.randint(3, 14) if body["name"] == "mast" else 8)
    length = next(body["rod"]["length"] for body in scene["bodies"] if body["name"] == "blade1")
    height, end = digits(2 * length + 3), scene["duration"]
    kind = rng.choice(["eog", "edc", "ecd", "ews", "jump", "jump"])
    start = end * rng.uniform(0.2, 0.9)
    scene["extra"]["aero"]["wind"] = {"kind": "iec", "condition": kind, "class": "IB", "speed": digits(rng.uniform(6, 20)),
                                      "reference_height": height, "start": "%.3g s" % (end * rng.uniform(0, 0.6))}
    if kind == "jump":
        times = [0, digits(start), digits(start + end * rng.choice([0.002, 0.05, 0.3])), 100]
        scene["extra"]["aero"]["wind"] = {"kind": "uniform", "direction": "%.3g deg" % rng.uniform(-20, 20),
                                          "table": {"times": times, "speeds": [digits(rng.uniform(3, 20)) for _ in range(4)]}}


def sections(rng, scene):
    """Tables of tapered, twisted and prebent rods with centres of mass off their axis; graded segments."""
    rng.choice([families.rotor, families.arm, families.tower, families.loaded])(rng, scene)
    files = scene["files"] = {}
    for body in scene["bodies"]:
        if "rod" not in body:
            continue
        one, count, name = body["rod"], rng.randint(3, 8), "table-%d.yaml" % len(files)
        taper, twist, prebend = rng.uniform(0.02, 1), rng.uniform(-30, 30), rng.uniform(-0.1, 0.1) * one["length"]
        centre = 0.1 * math.sqrt(one["mass"][3] / one["mass"][0])
        lines = ["length: %.6g" % one["length"], "damping: %s" % one["damping"], "stations:"]
        for k in range(count):
            x = k / (count - 1)
            stiffness = [digits(s * taper ** (x if j > 2 else 0.5 * x)) for j, s in enumerate(one["stiffness"])]
            mass = [digits(m * taper ** (0.5 * x)) for m in (one["mass"][0], 1.2 * one["mass"][3], 1.2 * one["mass"][4])]
            lines.append("  - {span: %.6g, twist: %.4g deg, axis: [%.4g, 0], stiffness: %s, mass: [%g, %.4g, 0, %g, %g, 0]}" %
                         (one["length"] * x, twist * (1 - x), prebend * x * x, stiffness, mass[0], centre, mass[1], mass[2]))
        files[name] = "\n".join(lines) + "\n"
        body.update(fidelity="rod", rod={"table": name, "segments": rng.randint(3, 16), "grading": digits(rng.uniform(0, 0.4))})
        body.pop("modal", None)


def brake(rng, scene):
    """A rotor that a torque stops, turns back and lets go, by jumps."""
    families.rotor(rng, scene)
    scene["loads"].clear()
    joint, inertia = scene["bodies"][0]["joint"], scene["bodies"][0]["inertia"][0]
    torque = inertia * float(joint["speed"].split()[0]) / scene["duration"] * rng.uniform(1, 20)
    at = sorted(scene["duration"] * rng.uniform(0, 1) for _ in range(4))
    scene["loads"].append({"joint": "hub", "torque": table([at[0], at[0] + 1e-6, at[1], at[1] + 1e-6, at[2], at[3]],
                                                          [0, -torque, -torque, torque, 0.3 * torque, 0])})


def soft(rng, scene):
    """A rod so soft that its weight coils it."""
    length, mass, one = draw(rng, (3, 16), rng.choice([0, 1e-4, 1e-2]))
    softer = decades(rng, -3, -0.5)
    one["stiffness"][3:] = [digits(softer * s) for s in one["stiffness"][3:]]
    base = based(rng, scene, moving(rng, rng.choice(JOINTS), "ground", size=length), mass, length)
    add(rng, scene, "whip", base, one, turned=rng.uniform(-180, 180))


def sizes(rng, scene):
    """An arm of 10 µm to 1 cm, or of 100 m to 10 km."""
    length = decades(rng, *rng.choice([(-5, -2), (2, 4)]))
    mass = min(decades(rng, -1, 3) * length ** 3, 1e9)
    one = rod(rng, length, mass, rng.randint(2, 12))
    joint = moving(rng, rng.choice(("revolute", "spherical", "free", "universal")), "ground", size=length)
    joint.pop("stiffness", None)
    scene["gravity"] = [0, 0, digits(-9.81 * rng.choice([0, 1]) * min(1, 10 * length))]
    add(rng, scene, "arm", based(rng, scene, joint, mass, length), one, KINDS, rng.uniform(-180, 180))
    force = bending_force(rng, one, -3, -0.5)
    scene["loads"].append({"body": "arm", "at": "tip", "frame": "body", "force": [force, digits(0.3 * force), 0],
                           "ramp": ["0 s", "%.4g s" % (scene["duration"] * rng.uniform(0.01, 1))]})


def torsion(rng, scene):
    """A shaft that is soft in torsion, fixed or turning, with or without a wheel, under pulses of a torque."""
    length, mass, one = draw(rng, (2, 12))
    one["stiffness"][5] = digits(one["stiffness"][5] * decades(rng, -3, -1))
    parent = "ground"
    if rng.random() < 0.5:
        joint = {"kind": "revolute", "axis": "z", "parent": "ground", "speed": turn(rng.uniform(-20, 20))}
        parent = based(rng, scene, joint, mass, length, "gear")
    add(rng, scene, "shaft", parent, one)
    load = {"body": "shaft", "at": "tip"}
    if rng.random() < 0.7:
        scene["bodies"].append(rigid("wheel", {"kind": "fixed", "parent": "shaft"}, mass * decades(rng, -1, 1), 0.2 * length, rng))
        load = {"body": "wheel"}
    torque = one["stiffness"][5] / length * decades(rng, -2, 0)
    scene["loads"].append(dict(load, frame="body", moment=[0, 0, digits(torque)],
                               factor=families_hard.pulse(rng, scene["duration"], scene["step"])))


def impact(rng, scene):
    """A bar that is hit along its axis."""
    length, mass, one = draw(rng, (2, 16))
    one["stiffness"][2] = digits(one["stiffness"][2] * decades(rng, -2, 0))
    joint = rng.choice([{"kind": "prismatic", "axis": "z", "parent": "ground"}, {"kind": "free", "parent": "ground"}])
    add(rng, scene, "bar", based(rng, scene, joint, mass, length, "head"), one, KINDS)
    scene["gravity"] = [0, 0, 0]
    scene["loads"].append({"body": "head", "frame": "body", "force": [0, 0, digits(one["stiffness"][2] * decades(rng, -4, -2))],
                           "factor": families_hard.pulse(rng, scene["duration"], scene["step"])})


def slider(rng, scene):
    """A rod on a slider on a turning arm."""
    length, mass, one = draw(rng, (1, 10))
    joint = {"kind": "revolute", "axis": rng.choice("xyz"), "parent": "ground", "speed": turn(rng.uniform(-8, 8))}
    based(rng, scene, joint, mass, 5 * length, "arm")
    joint = {"kind": rng.choice(["prismatic", "cylindrical"]), "axis": rng.choice("xyz"), "parent": "arm", "position": digits(0.2 * length)}
    scene["bodies"].append(rigid("slider", joint, mass * decades(rng, -2, 1), 0.1 * length, rng))
    add(rng, scene, "rod", "slider", one, KINDS, rng.uniform(-180, 180))


def followers(rng, scene):
    """A follower force and a load on a part of a rod, growing."""
    length, mass, one = draw(rng, (2, 14))
    parent = "ground"
    if rng.random() < 0.6:
        parent = based(rng, scene, moving(rng, rng.choice(JOINTS), "ground", size=length), mass, length)
    add(rng, scene, "beam", parent, one)
    force, ramp = bending_force(rng, one, -2, 0.7), ["0 s", "%.4g s" % (scene["duration"] * rng.uniform(0.05, 1))]
    along = ["%.5g m" % x for x in sorted(rng.uniform(0, length) for _ in range(2))]
    scene["loads"].append({"body": "beam", "at": "tip", "frame": "follower", "ramp": ramp,
                           "force": [force, digits(0.3 * force), digits(rng.uniform(-1, 0) * force)]})
    scene["loads"].append({"body": "beam", "along": along, "frame": rng.choice(["ground", "body", "follower"]), "ramp": ramp,
                           "force": [digits(force / length), 0, 0]})


FAMILIES = [buckling, late, shaken, resonance, string, thrown, gust, sections, brake, soft, sizes, torsion, impact, slider, followers]
AERODYNAMIC = (gust,)
STEADY = (shaken, string, brake)
