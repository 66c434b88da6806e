"""The promise, tested on random scenes: within its bound, or stopped with a diagnosis, and what is told is true.

    random_scenes.py BOUGH SOURCE [--hard | --machines] [--seed N] [--count M] [--jobs J] [--only FAMILY] [--advice] [--keep DIR] [--list FILE]

Every scene runs as a user runs it, and against the monolithic solution at two tolerances. Only where these two
agree the reference is taken for true; the others are counted as unsettled (chaos, for the most part). The table
has a row for each family and each scheme; the exit code is 1 where the promise is broken.

  held         error up to 1 % of the range, or told to be above it with exit code 0 and a warning (warned)
  diagnosed    exit code 3 with its reason
  gross        error above 5 %, told, and yet exit code 0; of a force, without a warning
  silent       error above 5 %, exit code 0, told less than a third of it
  too little   error above 1e-3, told less than a third of it
  too much     told more than ten times the error, and more than 1e-3
  false stop   ended, though the error until then was below 1e-3 (told by the error bound: a tenth of what was told)
  refused      exit code 2: the scene is not built

The last column has what was told of the largest error divided by it, where that is above 1e-3.

Errors are of vectors (X, Y, Z of a point; the directions of a joint), relative to the vector's own range."""
import argparse
import collections
import json
import math
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import settings

SCHEMES = ("frozen", "gauss-seidel", "extrapolated", "iterated", "iterated", "ramp", "ramp", "monolithic")
CLASSES = ("held", "warned", "diagnosed", "gross", "silent", "too little", "too much", "false stop", "not told",
           "refused", "crash", "hang", "unsettled")
BROKEN = ("silent", "too little", "gross", "crash", "hang")
GROSS, SMALL, WARNED = 0.05, 1e-3, 0.01
FLOOR = 1e-3  # of the largest range with that unit: what moves less is not judged; of a speed: its least range
ROUNDING = 1e-6  # nor what moves less than that of the largest motion, in SI units: as the program's own rule
SI = {"(deg)": math.radians(1), "(deg/s)": math.radians(1), "(rpm)": math.pi / 30}
TIMEOUT, REFERENCE_TIMEOUT = 60, 15  # s of CPU


class Run:
    """One run of the program: its exit code, channels, and what it told of its errors."""

    def __init__(self, bough, scene, folder, settings=(), seconds=TIMEOUT):
        words = [bough, "run", scene, "--quiet", "--threads", "1", "--out", folder]
        for setting in settings:
            words += ["--set", setting]
        try:
            done = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  timeout=40 * seconds, preexec_fn=lambda: limit(seconds), text=True, errors="replace")
            self.code, self.said = done.returncode, done.stderr.strip()
        except subprocess.TimeoutExpired:
            self.code, self.said = -24, "timeout"
        self.hung = self.code in (-24, -9)
        self.names, self.units, self.rows, self.told, self.summary = [], [], [], {}, {}
        if self.code in (0, 3):
            self.read(folder)

    def read(self, folder):
        try:
            with open(os.path.join(folder, "channels.out")) as file:
                lines = file.read().split("\n")
            with open(os.path.join(folder, "summary.json")) as file:
                self.summary = json.load(file)
        except OSError:
            return
        start = next(i for i, line in enumerate(lines) if line.lstrip().startswith("Time"))
        self.names = lines[start].split()[1:]
        self.units = lines[start + 1].split()[1:]
        self.rows = [[float(x) for x in line.split("\t")] for line in lines[start + 2:] if line]
        for key in ("coupling_error_estimate", "error_estimate"):
            for name, value in self.summary.get(key, {}).items():
                if isinstance(value, dict):
                    self.told[name] = value["largest"]

    @property
    def bound_stop(self):
        return self.code == 3 and "error bound" in self.said


def limit(seconds):
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 2))
    resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


# -- errors ---------------------------------------------------------------------------------------

def vector_of(name, unit):
    """What a channel is a component of."""
    stem = re.sub("([FM])[xyz]", r"\1", name) if "N" in unit else name
    for ending in ("X", "Y", "Z", "Xi", "Yi", "Zi"):
        if name.endswith(ending):
            stem = name[:-len(ending)]
    stem = re.sub("(Dir[XYZ])[xyz]$", r"\1", stem)
    for count in "123":
        stem = stem.replace(count + "Pos", "Pos").replace(count + "Vel", "Vel")
    return stem + " " + unit


def error_of(run, truth, told_of=None):
    """Of each vector that the run tells, or can tell: (largest error, told) relative to its range."""
    channels = collections.defaultdict(list)
    names = told_of if told_of is not None else run.told
    for k, name in enumerate(run.names):
        if name in names and name in truth.names:
            channels[vector_of(name, run.units[k])].append((k, truth.names.index(name), name, run.units[k]))
    n = min(len(run.rows), len(truth.rows))
    errors = {}
    for vector, columns in channels.items():
        error = told = span = size = 0.0
        for mine, other, name, unit in columns:
            a = [row[mine + 1] for row in run.rows[:n]]
            b = [row[other + 1] for row in truth.rows[:n]]
            whole = [row[other + 1] for row in truth.rows]
            off = [x - y for x, y in zip(a, b)]
            if unit == "(deg)":
                off = [math.remainder(x, 360) for x in off]
            error = max(error, max(map(abs, off), default=0))
            span = max(span, max(whole) - min(whole))
            size = max(size, max(map(abs, whole)))
            value = run.told.get(name)
            told = math.nan if value is None else max(told, value) if told == told else told
        unit = columns[0][3]
        if "/s" in unit or "rpm" in unit:
            span = max(span, FLOOR * size)
        errors[vector] = (error, told, span, size, unit)
    largest = collections.defaultdict(float)
    for error, told, span, size, unit in errors.values():
        largest[unit] = max(largest[unit], span)
    most = max([SI.get(unit, 1) * max(span, min(size, 1 / SI.get(unit, 1)))
                for _, _, span, size, unit in errors.values()], default=0)
    return {vector: (error / span, told / span) for vector, (error, told, span, size, unit) in errors.items()
            if span > FLOOR * largest[unit] and SI.get(unit, 1) * span > ROUNDING * most}


def is_state(name):
    return not any(word in name for word in ("Aero", "Gen", "BldPitch"))


def is_force(vector):
    return "N" in vector.split()[-1]


def classify(run, truth, rough):
    """The class, and the line that explains it."""
    if run.hung:
        return "hang", "cpu time"
    if run.code == 2:
        return "refused", run.said[:150]
    if run.code not in (0, 3):
        return "crash", "exit code %d %s" % (run.code, run.said[:150])
    if truth.code != 0 or rough.code != 0:
        return ("unsettled" if run.code == 0 else "diagnosed"), "reference: " + (truth.said or rough.said)[:150]
    told = {name for name, value in run.told.items() if value is not None}
    states = {name for name in truth.names if is_state(name) and (name in told or not told)}
    settled = error_of(rough, truth, states)
    unsure = max([e for e, _ in settled.values()], default=0)
    errors = error_of(run, truth, states)
    worst = max(errors, key=lambda v: errors[v][0], default=None)
    error, told = errors.get(worst, (0, 0))
    line = "%s: error %.2g told %.2g (reference %.1g)" % (worst, error, told, unsure)
    if run.code == 3:
        over = max(errors.values(), key=lambda e: e[1] if e[1] == e[1] else 0, default=(0, 0))
        line += "; " + " ".join(run.said.split())[:200]
        small = over[0] < 0.1 * over[1] and over[0] < 0.1 * GROSS if run.bound_stop else error < SMALL
        if len(run.rows) > 5 and unsure < 0.3 * SMALL and small:
            return "false stop", line
        return "diagnosed", line
    if unsure > 0.3 * max(error, SMALL):
        return "unsettled", line
    tells = any(value is not None for value in run.told.values())
    if not tells and run.summary.get("scheme") == "monolithic" and error <= SMALL:
        return "held", line
    ratios = [(e / t if t > 0 else math.inf, v) for v, (e, t) in errors.items() if (t == t or not tells) and e > SMALL and e > 5 * settled.get(v, (0,))[0]]
    ratio, vector = max(ratios, default=(0, None), key=lambda r: r[0])
    unknown = errors and not tells
    if vector is not None and (ratio > 3 or ratio != ratio):
        e, t = errors[vector]
        line = "%s: error %.2g told %.2g (reference %.1g)" % (vector, e, t, unsure)
    if unknown:
        return ("gross" if error > GROSS else "not told"), line
    errors = {v: (e, t) for v, (e, t) in errors.items() if t == t}
    warned = run.summary.get("error", {}).get("force", {}).get("warning")
    error = max([e for v, (e, _) in errors.items() if not (warned and is_force(v))], default=0)
    if ratio > 3:
        return ("silent" if errors[vector][0] > GROSS else "too little"), line
    if error > GROSS:
        return "gross", line
    over = max(errors, key=lambda v: errors[v][1] / max(errors[v][0], 1e-4), default=None)
    if over is not None and errors[over][1] > SMALL and errors[over][1] > 10 * max(errors[over][0], settled[over][0]):
        return "too much", "%s: error %.2g told %.2g" % (over, *errors[over])
    most = max([t for _, t in errors.values()], default=0)
    return ("warned" if most > WARNED or warned else "held"), line


def told_share(run, truth, rough):
    """Of the error of a run that ended well, where it is largest: told/true; None where it is small or unsettled."""
    if run.code != 0 or truth.code != 0 or rough.code != 0:
        return None
    told = {name for name, value in run.told.items() if value is not None and is_state(name)}
    settled = error_of(rough, truth, told)
    errors = error_of(run, truth, told)
    worst = max(errors, key=lambda v: errors[v][0], default=None)
    if worst is None or errors[worst][0] <= max(SMALL, 5 * settled[worst][0]):
        return None
    return errors[worst][1] / errors[worst][0]


# -- advice ---------------------------------------------------------------------------------------

ADVICE = {"scheme: monolithic": "simulation.coupling={scheme: monolithic}",
          r"macro_step: (\S+) s": "simulation.macro_step=%s s",
          r"master\.rtol: (\S+)": "simulation.master.rtol=%s"}


def follow(arguments, path, folder, said):
    """Whether each change that the message names holds: ["scheme: monolithic holds", …]."""
    outcomes = []
    named = said[said.rfind("; try "):]
    for pattern, setting in ADVICE.items():
        found = re.search(pattern, named)
        if not found:
            continue
        setting = setting % found.groups() if found.groups() else setting
        run = Run(arguments.bough, path, os.path.join(folder, "advised"), (*arguments.set, setting))
        outcomes.append("%s %s" % (setting.split("=")[0], "holds" if run.code == 0 else "ends with %d" % run.code))
    return outcomes


# -- scenes ---------------------------------------------------------------------------------------

MONOLITHIC = ("simulation.coupling={scheme: monolithic}", "simulation.step_control.tolerance=0",
              "simulation.error_estimate=none")


def one(arguments, index):
    rng = random.Random("%d/%d" % (arguments.seed, index))
    chosen = settings.HARD if arguments.hard else settings.MACHINES if arguments.machines else settings.FAMILIES
    family = chosen[index % len(chosen)]
    defaults = rng.random() < 1 / 3
    schemes = (arguments.scheme,) if arguments.scheme else SCHEMES
    scene, word, files = settings.make(rng, family, schemes, defaults and not arguments.scheme, arguments.stages)
    if arguments.only and family.__name__ not in arguments.only.split(","):
        return None
    if arguments.defaults and word != "default":
        return None
    folder = tempfile.mkdtemp(prefix="random-")
    try:
        for table in ("blade-structure", "tower-structure", "blade-aero", "airfoils"):
            os.symlink(os.path.join(arguments.source, "apps/turbine", table + ".yaml"), os.path.join(folder, table + ".yaml"))
        os.symlink(os.path.join(arguments.source, "apps/turbine/turbulence.bts"), os.path.join(folder, "turbulence.bts"))
        os.symlink(os.path.join(os.path.dirname(arguments.bough), "tests/libsample_discon.so"), os.path.join(folder, "libdiscon.so"))
        for name, text in files.items():
            with open(os.path.join(folder, name), "w") as file:
                file.write(text)
        path = os.path.join(folder, "scene.yaml")
        with open(path, "w") as file:
            json.dump(scene, file, indent=1)
        run = Run(arguments.bough, path, os.path.join(folder, "run"), arguments.set)
        if run.code == 2:
            return index, family.__name__, word, "refused", run.said[:200], None
        reference = [Run(arguments.bough, path, os.path.join(folder, "reference%d" % k),
                         MONOLITHIC + ("simulation.master={solver: ida, rtol: %g}" % rtol,), REFERENCE_TIMEOUT)
                     for k, rtol in enumerate((1e-6, 1e-8))]
        verdict, line = classify(run, reference[1], reference[0])
        if arguments.advice and run.code == 3 and reference[1].code == 0:
            arguments.followed.update(follow(arguments, path, folder, run.said))
        if arguments.keep:
            kept = os.path.join(arguments.keep, verdict.replace(" ", "-"))
            os.makedirs(kept, exist_ok=True)
            shutil.copy(path, os.path.join(kept, "%d-%d.yaml" % (arguments.seed, index)))
        return index, family.__name__, word, verdict, line, told_share(run, reference[1], reference[0])
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def table(results, column):
    rows, shares = collections.defaultdict(collections.Counter), collections.defaultdict(list)
    for result in results:
        for name in (result[column], "all"):
            rows[name][result[3]] += 1
            if result[5] is not None:
                shares[name].append(result[5])
    print("%-13s %5s " % ("", "runs") + " ".join("%10s" % c for c in CLASSES) + "   told/true, within 1/3 to 3")
    for name in [n for n in rows if n != "all"] + ["all"]:
        told = shares[name]
        good = "%.2f to %.2f, %d of %d" % (min(told), max(told), sum(1 / 3 <= x <= 3 for x in told), len(told)) if told else "."
        print("%-13s %5d " % (name, sum(rows[name].values())) + " ".join("%10s" % (rows[name][c] or ".") for c in CLASSES) +
              "   " + good)
    print()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("bough")
    parser.add_argument("source")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=120)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", help="families, with commas between")
    parser.add_argument("--hard", action="store_true", help="of families_hard.py")
    parser.add_argument("--machines", action="store_true", help="of families_machines.py")
    parser.add_argument("--scheme", help="this one for all scenes")
    parser.add_argument("--defaults", action="store_true", help="only scenes that leave all solver settings out")
    parser.add_argument("--stages", action="store_true", help="with stage-coupled steps among the schemes")
    parser.add_argument("--advice", action="store_true", help="try what the messages of stopped runs name, and count")
    parser.add_argument("--set", action="append", default=[], help="for the runs, not for their references")
    parser.add_argument("--keep", help="folder for the scenes, by class")
    parser.add_argument("--list", help="file for a line a scene")
    arguments = parser.parse_args()
    arguments.bough, arguments.source = os.path.abspath(arguments.bough), os.path.abspath(arguments.source)
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    results = []
    arguments.followed = collections.Counter()
    with ThreadPoolExecutor(arguments.jobs) as pool, open(arguments.list or os.devnull, "w") as file:
        for result in pool.map(lambda i: one(arguments, i), range(arguments.first, arguments.first + arguments.count)):
            if result:
                results.append(result)
                file.write("%d\t%s\t%s\t%s\t%s\n" % result[:5])
                file.flush()
    table(results, 1)
    table(results, 2)
    for outcome, count in sorted(arguments.followed.items()):
        print("%4d %s" % (count, outcome))
    broken = [r for r in results if r[3] in BROKEN or (r[3] == "false stop" and r[2] in ("monolithic", "stages"))]
    for result in broken:
        print("%d/%d %s %s: %s: %s" % ((arguments.seed,) + result[:5]))
    much = sum(r[3] == "too much" for r in results)
    if much > max(1, 0.02 * len(results)):
        print("%d of %d told too much" % (much, len(results)))
    return 1 if broken or much > max(1, 0.02 * len(results)) else 0


if __name__ == "__main__":
    sys.exit(main())
