#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What words of system files and questions about them cost, as medians of rounds in which both sides of a ratio take turns:
an event that never happens beside stop: of the same formula, located breaks beside ignored ones, if beside a formula of
as many operations, the spectrum of Lorenz beside three exponents, Newton's method for van der Pol's orbit, and an orbit
diagram with its picture, followed sections beside steps alone, and a map of sections. No test: nothing fails here.
systems.py GEOMINT [ROUNDS]"""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

geomint = os.path.abspath(sys.argv[1])
rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 11


def stepped(*words):
    """Seconds of the steps of a run."""
    done = subprocess.run([geomint, "run", *words, "--json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["seconds"]


def whole(*words):
    """Seconds of a process."""
    begun = time.monotonic()
    subprocess.run([geomint, *words], capture_output=True, check=True)
    return time.monotonic() - begun


def median_ratio(above, below):
    return statistics.median(above() / below() for _ in range(rounds))


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for name, word in ("event", "event: y = -9; v = -v"), ("stop", "stop: y + 9"):
        with open(name + ".system", "w") as file:
            file.write(f"rate: y = v, v = -y\n{word}\nstart: y = 1, v = 0\ndt: 0.01\n")
    for scheme in "rk4", "gauss4":
        ratio = median_ratio(lambda: stepped("event.system", f"scheme={scheme}", "steps=300000"),
                             lambda: stepped("stop.system", f"scheme={scheme}", "steps=300000"))
        print(f"an event that never happens, beside stop:, {scheme}: {ratio:.2f} (wanted 1.2)")
    with open("corner.system", "w") as file:
        file.write("coordinates: q\nmomenta: p\nH: p^2/2 + 9.8*abs(q)\nstart: q = 5, p = 0\ndt: 0.01\n")
    for scheme in "verlet", "rk4", "gauss4":
        words = "corner.system", f"scheme={scheme}", "steps=1000000"
        ratio = median_ratio(lambda: stepped(*words), lambda: stepped(*words, "breaks=ignored"))
        print(f"located breaks, a corner every 202 steps, beside ignored ones, {scheme}: {ratio:.2f} (wanted 1.5)")
    compiled = "scheme=rk4", "steps=1000000", "--engine", "native"
    for name, force in ("pieces", "if(x > 0, -2*x - x^3/10, -x - x^3/5)"), ("smooth", "-3/2*x - 3/20*x^3 - (x + x^3/5)/1e9"):
        with open(name + ".system", "w") as file:
            file.write(f"rate: x = v, v = {force}\nstart: x = 1, v = 0\ndt: 0.01\n")
    ratio = median_ratio(lambda: stepped("pieces.system", *compiled, "breaks=ignored"),
                         lambda: stepped("smooth.system", *compiled))
    print(f"if, compiled, beside a formula of as many operations, rk4: {ratio:.2f} (wanted 1.1)")
    lorenz = ("lorenz", "scheme=rk4", "dt=.005", "until=500", "--measure")
    ratio = median_ratio(lambda: whole("run", *lorenz, "lyapunov_spectrum"), lambda: 3 * whole("run", *lorenz, "lyapunov"))
    print(f"a spectrum of Lorenz, beside three exponents: {ratio:.2f} (wanted 1.5)")
    for scheme in "verlet", "rk4", "gauss4":
        words = "henon-heiles", f"scheme={scheme}", "steps=1000000"
        ratio = median_ratio(lambda: stepped(*words, "--save-tracks", "tracks.npz"), lambda: stepped(*words))
        print(f"Henon-Heiles with its section, beside its steps alone, {scheme}: {ratio:.2f} (wanted 1.3)")
    with open("far.system", "w") as file:
        file.write("coordinates: q\nmomenta: p\nH: p^2/2 + q^2/2 + q^4/4\nsection: q - 9 = 0; q, p\nstart: q = 1, p = 0\ndt: 0.1\n")
    words = "far.system", "scheme=verlet", "steps=1000000"
    ratio = median_ratio(lambda: stepped(*words, "--save-tracks", "tracks.npz"), lambda: stepped(*words))
    print(f"a section that is never passed, beside steps alone, verlet: {ratio:.2f} (wanted 1.3)")
    for name, words, wanted in (
        ("40 000 points of sections of Henon-Heiles", ("sweep", "henon-heiles", "scheme=verlet", "q2=-.1...3:400", "until=800",
         "--values", "q2:100", "--at", "section", "-o", "map.png"), 0.4),
        ("van der Pol's orbit", ("orbit", "system", "rate=x = y, y = (1 - x^2)*y - x", "x=2", "y=0"), 0.05),
        ("a tree of 400 x 100 with its picture", ("sweep", "system", "rate=x = r*x*(1 - x) - x", "x=.5", "r=2.8..4:400",
         "scheme=explicit-euler", "dt=1", "until=1000", "--values", "x:100", "-o", "tree.png"), 0.5),
    ):
        print(f"{name}: {statistics.median(whole(*words) for _ in range(rounds)):.3f} s (wanted {wanted})")
