"""The promise, tested on random scenes: a run says how large its whole error is, or stops with a diagnosis.

    random_scenes.py BOUGH SOURCE [--hard | --loads | --machines | --variants] [--seed N] [--count M] [--jobs J] [--only FAMILY] [--advice] [--keep DIR] [--list FILE]

Every scene runs as a user runs it, and twice as one system that is finer in everything: with three and six times the
segments, six and twelve times the rate of the air, a third and a sixth of the macro step, by two methods at tight
tolerances. Where these two agree, the finer one is taken for the truth; other scenes are counted as unsettled
(chaos, for the most part). The table has a row for each family and each scheme; the exit code is 1 where the
promise is broken.

  held         estimate up to 1 % of the range
  warned       estimate above 1 %, or a warning that the estimate lacks vibrations or forces; exit code 0
  diagnosed    exit code 3 with its reason
  silent       error above 5 %, exit code 0, estimate less than a third of it
  too little   error above 1e-3, estimate less than a third of it
  too much     estimate more than ten times the error, and more than 1e-3
  false stop   ended, though the error until then was below 1e-3 (by the error bound: a tenth of the estimate)
  unknown      exit code 0 and no estimate
  refused      exit code 2: the scene is not built

The last column has the estimate divided by the error in the channel that errs most, where that is above 1e-3.

Errors are of vectors (X, Y, Z of a point; the directions of a joint), relative to the vector's own range."""
import argparse
import collections
import copy
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
CLASSES = ("held", "warned", "diagnosed", "silent", "too little", "too much", "false stop", "unknown", "refused",
           "crash", "hang", "unsettled")
BROKEN = ("silent", "too little", "crash", "hang")
GROSS, SMALL, WARNED = 0.05, 1e-3, 0.01
FLOOR = 1e-3  # of the largest range with that unit: what moves less is not judged; of a speed: its least range
ROUNDING = 1e-6  # nor what moves less than that of the largest motion, in SI units: as the program's own rule
SI = {"(deg)": math.radians(1), "(deg/s)": math.radians(1), "(rpm)": math.pi / 30}
TIMEOUT = 60  # s of CPU, of a run


class Run:
    """One run of the program: its exit code, its channels, and its estimate of their errors."""

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
        self.hung = self.code in (-24, -9, 130)  # 130: it ends itself at the limit
        self.names, self.units, self.rows, self.estimate, self.summary = [], [], [], {}, {}
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
        self.estimate = self.summary.get("error_estimate") or {}

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
    stem = re.sub("(Spn\\d+[FMTR][LD])[xyz]", r"\1", stem)
    for count in "123":
        stem = stem.replace(count + "Pos", "Pos").replace(count + "Vel", "Vel")
    return stem + " " + unit


def error_of(run, truth, estimate):
    """Of each vector: (largest error, largest estimate), relative to its range, where it moves enough to be judged."""
    channels = collections.defaultdict(list)
    for k, name in enumerate(run.names):
        if name in truth.names:
            channels[vector_of(name, run.units[k])].append((k, truth.names.index(name), name, run.units[k]))
    n = min(len(run.rows), len(truth.rows))
    errors = {}
    for vector, columns in channels.items():
        error = estimated = span = size = 0.0
        for mine, other, name, unit in columns:
            whole = [row[other + 1] for row in truth.rows]
            off = [run.rows[i][mine + 1] - whole[i] for i in range(n)]
            if unit == "(deg)":
                off = [math.remainder(x, 360) for x in off]
            error = max(error, max(map(abs, off), default=0))
            span = max(span, max(whole) - min(whole))
            size = max(size, max(map(abs, whole)))
            value = estimate.get(name)
            estimated = math.nan if value is None else max(estimated, value) if estimated == estimated else estimated
        unit = columns[0][3]
        if "/s" in unit or "rpm" in unit:
            span = max(span, FLOOR * size)
        errors[vector] = (error, estimated, span, size, unit)
    largest = collections.defaultdict(float)
    for error, estimated, span, size, unit in errors.values():
        largest[unit] = max(largest[unit], span)
    most = max([SI.get(unit, 1) * max(span, min(size, 1 / SI.get(unit, 1)))
                for _, _, span, size, unit in errors.values() if is_motion(unit)], default=0)
    return {vector: (error / span, estimated / span) for vector, (error, estimated, span, size, unit) in errors.items()
            if span > FLOOR * largest[unit] and span > FLOOR * (0 if is_motion(unit) else size)
            and SI.get(unit, 1) * span > (ROUNDING * most if is_motion(unit) else 0)}


def is_motion(unit):
    return "N" not in unit and "W" not in unit


class Judgement:
    """The class of a run, the line that explains it, and estimate/error where the error is largest."""

    def __init__(self, run, truth, rough):
        self.ratio = None
        self.word, self.line = self.judge(run, truth, rough)

    def judge(self, run, truth, rough):
        if run.hung:
            return "hang", "cpu time"
        if run.code == 2:
            return "refused", run.said[:150]
        if run.code not in (0, 3):
            return "crash", "exit code %d %s" % (run.code, run.said[:150])
        if truth.code != 0 or rough.code != 0:
            return ("unsettled" if run.code == 0 else "diagnosed"), "reference: " + (truth.said or rough.said)[:150]
        unsure = {v: e for v, (e, _) in error_of(rough, truth, {}).items()}
        errors = error_of(run, truth, run.estimate)
        if run.code == 3:
            return self.judge_stop(run, errors, unsure)
        if not any(value is not None for value in run.estimate.values()):
            return "unknown", str(run.summary.get("error"))[:200]
        # what the two references settle, to a tenth of it or of what matters
        settled = {v: x for v, x in errors.items() if unsure.get(v, math.inf) <= 0.2 * max(x[0], SMALL) and x[1] == x[1]}
        if len(settled) < len(errors) / 2:
            return "unsettled", "the references differ by up to %.2g" % max(unsure.values(), default=0)
        return self.judge_estimate(run, settled, unsure)

    def judge_estimate(self, run, settled, unsure):
        def line(v):
            return "%s: error %.2g estimate %.2g (reference %.1g)" % (v, *settled[v], unsure[v])
        worst = max(settled, key=lambda v: settled[v][0], default=None)
        if worst is not None and settled[worst][0] > SMALL:
            self.ratio = settled[worst][1] / settled[worst][0]
        less = max((v for v in settled if settled[v][0] > SMALL),
                   key=lambda v: settled[v][0] / max(settled[v][1], 1e-300), default=None)
        if less is not None and settled[less][0] > 3 * settled[less][1]:
            limits = [warning["limit"] for warning in run.summary["warnings"]]
            if "fast_vibrations" in limits or ("singular_position" in limits and not is_motion(less.split()[-1])):
                return "warned", line(less)
            return ("silent" if settled[less][0] > GROSS else "too little"), line(less)
        more = max(settled, key=lambda v: settled[v][1] / max(settled[v][0], 1e-4), default=None)
        if more is not None and settled[more][1] > SMALL and settled[more][1] > 10 * max(settled[more][0], unsure[more]):
            return "too much", line(more)
        most = max(settled, key=lambda v: settled[v][1], default=None)
        if most is None:
            return "held", "nothing moves"
        return ("warned" if settled[most][1] > WARNED else "held"), line(worst)

    def judge_stop(self, run, errors, unsure):
        worst = max(errors, key=lambda v: errors[v][0], default=None)
        error = errors[worst][0] if worst else 0
        line = "%s: error %.2g; %s" % (worst, error, " ".join(run.said.split())[:200])
        if max(unsure.values(), default=0) > 0.3 * SMALL or len(run.rows) <= 5:
            return "diagnosed", line
        if run.bound_stop:
            v = max(errors, key=lambda v: errors[v][1] if errors[v][1] == errors[v][1] else 0, default=None)
            small = v is not None and errors[v][0] < 0.1 * errors[v][1] and errors[v][0] < 0.1 * GROSS
        else:  # what grows may move no channel yet
            small = error < SMALL and "is unstable without the damping" not in run.said
        return ("false stop" if small else "diagnosed"), line


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

def finer(scene, times, solver, rtol):
    """The scene, finer in everything, as one system by another method."""
    scene = copy.deepcopy(scene)
    for body in scene["bodies"]:
        if "rod" in body:  # which bodies may have in common
            body["rod"] = dict(body["rod"], segments=times * body["rod"]["segments"])
    for load in scene.get("loads", []):
        if isinstance(load.get("at"), int):  # the same place
            load["at"] *= times
    simulation = scene["simulation"]
    step = float(simulation["macro_step"].split()[0])
    simulation["output"] = {"interval": "%.12g ms" % step}
    if "aero" in scene:
        scene["aero"]["rate"] *= 2 * times
        step = min(step, times * 1000 / scene["aero"]["rate"])
    simulation["macro_step"] = "%.12g ms" % (step / times)
    simulation["coupling"] = {"scheme": "monolithic"}
    simulation["master"] = {"solver": solver, "rtol": rtol}
    simulation["error_estimate"] = "none"
    for key in ("micro", "step_control", "error_bound"):
        simulation.pop(key, None)
    return scene


KINDS = ("hard", "loads", "machines", "variants")  # of families
REFERENCES = ((3, "rosenbrock", 1e-6), (6, "ida", 1e-7))


def length_of(rod):
    """None: the rod has sections of its own."""
    return rod.get("length") or {"blade-structure.yaml": 61.5, "tower-structure.yaml": 87.6}.get(rod.get("table"))


def one(arguments, index):
    rng = random.Random("%d/%d" % (arguments.seed, index))
    chosen = next((getattr(settings, kind.upper()) for kind in KINDS if getattr(arguments, kind)), settings.FAMILIES)
    family = chosen[index % len(chosen)]
    defaults = rng.random() < 1 / 3
    schemes = (arguments.scheme,) if arguments.scheme else SCHEMES
    scene, word, files = settings.make(rng, family, schemes, defaults and not arguments.scheme, arguments.stages)
    if arguments.only and family.__name__ not in arguments.only.split(","):
        return None
    if arguments.defaults and word != "default":
        return None
    places = random.Random("%d/%d/sensors" % (arguments.seed, index))
    scene["sensors"] = [{"body": body["name"], "at": sorted(
        places.choice([0, 1, places.random()]) * length_of(body["rod"]) for _ in range(2))}
        for body in scene["bodies"] if "rod" in body and body["fidelity"] == "rod" and length_of(body["rod"])]
    folder = tempfile.mkdtemp(prefix="random-")
    try:
        for table in ("blade-structure", "tower-structure", "blade-aero", "airfoils"):
            os.symlink(os.path.join(arguments.source, "apps/turbine", table + ".yaml"), os.path.join(folder, table + ".yaml"))
        os.symlink(os.path.join(arguments.source, "apps/turbine/turbulence.bts"), os.path.join(folder, "turbulence.bts"))
        os.symlink(os.path.join(os.path.dirname(arguments.bough), "tests/libsample_discon.so"), os.path.join(folder, "libdiscon.so"))
        for name, text in files.items():
            with open(os.path.join(folder, name), "w") as file:
                file.write(text)
        scene["simulation"]["output"] = {"interval": scene["simulation"]["macro_step"]}
        path = os.path.join(folder, "scene.yaml")
        with open(path, "w") as file:
            json.dump(scene, file, indent=1)
        run = Run(arguments.bough, path, os.path.join(folder, "run"), arguments.set)
        if run.code == 2:
            return index, family.__name__, word, "refused", run.said[:200], None
        reference = []
        for k, (times, solver, rtol) in enumerate(REFERENCES):
            path_finer = os.path.join(folder, "finer%d.yaml" % times)
            with open(path_finer, "w") as file:
                json.dump(finer(scene, times, solver, rtol), file)
            reference.append(Run(arguments.bough, path_finer, os.path.join(folder, "reference%d" % k), (), arguments.reference_time))
            if reference[-1].code != 0:
                break
        judged = Judgement(run, reference[-1], reference[0])
        verdict, line = judged.word, judged.line
        if arguments.advice and run.code == 3 and reference[-1].code == 0:
            arguments.followed.update(follow(arguments, path, folder, run.said))
        if arguments.keep:
            kept = os.path.join(arguments.keep, verdict.replace(" ", "-"))
            os.makedirs(kept, exist_ok=True)
            name = os.path.join(kept, "%d-%d-%s.yaml" % (arguments.seed, index, family.__name__))
            shutil.copy(path, name)
            for file in files:
                shutil.copy(os.path.join(folder, file), name + "." + file)
        return index, family.__name__, word, verdict, line, judged.ratio
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def table(results, column):
    rows, shares = collections.defaultdict(collections.Counter), collections.defaultdict(list)
    for result in results:
        for name in (result[column], "all"):
            rows[name][result[3]] += 1
            if result[5] is not None:
                shares[name].append(result[5])
    print("%-13s %5s " % ("", "runs") + " ".join("%10s" % c for c in CLASSES) + "   estimate/error, within 1/3 to 4")
    for name in [n for n in rows if n != "all"] + ["all"]:
        estimated = shares[name]
        good = "%.2f to %.2f, %d of %d" % (min(estimated), max(estimated), sum(1 / 3 <= x <= 4 for x in estimated), len(estimated)) if estimated else "."
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
    for kind in KINDS:
        parser.add_argument("--" + kind, action="store_true", help="of families_%s.py" % kind)
    parser.add_argument("--scheme", help="this one for all scenes")
    parser.add_argument("--defaults", action="store_true", help="only scenes that leave all solver settings out")
    parser.add_argument("--stages", action="store_true", help="with stage-coupled steps among the schemes")
    parser.add_argument("--advice", action="store_true", help="try what the messages of stopped runs name, and count")
    parser.add_argument("--set", action="append", default=[], help="for the runs, not for their references")
    parser.add_argument("--reference-time", type=int, default=30, help="most CPU time of a reference [s]")
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
                file.write("\t".join(" ".join(str(field).split()) for field in result[:5]) + "\n")
                file.flush()
    table(results, 1)
    table(results, 2)
    for outcome, count in sorted(arguments.followed.items()):
        print("%4d %s" % (count, outcome))
    broken = [r for r in results if r[3] in BROKEN or (r[3] == "false stop" and r[2] in ("monolithic", "stages"))]
    for result in broken:
        print("%d/%d %s %s: %s: %s" % ((arguments.seed,) + result[:5]))
    much = sum(r[3] == "too much" for r in results)
    if much > max(1, 0.03 * len(results)):
        print("%d of %d estimates are too large" % (much, len(results)))
    return 1 if broken or much > max(1, 0.03 * len(results)) else 0


if __name__ == "__main__":
    sys.exit(main())
