# SPDX-License-Identifier: GPL-3.0-or-later
"""Explorations: lanes that advance together and can be changed during the run, with a live widget in a notebook."""
from __future__ import annotations

import json
import operator
import threading
from typing import Any

import numpy as np

from ._library import OK, ClosedError, UsageError, characters, check, ffi, library, owned, text_of, words_of
from ._pictures import Picture, Pictured
from ._words import value_text, words


class Exploration(Pictured):
    """Lanes of a scene that advance together, as in the explorer. In a notebook it is a live widget.

    Every verb returns the exploration; what does not fit is a UsageError and changes nothing. `view` is a dictionary of
    what the explorer's screen shows: lanes with the values of their observables, parameters, observables; `schemes` are
    the schemes that fit. Lanes are numbered from 0, and a failed lane stays at its last state.
    """

    def __init__(self, typed):
        array, kept = words_of(typed)
        self.words = tuple(typed)
        self._handle = owned(library.geomint_explore(len(kept), array))
        self._turn = threading.RLock()

    def _is_open(self):
        return self._handle is not None

    def _call(self, function, *arguments):
        with self._turn:
            if self._handle is None:
                raise ClosedError("this exploration is closed")
            return function(self._handle, *arguments)

    def _do(self, function, *arguments) -> "Exploration":
        with self._turn:
            check(self._handle, self._call(function, *arguments))
        return self

    # ---- time

    def advance(self, t: float) -> "Exploration":
        """Advances all lanes by the steps that end at or before the time t."""
        return self._do(library.geomint_advance, float(t))

    def forward(self) -> "Exploration":
        """The next step."""
        return self._do(library.geomint_forward)

    def back(self) -> "Exploration":
        """Takes the last step back."""
        return self._do(library.geomint_back)

    def reverse(self) -> "Exploration":
        """Lets time run the other way from here."""
        return self._do(library.geomint_reverse)

    def visit(self, passed: float) -> "Exploration":
        """Turns back to the last stored state at or before this time since the start (`view["passed"]`)."""
        return self._do(library.geomint_visit, float(passed))

    def restart(self) -> "Exploration":
        """Restarts all lanes with their current schemes and parameters."""
        return self._do(library.geomint_restart)

    def undo(self) -> "Exploration":
        """Undoes the last change of a parameter or of a scheme."""
        return self._do(library.geomint_undo)

    # ---- lanes

    def switch(self, scheme, lane: int = 0) -> "Exploration":
        """Continues a lane with another scheme."""
        return self._with_scheme(library.geomint_switch, lane, scheme)

    def fork(self, scheme, lane: int = 0) -> "Exploration":
        """Adds a copy of a lane, which continues with another scheme."""
        return self._with_scheme(library.geomint_fork, lane, scheme)

    def add(self, scheme, lane: int = 0) -> "Exploration":
        """Adds a lane at its start, with the parameters of `lane`."""
        return self._with_scheme(library.geomint_add, lane, scheme)

    def _with_scheme(self, function, lane, scheme):
        return self._do(function, _number(lane), characters(value_text("scheme", scheme)))

    def remove(self, lane: int) -> "Exploration":
        """Removes a lane."""
        return self._do(library.geomint_remove, _number(lane))

    def set(self, key: str, value: Any = None, lane: int = 0) -> "Exploration":
        """Sets a parameter, in `lane` if the lanes differ in it, else in all; None: its default."""
        text = ffi.NULL if value is None else characters(value_text(key, value))
        return self._do(library.geomint_set, _number(lane), characters(key), text)

    def slide(self, key: str, position: float, lane: int = 0) -> "Exploration":
        """Sets a parameter to a position from 0 to 1 in its range."""
        return self._do(library.geomint_slide, _number(lane), characters(key), float(position))

    def press(self, key: str) -> "Exploration":
        """Presses a key of the explorer that has one meaning: ".", ",", "B", "r", "PgUp"."""
        return self._do(library.geomint_press, characters(key))

    # ---- now

    def __len__(self) -> int:
        return self._call(library.geomint_lanes)

    @property
    def t(self) -> float:
        """The time of the lanes."""
        return self.view["t"]

    @property
    def view(self) -> dict:
        """What the explorer's screen shows."""
        return self._text(library.geomint_view)

    @property
    def schemes(self) -> list:
        """The schemes that fit: name, title, order, claims, formula, reference."""
        return self._text(library.geomint_schemes)

    def _text(self, function):
        with self._turn:
            return json.loads(text_of(self._call(function)))

    def state(self, lane: int = 0) -> np.ndarray:
        """A copy of a lane's state: (components,), or (components, members)."""
        with self._turn:
            sizes = ffi.new("size_t[2]")
            pointer = self._call(library.geomint_state, _number(lane), sizes, sizes + 1)
            check(self._handle)
            numbers = np.frombuffer(ffi.buffer(pointer, 8 * sizes[0] * sizes[1])).copy()
        return numbers if sizes[1] == 1 else numbers.reshape(sizes[0], sizes[1])

    def observe(self, key: str, lane: int = 0) -> float:
        """The current value of an observable."""
        value = ffi.new("double *")
        self._do(library.geomint_observable, _number(lane), characters(key), value)
        return value[0]

    # ---- exercises

    def grade(self, tour: str, step: int) -> tuple[bool, str]:
        """Whether the lanes pass an exercise of a tour, by its name or path, steps counted from 1; and the verdict."""
        with self._turn:
            status = check(self._handle, self._call(library.geomint_grade, characters(tour), _step(step)))
            return status == OK, text_of(library.geomint_message(self._handle))

    def answer(self, tour: str, step: int) -> str:
        """The text of the answer, which `geomint grade FILE.answer` repeats."""
        with self._turn:
            text = text_of(self._call(library.geomint_answer, characters(tour), _step(step)))
            check(self._handle)
        return text

    def picture(self, width: int = 1280, height: int = 720, scale: float = 1.0, title: str | None = None) -> Picture:
        """The picture of all lanes as they are now."""
        return Picture(self._call(lambda handle: handle), self._turn, width, height, scale, title)

    def close(self) -> None:
        """No verb and no picture after it."""
        with self._turn:
            self._handle = None

    def __repr__(self) -> str:
        if self._handle is None:
            return "<geomint exploration, closed>"
        view = self.view
        return f"<exploring {view['scene']} at t = {view['t']:.6g}: " + \
            ", ".join(lane["scheme"] + (" failed" if lane["message"] else "") for lane in view["lanes"]) + ">"

    def widget(self):
        """The live widget, which needs ipywidgets."""
        try:
            import ipywidgets
        except ImportError as error:
            raise ImportError("the live widget needs ipywidgets (in Debian: python3-ipywidgets); "
                              "without it the verbs are called: explore(...).advance(10)") from error
        from ._widget import Panel
        return Panel(self, ipywidgets)

    def _ipython_display_(self):
        from IPython.display import display
        try:
            display(self.widget().box)
        except ImportError as error:
            print(error)


def _counted(value, what, first):
    try:
        number = operator.index(value)
    except TypeError as error:
        raise UsageError(f"{value!r} is not the number of a {what}") from error
    if not first <= number < 2**63:
        raise UsageError(f"there is no {what} {number}; {what}s are counted from {first} on")
    return number


def _number(lane):
    return _counted(lane, "lane", 0)


def _step(step):
    return _counted(step, "step", 1)


def explore(scene, *typed: str, **parameters: Any) -> Exploration:
    """Opens a scene or a system as the explorer does. Arguments as those of `run`; without schemes the scene's first three.

        lab = geomint.explore("kepler", scheme=["verlet", "rk4"])
        lab.advance(20).fork("midpoint").advance(40)
        lab.view["lanes"][2]["values"]["energy_error"]
    """
    return Exploration(words(scene, typed, parameters))
