# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometric integration: runs, measurements and pictures of geometric and ordinary schemes.

    import geomint
    orbit = geomint.run("kepler", scheme="verlet", eccentricity=0.5, until=100)
    orbit.t, orbit.q, orbit.energy_error       # NumPy arrays, a row a step
    well = geomint.system(H="p^2/2 + q^4/4 - q^2/2", q=1.5, p=0)
    geomint.run(well, scheme=["rk4", "verlet"], dt=0.1, until=1000)[1].energy_error.max()
    geomint.certify("verlet", on=well)
    geomint.explore("kepler", scheme=["verlet", "rk4"])    # a live widget in a notebook

Scenes, schemes, keys and systems are those of the program; its documentation describes them.
"""
from ._library import ClosedError, FileError, GeomintError, UsageError, library as _c, text_of as _text_of
from ._explore import Exploration, explore
from ._pictures import Picture
from ._runs import MOST_STEPS as _MOST_STEPS, Lane, Run, System, open, run, system
from ._schemes import Certificate, Scheme, certify, scheme
from ._sweeps import Sweep, sweep
from ._version import __version__
from ._words import words as _words


def render(scene, *typed, width=1280, height=720, scale=1.0, title=None, **parameters) -> Picture:
    """The picture of a scene or a system at its end (`until=`), `width` x `height` pixels, letters and lines `scale` times
    as large: a notebook shows it, `save` writes .png, .svg or .pdf. Further arguments as those of `run`."""
    made = Run(_words(scene, typed, parameters), False)
    for lane in made:
        lane._record(_MOST_STEPS, False)
    return made.picture(width, height, scale, title)


def _names(function):
    names, index = [], 0
    while (name := _text_of(function(index))) is not None:
        if name not in names:
            names.append(name)
        index += 1
    return names


def scenes() -> list:
    """The names of all scenes."""
    return _names(_c.geomint_scene_name)


def schemes() -> list:
    """The names of all schemes."""
    return _names(_c.geomint_scheme_name)


__all__ = ["Certificate", "ClosedError", "Exploration", "FileError", "GeomintError", "Lane", "Picture", "Run", "Scheme",
           "Sweep", "System", "UsageError", "certify", "explore", "open", "render", "run", "scenes", "scheme", "schemes",
           "sweep", "system"]
