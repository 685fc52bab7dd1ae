#!/usr/bin/env python3
"""projected(S; I, ...) and relaxed(S; I) against an independent computation of both on the Kepler problem, the errors of
100 periods, what certify says of them, and what is refused.
usage: conserved.py GEOMINT"""
import json
import math
import os
import struct
import subprocess
import sys
import tempfile
import zipfile

geomint = sys.argv[1]
failures = []


def run(*words):
    return subprocess.run([geomint, *words], capture_output=True, text=True, timeout=280)


def check(good, what):
    if not good:
        failures.append(what)
        print("wrong:", what)


def numbers(*words):
    out = run("run", *words, "--json")
    return [json.loads(line) for line in out.stdout.splitlines() if line.startswith('{"')] if not out.returncode else out.stderr


# ---- the same steps in another program: H and L of Kepler's problem, gradients by hand ----


def rates(y):
    r3 = math.hypot(y[0], y[1]) ** 3
    return [y[2], y[3], -y[0] / r3, -y[1] / r3]


def rk4(y, h):
    a = rates(y)
    b = rates([u + h / 2 * k for u, k in zip(y, a)])
    c = rates([u + h / 2 * k for u, k in zip(y, b)])
    d = rates([u + h * k for u, k in zip(y, c)])
    return [u + h / 6 * (p + 2 * q + 2 * r + s) for u, p, q, r, s in zip(y, a, b, c, d)]


def verlet(y, h):
    p = [y[2 + i] + h / 2 * rates(y)[2 + i] for i in range(2)]
    q = [y[i] + h * p[i] for i in range(2)]
    end = rates(q + p)
    return q + [p[i] + h / 2 * end[2 + i] for i in range(2)]


invariants = {
    "H": (lambda y: (y[2] ** 2 + y[3] ** 2) / 2 - 1 / math.hypot(y[0], y[1]),
          lambda y: [y[0] / math.hypot(y[0], y[1]) ** 3, y[1] / math.hypot(y[0], y[1]) ** 3, y[2], y[3]]),
    "L": (lambda y: y[0] * y[3] - y[1] * y[2], lambda y: [y[3], -y[2], -y[1], y[0]]),
}


def dot(a, b):
    return sum(u * v for u, v in zip(a, b))


def solve(matrix, right):
    """Cramer's rule for one or two unknowns."""
    if len(right) == 1:
        return [right[0] / matrix[0][0]]
    (a, b), (c, d) = matrix
    det = a * d - b * c
    return [(right[0] * d - right[1] * b) / det, (right[1] * a - right[0] * c) / det]


def projected(step, names, symmetric):
    def advance(y, h, start):
        values, slopes = [invariants[n][0] for n in names], [invariants[n][1] for n in names]
        mu = [0.0] * len(names)
        for _ in range(60):
            before = [f(y) for f in slopes]
            from_ = [u + sum(m * g[i] for m, g in zip(mu, before)) for i, u in enumerate(y)] if symmetric else y
            z = step(from_, h)
            end = z
            for _ in range(60 if symmetric else 1):  # the end at which the gradients are taken
                rows = [f(end) for f in slopes] if symmetric else [f(z) for f in slopes]
                end = [u + sum(m * g[i] for m, g in zip(mu, rows)) for i, u in enumerate(z)]
            off = [s - v(end) for s, v in zip(start, values)]
            gram = [[dot(a, b) for b in rows] for a in rows]
            mu = [m + d / (2 if symmetric else 1) for m, d in zip(mu, solve(gram, off))]
        return end, h
    return advance


def relaxed(step, name, _):
    def advance(y, h, start):
        value, slope = invariants[name[0]]
        d = [a - b for a, b in zip(step(y, h), y)]
        gamma = 1.0
        for _ in range(20):
            end = [u + gamma * v for u, v in zip(y, d)]
            gamma += (start[0] - value(end)) / dot(slope(end), d)
        return [u + gamma * v for u, v in zip(y, d)], gamma * h
    return advance


for word, make, step, names, symmetric in (
        ("projected(rk4; H)", projected, rk4, ["H"], False),
        ("projected(rk4; H, L)", projected, rk4, ["H", "L"], False),
        ("projected(verlet; L, H)", projected, verlet, ["L", "H"], False),
        ("projected(rk4; H; symmetric: yes)", projected, rk4, ["H"], True),
        ("projected(verlet; H, L; symmetric: yes)", projected, verlet, ["H", "L"], True),
        ("relaxed(rk4; H)", relaxed, rk4, ["H"], False),
        ("relaxed(verlet; H)", relaxed, verlet, ["H"], False)):
    advance = make(step, names, symmetric)
    y, t = [0.5, 0.0, 0.0, math.sqrt(3)], 0.0
    start = [invariants[n][0](y) for n in names]
    for _ in range(20):
        y, went = advance(y, 0.1, start)
        t += went
    got = numbers("kepler", "eccentricity=.5", "scheme=" + word, "dt=0.1", "steps=20", "--state")
    near = isinstance(got, list) and max(abs(a - b) for a, b in zip(got[0]["state"], y)) < 1e-11
    check(near and abs(got[0]["t"] - t) < 1e-12, f"{word}: {got} instead of {y} at {t}")

# ---- a hundred periods at e = .5, 100 steps each ----
for word, expected in (("rk4", 1.541), ("relaxed(rk4; H)", 5.073e-4), ("projected(rk4; H, L)", 4.136e-4)):
    got = numbers("kepler", "scheme=" + word, "dt=2*pi/100", "steps=10000")
    error = got[0]["observables"]["position_error"] if isinstance(got, list) else math.nan
    check(abs(error / expected - 1) < 1e-3, f"{word}: position_error {error}, not {expected}")

# ---- certificates: the order is kept, what is given up is named and measured ----
for words, order, holds, lost in (
        (("projected(verlet; H)", "--on", "henon-heiles"), 2, ["H"], "symplectic"),
        (("projected(verlet; H; symmetric: yes)", "--on", "henon-heiles"), 2, ["H"], "symplectic"),
        (("projected(rk4; H, angular_momentum)", "--on", "kepler"), 4, ["H", "angular_momentum"], None),
        (("projected(rk4; I1, I2)", "--on", "kepler"), 4, ["I1", "I2"], None),
        (("relaxed(rk4; H)", "--on", "kepler"), 4, ["H"], None)):
    out = run("certify", *words, "--json")
    certificate = json.loads(out.stdout or "{}")
    kept = certificate.get("conserves", {})
    check(out.returncode == 0 and abs(certificate.get("measured_order", 0) - order) < .1 and sorted(kept) == sorted(holds)
          and all(defect is not None and defect < 1e-12 for defect in kept.values()), f"certify {words}: {out.stdout}{out.stderr}")
    if lost:
        check(lost in certificate.get("given_up", []) and certificate["measured"][lost] > 1e-9, f"{words} gives up {lost}")
    symmetric = certificate.get("properties", {}).get("symmetric", {})
    check(symmetric.get("claimed") == ("symmetric: yes" in words[0]), f"{words} is symmetric")
for word, scene, kept in (("projected(verlet; H; symmetric: yes)", "henon-heiles", "reversible"),
                          ("projected(midpoint; H, angular_momentum; symmetric: yes)", "kepler", "keeps quadratic invariants"),
                          ("relaxed(avf2; H)", "henon-heiles", "symmetric")):
    certificate = json.loads(run("certify", word, "--on", scene, "--json").stdout)
    check(kept not in certificate["given_up"] and certificate["measured"][kept] < 1e-12, f"{word} keeps: {kept}")
check(json.loads(run("certify", "projected(verlet; H; symmetric: yes)", "--on", "henon-heiles", "--json").stdout)
      ["properties"]["reversible"]["claimed"], "a symmetric projection onto H is reversible")

# ---- the invariants that a system has, along a run of any scheme ----
for scheme, verdicts in (("gauss4", ["oscillates", "conserved", "drifts", "oscillates"]), ("rk4", ["drifts"] * 4)):
    followed = json.loads(run("certify", scheme, "--on", "kepler", "--json").stdout)["invariants"]
    check([i["verdict"] for i in followed] == verdicts and [i["name"] for i in followed] == ["H", "angular_momentum", "I1", "I2"],
          f"{scheme} on kepler: {followed}")

# a loss that has ended is no oscillation; what could not be followed to the end says so
lost = json.loads(run("certify", "implicit-euler", "--on", "system", "H=p^2/2+q^2/2", "q=1", "p=0", "dt=.1", "--json").stdout)["invariants"]
check([i["verdict"] for i in lost] == ["drifts"] and lost[0]["defect"] > .99, f"implicit-euler loses H: {lost}")
for word in "explicit-euler", "composition(explicit-euler; 1/3, 1/3, 1/3)":  # a loss that slows down, and does not end
    lost = json.loads(run("certify", word, "--on", "kepler", "--json").stdout)["invariants"]
    check([i["verdict"] for i in lost[:2]] == ["drifts"] * 2 and lost[0]["defect"] > .9, f"{word} loses H and L: {lost}")
ended = json.loads(run("certify", "implicit-euler", "--on", "kepler", "--json").stdout)["invariants"]
check([(i["verdict"], i.get("reason")) for i in ended] == [("not measured", "no-convergence")] * 4, f"implicit-euler on kepler: {ended}")

# ---- nearly dependent invariants: on a circle the slopes of H and L are parallel ----
for e, word in ((0, "projected(rk4; H, L; symmetric: yes)"), (1e-6, "projected(midpoint; H, L; symmetric: yes)"),
                (1e-4, "projected(verlet; H, L; symmetric: yes)")):
    got = numbers("kepler", f"eccentricity={e}", "scheme=" + word, "dt=.01", "steps=600", "--max")
    check(isinstance(got, list) and got[0]["status"] == "ok" and got[0]["observables"]["energy_error_max"] < 1e-13,
          f"{word} at eccentricity {e}: {got}")
got = run("run", "kepler", "scheme=projected(rk4; H; symmetric: yes)", "dt=3", "--json")
check(got.returncode == 2 and json.loads(got.stdout)["status"] == "no-convergence", f"a step too long: {got.stdout}")
got = run("run", "kepler", "scheme=relaxed(implicit-euler; H)", "dt=1e-3")  # gamma tends to 2
check(got.returncode == 2 and "take a base of order 2 or more" in got.stdout, f"relaxed with order 1: {got.stdout}")

for word, said in (("projected(rk4; L, angular_momentum)", "angular_momentum is L"),
                   ("projected(rk4; H, X)", "finds: I1, I2, ...), in column 19;")):
    got = run("run", "kepler", "scheme=" + word, "steps=2")
    check(got.returncode == 1 and said in got.stderr, f"{word}: {got.stderr}")
check("holds between events" in run("list", "bouncing-ball", "--invariants").stdout, "a bounce changes H")

# a member that fails says why, whatever those after it do
for members in "1", "4":
    got = run("run", "figure-eight", "scheme=projected(saba4(kepler, interaction); H)", "steps=40", "members=" + members)
    check(got.returncode == 2 and "found no way back to the value that H has at the start" in got.stdout,
          f"{members} members: {got.stdout}")

# ---- engines, members, files ----
states = [numbers("kepler", "perturbation=0.01", "scheme=projected(rk4; H, L)", "dt=.05", "steps=200", "--state", "--engine", e)
          for e in ("interpreted", "auto")]
check(isinstance(states[0], list) and states[0][0].get("state") == states[1][0].get("state"), f"two engines: {states}")
several = numbers("kepler", "scheme=projected(rk4; H, L)", "members=3", "steps=20", "--state")[0]["state"]
alone = numbers("kepler", "scheme=projected(rk4; H, L)", "steps=20", "--state")[0]["state"]
check(several[::3] == alone or several[2::3] == alone, f"members: {several} {alone}")
got = numbers("kepler", "scheme=projected(rk4; H),relaxed(rk4; H)", "steps=9", "--measure", "projection,relaxation", "--max")
check(isinstance(got, list) and got[0]["observables"].get("projection_max", 0) > 1e-9 and
      abs(got[1]["observables"].get("relaxation_max", 0)) > 1e-9, f"projection, relaxation: {got}")
with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "held.scheme")
    with open(path, "w") as text:
        text.write("geomint: 1\nkind: projected\nbase: rk4\ninvariants: H, L\n")
    of_file, of_word = (numbers("kepler", "scheme=" + s, "steps=30", "dt=.05", "--state") for s in (path, "projected(rk4; H, L)"))
    check(of_file[0]["state"] == of_word[0]["state"], "the file is the word")
    kept = os.path.join(folder, "held.checkpoint")
    for word in ("projected(rk4; H, L)", "relaxed(rk4; H)"):
        whole = numbers("kepler", "scheme=" + word, "steps=60", "dt=.05", "--state")
        run("run", "kepler", "scheme=" + word, "steps=30", "dt=.05", "--checkpoint", kept)
        rest = run("run", "kepler", "scheme=" + word, "steps=60", "dt=.05", "--continue", kept, "--state", "--json")
        check(rest.returncode == 0 and json.loads(rest.stdout.splitlines()[0])["state"] == whole[0]["state"],
              f"{word} resumed: {rest.stdout}{rest.stderr}")

# ---- an invariant that leaves the numbers in a step is not met, in whatever order the names are

with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "prey.system")
    with open(path, "w") as text:
        text.write("rate: x = x*(1 - y), y = y*(x - 1), z = 0\ninvariant: A = x - log(x) + y - log(y)\ninvariant: B = z\n"
                   "start: x = .2, y = 4, z = 1\n")
    for names in "A, B", "B, A", "A":
        out = run("run", path, f"scheme=projected(explicit-euler; {names})", "dt=.5", "until=20")
        check(out.returncode == 2 and "no-convergence" in out.stdout and "t                    0" in out.stdout,
              f"{names} beyond the numbers: {out.returncode} {out.stdout}{out.stderr}")

# ---- what energy alone does not buy: the section of Hénon and Heiles drifts


def doubles(file, name):
    data = file.read(name)
    body = data[10 + struct.unpack("<H", data[8:10])[0]:]
    return struct.unpack(f"<{len(body) // 8}d", body)


def solve(rows, right):
    rows = [row + [value] for row, value in zip(rows, right)]
    for i in range(len(rows)):
        k = max(range(i, len(rows)), key=lambda r: abs(rows[r][i]))
        rows[i], rows[k] = rows[k], rows[i]
        for r in range(len(rows)):
            if r != i:
                factor = rows[r][i] / rows[i][i]
                rows[r] = [a - factor * b for a, b in zip(rows[r], rows[i])]
    return [row[-1] / row[i] for i, row in enumerate(rows)]


def drift(places):
    """the mean of the last tenth of the radii about the centre, less the waves 0 to 4 of the first tenth over the angle"""
    x, y = sum(p[0] for p in places) / len(places), sum(p[1] for p in places) / len(places)
    polar = [(math.atan2(b - y, a - x), math.hypot(a - x, b - y)) for a, b in places]
    tenth = len(polar) // 10

    def waves(angle):
        return [1] + [f(k * angle) for k in range(1, 5) for f in (math.cos, math.sin)]

    rows = [waves(angle) for angle, _ in polar[:tenth]]
    normal = [[sum(row[i] * row[j] for row in rows) for j in range(9)] for i in range(9)]
    fit = solve(normal, [sum(row[i] * r for row, (_, r) in zip(rows, polar)) for i in range(9)])
    return sum(r - sum(c * w for c, w in zip(fit, waves(angle))) for angle, r in polar[-tenth:]) / tenth


with tempfile.TemporaryDirectory() as folder:
    tracks = os.path.join(folder, "tracks.npz")
    lanes = numbers("henon-heiles", "scheme=relaxed(rk4; H),projected(rk4; H),verlet", "dt=.4,.4,.1", "zip=yes", "until=4000",
                    "--save-tracks", tracks)
    with zipfile.ZipFile(tracks) as file:
        for number, (expected, energy) in enumerate(((3.9e-2, 1e-12), (4.4e-2, 1e-12), (1.9e-3, 5.2e-4))):
            values = doubles(file, f"lane{number}/section.npy")
            found = drift(list(zip(values[::2], values[1::2])))
            check(abs(found / expected - 1) < .05, f"the section drifts by {found}, not {expected}")
            check(abs(lanes[number]["observables"]["energy_error"]) < energy, f"energy: {lanes[number]['observables']}")


# ---- what is refused, with its place ----
for scene, word, sentence in (
        ("kepler", "relaxed(rk4; H, L)", "column 17: relaxed takes one invariant; projected takes several"),
        ("kepler", "projected(rk4; H, H)", "column 19: H is named twice"),
        ("kepler", "projected(rk4; )", "column 16: the name of an invariant was expected"),
        ("kepler", "projected(rk4; H; symmetric: maybe)", "column 30: symmetric: is yes or no"),
        ("kepler", "projected(dopri5; H)", "column 11: dopri5 cannot be a part of a step: it is adaptive"),
        ("kepler", "composition(projected(rk4; H); 1)", "column 13: projected(rk4; H) cannot be a part of a step: whole"),
        ("kepler", "projected(projected(rk4; H); L)", "column 11: projected(rk4; H) cannot be a part of a step: whole"),
        ("kepler", "relaxed(relaxed(rk4; L); H)", "column 9: relaxed(rk4; L) cannot be a part of a step: whole"),
        ("henon-heiles", "projected(rk4; I1)", "an invariant I1 (there are H, and list --invariants finds no other)"),
        ("kepler", "projected(rk4; I3)", "an invariant I3 (there are H, angular_momentum, and I1 to I2)"),
        ("duffing", "verlet", "needs a Hamiltonian on which no force acts; here the line force: adds one"),
        ("kepler", "relaxed(rk4; constraints)", "column 14: constraints are held alone"),
        ("kepler", "projected(rk4; Lx)", "needs an invariant Lx (there are H, angular_momentum, and those that list --invariants finds"),
        ("kepler", "projected(rk4; r)", "needs a constant r (its rate is 0 at the start alone), in column 16;"),
        ("kepler", "projected(rk4; constraints)", "needs constraints"),
        ("driven-pendulum", "projected(rk4; H)", "needs a constant H (its rate"),
        ("cartesian-pendulum", "projected(rk4; H)", "projected(...; constraints)")):
    out = run("run", scene, "scheme=" + word, "steps=1")
    check(out.returncode == 1 and sentence in out.stderr, f"{word} on {scene}: {out.returncode} {out.stderr}")
linear = ("system", "rate=x = y-z", "rate=y = z-x", "rate=z = x-y", "x=1", "y=.2", "z=.1")
out = run("run", *linear, "scheme=relaxed(rk4; I1)", "dt=.1", "steps=1")
check(out.returncode == 1 and "not linear" in out.stderr, f"a linear invariant: {out.returncode} {out.stderr}")

for words, reason in ((("eccentricity=0", "scheme=projected(explicit-euler; H, L)", "steps=10"), "the iteration diverges"),
                      (("scheme=relaxed(rk4; H)", "dt=3", "steps=10"), "it stays off by 0.51 of its scale")):
    out = run("run", "kepler", *words)
    check(out.returncode == 2 and "no-convergence" in out.stdout and
          f"no way back to the value that H has at the start: {reason}" in out.stdout,
          f"a step too far: {out.returncode} {out.stdout}{out.stderr}")

sys.exit(1 if failures else 0)
