# SPDX-License-Identifier: GPL-3.0-or-later
# Lagrangians that are linear in the velocities on the command line: orders, the form that certify measures, the energy of
# long runs, runs that end where the form loses its rank, and what is refused.
# Usage: degenerate.py GEOMINT
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

GEOMINT = sys.argv[1]
failures = 0


def check(good, text):
    global failures
    if not good:
        failures += 1
        print("FAILED", text)


def answer(*words):
    return subprocess.run([GEOMINT, *words], capture_output=True, text=True)


def run(*words):
    done = answer("run", *words, "--json", "--state")
    return json.loads(done.stdout.splitlines()[-1]) if done.stdout else {"state": [math.nan] * 8, "observables": {}}


def certificate(scheme, system, *words):
    done = answer("certify", scheme, "--on", system, *words)
    defects = {}
    for line in done.stdout.splitlines():
        name, found, defect = line.partition(" defect ")
        if found:
            defects[" ".join(name.split()[1:])] = float(defect.split()[0])
    order = float(done.stdout.split("measured ")[1].split()[0]) if "measured " in done.stdout else math.nan
    return done.returncode, order, defects


def system(name, text):
    path = os.path.join(directory, name + ".system")
    with open(path, "w") as out:
        out.write("geomint: 1\ntitle: " + name + "\n" + text)
    return path


def near(value, wanted, part, what):
    check(abs(value - wanted) <= part * abs(wanted), f"{what}: {value} instead of {wanted}")


def orders():
    plane = system("plane", "coordinates: x y\nL: -(y + y^3/3)*v_x - x^2/2 - y^2/2 - x^4/4\n"
                            "observe: speed = v_x\nstart: x = 0.8, y = 0.3\n")
    exact = [-.14742533, .95542115]
    for scheme in "degenerate-midpoint2", "midpoint":
        errors = [max(abs(a - b) for a, b in zip(run(plane, "scheme=" + scheme, f"dt={h}", "until=2")["state"], exact))
                  for h in (.1, .05)]
        near(math.log2(errors[0] / errors[1]), 2, .01, scheme + " of the plane")
    # x' = -(x + x^3 + ...): velocities in observables are rates
    x, y = run(plane, "dt=0.1", "steps=1")["state"]
    near(run(plane, "dt=0.1", "steps=1")["observables"]["speed"], -y / (1 + y * y), 1e-14, "v_x")
    four = "composition(degenerate-midpoint2; let: g = 1/(2 - 2^(1/3)); g, 1-2*g, g)"
    code, order, defects = certificate(four, "lotka-volterra-L", "dt=0.1")
    near(order, 4, .02, "the order of a composition")
    check(code == 0 and defects["symplectic holds"] < 1e-12, f"a composition is symplectic: {defects}")


# rows: dt, the form of hunters and their prey with midpoint, the form of a guiding centre with both
def forms():
    for dt, hunters, centre, midpoint in ((.1, 2.6e-4, 3e-13, 1.5e-7), (.2, 2e-3, 2e-12, 1.1e-6),
                                          (.4, 1.4e-2, 5e-11, 8.4e-6)):
        code, order, defects = certificate("degenerate-midpoint2", "lotka-volterra-L", f"dt={dt}")
        near(order, 2, .01, "order of hunters")
        check(code == 0 and defects["symplectic holds"] < 1e-12 and defects["symmetric holds"] < 1e-12,
              f"hunters {dt}: {defects}")
        code, order, defects = certificate("midpoint", "lotka-volterra-L", f"dt={dt}")
        check(code == 0, "midpoint claims nothing of this form")
        near(defects["symplectic not claimed"], hunters, .03, f"midpoint, hunters {dt}")
        code, order, defects = certificate("degenerate-midpoint2", "guiding-centre", f"dt={dt}")
        near(order, 2, .01, "order of a guiding centre")
        check(code == 0 and defects["symplectic not claimed"] < centre, f"guiding centre {dt}: {defects}")
        code, order, defects = certificate("midpoint", "guiding-centre", f"dt={dt}")
        near(defects["symplectic not claimed"], midpoint, .03, f"midpoint, guiding centre {dt}")
    # another gauge, theta + grad(x y^2/3): the same motion, and the form is conserved up to h^4
    gauge = system("gauge", "coordinates: x y\nL: (log(y)/x + y^2/3)*v_x + 2*x*y/3*v_y - (x - log(x) + y - 2*log(y))\n"
                            "start: x = 2, y = 2\n")
    for dt, defect in ((.1, 6.61e-5), (.2, 1.306e-3), (.4, 1.249e-2)):
        code, order, defects = certificate("degenerate-midpoint2", gauge, f"dt={dt}")
        check(code == 0, "nothing is claimed in another gauge")
        near(defects["symplectic not claimed"], defect, .05, f"another gauge, {dt}")
    one, other = (run(name, "scheme=rk4", "dt=0.1", "steps=40")["state"] for name in ("lotka-volterra-L", gauge))
    check(max(abs(a - b) for a, b in zip(one, other)) < 1e-13, "a gauge changes the motion")
    x, y = run("lotka-volterra", "scheme=gauss8", "dt=0.1", "steps=40")["state"]
    back = run("lotka-volterra-L", "scheme=gauss8", "dt=0.1", "steps=40", f"x={x!r}", f"y={y!r}")["state"]
    check(max(abs(value - 2) for value in back) < 1e-9, f"the cycle of the bracket does not run backwards: {back}")


# the largest |H - H(0)| in each eighth of t = 1600
def energies():
    for scheme, first, last in (("degenerate-midpoint2", 2.58e-4, 2.64e-4), ("midpoint", 2.58e-4, 2.90e-4),
                                ("rk4", 2.0e-5, 1.64e-4)):
        path = os.path.join(directory, "history.csv")
        answer("run", "guiding-centre", "quartic=1", "dt=.2", "until=1600", "scheme=" + scheme, "--csv", path)
        largest = [0.] * 8
        with open(path) as rows:
            for row in csv.DictReader(rows):
                k = min(7, int(float(row["t"]) / 200.0001))
                largest[k] = max(largest[k], abs(float(row["energy_error"])) * .524081)
        near(largest[0], first, .01, scheme + " at first")
        near(largest[7], last, .01, scheme + " at last")
        check(scheme != "degenerate-midpoint2" or max(largest) < 2.7e-4, f"{scheme}: {largest}")


def vortices():
    lane = run("planar-vortices-L", "dt=0.02", "until=4")
    x, y = lane["state"][:4], lane["state"][4:]
    start = run("planar-vortices-L", "steps=0")["state"]
    check(max(abs(sum(a) - sum(b)) for a, b in ((x, start[:4]), (y, start[4:]))) < 1e-13, "impulses of vortices")
    finer = run("planar-vortices-L", "dt=0.01", "until=4")["state"]
    exact = run("planar-vortices-L", "scheme=gauss8", "dt=0.02", "until=4")["state"]
    ratio = max(abs(a - b) for a, b in zip(x + y, exact)) / max(abs(a - b) for a, b in zip(finer, exact))
    near(ratio, 4, .02, "order of vortices")


def facts():
    about = json.loads(answer("list", "lotka-volterra-L", "--json").stdout)
    check(about["kind"] == "degenerate" and list(about["start"]) == ["x", "y"], "the kind of hunters")
    check(about["structure"]["half-gauge"]["holds"] and about["structure"]["degenerate"]["holds"], "facts of hunters")
    check(about["form"] == {"theta_x": "log(y)/x", "theta_y": "0"}, "the form of hunters")
    about = json.loads(answer("list", "guiding-centre", "--json").stdout)
    check(not about["structure"]["half-gauge"]["holds"] and "Pf" in about["form"], "facts of a guiding centre")
    check("half of theta is 0" in answer("list", "lotka-volterra-L", "--long").stdout, "list --long")
    # m v^2/2 with m = 0 is no such Lagrangian, but one whose transform is singular
    weight = system("weight", "parameter: m = 0\ncoordinates: x y\nL: m*v_x^2/2 + y*v_x - x^2\nstart: x = 1, y = 1, v_x = 0, v_y = 0\n")
    check("Legendre transform of L is singular" in answer("run", weight).stderr, "a mass that is 0")


def ends():
    lost = system("lost", "coordinates: x y\nL: -y^2/2*v_x + x\nstart: x = 0, y = 1\n")
    lane = run(lost, "scheme=rk4", "dt=0.03", "until=2")
    check(lane["stopped"] and abs(lane["t"] - .5) < .02, f"the run passes where the form is singular: {lane}")
    check(lane["status"] == "ok" and "the run ends at t = 0.5" in lane["message"] and "the form of theta loses its rank near x = 0, y = " in lane["message"],
          f"an end without a sentence: {lane['message']}")
    # H has no value: at the start, where rates have one, or at the end
    for name, words in (("lotka-volterra-L", ("x=-1", "until=.4")), ("lotka-volterra", ("x=-1", "until=.4")),
                        ("system", ("H=p^2/2 + log(q)", "q=1", "p=-9", "dt=.5", "scheme=explicit-euler", "steps=1"))):
        done = answer("run", name, *words, "--json")
        lane = json.loads(done.stdout)
        check(done.returncode == 2 and lane["status"] == "blow-up" and "log(" in lane["message"], f"no number and ok: {done.stdout}")
    swept = answer("sweep", "lotka-volterra", "x=-1,1", "until=.4", "scheme=rk4").stdout
    check(swept.count(",blow-up,") == 1 and swept.count(",ok,") == 1, f"a swept run without a number is ok: {swept}")
    # exp(800), and a determinant that is 0
    for rate, reason in (("x = 8*x", "beyond the largest number"), ("x = -10*x", "determinant 0")):
        grown = json.loads(answer("run", "system", "rate=" + rate, "x=1e-300", "dt=.1", "steps=1000", "scheme=explicit-euler",
                                  "--measure", "volume_error,log_volume", "--json").stdout)
        check(all(value is None or math.isfinite(value) for value in grown["observables"].values()), f"{rate}: {grown}")
    for scheme in "degenerate-midpoint2", "midpoint":
        lane = run(lost, "scheme=" + scheme, "dt=0.03", "until=2")
        check("the form of theta loses its rank near x = 0, y = -0.00" in lane["message"], lane["message"])


def refusals():
    for name, text, line, sentence in (
            ("odd", "coordinates: x y z\nL: y*v_x - x\nstart: x = 0, y = 1, z = 0\n", "4:4",
             "L is linear in the velocities, and the form of theta is singular: 3 coordinates are an odd number"),
            ("rank", "coordinates: x y z w\nL: y*v_x - x - z^2\nstart: x = 0, y = 1, z = 0, w = 2\n", "4:4",
             "theta has a form of rank 2 of 4 at the start, x = 0, y = 1, z = 0, w = 2: L = theta . q' - H does not "
             "determine the velocities"),
            ("point", "coordinates: x y\nL: y^2*v_x - x\nstart: x = 0, y = 0\n", "4:4", "theta has a form of rank 0 of 2"),
            ("momenta", "coordinates: x y\nmomenta: a b\nL: y*v_x - x\nstart: x = 0, y = 1\n", "4:1",
             "its state is the coordinates alone, and it has no line \"momenta\""),
            ("force", "coordinates: x y\nforce: x = -x\nL: y*v_x - x\nstart: x = 0, y = 1\n", "4:1",
             "it has no line \"force\""),
            ("velocity", "coordinates: x y\nL: y*v_x - x\nstart: x = 0, v_y = 1\n", "5:15", "v_y follows from the coordinates, as L is linear in the velocities: it has no start"),
            ("dense", "coordinates: q[1..14]\nL: sum(i = 1 .. 14, sin(i*sum(j = 1 .. 14, q[j]*j^i/14^i))*v_q[i]) - q[1]\n"
             "start: q[i] = i/7\n", "4:4", "the form of theta has too many entries")):
        path = system(name, text)
        done = answer("run", path)
        check(done.returncode == 1 and f"{name}.system:{line}: " in done.stderr and sentence in done.stderr,
              f"{name}: {done.stderr}")
    start = answer("run", "lotka-volterra-L", "scheme=verlet")
    check(start.returncode == 1, "verlet does not fit")
    timed = system("timed", "coordinates: x y\nL: y*cos(t)*v_x - x^2 - y^2\nstart: x = 0, y = 1\n")
    done = answer("run", timed, "scheme=degenerate-midpoint2")
    check(done.returncode == 1 and "and without t" in done.stderr, done.stderr)
    # a typed L of this form needs no momenta
    done = answer("run", "system", "L=q1*v2 - q2*v1 - q1^2 - q2^2", "q1=1", "q2=.5", "dt=.1", "until=2")
    check(done.returncode == 0, done.stderr)
    # a start that is typed loses the rank, too
    point = system("typed", "coordinates: x y\nL: y^2*v_x - x\nstart: x = 0, y = 1\n")
    done = answer("run", point, "y=0")
    check(done.returncode == 1 and "rank 0 of 2 at the start, x = 0, y = 0" in done.stderr, done.stderr)


with tempfile.TemporaryDirectory() as directory:
    for part in orders, forms, energies, vortices, facts, ends, refusals:
        part()
sys.exit(failures > 0)
