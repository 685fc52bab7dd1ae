#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of one method: `list` reports them where they make the same steps, and there alone.
Usage: same_as.py PROGRAM"""
import json
import os
import subprocess
import sys
import tempfile

geomint = sys.argv[1]
failures = 0
folder = tempfile.TemporaryDirectory()
FORCED = os.path.join(folder.name, "forced.system")
with open(FORCED, "w", encoding="utf-8") as file:
    file.write("coordinates: q\nmomenta: p\nH: p^2/2 - cos(q)\nforce: q = -0.1*p\nstart: q = 2, p = 0\n")


def output(*words):
    return subprocess.run([geomint, *words], capture_output=True, text=True, timeout=300, check=True).stdout


def check(holds, *what):
    global failures
    if not holds:
        failures += 1
        print("FAILED:", *what)


def names(*words):
    """The schemes that have other names here, with these."""
    return json.loads(output("list", *words, "--json"))["same_as"]


def difference(words, schemes):
    """The largest difference of two runs of nine steps, as a part of the state."""
    lines = output("run", *words, "scheme=" + ",".join(schemes), "steps=9", "--json", "--state").splitlines()
    one, two = (json.loads(line)["state"] for line in lines)
    return max(abs(a - b) for a, b in zip(one, two)) / max(abs(a) for a in one)


LAGRANGIAN = {"midpoint": ["variational-midpoint2"], "verlet": ["variational-trapezoidal2"],
              "lobatto4": ["variational-simpson4"]}
FLAT = {"symplectic-euler-adjoint": ["volume-splitting1"], "verlet-position": ["volume-splitting2"]}
LINEAR = {"midpoint": ["avf2", "discrete-gradient2", "kahan2", "trapezoidal"], "rk4sym": ["avf4"]}
ROWS = [
    (["henon-heiles"], [LAGRANGIAN, FLAT]),
    (["system", "H=p^2/2 - cos(q)", "q=2", "p=0"], [LAGRANGIAN, FLAT]),
    (["system", "H=p^2/2 + q^2", "q=2", "p=0.3"], [LAGRANGIAN, FLAT, LINEAR]),
    (["system", "H=p^4/4 + q^2", "q=2", "p=0.3"], [FLAT]),
    (["system", "H=p^2*(1 + q^2)/2", "q=2", "p=0.3"], []),
    ([FORCED], []),
    (["system", "rate=x = y, y = -x - 2*y", "x=1", "y=0"],
     [{"midpoint": ["kahan2", "trapezoidal"]}]),
    (["system", "rate=x = y, y = -x + cos(t)", "x=1", "y=0"], []),
    (["wave", "points=60"], [{"leapfrog": ["energy-conserving", "euler-box"]}]),
    (["sine-gordon", "points=60"], [{"leapfrog": ["euler-box"]}]),
    (["kdv", "points=60"], []),
]
for words, groups in ROWS:
    wanted = {}
    for group in groups:
        for one, others in group.items():
            wanted.setdefault(one, set()).update(others)
    found = names(*(words if words[0] == "system" else words[:1]))
    check({name: set(found.get(name, [])) for name in wanted} == wanted, words, "has", found)
    check(set(found) == set(wanted) | {name for others in wanted.values() for name in others}, words, "has", found)
    for one, others in wanted.items():
        for other in others:
            check(one in found[other], other, "is not", one)
            apart = difference(words, [one, other])
            check(apart <= 1e-11, words, one, other, apart)

check("= verlet here" in output("list", "henon-heiles"), "the list does not say what is the same")
check(difference(["henon-heiles", "dt=0.5"], ["verlet", "midpoint"]) > 1e-5, "two methods are not told apart")

if failures:
    sys.exit(1)
print("same_as: ok")
