"""Random but plausible scenes: families of bodies. Everything follows from one random.Random; lengths, masses and stiffnesses are drawn by decades, frequencies and damping as built
structures have them."""
import math


def decades(rng, low, high):
    """10 to a power uniform in [low, high], of three digits: what the text of a scene shall show."""
    return float("%.3g" % 10 ** rng.uniform(low, high))


def digits(x):
    return float("%.4g" % x)


def rad(x):
    return "%.4g rad" % x


def turn(x):
    return "%.4g rad/s" % x


def rod(rng, length, mass, segments, damping=None):
    """A uniform rod by its first clamped bending frequency [Hz] and its slenderness."""
    m = mass / length
    frequency = min(decades(rng, -0.3, 1.3) / max(length, 0.2) ** 0.5, 60)
    bending = m * (2 * math.pi * frequency * length ** 2 / 3.516) ** 2
    slender = decades(rng, 2.5, 5.5)  # EA L²/EI
    axial = bending * slender / length ** 2
    ratio = rng.choice([1, 1, rng.uniform(1, 6)])
    inertia = m * length ** 2 / slender
    if damping is None:
        damping = rng.choice([0, decades(rng, -5, -2), decades(rng, -4, -2.3)])
    return {
        "length": digits(length), "segments": segments, "damping": [digits(damping)] * 6,
        "stiffness": [digits(s) for s in (axial / 2.6, axial / 2.6, axial, bending, ratio * bending, 0.77 * bending)],
        "mass": [digits(m), 0, 0, digits(inertia), digits(inertia), 0],
    }


def flexible(rng, name, joint, rod_, kinds=("rod",)):
    kind = rng.choice(kinds)
    body = {"name": name, "fidelity": kind, "joint": joint, "rod": rod_}
    if kind == "modal":
        body["modal"] = {"modes": rng.randint(3, 6)}
    if kind == "segmented-modal":
        body["rod"] = dict(rod_, segments=max(rod_["segments"], 4))
        body["modal"] = {"modes": rng.randint(2, 4), "pieces": rng.randint(2, 3)}
    return body


def rigid(name, joint, mass, size, rng):
    """A body of that mass and size; inertia and centre of mass at random within it."""
    parts = [mass * size ** 2 * rng.uniform(0.1, 0.4) for _ in range(3)]  # of x², y², z²
    inertia = [parts[1] + parts[2], parts[0] + parts[2], parts[0] + parts[1]]
    centre = [digits(size * rng.uniform(-0.1, 0.1)) if rng.random() < 0.4 else 0 for _ in range(3)]
    return {"name": name, "joint": joint, "fidelity": "rigid", "mass": digits(mass),
            "inertia": [digits(i) for i in inertia], "centre_of_mass": centre}


KINDS = ("rod", "rod", "rod", "modal", "segmented-modal")


def blades(rng, scene, hub, count, length, mass, kinds=("rod",), axis="x"):
    damping = rng.choice([0, decades(rng, -5, -2), decades(rng, -4, -2.3)])
    one = rod(rng, length, mass, rng.randint(1, 5), damping)
    for k in range(count):
        turned = ["rotate %s %.4g deg" % (axis, 360 * k / count)]
        if rng.random() < 0.3:
            turned.append("rotate y %.3g deg" % rng.uniform(-10, 10))
        placed = turned + ["move z %.3g m" % (0.05 * length)]
        joint = {"kind": "fixed", "parent": hub, "placement": placed}
        scene["bodies"].append(flexible(rng, "blade%d" % (k + 1), joint, one, kinds))


def rotor(rng, scene):
    """One to five blades on a hub of 1e-4 to 100 times their inertia about the shaft."""
    count, length = rng.randint(1, 5), decades(rng, -0.7, 1.8)
    mass = decades(rng, -1, 1) * length ** 2
    inertia = count * mass * length ** 2 / 3 * decades(rng, -4, 2)
    joint = {"kind": "revolute", "parent": "ground", "axis": "x",
             "speed": turn(rng.uniform(0.2, 4) * min(8, 3 / length ** 0.5))}
    hub = {"name": "hub", "fidelity": "rigid", "joint": joint, "mass": digits(inertia / length ** 2 * 3),
           "inertia": [digits(inertia)] + [digits(0.6 * inertia)] * 2}
    scene["bodies"].append(hub)
    blades(rng, scene, "hub", count, length, mass, KINDS)
    if rng.random() < 0.4:
        torque = inertia * rng.uniform(-5, 5) + count * mass * length ** 2 * rng.uniform(-2, 2)
        scene["loads"].append({"joint": "hub", "torque": digits(torque),
                               "ramp": ["0 s", "%.3g s" % rng.uniform(0.05, 0.5)]})


JOINTS = ("revolute", "prismatic", "planar", "universal", "spherical", "cylindrical", "free")


def moving(rng, kind, parent, placement=None, size=1.0):
    joint = {"kind": kind, "parent": parent}
    if placement:
        joint["placement"] = placement
    axis = rng.choice("xy")
    if kind in ("revolute", "prismatic", "planar", "universal", "cylindrical"):
        joint["axis"] = axis
    if kind == "universal":
        joint["second_axis"] = "y" if axis == "x" else "x"
        joint["angular_speeds"] = [turn(rng.uniform(-3, 3)), turn(rng.uniform(-3, 3))]
    elif kind == "revolute":
        joint["speed"] = turn(rng.uniform(-4, 4))
        joint["angle"] = rad(rng.uniform(-1, 1))
        if rng.random() < 0.2:
            joint["stiffness"] = decades(rng, -1, 3)
    elif kind == "prismatic":
        joint["speed"] = digits(size * rng.uniform(-2, 2))
        joint["stiffness"] = decades(rng, 0, 4)
    elif kind == "planar":
        joint["speeds"] = [digits(size * rng.uniform(-1, 1)), digits(size * rng.uniform(-1, 1))]
    elif kind == "cylindrical":
        joint["angular_speed"] = turn(rng.uniform(-4, 4))
    elif kind in ("spherical", "free"):
        joint["angular_velocity"] = [turn(rng.uniform(-2, 2)) for _ in range(3)]
    return joint


def arm(rng, scene):
    """A carriage on any joint, with an arm of 0.01 to 30 times its mass."""
    length, mass = decades(rng, -0.5, 1), decades(rng, -1, 2)
    carriage = mass * decades(rng, -1.5, 2)
    joint = moving(rng, rng.choice(JOINTS), "ground", size=length)
    scene["bodies"].append(rigid("carriage", joint, carriage, 0.1 * length, rng))
    turned = ["rotate %s %.3g deg" % (rng.choice("xyz"), rng.uniform(-180, 180))]
    joint = {"kind": "fixed", "parent": "carriage", "placement": turned}
    scene["bodies"].append(flexible(rng, "arm", joint, rod(rng, length, mass, rng.randint(1, 5)), KINDS))


def hung(rng, scene):
    """Rods that hang in a row from hinges, the last with a body."""
    length, mass, parent, placed = decades(rng, -0.5, 0.7), decades(rng, -1, 1), "ground", []
    for k in range(rng.randint(1, 2)):
        light = mass * decades(rng, -2, 0.5)
        joint = moving(rng, rng.choice(("revolute", "universal", "spherical")), parent, placed)
        scene["bodies"].append(rigid("hinge%d" % (k + 1), joint, light, 0.1 * length, rng))
        joint = {"kind": "fixed", "parent": "hinge%d" % (k + 1), "placement": ["rotate y 180 deg"]}
        scene["bodies"].append(flexible(rng, "rod%d" % (k + 1), joint, rod(rng, length, mass, rng.randint(2, 4))))
        parent, placed = "rod%d" % (k + 1), ["rotate y 180 deg"]
    if rng.random() < 0.6:
        joint = {"kind": "fixed", "parent": parent}
        scene["bodies"].append(rigid("bob", joint, mass * decades(rng, -2, 1), 0.1 * length, rng))


def mast(rng, scene, length, mass):
    placed = rng.choice([[], ["rotate y 180 deg"], ["rotate x %.3g deg" % rng.uniform(-90, 90)]])
    joint = {"kind": "fixed", "parent": "ground", "placement": placed}
    scene["bodies"].append({"name": "mast", "fidelity": "rod", "joint": joint,
                            "rod": rod(rng, length, mass, rng.randint(2, 4))})
    head = mass * decades(rng, -2, 1.5)
    scene["bodies"].append(rigid("head", {"kind": "fixed", "parent": "mast"}, head, 0.2 * length, rng))


def carrying(rng, scene):
    """A mast that carries a head, with a side arm on it, fixed or hinged."""
    length, mass = decades(rng, -0.5, 1.5), decades(rng, -1, 2)
    mast(rng, scene, length, mass)
    if rng.random() < 0.5:
        return
    parent = "head"
    if rng.random() < 0.5:
        joint = moving(rng, "revolute", "head")
        scene["bodies"].append(rigid("hinge", joint, mass * decades(rng, -3, 0), 0.1 * length, rng))
        parent = "hinge"
    joint = {"kind": "fixed", "parent": parent, "placement": ["rotate y 90 deg"]}
    scene["bodies"].append(flexible(rng, "side", joint, rod(rng, 0.7 * length, mass * decades(rng, -1.5, 0.3),
                                                            rng.randint(1, 3)), KINDS))


def tower(rng, scene):
    """A rotor on a mast."""
    length, mass = decades(rng, -0.5, 1.8), decades(rng, -1, 2)
    mast(rng, scene, length, mass)
    count, blade, wing = rng.randint(1, 3), mass * decades(rng, -1, 0), 0.5 * length
    inertia = count * blade * wing ** 2 / 3 * decades(rng, -4, 2)
    joint = {"kind": "revolute", "axis": "x", "parent": "head", "speed": turn(rng.uniform(0.5, 8)),
             "placement": ["move x %.3g m" % (-0.1 * length)]}
    hub = {"name": "hub", "fidelity": "rigid", "joint": joint, "mass": digits(10 * inertia / wing ** 2),
           "inertia": [digits(inertia)] + [digits(0.6 * inertia)] * 2}
    scene["bodies"].append(hub)
    blades(rng, scene, "hub", count, wing, blade)


def four_bar(rng, scene):
    """Crank, coupler, rocker, and a rod as arm on one of them."""
    mass = decades(rng, -1, 2)
    thin = lambda along: [digits(m * mass) for m in along]
    scene["bodies"] += [
        {"name": "crank", "fidelity": "rigid", "mass": mass, "inertia": thin([0.02, 0.02, 0.0003]),
         "joint": {"kind": "revolute", "axis": "y", "parent": "ground", "angle": "0.35 rad",
                   "speed": turn(rng.choice([-1, 1]) * rng.uniform(0.5, 7))}},
        {"name": "coupler", "fidelity": "rigid", "mass": mass, "centre_of_mass": [0.5, 0, 0],
         "inertia": thin([0.001, 0.084, 0.084]),
         "joint": {"kind": "revolute", "axis": "y", "parent": "crank", "placement": ["move z 0.5 m"],
                   "angle": "-0.42 rad"}},
        {"name": "rocker", "fidelity": "rigid", "mass": mass, "centre_of_mass": [0, 0, 0.28],
         "inertia": thin([0.025, 0.025, 0.0003]),
         "joint": {"kind": "revolute", "axis": "y", "parent": "ground", "placement": ["move x 1.1 m"],
                   "angle": "0.12 rad"}}]
    scene["closures"] = [{"name": "pin", "kind": rng.choice(["spherical", "revolute"]), "from": "coupler",
                          "from_placement": ["move x 1 m"], "to": "rocker", "to_placement": ["move z 0.55 m"]}]
    if scene["closures"][0]["kind"] == "revolute":
        scene["closures"][0]["axis"] = "y"
    joint = {"kind": "fixed", "parent": rng.choice(["crank", "coupler", "rocker", "rocker"]),
             "placement": ["rotate y %.3g deg" % rng.choice([0, 0, rng.uniform(-180, 180)])]}
    scene["bodies"].append(flexible(rng, "arm", joint, rod(rng, rng.uniform(0.2, 1), mass * decades(rng, -1.5, 0.5),
                                                           rng.randint(1, 4)), KINDS))


def mechanism(rng, scene):
    """A chain of rigid links with springs between some, the last with a rod; or a slider on a rod's crank."""
    length, mass, parent, placed = decades(rng, -0.7, 0.5), decades(rng, -1, 1), "ground", []
    count = rng.randint(1, 3)
    for k in range(count):
        joint = moving(rng, rng.choice(("revolute", "revolute", "universal", "prismatic", "spherical")), parent,
                       placed, length)
        scene["bodies"].append(rigid("link%d" % (k + 1), joint, mass * decades(rng, -0.7, 0.7), length, rng))
        parent, placed = "link%d" % (k + 1), ["move z %.3g m" % (-length)]
    joint = {"kind": "fixed", "parent": parent, "placement": placed + ["rotate y %.3g deg" % rng.uniform(-180, 180)]}
    scene["bodies"].append(flexible(rng, "arm", joint, rod(rng, length, mass * decades(rng, -1.5, 0.5),
                                                           rng.randint(1, 4)), KINDS))
    if rng.random() < 0.5:
        scene["springs"] = [{"name": "stay", "from": "ground", "from_point": [digits(3 * length), digits(length), 0],
                             "to": parent, "stiffness": decades(rng, 0, 4), "length": digits(2 * length),
                             "damping": rng.choice([0, decades(rng, -1, 1)])}]


def driven(rng, scene):
    """A body whose motion is prescribed by a ramp or a table, with arms."""
    length, mass = decades(rng, -0.5, 1.3), decades(rng, -1, 2)
    end = scene["duration"] * rng.uniform(0.2, 1.2)
    slides = rng.random() < 0.4
    size, unit, what = (length, "m", "position") if slides else (rng.uniform(0.2, 3), "rad", "angle")
    if rng.random() < 0.6:
        values = {"from": 0, "to": "%.3g %s" % (rng.uniform(-1, 1) * size, unit), "ramp": ["0 s", "%.3g s" % end]}
    else:
        times = [digits(end * k / 4) for k in range(5)]
        values = {"times": times, "values": [0] + ["%.3g %s" % (rng.uniform(-0.3, 0.3) * size, unit) for _ in range(4)]}
    if not slides and rng.random() < 0.4:
        what, values = "speed", {"from": 0, "to": turn(rng.uniform(-6, 6)), "ramp": ["0 s", "%.3g s" % end]}
    joint = {"kind": "prismatic" if slides else "revolute", "axis": rng.choice("xy"), "parent": "ground",
             "motion": {what: values}}
    scene["bodies"].append(rigid("base", joint, mass, 0.2 * length, rng))
    parent = "base"
    if rng.random() < 0.4:
        joint = moving(rng, rng.choice(("revolute", "universal")), "base", ["move z %.3g m" % (0.3 * length)])
        scene["bodies"].append(rigid("hinge", joint, mass * decades(rng, -2, 0), 0.1 * length, rng))
        parent = "hinge"
    for k in range(rng.randint(1, 2)):
        joint = {"kind": "fixed", "parent": parent, "placement": ["rotate y %.3g deg" % (rng.uniform(-90, 90))]}
        scene["bodies"].append(flexible(rng, "arm%d" % (k + 1), joint,
                                        rod(rng, length, mass * decades(rng, -1, 1), rng.randint(1, 4)), KINDS))


def light(rng, scene):
    """Bodies next to nothing, or without any mass, between and on rods."""
    length, mass = decades(rng, -0.5, 1), decades(rng, -1, 1)
    tiny = mass * decades(rng, -6, -2)
    joint = moving(rng, rng.choice(("revolute", "universal", "prismatic", "spherical")), "ground", size=length)
    scene["bodies"].append(rigid("hinge", joint, tiny, 0.05 * length, rng))
    joint = {"kind": "fixed", "parent": "hinge", "placement": ["rotate y %.3g deg" % rng.uniform(-180, 180)]}
    scene["bodies"].append(flexible(rng, "arm", joint, rod(rng, length, mass, rng.randint(2, 4))))
    tip = {"name": "tip", "fidelity": "rigid", "joint": {"kind": "fixed", "parent": "arm"}}
    if rng.random() < 0.5:
        tip.update(mass=digits(tiny), inertia=[digits(tiny * length ** 2 * 1e-3)] * 3)
    scene["bodies"].append(tip)


def loaded(rng, scene):
    """A cantilever or a swinging arm under tip loads that come by a ramp or follow a table."""
    length, mass = decades(rng, -0.5, 1.5), decades(rng, -1, 2)
    parent = "ground"
    if rng.random() < 0.6:
        joint = moving(rng, rng.choice(("revolute", "prismatic")), "ground", size=length)
        scene["bodies"].append(rigid("base", joint, mass * decades(rng, -2, 2), 0.2 * length, rng))
        parent = "base"
    one = rod(rng, length, mass, rng.randint(2, 6))
    scene["bodies"].append(flexible(rng, "beam", {"kind": "fixed", "parent": parent}, one))
    force = digits(one["stiffness"][3] / length ** 2 * decades(rng, -1.5, 0.3))
    start = rng.choice([0, scene["duration"] * rng.uniform(0, 0.5)])
    frame = "body" if rng.random() < 0.5 or parent != "ground" else "ground"
    scene["loads"].append({"body": "beam", "at": "tip", "force": [force, digits(0.3 * force), 0],
                           "frame": rng.choice([frame, "follower"]),
                           "ramp": ["%.3g s" % start, "%.3g s" % (start + rng.uniform(0.01, 0.5))]})


def drive_train(rng, scene):
    """Two rotors on one shaft with a torsional spring, the first with blades."""
    length, mass, count = decades(rng, -0.3, 1.8), decades(rng, -1, 2), rng.randint(2, 3)
    inertia = count * mass * length ** 2 / 3
    speed = rng.uniform(0.3, 6)
    hub = digits(inertia * decades(rng, -3, 0.5))
    scene["bodies"].append({"name": "hub", "fidelity": "rigid", "mass": digits(mass), "inertia": [hub, hub, hub],
                            "joint": {"kind": "revolute", "parent": "ground", "axis": "x", "speed": turn(speed)}})
    other = inertia * decades(rng, -2, 1)
    frequency = 2 * math.pi * decades(rng, -0.3, 1.2)
    stiffness = frequency ** 2 / (1 / other + 1 / (inertia + hub))
    scene["bodies"].append({"name": "generator", "fidelity": "rigid", "inertia": [digits(other), 0, 0],
                            "joint": {"kind": "revolute", "parent": "hub", "axis": "x", "stiffness": digits(stiffness),
                                      "damping": digits(stiffness * decades(rng, -4, -1.5))}})
    blades(rng, scene, "hub", count, length, mass)
    torque = digits(inertia * rng.uniform(-4, 4))
    scene["loads"].append({"joint": "generator", "torque": torque, "ramp": ["0 s", "%.3g s" % rng.uniform(0.02, 0.5)]})


def turbine(rng, scene):
    """A 5 MW rotor with few segments in steady or turbulent wind, free, braked or controlled; tower or none."""
    scene["turbine"] = True
    scene["gravity"] = [0, 0, -9.80665]
    kinds = rng.choice([("rod",), ("rod",), ("modal",), ("segmented-modal",)])
    segments, base = rng.randint(4, 8), "ground"
    if rng.random() < 0.5:
        scene["bodies"].append({"name": "tower", "fidelity": "rod", "joint": {"kind": "fixed", "parent": "ground"},
                                "rod": {"table": "tower-structure.yaml", "segments": rng.randint(3, 6)}})
        base, lift = "tower", []
    else:
        lift = ["move z 87.6 m"]
    nacelle = {"kind": "fixed", "parent": base, "placement": lift}
    if rng.random() < 0.4:
        nacelle.update(kind="revolute", axis="z", stiffness=9.02832e9, damping=1.916e7)
    scene["bodies"].append({"name": "nacelle", "fidelity": "rigid", "joint": nacelle, "mass": 2.4e5,
                            "centre_of_mass": [1.9, 0, 1.75], "inertia": [8.7e5, 8.7e5, 1.74149e6]})
    controlled = rng.random() < 0.6
    speed = rng.uniform(0.5, 1.4) if not controlled else rng.uniform(0.9, 1.3)
    place = ["move z 1.96256 m", "rotate y 5 deg", "move x -5.0191 m"]
    flexible_shaft = not controlled and rng.random() < 0.5
    inertia = (115926 if flexible_shaft else 5.1414234e6) * rng.choice([1, 1, decades(rng, -1, 1)])
    scene["bodies"].append({"name": "hub", "fidelity": "rigid", "mass": 56780,
                            "inertia": [digits(inertia), digits(0.5 * inertia), digits(0.5 * inertia)],
                            "joint": {"kind": "revolute", "axis": "x", "parent": "nacelle", "placement": place,
                                      "speed": turn(speed)}})
    if flexible_shaft:
        scene["bodies"].append({"name": "generator", "fidelity": "rigid", "inertia": [5.0254974e6, 0, 0],
                                "joint": {"kind": "revolute", "axis": "x", "parent": "hub", "stiffness": 8.67637e8,
                                          "damping": 6.215e6}})
    wind = rng.choice([8, 11.4, 14, 20])
    pitch = "%.3g deg" % {8: 0, 11.4: 0, 14: 6.5, 20: 15}[wind]
    for k in range(3):
        joint = {"kind": "fixed", "parent": "hub"}
        joint["placement"] = ["rotate x %d deg" % (120 * k), "rotate y -2.5 deg", "move z 1.5 m"]
        if controlled:
            joint.update(kind="revolute", axis="z", motion={"angle": "0 deg"})
        body = flexible(rng, "blade%d" % (k + 1), joint, {"table": "blade-structure.yaml", "segments": segments}, kinds)
        if not controlled:
            body["pitch"] = pitch
        scene["bodies"].append(body)
    scene["extra"] = {"turbine": {"rotor": "hub", "blades": ["blade1", "blade2", "blade3"]}}
    blowing = {"kind": "uniform", "speed": wind}
    if rng.random() < 0.4:
        blowing = {"kind": "bts", "file": "turbulence.bts"}
    scene["extra"]["aero"] = {
        "rate": 50, "wind": blowing, "blade": "blade-aero.yaml", "polars": "airfoils.yaml", "hub_radius": 1.5,
        "ramp": ["0 s", "%.3g s" % rng.uniform(0, 1)], "hold": rng.choice(["linear", "linear", "constant"]),
        "dynamic_stall": rng.choice(["none", "none", "hgm"]),
        "induction": {"inflow": rng.choice(["equilibrium", "equilibrium", "oye"])}}
    if controlled:
        scene["extra"]["control"] = {"kind": "variable-speed", "rate": 50, "gear_ratio": 97}
    else:
        scene["loads"].append({"joint": "hub", "torque": digits(-rng.uniform(0, 1.2e7)),
                               "ramp": ["0 s", "%.3g s" % rng.uniform(0.1, 1)]})


def gale(rng, scene):
    """The same in winds beyond its operation: outside the polars and the models, but not outside the promise."""
    turbine(rng, scene)
    scene["extra"]["aero"]["wind"] = {"kind": "uniform", "speed": rng.choice([30, 45, 60, 90])}


def portal(rng, scene):
    """Two flexible masts whose heads a rigid beam joins to a loop, pushed aside."""
    length, mass, width = decades(rng, -0.3, 1.3), decades(rng, -1, 2), rng.uniform(0.4, 1.5)
    one, width = rod(rng, length, mass, rng.randint(2, 4)), digits(width * length)
    for k in range(2):
        placed = ["move x %.4g m" % (k * width)]
        name, parent = "mast%d" % (k + 1), "ground"
        if k == 1 and rng.random() < 0.4:
            joint = {"kind": "revolute", "axis": "y", "parent": "ground", "placement": placed}
            scene["bodies"].append(rigid("foot", joint, mass * decades(rng, -3, 0), 0.1 * length, rng))
            parent, placed = "foot", []
        scene["bodies"].append({"name": name, "fidelity": "rod", "rod": one,
                                "joint": {"kind": "fixed", "parent": parent, "placement": placed}})
        scene["bodies"].append(rigid("head%d" % (k + 1), {"kind": "fixed", "parent": name}, mass * decades(rng, -3, 0.5),
                                     0.1 * length, rng))
    beam = mass * decades(rng, -2, 1)
    thin = [digits(beam * width ** 2 * x) for x in (1e-3, 0.084, 0.084)]
    scene["bodies"].append({"name": "beam", "fidelity": "rigid", "mass": digits(beam), "inertia": thin,
                            "centre_of_mass": [0.5 * width, 0, 0],
                            "joint": {"kind": "revolute", "axis": "y", "parent": "head1"}})
    scene["closures"] = [{"name": "pin", "kind": "spherical", "from": "beam", "from_placement": ["move x %.4g m" % width],
                          "to": "head2"}]
    push = digits(one["stiffness"][3] / length ** 2 * decades(rng, -2, -0.3))
    scene["loads"].append({"body": "beam", "force": [push, digits(0.1 * push), 0], "frame": "ground",
                           "ramp": ["0 s", "%.3g s" % rng.uniform(0.02, 0.5)]})


def slider_crank(rng, scene):
    """A flexible connecting rod between a crank and a piston on a guide."""
    length, mass = decades(rng, -0.5, 0.7), decades(rng, -1, 1)
    radius = digits(length * rng.uniform(0.1, 0.4))
    speed = rng.choice([-1, 1]) * rng.uniform(1, 10)
    crank = mass * decades(rng, -0.5, 1.5)
    scene["bodies"] += [
        rigid("crank", {"kind": "revolute", "axis": "y", "parent": "ground", "speed": turn(speed)}, crank, radius, rng),
        rigid("pin", {"kind": "revolute", "axis": "y", "parent": "crank", "placement": ["move z %.4g m" % radius]},
              mass * decades(rng, -3, -0.5), 0.1 * length, rng),
        {"name": "conrod", "fidelity": "rod", "rod": dict(rod(rng, length, mass, rng.randint(2, 4)), length=digits(length)),
         "joint": {"kind": "fixed", "parent": "pin", "placement": ["rotate y 90 deg"]}},
        rigid("piston", {"kind": "revolute", "axis": "y", "parent": "conrod"}, mass * decades(rng, -2, 1), 0.1 * length, rng)]
    scene["closures"] = [{"name": "guide", "kind": "prismatic", "axis": "x", "from": "ground",
                          "from_placement": ["move x %.4g m" % digits(length), "move z %.4g m" % radius], "to": "piston",
                          "to_placement": ["rotate y -90 deg"]}]


def spin_up(rng, scene):
    """A beam that is brought to turn fast: growth that the mechanics makes."""
    length, mass = decades(rng, -0.3, 1.2), decades(rng, -1, 2)
    one = rod(rng, length, mass, rng.choice([3, 6, 10]))
    first = 3.516 * math.sqrt(one["stiffness"][3] / one["mass"][0]) / length ** 2
    speed = {"from": 0, "to": turn(rng.uniform(0.2, 2) * first), "ramp": ["0 s", "%.3g s" % scene["duration"]]}
    joint = {"kind": "revolute", "axis": rng.choice("xy"), "parent": "ground", "motion": {"speed": speed}}
    scene["bodies"].append({"name": "axle", "fidelity": "rigid", "joint": joint, "mass": digits(mass),
                            "inertia": [digits(mass)] * 3})
    for k in range(rng.randint(1, 2)):
        scene["bodies"].append({"name": "beam%d" % (k + 1), "fidelity": "rod", "rod": one,
                                "joint": {"kind": "fixed", "parent": "axle", "placement": ["rotate x %d deg" % (180 * k)]}})


FAMILIES = [rotor, arm, hung, carrying, tower, four_bar, mechanism, driven, light, loaded, drive_train, turbine, gale,
            portal, slider_crank, spin_up]
