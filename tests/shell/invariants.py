# SPDX-License-Identifier: GPL-3.0-or-later
"""Invariants and affine symmetries that `list SYSTEM --invariants` finds: as many as the literature has, and each of
them is checked here, with rates of its own and derivatives by complex steps.
usage: invariants.py GEOMINT"""
import cmath
import json
import re
import subprocess
import sys

GEOMINT = sys.argv[1]
STEP = 1e-30

henon_heiles = "(p1^2 + p2^2)/2 + (q1^2 + q2^2)/2 + C*q1^2*q2 + D*q2^3/3"
kepler = "(p1^2 + p2^2)/2 - 1/sqrt(q1^2 + q2^2) - perturbation/(q1^2 + q2^2)"
toda = "(p1^2 + p2^2 + p3^2)/2 + exp(q1 - q2) + exp(q2 - q3) + exp(q3 - q1)"
top = {"Lx": "-mgl*y", "Ly": "mgl*x", "Lz": "0", "x": "Ly*z - Lz*y", "y": "Lz*x - Lx*z", "z": "Lx*y - Ly*x"}
body = {"y1": "y2*y3*(1/I3 - 1/I2)", "y2": "y3*y1*(1/I1 - 1/I3)", "y3": "y1*y2*(1/I2 - 1/I1)"}
axes = {"I1": 2, "I2": 1, "I3": 2 / 3}
# name; H or rates; parameters; degree of the search; degrees of the generators; independent ones; symmetries.
# A name of a bundled system is listed as it is, others are typed.
TABLE = [
    ("rigid-body", body, axes, 4, [2, 2], 2, 1),
    ("rigid-body, typed", body, {"I1": 0.37, "I2": 1.13, "I3": 2.7}, 4, [2, 2], 2, 1),
    ("henon-heiles", henon_heiles, {"C": 1, "D": -1}, 4, [3], 1, 0),
    ("C = 1, D = 6", henon_heiles, {"C": 1, "D": 6}, 4, [3, 4], 2, 0),
    ("C = D = 1", henon_heiles, {"C": 1, "D": 1}, 4, [3, 3], 2, 0),
    ("C = 1, D = 5.9", henon_heiles, {"C": 1, "D": 5.9}, 4, [3], 1, 0),
    ("oscillators 1:2", "(p1^2 + q1^2)/2 + (p2^2 + 4*q2^2)/2", {}, 3, [2, 2, 3, 3], 3, 4),
    ("nearly 1:2", "(p1^2 + q1^2)/2 + (p2^2 + w*q2^2)/2", {"w": 4.0001}, 3, [2, 2], 2, 4),
    ("cyclic", {"x": "x*(y - z)", "y": "y*(z - x)", "z": "z*(x - y)"}, {}, 4, [1, 3], 2, 1),
    ("lorenz", {"x": "10*(y - x)", "y": "x*(28 - z) - y", "z": "x*y - 8/3*z"}, {}, 4, [], 0, 0),
    ("van der Pol", {"x": "y", "y": "(1 - x^2)*y - x"}, {}, 5, [], 0, 0),
    ("kepler", kepler, {"perturbation": 0}, 3, [2, 2, 3, 3], 3, 2),
    ("kepler", kepler, {"perturbation": 0}, 4, [2, 2, 3, 3], 3, 2),
    ("kepler with a power", kepler.replace("1/sqrt(q1^2 + q2^2)", "1/(q1^2 + q2^2)^(1/2)"), {"perturbation": 0}, 4,
     [2, 2, 3, 3], 3, 2),
    ("kepler by rates", dict(q1="p1", q2="p2", p1="-q1*(q1^2 + q2^2)^(-1.5)", p2="-q2/(q1^2 + q2^2)^1.5"), {}, 4,
     [2, 2, 3, 3], 3, 2),
    ("decimals", {"x": "0.1*y", "y": "-0.3*x"}, {}, 4, [2], 1, None),
    ("long decimals", {"x": "0.123457*y", "y": "-0.7*x"}, {}, 4, [2], 1, None),
    ("perturbed Kepler", kepler, {"perturbation": 0.01}, 4, [2, 2], 2, 1),
    ("pendulum", "p1^2/2 - cos(q1)", {}, 4, [2], 1, 0),
    ("cosh", "p1^2/2 + cosh(q1)", {}, 4, [2], 1, 0),
    ("relativistic", "sqrt(1 + p1^2) + q1^2/2", {}, 4, [2], 1, 0),
    ("Gauss's hill", "(p1^2 + p2^2)/2 + exp(-q1^2 - q2^2)", {}, 4, [2, 2], 2, 1),
    ("toda", toda, {}, 3, [1, 2, 3], 3, 3),
    ("toda", toda, {}, 4, [1, 2, 3], 3, 3),
    ("heavy-top", top, {"mgl": 1, "I1": 1}, 4, [1, 2, 2, 2], 4, 2),
    ("epidemic", {"s": "-s*i", "i": "s*i - i/2", "r": "i/2"}, {}, 4, [1], 1, None),
    ("hunters", {"x": "x*(2 - y)", "y": "y*(x - 1)"}, {}, 4, [], 0, 0),
    ("lotka-volterra", {"x": "x*(a - b*y)", "y": "y*(d*x - c)"}, {"a": 2, "b": 1, "c": 1, "d": 1}, 4, [1], 1, 0),
]
BUNDLED = {"rigid-body", "henon-heiles", "lorenz", "kepler", "heavy-top", "lotka-volterra"}

failures = []


def fail(text):
    failures.append(text)
    print(text)


def run(*words):
    return subprocess.run([GEOMINT, "list", *words], capture_output=True, text=True, check=False)


def value(formula, names, y, parameters):
    scope = {name: getattr(cmath, name) for name in ("sqrt", "exp", "log", "sin", "cos", "sinh", "cosh")}
    scope.update(parameters)
    scope.update(zip(names, y))
    return eval(formula.replace("^", "**"), {"__builtins__": {}}, scope)


def slope(function, y, direction):
    """The derivative of a function along a direction, at a real point."""
    return function([a + 1j * STEP * b for a, b in zip(y, direction)]).imag / STEP


def names_and_rates(system, parameters):
    """The components, and the rates as a function of a real point."""
    if isinstance(system, dict):
        return list(system), lambda y: [complex(value(f, system, y, parameters)).real for f in system.values()]
    half = len(set(re.findall(r"q\d", system)))
    names = [f"q{i + 1}" for i in range(half)] + [f"p{i + 1}" for i in range(half)]

    def rates(y):
        gradient = []
        for i in range(2 * half):
            unit = [float(k == i) for k in range(2 * half)]
            gradient.append(slope(lambda x: value(system, names, x, parameters), y, unit))
        return gradient[half:] + [-g for g in gradient[:half]]

    return names, rates


def words_of(name, system, parameters, names):
    if name in BUNDLED:
        return [name]
    formulas = [f"rate={n} = {f}" for n, f in system.items()] if isinstance(system, dict) else ["H=" + system]
    return ["system", *formulas, *[f"{k}={v}" for k, v in parameters.items()], *[f"{n}=.5" for n in names]]


def check_symmetry(symmetry, names, rates, points):
    """f'(y) Y - Y'(y) f = c f along the field Y, by differences of fourth order."""
    parts = dict(part.split(" = ", 1) for part in re.split(r", (?=\w+ = )", symmetry["formula"]))

    def field(y):
        return [complex(value(parts.get(n, "0"), names, y, {})).real for n in names]

    def along(function, y, direction, h=1e-3):
        ends = [function([a + k * h * b for a, b in zip(y, direction)]) for k in (-2, -1, 1, 2)]
        return [(a - 8 * b + 8 * c - d) / (12 * h) for a, b, c, d in zip(*ends)]

    worst = 0
    for y in points:
        f = rates(y)
        bracket = [a - b for a, b in zip(along(rates, y, field(y)), along(field, y, f))]
        size = 1 + max(map(abs, f))
        worst = max(worst, max(abs(b - symmetry["scaling"] * r) / size for b, r in zip(bracket, f)))
    return worst < 1e-6


def is_generated_by(symmetry, momentum_map, names, points):
    """The field is parallel to J grad G, G a formula."""
    parts = dict(part.split(" = ", 1) for part in re.split(r", (?=\w+ = )", symmetry["formula"]))
    half = len(names) // 2
    for y in points:
        unit = [[float(k == i) for k in range(2 * half)] for i in range(2 * half)]
        gradient = [slope(lambda x: complex(value(momentum_map, names, x, {})), y, u) for u in unit]
        motion = gradient[half:] + [-g for g in gradient[:half]]
        field = [complex(value(parts.get(n, "0"), names, y, {})).real for n in names]
        crossed = [abs(a * d - b * c) for a, b in zip(motion, field) for c, d in zip(motion, field)]
        if max(map(abs, motion)) < 1e-9 or max(crossed) > 1e-12:
            return False
    return True


# the symmetries with a momentum map
MAPS = {"oscillators 1:2": 2, "kepler": 1, "Gauss's hill": 1, "toda": 2, "perturbed Kepler": 1, "rigid-body": 0, "heavy-top": 0}

for name, system, parameters, degree, degrees, independent, symmetries in TABLE:
    names, rates = names_and_rates(system, parameters)
    out = run(*words_of(name, system, parameters, names), "--invariants", "--degree", str(degree), "--json")
    if out.returncode:
        fail(f"{name}: {out.stderr}")
        continue
    found = json.loads(out.stdout)
    invariants = found["invariants_found"]
    got = [sorted(i["degree"] for i in invariants), found["invariants_independent"], found["degree"]]
    if got != [degrees, independent, degree] or found["invariants_unwritten"]:
        fail(f"{name}: {got}, not {[degrees, independent, degree]}")
    if symmetries is not None and len(found["symmetries_found"]) != symmetries:
        fail(f"{name}: {len(found['symmetries_found'])} symmetries, not {symmetries}")
    points = [[0.3 + ((37 * (i + 1) * (k + 3)) % 101) / 80 for k in range(len(names))] for i in range(5)]

    def is_constant(formula):
        return all(
            abs(slope(lambda x: complex(value(formula, names, x, parameters)), y, rates(y))) < 1e-12 * (1 + max(map(abs, y))) ** 6
            for y in points
        )

    for invariant in invariants:
        formula = invariant["formula"]
        if invariant["proof"] != "exact" or not is_constant(formula):
            fail(f"{name}: {formula} is not constant")
        if is_constant(f"{formula} + 1e-6*({names[0]}*{names[-1]} + {names[0]}^3)"):
            fail(f"{name}: a wrong formula passes the check")
    for symmetry in found["symmetries_found"]:
        if not check_symmetry(symmetry, names, rates, points):
            fail(f"{name}: {symmetry['formula']} is no symmetry")
    formulas = {i["name"]: i["formula"] for i in invariants}
    maps = [s for s in found["symmetries_found"] if s["momentum_map"]]
    if len(maps) != MAPS.get(name, len(maps)):
        fail(f"{name}: {len(maps)} momentum maps, not {MAPS[name]}")
    for symmetry in maps:
        formula = formulas.get(symmetry["momentum_map"], symmetry["momentum_map"])
        if not is_constant(formula) or not is_generated_by(symmetry, formula, names, points):
            fail(f"{name}: {symmetry['momentum_map']} is not the momentum map of {symmetry['formula']}")
        if is_generated_by(symmetry, f"{formula} + 1e-6*{names[0]}*{names[-1]}", names, points):
            fail(f"{name}: a wrong momentum map passes the check")

# under a constant force the motion is the same elsewhere, but no momentum is conserved along the force
falling = run("system", "H=(p1^2 + p2^2)/2 + q1", "q1=1", "q2=0", "p1=0", "p2=1", "--invariants").stdout
if "q1 = 1 (scaling 0)" not in falling or "q2 = 1 (scaling 0, momentum map I1)" not in falling:
    fail(f"momentum maps of a fall: {falling}")

named = [i["name"] for i in json.loads(run("kepler", "--invariants", "--json").stdout)["invariants_found"]]
if named != ["H", "angular_momentum", "I1", "I2"]:
    fail(f"names of kepler: {named}")
lowered = json.loads(run("toda", "--invariants", "--json").stdout)
if lowered["degree"] != 3 or "degree 4 has more than 3000 candidates" not in run("toda", "--invariants").stdout:
    fail("toda, five particles: the degree is not lowered, or not said to be")
for system, degree, names in (("outer-planets", None, ["H", "momentum_x", "momentum_y", "momentum_z", "angular_momentum_x",
                                                       "angular_momentum_y", "angular_momentum_z"]),
                              ("lennard-jones", 1, ["momentum_x", "momentum_y", "H", "angular_momentum"]),
                              ("argon", 2, ["momentum_x", "momentum_y", "angular_momentum", "I1", "H"])):
    found = json.loads(run(system, "--invariants", "--json").stdout)
    if [i["name"] for i in found["invariants_found"]] != names:
        fail(f"{system}: {[i['name'] for i in found['invariants_found']]}, not {names}")
    if (found["not_searched"] is None) != (degree is not None) or degree and (
            found["degree"] != degree or found["invariants_independent"] != len(names) or found["invariants_found"][-1]["degree"]):
        fail(f"{system}: {found['not_searched']}, degree {found['degree']}, {found['invariants_independent']} independent")
wrong = run("system", "H=p^2/2+q^4", "q=1", "p=0", "invariant=E = p^2/2 + q^4 + 1e-9*q", "--invariants", "--degree", "1", "--json")
if wrong.returncode == 0 and "E" in [i["name"] for i in json.loads(wrong.stdout)["invariants_found"]]:
    fail(f"a declared invariant that is none: {wrong.stdout}")
irrational = run("system", "H=(p1^2+w^2*q1^2)/2+(p2^2+4*w^2*q2^2)/2", "w=sqrt(2)", "q1=1", "q2=1", "p1=1", "p2=1",
                 "--degree", "3", "--invariants")
if "and 3 whose coefficients are not short fractions" not in irrational.stdout:
    fail(f"irrational coefficients: {irrational.stdout}{irrational.stderr}")
for words, sentence in [
    (["kepler", "--invariants", "--degree", "9"], "--degree 9 is not a whole number from 1 to 8"),
    *[(["kepler", "--invariants", "--degree", degree], f"--degree {degree} is not a whole number from 1 to 8")
      for degree in ("0", "-1", "1.5", "x")],
    (["kepler", "--degree", "3"], "--degree is that of --invariants, which is missing"),
    (["rk4", "--invariants"], "--invariants are those of a system: list kepler --invariants"),
    (["wave", "--invariants"], "not searched: it is a field"),
    (["chain", "--invariants"], "not searched: it has constraints"),
    (["duffing", "--invariants"], "not searched: its rates depend on the time"),
    (["bowl", "--invariants"], "not searched: a Lagrangian has no formulas of its rates; its H has"),
    (["system", "H=p^2/2+abs(q)", "q=1", "p=0", "--invariants"], "not searched: it is not smooth"),
    (["kepler", "--invariants", "--latex"], "each is a list of its own"),
]:
    out = run(*words)
    if out.returncode != 1 or sentence not in out.stderr or out.stdout:
        fail(f"{' '.join(words)}: {out.returncode}, {out.stderr}")

# the errors of those without a name, beside the components of the Laplace-Runge-Lenz vector
row = json.loads(subprocess.run([GEOMINT, "run", "kepler", "scheme=rk4", "steps=100", "--json", "--state", "--measure",
                                 "I1_error,I2_error,I3_error"], capture_output=True, text=True, check=True).stdout)
x, y, u, v = row["state"]
r = (x * x + y * y) ** 0.5
wanted = [abs(y / r + x * u * v - y * u * u), abs((x / r - x * v * v + y * u * v) / 0.5 + 1)]
got = [row["observables"][f"I{k}_error"] for k in (1, 2, 3)]
if any(abs(a - b) > 1e-14 for a, b in zip(wanted, got)) or got[2] is not None or max(wanted) < 1e-6:
    fail(f"errors of I1, I2, I3: {got}, not {wanted}")

# numbers that a prime field would take for short ones: x^2 + 2561*y^2 is no invariant
for factor in "(1 + 1e-15)", "2^61":
    found = json.loads(run("system", f"rate=x = {factor}*y, y = -x", "x=1", "y=1", "--invariants", "--json").stdout)
    got = [found[key] for key in ("invariants_found", "invariants_unwritten", "symmetries_unwritten")]
    if got != [[], 1, 1]:
        fail(f"x' = {factor} y: {got}")

print(f"{len(TABLE)} systems")
sys.exit(1 if failures else 0)
