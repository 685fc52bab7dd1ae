#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The house, by what files include and what their objects call: no circle of files or of folders, no folder of more
rooms than one looks through, the hall of core without a wing, wings without each other, every exported name with the
project's prefix, every name of a header unique.
Usage: house.py SOURCE BUILD [--long]   --long: what each circle is made of"""
import collections
import json
import os
import re
import shlex
import subprocess
import sys

source, build = os.path.realpath(sys.argv[1]), os.path.realpath(sys.argv[2])
long = "--long" in sys.argv
LAYERS = ("loader", "core", "render", "scenes", "app", "library")
KINDS = open(os.path.join(source, "core/kinds.def"), encoding="utf-8").read()
MOST_ROOMS = 16  # in a folder; about fifteen
WINGS = tuple("core/" + kind for kind in re.findall(r"^GM_KIND\((\w+)\)", KINDS, re.M))
failures = []


def fail(sentence):
    failures.append(sentence)
    print(sentence)


def room(path):
    """A source and its header are one."""
    return re.sub(r"\.(c|h|def|loop\.h|kernel\.h|loops\.c)$", "", path)


def circles(arrows):
    """The strongly connected components of more than one node (Tarjan, without recursion)."""
    index, low, on, stack, found = {}, {}, set(), [], []
    for root in sorted(arrows):
        if root in index:
            continue
        work = [(root, iter(sorted(arrows[root])))]
        index[root] = low[root] = len(index)
        stack.append(root)
        on.add(root)
        while work:
            node, following = work[-1]
            for other in following:
                if other not in index:
                    index[other] = low[other] = len(index)
                    stack.append(other)
                    on.add(other)
                    work.append((other, iter(sorted(arrows.get(other, ())))))
                    break
                if other in on:
                    low[node] = min(low[node], index[other])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == index[node]:
                    circle = []
                    while not circle or circle[-1] != node:
                        circle.append(stack.pop())
                        on.discard(circle[-1])
                    if len(circle) > 1:
                        found.append(sorted(circle))
    return found


def back_up(arrows, circle):
    """How many arrows of a circle have to go for it to open: those to where a walk from its first file still is."""
    members, done, back = set(circle), set(), 0
    for root in circle:
        walk = [(root, iter(sorted(arrows[root] & members)))] if root not in done else []
        while walk:
            done.add(walk[-1][0])
            other = next(walk[-1][1], None)
            if other is None:
                walk.pop()
            elif any(other == node for node, _ in walk):
                back += 1
            elif other not in done:
                walk.append((other, iter(sorted(arrows[other] & members))))
    return back


def count(what, arrows):
    found = circles(arrows)
    print(f"{what}: {sum(map(len, arrows.values()))} arrows, {len(found)} circles, "
          f"{sum(back_up(arrows, circle) for circle in found)} arrows back up")


files = []
for layer in LAYERS:
    for folder, _, names in os.walk(os.path.join(source, layer)):
        files += [os.path.relpath(os.path.join(folder, n), source) for n in names if n.endswith((".c", ".h", ".def"))]
text = {f: open(os.path.join(source, f), encoding="utf-8").read() for f in files}
includes = {f: re.findall(r'^\s*#\s*include\s+"([^"]+)"', text[f], re.M) for f in files}

rooms = collections.defaultdict(set)
for f in files:
    rooms[os.path.dirname(f)].add(room(f))
for folder, inside in sorted(rooms.items()):
    if len(inside) > MOST_ROOMS:
        fail(f"{folder} has {len(inside)} rooms, more than {MOST_ROOMS}: it wants folders, by what belongs together")

# who calls whom, from the objects of the build
commands = json.load(open(os.path.join(build, "compile_commands.json"), encoding="utf-8"))
defined, wanted = {}, collections.defaultdict(set)
compiled, missing = set(), set()
for command in commands:
    path = os.path.relpath(os.path.realpath(os.path.join(command["directory"], command["file"])), source)
    if not path.startswith(LAYERS):
        continue
    output = os.path.join(command["directory"], command["output"])
    if not os.path.exists(output):
        missing.add(path)
        continue
    compiled.add(path)
    for line in subprocess.run(["nm", output], check=True, capture_output=True, text=True).stdout.splitlines():
        kind, name = line.split()[-2:]
        if kind == "U":
            wanted[path].add(name)
        elif kind.isupper():
            defined[name] = path
            own = ("gm_", "geomint_") if path.startswith("library/") else "gm_"
            if not name.startswith(own) and name != "main" and not re.match(r"_|LLVMFuzzer", name):
                fail(f"{path} exports {name}, which does not begin with gm_")

for path in sorted(missing - compiled):
    fail(f"{path} is not compiled: nothing is known of its calls")

arrows = collections.defaultdict(set)
why = {}
for f in files:
    for other in includes[f]:
        if room(other) != room(f):
            arrows[room(f)].add(room(other))
            why.setdefault((room(f), room(other)), "#include")
# what a list (.def) names is registered by who includes the list: data, no call
listed = {f: set(re.findall(r"^\w+\((?:\w+, )?(\w+)", text[f], re.M)) for f in files if f.endswith(".def")}


def is_registered(path, name):
    return any(other in listed and name.rsplit("gm_", 1)[-1].split("_", 1)[-1] in listed[other] for other in includes[path])


by_lists = collections.defaultdict(set)  # what a list names, and a wing's name plate, gm_kind_NAME: data, no calls
for path, names in wanted.items():
    for name in names & defined.keys():
        if room(defined[name]) == room(path):
            continue
        if is_registered(path, name) or name.startswith("gm_kind_"):
            by_lists[room(path)].add(room(defined[name]))
        else:
            arrows[room(path)].add(room(defined[name]))
            why[(room(path), room(defined[name]))] = name

for circle in circles(arrows):
    fail("a circle of files: " + " ".join(circle))
    if long:
        for a in circle:
            for b in sorted(arrows[a] & set(circle)):
                print(f"    {a} -> {b}: {why[(a, b)]}")

for layer in LAYERS:
    folders = collections.defaultdict(set)
    for a in list(arrows):
        for b in arrows[a]:
            if a.startswith(layer + "/") and b.startswith(layer + "/"):
                x, y = os.path.dirname(a), os.path.dirname(b)
                if x != y:
                    folders[x].add(y)
                    folders[y]
                    if long:
                        why.setdefault(("folder", x, y), (a, b, why[(a, b)]))
    for circle in circles(folders):
        fail("a circle of folders: " + " ".join(circle))
        if long:
            for a in circle:
                for b in sorted(folders[a] & set(circle)):
                    print(f"    {a} -> {b}: {why[('folder', a, b)]}")

for f in files:
    if not f.startswith("core/"):
        continue
    mine = next((w for w in WINGS if f.startswith(w + "/")), "")
    for other in includes[f]:
        if any(other.startswith(w + "/") for w in WINGS if w != mine):
            fail(f"{f} must not include {other}: " + ("wings do not know each other" if mine else "the hall knows no wing"))
for a in sorted(arrows):
    mine = next((w for w in WINGS if a.startswith(w + "/")), "")
    for b in sorted(arrows[a]):
        if a.startswith("core/") and why[(a, b)] != "#include" and any(b.startswith(w + "/") for w in WINGS if w != mine):
            fail(f"{a} must not call {why[(a, b)]} of {b}")

# names: what a header says means one thing in the whole program
BODIES = {  # headers that mean something only where they are included
    r"\.kernel\.h$": "a problem's kernels, over the lane type of the pass that includes them",
    r"\.loop\.h$": "a family's loop over those kernels",
    r"^core/ode/(compiled/pass|kernel/(block|drive|formula))\.h$": "parts of a pass, of which a file has two",
    r"^core/functions/(?!functions|complex|instructions|rows)\w+\.h$": "the functions of a pass",
}
headers = sorted(f for f in files if f.endswith(".h") and not any(re.search(body, f) for body in BODIES))


def bare(c):
    """C without comments, strings and lines of the preprocessor."""
    c = re.sub(r'/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', " ", c, flags=re.S)
    return re.sub(r"^\s*#(?:.*\\\n)*.*$", "", c, flags=re.M)


def without_brackets(c):
    while re.search(r"\([^()]*\)|\[[^][]*\]", c):
        c = re.sub(r"\([^()]*\)|\[[^][]*\]", "", c)
    return c


public, meanings, places = set(), collections.defaultdict(set), collections.defaultdict(set)
for f in headers + [f for f in files if f.endswith(".c")]:
    code = bare(text[f])
    found = [("macro", name, "") for name in re.findall(r"^\s*#\s*define\s+(\w+)", text[f], re.M)]
    found += re.findall(r"\b(struct|enum|union)\s+(\w+)\s*(\{)?", code)
    for body in re.findall(r"\benum\b\s*\w*\s*\{([^}]*)\}", code):
        found += [("constant", name, "=") for name in re.findall(r"(?:^|,)\s*(\w+)", without_brackets(body))]
    for what in re.findall(r"\btypedef\b([^;{]*(?:\{[^}]*\})?[^;{]*);", code):
        name = (re.findall(r"\(\s*\*\s*(\w+)\s*\)", what) or re.findall(r"\w+", without_brackets(what)))[-1]
        if not re.match(rf"\s*(struct|enum|union)\s+{name}\b", what):
            found.append(("type", name, "="))
    for kind, name, here in found:
        meanings[name].add(kind)
        if here:
            places[name].add(f"{kind} in {f}")
        if f.endswith(".h"):
            public.add(name)
for name in sorted(public):
    if len(places[name]) > 1 or len(meanings[name]) > 1:
        fail(f"{name} is two things: " + ", ".join(sorted(places[name] | meanings[name])))

# ... and the compiler, which sees all headers at once
command = next(c for c in commands if c["file"].endswith("app/main.c"))
words = shlex.split(command["command"])
compiler = words[: next(i for i, word in enumerate(words) if word.startswith("-"))]
flags = [word for word in words if word.startswith(("-I", "-D", "-std=", "-isystem"))]
checked = subprocess.run(
    [*compiler, *flags, *"-Wall -Wextra -Wshadow -Wpedantic -Werror -fsyntax-only -x c -".split()],
    input="".join(f'#include "{f}"\n' for f in headers), cwd=command["directory"], capture_output=True, text=True,
    check=False,
)
if checked.returncode != 0:
    fail("no unit can include all headers at once:\n" + checked.stderr)

count("files", arrows)
count("files, with what lists name", {a: arrows.get(a, set()) | by_lists.get(a, set()) for a in arrows | by_lists})
between = collections.defaultdict(set)
for a in list(arrows):
    between[os.path.dirname(a)] |= {os.path.dirname(b) for b in arrows[a]} - {os.path.dirname(a)}
count("folders", between)
print(f"{len(failures)} found")
sys.exit(1 if failures else 0)
