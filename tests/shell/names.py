#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Names that people know from elsewhere: every alias runs as its scheme, and the first mistakes name what is meant.

names.py GEOMINT SOURCE
"""
import json
import os
import re
import subprocess
import sys
import tempfile

geomint, source = os.path.realpath(sys.argv[1]), os.path.realpath(sys.argv[2])
failures = 0


def check(good, text):
    global failures
    if not good:
        print("FAILED:", text)
        failures += 1


def call(*words, **environment):
    return subprocess.run([geomint, *words], capture_output=True, text=True, stdin=subprocess.DEVNULL,
                          env={**os.environ, **environment})


def run(scene, scheme):
    """The lines of a run in JSON, without its time; None if it was refused."""
    answer = call("run", scene, "scheme=" + scheme, "steps=4", "--json", "--state")
    rows = [json.loads(line) for line in answer.stdout.splitlines()] if answer.returncode == 0 else None
    for row in rows or []:
        del row["seconds"]
        row.pop("engine", None)
    return rows


def refused(contained, *words):
    answer = call(*words)
    check(answer.returncode == 1 and answer.stdout == "" and answer.stderr.count("\n") == 1
          and all(text in answer.stderr for text in contained), f"{words}: {answer}")


names = {json.loads(line)["scheme"] for line in call("list", "schemes", "--json").stdout.splitlines()}
with open(os.path.join(source, "core", "aliases.def"), encoding="utf-8") as file:
    rows = re.findall(r'^GM_(\w+)\((?:(\w+), )?"(.*?)", "(.*?)"', file.read(), re.MULTILINE)
near = [(kind, typed, meant) for macro, kind, typed, meant in rows if macro == "NEAR"]
aliases = [(typed, meant) for macro, kind, typed, meant in rows if macro == "ALIAS"]
check(len(aliases) >= 50, f"{len(aliases)} aliases")
check(len(set(typed for typed, meant in aliases)) == len(aliases), "an alias of two schemes")

# every alias gives the bits of its scheme under the scheme's own name, where that scheme fits
tried = set()
for typed, meant in aliases:
    if meant not in names:  # it needs a library that this build lacks
        check(meant.startswith("gsl-"), f"{typed} means {meant}, which is not a scheme")
        continue
    scene, expected = next(((scene, rows) for scene in ("kepler", "sine-gordon", "rigid-body")
                            if (rows := run(scene, meant))), (None, None))
    rows = run(scene, typed) if scene else None
    check(rows and rows == expected, f"{typed} in {scene} is not {meant}: {str(rows)[:200]}")
    check(rows and rows[0]["scheme"] == meant, f"{typed} is shown as {rows and rows[0]['scheme']}")
    tried.add(scene)
check(tried == {"kepler", "sine-gordon", "rigid-body"}, f"scenes: {tried}")

# a scheme of that very name has precedence where it fits, and a file has it everywhere
check(run("sine-gordon", "leapfrog")[0]["scheme"] == "leapfrog", "leapfrog of waves")
check(run("burgers", "crank-nicolson")[0]["scheme"] == "crank-nicolson", "crank-nicolson of Burgers' equation")
for typed, own in {"Verlet": "verlet", "RK4": "rk4", "Velocity-Verlet": "verlet"}.items():
    check(run("Kepler", typed) == run("kepler", own), f"{typed} of Kepler")
with tempfile.TemporaryDirectory() as folder:
    with open(os.path.join(folder, "heun.scheme"), "w", encoding="utf-8") as file:
        file.write("geomint: 1\nkind: composition\nbase: verlet\nsteps: 1/2, 1/2\n")
    answer = call("run", "kepler", "scheme=heun", "steps=4", "--json", GEOMINT_SCHEMES=folder)
    check('"scheme":"heun"' in answer.stdout, f"a file called heun: {answer}")
    # tables and the metadata of pictures have the own name
    table, picture = os.path.join(folder, "t.csv"), os.path.join(folder, "p.svg")
    call("sweep", "kepler", "scheme=leapfrog,Heun", "dt=0.1,0.2", "until=1", "--table", table)
    with open(table, encoding="utf-8") as file:
        check([line.split(",")[1] for line in file][1:] == ["verlet", "verlet", "rk2", "rk2"], "the table's names")
    call("render", "kepler", "scheme=leapfrog", "until=1", "-o", picture, "--size", "160x90")
    with open(picture, encoding="utf-8") as file:
        text = file.read()
        check("scheme=verlet" in text and "leapfrog" not in text, "the picture's names")

# the first mistakes
for contained, *words in (
        [["dt"], "run", "kepler", "h=0.1"],
        [["until"], "run", "kepler", "tmax=10"],
        [["until"], "run", "kepler", "T=10"],
        [["did you mean scheme"], "run", "kepler", "method=rk4"],
        [["eccentricity"], "run", "kepler", "e=0.1"],
        [["points"], "run", "sine-gordon", "N=100"],
        [["scheme=rk4"], "run", "kepler", "--scheme", "rk4"],
        [["scheme=rk4"], "run", "kepler", "--scheme=rk4"],
        [["until=10"], "run", "kepler", "--tmax", "10"],
        [["scheme=rk4"], "run", "kepler", "scheme", "rk4"],
        [["scheme=rk4"], "run", "kepler", "rk4"],
        [["disc system=pendulum", "double-pendulum", "spherical-pendulum"], "run", "pendulum"],
        [["disc system=pendulum"], "pendulum"],
        [["did you mean verlet"], "run", "kepler", "scheme=Störmer"],
        [["see geomint list sine-gordon"], "run", "sine-gordon", "scheme=rkf45"],
        [["three words: H='p^2/2 - cos(q)' q=1 p=0"], "system", "H = p^2/2 - cos(q), q = 1, p = 0"],
        [["two words: H='q^2 + p^2' q=1"], "run", "system", "H = q^2 + p^2, q = 1"],
        [["rate='x = y' rate='y = -x'"], "run", "system", "x'=y", "y'=-x", "x=1", "y=0"],
        [["rate='x = v' rate='v = -x'"], "run", "system", "x''=-x", "x=1"],
        [["rate='v = v_v' rate='v_v = -v'"], "run", "system", "v''=-v"],
        [["rate='x = y' rate='y = -x'"], "system", "x' = y, y' = -x"],
        [["rate='x = y'"], "run", "system", "dx/dt=y"],
        [["three words: H='p^2/2 - cos(q)' q=1 p=0"], "run", "system", "H=p^2/2 - cos(q), q=1, p=0"],
        [["system x''=-x"], "run", "x''=-x"],
        [["the scene comes before scheme=verlet"], "run", "scheme=verlet", "kepler"],
        [["coordinates=x momenta=y"], "run", "system", "H=(x^2+y^2)/2", "x=1", "y=0"],
        [["coordinates=x,y momenta=px,py"], "run", "system", "H=(px^2+py^2)/2+x*y", "x=1", "y=0", "px=0", "py=0"],
        [["did you mean render"], "plot", "kepler"],
        [["did you mean run"], "simulate", "kepler"],
        [["did you mean sweep"], "scan", "kepler"],
        [["did you mean list or tour"], "gallery"]):
    refused(contained, *words)
check(run("kepler", "leapfrog")[0]["scheme"] == "verlet", "leapfrog of kepler")
for kind, typed, meant in near:
    if kind == "SCHEME" and meant in names:
        refused([f"{typed} is not here", meant], "run", "kepler", "scheme=" + typed)

sys.exit(failures > 0)
