"""Bodies that are FMUs of other programs: test_fmu_member.py BOUGH SOURCE SAMPLE LACKING. SAMPLE and LACKING are
libraries of sample_fmu.c, the latter without fmi3DoStep."""
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

import bough

PROGRAM, SOURCE, SAMPLE, LACKING = sys.argv[1:5]

DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="%s" modelName="damper" instantiationToken="%s">
  <CoSimulation modelIdentifier="sample" canGetAndSetFMUState="%s"
    canBeInstantiatedOnlyOncePerProcess="%s"/>
  <UnitDefinitions>
    <Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
    <Unit name="kN"><BaseUnit kg="1" m="1" s="-2" factor="1000"/></Unit>
  </UnitDefinitions>
  <ModelVariables>
    <Float64 name="v" valueReference="10" causality="input" variability="continuous" start="0"/>
    <Float64 name="k" valueReference="30" causality="parameter" variability="fixed" start="8"/>
    <Float64 name="c" valueReference="31" causality="parameter" variability="fixed" start="0.4"/>
    <Float64 name="f" valueReference="20" causality="output" variability="continuous" unit="N"/>
    <Float64 name="f_kN" valueReference="21" causality="output" variability="continuous" unit="kN"/>
    <Float64 name="all" valueReference="22" causality="output" variability="continuous">
      <Dimension start="3"/>
    </Float64>
  </ModelVariables>
  <ModelStructure><Output valueReference="20"/></ModelStructure>
</fmiModelDescription>
"""
SCENE = """
gravity: [0, 0, 0]
simulation:
  duration: 5 s
  macro_step: 20 ms
  error_estimate: none
  coupling: {scheme: extrapolated, order: 2}
  master: {rtol: 1e-10}
bodies:
  - name: mass
    fidelity: rigid
    mass: 2 kg
    joint: {kind: prismatic, axis: z, parent: ground, speed: 1 m/s}
  - name: damper
    fidelity: fmu
    joint: {kind: fixed, parent: mass}
    fmu:
      folder: sample
      motion: [none, none, v, none, none, none, none, none, none]
      wrench: [none, none, f, none, none, none]
"""
STIFFNESS, DAMPING, MASS = 8, 0.4, 2  # of sample_fmu.c, of the scene


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as file:
        file.write(text)


class Member(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = self.temporary.name
        self.scene = self.folder + "/scene.yaml"
        write(self.scene, SCENE)
        self.unpack()

    def tearDown(self):
        self.temporary.cleanup()

    def unpack(self, library=SAMPLE, version="3.0", token="sound", restores="true", once="false"):
        """The sample as an unpacked FMU beside the scene."""
        write(self.folder + "/sample/modelDescription.xml",
              DESCRIPTION % (version, token, restores, once))
        binaries = self.folder + "/sample/binaries/%s-linux" % os.uname().machine
        os.makedirs(binaries, exist_ok=True)
        if os.path.exists(binaries + "/sample.so"):
            os.remove(binaries + "/sample.so")
        if library:
            shutil.copy(library, binaries + "/sample.so")

    def program(self, *words):
        return subprocess.run([PROGRAM, *words], capture_output=True, text=True, cwd=self.folder)

    def refused(self, expected, *sets, code=2, command="run"):
        words = [word for s in sets for word in ("--set", s)]
        done = self.program(command, "scene.yaml", *words)
        self.assertIn(expected, done.stderr)
        self.assertEqual(done.returncode, code)

    def error(self, *sets, force_within=2e-2):
        """Of the displacement at the end, from the damped oscillation."""
        with bough.Session(self.scene, *sets) as run:
            rows = run.advance()
        decay = DAMPING / MASS / 2
        omega = math.sqrt(STIFFNESS / MASS - decay * decay)
        exact = math.exp(-decay * 5) * math.sin(omega * 5) / omega
        velocity, force = rows["massVel"][-1], rows["damperFz"][-1]
        self.assertAlmostEqual(force, -STIFFNESS * exact - DAMPING * velocity, delta=force_within)
        return abs(rows["massPos"][-1] - exact)

    def test_a_spring_of_another_program_swings_as_it_must(self):
        steps = "simulation.macro_step=%g ms"
        for scheme in "extrapolated", "iterated":
            named = "simulation.coupling.scheme=" + scheme
            errors = [self.error(named, steps % h) for h in (20, 10, 5)]
            self.assertLess(errors[0], 2e-3)
            for coarse, fine in zip(errors, errors[1:]):
                self.assertGreater(coarse / fine, 3, (scheme, errors))  # order 2
        self.assertLess(self.error("simulation.coupling.scheme=gauss-seidel", steps % 1), 5e-3)
        finer = self.error(named, "bodies[damper].fmu.steps=20")
        self.assertLess(finer, 0.6 * self.error(named))

    def archive(self, compression=zipfile.ZIP_DEFLATED, **more):
        """The sample as sample.fmu, with further files of these names."""
        with zipfile.ZipFile(self.folder + "/sample.fmu", "w", compression) as archive:
            for above, _, names in os.walk(self.folder + "/sample"):
                for name in names:
                    path = os.path.join(above, name)
                    archive.write(path, os.path.relpath(path, self.folder + "/sample"))
            for name, text in more.items():
                archive.writestr(name, text)

    def test_an_archive_runs_as_its_folder_does(self):
        named, temporary = "bodies[damper].fmu.folder=sample.fmu", self.folder + "/temporary"
        os.mkdir(temporary)
        os.environ["TMPDIR"] = temporary
        self.addCleanup(os.environ.pop, "TMPDIR")
        with bough.Session(self.scene) as run:
            expected = bytes(run.advance()["massPos"])
        for compression in zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED:
            self.archive(compression)
            with bough.Session(self.scene, named) as run:
                self.assertEqual(len(os.listdir(temporary)), 1)
                self.assertEqual(bytes(run.advance()["massPos"]), expected)
            self.assertEqual(os.listdir(temporary), [])
        self.archive(**{"../outside": "no"})
        self.refused("the name of a file leads out of the archive", named)
        self.archive()
        with open(self.folder + "/sample.fmu", "rb") as file:
            whole = file.read()
        for k in range(0, len(whole), len(whole) // 20):  # one wrong byte: an error or, in a date, nothing
            with open(self.folder + "/sample.fmu", "wb") as file:
                file.write(whole[:k] + bytes([whole[k] ^ 0xff]) + whole[k + 1:])
            said = self.program("run", "scene.yaml", "--set", named)
            self.assertIn(said.returncode, (0, 2), said.stderr)
        for size in 0, 10, len(whole) // 2, len(whole) - 1:
            with open(self.folder + "/sample.fmu", "wb") as file:
                file.write(whole[:size])
            self.refused("no ZIP archive", named)
        self.assertEqual(os.listdir(temporary), [])

    def test_parameters_are_those_of_the_scene(self):
        global STIFFNESS, DAMPING
        before = STIFFNESS, DAMPING
        STIFFNESS, DAMPING = 2, 0.1
        try:
            self.assertLess(self.error("bodies[damper].fmu.parameters={k: 2, c: 0.1}"), 2e-3)
        finally:
            STIFFNESS, DAMPING = before

    def test_inputs_at_the_end_of_the_step_are_early_by_half_a_step(self):
        reached = "bodies[damper].fmu.inputs=reached"
        errors = [self.error(reached, "simulation.macro_step=%g ms" % h, force_within=0.1) for h in (10, 5, 2.5)]
        for coarse, fine in zip(errors, errors[1:]):  # order 1: the sample keeps its inputs
            self.assertAlmostEqual(coarse / fine, 2, delta=0.2)

    def test_the_example_of_the_documents_runs(self):
        with open(SOURCE + "/docs/programs.md") as file:
            section = file.read().split("## A body that is an FMU")[1]
        write(self.scene, section.split("```")[1])
        self.archive()
        os.rename(self.folder + "/sample.fmu", self.folder + "/damper.fmu")
        with bough.Session(self.scene) as run:
            rows = run.advance()
        self.assertLess(max(abs(rows["massPos"][-1]), abs(rows["damperFz"][-1])), 100)
        self.assertGreater(max(map(abs, rows["damperFz"])), 1)

    @unittest.skipUnless(os.environ.get("BOUGH_REFERENCE_FMUS"), "BOUGH_REFERENCE_FMUS names no folder of them")
    def test_the_reference_fmus_are_parts_of_a_scene(self):
        scene = SCENE.replace("[none, none, v, none", "[none, none, %s, none").replace("none, none, f,", "none, none, %s,")
        for name, given, force in (
                ("BouncingBall", "none", "h"), ("Dahlquist", "none", "x"), ("VanDerPol", "none", "x0"),
                ("Feedthrough", "Float64_continuous_input", "Float64_continuous_output"), ("Stair", "none", "none"),
                ("StateSpace", "none", "none"), ("Resource", "none", "none"), ("Roberts", "none", "y1")):
            write(self.scene, (scene % (given, force)).replace("folder: sample", "folder: %s/%s.fmu" % (
                os.environ["BOUGH_REFERENCE_FMUS"], name)))
            with bough.Session(self.scene) as run:
                rows = run.advance()
            end = rows["damperFz"][-1]
            if name == "Dahlquist":  # x' = -x by explicit Euler with its own step of 0.1 s
                self.assertAlmostEqual(end / 0.9 ** 50, 1, delta=1e-6)
            if name == "Feedthrough":  # v' = v / m
                self.assertAlmostEqual(end / math.exp(5 / MASS), 1, delta=1e-2)

    def test_threads_do_not_change_the_bits(self):
        rows = []
        for threads in 1, 2:
            with bough.Session(self.scene, "simulation.threads=%d" % threads) as run:
                rows.append(bytes(run.advance()["massPos"]))
        self.assertEqual(*rows)

    def test_what_does_not_fit_is_reported_with_its_place(self):
        write(self.scene, SCENE.replace("scheme: extrapolated", "scheme: ramp"))
        self.refused("scene.yaml:7:22: error: simulation.coupling.scheme: 'damper' is an FMU")
        write(self.scene, SCENE)
        self.refused("fixed steps", "simulation.step_control.tolerance=1e-3")
        self.refused("expected undeformed", "simulation.initial=equilibrium")
        self.refused("communication points only", "simulation.coupling.scheme=iterated",
                     "simulation.coupling.exchange=waveform")
        self.refused("needs tangents", "simulation.coupling.scheme=iterated",
                     "simulation.coupling.accelerator=interface-newton")
        motion = "bodies[damper].fmu.motion=[%s, none, v, none, none, none, none, none, none]"
        self.refused("no variable 'w' of type Float64", motion % "w")
        self.refused("'f' is not of causality input", motion % "f")
        wrench = "bodies[damper].fmu.wrench=[none, none, %s, none, none, none]"
        self.refused("'f_kN' is in kN; expected SI units", wrench % "f_kN")
        self.refused("'all' is an array", wrench % "all")
        self.refused("expected 6 names", "bodies[damper].fmu.wrench=[f]")
        self.refused("cannot read", "bodies[damper].fmu.folder=another")
        self.refused("parameters: the FMU has no variable 'kk' of type Float64 (did you mean 'k'?)",
                     "bodies[damper].fmu.parameters={kk: 1}")
        self.refused("the variable 'v' is not of causality parameter", "bodies[damper].fmu.parameters={v: 1}")
        self.refused("expected a mapping of names and numbers", "bodies[damper].fmu.parameters=8")
        self.refused("has no modes", command="modes")
        self.refused("has no equilibrium", command="static")
        done = self.program("export", "fmu", "scene.yaml")
        self.assertIn("'damper' is an FMU, whose equations are not known", done.stderr)
        self.assertEqual(done.returncode, 2)

    def test_the_folder_is_judged_before_the_run(self):
        self.unpack(version="2.0")
        self.refused("the FMU is of FMI 2.0; expected FMI 3.0")
        self.unpack(restores="false")
        self.error()
        self.refused("'damper' cannot restore its state", "simulation.coupling.scheme=iterated")
        self.unpack(library=None)
        self.refused("scene.yaml:18:7: fmu: the library of 'damper' cannot be loaded")
        self.refused("error: --set: fmu: the library of 'damper'",
                     "bodies[damper].fmu={folder: sample, motion: [none, none, v, none, none, none, none, none, none]"
                     ", wrench: [none, none, f, none, none, none]}")
        self.unpack(library=LACKING)
        self.refused("the library of 'damper' has no function fmi3DoStep")
        write(self.folder + "/sample/modelDescription.xml", "<fmiModelDescription")
        self.refused("sample/modelDescription.xml:1: unclosed token")
        self.unpack(once="true")
        write(self.scene, SCENE + SCENE[SCENE.index("  - name: damper"):].replace("name: damper", "name: b"))
        self.refused("only one body can use this FMU, and 'damper' does")

    def test_its_failure_is_reported_with_body_and_time(self):
        self.unpack(token="refuses")
        self.refused("damper: the FMU's fmi3InstantiateCoSimulation at 0 s: error: no licence", code=3)
        self.unpack(token="late")
        self.refused("damper: the FMU's fmi3DoStep at 0.52 s: error: the oil is too hot", code=3)
        self.unpack(token="infinite")
        self.refused("damper: output 'f' of the FMU at 0.52 s: not a finite number", code=3)
        self.unpack(token="early")
        self.refused("damper: the FMU ended its step at 0.54 s", code=3)

    def test_no_copy_of_a_state_that_is_elsewhere(self):
        with bough.Session(self.scene) as run:
            with self.assertRaisesRegex(Exception, "has memory of its own"):
                run.save()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
