"""More families: machines that controllers and prescribed motions drive, and loads that a macro step does not
resolve."""
import json
import math

from families import (KINDS, blades, decades, digits, flexible, moving, rad, rigid, rod, turn)


def pulse(rng, duration, step):
    """Times and factors of a jump, a pulse shorter than a macro step, a train of pulses, or a zigzag."""
    start, short = duration * rng.uniform(0.05, 0.5), step * decades(rng, -2, 0.5)
    rise = short * rng.choice([1e-3, 0.1, 0.3])
    kind = rng.choice(["jump", "pulse", "pulse", "train", "zigzag"])
    if kind == "jump":
        times, values = [start, start + rise], [0, 1]
    elif kind == "zigzag":
        times = [start + k * short for k in range(8)]
        values = [0] + [rng.uniform(-1, 1) for _ in range(6)] + [0]
    else:
        times, values = [], []
        for k in range(1 if kind == "pulse" else 4):
            at = start + k * (3 * short + 2 * rise)
            times += [at, at + rise, at + rise + short, at + 2 * rise + short]
            values += [0, 1, 1, 0]
    size = duration / max(short, 1e-9) * 0.1 if kind in ("pulse", "train") else 1
    return {"times": [float("%.9g" % t) for t in times], "values": [digits(min(size, 30) * v) for v in values]}


def impulse(rng, scene):
    """Steps, pulses and zigzags of a load, at times within macro steps."""
    length, mass, step = decades(rng, -0.5, 1.5), decades(rng, -1, 2), scene["step"]
    parent = "ground"
    if rng.random() < 0.7:
        joint = moving(rng, rng.choice(("revolute", "prismatic", "universal", "free")), "ground", size=length)
        scene["bodies"].append(rigid("base", joint, mass * decades(rng, -2, 2), 0.2 * length, rng))
        parent = "base"
    one = rod(rng, length, mass, rng.randint(2, 6))
    scene["bodies"].append(flexible(rng, "beam", {"kind": "fixed", "parent": parent}, one, KINDS))
    force = digits(one["stiffness"][3] / length ** 2 * decades(rng, -2, -0.3))
    load = {"body": "beam", "at": "tip", "frame": "body", "force": [force, digits(0.3 * force), 0]}
    if parent == "base" and rng.random() < 0.5:
        load = {"body": "base", "frame": "body", "force": [force, 0, 0], "moment": [0, digits(force * length), 0]}
    scene["loads"].append(dict(load, factor=pulse(rng, scene["duration"], step)))
    if rng.random() < 0.3:
        start = scene["duration"] * rng.uniform(0.1, 0.9)
        scene["loads"].append(dict(load, ramp=["%.6g s" % start] * 2))


def dropped(rng, scene):
    """A distributed load, as a weight, that is switched on and off; gravity in any direction or none."""
    length, mass = decades(rng, -0.5, 1.5), decades(rng, -1, 2)
    scene["gravity"] = rng.choice([[0, 0, 0], [9.81, 0, 0], [3, -4, 5], [0, 0, 30]])
    one = rod(rng, length, mass, rng.randint(2, 6))
    joint = {"kind": "fixed", "parent": "ground"}
    if rng.random() < 0.5:
        scene["bodies"].append(rigid("hinge", moving(rng, rng.choice(("revolute", "universal", "spherical")), "ground"),
                                     mass * decades(rng, -3, 1), 0.1 * length, rng))
        joint = {"kind": "fixed", "parent": "hinge"}
    scene["bodies"].append(flexible(rng, "beam", joint, one))
    if rng.random() < 0.5:
        scene["bodies"].append(rigid("bob", {"kind": "fixed", "parent": "beam"}, mass * decades(rng, -2, 1),
                                     0.1 * length, rng))
    weight = digits(one["stiffness"][3] / length ** 3 * decades(rng, -2, 0))
    first, last = sorted(scene["duration"] * rng.uniform(0, 1) for _ in range(2))
    times = [float("%.9g" % t) for t in (first, first + 1e-6, last + 1e-5, last + 1.1e-5)]
    scene["loads"].append({"body": "beam", "along": ["0 m", "%.4g m" % length], "frame": "body",
                           "force": [weight, digits(weight * rng.uniform(-1, 1)), 0],
                           "factor": {"times": times, "values": [0, 1, 1, 0]}})


def stiff(rng, scene):
    """Arms behind stiff springs of joints, bushings, stays and stops."""
    length, mass = decades(rng, -0.5, 1), decades(rng, -1, 2)
    kind = rng.choice(("revolute", "prismatic"))
    carried = mass * decades(rng, -2, 1)
    inertia = (mass + carried) * (length ** 2 if kind == "revolute" else 1)
    joint = {"kind": kind, "axis": rng.choice("xy"), "parent": "ground"}
    joint["speed"] = turn(rng.uniform(-3, 3)) if kind == "revolute" else digits(length * rng.uniform(-1, 1))
    stiffness = inertia * (2 * math.pi * decades(rng, 0, 3)) ** 2
    ratio = rng.choice([0, 0, decades(rng, -4, -1.5)])
    if rng.random() < 0.5:
        joint.update(stiffness=digits(stiffness), damping=digits(ratio * stiffness * 0.01))
    else:
        free = rng.uniform(0.01, 0.5) * (1 if kind == "revolute" else length)
        unit = "rad" if kind == "revolute" else "m"
        joint.update(stop=["%.4g %s" % (-free, unit), "%.4g %s" % (free, unit)], stop_stiffness=digits(stiffness))
    scene["bodies"].append(rigid("base", joint, carried, 0.2 * length, rng))
    parent = "base"
    if rng.random() < 0.5:
        scene["bodies"].append(rigid("mount", {"kind": "free", "parent": "ground"}, carried, 0.2 * length, rng))
        linear = digits(carried * (2 * math.pi * decades(rng, 0.5, 2.5)) ** 2)
        angular = digits(linear * 0.04 * length ** 2)
        scene["bushings"] = [{"name": "mounting", "from": "base", "to": "mount", "stiffness": [linear] * 3,
                              "rotational_stiffness": [angular] * 3, "damping": [digits(ratio * linear * 0.01)] * 3}]
        parent = "mount"
    turned = {"kind": "fixed", "parent": parent, "placement": ["rotate y %.3g deg" % rng.uniform(-180, 180)]}
    scene["bodies"].append(flexible(rng, "arm", turned, rod(rng, length, mass, rng.randint(1, 4)), KINDS))
    if rng.random() < 0.4:
        scene["springs"] = [{"name": "stay", "from": "ground", "from_point": [digits(2 * length), 0.3, digits(length)],
                             "to": parent, "stiffness": digits(stiffness / length ** 2), "length": digits(2 * length)}]


def rods_loop(rng, scene):
    """A loop of flexible links: two to four rods in a row from the ground, their end pinned to the ground."""
    length, mass, count = decades(rng, -0.5, 0.8), decades(rng, -1, 1), rng.randint(2, 4)
    side = digits(length)
    turning = [rng.uniform(15, 80)] + [360 / (count + 1)] * (count - 1)
    parent, x, z, angle = "ground", 0.0, 0.0, 0.0
    for k in range(count):
        angle += turning[k]
        x, z = x + side * math.sin(math.radians(angle)), z + side * math.cos(math.radians(angle))
        joint = {"kind": "revolute", "axis": "y", "parent": parent, "placement": ["rotate y %.12g deg" % turning[k]]}
        if k == 0:
            joint["speed"] = turn(rng.uniform(-4, 4))
        scene["bodies"].append(rigid("pin%d" % (k + 1), joint, mass * decades(rng, -3, 0), 0.1 * length, rng))
        body = flexible(rng, "link%d" % (k + 1), {"kind": "fixed", "parent": "pin%d" % (k + 1)},
                        dict(rod(rng, side, mass * decades(rng, -0.5, 0.5), rng.randint(2, 3)), length=side))
        scene["bodies"].append(body)
        parent = "link%d" % (k + 1)
    scene["bodies"].append(rigid("end", {"kind": "fixed", "parent": parent}, mass * decades(rng, -3, 0), 0.1 * length, rng))
    scene["closures"] = [{"name": "pin", "kind": rng.choice(["spherical", "revolute"]), "from": "ground",
                          "from_placement": ["move x %.12g m" % x, "move z %.12g m" % z], "to": "end"}]
    if scene["closures"][0]["kind"] == "revolute":
        scene["closures"][0]["axis"] = "y"


def yawing(rng, scene):
    """A rotor on a mast whose head yaws, by a prescribed motion, a spring, or freely."""
    length, mass = decades(rng, -0.3, 1.6), decades(rng, -1, 2)
    base = "ground"
    if rng.random() < 0.7:
        scene["bodies"].append({"name": "mast", "fidelity": "rod", "joint": {"kind": "fixed", "parent": "ground"},
                                "rod": rod(rng, length, mass, rng.randint(2, 4))})
        base = "mast"
    head = mass * decades(rng, -1, 1)
    count, blade, wing = rng.randint(2, 3), mass * decades(rng, -1.5, 0), 0.5 * length
    carried = head * 0.04 * length ** 2 + count * blade * wing ** 2 / 3
    joint = {"kind": "revolute", "axis": "z", "parent": base}
    how = rng.choice(["motion", "motion", "spring", "free"])
    if how == "motion":
        end = scene["duration"] * rng.uniform(0.3, 1.2)
        joint["motion"] = {"angle": {"from": 0, "to": rad(rng.uniform(-1, 1)), "ramp": ["0 s", "%.3g s" % end]}}
    elif how == "spring":
        joint["stiffness"] = digits(carried * (2 * math.pi * decades(rng, -0.5, 1)) ** 2)
        joint["speed"] = turn(rng.uniform(-0.5, 0.5))
    else:
        joint["speed"] = turn(rng.uniform(-2, 2))
    scene["bodies"].append(rigid("head", joint, head, 0.2 * length, rng))
    inertia = count * blade * wing ** 2 / 3 * decades(rng, -3, 1)
    joint = {"kind": "revolute", "axis": "x", "parent": "head", "speed": turn(rng.uniform(0.5, 10)),
             "placement": ["move x %.3g m" % (-0.1 * length)]}
    scene["bodies"].append({"name": "hub", "fidelity": "rigid", "joint": joint, "mass": digits(10 * inertia / wing ** 2),
                            "inertia": [digits(inertia)] + [digits(0.6 * inertia)] * 2})
    blades(rng, scene, "hub", count, wing, blade, KINDS)


def undamped(rng, scene):
    """A rotor with a very light hub and blades of next to no damping, under a torque that comes by a step or ramp."""
    count, length = rng.randint(2, 3), decades(rng, -0.5, 1.8)
    mass = decades(rng, -1, 1) * length ** 2
    inertia = count * mass * length ** 2 / 3 * decades(rng, -6, -1)
    joint = {"kind": "revolute", "parent": "ground", "axis": "x", "speed": turn(rng.uniform(0, 3) / length ** 0.5)}
    scene["bodies"].append({"name": "hub", "fidelity": "rigid", "joint": joint, "mass": digits(inertia / length ** 2 * 3),
                            "inertia": [digits(inertia)] * 3})
    one = rod(rng, length, mass, rng.randint(3, 8), rng.choice([0, 0, decades(rng, -5, -3)]))
    for k in range(count):
        placed = ["rotate x %.4g deg" % (360 * k / count)]
        scene["bodies"].append(flexible(rng, "blade%d" % (k + 1), {"kind": "fixed", "parent": "hub", "placement": placed},
                                        one, ("rod", "rod", "rod", "modal")))
    start = scene["duration"] * rng.uniform(0, 0.4)
    end = start + rng.choice([0, 0.01, 0.1, scene["duration"]])
    torque = digits(rng.uniform(-1, 1) * one["stiffness"][3] / length)
    scene["loads"].append({"joint": "hub", "torque": torque, "ramp": ["%.6g s" % max(start, 1e-3), "%.6g s" % max(end, 1e-3)]})


def chain(rng, scene):
    """A chain of equal rigid bodies or rods on joints with springs, hung or thrown."""
    count, length, mass = rng.randint(3, 10), decades(rng, -1, 0.3), decades(rng, -1, 1)
    kind = rng.choice(("revolute", "universal", "spherical", "revolute"))
    joint = {"kind": kind, "parent": "ground", "placement": ["move z %.4g m" % -digits(length)]}
    if kind == "revolute":
        joint.update(axis="y", angle=rad(rng.uniform(-0.3, 0.3)))
        if rng.random() < 0.6:
            joint["stiffness"] = digits(mass * length ** 2 * (2 * math.pi * decades(rng, -0.5, 1.5)) ** 2)
            joint["damping"] = digits(joint["stiffness"] * rng.choice([0, decades(rng, -4, -2)]))
    if kind == "universal":
        joint.update(axis="x", second_axis="y", angles=[rad(rng.uniform(-0.3, 0.3)), rad(rng.uniform(-0.3, 0.3))])
    link = rigid("link", joint, mass, length, rng)
    link["repeat"] = count
    scene["bodies"].append(link)
    placed = {"kind": "fixed", "parent": "link%d" % count, "placement": ["rotate y %.4g deg" % rng.uniform(90, 270)]}
    scene["bodies"].append(flexible(rng, "tail", placed, rod(rng, 2 * length, mass * decades(rng, -1, 1), rng.randint(2, 4)),
                                    KINDS))


# -- small rotors in the wind ---------------------------------------------------------------------

def small_blade(rng, scene, length):
    """Blade elements of a small rotor and one polar, in files of the scene."""
    chord, polars = length * rng.uniform(0.05, 0.12), []
    for degrees in range(-180, 181, 10):
        a = math.radians(degrees)
        inner = abs(degrees) <= 10
        lift = 2 * math.pi * math.sin(a) if inner else math.sin(2 * a) * 1.1
        polars.append({"alpha": "%d deg" % degrees, "cl": digits(lift), "cd": digits(0.012 + 1.3 * math.sin(a) ** 2), "cm": 0})
    count = rng.randint(5, 9)
    stations = []
    for k in range(count):
        s = k / (count - 1)
        stations.append({"span": digits(s * length), "twist": "%.3g deg" % (12 * (1 - s) ** 2 + 1),
                         "chord": digits(chord * (1 - 0.6 * s)), "polar": "foil"})
    scene["files"] = {"small-blade.yaml": json.dumps({"stations": stations}),
                      "small-polars.yaml": json.dumps({"polars": [{"name": "foil", "table": polars}]})}


def blowing(rng, speed, height, duration):
    kind = rng.choice(["uniform", "power", "table", "table", "iec", "iec"])
    if kind == "table":
        times = [digits(duration * s) for s in (0, 0.2, 0.2 + rng.uniform(0.01, 0.3), 0.7, 1)]
        speeds = [digits(speed * rng.uniform(0.3, 1.6)) for _ in times]
        return {"kind": "uniform", "table": {"times": times, "speeds": speeds}}
    if kind == "iec":
        return {"kind": "iec", "condition": rng.choice(["ntm", "etm"]), "class": rng.choice(["IA", "IIB", "IIIC"]),
                "seed": rng.randint(0, 99), "points": 5, "reference_height": digits(height), "speed": digits(speed),
                "period": "%d s" % 20, "time_step": 0.05}
    wind = {"kind": kind, "speed": digits(speed)}
    if kind == "power":
        wind.update(reference_height=digits(height), exponent=digits(rng.uniform(0, 0.3)))
    if rng.random() < 0.4:
        wind.update(direction="%.3g deg" % rng.uniform(-40, 40))
    return wind


def small_rotor(rng, scene):
    """Two or three blades of 0.5 to 20 m in wind, pitched by prescribed motions or not at all."""
    scene["turbine"] = True
    length, count, kinds = decades(rng, -0.3, 1.3), rng.randint(2, 3), (rng.choice(KINDS),)
    mass = decades(rng, -0.3, 0.7) * length ** 2
    height, wind = digits(2 * length + 3), rng.uniform(4, 16)
    base, placed = "ground", ["move z %.4g m" % height]
    if rng.random() < 0.4:
        mast = rod(rng, height, mass * 10, rng.randint(2, 4))
        scene["bodies"].append({"name": "mast", "fidelity": "rod", "joint": {"kind": "fixed", "parent": "ground"}, "rod": mast})
        base, placed = "mast", []
    nacelle = {"kind": "fixed", "parent": base, "placement": placed}
    yaws = rng.choice(["no", "no", "motion", "spring"])
    if yaws == "motion":
        nacelle.update(kind="revolute", axis="z", motion={"angle": {"from": 0, "to": rad(rng.uniform(-0.6, 0.6)),
                                                                    "ramp": ["0 s", "%.4g s" % scene["duration"]]}})
    elif yaws == "spring":
        nacelle.update(kind="revolute", axis="z", stiffness=digits(count * mass * length ** 2 * decades(rng, 1, 3)))
    scene["bodies"].append(rigid("nacelle", nacelle, 5 * mass, 0.3 * length, rng))
    inertia = count * mass * length ** 2 / 3 * decades(rng, -3, 0.5)
    joint = {"kind": "revolute", "axis": "x", "parent": "nacelle", "speed": turn(rng.uniform(1, 7) * wind / length),
             "placement": ["rotate y %.3g deg" % rng.uniform(0, 6), "move x %.3g m" % (-0.3 * length)]}
    scene["bodies"].append({"name": "hub", "fidelity": "rigid", "joint": joint, "mass": digits(0.5 * mass),
                            "inertia": [digits(inertia)] + [digits(0.6 * inertia)] * 2})
    one = rod(rng, length, mass, rng.randint(4, 6))
    pitching = rng.random() < 0.5
    end = scene["duration"] * rng.uniform(0.1, 1)
    turned = {"from": 0, "to": rad(rng.uniform(-0.2, 1.2)), "ramp": ["0 s", "%.3g s" % end]}
    if rng.random() < 0.5:
        turned = {"times": [digits(end * k / 4) for k in range(5)],
                  "values": [0] + [rad(rng.uniform(-0.1, 0.4)) for _ in range(4)]}
    for k in range(count):
        joint = {"kind": "fixed", "parent": "hub",
                 "placement": ["rotate x %.6g deg" % (360 * k / count), "move z %.3g m" % (0.05 * length)]}
        if pitching:
            joint.update(kind="revolute", axis="z", motion={"angle": turned})
        scene["bodies"].append(flexible(rng, "blade%d" % (k + 1), joint, one, kinds))
    small_blade(rng, scene, one["length"])
    scene["extra"] = {"turbine": {"rotor": "hub", "blades": ["blade%d" % (k + 1) for k in range(count)]},
                      "aero": {"rate": 50, "wind": blowing(rng, wind, height, scene["duration"]),
                               "blade": "small-blade.yaml", "polars": "small-polars.yaml", "hub_radius": digits(0.05 * length),
                               "ramp": ["0 s", "%.3g s" % rng.choice([0, rng.uniform(0, 0.5)])],
                               "hold": rng.choice(["linear", "linear", "constant"]),
                               "dynamic_stall": rng.choice(["none", "none", "hgm"]),
                               "induction": {"inflow": rng.choice(["equilibrium", "equilibrium", "oye"])}}}
    torque = digits(-rng.uniform(0, 0.3) * wind ** 2 * length ** 3)
    scene["loads"].append({"joint": "hub", "torque": torque, "ramp": ["0 s", "%.3g s" % rng.uniform(0.02, 0.5)]})


def steered(rng, scene):
    """A 5 MW rotor of few segments under a controller, built in or a library, with events that stop or turn it."""
    scene["turbine"] = True
    scene["gravity"] = [0, 0, -9.80665]
    kinds = rng.choice([("rod",), ("rod",), ("modal",)])
    segments, base, lift = rng.randint(4, 8), "ground", ["move z 87.6 m"]
    if rng.random() < 0.5:
        scene["bodies"].append({"name": "tower", "fidelity": "rod", "joint": {"kind": "fixed", "parent": "ground"},
                                "rod": {"table": "tower-structure.yaml", "segments": rng.randint(3, 6)}})
        base, lift = "tower", []
    yaw = {"kind": "fixed", "parent": base, "placement": lift}
    events, late = [], scene["duration"] * rng.uniform(0.1, 0.6)
    kind = rng.choice(["none", "none", "emergency-stop", "stop", "grid-loss", "pitch-runaway", "pitch-stuck", "yaw-runaway"])
    if kind == "yaw-runaway":
        yaw.update(kind="revolute", axis="z", motion={"angle": "0 deg"})
        events = [{"kind": kind, "at": digits(late), "body": "nacelle", "angle": "20 deg", "rate": "0.2 rad/s"}]
    elif kind in ("pitch-runaway", "pitch-stuck"):
        events = [{"kind": kind, "at": digits(late), "blade": rng.randint(1, 3)}]
    elif kind != "none":
        events = [{"kind": kind, "at": digits(late)}]
    scene["bodies"].append({"name": "nacelle", "fidelity": "rigid", "joint": yaw, "mass": 2.4e5,
                            "centre_of_mass": [1.9, 0, 1.75], "inertia": [8.7e5, 8.7e5, 1.74149e6]})
    wind = rng.choice([6, 8, 11.4, 14, 20])
    inertia = digits(5.1414234e6 * rng.choice([1, 1, decades(rng, -2, 0.5)]))
    place = ["move z 1.96256 m", "rotate y 5 deg", "move x -5.0191 m"]
    scene["bodies"].append({"name": "hub", "fidelity": "rigid", "mass": 56780,
                            "inertia": [inertia, digits(0.5 * inertia), digits(0.5 * inertia)],
                            "joint": {"kind": "revolute", "axis": "x", "parent": "nacelle", "placement": place,
                                      "speed": turn(rng.uniform(0.7, 1.35))}})
    pitch = "%.3g deg" % {6: 0, 8: 0, 11.4: 0, 14: 8.5, 20: 17}[wind]
    for k in range(3):
        joint = {"kind": "revolute", "axis": "z", "parent": "hub", "motion": {"angle": pitch},
                 "placement": ["rotate x %d deg" % (120 * k), "rotate y -2.5 deg", "move z 1.5 m"]}
        scene["bodies"].append(flexible(rng, "blade%d" % (k + 1), joint,
                                        {"table": "blade-structure.yaml", "segments": segments}, kinds))
    control = {"kind": "variable-speed", "rate": 50, "gear_ratio": 97}
    if rng.random() < 0.4:
        control = {"kind": "bladed", "rate": 50, "gear_ratio": 97, "library": "libdiscon.so"}
        if rng.random() < 0.4:
            control.update(input="individual", individual_pitch=True)
            scene.setdefault("files", {})["individual"] = ""
    if events:
        control["events"] = events
    blow = {"kind": "uniform", "speed": wind}
    turbulent = rng.random()
    if turbulent < 0.3:
        blow = {"kind": "bts", "file": "turbulence.bts"}
    elif turbulent < 0.5:
        blow = blowing(rng, wind, 89.56, scene["duration"])
    scene["extra"] = {"turbine": {"rotor": "hub", "blades": ["blade1", "blade2", "blade3"]}, "control": control,
                      "aero": {"rate": 50, "wind": blow, "blade": "blade-aero.yaml", "polars": "airfoils.yaml",
                               "hub_radius": 1.5, "ramp": ["0 s", "%.3g s" % rng.uniform(0, 1)],
                               "hold": rng.choice(["linear", "linear", "constant"]),
                               "dynamic_stall": rng.choice(["none", "none", "hgm"]),
                               "induction": {"inflow": rng.choice(["equilibrium", "equilibrium", "oye"])}}}


FAMILIES = [impulse, dropped, stiff, rods_loop, yawing, undamped, chain, small_rotor, steered]
AERODYNAMIC = (small_rotor, steered)
