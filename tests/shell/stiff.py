#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Implicit schemes on stiff problems: every row is a run, what it has to end in, and where that is known from.
Usage: stiff.py PROGRAM"""
import json
import math
import os
import subprocess
import sys
import tempfile

geomint = os.path.realpath(sys.argv[1])
folder = tempfile.TemporaryDirectory()
failures = 0

FILES = {
    "robertson": "rate: a = -0.04*a + 1e4*b*c, b = 0.04*a - 3e7*b^2 - 1e4*b*c, c = 3e7*b^2\n"
                 "start: a = 1, b = 0, c = 0\nuntil: 40\n",
    "hires": "rate: y1 = -1.71*y1 + 0.43*y2 + 8.32*y3 + 0.0007\nrate: y2 = 1.71*y1 - 8.75*y2\n"
             "rate: y3 = -10.03*y3 + 0.43*y4 + 0.035*y5\nrate: y4 = 8.32*y2 + 1.71*y3 - 1.12*y4\n"
             "rate: y5 = -1.745*y5 + 0.43*y6 + 0.43*y7\n"
             "rate: y6 = -280*y6*y8 + 0.69*y4 + 1.71*y5 - 0.43*y6 + 0.69*y7\n"
             "rate: y7 = 280*y6*y8 - 1.81*y7\nrate: y8 = -280*y6*y8 + 1.81*y7\n"
             "start: y1 = 1, y2 = 0, y3 = 0, y4 = 0, y5 = 0, y6 = 0, y7 = 0, y8 = 0.0057\nuntil: 321.8122\n",
    "oregonator": "rate: y1 = 77.27*(y2 + y1*(1 - 8.375e-6*y1 - y2))\nrate: y2 = (y3 - (1 + y1)*y2)/77.27\n"
                  "rate: y3 = 0.161*(y1 - y3)\nstart: y1 = 1, y2 = 2, y3 = 3\nuntil: 360\n",
    "van-der-pol": "rate: x = z, z = ((1 - x^2)*z - x)/1e-6\nstart: x = 2, z = 0\nuntil: 0.804\n",
    "decay": "rate: x = y, y = -x - 2*y\nstart: x = 1, y = 0\ndt: 0.5\nuntil: 2000\n",
    "cubic": "rate: x = -1e6*x^3 - x\nstart: x = 1\ndt: 0.5\nuntil: 1500\n",
    "slow-manifold": "rate: x = y, y = -1e6*(y - cos(x))\nstart: x = 0, y = 0\ndt: 0.01\nuntil: 1\n",
    "forced": "rate: x = -1e7*(x - sin(t)) + cos(t)\nstart: x = 0.5\ndt: 0.01\nuntil: 2\n",
    "rod": "coordinates: x y\nL: (v_x^2 + v_y^2)/2 - 1e6/2*(sqrt(x^2 + y^2) - 1)^2 - y\n"
           "start: x = 1.0001, y = 0, p_x = 0, p_y = 0\ndt: 0.01\nuntil: 1\n",
    "quadratic": "coordinates: q\nmomenta: p\nH: p^2*(1 + q^2)/2 + 1e6*q^2/2 + q^4/4\n"
                 "start: q = 0.01, p = 0\ndt: 0.01\nuntil: 1\n",
}
for name, text in FILES.items():
    with open(os.path.join(folder.name, name + ".system"), "w", encoding="utf-8") as file:
        file.write(text)


def run(name, *words):
    path = os.path.join(folder.name, name + ".system")
    done = subprocess.run([geomint, "run", path, *words, "--json", "--state"], capture_output=True, text=True,
                          timeout=300)
    if not done.stdout:
        return {"status": "none", "message": done.stderr, "state": [math.nan], "t": 0, "steps": 1,
                "evaluations": 0}
    return json.loads(done.stdout)


def check(holds, *what):
    global failures
    if not holds:
        failures += 1
        print("FAILED:", *what)


def ends(name, words, values, near):
    """The run ends ok, its first components at these values, each to this part of it."""
    made = run(name, *words.split())
    good = made["status"] == "ok" and all(abs(x - y) <= near * abs(y) for x, y in zip(made["state"], values))
    check(good, name, words, made["status"], made["message"], made["state"], "not", values)


IMPLICIT = ["implicit-euler", "sdirk2", "trapezoidal", "midpoint", "radau3", "radau5"]

# Robertson's reactions at t = 40. The scheme's own numbers: each step solved with 30 digits.
OWN = [
    ("implicit-euler", 0.2, (0.71652003754267, 9.2125157689982e-6, 0.28347074994156)),
    ("midpoint", 0.2, (0.71583147079796, 4.0041233964181e-7, 0.2841681287897)),
    ("trapezoidal", 0.2, (0.69837990159028, 5.7562260244574e-6, 0.3016143421837)),
    ("sdirk2", 0.2, (0.71582518614143, 9.1854615714929e-6, 0.28416562839699)),
    ("radau3", 0.2, (0.71582705255345, 9.1855341361287e-6, 0.28416376191241)),
    ("implicit-euler", 0.1, (0.71617495454806, 9.1990676527981e-6, 0.28381584638429)),
    ("midpoint", 0.1, (0.71582635960607, 9.0631603943522e-6, 0.28416457723354)),
    ("trapezoidal", 0.1, (0.71459102613603, 9.1002408720503e-6, 0.2853998736231)),
    ("sdirk2", 0.1, (0.71582661077971, 9.1855169535759e-6, 0.28416420370334)),
    ("radau3", 0.1, (0.71582706677857, 9.1855346890929e-6, 0.28416374768674)),
]
for scheme, dt, values in OWN:
    ends("robertson", f"scheme={scheme} dt={dt}", values, 1e-8)
# and those of the exact solution, by the reference of Hairer & Wanner's test set
RIGHT = (0.7158270688, 9.185534765e-6, 0.2841637457)
for scheme, near in zip(IMPLICIT, [1e-3, 1e-6, 1.2e-4, 1e-6, 1e-8, 1e-8]):
    for dt in "0.04", "0.01":
        ends("robertson", f"scheme={scheme} dt={dt}", RIGHT, near)
# one step of implicit Euler from the start: the root of its cubic, with 30 digits
ends("robertson", "scheme=implicit-euler dt=1e5 steps=1", (0.1194785136, 5.417628462e-7), 1e-9)
ends("robertson", "scheme=implicit-euler dt=1e8 steps=1", (4.533599163e-3, 1.821598549e-8), 1e-9)
ends("robertson", "scheme=implicit-euler dt=1e8 until=1e11", (2.08334e-8,), 0.02)
# of longer methods the root at 1e4 is no concentration any more; beyond Newton's method finds none
ends("robertson", "scheme=radau5 dt=1e4 steps=1", (-0.1289317749,), 1e-9)
ends("robertson", "scheme=sdirk2 dt=1e4 steps=1", (-0.68626764,), 1e-7)

# the test set for initial value problems: OREGO at 360, HIRES at 321.8122
OREGO = (1.00081487, 1228.17852, 132.055494)
ends("oregonator", "scheme=radau5 dt=0.01", OREGO, 1e-6)
ends("oregonator", "scheme=midpoint dt=0.01", OREGO, 2e-3)
ends("oregonator", "scheme=implicit-euler dt=0.01", OREGO, 0.04)
ends("hires", "scheme=radau5 dt=0.01", (7.371e-4,), 1e-3)
made = run("hires", "scheme=radau5", "dt=0.1")
check(made["status"] == "ok" and made["evaluations"] < 35 * made["steps"], "hires", made["message"],
      made["evaluations"] / made["steps"], "evaluations a step, where sweeps need 145")

# an end that is typed decides what is stiff; a file with events takes a scheme that ends at them
typed = ["system", "rate=x = z, z = ((1 - x^2)*z - x)/1e-6", "x=2", "z=0", "until=2"]
made = json.loads(subprocess.run([geomint, "run", *typed, "--json", "--state"], capture_output=True, text=True).stdout)
check(made["scheme"] == "gsl-msbdf" and abs(made["state"][0] - 1.7061677321) < 1e-4, "typed", made)

# all reach t = 0.804, before the jump at 0.807; x there by gsl-msbdf with tolerance=1e-11
for scheme, near in zip(IMPLICIT, [2e-2, 1e-4, 2e-4, 1e-5, 2e-6, 1e-7]):
    for dt in "1e-3", "1e-4":
        ends("van-der-pol", f"scheme={scheme} dt={dt}", (1.053955041,), near)
# what comes to rest is at rest
for scheme in IMPLICIT + ["gauss4"]:
    for name in "decay", "cubic":
        made = run(name, f"scheme={scheme}")
        slow = name == "cubic" and scheme == "trapezoidal"  # it changes the sign of what is large
        check(made["status"] == "ok" and (slow or abs(made["state"][0]) < 1e-300), name, scheme, made["message"],
              made["state"])
# y falls to cos x, and x' = cos x is then the Gudermannian: sin x = tanh t; methods that do not damp go about it
for scheme, near in zip(IMPLICIT + ["gauss4"], [2e-3, 1e-5, 1e-5, 2e-5, 1e-6, 1e-6, 1e-5]):
    ends("slow-manifold", f"scheme={scheme}", (math.asin(math.tanh(1)),), near)
ends("forced", "scheme=implicit-euler", (math.sin(2),), 1e-9)
ends("forced", "scheme=radau5", (math.sin(2),), 1e-14)
# a rod all but rigid is a pendulum from rest at the side, a'' = -cos a: cos and sin of a(1), by Taylor's method with
# 20 digits
for scheme, near in ("gauss4", 5e-4), ("midpoint", 5e-4), ("radau5", 5e-4), ("implicit-euler", 1e-2):
    ends("rod", f"scheme={scheme}", (0.879548132412, -0.475809922943), near)


def fails(name, words, t, sentence):
    made = run(name, *words.split())
    check(made["status"] == "no-convergence" and abs(made["t"] - t) < 1e-9 and sentence in made["message"]
          and len(made["message"].split()) <= 26, name, words, made["status"], made["t"], made["message"])


# steps without a solution: the quadratic -0.0100 p^2 + p - 9902 = 0 has no real root
LARGE = "was not solved: its iteration still changes by "
for scheme in "symplectic-euler", "lobatto2", "lobatto4":
    fails("quadratic", f"scheme={scheme}", 0.01, "radau5 or gsl-msbdf")
for scheme in "radau5", "sdirk2":
    fails("robertson", f"scheme={scheme} dt=1e5 steps=1", 0, LARGE)
    check(run("robertson", f"scheme={scheme}", "dt=1e5", "steps=1")["message"].partition("; take ")[2].startswith(("a shorter dt", "dt below")),
          scheme, "proposes another scheme")

folder.cleanup()
sys.exit(failures > 0)
