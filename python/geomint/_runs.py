# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs: their lanes, which can be stepped, and their rows as arrays."""
from __future__ import annotations

import functools
import json
import threading
import time
from typing import Any, Iterable, Iterator, Sequence, Union

import numpy as np

from ._library import ClosedError, UsageError, characters, check, ffi, library, owned, text_of, words_of
from ._pictures import Picture, Pictured
from ._words import keys_text, value_text, words

MOST_STEPS = 10**15  # of a run
MOST_BYTES = 1 << 30  # of a lane's rows, unless `every` is given


class System:
    """A user-defined system, by its words; it is used like a scene's name. Made by `geomint.system`."""

    def __init__(self, words: Sequence[str]):
        self.words = tuple(words)

    def __repr__(self) -> str:
        return "geomint.system: " + " ".join(self.words)


def system(name: str | None = None, *, rate: Union[str, Iterable[str], dict, None] = None, **parameters: Any) -> System:
    """A user-defined system: `system("lorenz")` by name, `system("./mine.system")` from a file, or from a formula,

        system(H="p^2/2 + q^4/4", q=1, p=0)
        system(L="v^2/2 - k*q^2/2", k=2, q=1, v=0)
        system(rate={"x": "y", "y": "-x"}, x=1, y=0)

    Every other name in a formula is a parameter or a value at the start; they may also be given later, to `run`. The
    formulas are read when a run is opened.
    """
    first = [name if name is not None else "system"]
    if isinstance(rate, dict):
        rate = [f"{component} = {formula}" for component, formula in rate.items()]
    for formula in [rate] if isinstance(rate, str) else rate or []:
        first.append(f"rate={formula}")
    if name is None and rate is None and not {"H", "L"} & set(parameters):
        raise UsageError("a system is a name, a path, or a formula: H=, L= or rate=")
    return System(first + [f"{key}={value_text(key, value)}" for key, value in parameters.items()])


class _Memory:
    """Numbers of C as a NumPy array, read-only; they keep their run alive."""

    def __init__(self, handle, pointer, shape):
        self.handle = handle
        self.__array_interface__ = {
            "version": 3, "typestr": "<f8", "shape": shape, "data": (int(ffi.cast("uintptr_t", pointer)), True)}


class _Opened:
    """The handle of a run, shared by the run and its lanes; it ends with the last of them, or by `close`."""

    def __init__(self, words: Sequence[str]):
        array, kept = words_of(words)
        self._handle = owned(library.geomint_open(len(kept), array))
        self.scene = words[0]
        self.turn = threading.RLock()  # of threads: only one at a time may call the library

    def handle(self):
        handle = self._handle
        if handle is None:
            raise ClosedError("this run is closed")
        return handle

    def close(self):
        self._handle = None

    def is_closed(self):
        return self._handle is None


def _alone(method):
    """A method of a lane during which no other thread uses its run."""
    @functools.wraps(method)
    def alone(self, *arguments):
        with self._opened.turn:
            return method(self, *arguments)

    return alone


def _current(key, words) -> Any:
    """A current property of a lane."""
    return property(lambda lane: lane.about[key], doc=words)


class Lane:
    """One run of a scene with one scheme.

    Arrays by name, as attributes or `lane["name"]`: `t`, the times (rows,) in the scene's unit; the components of the
    state (rows, ...), `q`, `p`, `x`, `u`: further axes are bodies or nodes, then the members of an ensemble; `q1`, `q2` are
    together also `q` (rows, 2); observables (rows,). They are views of one block: nothing is copied. A grid has no axis
    of time. `state` is the current state, (components,), or (components, members), which changes with every step.
    """

    def __init__(self, opened: _Opened, number: int):
        self._opened = opened
        self._number = number
        self._arrays: dict[str, np.ndarray] = {}
        self._fixed: set[str] = set()
        self._state: np.ndarray | None = None
        self._pace = 256

    # ---- driving

    def step(self, steps: int = 1) -> "Lane":
        """Makes steps; a failed lane stays at its last state (`status`)."""
        steps = int(steps)
        if steps < 0:
            raise UsageError("steps are made forwards: at least 0")
        end = self.steps + steps
        while steps > 0:
            if self._timed(library.geomint_step, min(steps, self._pace)):
                break
            left = end - self.steps
            if left == steps:  # it has stopped, and stopped well
                break
            steps = left
        return self

    def until(self, t: float) -> "Lane":
        """Advances to the step nearest to the time t; an adaptive scheme stops at the first step at or after t."""
        now = self.time
        piece = (float(t) - now) / 2**24  # the time of a step is not known yet
        while now + piece < t:  # as `step` does; the end does not depend on the pieces
            begin = time.perf_counter()
            if self._go(now + piece):
                return self
            now = max(now + piece, self.time)
            piece *= 16 if time.perf_counter() - begin < 0.02 else 1
        self._go(float(t))
        return self

    @_alone
    def _go(self, t):
        handle = self._opened.handle()
        return check(handle, library.geomint_until(handle, self._number, t))

    @_alone
    def _timed(self, function, *arguments):
        """A call that makes about as many steps as the pace allows: so few that the keyboard interrupts between them, or
        another thread that closes the run."""
        handle = self._opened.handle()
        begin, before = time.perf_counter(), library.geomint_steps(handle, self._number)
        status = check(handle, function(handle, self._number, *arguments))
        took = time.perf_counter() - begin
        if took > 0.2:
            self._pace = max(1, self._pace // 2)
        elif took < 0.05 and library.geomint_steps(handle, self._number) - before > self._pace // 2:
            self._pace *= 2
        return status

    # ---- now

    @property
    def time(self) -> float:
        """The current time, in the scene's unit."""
        return library.geomint_time(self._opened.handle(), self._number)

    @property
    def steps(self) -> int:
        """The steps made so far."""
        return library.geomint_steps(self._opened.handle(), self._number)

    @property
    @_alone
    def state(self) -> np.ndarray:
        """The current state (components,), or (components, members); not a copy, read-only, changed by every step."""
        handle = self._opened.handle()
        if self._state is None:
            sizes = ffi.new("size_t[2]")
            pointer = library.geomint_state(handle, self._number, sizes, sizes + 1)
            check(handle)
            shape = (sizes[0],) if sizes[1] == 1 else (sizes[0], sizes[1])
            self._state = np.asarray(_Memory(handle, pointer, shape))
        return self._state

    @_alone
    def observe(self, key: str) -> float:
        """The current value of an observable, also of one that is not reported by default, such as "lyapunov"."""
        handle = self._opened.handle()
        value = ffi.new("double *")
        check(handle, library.geomint_observable(handle, self._number, characters(key), value))
        return value[0]

    @property
    @_alone
    def about(self) -> dict:
        """Scene, scheme, parameters, units, status, message, warning, evaluations per member, as they are now."""
        handle = self._opened.handle()
        text = text_of(library.geomint_text(handle))
        check(handle)
        return json.loads(text)[self._number]

    scheme: str = _current("scheme", "The scheme's name.")
    parameters: dict = _current("parameters", "The parameters, each with its value.")
    status: str = _current("status", '"ok", or how the run ended: "blow-up", "no-convergence" ...')
    message: str = _current("message", 'A sentence on a status that is not "ok".')
    warning: str = _current("warning", 'A sentence on a run that is "ok" but has lost a conserved quantity.')

    # ---- rows

    def _columns(self, handle):
        """Name and shape of each column, True if it is a part of a row, and its number."""
        rows = library.geomint_columns(handle, self._number)
        shape = ffi.new("size_t[3]")
        column = 0
        while True:
            name = text_of(library.geomint_column_name(handle, self._number, column))
            if name is None:
                return
            axes = library.geomint_column_shape(handle, self._number, column, shape)
            yield name, tuple(shape[i] for i in range(axes)), column < rows, column
            column += 1

    def _record(self, every, limited):
        """Advances to the end of the run, and stores a row after every `every` steps."""
        handle = self._opened.handle()
        every = min(every, MOST_STEPS)
        width = library.geomint_row_size(handle, self._number)
        left = library.geomint_steps_left(handle, self._number)
        rows = 1 + (-(-left // every) if left >= 0 else 1023)
        if limited and 8 * rows * (width + 1) > MOST_BYTES:
            least = -(-left * 8 * (width + 1) // MOST_BYTES)
            raise UsageError(f"{rows} rows of {width} numbers are {8e-9 * rows * width:.3g} GB; "
                             f"every={least} stores fewer rows, every={left} the end alone")
        t, values = np.empty(rows), np.empty((rows, width))
        count = 1
        made = ffi.new("size_t *")

        def place(array, row):
            return ffi.cast("double *", array.ctypes.data + row * array.strides[0])

        self._timed(library.geomint_row, place(t, 0), place(values, 0))
        while True:
            left = library.geomint_steps_left(handle, self._number)
            if left == 0:
                break
            if count == len(t):  # the number of steps of an adaptive scheme is not known
                t, values = np.resize(t, 2 * count), np.resize(values, (2 * count, width))
            before = library.geomint_steps(handle, self._number)
            ahead = min(every - before % every, left) if left > 0 else 0
            if ahead > self._pace:  # up to the last piece before a row
                self.step(ahead - self._pace)
            room = min(max(1, self._pace // every), len(t) - count)
            status = self._timed(library.geomint_rows, every, room, place(t, count), place(values, count), made)
            count += made[0]
            if status or made[0] == 0:
                break
        if library.geomint_time(handle, self._number) != t[count - 1] and count < len(t):
            self._timed(library.geomint_row, place(t, count), place(values, count))
            count += 1
        self._name(handle, t[:count], values[:count])

    @_alone
    def _name(self, handle, t, values):
        self._arrays = {"t": t}
        at = 0
        for name, shape, moves, column in self._columns(handle):
            size = int(np.prod(shape, dtype=int))
            if moves:
                array = values[:, at:at + size].reshape((len(t),) + shape) if shape else values[:, at]
                at += size
            else:
                self._fixed.add(name)
                array = np.empty(shape)
                check(handle, library.geomint_column(handle, self._number, column,
                                                     ffi.cast("double *", array.ctypes.data)))
                if name == "triangles":  # which number the points
                    array = array.astype(np.int64)
            self._arrays[name] = array
        self._join(values)

    def _join(self, values):
        """Adjacent numbered names, q1 q2, are also one array with an axis for their numbers: q."""
        columns = [(name, array) for name, array in self._arrays.items() if name not in self._fixed and name != "t"]
        at = 0
        for i, (name, first) in enumerate(columns):
            base = name[:-1]
            parts = 1
            while i + parts < len(columns) and columns[i + parts][0] == f"{base}{parts + 1}" \
                    and columns[i + parts][1].shape == first.shape:
                parts += 1
            size = int(np.prod(first.shape[1:], dtype=int))
            if name.endswith("1") and base[-1:].isalpha() and parts > 1 and base not in self._arrays:
                self._arrays[base] = values[:, at:at + parts * size].reshape(
                    (len(values), parts) + first.shape[1:])
            at += size

    def keys(self):
        """The names of the arrays."""
        return self._arrays.keys()

    def __getitem__(self, name: str) -> np.ndarray:
        if name in self._arrays:
            return self._arrays[name]
        raise KeyError(f"{name}; there are {', '.join(self._arrays) or 'no arrays'}")

    def __getattr__(self, name: str) -> np.ndarray:
        if name.startswith("_"):
            raise AttributeError(name)
        if name in self._arrays:
            return self._arrays[name]
        raise AttributeError(f"a lane of {self._opened.scene} has no {name}; its arrays are "
                             f"{', '.join(self.__dict__.get('_arrays', ())) or 'none'}")

    def __dir__(self):
        return list(super().__dir__()) + list(self._arrays)

    def __repr__(self) -> str:
        if self._opened.is_closed():
            return "<geomint lane, closed>"
        about = self.about
        kept = ", ".join(f"{name}{array.shape}" for name, array in self._arrays.items())
        return f"<{about['scene']} by {about['scheme']}: {about['status']} at t = {about['t']:.6g}, " \
               f"{about['steps']} steps{'; ' if kept else ''}{kept}>"


class Run(Pictured):
    """Lanes of a scene, `run[0]`, `run[1]` ..., one for each combination of the lists that were given; what a lane has,
    a run of one lane has itself: `run.q`. In a notebook it shows its picture. `with` closes it, or `close`."""

    def __init__(self, words: Sequence[str], observe: Union[bool, str, Iterable[str]] = True):
        self._opened = _Opened(words)
        self.words = tuple(words)
        self.scene = words[0]
        keys = keys_text(observe)
        handle = self._opened.handle()
        if keys is not None:
            check(handle, library.geomint_observe(handle, characters(keys)))
        self.lanes = tuple(Lane(self._opened, i) for i in range(library.geomint_lanes(handle)))

    def _is_open(self):
        return not self._opened.is_closed()

    def close(self) -> None:
        """No more steps and no more pictures; a call of another thread ends soon. Arrays stay, also `state`."""
        self._opened.close()

    def __enter__(self) -> "Run":
        return self

    def __exit__(self, *reason) -> None:
        self.close()

    def __len__(self) -> int:
        return len(self.lanes)

    def __getitem__(self, key):
        if isinstance(key, (int, slice)):
            return self.lanes[key]
        if len(self.lanes) != 1:
            raise KeyError(f"{key} of which lane? There are {len(self.lanes)}: run[0]")
        return self.lanes[0][key]

    def __iter__(self) -> Iterator[Lane]:
        return iter(self.lanes)

    def _only(self, name):
        if len(self.lanes) != 1:
            raise AttributeError(f"this run has {len(self.lanes)} lanes: run[0].{name} is the first one's {name}")
        return self.lanes[0]

    def __getattr__(self, name):
        if name.startswith("_") or name == "lanes":
            raise AttributeError(name)
        return getattr(self._only(name), name)

    def __dir__(self):
        return list(super().__dir__()) + (dir(self.lanes[0]) if len(self.lanes) == 1 else [])

    def picture(self, width: int = 1280, height: int = 720, scale: float = 1.0, title: str | None = None) -> Picture:
        """The scene's picture of all lanes as they are now; width and height in pixels."""
        return Picture(self._opened.handle(), self._opened.turn, width, height, scale, title)

    def __repr__(self) -> str:
        return "\n".join(map(repr, self.lanes))


def open(scene: Union[str, System], *typed: str, observe=True, **parameters: Any) -> Run:
    """Opens a run at its start, to be driven by `step` and `until`. Arguments as those of `run`."""
    return Run(words(scene, typed, parameters), observe)


def run(scene: Union[str, System], *typed: str, every: int | None = None,
        observe: Union[bool, str, Iterable[str]] = True, **parameters: Any) -> Run:
    """Runs a scene or a system to its end (`until=`, or `steps=`), and stores a row of numbers after every step.

        geomint.run("kepler", scheme="verlet", eccentricity=0.5, until=100).q

    scene       a scene's name, a system's, the path of a .system file, or what `geomint.system` made
    typed       further "key=value", as on the command line: names that Python cannot write, such as "q[1]=2"
    every       number of steps between rows (1); there is also a row at the start and one at the end
    observe     observables in a row: True, the default ones of the scene; False, none; or their keys
    parameters  as `geomint list SCENE` names them; a list of values makes several lanes

    An unknown key is a UsageError which proposes the nearest one. A run that blows up does not raise: see `status`, `message`.
    """
    if every is not None and int(every) < 1:
        raise UsageError("every= is a number of steps: 1 or more")
    made = Run(words(scene, typed, parameters), observe)
    for lane in made.lanes:
        lane._record(1 if every is None else int(every), every is None)
    return made
