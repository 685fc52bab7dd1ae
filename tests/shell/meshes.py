# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh equations as data: densities, known meshes, smoothing, free nodes.   meshes.py PROGRAM

What the program prints is compared with numbers computed here from the states, with numbers that a second program
computed once, and with sentences."""
import json
import math
import subprocess
import sys
import tempfile

program = sys.argv[1]
folder = tempfile.TemporaryDirectory()
faults = []

SYSTEM = """field: u
V: u^2/2 + k*u^4/4
parameter: k = 0.25
parameter: a = 1.2
start: u = a*exp(-(x - 0.5)^2/3), u_t = 0.2*x*exp(-x^2/2)
half_length: 6
points: 7
schemes: multiplier-lobatto4
"""


def check(good, text):
    print(("    " if good else "    WRONG: ") + text)
    if not good:
        faults.append(text)


def near(name, got, wanted, within):
    check(abs(got - wanted) <= within, f"{name}: {got:.12g}, wanted {wanted:.12g} within {within:.1g}")


def file_of(name, *lines):
    path = f"{folder.name}/{name}.system"
    with open(path, "w", encoding="utf-8") as file:
        file.write(SYSTEM + "".join(line + "\n" for line in lines))
    return path


def run(*words):
    return subprocess.run([program, "run", *words], capture_output=True, text=True, check=False)


def states(*words):
    """Answers of lanes, with states of lists u, x, u_dot, x_dot."""
    made = run(*words, "--state", "--json")
    lanes = [json.loads(line) for line in made.stdout.splitlines()]
    if not lanes:
        print(made.stderr)
    for lane in lanes:
        state, points = lane["state"], len(lane["state"]) // 4
        names = ("u", "x", "u_dot", "x_dot")
        lane["state"] = {name: state[i * points:(i + 1) * points] for i, name in enumerate(names)}
    return lanes


def refused(sentence, *words):
    made = run(*words)
    check(made.returncode == 1 and sentence in made.stderr, f"refused: {words[-1]}: {made.stderr.strip()}")


def densities():
    """Every cell has the same ell, computed from the printed state."""
    for text, rho in (
        ("sqrt(1 + 2*u_x^2 + 0.3*u^2)", lambda u, s, x: math.sqrt(1 + 2 * s * s + 0.3 * u * u)),
        ("1 + 0.4*tanh(x - 12)*u_x^2/(1 + u_x^2) + 0.1*V_u",
         lambda u, s, x: 1 + 0.4 * math.tanh(x - 12) * s * s / (1 + s * s) + 0.1 * math.sin(u)),
    ):
        for lane in states("soliton", f"density={text}", "until=5",
                           "scheme=multiplier-lobatto4,control-gauss4,multiplier-trapezoidal"):
            u = [0, *lane["state"]["u"], 2 * math.pi]
            x = [0, *lane["state"]["x"], 25]
            ell = []
            for e in range(len(u) - 1):
                d = x[e + 1] - x[e]
                s = (u[e + 1] - u[e]) / d
                ell.append(d * d * (rho(u[e], s, x[e]) ** 2 + rho(u[e + 1], s, x[e + 1]) ** 2) / 2)
            near(f"{lane['scheme']}, {text}: spread of ell", (max(ell) - min(ell)) / max(ell), 0, 1e-11)
    named, typed = (states("soliton", f"density={density}", "until=5")[0]["state"]
                    for density in ("arclength", "sqrt(1 + alpha^2*u_x^2)"))
    check(named == typed, "arclength and its formula have the same bits")
    line, key = (states(*words, "until=1")[0]["state"] for words in (
        (file_of("line", "density: sqrt(1 + 0.8*u_x^2 + k*u^2)"),),
        (file_of("key", "density: 1 + x^2"), "density=sqrt(1 + 0.8*u_x^2 + 0.25*u^2)")))
    check(line == key, "a line and a key have the same bits, and the key replaces the line")
    refused("density: there is no name v; did you mean velocity, at column 10 of sqrt(1 + v)", "soliton", "density=sqrt(1 + v)")
    refused("density: it does not hold u_t, at column 1 of 1 + u_t", "soliton", "density=1 + u_t")
    refused("density: it has to be smooth, and abs is not, at column 5", "soliton", "density=1 + abs(u_x)")
    refused("density: is -1 at the start where x = 0", "soliton", "density=u_x - 1")
    refused("density: is ", "soliton", "density=1/(x - 12.5)")
    refused("the formula ends where a number", "soliton", "density=sqrt(1 +")
    refused("bad.system:9:10: density: there is no name w, at column 5 of 1 + w", file_of("bad", "density: 1 + w"))
    refused("alpha is a key of moving meshes", file_of("alpha", "parameter: alpha = 1"))
    refused("steepest has a meaning in density: and is a parameter",
            file_of("steepest", "parameter: steepest = 1", "density: limited"))
    refused("density: has at most 255 characters", file_of("long", "density: 1" + " + u^2" * 60))


densities()
sys.exit(len(faults) > 0)
