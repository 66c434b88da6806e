"""The Python module against the program: test_python.py BOUGH SOURCE."""
import math
import os
import struct
import subprocess
import sys
import tempfile
import unittest

import bough

PROGRAM, SOURCE = sys.argv[1:3]
PENDULUM = SOURCE + "/apps/mechanisms/pendulum.yaml"
RUNUP = SOURCE + "/apps/turbine/runup.yaml"
FEW = ["bodies[3-5].rod.segments=8", "simulation.threads=1"]


def numpy_python():
    """A Python that has NumPy; None: there is none."""
    for python in sys.executable, "/usr/bin/python3":
        if subprocess.run([python, "-c", "import numpy"], capture_output=True).returncode == 0:
            return python


def determinant(m):
    return sum(m[0][i] * (m[1][i - 2] * m[2][i - 1] - m[1][i - 1] * m[2][i - 2]) for i in range(3))


class Results(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def test_a_run_is_read_as_it_was_stepped(self):
        settings = ["simulation.duration=0.5 s", "simulation.output.binary=true"]
        rows = bough.run(PENDULUM, *settings, out=self.folder)
        with bough.Session(PENDULUM, *settings) as session:
            stepped = session.advance()
        self.assertEqual(rows.names, stepped.names)
        self.assertEqual(rows.units, stepped.units)
        self.assertEqual(rows.units["Time"], "s")
        self.assertEqual(rows.summary["status"], "complete")
        self.assertEqual(bough.read(self.folder + "/channels.out").names, rows.names)
        packed = bough.read(self.folder + "/channels.outb")
        self.assertEqual(packed.units, rows.units)
        every = (len(stepped.time) - 1) // (len(rows.time) - 1)
        for name in rows:
            span = max(rows[name]) - min(rows[name])
            for k, value in enumerate(rows[name]):
                self.assertAlmostEqual(value, stepped[name][k * every], delta=1e-8 * abs(value) + 1e-15, msg=name)
                self.assertAlmostEqual(packed[name][k], value, delta=2e-5 * span + 1e-6 * abs(value), msg=name)
        with self.assertRaises(KeyError):
            rows["bobPoss"]

    def test_every_kind_of_openfasts_binary_output_is_read(self):
        head = struct.pack("<i5s", 5, b"title") + b"".join(w.ljust(10).encode() for w in (
            "Time", "A", "B", "(s)", "(m)", "(kN)"))
        scales = struct.pack("<2f2f", 2, 4, 1, -1)  # packed = scale value + offset
        packed, rows = struct.pack("<6h", 3, 3, 5, 7, 7, 11), ([1, 2, 3], [1, 2, 3])
        kinds = {1: struct.pack("<ii2d", 2, 3, 10, 5) + scales + head + struct.pack("<3i", 5, 15, 25) + packed,
                 2: struct.pack("<ii2d", 2, 3, 0, 1) + scales + head + packed,
                 3: struct.pack("<ii2d", 2, 3, 0, 1) + head + struct.pack("<6d", 1, 1, 2, 2, 3, 3),
                 4: struct.pack("<hii2d", 10, 2, 3, 0, 1) + scales + head + packed}
        for kind, data in kinds.items():
            path = "%s/%d.outb" % (self.folder, kind)
            with open(path, "wb") as file:
                file.write(struct.pack("<h", kind) + data)
            table = bough.read(path)
            self.assertEqual((table.title, table.units), ("title", {"Time": "s", "A": "m", "B": "kN"}))
            self.assertEqual([list(table[name]) for name in table], [[0, 1, 2], *rows], kind)
            for size in 1, 20, len(data):
                with open(path, "wb") as file:
                    file.write((struct.pack("<h", kind) + data)[:size])
                with self.assertRaises(bough.Error):
                    bough.read(path)

    def test_modes_and_statics_are_tables(self):
        modes = bough.modes(PENDULUM)
        self.assertEqual(modes.units["frequency"], "Hz")
        self.assertGreater(modes["frequency"][0], 0)
        beam = bough.static(SOURCE + "/apps/beams/elastica.yaml")
        self.assertEqual(set(beam["rod"]), {"beam"})
        self.assertAlmostEqual(beam["uz"][-1], -0.555, 3)
        with self.assertRaisesRegex(bough.Error, "did you mean 'duration'"):
            bough.run(PENDULUM, "simulation.duratoin=1")
        for wrong in "results.txt", self.folder:
            with self.assertRaises((bough.Error, OSError)):
                bough.read(wrong)


class Module(unittest.TestCase):
    def test_rows_are_those_of_the_program(self):
        settings = ["simulation.duration=0.5 s", "simulation.output.interval=0.01 s"]
        with tempfile.TemporaryDirectory() as folder:
            sets = [word for s in settings for word in ("--set", s)]
            subprocess.run([PROGRAM, "run", PENDULUM, "--out", folder, "--quiet", *sets],
                           check=True, stdout=subprocess.DEVNULL)
            with open(folder + "/channels.out") as file:
                lines = [line.split() for line in file]
        head = next(i for i, words in enumerate(lines) if words[:1] == ["Time"])
        with bough.Session(PENDULUM, *settings) as session:
            self.assertEqual(lines[head][1:], session.names)
            self.assertEqual(lines[head + 1][1:], ["(%s)" % unit for unit in session.units])
            macro_step = session.duration / (len(session.advance()["Time"]) - 1)
        every = round(0.01 / macro_step)
        with bough.Session(PENDULUM, *settings) as session:
            rows = session.advance()
        for i, words in enumerate(lines[head + 2:]):
            for name, word in zip(["Time", *session.names], words):
                self.assertAlmostEqual(rows[name][i * every], float(word),
                                       delta=1e-8 * abs(float(word)) + 1e-15)
        self.assertEqual(len(lines[head + 2:]), (len(rows["Time"]) - 1) // every + 1)

    def test_a_restored_run_goes_on_to_the_same_bits(self):
        with bough.Session(RUNUP, *FEW) as run, bough.Session(RUNUP, *FEW) as other:
            run.advance(0.4)
            copy = run.save()
            first = run.advance(0.8)
            other.restore(copy)
            run.restore(copy)
            self.assertAlmostEqual(run.time, 0.4)
            for again in run.advance(0.8), other.advance(0.8):
                for name in first:
                    self.assertEqual(bytes(again[name]), bytes(first[name]), name)

    def test_a_step_is_reported_until_the_end(self):
        with bough.Session(PENDULUM, "simulation.duration=0.1 s") as session:
            steps = 0
            while session.step():
                steps += 1
            self.assertGreater(steps, 1)
            self.assertAlmostEqual(session.time, 0.1)
            self.assertFalse(session.step())

    def test_inputs_are_set_by_name(self):
        load = "loads=[{joint: bob, torque: %s}]"
        with bough.Session(PENDULUM, "simulation.duration=0.5 s", load % "0, input: push") as run:
            self.assertEqual(run.inputs, {"push": "N m"})
            run["push"] = "3e-3 kN m"
            rows = run.advance()
            with self.assertRaises(bough.Error):
                run["push"] = "3 kg"
            self.assertEqual(run["push"], 3)
            with self.assertRaises(KeyError) as caught:
                run["psuh"] = 1
            self.assertIn("no input 'psuh' (did you mean 'push'?)", str(caught.exception))
            with self.assertRaises(TypeError):
                run["push"] = None
        with bough.Session(PENDULUM, "simulation.duration=0.5 s", load % "3 N m") as other:
            self.assertEqual(bytes(other.advance()["bobPos"]), bytes(rows["bobPos"]))

    def test_errors_say_what_the_program_says(self):
        with self.assertRaises(bough.Error) as caught:
            bough.Session(PENDULUM, "simulation.duratoin=1 s")
        self.assertEqual(caught.exception.code, bough.INVALID)
        self.assertIn("duration", str(caught.exception))
        with bough.Session(PENDULUM) as pendulum, bough.Session(RUNUP, *FEW) as run:
            with self.assertRaises(bough.Error):
                run.restore(pendulum.save())
            for wrong in (lambda: pendulum["bobPoss"], lambda: pendulum.advance(channels=["bobPoss"]),
                          lambda: pendulum.advance(channels="bobPoss")):
                with self.assertRaises(KeyError) as caught:
                    wrong()
                self.assertIsInstance(caught.exception, bough.Error)
                self.assertIn("no channel 'bobPoss' (did you mean 'bobPos'?)", str(caught.exception))
            with self.assertRaises(TypeError):
                pendulum[3]
            with self.assertRaises(bough.Error):
                pendulum.restore(b"no copy")
            with self.assertRaises(ValueError):
                pendulum.advance(float("nan"))
        with self.assertRaises(ValueError):
            pendulum.step()

    def test_errors_are_those_of_the_companion(self):
        with bough.Session(RUNUP, *FEW, "simulation.error_estimate=companion") as run:
            run.advance(0.4)
            self.assertEqual(list(run.errors), run.names)
            self.assertTrue(0 < run.errors["RotSpeed"] < 0.1)
        with bough.Session(RUNUP, *FEW) as run:
            run.advance(0.1)
            self.assertTrue(math.isnan(run.errors["RotSpeed"]))

    def test_the_nearest_name_is_the_one_that_begins_alike(self):
        with self.assertRaises(bough.Error) as caught:
            bough.Session(RUNUP, "aero.wind.sped=12 m/s")
        self.assertIn("did you mean 'speed'?", str(caught.exception))

    def test_an_input_takes_what_the_scene_would(self):
        with bough.Session(RUNUP, *FEW, "aero.wind.input=wind") as run:
            before = run["wind"]
            for bad in -3, "-3 m/s", float("nan"), "12 kg":
                with self.assertRaises(bough.Error):
                    run["wind"] = bad
            self.assertEqual(run["wind"], before)
            run["wind"] = "10 m/s"
            self.assertEqual(run["wind"], 10)

    def test_values_are_a_view_that_outlives_the_session(self):
        with bough.Session(PENDULUM) as session:
            values = session.values
            before = list(values)
            session.step()
            session.values
            self.assertNotEqual(before, list(values))
            with self.assertRaises((TypeError, ValueError)):
                values[0] = 1.0
        del session
        self.assertEqual(len(list(values)), len(before))

    def test_poses_are_those_of_the_scene(self):
        with bough.Session(RUNUP, *FEW, "simulation.duration=1 s") as run:
            run.advance(0.5)
            values = list(run.values)
            hub, blade, angle = run.poses["hub"], run.poses["blade1"], math.radians(run["Azimuth"])
            self.assertEqual(values, list(run.values))
            self.assertEqual((len(hub.position), len(blade.position)), (1, 9))
            for pose in run.poses.values():
                for matrix in pose.rotation:
                    self.assertAlmostEqual(determinant(matrix), 1, delta=1e-12)
            x, y, z = (row[1] for row in hub.rotation[0])  # the hub's y axis; the shaft is tilted about y
            self.assertAlmostEqual(y, math.cos(angle), delta=1e-9)
            self.assertAlmostEqual(math.hypot(x, z), abs(math.sin(angle)), delta=1e-9)
            self.assertLess(math.dist(hub.position[0], blade.position[0]), 3)
            self.assertGreater(math.dist(hub.position[0], blade.position[-1]), 60)
            run.close()
            with self.assertRaises(ValueError):
                run.poses

    def test_the_pose_of_a_pendulum_is_its_angle(self):
        with bough.Session(PENDULUM) as run:
            run.advance(0.5)
            position, rotation = run.poses["bob"]
            turn = math.radians(run["bobPos"])  # about y
            place = run["bobX"], run["bobY"], run["bobZ"]
        self.assertEqual([list(x) for x in position], [[0, 0, 0]])
        exact = [[math.cos(turn), 0, math.sin(turn)], [0, 1, 0], [-math.sin(turn), 0, math.cos(turn)]]
        for row, expected, x in zip(rotation[0], exact, place):
            for entry, value in zip(row, expected):
                self.assertAlmostEqual(entry, value, delta=1e-12)
            self.assertAlmostEqual(-row[0], x, delta=1e-12)  # the bob is at (-1, 0, 0) of its body

    def test_the_example_of_the_documents_runs(self):
        with open(SOURCE + "/docs/programs.md") as file:
            results, code, poses = file.read().split("## Python")[1].split("```")[1:6:2]
        if numpy_python():
            said = subprocess.run([numpy_python(), "-c", results], check=True, cwd=SOURCE, capture_output=True, text=True)
            self.assertRegex(said.stdout, r"rpm \+- .*\nmean of the last second: .* kN-m\n(.* Hz .*\n){12}tip: ")
            said = subprocess.run([numpy_python(), "-c", poses], check=True, cwd=SOURCE, capture_output=True, text=True)
            self.assertRegex(said.stdout, r"\((\d+), 3\) \(\1, 3, 3\)\ntip: \[.*\] m, along the span: \[.*\]\n")
        shorter = code.replace('"aero.wind.input=wind"', '"aero.wind.input=wind", "simulation.duration=0.1 s"')
        self.assertNotEqual(code, shorter)
        ran = subprocess.run([sys.executable, "-c", shorter], check=True, cwd=SOURCE, stdout=subprocess.PIPE)
        self.assertIn(b"{'wind': 'm/s'}", ran.stdout)

    def test_the_example_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            ran = subprocess.run([sys.executable, SOURCE + "/apps/bough/exchange/what_if.py"], check=True,
                                 stdout=subprocess.PIPE, cwd=folder)
            pictures = os.listdir(folder)
        self.assertIn(b"repeated to the bit: True", ran.stdout)
        self.assertEqual(pictures, ["what-if.svg"] if b"picture" in ran.stdout else [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
