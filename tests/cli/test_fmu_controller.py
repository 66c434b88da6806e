"""A controller that is an FMU of another program: test_fmu_controller.py BOUGH SOURCE SAMPLE. SAMPLE is the library of
sample_controller_fmu.c, the law of variable speed."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import bough

PROGRAM, SOURCE, SAMPLE = sys.argv[1:4]
SCENE = SOURCE + "/apps/turbine/power.yaml"
DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="controller" instantiationToken="law">
  <CoSimulation modelIdentifier="sample" canBeInstantiatedOnlyOncePerProcess="%s"/>
  <UnitDefinitions>
    <Unit name="rpm"><BaseUnit s="-1" rad="1" factor="0.10471975511965977"/></Unit>
  </UnitDefinitions>
  <ModelVariables>
    <Float64 name="omega" valueReference="1" causality="input" variability="continuous" start="0"/>
    <Float64 name="beta" valueReference="2" causality="input" variability="continuous" start="0"/>
    <Float64 name="gain" valueReference="3" causality="parameter" variability="fixed" start="2.332287"/>
    <Float64 name="T" valueReference="4" causality="output" variability="discrete"/>
    <Float64 name="demand" valueReference="5" causality="output" variability="discrete"/>
    <Float64 name="t" valueReference="6" causality="input" variability="continuous" start="0"/>
    <Float64 name="beta2" valueReference="7" causality="input" variability="continuous" start="0"/>
    <Float64 name="beta3" valueReference="8" causality="input" variability="continuous" start="0"/>
    <Float64 name="n" valueReference="9" causality="input" variability="continuous" start="0" unit="rpm"/>
  </ModelVariables>
  <ModelStructure><Output valueReference="4"/><Output valueReference="5"/></ModelStructure>
</fmiModelDescription>
"""
RIGID = ["bodies[%s].fidelity=rigid" % name for name in ("blade1", "blade2", "blade3")]
BASE = RIGID + ["simulation.duration=5 s", "aero.wind.speed=13 m/s", "simulation.error_estimate=none"]
INPUTS = "{time: t, generator_speed: omega, pitch: [beta, beta2, beta3]}"
OUTPUTS = "{torque: T, pitch: [demand]}"
CHANNELS = "RotSpeed", "GenTq", "BldPitch1", "BldPitch3"


class Controller(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.unpack()

    def unpack(self, once="false"):
        binaries = self.folder + "/sample/binaries/%s-linux" % os.uname().machine
        os.makedirs(binaries, exist_ok=True)
        with open(self.folder + "/sample/modelDescription.xml", "w") as file:
            file.write(DESCRIPTION % once)
        shutil.copy(SAMPLE, binaries + "/sample.so")

    def control(self, inputs=INPUTS, outputs=OUTPUTS, more=""):
        return "control={kind: fmu, fmu: {folder: %s/sample, inputs: %s, outputs: %s%s}}" % (
            self.folder, inputs, outputs, more)

    def rows(self, *sets):
        with bough.Session(SCENE, *BASE, *sets) as run:
            rows = run.advance()
        return [bytes(rows[name]) for name in CHANNELS]

    def run_program(self, command, *sets):
        words = [word for s in sets for word in ("--set", s)]
        return subprocess.run([PROGRAM, command, SCENE, *words], capture_output=True, text=True, cwd=self.folder)

    def test_the_built_in_law_as_an_fmu_gives_the_same_bits(self):
        expected = self.rows("control={kind: variable-speed}")
        self.assertEqual(self.rows(self.control()), expected)
        each = "{torque: T, pitch: [demand, demand, demand]}"
        self.assertEqual(self.rows(self.control(outputs=each)), expected)
        low = self.rows(self.control(more=", parameters: {gain: 2}"), "aero.wind.speed=9 m/s")
        self.assertEqual(low, self.rows("control={kind: variable-speed, law: {optimal_gain: 2}}",
                                        "aero.wind.speed=9 m/s"))
        self.assertNotEqual(low, self.rows("control={kind: variable-speed}", "aero.wind.speed=9 m/s"))

    def test_blades_without_a_demand_keep_their_pitch(self):
        with bough.Session(SCENE, *BASE, "bodies[blade1].pitch=3 deg", "bodies[blade2].pitch=3 deg",
                           "bodies[blade3].pitch=3 deg", self.control(outputs="{torque: T}")) as run:
            rows = run.advance()
        self.assertLess(max(abs(pitch - 3) for pitch in rows["BldPitch1"]), 1e-9)

    def test_its_error_is_estimated_where_a_second_instance_may_be(self):
        sets = RIGID + ["simulation.duration=1 s", self.control()]
        self.assertIn("error", self.run_program("run", *sets).stdout)
        with open(self.folder + "/out/power/summary.json") as file:
            self.assertNotIn("second time", file.read())
        self.unpack(once="true")
        self.assertIn("cannot be loaded a second time", "".join(self.run_program("run", *sets).stdout))

    def test_the_example_of_the_documents_runs(self):
        with open(SOURCE + "/docs/programs.md") as file:
            block = file.read().split("## A controller that is an FMU")[1].split("```")[1]
        os.rename(self.folder + "/sample", self.folder + "/unpacked")
        shutil.make_archive(self.folder + "/controller", "zip", self.folder + "/unpacked")
        os.rename(self.folder + "/controller.zip", self.folder + "/controller.fmu")
        scene = self.folder + "/scene.yaml"
        with open(scene, "w") as file:
            file.write("base: %s\n%s" % (SCENE, block.removeprefix("yaml")))
        with bough.Session(scene, *BASE, "simulation.duration=1 s") as run:
            self.assertGreater(run.advance()["GenTq"][-1], 1)

    def refused(self, expected, *sets):
        said = self.run_program("check", *sets)
        self.assertIn(expected, said.stderr)
        self.assertEqual(said.returncode, 2)

    def test_names_that_do_not_fit_are_refused_with_the_nearest(self):
        inputs = "{time: t, generator_speed: omeg, pitch: [beta, beta2, beta3]}"
        self.refused("control.fmu.inputs: the FMU has no variable 'omeg' of type Float64 (did you mean 'omega'?)",
                     self.control(inputs))
        self.refused("(did you mean 'generator_speed'?)", self.control("{generator_sped: omega}"))
        self.refused("'T' is not of causality input", self.control("{generator_speed: T}"))
        self.refused("'n' is in rpm; expected SI units", self.control("{generator_speed: n}"))
        self.refused("'omega' is not of causality output", self.control(outputs="{torque: omega}"))
        self.refused("'torque' is missing", self.control(outputs="{pitch: [demand]}"))
        self.refused("expected one name for all blades, or a name for each of the 3 blades, got 2",
                     self.control(outputs="{torque: T, pitch: [demand, demand]}"))
        self.refused("expected a name for each of the 3 blades, got 1",
                     self.control("{generator_speed: omega, pitch: [beta]}"))
        self.refused("has no variable 'gian'", self.control(more=", parameters: {gian: 2}"))
        self.refused("cannot read", "control={kind: fmu, fmu: {folder: none, inputs: {}, outputs: {torque: T}}}")
        scene = self.folder + "/scene.yaml"
        with open(scene, "w") as file:
            file.write("base: %s\ncontrol:\n  kind: fmu\n  fmu:\n    folder: sample\n    inputs:\n"
                       "      generator_speed: omeg\n    outputs: {torque: T}\n" % SCENE)
        said = subprocess.run([PROGRAM, "check", scene], capture_output=True, text=True)
        self.assertIn("scene.yaml:7:24: error: control.fmu.inputs", said.stderr)

    def test_its_failure_ends_the_run_with_its_time(self):
        said = self.run_program("run", *RIGID, self.control("{generator_speed: omega}"), "simulation.duration=1 s")
        self.assertIn("control: the FMU's fmi3DoStep at 0.02 s: error", said.stderr)
        self.assertEqual(said.returncode, 3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
