"""Variants of the other families: sudden starts, overspeed, more segments, little damping, turbulence, stiff rods without
damping, loops of finer rods."""
import math

import families
import families_hard
import families_machines
from families import KINDS, decades, digits, flexible, rigid, rod, turn


def set_rods(scene, **values):
    for body in scene["bodies"]:
        if "rod" in body:
            body["rod"] = dict(body["rod"], **values)


def sudden(rng, scene):
    """Everything starts at once: full loads and full speed at time 0, from rest shapes."""
    rng.choice([families.rotor, families.arm, families.loaded, families.tower, families_machines.vehicle])(rng, scene)
    set_rods(scene, segments=rng.randint(2, 8))
    for load in scene["loads"]:
        load.pop("ramp", None)
        load.pop("factor", None)


def overspeed(rng, scene):
    """A rotor in wind at 1.5 to 4 times its speed, whose torque is lost."""
    families_hard.small_rotor(rng, scene)
    set_rods(scene, segments=rng.randint(4, 8))
    hub = next(body for body in scene["bodies"] if body["name"] == "hub")
    hub["joint"]["speed"] = turn(float(hub["joint"]["speed"].split()[0]) * rng.uniform(1.5, 4))
    scene["loads"].clear()


def medium(rng, scene):
    """Rods of four to eight segments, every damping."""
    rng.choice([families.rotor, families.hung, families.carrying, families.mechanism, families.light, families.driven,
                families_machines.flapping, families_hard.yawing])(rng, scene)
    set_rods(scene, segments=rng.randint(4, 8))


def fine(rng, scene):
    """Rods of nine to sixteen segments, whose companion has half of them."""
    rng.choice([families.rotor, families.arm, families.tower, families.loaded, families.four_bar, families.light])(rng, scene)
    set_rods(scene, segments=rng.randint(9, 16))


def low_damped(rng, scene):
    """Blades with a stiffness-proportional damping of 5e-4 s, as built blades have."""
    rng.choice([families.rotor, families.tower, families.drive_train, families_hard.undamped])(rng, scene)
    set_rods(scene, segments=rng.randint(3, 10), damping=[5e-4] * 6)


def turbulent(rng, scene):
    """A small rotor with blades of next to no damping in turbulence."""
    families_hard.small_rotor(rng, scene)
    set_rods(scene, segments=rng.randint(4, 8), damping=[5e-4] * 6)
    length = next(body["rod"]["length"] for body in scene["bodies"] if body["name"] == "blade1")
    scene["extra"]["aero"]["wind"] = {
        "kind": "iec", "condition": rng.choice(["ntm", "etm"]), "class": rng.choice(["IA", "IIB", "IIIC"]),
        "seed": rng.randint(0, 999), "points": 5, "reference_height": digits(2 * length + 3), "speed": digits(rng.uniform(5, 20)),
        "period": "20 s", "time_step": 0.05}


def stiff_rods(rng, scene):
    """Undamped rods of 50 to 2000 Hz on moving bases: vibrations that no step resolves."""
    length, mass = decades(rng, -1, 0.7), decades(rng, -1, 2)
    joint = families.moving(rng, rng.choice(families.JOINTS), "ground", size=length)
    scene["bodies"].append(rigid("base", joint, mass * decades(rng, -2, 1), 0.2 * length, rng))
    one = rod(rng, length, mass, rng.randint(2, 8), 0)
    frequency = math.sqrt(one["stiffness"][3] / one["mass"][0]) * 3.516 / length ** 2 / (2 * math.pi)
    stiffer = (decades(rng, 1.7, 3.3) / frequency) ** 2
    one["stiffness"] = [digits(stiffer * x) for x in one["stiffness"]]
    for k in range(rng.randint(1, 3)):
        placed = ["rotate %s %.4g deg" % (rng.choice("xy"), rng.uniform(-180, 180))]
        scene["bodies"].append(flexible(rng, "rod%d" % (k + 1), {"kind": "fixed", "parent": "base", "placement": placed}, one,
                                        KINDS))
    if rng.random() < 0.5:
        scene["bodies"].append(rigid("bob", {"kind": "fixed", "parent": "rod1"}, mass * decades(rng, -2, 1), 0.1 * length, rng))
        scene["bodies"][1].update(fidelity="rod")
        scene["bodies"][1].pop("modal", None)
    if rng.random() < 0.5:
        force = digits(one["stiffness"][3] / length ** 2 * decades(rng, -4, -2))
        load = {"body": "base", "frame": "body", "force": [force, 0, 0], "moment": [0, digits(force * length), 0]}
        scene["loads"].append(dict(load, factor=families_hard.pulse(rng, scene["duration"], scene["step"])))


def loops(rng, scene):
    """Closed loops with rods of four to eight segments."""
    rng.choice([families.portal, families.four_bar, families.slider_crank, families_hard.rods_loop,
                families_machines.parallelogram])(rng, scene)
    set_rods(scene, segments=rng.randint(4, 8))


FAMILIES = [sudden, overspeed, medium, fine, low_damped, turbulent, stiff_rods, loops]
AERODYNAMIC = (overspeed, turbulent)
STEADY = (loops,)
