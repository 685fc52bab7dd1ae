# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of runs, as a notebook shows them, as arrays, as files."""
from __future__ import annotations

import os
import tempfile

import numpy as np

from ._library import UsageError, characters, check, ffi, library


LEAST_SIDE, MOST_SIDE = 64, 16384  # as the library has them


class Pictured:
    """What has a picture shows it in a notebook; what is closed has none."""

    def _repr_png_(self) -> bytes | None:
        return self.picture().png if self._is_open() else None

    def _repr_svg_(self) -> str | None:
        return self.picture()._repr_svg_() if self._is_open() else None


class Picture:
    """A picture of a run as it was when this was asked of it first.

    `png`, `svg`, `pdf` are bytes, as `geomint render` writes them; `rgba` an array (height, width, 4) of bytes.
    """

    def __init__(self, handle, turn, width: int, height: int, scale: float, title: str | None):
        for side in width, height:
            if not LEAST_SIDE <= side <= MOST_SIDE:
                raise UsageError(f"a picture of {width} x {height} pixels: each side is from {LEAST_SIDE} to {MOST_SIDE}")
        self._handle = handle
        self._turn = turn
        self._look = (int(width), int(height), float(scale))
        self._title = ffi.NULL if title is None else characters(title)
        self._made: dict = {}

    def save(self, path: str | os.PathLike) -> None:
        """Writes a file whose name ends with .png, .svg or .pdf; `geomint again` redraws it."""
        with self._turn:
            check(self._handle, library.geomint_save(self._handle, characters(os.fsdecode(path)), *self._look, self._title))

    def _bytes(self, ending):
        if ending not in self._made:
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "picture." + ending)
                self.save(path)
                with open(path, "rb") as file:
                    self._made[ending] = file.read()
        return self._made[ending]

    @property
    def png(self) -> bytes:
        """As PNG."""
        return self._bytes("png")

    @property
    def svg(self) -> bytes:
        """As SVG."""
        return self._bytes("svg")

    @property
    def pdf(self) -> bytes:
        """As PDF, a page."""
        return self._bytes("pdf")

    @property
    def rgba(self) -> np.ndarray:
        """The pixels: (height, width, 4), bytes, the top row first."""
        if "rgba" not in self._made:
            width, height, scale = self._look
            pixels = np.empty((height, width, 4), np.uint8)
            with self._turn:
                check(self._handle, library.geomint_draw(self._handle, width, height, scale,
                                                         ffi.cast("unsigned char *", pixels.ctypes.data)))
            self._made["rgba"] = pixels
        return self._made["rgba"]

    def _repr_png_(self) -> bytes:
        return self.png

    def _repr_svg_(self) -> str:
        text = self.svg.decode()
        return text[text.index("<svg") :]  # as a part of HTML, which has no XML declaration
