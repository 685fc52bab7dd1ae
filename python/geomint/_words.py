# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments of Python as the words of a command line."""
import numbers

import numpy

from ._library import UsageError


def value_text(key, value):
    """A value, or a list of values with a comma between, each a lane."""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, numpy.bool_)):
        return "yes" if value else "no"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))
    if hasattr(value, "word"):  # a scheme
        return value.word
    if isinstance(value, numpy.ndarray) and value.ndim != 1:
        if value.ndim == 0:
            return value_text(key, value.item())
        raise UsageError(f"{key} has the shape {value.shape}: a list of values has one axis")
    if isinstance(value, (list, tuple, range, numpy.ndarray)):
        if len(value) == 0:
            raise UsageError(f"{key} is an empty list")
        return ",".join(value_text(key, one) for one in value)
    raise UsageError(f"{key} is a number, a word or a list of these, and not {type(value).__name__}")


def words(scene, typed, parameters):
    """The scene, or the words of a system; then what was typed as "key=value"; then key=value."""
    if isinstance(scene, str):
        first = [scene]
    elif hasattr(scene, "words"):
        first = list(scene.words)
    else:
        raise UsageError(f"the first argument is a scene's name or a system, and not {type(scene).__name__}")
    for word in typed:
        if not isinstance(word, str) or "=" not in word:
            raise UsageError(f"{word!r} is not \"key=value\"")
    given = list(typed) + [f"{key}={value_text(key, value)}" for key, value in parameters.items()]
    again = {word.partition("=")[0] for word in given}
    # the first values of a system are its defaults; a formula may occur several times
    return [word for word in first if word.partition("=")[0] not in again or "=" not in word] + given


def keys_text(observe):
    """Keys of observables; True: the default ones of the scene."""
    if observe is True:
        return None
    if not observe:
        return ""
    return observe if isinstance(observe, str) else ",".join(observe)
