#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The outputs in the documents are what the program prints.
Usage: console.py GEOMINT SOURCE [--write]   --write: replaces the outputs that differ

A block that begins with ```console holds commands (`$ `, continued after a backslash) and what they print. All blocks of
a document run in order, in one folder and one shell. A line `...` matches any lines, and `…` any text within a line; a
number matches to a relative 1e-6, or if both are below 1e-11. A command that fails is a fault, `COMMAND; echo $?` none."""
import difflib
import glob
import os
import re
import subprocess
import sys
import tempfile

MARK = "-- end of command, status "
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
RELATIVE, ROUND_OFF = 1e-6, 1e-11


def likeness(one, other):
    return difflib.SequenceMatcher(None, one or "", other or "").ratio()


def line_matches(expected, printed):
    pattern, numbers = "", []
    for piece in re.split(f"( *{NUMBER}|…)", expected):
        if re.fullmatch(" *" + NUMBER, piece):
            pattern += (" +" if piece[0] == " " else "") + f"({NUMBER})"
            numbers.append(float(piece))
        else:
            pattern += ".*" if piece == "…" else re.escape(piece)
    found = re.fullmatch(pattern, printed)
    return found is not None and all(abs(a - b) <= RELATIVE * abs(a) or max(abs(a), abs(b)) < ROUND_OFF
                                     for a, b in zip(numbers, map(float, found.groups())))


def difference(expected, printed):
    """Returns None if the lines match, else the first two that do not, of which one may be missing."""
    if not expected:
        return (None, printed[0]) if printed else None
    if expected[0] == "...":
        found = [difference(expected[1:], printed[skipped:]) for skipped in range(len(printed) + 1)]
        return None if None in found else max(found, key=lambda lines: likeness(*lines))
    if not printed or not line_matches(expected[0], printed[0]):
        return expected[0], printed[0] if printed else None
    return difference(expected[1:], printed[1:])


def line_written(old, new):
    """Returns the new line, with `…` in the words that have it in the old one, and for seconds and bytes."""
    if line_matches(old, new):
        return old
    before, after = (re.split(r"([\s,]+)", line) for line in (old, new))
    if len(before) == len(after):
        new = "".join(b if "…" in b else a for b, a in zip(before, after))
    elif before[-1] == "…":
        new = "".join(after[:len(before) - 1]) + "…"
    return re.sub(rf'(\bseconds"?:? *){NUMBER}|\b\d+(?= bytes\b)', lambda found: (found[1] or "") + "…", new)


def written(old, printed):
    """Returns the lines printed, without those that the document leaves out by `...`."""
    segments = [[]]
    for line in old:
        if line == "...":
            segments.append([])
        else:
            segments[-1].append(line)
    if len(segments) == 1:
        return [line_written(line, new) for line, new in zip(old + [""] * len(printed), printed)]
    lines, at = [], 0
    for n, segment in enumerate(segments):
        last = max(at, len(printed) - len(segment))
        if n == len(segments) - 1:
            at = last
        elif n > 0:  # the lines that are most like those of the document
            at = max(range(at, last + 1), key=lambda p: sum(map(likeness, segment, printed[p:])))
        lines += [line_written(*pair) for pair in zip(segment, printed[at:])] + ["..."]
        at += len(segment)
    return lines[:-1]


def commands(lines):
    """Returns (number of the block, command, first and last line of its output) for each command of a document."""
    found, block, inside, n = [], 0, None, 0
    while n < len(lines):
        fence = re.match("```(.*)", lines[n])
        if fence:
            inside = fence[1] if inside is None else None
            block += inside == "console"
        n += 1
        if inside == "console" and lines[n - 1].startswith("$ "):
            text = lines[n - 1][2:]
            while text.endswith("\\"):
                text += "\n" + lines[n]
                n += 1
            start = n
            while not lines[n].startswith(("$ ", "```")):
                n += 1
            found.append((block, text, start, n))
    return found


def run(geomint, source, texts):
    """Returns the lines that each command printed, and its exit status. One shell runs them all."""
    with tempfile.TemporaryDirectory() as folder:
        place, script = os.path.join(folder, "here"), os.path.join(folder, "script")
        os.mkdir(place)
        os.symlink(geomint, os.path.join(place, "geomint"))
        with open(script, "w", encoding="utf-8") as file:
            file.writelines(f"{text}\necho \"{MARK}$?\"\n" for text in texts)
        environment = dict(os.environ, GEOMINT_KERNEL=source, HOME=folder, XDG_CACHE_HOME=folder, LC_ALL="C.UTF-8")
        out = subprocess.run(["sh", script], cwd=place, env=environment, stdin=subprocess.DEVNULL, timeout=240,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False).stdout
    parts = re.split(re.escape(MARK) + r"(\d+)\n", out.decode("utf-8", "replace"))
    return [(printed.splitlines(), int(status)) for printed, status in zip(parts[::2], parts[1::2])]


def main(geomint, source, write):
    blocks = faults = 0
    for document in [os.path.join(source, "README.md"), *sorted(glob.glob(os.path.join(source, "docs/*.md")))]:
        name, text, reports = os.path.relpath(document, source), open(document, encoding="utf-8").read(), []
        lines = text.split("\n")
        found = commands(lines)
        results = run(geomint, source, [command for _, command, _, _ in found]) if found else []
        if len(results) < len(found):
            sys.exit(f"{name}:{found[len(results)][2]}: the shell ended at {found[len(results)][1]}")
        blocks += len({block for block, _, start, end in found if end > start})
        for (_, command, start, end), (printed, status) in reversed(list(zip(found, results))):
            differs = difference(lines[start:end], printed)
            if status:
                reports += [[f"{name}:{start}: exit status {status}: {command}", *printed[-3:]]]
            elif differs and write:
                lines[start:end] = written(lines[start:end], printed)
            elif differs:
                reports += [[f"{name}:{start}: {command}", f"document: {differs[0]}", f"program:  {differs[1]}"]]
        for report in reversed(reports):
            print(*report, sep="\n  ")
        faults += len(reports)
        if write and "\n".join(lines) != text:
            with open(document, "w", encoding="utf-8") as file:
                file.write("\n".join(lines))
            print(f"{name}: written")
    print(f"{blocks} blocks with output, {faults} of their outputs differ")
    return faults > 0


sys.exit(main(*map(os.path.realpath, sys.argv[1:3]), "--write" in sys.argv))
