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
    print(("    " if good else "    WRONG: ") + text.splitlines()[0])
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
    refused("density: it does not hold u_t, at column 5 of 1 + u_t", "soliton", "density=1 + u_t")
    refused("density: there is no name ux; did you mean u_x, at column 5 of 1 + ux", "soliton", "density=1 + ux")
    refused("boundary: walls mean u_x = 0, and the ends of a moving mesh hold u", "phi4", "scheme=multiplier-trapezoidal", "boundary=walls")
    refused("density: there is no name temperd; did you mean tempered, at column 1", "soliton", "density=temperd")
    refused("bend, V_u, arclength, curvature, mix, limited, tempered, at column 1", "soliton", "density=equally")
    refused("density: there is no name u_tt; names are u_x, u, x, alpha, steepest, bend, V_u, at column 5 of 1 + u_tt", "soliton", "density=1 + u_tt")
    refused("density: it has to be smooth, and abs is not, at column 5", "soliton", "density=1 + abs(u_x)")
    refused("density: is -1 at the start where x = 0", "soliton", "density=u_x - 1")
    refused("density: is ", "soliton", "density=1/(x - 12.5)")
    refused("density: is 0 everywhere at the start; a constant above 0 makes a uniform mesh", "soliton", "density=0")
    for density in ("sqrt(1 + alpha^2*u_x^2)", "1"):
        plain, *scaled = (states("soliton", f"density={factor}*{density}", "until=2", f"scheme={scheme}")[0]
                          for scheme in ("multiplier-lobatto4", "control-gauss4") for factor in ("1", "1e-30", "1e6"))
        for lane, name in zip(scaled[:2], ("1e-30", "1e6"), strict=True):
            check(lane["status"] == "ok", f"{name}*{density}: {lane['status']}")
            compare(f"only ratios of {density} matter, {name}", lane["state"]["x"], plain["state"]["x"], 1e-9)
        compare(f"the same of control-gauss4, {density}", scaled[3]["state"]["x"], scaled[2]["state"]["x"], 1e-9)
    path = file_of("slow_scale", STEEP)
    one, four = (states(path, f"relax={relax}", "scheme=control-radau3", "until=0.5", f"density={factor}*sqrt(1 + u_x^2)")[0]
                 for relax, factor in ((0.3, 1), (1.2, 2)))
    compare("the time of smoothing is of the density squared", four["state"]["x"], one["state"]["x"], 1e-9)
    refused("density: is not a number at the start where x = 0", "soliton", "density=sqrt(u_x - 100)")
    refused("the formula ends where a number", "soliton", "density=sqrt(1 +")
    refused("bad.system:9:10: density: there is no name w; names are u_x, u, x, alpha, steepest, bend, V_u, at column 5 of 1 + w", file_of("bad", "density: 1 + w"))
    refused("alpha is a key of moving meshes", file_of("alpha", "parameter: alpha = 1"))
    refused("steepest is a key of moving meshes: a parameter needs another name",
            file_of("steepest", "parameter: steepest = 1", "density: limited"))
    for name in ("alpha", "steepest", "bend", "X", "relax"):
        refused(f"{name} is a key of moving meshes: a let needs another name", file_of(f"let{name}", f"let: {name} = 1"))
    refused("density: V_u has a meaning here, and a let of that name needs another one, at column 5",
            file_of("let_force", "let: V_u = 1", "density: 1 + V_u"))
    path = file_of("moment", "let: w = t + k", "let: z = w + 1")
    refused("density: it does not hold t, and holds it through z, at column 5", path, "density=1 + z^2*u_x^2")
    refused("cell: it does not hold t, and holds it through w, at column 1", path, "scheme=free-gauss4", "cell=w*(d_t/d)^2")
    check(run(path, "scheme=given-gauss2", "mesh=X = x + 0*w", "steps=1").returncode == 0,
          "mesh: holds t through a let")
    refused("show=convergence draws the error, and the file has no exact solution", path, "show=convergence")
    made = run("soliton", "points=1", "until=14", "scheme=uniform-gauss4", "--measure", "position", "--json")
    check(json.loads(made.stdout)["observables"]["position"] is not None, "the soliton has a place in the last cell")
    refused("density: has at most 255 characters", file_of("long", "density: 1" + " + u^2" * 60))



SWINGS = "mesh: X = x + 0.7*sin(pi*(x + 6)/12)*sin(1.1*t + 0.3)"
STEEP = "density: sqrt(1 + 0.8*u_x^2 + 0.1*u^2)"


def compare(name, got, wanted, within=1e-10):
    near(name, max(abs(a - b) for a, b in zip(got, wanted, strict=True)), 0, within)


def apart(one, other):
    return max(abs(a - b) for key in ("u", "x") for a, b in zip(one[key], other[key], strict=True))


def element(y, x, u, v, k):
    """Derivatives of one element's Lagrangian by y and dy/dt of both ends, by differences of Gauss's rule."""
    nodes = (-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640)
    weights = (0.2369268850561891, 0.4786286704993665, 128 / 225, 0.4786286704993665, 0.2369268850561891)

    def value(y0, y1, u0, u1):
        d, slope, total = x[1] - x[0], (y1 - y0) / (x[1] - x[0]), 0
        for node, weight in zip(nodes, weights, strict=True):
            s = (1 + node) / 2
            field, rate = (1 - s) * y0 + s * y1, (1 - s) * (u0 - slope * v[0]) + s * (u1 - slope * v[1])
            total += weight / 2 * d * (rate**2 / 2 - slope**2 / 2 - field**2 / 2 - k * field**4 / 4)
        return total

    made, h = [], 1e-3
    for i in range(4):
        z = [*y, *u]
        slope = 0
        for by, factor in ((-2, 1), (-1, -8), (1, 8), (2, -1)):  # of a polynomial of degree 4: exact
            z[i] = [*y, *u][i] + by * h
            slope += factor * value(*z) / (12 * h)
        made.append(slope)
    return made


def cell_defect(scheme):
    """The discrete Euler-Lagrange equations of the midpoint rule (109) from three states."""
    h, length, amplitude = 0.05, 12, 0.7
    path = file_of("swings", SWINGS)
    y = [[0.0, *states(path, f"scheme={scheme}", f"dt={h}", f"steps={n}")[0]["state"]["u"], 0.0] for n in range(3)]
    for state in y:
        state[0] = 1.2 * math.exp(-6.5**2 / 3)
        state[-1] = 1.2 * math.exp(-5.5**2 / 3)
    labels = [-6 + 1.5 * k for k in range(9)]
    place = [[x + amplitude * math.sin(math.pi * (x + 6) / length) * math.sin(1.1 * t + 0.3) for x in labels]
             for t in (h / 2, 3 * h / 2)]
    rate = [[1.1 * amplitude * math.sin(math.pi * (x + 6) / length) * math.cos(1.1 * t + 0.3) for x in labels]
            for t in (h / 2, 3 * h / 2)]
    rest, size = [0.0] * 9, 0.0
    for step in range(2):
        for e in range(8):
            ends = (e, e + 1)
            middle = [(y[step][i] + y[step + 1][i]) / 2 for i in ends]
            u = [(y[step + 1][i] - y[step][i]) / h for i in ends]
            by = element(middle, [place[step][i] for i in ends], u, [rate[step][i] for i in ends], 0.25)
            for side in range(2):
                # D2 of the first step and D1 of the second, both of h l((y + y')/2, (y' - y)/h)
                parts = (h / 2 * by[side], by[2 + side] if step == 0 else -by[2 + side])
                rest[e + side] += sum(parts)
                size = max(size, *map(abs, parts))
    return max(map(abs, rest[1:-1])) / size


def known_meshes():
    path = file_of("known", SWINGS)
    two, four = states(path, "scheme=given-gauss2,given-gauss4", "dt=0.05", "steps=20")
    compare("given-gauss2", two["state"]["u"], (-.000990768389936, .103911572322, .283162720824, .317060009905,
                                                .339073023932, .159259503772, -.00200901973701))
    compare("given-gauss4", four["state"]["u"], (-.00103107618899, .104098723083, .283113653716, .316152370913,
                                                 .339136357126, .159307864819, -.0020202301356))
    compare("its mesh", four["state"]["x"], (-4.23601930043, -2.51222726938, -.862694214901, .689814810992,
                                             2.1373057851, 3.48777273062, 4.76398069957))
    near("energy", two["observables"]["energy"], 1.980189368093, 1e-10)
    one, other = states(path, "mesh=X = x", "scheme=given-gauss4,uniform-gauss4")
    check(one["state"] == other["state"], "X = x and the uniform mesh have the same bits")
    for scheme, order in (("gauss2", 2), ("gauss4", 4), ("lobatto2", 2), ("lobatto4", 4)):
        lanes = states(path, f"scheme=given-{scheme}", "until=0.8", "dt=0.1,0.05,0.025,0.0125")
        gaps = [apart(lanes[i]["state"], lanes[i + 1]["state"]) for i in range(3)]
        near(f"order of given-{scheme}", math.log2(gaps[1] / gaps[2]), order, 0.1)
    near("Euler-Lagrange equations of given-gauss2", cell_defect("given-gauss2"), 0, 1e-10)
    defect = cell_defect("given-lobatto2")
    check(defect > 4e-4, f"given-lobatto2 does not obey them: {defect:.2g}")
    for scheme, word in (("given-gauss2", "holds"), ("given-lobatto2", "not claimed")):
        made = subprocess.run([program, "certify", scheme, "--on", path, "points=3", "dt=0.05"], capture_output=True,
                              text=True, check=False)
        check(made.returncode == 0, f"certify {scheme} --on the file: {made.stderr}")
        line = next(line for line in made.stdout.splitlines() if line.lstrip().startswith("M "))
        check(word in line, line)
        if word != "holds":
            check(float(line.split("defect ")[1].split()[0]) > 1e-6, "a defect above 1e-6")
    for sentence, text in (
        ("mesh: X is -5.9 at the end x = -6 at t = 0, and has to stay there", "X = x + 0.1"),
        ("mesh: X is 6 at the end x = -6 at t = 0, and has to stay there", "X = -x"),
        ("mesh: it does not hold u", "X = x + u"),
        ("mesh: it is X = and a formula in x and t", "Y = x"),
        ("mesh: it has to be smooth, and mod is not", "X = x + 0.2*mod(t, 1)*(36 - x^2)/36"),
        ("mesh: it has to be smooth, and floor is not", "X = x + 0.2*floor(t)*(36 - x^2)/36"),
        ("mesh: it has to be smooth, and below is not", "X = x + 0.2*if(t > 1, 1, 0)*(36 - x^2)/36"),
        ("mesh: X does not grow with x at x = -6, t = 1", "X = x + 3*sin(pi*x/6)*sin(t)"),
    ):
        refused(sentence, path, "until=1", f"mesh={text}")
    refused("none of these schemes takes mesh=; these do: given-gauss2", "soliton", "scheme=control-gauss2", "mesh=X = x")
    crossed = states(path, "scheme=given-gauss2", "mesh=X = x + 4*sin(pi*(x + 6)/6)*sin(t)*sin(pi*t/4)", "until=4")[0]
    check(crossed["status"] == "mesh-crossing", f"a mesh that is not positive later: {crossed['status']}")


def smoothing():
    path = file_of("smoothed", STEEP)
    lane = states(path, "relax=0.3", "scheme=control-radau3", "dt=0.02", "steps=25")[0]
    compare("control-radau3 with relax", lane["state"]["u"],
            (1.28392657159e-05, .026446427548, .321874526987, .852186778771, .751218449861, .20286189179, .00583656427398))
    compare("its mesh", lane["state"]["x"], (-4.46200227358, -2.92456608952, -1.41444670703, .0170584570296,
                                             1.50321143046, 2.93744878062, 4.46269722609))
    held, *lanes = states(path, "relax=0,0.1,0.01,0.001", "scheme=control-radau5", "points=9", "dt=0.01", "until=0.5")
    for lane, wanted in zip(lanes, (7.2e-4, 7.2e-5, 7.2e-6), strict=True):
        gap = apart(lane["state"], held["state"])
        near(f"distance from relax=0 with relax={lane['parameters']['relax']:g}", gap, wanted, 0.05 * wanted)
    # the run begins with dX/dt = g/E, as every step ends, and with the momenta of the other schemes' start
    short = states("soliton", "scheme=control-radau5", "relax=0.3", "dt=1e-6", "steps=1")[0]["observables"]
    near("energy error after a step of 1e-6 with relax", short["energy_error"], 0, 1e-6)
    begun, after = (states(path, "relax=0.3", "scheme=control-radau5", "dt=1e-7", f"steps={n}")[0]["state"] for n in (0, 1))
    compare("velocities of the start", begun["u_dot"] + begun["x_dot"], after["u_dot"] + after["x_dot"], 1e-5)
    for relax, word in (("0.3", "not claimed"), ("0", "holds")):
        made = subprocess.run([program, "certify", "control-gauss2", "--on", "soliton", "points=7", f"relax={relax}"],
                              capture_output=True, text=True, check=False)
        lines = made.stdout.splitlines()
        check(made.returncode == 0 and any("= symmetric" in line and "holds" in line for line in lines) and
              any("R reversible" in line and word in line for line in lines),
              f"certify with relax={relax}: symmetric holds, reversible {word}")
    refused("relax=-1 is out of range", path, "relax=-1")
    # shorter ones would be of round-off: at the bound a run is that of relax=0 but for the lag
    refused("relax: is 1e-10, and round-off would move 7 nodes: it is 0, or 2.1e-08 or longer", path, "relax=1e-10",
            "scheme=control-radau5")
    near("distance with the shortest relax", apart(*(lane["state"] for lane in states(
        path, "relax=0,2.2e-8", "scheme=control-radau5", "dt=0.01", "until=0.5"))), 0, 1e-8)
    refused("none of these schemes takes relax=; these do: control-gauss2", path, "relax=1")
    lazy, plain = (states(name, "until=0.5")[0]["state"] for name in (file_of("slow", STEEP, "relax: 0.3"), path))
    check(lazy == plain, "a scheme that does not take a line relax: ignores it")
    refused("relax: is a number between 0 and 1e+06", file_of("lazy", "relax: k"))


def free_nodes():
    inertia = "cell: 0.05/2*(d_t/d)^2"
    path, bare = file_of("free", STEEP, inertia), file_of("bare", STEEP)
    lane = states(path, "scheme=free-gauss4", "dt=0.02", "steps=25")[0]
    compare("free-gauss4", lane["state"]["u"], (-.000665712784008, .0312835627526, .329993742996, .85338190064,
                                                .766465931032, .216655061641, .00623815749854))
    compare("its mesh", lane["state"]["x"], (-4.43461989234, -2.870668013, -1.39878678971, .0461932596569,
                                             1.43343324089, 2.89786914216, 4.42561081999))
    start = states(path, "scheme=free-gauss4", "steps=0")[0]["observables"]
    near("energy at the start", start["energy"], 1.9870952359088, 1e-12)
    field = states(path, "scheme=multiplier-lobatto4", "steps=0")[0]["observables"]
    near("the field's", field["energy"], 1.9870647750702, 1e-12)
    made = run(path, "scheme=free-gauss4", "steps=0")
    check("none: nothing constrains this mesh" in made.stdout, "a free mesh has no constraint")
    longer = states(path, "scheme=free-gauss4", "until=9", "dt=0.01")[0]
    check(longer["status"] == "ok", "to t = 9: " + longer["status"])
    near("energy error", longer["observables"]["energy_error"], 0, 1e-7)
    made = run(bare, "scheme=free-gauss4", "until=9", "dt=0.01")
    check(made.returncode == 2 and "0.7" in made.stdout and "slopes meet" in made.stdout, "without cells slopes meet near t = 0.76")
    asked = states(bare, "--measure", "straightest,mass_rank,mass_condition", "steps=0")[0]["observables"]
    near("straightest", asked["straightest"], .0165844324089, 1e-12)
    near("condition", asked["mass_condition"], 25089.7, 0.1)
    near("rank", asked["mass_rank"], 14, 0)
    tent = file_of("tent").replace("tent", "tented")
    with open(tent, "w", encoding="utf-8") as file:
        file.write("field: u\nV: 0*u\nstart: u = 1 - abs(x)/6, u_t = 0\nhalf_length: 6\npoints: 7\n"
                   "schemes: uniform-gauss2\n")
    near("rank of a tent", states(tent, "--measure", "mass_rank", "steps=0")[0]["observables"]["mass_rank"], 8, 0)
    refused("9 of 31 nodes are straight: the mass matrix has rank 53 of 62; a line cell: makes it regular",
            "soliton", "scheme=free-gauss4", "until=1")
    for cell in ("0*d", "d", "0*d_t", "1e-14*(d_t/d)^2"):
        refused("9 of 31 nodes are straight: the mass matrix has rank 53 of 62; a line cell: like 0.05*(d_t/d)^2 makes it "
                "regular", "soliton", "scheme=free-gauss4", "until=1", "cell=" + cell)
        if cell[0] != "1":
            made = run(path, "scheme=free-gauss4", "until=9", "dt=0.01", "cell=" + cell)
            check(made.returncode == 2 and "slopes meet" in made.stdout, f"slopes meet with cell={cell}")
    refused("cell: the mass matrix is not positive at the start: inertia is below 0", path, "scheme=free-gauss4",
            "cell=-(d_t/d)^2")
    indefinite = states(file_of("negative", STEEP, "cell: -(d_t/d)^2"), "--measure", "mass_rank",
                        "steps=0")[0]["observables"]
    near("rank without cells, as multipliers hold the mesh", indefinite["mass_rank"], 14, 0)
    refused("cell: the mass matrix of the nodes is singular", "peakons", "cell=0*d")
    best = json.loads(run("soliton", "scheme=free-gauss2", "dt=0.02", "until=8", "cell=0.05*(d_t/d)^2", "--max",
                          "--json").stdout)["observables"]
    near("largest error of the soliton", best["solution_error_max"], 0.166, 0.005)
    near("largest energy error", best["energy_error_max"], 0, 2e-6)
    near("that of the field", best["field_energy_error_max"], 3e-4, 3e-5)
    for scheme in ("free-gauss2", "free-gauss4"):
        made = subprocess.run([program, "certify", scheme, "--on", path, "points=3", "dt=0.05"], capture_output=True,
                              text=True, check=False)
        check(made.returncode == 0 and made.stdout.count("holds ") == 3 + (scheme == "free-gauss2"),
              f"certify {scheme} --on the file: {made.stderr}")
    made = subprocess.run([program, "certify", "free-gauss2", "--on", path], capture_output=True, text=True, check=False)
    check(made.returncode == 0 and "BROKEN" not in made.stdout and
          "M multisymplectic                not measured a step fails" in made.stdout,
          f"steps that fail break no claim: {made.stdout}")
    refused("cell: there is no name w; names are d, d_t, m_t, u_x", path, "scheme=free-gauss4", "cell=d*w")
    refused("cell: there is no name xx; names are d, d_t, m_t, u_x", path, "scheme=free-gauss4", "cell=d*xx")
    refused("cell: the energy of the cells is not finite at the start", path, "scheme=free-gauss4", "cell=d_t^2/(d - d)")
    refused("cell: it has to be smooth, and abs is not", path, "scheme=free-gauss4", "cell=abs(d_t)")
    refused("cell: d has a meaning here, and a let of that name needs another one", file_of("let_d", "let: d = 1"),
            "scheme=free-gauss4", "cell=d*d_t^2")
    refused("cell: it does not hold x", path, "scheme=free-gauss4", "cell=x*d_t^2")


def momenta(places, velocities, wall=24):
    """Momenta of peakons: M is the inverse of exp(-|x_i - x_j|)/2, or with walls of what is 0 there; by elimination."""
    def green(a, b):
        return math.sinh(wall - max(a, b)) * math.sinh(wall + min(a, b)) / math.sinh(2 * wall)

    n = len(places)
    rows = [[green(a, b) for b in places] + [v] for a, v in zip(places, velocities, strict=True)]
    for i in range(n):
        rows[i] = [value / rows[i][i] for value in rows[i]]
        for k in range(n):
            if k != i:
                rows[k] = [a - rows[k][i] * b for a, b in zip(rows[k], rows[i], strict=True)]
    return [row[-1] for row in rows]


def alone(*words):
    made = run(*words, "--state", "--json")
    lanes = [json.loads(line) for line in made.stdout.splitlines()]
    if not lanes:
        print(made.stderr)
    return lanes


def nodes_alone():
    """Peakons, whose Lagrangian is that of the cells alone."""
    lane = alone("peakons", "nodes=-8, -2", "until=8", "dt=0.05", "scheme=free-gauss4")[0]
    compare("two peakons, places and velocities", lane["state"], (5.86044683, 9.44434523, 1.10905804, 1.97424367), 2e-8)
    for name in ("momentum_error", "energy_error"):
        near(name, lane["observables"][name], 0, 1e-10)
    check("points" not in lane["parameters"], "listed nodes leave no number of them to choose")
    for key in ("points=31", "density=1 + x^2"):
        refused("= has no effect here: nodes: lists the places, unless it is nodes=density", "peakons", key)
    check(len(alone("peakons", "nodes=density", "points=9", "steps=0")[0]["state"]) == 18, "nodes=density has points")
    # the places obey dx/dt = sum p_j exp(-|x - x_j|)/2, dp/dt = p/2 sum p_j sign(x - x_j) exp(-|x - x_j|), by Runge and Kutta
    x, p = [-8.0, -2.0], momenta((-8, -2), (2 + math.exp(-6), 1 + 2 * math.exp(-6)))

    def rates(z):
        q, p = z[:2], z[2:]
        decay = math.exp(-abs(q[0] - q[1])) / 2
        pull = p[0] * p[1] * decay * (1 if q[0] > q[1] else -1)
        return [p[0] / 2 + p[1] * decay, p[1] / 2 + p[0] * decay, pull, -pull]

    z, h = x + p, 0.002
    for _ in range(4000):
        k1 = rates(z)
        k2 = rates([a + h / 2 * b for a, b in zip(z, k1, strict=True)])
        k3 = rates([a + h / 2 * b for a, b in zip(z, k2, strict=True)])
        k4 = rates([a + h * b for a, b in zip(z, k3, strict=True)])
        z = [a + h / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(z, k1, k2, k3, k4, strict=True)]
    compare("Camassa and Holm's equations of two peakons", lane["state"][:2], z[:2], 1e-8)
    compare("their momenta", momenta(lane["state"][:2], lane["state"][2:]), z[2:], 1e-8)
    made = run("peakons", "nodes=-8, -2", "until=15.5", "dt=0.01")
    check("momentum_error       2.1" in made.stdout and "warning" not in made.stdout,
          f"momentum that walls take is not lost: {made.stdout}")
    path = f"{folder.name}/one.system"
    with open(path, "w", encoding="utf-8") as file:
        file.write("cell: m_t^2*tanh(d/2) + d_t^2/(4*tanh(d/2))\ndensity: 1 + 2/cosh(x)\nhalf_length: 20\n"
                   "start: X_t = sinh(20 - abs(x))/sinh(20)\nuntil: 5\ndt: 0.05\n")
    for lane in alone(path, "points=3,7,31", "scheme=free-gauss2,free-gauss4"):
        n = len(lane["state"]) // 2
        name = f"{n} nodes, {lane['scheme']}"
        near(f"{name}: crest", lane["observables"]["crest"], 5, 1e-10)
        near(f"{name}: height", lane["observables"]["amplitude"], 1, 1e-10)
        others = sorted(map(abs, momenta(lane["state"][:n], lane["state"][n:], 20)))[:-1]
        near(f"{name}: momentum of the other nodes", max(others), 0, 1e-10)
    for scheme in ("free-gauss2", "free-gauss4"):
        made = subprocess.run([program, "certify", scheme, "--on", path, "points=3", "until=1"], capture_output=True,
                              text=True, check=False)
        check(made.returncode == 0 and made.stdout.count("holds ") == 3, f"certify {scheme} --on nodes: {made.stderr}")
    grid = run("camassa-holm", "half_length=20", "points=31", "until=10", "scheme=rk4", "space=differences,fourier", "--json")
    lanes = [json.loads(line) for line in grid.stdout.splitlines()]
    near("a grid of 31 points: error", lanes[0]["observables"]["solution_error"], 0.845, 5e-4)
    check(lanes[1]["status"] == "blow-up", "by Fourier: " + lanes[1]["status"])
    bare = "cell: d_t^2/d\n"
    for number, (sentence, text) in enumerate((
        ("nodes: 0 follows 1, and places grow, between -20 and 20", bare + "nodes: 1, 0\nstart: X_t = x\n"),
        ("nodes: 30 follows 1, and places grow", bare + "nodes: 1, 30\nstart: X_t = x\n"),
        ("nodes: there is no name w", bare + "nodes: 1, w\nstart: X_t = x\n"),
        ("density: there is no name u; names are x, at column 5 of 1 + u", bare + "density: 1 + u\nstart: X_t = x\n"),
        ("between: there is no name w; names are s, d, v0, v1", bare + "between: w\nstart: X_t = x\n"),
        ("no name u", bare + "start: X_t = u\n"),
        ("the nodes have no velocity at the start", bare),
        ("X_t at the start is not finite where x = 0", bare + "start: X_t = 1/x\n"),
        ("start: X_t is given twice", bare + "start: X_t = 1, X_t = x\n"),
        ('a system of nodes alone has no line "relax"', bare + "relax: 1\nstart: X_t = x\n"),
        ('a system of nodes alone has no line "invariant"', bare + "invariant: a = x\nstart: X_t = x\n"),
        ("the file has no equation: H, L, rate", "half_length: 2\n"),
        ('a system with a field has no line "nodes"', SYSTEM + "nodes: 1\n"),
    )):
        path = f"{folder.name}/bad{number}.system"
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        refused(sentence, path)
    refused("it needs a field; nodes alone are for free- schemes", "peakons", "scheme=control-gauss4")
    made = subprocess.run([program, "work-precision", "peakons", "until=2", "--out", folder.name], capture_output=True,
                          text=True, check=False)
    check(made.returncode == 0 and "against a run of free-gauss4 with a step of 0.00625" in made.stdout and
          "control-" not in made.stdout, f"the reference of nodes alone is a free- scheme: {made.stdout}{made.stderr}")
    made = subprocess.run([program, "certify", "free-gauss4", "--on", "peakons"], capture_output=True, text=True, check=False)
    check(made.returncode == 0 and "order 4, measured 4.0" in made.stdout, f"listed nodes are certified: {made.stderr}")
    for between in ("1/0", "v0", "s*v0", "v0 + s*(v1 - v0) + 0*log(s - 1)"):
        refused("it is finite, v0 at s = 0 and v1 at s = 1", "peakons", f"between={between}")
    check(run("peakons", "half_length=800", "steps=1").returncode == 0, "long cells do not overflow")
    refused("cell: the mass matrix is not positive at the start", "peakons", "cell=-m_t^2")
    refused("cell: is 0, and nodes alone move by nothing else", "peakons", "cell=0")
    refused("none of these schemes takes cell=; these do: free-gauss2, free-gauss4", "soliton", "cell=d_t^2")
    for name in ("steepest", "bend", "X"):
        refused(f"{name} is a key of moving meshes", file_of(f"name{name}", f"parameter: {name} = 1"))
    text = SYSTEM.replace("u_t = 0.2*x*exp(-x^2/2)", "u_t = 0.2*x*exp(-x^2/2), X_t = 0.1*cos(pi*x/12)")
    path = file_of("drifts", STEEP, "cell: 0.05*(d_t/d)^2")
    still = states(path, "scheme=free-gauss4", "steps=0")[0]["state"]
    with open(path, "w", encoding="utf-8") as file:
        file.write(text + STEEP + "\ncell: 0.05*(d_t/d)^2\n")
    faint = f"{folder.name}/faint.system"
    with open(faint, "w", encoding="utf-8") as file:
        file.write("field: u\nV: u^2/2\nstart: u = 0.01*exp(-x^2), u_t = 0, X_t = 1.5*cos(pi*x/12)\nhalf_length: 6\n"
                   "points: 7\nschemes: free-gauss4\ncell: 5*(d_t/d)^2\n")
    taken = json.loads(run(faint, "until=4", "dt=0.02", "--json").stdout)
    check(taken["observables"]["field_energy_error"] > 2 and not taken.get("warning") and taken["status"] == "ok",
          f"energy that cells give the field is not lost: {taken['observables']['field_energy_error']:.3g}")
    state, held = (lane["state"] for lane in states(path, "scheme=free-gauss4,multiplier-lobatto4", "steps=0"))
    compare("X_t at the start", state["x_dot"], [0.1 * math.cos(math.pi * x / 12) for x in state["x"]], 1e-14)
    slopes = [-2 / 3 * (x - 0.5) * u for x, u in zip(state["x"], state["u"], strict=True)]
    compare("u follows the nodes", state["u_dot"],
            [0.2 * x * math.exp(-x * x / 2) + s * v for x, s, v in zip(state["x"], slopes, state["x_dot"], strict=True)], 1e-13)
    compare("schemes that hold the mesh have their own", held["x_dot"], still["x_dot"], 1e-14)


def laws_of_variable_meshes():
    """The printed laws of leapfrog's wave on a mesh in space and time, from the levels of the state."""
    made = run("wave", "steps=41", "--state", "--json")  # the steepest place is that where the ring closes
    lane = json.loads(made.stdout)
    state, observables = lane["state"], lane["observables"]
    points = len(state) // 2
    now, before, dt, dx = state[:points], state[points:2 * points], lane["parameters"]["dt"], 2 * math.pi / points
    after = [2 * now[j] - before[j] + (dt / dx) ** 2 * (now[(j + 1) % points] - 2 * now[j] + now[j - 1]) for j in range(points)]
    old, new = ([(((next_[j] - first[j]) / dt) ** 2 + ((at[(j + 1) % points] - at[j]) / dx) ** 2) / 2 for j in range(points)]
                for first, next_, at in ((before, now, before), (now, after, now)))
    near("energy law of a cell", observables["energy_law_residual"],
         max(abs(b - a) for a, b in zip(old, new, strict=True)) / max(new), 1e-12)
    near("energy law of all cells", observables["energy_sum_residual"], abs(sum(new) - sum(old)) / sum(new), 1e-12)
    near("momentum law", observables["momentum_law_residual"], max(abs(new[j] - new[j - 1]) for j in range(points)) / max(new), 1e-12)


densities()
laws_of_variable_meshes()
known_meshes()
smoothing()
free_nodes()
nodes_alone()
sys.exit(len(faults) > 0)
