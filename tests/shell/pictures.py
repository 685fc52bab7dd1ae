#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Each picture of the documents is what the command beside it draws.
Usage: pictures.py GEOMINT SOURCE [--write [NAME ...]]   --write: draws the pictures that differ, or those named

A command that draws a file of the picture's name is in the section of the image, or of the same image in another
document. A PNG stores its own command: scene, schemes and parameters must be the same, and the painter the program's
own, whose pixels are the same on every machine with the same fonts. A movie stores nothing, so it is drawn only by its
name."""
import glob
import json
import os
import re
import shlex
import struct
import subprocess
import sys
import tempfile

SIZE = "960x540"  # pixels, if the command gives none
MOST_BYTES = {".png": 200_000, ".gif": 600_000}
MOST_BYTES_IN_ALL = 2_800_000
HOW = ("-o", "--movie", "--shot", "--size", "--painter")  # options with a value that do not choose what is drawn


def what_is_drawn(words):
    """Returns the words that choose what is drawn, sorted, with each theme and screen that is not the usual one."""
    words, kept = list(words), []
    while words:
        word = words.pop(0)
        value = words.pop(0) if word in (*HOW, "--theme", "--screen") else None
        if word not in HOW and value not in ("light", "80x24"):
            kept.append(word if value is None else f"{word} {value}")
    return sorted(kept)


def stored(path):
    """Returns what the text chunks of a PNG say was drawn, and by which painter."""
    data, texts, at = open(path, "rb").read(), {}, 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"tEXt":
            key, _, text = data[at + 8:at + 8 + length].decode("utf-8").partition("\0")
            texts[key] = text
        at += 12 + length
    command = texts.get("geomint:command")
    if command is None:
        command = f"render {texts['geomint:arguments']} --theme {texts['geomint:picture'].split()[1]}"
    return what_is_drawn(shlex.split(command)), texts["geomint:painter"]


def shown(source):
    """Returns the path of each picture in the documents, and the places and words of the commands in its section."""
    found = {}
    for document in [os.path.join(source, "README.md"), *sorted(glob.glob(os.path.join(source, "docs/*.md")))]:
        for section in re.split(r"^(?=#+ )", open(document, encoding="utf-8").read(), flags=re.M):
            title = section.split("\n", 1)[0]
            for link in re.findall(r"!\[[^]]*\]\(([^)]*\.(?:png|gif))\)", section):
                commands = found.setdefault(os.path.normpath(os.path.join(os.path.dirname(document), link)), [])
                for command in re.findall(r"geomint ([a-z-]+ [^\n`]*(?:-o|--movie|--shot) \S+\.(?:png|gif))", section):
                    words = shlex.split(command)
                    if words[-1] == os.path.basename(link):
                        commands.append((f"{os.path.relpath(document, source)}, {title}", words))
    return found


def difference(geomint, path, words):
    """Returns None if the picture is drawn by these words, else how it differs."""
    if not os.path.exists(path):
        return "is missing"
    if not path.endswith(".png"):
        return None
    (drawn, painter), wanted = stored(path), what_is_drawn(words)
    if drawn != wanted and words[0] == "render":  # a scene without schemes is drawn with those of its list
        listed = json.loads(subprocess.run([geomint, "list", words[1], "--json"], check=True, capture_output=True).stdout)
        wanted = sorted(wanted + ("" if "scheme=" in " ".join(words) else listed.get("render", "")).split())
    if drawn != wanted:
        return f"stores: {shlex.join(drawn)}"
    return None if painter == "own" else f"is painted by {painter}"


def draw(geomint, path, words):
    """Draws a picture in a folder of its own first: a failure leaves the old one."""
    with tempfile.TemporaryDirectory(dir=os.path.dirname(path)) as folder:
        size = [] if "--size" in words or words[0] == "tui" else ["--size", SIZE]
        subprocess.run([geomint, *words, *size, "--painter", "own"], cwd=folder, check=True, capture_output=True)
        os.replace(os.path.join(folder, words[-1]), path)
    print(f"{words[-1]}: drawn")


def main(geomint, source, write, named):
    faults, found = [], shown(source)
    for path in sorted({*glob.glob(os.path.join(source, "docs/pictures/*")), *found}):
        name, commands = os.path.basename(path), found.get(path, [])
        if name == "page.png": # a browser's, which tests/web/page.py makes
            continue
        if len({tuple(what_is_drawn(words)) for _, words in commands}) != 1:
            places = ", ".join(place for place, _ in commands) or "no document"
            faults.append(f"{name}: one command must draw it; it is near {places}")
            continue
        differs = difference(geomint, path, commands[0][1])
        if write and (name in named or (differs and not named)):
            draw(geomint, path, commands[0][1])
        elif differs:
            faults.append(f"{commands[0][0]}: {name} {differs}\n  document: {shlex.join(what_is_drawn(commands[0][1]))}")
    sizes = {path: os.path.getsize(path) for path in glob.glob(os.path.join(source, "docs/pictures/*"))}
    faults += [f"{os.path.basename(path)}: {size} bytes, at most {MOST_BYTES[path[-4:]]}"
               for path, size in sizes.items() if size > MOST_BYTES[path[-4:]]]
    if sum(sizes.values()) > MOST_BYTES_IN_ALL:
        faults.append(f"all pictures: {sum(sizes.values())} bytes, at most {MOST_BYTES_IN_ALL}")
    print(*faults, f"{len(sizes)} pictures, {sum(sizes.values())} bytes, {len(faults)} faults", sep="\n")
    return bool(faults)


sys.exit(main(*map(os.path.realpath, sys.argv[1:3]), "--write" in sys.argv, [w for w in sys.argv[3:] if w[0] != "-"]))
