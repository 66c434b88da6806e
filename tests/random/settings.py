"""The settings of a random scene, and its text."""
import families
import families_hard
import families_loads
import families_machines
import families_variants
from families import decades, digits

FAMILIES, HARD, MACHINES = families.FAMILIES, families_hard.FAMILIES, families_machines.FAMILIES
VARIANTS, LOADS = families_variants.FAMILIES, families_loads.FAMILIES
# with loads sampled at 50 or 100 Hz, which the macro step must divide
AERODYNAMIC = (families.turbine, families.gale) + families_hard.AERODYNAMIC + families_loads.AERODYNAMIC + families_variants.AERODYNAMIC
STEADY = (families.driven, families.spin_up, families_hard.rods_loop) + families_loads.STEADY + families_variants.STEADY + AERODYNAMIC  # not from equilibrium


def micro(rng):
    solver = rng.choice(["cvode-bdf", "generalized-alpha", "arkode-esdirk", "rosenbrock"])
    settings = {"solver": solver, "rtol": decades(rng, -7, -3)}
    if solver in ("generalized-alpha", "rosenbrock"):
        settings["step"] = "%.3g ms" % rng.choice([0.5, 1, 2, 5, 10, 20])
    if solver == "generalized-alpha" and rng.random() < 0.5:
        settings["rho"] = digits(rng.uniform(0, 1))
    return settings


def coupling(rng, schemes):
    scheme = rng.choice(schemes)
    settings = {"scheme": scheme}
    if scheme in ("extrapolated", "iterated"):
        settings["order"] = rng.randint(0, 2)
    if scheme == "iterated":
        settings["exchange"] = rng.choice(["end-values", "waveform"])
        settings["accelerator"] = rng.choice(["none", "relaxation", "aitken", "iqn-ils", "iqn-ils", "interface-newton"])
    return settings


MACRO_STEPS = [1, 2, 2, 5, 5, 10, 10, 10, 20, 20, 20, 40, 80]  # [ms]
LONG_STEPS = [100, 200, 500]  # [ms] at times in the hard families


def make(rng, family, schemes, defaults, stage_coupled):
    """The scene as values, the word under which its scheme is counted, and the text of its files by name."""
    step = rng.choice(MACRO_STEPS)
    if family in AERODYNAMIC:
        step = rng.choice([5, 10, 20, 20])
    elif family in HARD and rng.random() < 0.15:
        step = rng.choice(LONG_STEPS)
    span = {1: 0.2, 2: 0.4, 5: 0.6, 10: 0.8}.get(step, 1.2)
    count = max(8, round(span * 1000 / step * rng.uniform(0.5, 1)))
    draft = {"bodies": [], "loads": [], "duration": count * step / 1000, "step": step / 1000}
    if rng.random() < 0.2:
        draft["gravity"] = [0, 0, 0]
    family(rng, draft)
    simulation = {"duration": "%.9g s" % draft["duration"], "macro_step": "%d ms" % step}
    word = "default"
    if not defaults:
        chosen = coupling(rng, schemes)
        word = chosen["scheme"]
        simulation["coupling"] = chosen
        simulation["micro"] = micro(rng)
        simulation["master"] = {"rtol": decades(rng, -8, -4)}
        if word == "monolithic" and stage_coupled and rng.random() < 0.6:
            simulation["master"]["solver"] = "rosenbrock"
            word = "stages"
        elif word != "monolithic" and rng.random() < 0.3:
            simulation["master"]["solver"] = "radau5"
        if word == "ramp" and rng.random() < 0.2:
            chosen["theta"] = digits(rng.uniform(0.5, 1))
        if word not in ("monolithic", "stages") and rng.random() < 0.15:
            simulation["step_control"] = {"tolerance": decades(rng, -4, -1.5)}
    if rng.random() < 0.15 and family not in STEADY:
        simulation["initial"] = "equilibrium"
    scene = {"title": "%s, %s" % (family.__name__, word), "simulation": simulation, "bodies": draft["bodies"]}
    for key in ("loads", "closures", "springs", "bushings", "gravity"):
        if draft.get(key):
            scene[key] = draft[key]
    scene.update(draft.get("extra", {}))
    return scene, word, draft.get("files", {})
