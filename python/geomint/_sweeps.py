# SPDX-License-Identifier: GPL-3.0-or-later
"""A run for every combination of values, on all cores."""
from __future__ import annotations

import itertools
import os
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Iterable, Union

import numpy as np

from ._library import UsageError
from ._runs import MOST_STEPS, Run, System
from ._words import words


class Sweep:
    """The results of a sweep. `axes` has the given lists, in their order. `sweep["key"]` is an array with an axis for
    each list: an observable or another number of the state at the end (NaN if it does not exist), or `t`, `steps`,
    `evaluations`, `status` (words)."""

    def __init__(self, axes: dict, columns: dict):
        self.axes = axes
        self._columns = columns

    @property
    def shape(self) -> tuple:
        """The lengths of the axes."""
        return tuple(len(values) for values in self.axes.values())

    def keys(self):
        """The names of the arrays."""
        return self._columns.keys()

    def __getitem__(self, key: str) -> np.ndarray:
        if key not in self._columns:
            raise KeyError(f"{key}; there are {', '.join(self._columns)}")
        return self._columns[key]

    def __repr__(self) -> str:
        axes = " x ".join(f"{key} ({len(values)})" for key, values in self.axes.items()) or "one run"
        return f"<sweep of {axes}: {', '.join(self._columns)}>"


def _end_of(made: Run):
    if len(made) != 1:
        raise UsageError("a sweep takes lists of Python, not \"a,b\"")
    lane = made[0]
    lane._record(MOST_STEPS, False)
    about = lane.about
    row = {key: about[key] for key in ("status", "t", "steps", "evaluations")}
    row.update({key: lane[key][-1] for key in lane.keys()
                if key not in row and key not in lane._fixed and lane[key].ndim == 1})
    return row


def sweep(scene: Union[str, System], *typed: str, observe: Union[bool, str, Iterable[str]] = True,
          jobs: int | None = None, **parameters: Any) -> Sweep:
    """Runs a scene for every combination of the lists among its parameters, `jobs` at once (by default one per core).

        errors = geomint.sweep("kepler", scheme=["rk4", "verlet"], dt=numpy.logspace(-3, -1, 20), until=100)
        errors["energy_error"].shape == (2, 20)

    The first error ends the sweep, and so does Ctrl-C. A run that blows up is reported by its status. A number that only
    some runs have, such as a component of a system with more bodies, is NaN in the others.
    """
    axes = {key: list(value) for key, value in parameters.items()
            if isinstance(value, (list, tuple, range)) or (isinstance(value, np.ndarray) and value.ndim > 0)}
    for key, values in axes.items():
        if not values:
            raise UsageError(f"{key} is an empty list")
    if jobs is not None and int(jobs) < 1:
        raise UsageError("jobs= is the number of runs made at once: 1 or more")
    running: set = set()
    ended = threading.Event()

    def one(values):
        with Run(words(scene, typed, {**parameters, **dict(zip(axes, values))}), observe) as made:
            running.add(made)
            if ended.is_set():
                made.close()
            try:
                return _end_of(made)
            finally:
                running.discard(made)

    with ThreadPoolExecutor(jobs or os.cpu_count()) as pool:
        try:
            rows = list(pool.map(one, itertools.product(*axes.values())))
        except BaseException:
            ended.set()
            for made in tuple(running):
                made.close()
            raise
    shape = tuple(len(values) for values in axes.values())
    keys = dict.fromkeys(key for row in rows for key in row)
    return Sweep(axes, {key: np.array([row.get(key, np.nan) for row in rows]).reshape(shape) for key in keys})
