# SPDX-License-Identifier: GPL-3.0-or-later
"""Schemes: their properties, and their certificates."""
from __future__ import annotations

import json
from typing import Any, Union

from ._library import characters, library, owned, text_of, words_of
from ._words import words


class Scheme:
    """The properties of a scheme: `name`, `title`, `order` (0: variable order), `claims` (words), `formula`, `reference`,
    `family`, `problems` (for which it is made). It can be used wherever a scheme's name is expected."""

    def __init__(self, word: str):
        handle = owned(library.geomint_scheme(characters(word)))
        about = json.loads(text_of(library.geomint_text(handle)))
        self.word = word
        self.name: str = about["scheme"]
        self.title: str = about["title"]
        self.order: int = about["order"]
        self.claims = frozenset(about["claims"])
        self.formula: str = about["formula"]
        self.reference: str = about["reference"]
        self.family: str = about["family"]
        self.problems: str = about["for"]

    def certify(self, on=None, **parameters: Any) -> "Certificate":
        """As geomint.certify."""
        return certify(self, on, **parameters)

    def __repr__(self) -> str:
        return f"<{self.title}, order {self.order}, for {self.problems}: {', '.join(sorted(self.claims)) or 'no claims'}>"


def scheme(word: str) -> Scheme:
    """A scheme by its name, the path of a .scheme file, or a word: "composition(verlet; 1/2, 1/2)"."""
    return Scheme(word)


class Certificate:
    """The measured claims of a scheme, and the theory of its coefficients.

    `holds`: no claim is refuted. `order` is the claimed order, `measured_order` a slope of errors (None: no error is
    clear of round-off). `claims[word]` has claimed, measured, defect, tolerance, problem. `theory` has order,
    failing_condition, symplectic, symmetric, error_constant, stability; None if unknown.
    """

    def __init__(self, about: dict):
        self.about = about
        self.scheme: str = about["scheme"]
        self.holds: bool = about["holds"]
        self.order: int = about["order"]
        self.measured_order: float | None = about["measured_order"]
        self.claims: dict = about["properties"]
        self.theory: dict | None = about["theory"]

    def __bool__(self) -> bool:
        return self.holds

    def __repr__(self) -> str:
        lines = [f"{self.scheme}: order {self.order}, measured "
                 + ("nowhere" if self.measured_order is None else f"{self.measured_order:.3f}")
                 + ("" if self.holds else "; BROKEN")]
        for word, claim in self.claims.items():
            defect = "" if claim["defect"] is None else f" (defect {claim['defect']:.1e})"
            lines.append(f"  {word}: {'claimed' if claim['claimed'] else 'not claimed'}{defect}")
        return "\n".join(lines)


def certify(scheme: Union[str, Scheme], on=None, **parameters: Any) -> Certificate:
    """Measures the claims of a scheme, its order and every property, `on` a scene or a system with its parameters, or on
    the program's own problems. It takes up to a few seconds. A broken claim does not raise: see `holds`."""
    word = scheme if isinstance(scheme, str) else scheme.word
    array, kept = words_of(words(on, (), parameters) if on is not None else [])
    handle = owned(library.geomint_certify(characters(word), len(kept), array))
    return Certificate(json.loads(text_of(library.geomint_text(handle))))
