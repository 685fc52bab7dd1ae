# SPDX-License-Identifier: GPL-3.0-or-later
# Splittings by parts: errors against an exact motion, the orders of rows in h and in a small part, computed here with
# 50 digits from their files, and what is refused.
# Usage: splittings.py GEOMINT SOURCE_ROOT
import json
import math
import re
import subprocess
import sys
import tempfile
from decimal import Decimal, getcontext

GEOMINT, ROOT = sys.argv[1:3]
getcontext().prec = 50
failures = 0


def check(good, text):
    global failures
    if not good:
        failures += 1
        print("FAILED", text)


def run(*words):
    done = subprocess.run([GEOMINT, "run", *words, "--json", "--state"], capture_output=True, text=True)
    if done.returncode:
        return done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def state(*words):
    lanes = run(*words)
    if isinstance(lanes, str):
        check(False, " ".join(words) + ": " + lanes)
        return [0] * 4
    return lanes[-1]["state"]


def distance(one, other):
    return max(abs(a - b) for a, b in zip(one, other))


SYSTEM = """geomint: 1
title: a wave and a spring
coordinates: a, b
momenta: u, v
let: A = (u^2 + v^2)/2 + b^2 + .15*(a - b)^2
part: B = -cos(a), C = (u^2 + v^2)/2, D = b^2 + .15*(a - b)^2, E = u^3/3 + a^3/3
H: A - cos(a)
start: a = 1.1
start: b = -.4
start: u = .2
start: v = .5
"""
RATES = """geomint: 1
title: a driven wave, as rates
components: x, v
part: A; x = v
part: B; v = -sin(x) + .3*cos(t)
rate: x = v
rate: v = -sin(x) + .3*cos(t)
start: x = 1
start: v = .2
"""
RING = ["system", "H=(p1^2 + p2^2)/2 - q1*q2 + q1^4 + q2^4", "part=A = (p1^2 + p2^2)/2 - q1*q2, B = q1^4 + q2^4",
        "q1=.5", "q2=.2", "p1=.1", "p2=0"]
PENDULUM = ["system", "H=p^2/2 - cos(q)", "part=A = p^2/2, B = -cos(q)", "q=1.1", "p=.2", "until=8"]


def coefficients(name):
    """drifts, kicks and the corrector of a file of share/schemes"""
    lines = [line.split(": ", 1) for line in open(f"{ROOT}/share/schemes/{name}.scheme") if ": " in line]
    names = {"sqrt": Decimal.sqrt, "D": Decimal}

    def value(text):
        return eval(re.sub(r"(?<![\w.])(\d*\.?\d+)", r'D("\1")', text), names)

    for word, text in lines:
        if word == "let":
            left, right = text.split("=", 1)
            names[left.strip()] = value(right.strip())
    rows = {word: [value(item) for item in text.strip().split(", ")] for word, text in lines
            if word in ("drifts", "kicks", "corrector")}
    return rows["drifts"], rows["kicks"], rows.get("corrector", [Decimal(0)])[0]


EPS = 4  # powers of eps that are kept


def times(x, y):
    out = [Decimal(0)] * EPS
    for i in range(EPS):
        for k in range(EPS - i):
            out[i + k] += x[i] * y[k]
    return out


def sine_cosine(x):
    s = c = Decimal(0)
    term, k = Decimal(1), 0
    while abs(term) > Decimal(10) ** -55:
        if k % 2 == 0:
            c += term if k % 4 == 0 else -term
        else:
            s += term if k % 4 == 1 else -term
        k += 1
        term *= x / k
    return s, c


def flow(name, steps, correct=Decimal(1)):
    """(p^2 + q^2)/2 + eps (q^4/4 + q^3/3) to t = 1, as a polynomial in eps; A is the first part"""
    drifts, kicks, corrector = coefficients(name)
    h = Decimal(1) / steps
    q, p = [Decimal("0.8")] + [Decimal(0)] * (EPS - 1), [Decimal("0.3")] + [Decimal(0)] * (EPS - 1)
    turns = [sine_cosine(a * h) for a in drifts]

    def kick(p, q, factor):
        slope = [a + b for a, b in zip(times(q, times(q, q)), times(q, q))]
        return [p[i] - factor * (slope[i - 1] if i else 0) for i in range(EPS)]

    def end(p, q):
        square = times(q, q)
        slope = [a + b for a, b in zip(times(square, q), square)]
        curvature = [3 * a + 2 * b for a, b in zip(square, q)]
        both = times(slope, curvature)
        return [p[i] + correct * corrector * h ** 3 * (both[i - 2] if i > 1 else 0) for i in range(EPS)]

    for _ in range(steps):
        p = end(p, q)
        for i, (s, c) in enumerate(turns):
            q, p = [c * x + s * y for x, y in zip(q, p)], [c * y - s * x for x, y in zip(q, p)]
            if i < len(kicks):
                p = kick(p, q, kicks[i] * h)
        p = end(p, q)
    return q


def orders(name, correct=Decimal(1)):
    """orders in h of the errors of size eps, eps^2, eps^3"""
    values = [flow(name, steps, correct) for steps in (16, 32, 64)]
    return [float(((values[0][k] - values[1][k]) / (values[1][k] - values[2][k])).copy_abs().ln() / Decimal(2).ln())
            for k in (1, 2, 3)]


def rows_have_their_orders():
    for name, wanted in {"saba2": (4, 2, 2), "saba3": (6, 2, 2), "saba4": (8, 2, 2), "sabac2": (4, 4, 4),
                         "sabac3": (6, 4, 4), "sabac4": (8, 4, 4), "aba104": (10, 4, 4), "aba864": (8, 6, 4),
                         "aba1064": (10, 6, 4)}.items():
        drifts, kicks, _ = coefficients(name)
        at, places = Decimal(0), []
        for a in drifts[:-1]:
            at += a
            places.append(at)
        for k in range(wanted[0]):
            defect = abs(sum(b * c ** k for b, c in zip(kicks, places)) - 1 / Decimal(k + 1))
            check(defect < Decimal("1e-28"), f"{name}: sum b c^{k} is off by {defect:.1e}")
        found = orders(name)
        check(all(abs(a - b) < .06 for a, b in zip(found, wanted)), f"{name} has the orders {found}, not {wanted}")
    wrong = orders("sabac2", Decimal("1.05"))
    check(wrong[1] < 2.5, f"a wrong corrector has the orders {wrong}")


def errors_are_those_of_the_table(path):
    exact = state(path, "scheme=gauss8", "dt=.005", "until=10")
    for scheme, error in {"saba2": 1.23e-2, "saba4": 3.75e-3, "aba104": 3.37e-6, "aba864": 2.18e-6,
                          "aba1064": 1.77e-6}.items():
        found = distance(state(path, f"scheme={scheme}(A, B)", "dt=.5", "until=10"), exact)
        check(abs(found / error - 1) < .01, f"{scheme}(A, B) has the error {found}, not {error}")


def correctors_raise_the_order():
    exact = state(*PENDULUM, "scheme=gauss8", "dt=.005")
    for scheme, order in {"saba2(A, B)": 2, "sabac2(A, B)": 4, "sabac3": 4, "sabac4(kinetic, potential)": 4,
                          "splitting(a, 1 - 2*a, a; 1/2, 1/2; let: a = (3 - sqrt(3))/6; corrector: (2 - sqrt(3))/20)":
                          2}.items():
        one, other = (distance(state(*PENDULUM, "scheme=" + scheme, f"dt={dt}"), exact) for dt in (.1, .05))
        check(abs((one / other) - 2 ** order) < .08 * 2 ** order, f"{scheme} has the ratio {one / other}")


def words_agree(path, rates):
    def same(one, other, to=1e-13, system=path):
        words = [system] if isinstance(system, str) else system
        off = distance(state(*words, "scheme=" + one, "dt=.1", "steps=40"),
                       state(*words, "scheme=" + other, "dt=.1", "steps=40"))
        check(off <= to, f"{one} and {other} differ by {off}")

    same("strang(kinetic, potential)", "verlet-position", 0)
    same("strang(potential, kinetic)", "verlet", 0)
    same("strang(A, B)", "split(A, B; 1/2, 1, 1/2)")
    same("strang(A, B)", "composition(lie(A, B), adjoint(lie(A, B)); 1/2, 1/2)")
    same("strang(A, B)", "composition(strang(A, B); 1)")
    same("strang(linear, rest)", "strang(A, B by gauss8)", 1e-9, RING)
    same("strang(A, B)", "strang(A by gauss8, B)", 1e-9)
    same("verlet(A, B)", "strang(B, A)")
    same("strang(pieces)", "volume-splitting2", 0)
    same("lie(pieces)", "volume-splitting1", 0)
    same("strang(interaction, kepler)", "wisdom-holman2", 0, ["kepler", "perturbation=.05"])
    same("strang(rest, linear)", "impulse2", 0, "stiff")
    same("strang(A, B)", "verlet-position", 1e-15, rates)
    for scheme in ("lie(A, B)", "lie(C, D, B)", "lie(A by explicit-euler, B)", "aba864(A, B)", "strang(C, B, D)"):
        there = state(path, f"scheme={scheme}", "dt=.1", "steps=1")
        again = state(path, f"scheme=composition({scheme}, adjoint({scheme}), {scheme}; .7, -.7, 1)", "dt=.1",
                      "steps=1")
        check(distance(there, again) < 1e-13, f"the adjoint of {scheme} does not undo it")


def members_and_engines_agree():
    words = ["henon-heiles", "scheme=strang(linear, rest)", "dt=.1", "steps=20"]
    interpreted = state(*words, "--engine", "interpreted")
    check(distance(interpreted, state(*words)) == 0, "engines differ")
    alone = state(*words)
    several = run(*words, "members=5")
    check(not isinstance(several, str) and len(several[-1]["state"]) == 5 * len(alone), "members do not run")


def bodies(**changes):
    """three bodies in space, whose components are mixed and whose heaviest is the second"""
    start = {"k": 1, "x1": 1, "y1": .1, "z1": -.2, "x2": .1, "y2": 0, "z2": .1, "x3": -2, "y3": .5, "z3": .3,
             "p_x1": -.05, "p_y1": .35, "p_z1": .02, "p_x2": .1, "p_y2": 0, "p_z2": .1, "p_x3": .03, "p_y3": -.13,
             "p_z3": .01, **changes}
    return ["system", "coordinates=x1,z1,x2,x3,z2,z3,y1,y2,y3",
            "H=(p_x1^2+p_y1^2+p_z1^2)/2/.2+(p_x2^2+p_y2^2+p_z2^2)/2/3+(p_x3^2+p_y3^2+p_z3^2)/2/.1"
            "-.6*k/sqrt((x1-x2)^2+(y1-y2)^2+(z1-z2)^2)-.02*k/((x1-x3)^2+(y1-y3)^2+(z1-z3)^2)^.5"
            "-.3*k/sqrt((x2-x3)^2+(y2-y3)^2+(z2-z3)^2)", *(f"{name}={value}" for name, value in start.items())]


def bodies_move_in_jacobi_coordinates():
    """Steps alone and in a block; flows of the program and of formulas."""
    for words in (["outer-planets", "dt=100", "steps=40"], [*bodies(), "dt=.02", "steps=60"],
                  [*bodies(k=2), "dt=.005", "steps=60"]):
        for scheme in ("strang(kepler, interaction)", "wisdom-holman2", "aba864(kepler, interaction)"):
            whole = state(*words, "scheme=" + scheme)
            lanes = run(*words, "scheme=" + scheme, "--max")
            alone = lanes[-1]["state"] if not isinstance(lanes, str) else [0] * len(whole)
            check(distance(whole, alone) < 2e-13, f"{scheme} step by step: {distance(whole, alone)}")
        by_flow = state(*words, "scheme=strang(kepler, interaction)")
        same = ["strang(kepler by gauss8, interaction by gauss8)", "strang(kepler, interaction by gauss8)"]
        for scheme in same if words[0] != "outer-planets" else same[1:]:
            by_formula = state(*words, "scheme=" + scheme)
            check(distance(by_flow, by_formula) < 3e-13, f"{scheme}: {distance(by_flow, by_formula)}")
        check(distance(state(*words, "scheme=strang(interaction, kepler)"),
                       state(*words, "scheme=wisdom-holman2")) == 0, "wisdom-holman2 is kick first")
    words = [*bodies(), "dt=.02", "steps=60", "scheme=saba4(kepler, interaction)"]
    one, several = state(*words), run(*words, "members=7", "spread=1e-9")
    n = len(one)
    check(not isinstance(several, str) and max(
        abs(several[-1]["state"][c * 7 + l] - one[c]) for c in range(n) for l in range(7)) < 1e-6, f"members: {several}")
    exact = state(*bodies(), "dt=.005", "until=1.2", "scheme=kahan-li8")
    errors = [distance(state(*bodies(), f"dt={dt}", "until=1.2", "scheme=wisdom-holman2"), exact) for dt in (.02, .01)]
    check(abs(errors[0] / errors[1] - 4) < .1, f"order of wisdom-holman2: {errors}")
    # one body leaves on a hyperbola
    energies = run(*bodies(p_y1=3, p_x1=2), "scheme=saba2(kepler, interaction)", "dt=.02", "steps=200", "--max")
    check(not isinstance(energies, str) and abs(energies[-1]["observables"]["energy_error_max"]) < 1e-4,
          f"a hyperbola: {energies}")
    # a typed part that is Kepler's motion of a body, in a plane and in space, and what is none
    for momenta, place, start in (("p_x^2+p_y^2+p_z^2", "x^2+y^2+z^2", ["x=1", "y=.2", "z=.3", "p_x=.1", "p_y=2", "p_z=.4"]),
                                  ("p_x^2+p_y^2", "x^2+y^2", ["x=1", "y=.2", "p_x=.1", "p_y=2"])):
        body = ["system", f"H=({momenta})/4-k/sqrt({place})+.05*x^2*y", f"part=A = ({momenta})/4-k/sqrt({place}), B = .05*x^2*y",
                "k=3", "dt=.02", "steps=60", *start,
                *(f"{word}={','.join(k + c for c in 'xyz' if c + '=' in ''.join(start))}" for word, k in (("coordinates", ""), ("momenta", "p_")))]
        check(distance(state(*body, "scheme=strang(A, B)"), state(*body, "scheme=strang(A by gauss8, B)")) < 1e-12,
              f"a typed part of Kepler's motion: {state(*body, 'scheme=strang(A, B)')}")
    for part in ("(p_x^2+2*p_y^2)/4-3/sqrt(x^2+y^2)", "(p_x^2+p_y^2)/4-3/sqrt(x^2+y^2+1e-9)", "(p_x^2+p_y^2)/4+3/sqrt(x^2+y^2)",
                 "(p_x^2+p_y^2)/4-3/(x^2+y^2)"):
        refused = run("system", f"H={part}+x", f"part=A = {part}, B = x", "coordinates=x,y", "momenta=p_x,p_y", "x=1", "y=.2", "p_x=.1", "p_y=2", "steps=1", "scheme=strang(A, B)")
        check(isinstance(refused, str) and "a known flow of A" in refused, f"{part} is none of Kepler's motions: {refused}")
    for k, scheme, told in ((-1, "saba2(kepler, interaction)", "it needs a part kepler"),
                            (1, "sabac2(kepler, interaction)", "for its corrector"),
                            (1, "saba2(kepler, potential)", "parts that sum to the rates"),
                            (1, "saba2(keplar, interaction)", "did you mean kepler")):
        refused = run(*bodies(k=k), "scheme=" + scheme)
        check(isinstance(refused, str) and told in refused, f"{k} {scheme}: {refused}")


def faults_are_told(path):
    for scheme, words in {
            "strang(A)": "column 8: strang splits into 2 parts or more",
            "aba104(A, B, C)": "column 8: aba104 splits into 2 parts, not into 3",
            "split(A, B; .5, 1, .4)": "column 13: the steps of A sum to 0.9",
            "strang(A, A)": "column 11: the part A is given twice",
            "rk4(A, B)": "column 1: rk4 is not a splitting",
            "strang(A, C)": "A + C is not H, H - A - C = ",
            "strang(A, kinetik)": "a part kinetik (column 11); did you mean kinetic",
            "strang(A, kinetic)": "the rate of a has, beside A + kinetic, -u (-0.2 at the start)",
            "strang(, kinetic)": "a part has no name",
            "strang(kinetic, )": "a part has no name",
            "composition(rk4; 0/0, 1)": "this coefficient is not a number",
            "strang(E, B)": "a known flow of E (column 8), which is neither",
            "strang(A by verlet, B)": "a scheme for any field, of at most 64 components, not A by verlet",
            "composition(strang(A, C); 1)": "A + C is not H"}.items():
        told = run(path, "scheme=" + scheme, "until=1")
        check(isinstance(told, str) and words in told, f"{scheme}: {told}")
    told = run(*PENDULUM[:2], "part=A = p^2/2 - cos(q), B = 0*q", *PENDULUM[3:], "scheme=sabac2(B, A)")
    check(isinstance(told, str) and ("for its corrector" in told or "a known flow" in told), f"corrector: {told}")


def parts_are_typed():
    # A part that is typed after the name of a scene is a line of its file.
    part = "A = (p1^2 + p2^2)/2, B = -1/r - perturbation/r^2"
    source = subprocess.run([GEOMINT, "list", "kepler", "--source"], capture_output=True, text=True).stdout
    with tempfile.NamedTemporaryFile("w", suffix=".system") as file:
        file.write(f"{source}part: {part}\n")
        file.flush()
        words = ("eccentricity=.3", "steps=40", "scheme=aba104(A, B)")
        check(distance(state("kepler", "part=" + part, *words), state(file.name, *words)) == 0,
              "a part typed after a scene is not that of a file")
    check(distance(state("kepler", "part=" + part, "steps=40", "scheme=strang(B, A)"),
                   state("kepler", "steps=40", "scheme=verlet")) < 1e-13, "strang(B, A) of kepler is not verlet")
    for words, sentence in ((("run", "kepler", "part=A = (p1^2 + p2^2)/2, B = -2/r", "scheme=strang(A, B)", "steps=1"),
                             "A + B is not H"),
                            (("list", "kepler", "part=A = p1^2/2, B = -1/"), "in part=, column 20"),
                            (("run", "cavity", "part=A = 1", "steps=1"), "part: is a line of a system's file, not a key"),
                            (("list", "kdv", "H=u"), 'no parameter "H"'),
                            (("run", "lorenz", "scheme=sabac2(linear, rest)", "steps=1"), "for its corrector"),
                            (("run", "abc", "scheme=strang(linear, rest)", "steps=1"), "this system does not have it"),
                            # its coefficients are not those of a splitting into T and V
                            (("backward", "henon-heiles", "scheme=strang(linear, rest)", "until=1"), "is unknown")):
        refused = subprocess.run([GEOMINT, *words], capture_output=True, text=True)
        check(refused.returncode == 1 and sentence in refused.stderr, f"{words}: {refused.stderr}")
    pendulum = ("system", "rate=x = v, v = -sin(x)", "x=1", "v=0.2", "steps=20")
    check(distance(state(*pendulum, "part=A; x = v", "part=B; v = -sin(x)", "scheme=strang(B, A)"),
                   state(*pendulum, "scheme=verlet")) < 1e-14, "parts of typed rates")
    listed = subprocess.run([GEOMINT, "list", "kepler", "part=" + part, "--long"], capture_output=True, text=True).stdout
    check(re.search(r"^  A +.*\n  B ", listed, re.M), "list kepler part=... has no parts A and B")


def time_moves_with_the_first_part_without_it():
    # Kick, drift, kick, whose kicks move the time, of H = p^2/2 (1 + sin(t)/2) + q^2/2; a splitting into T and V would
    # move it with the drift.
    q, p, h = 1., 0., .1
    for k in range(20):
        p -= h/2*q
        q += h*(1 + math.sin((k + .5)*h)/2)*p
        p -= h/2*q
    driven = ("system", "H=p^2/2*(1 + sin(t)/2) + q^2/2", "q=1", "p=0", "dt=.1", "steps=20")
    moved = state(*driven, "part=A = p^2/2*(1 + sin(t)/2), B = q^2/2", "scheme=strang(B, A)")
    check(distance(moved[:2], [q, p]) < 1e-14, f"strang(B, A) with t in A: {moved}")
    for words in ("verlet", "yoshida4", "symplectic-euler", "blanes-moan-nystrom6", "sabac2", "strang(kinetic, potential)"):
        told = run(*driven, "scheme=" + words)
        check(isinstance(told, str) and "it needs a" in told, f"{words} takes t in T: {told}")
    listed = subprocess.run([GEOMINT, "list", *driven[:4], "--long"], capture_output=True, text=True).stdout
    check(re.search("separable +no .* holds momenta and the time", listed), "t in T is said to separate")
    for system in (("rate=x = y, y = -x^3 + cos(t)/2", "x=1", "y=0"), ("H=p^2/2 + q^4/4 + q*cos(t)", "q=1", "p=.2")):
        near, far = (distance(state("system", *system, f"dt={h}", "until=2", "scheme=sabac2")[:2],
                              state("system", *system, "dt=.01", "until=2", "scheme=gauss8")[:2]) for h in (.05, .1))
        check(3.8 < math.log2(far/near) < 4.2, f"sabac2 with t in V: {far} {near}")
    told = run("system", "H=p^2/2 + q^2/2", "part=A = p^2/2*(1 + sin(t)), B = q^2/2 - p^2/2*sin(t)", "q=1", "p=0",
               "scheme=strang(A, B)", "steps=1")
    check("a part holds the time" in told, f"two parts hold t: {told}")
    told = run("system", "H=p^2/2 + q^2/2", "part=H = p^2/2", "q=1", "p=0", "steps=1")
    check("the name H is reserved" in told, f"a part H: {told}")


def certify(*words):
    done = subprocess.run([GEOMINT, "certify", *words], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def names_mean_parts_of_the_system():
    system = ("system", "H=p^2/2 + q^2/2 - q^4/9", "q=1", "p=0", "dt=.5", "until=2")
    named, lettered = (system + (f"part={a} = p^2/2 + q^2/2, {b} = -q^4/9",)
                       for a, b in (("kinetic", "potential"), ("A", "B")))
    for scheme in ("strang({}, {})", "lie({1}, {0})", "composition(strang({}, {}), lie({}, {}); 1/2, 1/2)", "adjoint(lie({}, {}))",
                   "projected(adjoint(composition(lie({}, {}), strang({}, {}); 1/2, 1/2)); H)"):
        def place(a, b):
            return scheme.format(a, b, a, b)
        off = distance(state(*named, "scheme=" + place("kinetic", "potential")),
                       state(*lettered, "scheme=" + place("A", "B")))
        check(off == 0, f"{scheme} of parts named kinetic and potential is off by {off}")
    own = distance(state(*lettered, "scheme=strang(kinetic, potential)"), state(*lettered, "scheme=verlet-position"))
    check(own == 0, f"the program's kinetic and potential are off by {own}")
    for word, row in ("adjoint(lie(kinetic, potential))", "symplectic-euler"), ("projected(strang(potential, kinetic); H)", "projected(verlet; H)"):
        own = distance(state(*lettered, "scheme=" + word), state(*lettered, "scheme=" + row))
        check(own == 0, f"{word} is off {row} by {own}")


def an_adjoint_has_the_properties_of_its_base():
    for base, family in ("aba864(kinetic, potential)", "splitting"), ("aba864(kepler, interaction)", "splitting by parts"), \
            ("composition(lie(kinetic, potential), rk4; 1/2, 1/2)", "composition"):
        told = [json.loads(certify(word, "--on", "outer-planets", "--json")[1]) for word in (base, f"adjoint({base})")]
        claims = [{key for key, value in one["properties"].items() if value["claimed"]} for one in told]
        check(all(one["family"] == family and one["holds"] for one in told) and told[0]["order"] == told[1]["order"] and
              claims[0] == claims[1], f"adjoint({base}): {told}")


HIDDEN = ("system", "rate=x = y*z", "rate=y = -2*x*z", "rate=z = x*y", "x=1", "y=.5", "z=.3", "dt=.1")


HARMONIC = ("system", "H=p^2/2 + q^2/2", "q=1", "p=0", "dt=.1")


def certificates_are_not_passed_by_nothing():
    for words, status, found in (
            (("relaxed(rk4; L; claims: keeps energy)", "--on", "kepler"), 4, "conserves energy               BROKEN"),
            (("composition(rk4; 1/2, 1/2; claims: keeps energy)", "--on", "kepler", "dt=.02"), 4,
             "conserves energy               BROKEN"),
            (("relaxed(explicit-euler; L; claims: keeps energy)", "--on", "kepler"), 0,
             "conserves energy               not measured"),
            (("relaxed(implicit-euler; I1)",), 0, "measured nowhere: with every step the run fails before its end"),
            (("relaxed(implicit-euler; I1)", "--on", "kepler"), 0, "with every step from 8 dt down the run fails before its end"),
            (("projected(rk4; H, L)", "--on", "kepler"), 0, "conserves energy               holds"),
            (("midpoint", "--on", "system", "H=p^2/2e-6 + 1e-6*q^4/4", "q=1", "p=1e-4", "dt=.1"), 0,
             "conserves quadratic invariants not measured"),
            (("composition(rk4; 1; claims: keeps quadratic invariants)", "--on", *HIDDEN), 4,
             "conserves quadratic invariants BROKEN"), # by those that are found
            (("composition(rk4; 1; claims: keeps quadratic invariants)", "--on", *HARMONIC), 4,
             "(system); refuted by theory"),
            (("composition(rk4, avf2; 1/2, 1/2; claims: keeps quadratic invariants)", "--on", *HARMONIC), 4,
             "conserves quadratic invariants BROKEN"), # by 4000 steps
            (("composition(gauss4, avf2; 1/2, 1/2; claims: keeps quadratic invariants)", "--on", *HARMONIC), 0,
             "conserves quadratic invariants holds"),
            (("composition(gauss4; 1; claims: symmetric keeps quadratic invariants keeps bilinear invariants reversible)",), 0,
             "conserves quadratic invariants holds"),
            (("composition(suzuki-umeno8; 1; claims: keeps quadratic invariants)",), 4, "(kepler); refuted by theory"),
            (("composition(gauss8; 1; claims: keeps energy)",), 4, "refuted by theory"),
            (("midpoint", "--on", *HIDDEN), 0, "conserves quadratic invariants holds"),
            (("composition(gauss4; 1; claims: keeps energy)", "--on", "henon-heiles"), 4, "conserves energy               BROKEN"),
            (("strang(kepler, interaction)",), 0, "order 2, measured 2.000 (kepler-perturbed)"),
            (("aba864(D by explicit-euler, E)",), 0, "order 1,")):
        code, text = certify(*words)
        check(code == status and found in text, f"{words} ends with {code}: {text}")


def false_orders_are_refuted():
    with tempfile.NamedTemporaryFile("w", suffix=".system") as file:
        file.write("coordinates: q\nH: p_q^2/2 + q^2/2 - q^4/9\npart: A = p_q^2/2 + q^2/2\npart: B = -q^4/9\n"
                   "start: q = 1, p_q = 0\ndt: 0.1\n")
        file.flush()
        for scheme in ("aba1064(A, B; order: 10)", "aba1064(B, A; order: 8)", "pefrl4(A, B; order: 6)",
                       "suzuki4(A, B; order: 6)", "mclachlan4(A, B; order: 5)", "yoshida6(A, B; order: 8)"):
            code, text = certify(scheme, "--on", file.name)
            check(code == 4 and "BROKEN" in text, f"{scheme} ends with {code}: {text}")
        for scheme, order in (("aba1064(B, A)", 4), ("aba1064(A, B)", 4), ("strang(A, B)", 2)):
            code, text = certify(scheme, "--on", file.name)
            found = re.search(r"order \d+, measured ([\d.]+)", text)
            check(code == 0 and found and abs(float(found[1]) - order) < 0.1, f"{scheme} ends with {code}: {text}")


def best_adds_schemes_of_the_order_or_says_so():
    for scheme, first, others, none in (
            ("degenerate-midpoint2", "lotka-volterra-L", (), True), ("suzuki-umeno8", "kepler", (), False),
            ("composition(midpoint; 1/2, 1/2)", "kepler", ("midpoint", "trapezoidal"), False),
            ("rk2", "kepler", ("rk4",), False), ("rk4", "kepler", (), True)):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([GEOMINT, "work-precision", first, f"scheme={scheme},best", "until=1", "--out", folder],
                                  capture_output=True, text=True)
        lines = [line.split() for line in done.stdout.splitlines()]
        names = [line[0] for line in lines[3:] if len(line) == 8]
        check(done.returncode == 0 and ("best adds no scheme" in done.stdout) == none, f"best of {scheme}: {done}")
        check("explicit-euler" not in names and all(o in names for o in others), f"best of {scheme} adds {names}")


def work_of_parts_is_counted():
    system = ("system", "H=p^2/2 + q^2/2 - q^4/9", "part=A = p^2/2 + q^2/2, B = -q^4/9", "q=1", "p=0", "dt=.5", "steps=10")
    for scheme, count in (("lie(A by rk4, B)", 50), ("lie(A, B by rk4)", 50), ("lie(A by rk4, B by rk4)", 80),
                          ("strang(A, B)", 10), ("projected(lie(A by rk4, B); H)", 50),
                          ("composition(lie(A by rk4, B), lie(A, B); 1/2, 1/2)", 60)):
        told = run(*system, "scheme=" + scheme)
        found = told if isinstance(told, str) else told[0]["evaluations"]
        check(found == count, f"{scheme} has {found} evaluations, not {count}")


def adjoints_and_compositions_have_the_claims_of_their_bases(folder):
    for name, lines in (("told", "split\nparts: A, B\nsteps: 1/2, 1, 1/2\norder: 7\nclaims: symplectic keeps energy"),
                        ("untold", "split\nparts: A, B\nsteps: 1/2, 1, 1/2"),
                        ("drifts", "splitting\ndrifts: 1/2, 1/2\nkicks: 1\norder: 5\n"
                                   "claims: keeps energy keeps linear invariants")):
        with open(f"{folder}/{name}.scheme", "w") as file:
            file.write(f"geomint: 1\ntitle: {name}\nkind: {lines}\n")
    for scheme, claims, order in (
            ("adjoint(boris2)", "=V", 2), ("adjoint(avf2)", "=RHL", 2), ("adjoint(rattle2)", "S=RNKT", 2),
            ("adjoint(degenerate-midpoint2)", "S=", 2), ("composition(avf2; 1/2, 1/2)", "=RHL", 2),
            ("composition(boris2; let: g = 1/(2 - 2^(1/3)); g, 1 - 2*g, g)", "=V", 4),
            ("composition(rattle2; 1/3, 2/3)", "SNKT", 2), ("composition(degenerate-midpoint2; 1/2, 1/2)", "S=", 2),
            ("composition(lie(D by rk4, E), adjoint(lie(D by rk4, E)); 1/2, 1/2)", "=", 2),
            ("composition(lie(D by gauss4, E), adjoint(lie(D by gauss4, E)); 1/2, 1/2)", "S=", 2),
            ("composition(lie(D by rk4, E), adjoint(lie(D by rk2, E)); 1/2, 1/2)", "", 1),
            # the order of the list, and at most that of the schemes of its parts; of what is symmetric it is even
            ("strang(D by rk4, E)", "=", 2), ("strang(D, E by explicit-euler)", "=", 2), ("strang(D by rk4, E, F)", "=", 2),
            ("lie(D by rk4, E)", "", 1), ("split(D by rk4, E; 1/2, 1, 1/2)", "", 2),
            ("split(D by explicit-euler, E; 1/2, 1, 1/2)", "", 1), ("aba1064(D by rk2, E)", "", 2),
            ("aba1064(D by gauss4, E)", "S=", 4), ("composition(strang(D, E); .3, .7)", "S", 2),
            ("composition(strang(D by rk4, E); let: g = 1/(2 - 2^(1/3)); g, 1 - 2*g, g)", "=", 4),
            # a file's own order and claims, where it is called with parts
            (f"{folder}/told.scheme(D, E)", "SH", 7), (f"{folder}/told.scheme(kinetic, potential)", "SH", 7),
            (f"{folder}/told.scheme(D by rk4, E)", "", 4), (f"{folder}/drifts.scheme(D, E)", "H", 5),
            (f"{folder}/drifts.scheme(kinetic, potential)", "HL", 5), (f"{folder}/untold.scheme(D, E)", "S=", 2)):
        done = subprocess.run([GEOMINT, "list", scheme, "--json"], capture_output=True, text=True)
        row = json.loads(done.stdout)
        found = set(row["claims"])
        keys = {"S": "symplectic", "=": "symmetric", "R": "reversible", "H": "keeps energy", "L": "keeps linear invariants",
                "V": "keeps volume", "N": "keeps momentum maps", "K": "keeps constraints", "T": "keeps hidden constraints"}
        check(found == {keys[letter] for letter in claims} and row["order"] == order, f"{scheme}: {row['order']} {found}")
    for scheme in ("adjoint(boris2)", "adjoint(volume-splitting2)", "composition(avf2; 1/2, 1/2)",
                   "composition(rattle2; 1/2, 1/2)"):
        code, text = certify(scheme)
        check(code == 0 and "BROKEN" not in text and "symmetric                      holds" in text, f"{scheme}: {text}")
    code, text = certify("composition(explicit-euler, avf2; 1/2, 1/2; claims: keeps energy)")
    check(code == 4 and "conserves energy               BROKEN" in text, f"a wrong claim is not refuted: {text}")
    code, text = certify(f"{folder}/told.scheme(A, B)", "--on", "system", "H=p^2/2 - cos(q)", "q=1", "p=0", "dt=.1",
                         "part=A = p^2/2, B = -cos(q)")
    check(code == 4 and "order 7, measured 2.000 (system)  BROKEN" in text and "conserves energy               BROKEN" in text,
          f"the claims of a file that is called with parts: {text}")


def sentences_help():
    system = ("system", "H=p^2/2+q^2/2", "part=A = p^2/2, B = q^2/2, C = q^2/2 + 1/0", "q=1", "p=0", "steps=1")
    typed = ("system", "L=log(q2)/q1*v1 - (q1 - log(q1) + q2 - 2*log(q2))", "q1=2", "steps=1")
    for words, sentence in (
            (("henon-heiles", "scheme=aba864()"), "column 1: aba864() names no parts; a splitting takes those of a system"),
            (system + ("scheme=strang(by rk4, B)",), "column 8: a part is a name, or NAME by SCHEME"),
            (system + ("scheme=strang(A by, B)",), "column 10: a part is a name, or NAME by SCHEME"),
            (system + ("scheme=strang(A, 5+]+1)",), "column 11: a part is a name, or NAME by SCHEME"),
            (system + ("scheme=strang(A, C)",), "A + C is not H"),
            (system + ("scheme=strang(A by dopri5, B)",), "column 13: dopri5 cannot be a part of a step: it is adaptive"),
            (system + ("scheme=lie(A by projected(rk4; H), B)",), "column 10: projected(rk4; H) cannot be a part of a step"),
            (typed + ("q2=1.5", "v1=0"), "so its state is the coordinates alone: leave out v1="),
            (typed + ("q2=1.5", "p1=0", "p2=0"), "leave out p1= p2=")):
        done = subprocess.run([GEOMINT, "run", *words], capture_output=True, text=True)
        check(done.returncode == 1 and sentence in done.stderr, f"{words}: {done.stderr}")
    for name, found, there in (("henon-heiles", "q1' = p1, q2' = p2, p1' = -q1, p2' = -q2", True),
                               ("abc", "\nparts\n", False), ("outer-planets", "it is 0 here", False)):
        told = subprocess.run([GEOMINT, "list", name, "--long"], capture_output=True, text=True).stdout
        check((found in told) == there, f"list {name} --long: {told[-1500:]}")
    for words, sentence in (
            (("relaxed(rk4; H)", "--on", "henon-heiles"), "not claimed  the length of a step depends on the state"),
            (("strang(A, B)",), "it splits into parts with names, and not into T and V\n"),
            (("strang(A, B)",), "\n0 certified, 0 broken: nothing was measured; name a system"),
            (("adjoint(avf2)",), "theory does not apply: a part has no coefficients, or"),
            (("composition(avf2; 1)",), "theory does not apply: a part has no coefficients, or")):
        code, text = certify(*words)
        check(code == 0 and sentence in text, f"{words}: {text}")


def starts_at_a_singularity_are_refused():
    told = run("charged-particle", "scheme=boris2", "x=0", "y=0", "steps=2")
    check("not finite at the start" in told, f"boris2 at the singularity: {told}")


def rows_do_not_change_a_trajectory():
    with tempfile.NamedTemporaryFile(suffix=".csv") as rows:
        for scheme in ("wisdom-holman2", "aba864(kepler, interaction)", "lie(kepler, interaction)"):
            words = ("outer-planets", "scheme=" + scheme, "steps=40")
            check(state(*words) == state(*words, "--csv", rows.name, "--every", "7"), f"{scheme}: rows change the motion")
    measured = run("outer-planets", "scheme=saba4(kepler, interaction)", "steps=200", "--measure", "lyapunov")
    check("none" not in str(measured) and "None" not in str(measured), f"lyapunov of saba4: {measured}")


def main():
    with tempfile.NamedTemporaryFile("w", suffix=".system") as one, \
            tempfile.NamedTemporaryFile("w", suffix=".system") as two:
        one.write(SYSTEM)
        one.flush()
        two.write(RATES)
        two.flush()
        rows_have_their_orders()
        errors_are_those_of_the_table(one.name)
        correctors_raise_the_order()
        words_agree(one.name, two.name)
        members_and_engines_agree()
        bodies_move_in_jacobi_coordinates()
        faults_are_told(one.name)
    parts_are_typed()
    names_mean_parts_of_the_system()
    an_adjoint_has_the_properties_of_its_base()
    certificates_are_not_passed_by_nothing()
    false_orders_are_refuted()
    best_adds_schemes_of_the_order_or_says_so()
    work_of_parts_is_counted()
    with tempfile.TemporaryDirectory() as folder:
        adjoints_and_compositions_have_the_claims_of_their_bases(folder)
    sentences_help()
    starts_at_a_singularity_are_refused()
    time_moves_with_the_first_part_without_it()
    rows_do_not_change_a_trajectory()
    sys.exit(failures > 0)


main()
