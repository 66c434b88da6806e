"""Random trees of rods and rigid bodies under dead loads: every equilibrium that `bough static` finds is one.

random_statics.py BOUGH --seed N --count K [--keep FOLDER]. A tree has one to six bodies on fixed, revolute, spherical
and universal joints. A run from the equilibrium must stay where it is; one that the program calls unstable may
leave. Where segments are too long for an equilibrium, the program says how many times as many have one, and with
these it must be found. Exit code 1 if an equilibrium moves, if the program hangs or ends otherwise, or if more than
a fiftieth of the trees have none.
"""
import argparse
import collections
import os
import random
import re
import subprocess
import sys
import tempfile

LIMIT = 60  # of a command [s]
STILL = 1e-4  # largest motion of a run from equilibrium over the length of the tree's rods


def joint(r, first, parent, size):
    kind = r.choice(["fixed", "fixed", "fixed", "revolute"] if first else
                    ["fixed", "fixed", "revolute", "spherical", "universal"])
    text = f"kind: {kind}, parent: {parent}"
    if kind == "revolute":
        text += f", axis: {r.choice('xyz')}"
        if r.random() < 0.6:
            text += f", stiffness: {10 ** r.uniform(1, 5):.3g}"
    if kind == "universal":
        text += ", axis: x, second_axis: y"
    steps = [f"rotate {r.choice('xyz')} {r.uniform(-120, 120):.1f} deg" for _ in range(r.randint(0, 2))]
    if r.random() < 0.3:
        steps.append(f"move {r.choice('xyz')} {r.uniform(-0.3, 0.3) * size:.3g} m")
    return text + (", placement: [" + ", ".join(steps) + "]" if steps else "")


def rod(r, length, mass):
    bend = mass * 9.81 * length ** 3 * 10 ** r.uniform(-1, 2.5)
    axial = bend / length ** 2 * 10 ** r.uniform(2, 5)
    turning = mass * 1e-3 * length ** 2
    stiffness = [axial / 2.6, axial / 2.6, axial, bend, bend * r.uniform(0.5, 3), 0.7 * bend]
    return ("rod: {length: %.4g, segments: %d, stiffness: [%s], mass: [%.4g, 0, 0, %.3g, %.3g, 0], damping: [%s]}" %
            (length, r.randint(3, 16), ", ".join("%.4g" % c for c in stiffness), mass, turning, turning,
             ", ".join(["0.01"] * 6)))


def rigid(r, length, mass):
    m = mass * length * r.uniform(0.1, 3)
    centre = ", ".join("%.3g" % (r.uniform(-0.3, 0.3) * length) for _ in range(3))
    inertia = ", ".join(["%.4g" % (0.1 * m * length ** 2)] * 3)
    return f"mass: {m:.4g}, inertia: [{inertia}], centre_of_mass: [{centre}]"


def scene(seed):
    """The text of a tree and the sum of its lengths."""
    r = random.Random(seed)
    names, bodies, loads, markers, total = ["ground"], [], [], [], 0
    size = 10 ** r.uniform(-0.5, 1.5)
    for i in range(r.randint(1, 6)):
        parent = names[-1] if i == 0 else r.choice(names[-3:])
        name, length, mass = f"b{i}", size * r.uniform(0.3, 1.5), 10 ** r.uniform(-1, 2)
        text, bends = joint(r, i == 0, parent, size), i == 0 or r.random() < 0.65
        bodies.append("  - {name: %s, fidelity: %s, joint: {%s}, %s}" %
                      (name, "rod" if bends else "rigid", text, (rod if bends else rigid)(r, length, mass)))
        if not bends:
            markers.append("  - {name: m%d, body: %s}" % (i, name))
        if r.random() < 0.5:
            force = ", ".join("%.4g" % (r.gauss(0, 0.5) * mass * 9.81 * length) for _ in range(3))
            loads.append("  - {body: %s%s, force: [%s]}" % (name, ", at: tip" if bends else "", force))
        names.append(name)
        total += length
    lines = ["simulation: {duration: 0.2 s, macro_step: 10 ms, error_estimate: none, master: {rtol: 1e-7}}",
             "bodies:", *bodies]
    lines += ["markers:", *markers] if markers else []
    lines += ["loads:", *loads] if loads else []
    return "\n".join(lines) + "\n", total


def columns(path):
    """The recorded values: a list of rows by name."""
    names, rows = None, []
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            words = line.split()
            if words and words[0] == "Time":
                names = words
            elif names and words and words[0][0].isdigit():
                rows.append([float(word) for word in words])
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}


def run(command):
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return None


def finer_is_found(bough, path, out, times):
    with open(path, encoding="utf-8") as file:
        text = re.sub(r"segments: (\d+)", lambda n: f"segments: {int(n[1]) * times}", file.read())
    finer = path.replace(".yaml", "-finer.yaml")
    with open(finer, "w", encoding="utf-8") as file:
        file.write(text)
    found = run([bough, "static", finer, "--out", out + "-finer"])
    return found is not None and found.returncode == 0


def judge(bough, path, out, length):
    found = run([bough, "static", path, "--out", out + "-static"])
    if found is None:
        return "hang", ""
    said = (found.stderr.strip().splitlines() or [""])[-1]
    times = re.search(r"with (\d+) times the segments", said)
    if found.returncode == 3 and times:
        return ("coarse", "") if finer_is_found(bough, path, out, int(times[1])) else ("wrong", said)
    if found.returncode == 3 and "no equilibrium found" in said:
        return "none", said
    if found.returncode != 0:
        return "refused" if found.returncode == 2 else "wrong", said
    after = run([bough, "run", path, "--set", "simulation.initial=equilibrium", "--quiet", "--out", out])
    if "unstable" in found.stderr:
        return "unstable", ""
    if after is None or after.returncode != 0:
        return "wrong", "hang" if after is None else after.stderr.strip()
    places = {k: v for k, v in columns(os.path.join(out, "channels.out")).items() if k[-1] in "XYZ"}
    moved = max((abs(x - v[0]) for v in places.values() for x in v), default=0) / length
    return ("held", "") if moved < STILL else ("wrong", f"moves by {moved:.2g} of its length")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bough")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--keep", help="folder for the scenes")
    options = parser.parse_args()
    counts = collections.Counter()
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or scratch
        os.makedirs(folder, exist_ok=True)
        for k in range(options.count):
            seed = options.seed * 10000 + k
            text, length = scene(seed)
            path = os.path.join(folder, f"{seed}.yaml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            verdict, why = judge(os.path.abspath(options.bough), path, os.path.join(scratch, str(seed)), length)
            counts[verdict] += 1
            if verdict not in ("held", "unstable", "coarse", "refused"):
                print(f"{seed}: {verdict}: {why[:300]}", flush=True)
    print(", ".join(f"{n} {verdict}" for verdict, n in sorted(counts.items())))
    bad = counts["wrong"] + counts["hang"]
    return 1 if bad > 0 or counts["none"] > 0.02 * options.count else 0


if __name__ == "__main__":
    sys.exit(main())
