"""bough from Python: runs scenes, reads results, steps a scene, sets inputs, stores copies of its state.

    import bough
    rows = bough.read("out/runup")                 # the results of a run
    print(rows.units["RotSpeed"], rows["RotSpeed"][-1])
    with bough.Session("runup.yaml", "simulation.duration=5 s") as run:
        rows = run.advance(2.0, ["RotSpeed"])      # stepped here

The module needs Python 3.8 and nothing else. If numpy is installed, columns and values are numpy arrays.
BOUGH_LIBRARY may name the library; otherwise the module searches for it where pip and `cmake --install` put it,
beside this file or up to three folders above, and then where the system searches.
"""
from __future__ import annotations

import array
import collections.abc
import csv
import ctypes
import glob
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Union

try:
    import numpy
except ImportError:
    numpy = None

OK, DONE, INVALID, FAILED, OTHER = 0, -1, 2, 3, 1


class Error(Exception):
    """A message of bough about a scene, a step or a copy; `code` is INVALID, FAILED or OTHER."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code

    def __str__(self):
        return self.args[0]


class UnknownName(Error, KeyError):
    """The scene has no channel or input of that name; the message names the nearest."""


def _load():
    here = os.path.dirname(os.path.abspath(__file__))
    above = [os.path.join(here, *[".."] * up, "libbough.so.0") for up in range(4)]
    above += glob.glob(os.path.join(here, *[".."] * 3, "*", "libbough.so.0"))
    found = [path for path in above if os.path.exists(path)]
    path = os.environ.get("BOUGH_LIBRARY") or (found[0] if found else "libbough.so.0")
    library = ctypes.CDLL(path)
    library.path = path
    session, text, real = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_double
    for name, result, *arguments in (
        ("open", session, text, ctypes.POINTER(text), ctypes.c_int),
        ("code", ctypes.c_int, session),
        ("error", text, session),
        ("warning", text, session),
        ("step", ctypes.c_int, session),
        ("time", real, session),
        ("duration", real, session),
        ("count", ctypes.c_int, session),
        ("name", text, session, ctypes.c_int),
        ("unit", text, session, ctypes.c_int),
        ("find", ctypes.c_int, session, text),
        ("values", ctypes.c_void_p, session),
        ("estimate", real, session, ctypes.c_int),
        ("bodies", ctypes.c_int, session),
        ("body_name", text, session, ctypes.c_int),
        ("stations", ctypes.c_int, session, ctypes.c_int),
        ("poses", ctypes.c_int, session, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p),
        ("inputs", ctypes.c_int, session),
        ("input_name", text, session, ctypes.c_int),
        ("input_unit", text, session, ctypes.c_int),
        ("input", ctypes.c_int, session, text),
        ("input_value", real, session, ctypes.c_int),
        ("set", ctypes.c_int, session, ctypes.c_int, real),
        ("set_text", ctypes.c_int, session, ctypes.c_int, text),
        ("size", ctypes.c_size_t, session),
        ("save", ctypes.c_int, session, ctypes.c_void_p),
        ("restore", ctypes.c_int, session, ctypes.c_void_p),
        ("close", None, session),
    ):
        function = getattr(library, "bough_session_" + name)
        function.restype, function.argtypes = result, arguments
    return library


_library = _load()


def _view(doubles):
    """numpy's array on the memory of the doubles, where there is numpy."""
    return numpy.frombuffer(doubles) if numpy else doubles


# -- results --------------------------------------------------------------------------------------


class Table(collections.abc.Mapping):
    """Columns by name: table["RotSpeed"], an array with one value for each row.

    names    names of the columns, in order
    units    unit of each name, "" where there is none
    title    of the file, or ""
    summary  what summary.json beside the file says: status, cost, estimated errors; {} where there is none
    """

    def __init__(self, names: List[str], units: List[str], columns: list, title: str = "") -> None:
        self.names, self.units, self.title = names, dict(zip(names, units)), title
        self.summary: Dict[str, Any] = {}
        self._column = dict(zip(names, columns))

    @property
    def time(self) -> Any:
        """The time of each row [s]."""
        return self["Time"]

    def __getitem__(self, name: str) -> Any:
        """The column of that name."""
        if name in self._column:
            return self._column[name]
        raise UnknownName(INVALID, "no column %r; there are: %s" % (name, ", ".join(self.names)))

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def __repr__(self) -> str:
        return "<%d columns: %s>" % (len(self), ", ".join(self.names[:4] + ["..."] * (len(self) > 4)))


def _column(values: Sequence[Any]) -> Any:
    """An array of numbers, or the words as they are."""
    try:
        return _view(array.array("d", map(float, values)))
    except ValueError:
        return list(values)


def _read_text(path: str) -> Table:
    """OpenFAST's text: a title in the lines before the names, the units, rows."""
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = file.read().splitlines()
    head = next((i for i, line in enumerate(lines[:-1]) if line.split()[:1] == ["Time"]), None)
    if head is None:
        raise Error(INVALID, "%s: no line that begins with 'Time'" % path)
    names, rows = lines[head].split(), [line.split() for line in lines[head + 2:] if line.strip()]
    for i, row in enumerate(rows):
        if len(row) != len(names):
            raise Error(INVALID, "%s:%d: expected %d values, got %d" % (path, head + 3 + i, len(names), len(row)))
    units = [unit.strip("()") for unit in lines[head + 1].split()]
    title = " ".join(line.strip() for line in lines[:head] if line.strip())
    columns = zip(*rows) if rows else [()] * len(names)
    return Table(names, units, [_column(c) for c in columns], title)


def _read_binary(path: str) -> Table:
    """OpenFAST's binary output, all four kinds: https://github.com/OpenFAST/openfast, NWTC_IO."""
    with open(path, "rb") as file:
        data = file.read()
    at = 0

    def take(form: str) -> tuple:
        nonlocal at
        values = struct.unpack_from("<" + form, data, at)
        at += struct.calcsize("<" + form)
        return values

    try:
        kind, = take("h")
        if kind not in (1, 2, 3, 4):
            raise Error(INVALID, "%s: not of OpenFAST's binary output" % path)
        width = take("h")[0] if kind == 4 else 10
        n, rows = take("ii")
        first, second = take("dd")
        scale, offset = (take("%df" % n), take("%df" % n)) if kind != 3 else ((1.0,) * n, (0.0,) * n)
        title = take("%ds" % take("i"))[0].decode("utf-8", "replace").strip()
        words = [take("%ds" % width)[0].decode("utf-8", "replace").strip() for _ in range(2 * n + 2)]
        time = [(t - second) / first for t in take("%di" % rows)] if kind == 1 else \
            [first + second * i for i in range(rows)]
        packed = array.array("d" if kind == 3 else "h")
        packed.frombytes(data[at:at + n * rows * packed.itemsize])
        if len(packed) != n * rows:
            raise Error(INVALID, "%s: the file is cut" % path)
    except (struct.error, ValueError):
        raise Error(INVALID, "%s: the file is cut" % path) from None
    if sys.byteorder == "big":
        packed.byteswap()
    columns = [_column([(v - offset[k]) / scale[k] for v in packed[k::n]]) for k in range(n)]
    return Table(words[:n + 1], [u.strip("()") for u in words[n + 1:]], [_column(time), *columns], title)


def _read_csv(path: str) -> Table:
    """A table of bough: names with units in parentheses, then rows."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    if not rows:
        raise Error(INVALID, "%s: the file is empty" % path)
    heads = [re.fullmatch(r"(.*?)(?: \(([^()]*)\))?", head) for head in rows[0]]
    names, units = [h.group(1) for h in heads if h], [h.group(2) or "" for h in heads if h]
    columns = zip(*rows[1:]) if rows[1:] else [()] * len(names)
    return Table(names, units, [_column(c) for c in columns])


def read(path: Union[str, os.PathLike]) -> Table:
    """Results as a Table: the folder of a run, a file .out or .outb of bough or OpenFAST, or a .csv of bough."""
    path = os.fspath(path)
    folder = path if os.path.isdir(path) else os.path.dirname(path)
    if os.path.isdir(path):
        path = os.path.join(path, "channels.out")
    kinds = {".out": _read_text, ".outb": _read_binary, ".csv": _read_csv}
    kind = os.path.splitext(path)[1]
    if kind not in kinds:
        raise Error(INVALID, "%s: expected a folder of results, or a file %s" % (path, ", ".join(kinds)))
    table = kinds[kind](path)
    summary = os.path.join(folder, "summary.json")
    if os.path.basename(path).startswith("channels.") and os.path.exists(summary):
        with open(summary, encoding="utf-8") as file:
            table.summary = json.load(file)
    return table


def _command(command: str, file: str, scene: Union[str, os.PathLike], settings: Sequence[str],
             out: Union[None, str, os.PathLike]) -> Table:
    """Runs a command of the program, which lies by the library, into a folder and reads a file of it."""
    here = os.path.dirname(os.path.abspath(_library.path)) if os.path.dirname(_library.path) else ""
    beside = [os.path.join(here, *place, "bough") for place in ((), *((*[".."] * up, "bin") for up in (1, 2, 4)))]
    program = next((p for p in beside if here and os.path.isfile(p)), None) or shutil.which("bough")
    if not program:
        raise Error(OTHER, "the program bough is neither by the library nor in the PATH")
    with tempfile.TemporaryDirectory() as scratch:
        folder = os.fspath(out) if out is not None else scratch
        words = [program, command, os.fspath(scene), "--out", folder]
        for setting in settings:
            words += ["--set", setting]
        ran = subprocess.run(words, capture_output=True, text=True)
        if ran.returncode != 0:
            raise Error(ran.returncode, ran.stderr.strip())
        return read(os.path.join(folder, file))


def run(scene: Union[str, os.PathLike], *settings: str, out: Union[None, str, os.PathLike] = None) -> Table:
    """Runs a scene to its end, errors estimated, and returns its channels; `out` keeps the folder of the results."""
    return _command("run", "channels.out", scene, settings, out)


def modes(scene: Union[str, os.PathLike], *settings: str, out: Union[None, str, os.PathLike] = None) -> Table:
    """Frequencies, damping ratios and patterns of a scene's modes, a row each (`bough help modes`)."""
    return _command("modes", "modes.csv", scene, settings, out)


def static(scene: Union[str, os.PathLike], *settings: str, out: Union[None, str, os.PathLike] = None) -> Table:
    """The equilibrium of the rods: displacements and section forces, a row for each vertex (`bough help static`)."""
    return _command("static", "static.csv", scene, settings, out)


# -- sessions -------------------------------------------------------------------------------------


class _Handle:
    """The session in C: lives as long as its session in Python or a view of its values."""

    def __init__(self, scene, settings):
        words = (ctypes.c_char_p * len(settings))(*(os.fsencode(s) for s in settings))
        self.pointer = _library.bough_session_open(os.fsencode(scene), words, len(settings))
        if not self.pointer:
            raise MemoryError

    def __del__(self):
        if getattr(self, "pointer", None):
            _library.bough_session_close(self.pointer)


class Pose(NamedTuple):
    """Where the stations of a body are: the vertices of a rod from its root to its end, else the body's origin alone.

    position    (stations, 3) in ground axes [m]
    rotation    (stations, 3, 3) matrices, which take components in the axes of body or section to those in ground axes
    """

    position: Any
    rotation: Any


def _shaped(values: array.array, *shape: int) -> Any:
    """numpy's array of that shape; lists in lists where there is no numpy."""
    if numpy:
        return numpy.frombuffer(values).reshape(shape)
    rows = list(values)
    for n in reversed(shape[1:]):
        rows = [rows[k:k + n] for k in range(0, len(rows), n)]
    return rows


class Session:
    """A scene that runs: Session("runup.yaml", "aero.wind.speed=12 m/s", ...).

    names, units    names and units of its channels, in order
    """

    names: List[str]
    units: List[str]

    def __init__(self, scene: Union[str, os.PathLike], *settings: str) -> None:
        self._handle = _Handle(scene, settings)
        self._check(self._call("code"))
        text = {"names": "name", "units": "unit"}
        for attribute, call in text.items():
            words = [self._call(call, i).decode() for i in range(self._call("count"))]
            setattr(self, attribute, words)
        self._index = {name: i for i, name in enumerate(self.names)}
        inputs = range(self._call("inputs"))
        self._input = {self._call("input_name", i).decode(): i for i in inputs}

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Releases the session; views of its values stay valid."""
        self._handle = None

    def _call(self, name, *arguments):
        if self._handle is None:
            raise ValueError("the session is closed")
        return getattr(_library, "bough_session_" + name)(self._handle.pointer, *arguments)

    def _error(self):
        return self._call("error").decode().rstrip()

    def _check(self, code):
        if code not in (OK, DONE):
            raise Error(code, self._error())
        return code

    def _find(self, known, call, name):
        """The index of a channel or an input among those known; the error of the library's call is raised."""
        if name in known:
            return known[name]
        if not isinstance(name, str):
            raise TypeError("expected the name of a channel or an input, got %r" % (name,))
        self._call(call, name.encode())
        raise UnknownName(INVALID, self._error())

    @property
    def time(self) -> float:
        """The current time [s]."""
        return self._call("time")

    @property
    def duration(self) -> float:
        """The time at which the scene ends [s]."""
        return self._call("duration")

    @property
    def warning(self) -> str:
        """A warning that the coupling is unstable, or ""."""
        return self._call("warning").decode()

    def step(self) -> bool:
        """Takes one macro step; returns False at the end of the scene, without a step."""
        return self._check(self._call("step")) == OK

    @property
    def values(self) -> Any:
        """Current values of all channels in the order of `names`: a read-only view, which later reads update."""
        address = self._call("values")
        if not address:
            raise Error(FAILED, "there are no values: no channels, or a step has failed")
        doubles = (ctypes.c_double * len(self.names)).from_address(address)
        doubles.handle = self._handle
        return _view(memoryview(doubles).cast("B").cast("d").toreadonly())

    def __getitem__(self, name: str) -> float:
        """Current value of a channel, session["RotSpeed"], or of an input as it was last set (SI)."""
        if name in self._input and name not in self._index:
            return self._call("input_value", self._input[name])
        return float(self.values[self._find(self._index, "find", name)])

    @property
    def errors(self) -> Dict[str, float]:
        """Estimated largest error so far of each channel, in its unit; nan: not known, as without the setting
        "simulation.error_estimate=companion"."""
        return {name: self._call("estimate", i) for name, i in self._index.items()}

    @property
    def poses(self) -> Dict[str, Pose]:
        """The present poses of all bodies by name: run.poses["blade1"].position[-1] is the tip [m]."""
        poses = {}
        for body in range(self._call("bodies")):
            n = self._call("stations", body)
            position, rotation = (array.array("d", bytes(8 * size * n)) for size in (3, 9))
            self._check(self._call("poses", body, position.buffer_info()[0], rotation.buffer_info()[0]))
            name = self._call("body_name", body).decode()
            poses[name] = Pose(_shaped(position, n, 3), _shaped(rotation, n, 3, 3))
        return poses

    @property
    def inputs(self) -> Dict[str, str]:
        """The inputs that the scene declares: a dictionary of names and units (SI)."""
        return {name: self._call("input_unit", i).decode() for name, i in self._input.items()}

    def __setitem__(self, name: str, value: Union[float, str]) -> None:
        """Sets an input from the next step on: a number in SI, or a text with a unit, "5 kN m"."""
        i = self._find(self._input, "input", name)
        if isinstance(value, str):
            self._check(self._call("set_text", i, value.encode()))
        else:
            self._check(self._call("set", i, float(value)))

    def advance(self, until: Optional[float] = None,
                channels: Union[None, str, Sequence[str]] = None) -> Table:
        """Steps to a time [s], or to the end. Returns a Table of "Time" and the channels (None: all, or names),
        with one row for the start and one for each step."""
        until = self.duration if until is None else float(until)
        if until != until:
            raise ValueError("expected a time to advance to, got nan")
        names = self.names if channels is None else [channels] if isinstance(channels, str) else channels
        index = [self._find(self._index, "find", name) for name in names]
        columns = {name: array.array("d") for name in ["Time", *names]}
        while True:
            now, values = self.time, self.values
            columns["Time"].append(now)
            for name, i in zip(names, index):
                columns[name].append(values[i])
            if now >= until - 1e-9 or not self.step():
                units = ["s", *(self.units[i] for i in index)]
                return Table(list(columns), units, [_view(column) for column in columns.values()])

    def save(self) -> ctypes.Array:
        """A copy of all that the run goes on from. See bough.h for what restores where."""
        copy = (ctypes.c_double * (self._call("size") // 8))()
        self._check(self._call("save", ctypes.addressof(copy)))
        return copy

    def restore(self, copy: ctypes.Array) -> None:
        """Takes the session to where the copy was made, be it of this or of a like session."""
        if not isinstance(copy, ctypes.Array) or ctypes.sizeof(copy) != self._call("size"):
            raise Error(INVALID, "the copy is of a scene with other parts, coupling or steps")
        self._check(self._call("restore", ctypes.addressof(copy)))
