#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What scenes say of schemes, held against their numbers: sentences.py GEOMINT

The names are read from the sentence, the numbers from runs: another sentence, or another scheme, and they part."""
import json
import re
import subprocess
import sys

ROUND_OFF = 1e-12  # of what is kept; what is not is off by far more, but for schemes of order 8 (2e-11)


def geomint(*words):
    return subprocess.run([sys.argv[1], *words], check=False, stdout=subprocess.PIPE).stdout.decode()


def run(*words):
    """The observables of each lane, with the largest, by scheme."""
    lanes = [json.loads(line) for line in geomint("run", *words, "--json", "--max").splitlines()]
    return {lane["scheme"]: lane["observables"] for lane in lanes}


def told(scene, pattern):
    """The scene as it is listed, and what the pattern finds in the sentence on what to watch."""
    listed = json.loads(geomint("list", scene, "--json"))
    found = re.search(pattern, listed["watch"])
    if not found:
        sys.exit(f"{scene} says something else, which is to be measured here: {listed['watch']}")
    return listed, found.groups()


def names(schemes, text):
    return {scheme for scheme in schemes if re.search(rf"(?<![\w-]){scheme}(?![\w-])", text)}


def expect(good, sentence, numbers):
    print("ok " if good else "NOT", sentence, numbers)
    return good


def kepler():
    listed, (exact, fictitious) = told("kepler", "With a fixed step the ellipse precesses under every scheme except (.*?), "
                                                 "which is exact without perturbation. Schemes in a transformed time "
                                                 r"\((.*?)\) follow the exact ellipse; only their phase has an error. "
                                                 "Adaptive schemes of high order follow it nearly")
    schemes = listed["schemes"]
    keep = names(schemes, fictitious + " " + exact)
    good = expect(len(keep) == 3, "three schemes are named", keep)
    composed = {scheme for scheme in schemes if scheme.startswith("logh-")}
    good &= expect(len(composed) == 4 and "its compositions" in fictitious, "and the compositions of logh2", composed)
    keep |= composed
    orbits = {}
    for some in (schemes[:40], schemes[40:]):  # a list has at most 64 words
        orbits |= run("kepler", "scheme=" + ",".join(some), "eccentricity=0.6", "dt=pi/100", "until=20*pi")
    for scheme in schemes:
        turn = abs(orbits[scheme]["lrl_angle_max"])
        if re.match("(controlled|poincare)-.*[68]$", scheme):
            good &= expect(turn < 1e-8, f"kepler: the ellipse hardly precesses under {scheme}", turn)
            continue
        good &= expect((turn < ROUND_OFF) == (scheme in keep),
                       f"kepler: the ellipse {'stays' if scheme in keep else 'precesses'} under {scheme}", turn)
    perturbed = run("kepler", "scheme=" + ",".join(keep), "perturbation=0.01", "until=4*pi")
    for scheme in keep:
        good &= expect(abs(perturbed[scheme]["lrl_angle"]) > 0.01, f"kepler, perturbed: the ellipse precesses under {scheme}",
                       perturbed[scheme]["lrl_angle"])
    told("kepler", "RK4 starts out more accurate than the symplectic methods and loses, because its error grows")
    short, half, whole = (run("kepler", "scheme=rk4,verlet,rk4sym", f"until={orbits}*pi") for orbits in (4, 100, 200))
    for scheme in ("verlet", "rk4sym"):
        good &= expect(short["rk4"]["energy_error_max"] < short[scheme]["energy_error_max"],
                       f"kepler: RK4 is better than {scheme} at first", short[scheme]["energy_error_max"])
        good &= expect(whole[scheme]["energy_error_max"] < 1.05 * half[scheme]["energy_error_max"],
                       f"kepler: the error of {scheme} does not grow", whole[scheme]["energy_error_max"])
    good &= expect(whole["rk4"]["energy_error_max"] > 1.9 * half["rk4"]["energy_error_max"],
                   "kepler: that of RK4 does", whole["rk4"]["energy_error_max"])
    return good


def nls():
    told("nls", "the box keeps that of cell means and the split step that of the nodes, to round-off; the Euler box "
                "keeps neither")
    good = True
    kept = {"box": "charge_error", "split-step2": "node_charge_error", "euler-box": None}
    waves = {**run("nls", "scheme=box,split-step2"), **run("nls", "scheme=euler-box", "dt=0.004")}
    for scheme, own in kept.items():
        for key in ("charge_error", "node_charge_error"):
            error = waves[scheme][key + "_max"]
            good &= expect((error < ROUND_OFF) == (key == own),
                           f"nls: {scheme} {'keeps' if key == own else 'loses'} {key}", error)
    told("nls", "The energy is kept only nearly, and dips while the solitons meet")
    for scheme in ("box", "split-step2"):
        energy, largest = waves[scheme]["energy_error"], waves[scheme]["energy_error_max"]
        good &= expect(ROUND_OFF < energy and 3 * energy < largest < 0.5,
                       f"nls: the energy of {scheme} dips and comes back", (largest, energy))
    # measured as the scheme sees space, by Fourier modes, it is an error of time alone: of order 2
    errors = [run("nls", "scheme=split-step2", f"dt={dt}", "until=5")["split-step2"]["energy_error_max"]
              for dt in (0.005, 0.00125)]
    good &= expect(errors[0] < 1e-3 and 15 < errors[0] / errors[1] < 17, "nls: the energy of split-step2 falls with dt^2",
                   errors)
    return good


if not all([kepler(), nls()]):
    sys.exit("a scene says what is not so")
