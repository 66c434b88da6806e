"""bough from Python: opens a scene, steps it, sets inputs, reads channels, stores copies of its state.

    import bough
    with bough.Session("runup.yaml", "simulation.duration=5 s") as run:
        rows = run.advance(2.0, ["RotSpeed"])
    print(rows["Time"][-1], rows["RotSpeed"][-1])

The module needs Python 3.8 and nothing else. If numpy is installed, values and rows are numpy arrays on
the same memory. BOUGH_LIBRARY may name the library; otherwise the module searches for it where
`cmake --install` puts it, one or two folders above this file, and then where the system searches.
"""
import array
import ctypes
import glob
import os

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
    """The scene has no channel or input of that name; the message tells the nearest."""


def _load():
    here = os.path.dirname(os.path.abspath(__file__))
    above = [os.path.join(here, *[".."] * up, "libbough.so.0") for up in (1, 2)]
    above += glob.glob(os.path.join(here, "..", "..", "*", "libbough.so.0"))
    found = [path for path in above if os.path.exists(path)]
    path = os.environ.get("BOUGH_LIBRARY") or (found[0] if found else "libbough.so.0")
    library = ctypes.CDLL(path)
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


class Session:
    """A scene that runs: Session("runup.yaml", "aero.wind.speed=12 m/s", ...)."""

    def __init__(self, scene, *settings):
        self._handle = _Handle(scene, settings)
        self._check(self._call("code"))
        text = {"names": "name", "units": "unit"}
        for attribute, call in text.items():
            words = [self._call(call, i).decode() for i in range(self._call("count"))]
            setattr(self, attribute, words)
        self._index = {name: i for i, name in enumerate(self.names)}
        inputs = range(self._call("inputs"))
        self._input = {self._call("input_name", i).decode(): i for i in inputs}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
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
        """The index of a channel or an input among those known; the library's call tells what is wrong."""
        if name in known:
            return known[name]
        if not isinstance(name, str):
            raise TypeError("expected the name of a channel or an input, got %r" % (name,))
        self._call(call, name.encode())
        raise UnknownName(INVALID, self._error())

    @property
    def time(self):
        """The current time [s]."""
        return self._call("time")

    @property
    def duration(self):
        """The time at which the scene ends [s]."""
        return self._call("duration")

    @property
    def warning(self):
        """A warning that the coupling is unstable, or ""."""
        return self._call("warning").decode()

    def step(self):
        """Takes one macro step; returns False at the end of the scene, without a step."""
        return self._check(self._call("step")) == OK

    @property
    def values(self):
        """Current values of all channels in the order of `names`: a read-only view, which later reads update."""
        address = self._call("values")
        if not address:
            raise Error(FAILED, "there are no values: no channels, or a step has failed")
        doubles = (ctypes.c_double * len(self.names)).from_address(address)
        doubles.handle = self._handle
        return _view(memoryview(doubles).cast("B").cast("d").toreadonly())

    def __getitem__(self, name):
        """Current value of a channel, session["RotSpeed"], or of an input as it was last set (SI)."""
        if name in self._input and name not in self._index:
            return self._call("input_value", self._input[name])
        return float(self.values[self._find(self._index, "find", name)])

    @property
    def inputs(self):
        """The inputs that the scene declares: a dictionary of names and units (SI)."""
        return {name: self._call("input_unit", i).decode() for name, i in self._input.items()}

    def __setitem__(self, name, value):
        """Sets an input from the next step on: a number in SI, or a text with a unit, "5 kN m"."""
        i = self._find(self._input, "input", name)
        if isinstance(value, str):
            self._check(self._call("set_text", i, value.encode()))
        else:
            self._check(self._call("set", i, float(value)))

    def advance(self, until=None, channels=None):
        """Steps to a time [s], or to the end. Returns a dictionary of columns, "Time" and the channels (None:
        all, or names), with one row for the start and one for each step."""
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
                return {name: _view(column) for name, column in columns.items()}

    def save(self):
        """A copy of all that the run goes on from. See bough.h for what restores where."""
        copy = (ctypes.c_double * (self._call("size") // 8))()
        self._check(self._call("save", ctypes.addressof(copy)))
        return copy

    def restore(self, copy):
        """Takes the session to where the copy was made, be it of this or of a like session."""
        if not isinstance(copy, ctypes.Array) or ctypes.sizeof(copy) != self._call("size"):
            raise Error(INVALID, "the copy is of a scene with other parts, coupling or steps")
        self._check(self._call("restore", ctypes.addressof(copy)))
