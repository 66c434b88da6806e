"""An exported FMU as an importer meets it: test_fmu.py BOUGH SOURCE CONTROLLER, with the module bough in the path.

The archive, its description against the rules of FMI 3.0, the library by dlopen with all functions of
the standard, its run against bough's own to the bit.
"""
import ctypes
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml
import zipfile

import bough

PROGRAM, SOURCE, CONTROLLER = sys.argv[1:4]
TURBINE = SOURCE + "/apps/turbine/runup.yaml"
SETTINGS = ["title=many settings"] * 70 + [
            "bodies[3-5].rod.segments=8", "aero.wind.input=wind",
            "loads=[{joint: hub, torque: -2 MN m, input: brake}]", "simulation.threads=1"]

TYPES = "Float32 Float64 Int8 UInt8 Int16 UInt16 Int32 UInt32 Int64 UInt64 Boolean String Binary Clock"
FUNCTIONS = ["fmi3" + name for name in """
    GetVersion SetDebugLogging InstantiateModelExchange InstantiateCoSimulation
    InstantiateScheduledExecution FreeInstance EnterInitializationMode ExitInitializationMode
    EnterEventMode Terminate Reset GetNumberOfVariableDependencies GetVariableDependencies GetFMUState
    SetFMUState FreeFMUState SerializedFMUStateSize SerializeFMUState DeserializeFMUState
    GetDirectionalDerivative GetAdjointDerivative EnterConfigurationMode ExitConfigurationMode
    GetIntervalDecimal GetIntervalFraction GetShiftDecimal GetShiftFraction SetIntervalDecimal
    SetIntervalFraction SetShiftDecimal SetShiftFraction EvaluateDiscreteStates UpdateDiscreteStates
    EnterContinuousTimeMode CompletedIntegratorStep SetTime SetContinuousStates
    GetContinuousStateDerivatives GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates
    GetNumberOfEventIndicators GetNumberOfContinuousStates EnterStepMode GetOutputDerivatives DoStep
    ActivateModelPartition""".split()]
FUNCTIONS += ["fmi3%s%s" % (access, name) for access in ("Get", "Set") for name in TYPES.split()]

OK, ERROR = 0, 3
REAL, REFERENCE, SIZE = ctypes.c_double, ctypes.c_uint32, ctypes.c_size_t
LOG = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p)


def setUpModule():
    global folder, root, library
    folder = tempfile.TemporaryDirectory()
    sets = [word for s in SETTINGS for word in ("--set", s)]
    subprocess.run([PROGRAM, "export", "fmu", TURBINE, "--out", folder.name, *sets], check=True,
                   stdout=subprocess.DEVNULL)
    with zipfile.ZipFile(folder.name + "/bough.fmu") as archive:
        assert archive.testzip() is None
        archive.extractall(folder.name + "/x")
    root = xml.parse(folder.name + "/x/modelDescription.xml").getroot()
    library = ctypes.CDLL(folder.name + "/x/binaries/x86_64-linux/bough.so")
    library.fmi3GetVersion.restype = ctypes.c_char_p
    library.fmi3InstantiateCoSimulation.restype = ctypes.c_void_p


def tearDownModule():
    folder.cleanup()


class Instance:
    def __init__(self, token=None):
        self.messages = []
        self.log = LOG(lambda environment, status, category, text: self.messages.append(text.decode()))
        resources = (folder.name + "/x/resources/").encode()
        token = (token or root.get("instantiationToken")).encode()
        self.pointer = library.fmi3InstantiateCoSimulation(
            b"one", token, resources, False, False, False, False, None, SIZE(0), None, self.log, None)
        self.pointer = self.pointer and ctypes.c_void_p(self.pointer)

    def start(self, stop=None, start=0, **inputs):
        entered = library.fmi3EnterInitializationMode(self.pointer, False, REAL(0), REAL(start),
                                                      stop is not None, REAL(stop or 0))
        for name, value in inputs.items():
            self.set(variables("input")[name], value)
        return entered, library.fmi3ExitInitializationMode(self.pointer)

    def get(self, references):
        values = (REAL * len(references))()
        array = (REFERENCE * len(references))(*references)
        status = library.fmi3GetFloat64(self.pointer, array, SIZE(len(references)), values,
                                        SIZE(len(references)))
        return list(values) if status == OK else status

    def set(self, reference, value):
        return library.fmi3SetFloat64(self.pointer, (REFERENCE * 1)(reference), SIZE(1),
                                      (REAL * 1)(value), SIZE(1))

    def step(self, time, size):
        flags, reached = [ctypes.c_bool() for _ in range(3)], REAL()
        status = library.fmi3DoStep(self.pointer, REAL(time), REAL(size), False,
                                    *(ctypes.byref(x) for x in (*flags, reached)))
        return status, reached.value

    def free(self):
        library.fmi3FreeInstance(self.pointer)


def variables(causality):
    return {v.get("name"): int(v.get("valueReference")) for v in root.find("ModelVariables")
            if v.get("causality") == causality}


class Files(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = self.temporary.name

    def tearDown(self):
        self.temporary.cleanup()

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w") as file:
            file.write(text)

    def export(self, *words):
        return subprocess.run([PROGRAM, "export", "fmu", *words, "--out", "x"], cwd=self.folder,
                              capture_output=True, text=True)

    def names(self):
        with zipfile.ZipFile(self.folder + "/x/bough.fmu") as archive:
            self.assertIsNone(archive.testzip())
            return sorted(name for name in archive.namelist() if name.startswith("resources/"))

    def test_every_table_is_in_the_archive(self):
        tables = range(100)
        section = "stiffness: [1e9, 1e9, 1e9, 1e6, 1e6, 1e6], mass: [1, 0, 0, 1, 1, 0]"
        for k in tables:
            self.write("t%02d.yaml" % k, "length: 5\nstations:\n" + "".join(
                "- {span: %d, %s}\n" % (span, section) for span in (0, 5)))
        self.write("many.yaml", "simulation: {duration: 1 s, macro_step: 10 ms}\nbodies:\n" + "".join(
            "- {name: b%d, fidelity: rod, joint: {kind: fixed, parent: ground}, "
            "rod: {table: t%02d.yaml, segments: 2}}\n" % (k, k) for k in tables))
        said = self.export("many.yaml")
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertEqual(self.names(), sorted(["resources/many.yaml", "resources/scene.txt"] +
                                              ["resources/t%02d.yaml" % k for k in tables]))

    def test_a_directory_stands_for_the_scene_in_it(self):
        self.write("mine/scene.yaml", "simulation: {duration: 1 s}\n"
                   "bodies: [{name: a, fidelity: rigid, mass: 1, joint: {kind: prismatic, axis: z, parent: ground}}]\n")
        said = self.export("mine")
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn("resources/scene.txt", self.names())
        os.mkdir(self.folder + "/empty")
        self.assertIn("'empty' holds no scene", self.export("empty").stderr)

    def test_the_files_of_a_controller_are_in_the_archive(self):
        for name in "power", "blade-structure", "blade-aero", "airfoils":
            with open(SOURCE + "/apps/turbine/%s.yaml" % name) as file:
                self.write("scenes/%s.yaml" % name, file.read())
        os.makedirs(self.folder + "/control")
        shutil.copy(CONTROLLER, self.folder + "/control/law.so")
        self.write("control/law.in", "100 ! gain\n\"../tables/Cp.txt\" ! PerfFileName\n")
        self.write("tables/Cp.txt", "0.4\n")
        given = ["--set", "control={kind: bladed, library: ../control/law.so, input: ../control/law.in, pitch: false}"]
        said = self.export("scenes/power.yaml", *given)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertEqual([name[10:] for name in self.names() if name.endswith((".txt", ".so", ".in"))],
                         ["control/law.in", "control/law.so", "scene.txt", "tables/Cp.txt"])
        said = self.export("scenes/power.yaml", *given,
                           "--set", "control.library=%s/control/law.so" % self.folder)
        self.assertEqual(said.returncode, 2)
        self.assertIn("control.library: '%s/control/law.so' is not given relative" % self.folder, said.stderr)
        absolute = "%s/scenes/power.yaml" % self.folder # of the scene itself it changes nothing
        self.assertEqual(self.export(absolute, *given).returncode, 0)


class Fmu(unittest.TestCase):
    def test_the_library_shows_all_functions_and_needs_libc_only(self):
        self.assertEqual(len(set(FUNCTIONS)), 75)
        for name in FUNCTIONS:
            self.assertTrue(hasattr(library, name), name)
        self.assertEqual(library.fmi3GetVersion(), b"3.0")
        path = folder.name + "/x/binaries/x86_64-linux/bough.so"
        needs = subprocess.run(["ldd", path], capture_output=True, text=True).stdout
        for line in needs.splitlines():
            self.assertRegex(line, r"^\s*(linux-vdso|libm\.so\.6|libc\.so\.6|/lib64/ld-linux)")

    def test_the_description_follows_the_standard(self):
        self.assertEqual((root.tag, root.get("fmiVersion")), ("fmiModelDescription", "3.0"))
        order = [child.tag for child in root]
        rules = ["CoSimulation", "UnitDefinitions", "LogCategories", "DefaultExperiment",
                 "ModelVariables", "ModelStructure"]
        self.assertEqual(order, rules)
        kind = root.find("CoSimulation")
        self.assertEqual(kind.get("modelIdentifier"), "bough")
        every = list(root.find("ModelVariables"))
        for key in "name", "valueReference":
            values = [v.get(key) for v in every]
            self.assertEqual(len(set(values)), len(values), key)
        units = {u.get("name"): u.find("BaseUnit").attrib for u in root.find("UnitDefinitions")}
        self.assertEqual(units["kN"], {"kg": "1", "m": "1", "s": "-2", "factor": "1000"})
        self.assertEqual(units["s"], {"s": "1"})
        self.assertAlmostEqual(float(units["rpm"]["factor"]) * 30, 3.14159265358979)
        for v in every:
            self.assertIn(v.get("causality"), ("independent", "input", "output"))
            self.assertEqual(v.get("variability"), "continuous")
            self.assertEqual(v.get("start") is not None, v.get("causality") == "input")
            self.assertIn(v.get("unit"), units)
            self.assertNotIn("{", v.get("description", "time"))
        described = {v.get("name"): v.get("description") for v in every}
        self.assertEqual(described["wind"], "speed of the wind")
        self.assertEqual(list(variables("independent")), ["time"])
        outputs = set(variables("output").values())
        structure = root.find("ModelStructure")
        for tag in "Output", "InitialUnknown":
            listed = [int(x.get("valueReference")) for x in structure.findall(tag)]
            self.assertEqual(set(listed), outputs)
            self.assertEqual(len(listed), len(outputs))
        for output in structure.findall("Output"):
            self.assertEqual(output.get("dependencies"), "")
        self.assertEqual(kind.get("providesDirectionalDerivatives"), "false")
        self.assertEqual(set(variables("input")), {"wind", "brake"})

    def test_outputs_do_not_depend_on_inputs_at_the_same_time(self):
        fmu, every = Instance(), sorted(variables("output").values())
        fmu.start()
        fmu.step(0, 0.2)
        before = fmu.get(every)
        for name, value in ("wind", 5), ("brake", -1e6):
            self.assertEqual(fmu.set(variables("input")[name], value), OK)
        self.assertEqual(fmu.get(every), before)
        fmu.free()

    def test_its_run_is_boughs_own_to_the_bit(self):
        inputs, outputs = variables("input"), variables("output")
        fmu = Instance()
        self.assertEqual(fmu.start(), (OK, OK))
        with bough.Session(TURBINE, *SETTINGS) as own:
            self.assertEqual(set(own.names), set(outputs))
            for k in range(20):
                wind, brake = 20 - 0.1 * k, -2e6 - 1e4 * k
                own["wind"], own["brake"] = wind, brake
                self.assertEqual(fmu.set(inputs["wind"], wind), OK)
                self.assertEqual(fmu.set(inputs["brake"], brake), OK)
                for _ in range(2):
                    own.step()
                self.assertEqual(fmu.step(0.04 * k, 0.04)[0], OK, fmu.messages)
                self.assertEqual(fmu.get([outputs[name] for name in own.names]), list(own.values))
                self.assertEqual(fmu.get([0]), [own.time])
        self.assertEqual(library.fmi3Terminate(fmu.pointer), OK)
        fmu.free()

    def test_outputs_at_time_0_follow_from_the_inputs_of_the_initialisation(self):
        outputs = variables("output")
        for stop in None, 50:
            fmu = Instance()
            self.assertEqual(fmu.start(stop, wind=9, brake=-1e6), (OK, OK), fmu.messages)
            with bough.Session(TURBINE, *SETTINGS, "aero.wind.speed=9", "loads[0].torque=-1e6") as own:
                for k in range(3):
                    self.assertEqual(fmu.get([outputs[name] for name in own.names]), list(own.values))
                    own.step()
                    self.assertEqual(fmu.step(0.02 * k, 0.02)[0], OK, fmu.messages)
            library.fmi3Reset(fmu.pointer)
            self.assertEqual(fmu.get([outputs["Wind1VelX"]]), [20])
            fmu.free()

    @unittest.skipUnless(shutil.which("fmusim"), "no fmusim of the Reference FMUs in the PATH")
    def test_a_public_client_runs_it_as_bough_does(self):
        table = folder.name + "/fmusim.csv"
        said = subprocess.run(["fmusim", "--interface-type", "cs", "--stop-time", "0.4", "--output-interval", "0.1",
                               "--output-file", table, folder.name + "/bough.fmu"], capture_output=True, text=True)
        self.assertEqual(said.returncode, 0, said.stderr)
        rows = bough.read(table)
        with bough.Session(TURBINE, *SETTINGS) as own:
            for k in range(5):
                own.advance(0.1 * k)
                for name in own.names:
                    # the client writes 16 digits
                    self.assertAlmostEqual(rows[name][k], own[name], delta=1e-15 * abs(own[name]), msg=(k, name))

    def test_a_run_that_starts_later_is_the_same(self):
        early, late = Instance(), Instance()
        self.assertEqual(early.start(), (OK, OK))
        self.assertEqual(late.start(stop=1050, start=1000), (OK, OK), late.messages)
        every = sorted(variables("output").values())
        for k in range(5):
            self.assertEqual(early.step(0.2 * k, 0.2), (OK, early.get([0])[0]))
            self.assertEqual(late.step(1000 + 0.2 * k, 0.2)[0], OK, late.messages)
            self.assertAlmostEqual(late.get([0])[0], 1000.2 + 0.2 * k)
            self.assertEqual(late.get(every), early.get(every))
        self.assertEqual(late.step(0, 0.2)[0], ERROR)
        early.free()
        late.free()
        self.assertEqual(Instance().start(stop=3, start=5)[0], ERROR)

    def test_time_may_be_that_of_a_calendar(self):
        early, late, epoch = Instance(), Instance(), 1.7e9
        early.start()
        late.start(start=epoch)
        every = sorted(variables("output").values())
        for k in range(3):
            early.step(0.02 * k, 0.02)
            self.assertEqual(late.step(epoch + 0.02 * k, 0.02)[0], OK, late.messages)
            self.assertEqual(late.get(every), early.get(every))
        self.assertEqual(late.step(epoch, 0.02)[0], ERROR)
        early.free()
        late.free()

    def test_a_stop_time_needs_no_whole_macro_steps(self):
        fmu = Instance()
        self.assertEqual(fmu.start(stop=50.007), (OK, OK), fmu.messages)
        self.assertEqual(fmu.step(0, 0.02)[0], OK, fmu.messages)
        fmu.free()

    def test_no_step_leads_beyond_the_stop_time(self):
        fmu = Instance()
        fmu.start(stop=1000.05, start=1000)  # in the third macro step
        for far in (0.08, float("inf"), float("nan")):
            self.assertEqual(fmu.step(1000, far), (ERROR, 1000))
        self.assertEqual(fmu.step(1000, 0.06)[0], OK, fmu.messages)
        self.assertEqual(fmu.step(1000.06, 0.02)[0], ERROR)
        self.assertIn("0.02 s lead beyond the end at 1000.06 s", fmu.messages[-1])
        fmu.free()

    def test_a_state_is_gone_back_to(self):
        fmu, place = Instance(), ctypes.c_void_p()
        fmu.start()
        fmu.step(0, 0.2)
        self.assertEqual(library.fmi3GetFMUState(fmu.pointer, ctypes.byref(place)), OK, fmu.messages)
        every = sorted(variables("output").values())
        fmu.step(0.2, 0.2)
        once = fmu.get(every)
        fmu.set(variables("input")["wind"], 5)
        fmu.step(0.4, 0.2)
        self.assertEqual(library.fmi3SetFMUState(fmu.pointer, place), OK)
        self.assertAlmostEqual(fmu.get([0])[0], 0.2)
        fmu.step(0.2, 0.2)
        self.assertEqual(fmu.get(every), once)
        self.assertEqual(library.fmi3Reset(fmu.pointer), OK)
        self.assertEqual(fmu.get([0]), [0])
        self.assertEqual(library.fmi3SetFMUState(fmu.pointer, place), OK)
        fmu.step(0.2, 0.2)
        self.assertEqual(fmu.get(every), once)
        self.assertEqual(library.fmi3FreeFMUState(fmu.pointer, ctypes.byref(place)), OK)
        fmu.start(start=7)
        library.fmi3Reset(fmu.pointer)
        self.assertEqual(fmu.get([0]), [0])
        fmu.free()

    def test_what_is_wrong_is_reported(self):
        self.assertIsNone(Instance("another").pointer)
        fmu = Instance()
        self.assertEqual(fmu.step(0, 0.02)[0], ERROR)  # not initialised
        fmu.start()
        self.assertEqual(fmu.step(0, 0.03)[0], ERROR)
        self.assertIn("not a whole number of macro steps of 0.02 s", fmu.messages[-1])
        self.assertEqual(fmu.step(0, 0.02)[0], OK, "the refused step has moved nothing")
        self.assertEqual(fmu.set(0, 1), ERROR)
        self.assertEqual(fmu.get([100000]), ERROR)
        fmu.free()
        longer = Instance()
        self.assertEqual(longer.start(50.0), (OK, OK))  # beyond the scene's own duration
        self.assertEqual(longer.step(0, 0.02)[0], OK)
        longer.free()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
