# SPDX-License-Identifier: GPL-3.0-or-later
"""Systems of forms: numbers of a second program that was written for them, what their equations keep, and what is
refused where.
usage: forms.py GEOMINT"""
import json
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import zipfile

GEOMINT = os.path.abspath(sys.argv[1])
failures = 0


def run(words, **more):
    done = subprocess.run([GEOMINT, "run", *words], capture_output=True, text=True, **more)
    return done.returncode, done.stdout, done.stderr


def check(good, text):
    global failures
    if not good:
        failures += 1
        print(f"forms.py: {text}")


def observed(*words):
    status, out, err = run([*words, "--json"])
    check(status == 0, f"{words}: {err}")
    return json.loads(out)["observables"] if status == 0 else {}


# words; key; the second program's value; how near
NUMBERS = [
    *[(["form-poisson", f"level={level}"], "u_error", error, 1e-9)
      for level, error in ((1, .0942201730), (2, .0232681138), (3, .0057757128), (4, .0014404933))],
    *[(["form-wave", f"level={level}"], "u_error", error, 5e-4 * error)
      for level, error in ((2, 5.56e-2), (3, 1.216e-2), (4, 2.85e-3))],
    *[(["form-heat", f"level={level}"], "u_error", error, 5e-3 * error)
      for level, error in ((2, 1.98e-3), (3, 4.90e-4), (4, 1.18e-4))],
    (["form-shallow"], "h_error", 1.97e-4, 5e-7),
    (["form-age"], "mean", 1.6635545, 6e-8),
    (["form-age", "N=48", "M=20"], "mean", 1.6659149, 1e-7),
    (["form-age", "star=barycentric"], "mean", 1.6459368, 6e-8),
    (["form-age", "star=barycentric", "N=48", "M=20"], "mean", 1.6591496, 6e-8),
    (["form-stokes", "n=20"], "psi_least", -.0997705, 1e-7),
    (["form-stokes", "n=40"], "psi_least", -.0999905, 1e-7),
    (["form-brusselator"], "total_u", 12.5435839, 1e-7),
    (["form-brusselator"], "total_v", 24.9674168, 1e-7),
    (["form-brusselator"], "least", .9318679, 1e-7),
    (["form-brusselator"], "largest", 1.0760845, 1e-7),
    (["form-vorticity", "level=3"], "w_error", .211, 5e-4),
    (["form-vorticity", "level=4"], "w_error", .0550, 5e-5),
    (["form-vorticity", "level=4"], "energy_error", 4.7e-4, 1e-6),
    (["form-vorticity", "level=4", "star=barycentric"], "w_error", .0564, 5e-5),
]
kept = {}
for words, key, value, tolerance in NUMBERS:
    text = " ".join(words)
    kept[text] = kept.get(text) or observed(*words)
    found = kept[text].get(key, math.nan)
    # three digits were given: half of the last one
    check(abs(found - value) <= max(tolerance, 0.5 * 10 ** (math.floor(math.log10(abs(value))) - 2)
                                    if tolerance > 1e-7 else tolerance), f"{text}: {key} is {found}, not {value}")

KEPT = [
    (["form-wave", "until=500", "--max"], "energy_error_max", 1.5e-4),
    (["form-maxwell", "--max"], "charge_max", 1e-14),
    (["form-maxwell", "star=barycentric", "until=20", "--max"], "charge_max", 1e-14),
    (["form-shallow"], "mass", 1e-14),
    (["form-shallow"], "curl", 1e-12),
    (["form-maxwell", "--max"], "energy_error_max", 1.28e-3),
    (["form-maxwell", "dt=.01", "--max"], "energy_error_max", 3.2e-4),
    (["form-darcy"], "defect", 1e-11),
    (["form-heat", "level=4"], "total_error", 1e-14),
    (["form-heat", "scheme=gauss4", "star=barycentric"], "total_error", 1e-14),
    (["form-maxwell", "scheme=midpoint", "--max"], "energy_error_max", 1e-12),
    (["form-maxwell", "scheme=midpoint", "until=20", "star=barycentric", "--max"], "energy_error_max", 1e-12),
    (["form-vorticity", "level=4", "star=barycentric"], "energy_error", 1e-8),
    (["form-vorticity", "level=4"], "enstrophy_error", 1e-7),
]
for words, key, most in KEPT:
    found = observed(*words).get(key, math.nan)
    check(abs(found) <= most, f"{' '.join(words)}: {key} is {found}, more than {most}")

# an implicit scheme takes the exact Jacobian: of what is linear one iteration finds the stages, others check it
for words, most in ((["form-heat", "level=4"], 4), (["form-maxwell", "until=2", "scheme=gauss4", "star=incentric"], 8),
                    (["form-brusselator", "scheme=midpoint", "level=4", "dt=.2", "until=1"], 10)):
    status, out, err = run([*words, "--json"])
    row = json.loads(out) if status == 0 else {"steps": 0, "solves": 1}
    check(0 < row["solves"] <= most * row["steps"], f"{words}: {row['solves']} iterations in {row['steps']} steps")

# meshes of Gmsh: numbers of the second program
CASES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "reference", "exterior")
with open(os.path.join(CASES, "expected.json"), encoding="utf-8") as stream:
    expected = json.load(stream)
cases = {name: observed(os.path.join(CASES, f"{name}.system"))
         for name in ("membrane", "cavity-modes", "sand", "parts", "whirls")}
for name, numbers in expected.items():
    found = cases.get({"plate": "parts", "egg": "whirls"}.get(name, name))
    for key, value in numbers.items():
        near = 1e-6 if name in ("membrane", "cavity-modes", "parts", "whirls") else 1e-9
        check(key == "star" or abs(found.get(key, math.nan) - value) <= near * max(1, abs(value)),
              f"{name}: {key} is {found.get(key)}, not {value}")
check(cases["sand"]["f_residual"] < 1e-14 and cases["membrane"]["u_residual"] < 1e-14, "residuals of equations")

# a group that is a number, and is not there
with open(os.path.join(CASES, "sand.system"), encoding="utf-8") as stream:
    numbered = stream.read().replace("boundary: left f", "boundary: 77 f").replace("plate.msh", os.path.join(CASES, "plate.msh"))
with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "numbered.system")
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(numbered)
    status, out, err = run([path])
    check(status == 1 and "77 is not a part of the boundary" in err, f"group 77 exits {status}: {err}")

# what flows out and what the cells at the left take is all that ages
found = observed("form-age", "interior=upwind")
check(abs(found["outflow"] + found["taken"] - 3) < 1e-12 and found["outflow"] > 2.9, f"form-age: {found}")

# interior products on a shaken torus: which keeps a constant, squares, what is stationary, and signs. The mesh is not
# that of the second program, so sizes agree within a third
for star, product, constant, enstrophy, still in (
        ("circumcentric", "dual", 0, 0, 6.1e-2), ("barycentric", "dual", 0, 0, 0), ("barycentric", "whitney", .86, 3.2e-3, 3.3e-2),
        ("barycentric", "upwind", 0, .20, .19)):
    found = observed("form-transport", f"star={star}", f"interior={product}")
    for key, value in (("constant", constant), ("enstrophy_error", enstrophy), ("c_error", still)):
        small = 1e-13 if key != "enstrophy_error" else 1e-7
        check(abs(found[key] - value) <= (0.34 * value if value else small), f"{star} {product}: {key} is {found[key]}")
    check((found["least"] > math.exp(-2)) == (product == "upwind"), f"{star} {product}: {found['least']}")
check(abs(observed("form-transport", "irregular=0", "star=circumcentric")["c_error"] - 1.8e-4) < 5e-6, "a regular torus")

# the free energy of two liquids falls to that of an independent program, and their total stays
PARTING = ("form-cahn-hilliard", "n=8", "eps=0.2")
check(abs(observed(*PARTING, "until=0")["free_energy"] - .7767425) < 5e-8, "the free energy at the start")
for words in (("scheme=rk4", "dt=1e-5"), ("scheme=midpoint", "dt=1e-3")):
    found = observed(*PARTING, "until=0.05", *words)
    check(abs(found["free_energy"] - .7725167) < 6e-8 and found["total_error"] < 1e-15, f"two liquids, {words}: {found}")

# list --long measures with the star and the product of the file
source = subprocess.run([GEOMINT, "list", "form-transport", "--source"], capture_output=True, text=True).stdout
for line, star, verdict in (("", "circumcentric", "keep"), ("star: galerkin", "barycentric", "keep"),
                            ("interior: upwind", "circumcentric", "change")):
    with tempfile.NamedTemporaryFile("w", suffix=".system") as file:
        file.write(f"{source}{line}\n")
        file.flush()
        told = subprocess.run([GEOMINT, "list", file.name, "--long"], capture_output=True, text=True).stdout
    check(f"; star {star};" in told and f"enstrophy: the equations on this mesh {verdict} it" in told, f"{line}: {told[-400:]}")

# Hodge's three parts, in squares, and the loops; circulations do not depend on the path
TORUS = ["mesh=torus 2 0.8 40 20", "let=a = form(y*z - y/r2, x/r2, x)"]
for words, squares, loops in ((["N=24", "m=3"], (122.813881, 79.474367, 3.680128, 39.659386), 1),
                              (["N=48"], (124.816880, 81.923495, 3.581530, 39.311854), 1),
                              (["N=24", "m=3", "star=barycentric"], (123.707363, 80.313087, 3.734890, 39.659386), 1),
                              (TORUS, (142.965166, 74.864635, 50.921460, 17.179070), 2),
                              (["mesh=sphere 1 2"], (None, None, None, 0), 0)):
    found = observed("form-hodge", *words)
    check(found["betti1"] == loops and found["mixed"] < 1e-14, f"form-hodge {words}: {found}")
    for part, square in zip(("whole", "exact", "coexact", "harmonic"), squares):
        check(square is None or abs(found[f"{part}_square"] - square) < 6e-7, f"form-hodge {words}: {part}: {found}")

# order 2 with every star, on every mesh
for star in ("circumcentric", "barycentric", "incentric"):
    errors = [observed("form-poisson", f"level={level}", f"star={star}")["u_error"] for level in (3, 4)]
    check(1.9 < math.log2(errors[0] / errors[1]) < 2.1, f"star={star}: errors {errors}")
errors = [observed("form-darcy", f"N={n}", f"M={m}") for n, m in ((32, 20), (64, 42))]
check(errors[0]["f_error"] > 4 * errors[1]["f_error"] and errors[1]["p_error"] < 1e-3, f"form-darcy: {errors}")
for mesh, betti in (("torus 2 0.8 24", [1, 2, 1]), ("annulus 1 2 24", [1, 1, 0]), ("disc 1 6", [1, 0, 0])):
    facts = observed("form-wave", f"mesh={mesh}", "until=0")
    check([facts[f"betti{k}"] for k in range(3)] == betti, f"{mesh}: {facts}")

# the line that is wrong, in place of the good one with the same word; where; the sentence's begin
WAVE = """geomint: 1
mesh: sphere 1 2
field: u = 0-form, v = 0-form
rate: u = v
rate: v = laplace(u)
start: u = x*y, v = 0
"""
STEADY = """geomint: 1
mesh: sphere 1 2
unknown: u = 0-form
equation: u; -laplace(u) = x*y
"""
HARMONIC = """geomint: 1
mesh: annulus 1 2 24 3
unknown: f = 1-form
equation: f; -laplace(f) = form(x, y)
"""
REFUSED = [
    (WAVE, "rate: u = v", "rate: u = v + d(u)", "4:11: v is a 0-form and d(u) a 1-form: they cannot be added"),
    (WAVE, "rate: u = v", "rate: u = d(u)*d(v)", "4:11: d(u) is a 1-form and d(v) a 1-form: they cannot be multiplied"),
    (WAVE, "rate: u = v", "rate: u = d(d(d(u)))", "4:11: d is of a 0-form or a 1-form, and d(d(u)) is a 2-form"),
    (WAVE, "rate: u = v", "rate: u = d(v)", "4:11: d(v) is a 1-form, and has to be a 0-form here"),
    (WAVE, "rate: u = v", "rate: u = delta(v)", "4:11: delta is of a 1-form or a 2-form"),
    (WAVE, "rate: u = v", "rate: u = star(lie(d(v), star(u)))", "4:16: the velocity of interior and lie is a dual 1-form"),
    (WAVE, "rate: u = v", "rate: u = inner(u, d(u))*u", "4:11: inner is of two forms of one type"),
    (WAVE, "rate: u = v", "rate: u = d(u, v)", "4:11: d takes one form"),
    (WAVE, "rate: u = v", "rate: u = w", "4:11: there is no name w"),
    (WAVE, "rate: u = v\n", "", "3:8: u has no rate"),
    (WAVE, "field: u = 0-form,", "field: u,", "3:8: u has no degree: write field: u = 0-form"),
    (WAVE, "v = 0-form", "v = 3-form", "3:"),
    (WAVE, "v = 0-form", "u = 0-form", "3:"),
    (WAVE, "mesh: sphere 1 2\n", "", "2:1: a field with a degree needs a line"),
    (WAVE, "start: u = x*y, v = 0\n", "", "3:8: u has no value at the start"),
    (WAVE, "u = x*y", "u = log(x - 2)", "6:8: start: u is not finite at its number"),
    (WAVE, "u = x*y", "u = d(v)", "6:"),
    (WAVE, "sphere 1 2", "sphere 1 10", "10 is not a whole number from 0 to 9"),
    (WAVE, "sphere 1 2", "sphere -1 2", "-1 is not a length"),
    (WAVE, "sphere 1 2", "torus 1 2 20", "its radius 1 has to be above that of its tube, 2"),
    (WAVE, "sphere 1 2", "torus 2 1 20 7", "not an even number"),
    (WAVE, "sphere 1 2", "annulus 2 1 20", "its outer radius 1 has to be above the inner one 2"),
    (WAVE, "sphere 1 2", "cube 1", "2:7: mesh: there is no mesh cube"),
    (WAVE, "sphere 1 2", "sphere; width 2", "2:21: a mesh has at most five numbers, and a rectangle alone names them"),
    (WAVE, "sphere 1 2", "disc 1", "2:7: mesh: disc has the numbers R n"),
    (WAVE, "sphere 1 2", "annulus 1 2 12\nstar: circumcentric", "and its least star entry is -"),
    (WAVE, "sphere 1 2", "sphere 1 2\nstar: round", "3:7: star: is auto, circumcentric"),
    (STEADY, "equation: u; -laplace(u) = x*y\n", "", "3:10: u has no equation"),
    (STEADY, "= x*y", "= x*y\nboundary: top u = 0", "5:11: boundary: top is not a part of the boundary; the parts of sphere are: none"),
    (STEADY, "= x*y", "= x*y\nboundary: all w = 0", "5:15: there is no name w"),
    (STEADY, "= x*y", "= u^2", "4:28: an equation is linear in its unknowns"),
    (STEADY, "= x*y", "= x*y\nequation: u; u = 0", "5:11: u has two equations"),
    (STEADY, "-laplace(u) = x*y", "d(u) = form(x, y)", "4:14: the equation of u, which is a 0-form, is of a 1-form"),
]
def written(text, *words):
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "typed.system"), "w", encoding="utf-8") as stream:
            stream.write(text)
        return observed(os.path.join(folder, "typed.system"), *words)


# files: constant forms of each type, and an unknown, as numbers for tables and as densities and vectors for VTK
CONSTANTS = """geomint: 1
mesh: rectangle 2 1 8 6
star: barycentric
field: a = 0-form, b = 1-form, c = 2-form, p = dual 0-form, r = dual 2-form
unknown: f = 0-form
equation: f; f = x + 3*t
let: turned = star(b)
rate: a = 0, b = 0, c = 0, p = 0, r = 0
start: a = x, b = form(2, 3), c = 5, p = 7, r = 11
dt: 0.5
until: 1
schemes: rk4
"""


def arrays(path):
    """The numbers of an .npz file, and the shapes."""
    found = {}
    with zipfile.ZipFile(path) as archive:
        for name in archive.namelist():
            data = archive.read(name)
            size = struct.unpack("<H", data[8:10])[0]
            head = data[10:10 + size].decode()
            kind = {"<f8": "d", "<i8": "q"}.get(re.search("'descr': '(.*?)'", head)[1])
            shape = [int(n) for n in re.findall("[0-9]+", re.search(r"'shape': \((.*?)\)", head)[1])]
            if kind:
                found[name[:-4]] = shape, struct.unpack(f"<{len(data[10 + size:]) // 8}{kind}", data[10 + size:])
    return found


def blocks(path):
    """The doubles of a .vtu file by their names."""
    data = open(path, "rb").read()
    head, rest = data.split(b"<AppendedData encoding=\"raw\">\n_", 1)
    found = {}
    for name, offset in re.findall(r'Float64" Name="(\w+)".*?offset="(\d+)"', head.decode()):
        size, = struct.unpack("<Q", rest[int(offset):int(offset) + 8])
        found[name] = struct.unpack(f"<{size // 8}d", rest[int(offset) + 8:int(offset) + 8 + size])
    return found


with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "constants.system")
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(CONSTANTS)
    for ending in ("npz", "pvd", "csv"):
        check(run([path, "--save", os.path.join(folder, f"c.{ending}")])[0] == 0, ending)
    table = arrays(os.path.join(folder, "c.npz"))
    (vertices, _), points = table["points"]
    shapes = {name: shape for name, (shape, _) in table.items()}
    edges, triangles = shapes["edges"][0], shapes["triangles"][0]
    check(vertices - edges + triangles == 1 and
          shapes == {"t": [3], "points": [vertices, 2], "triangles": [triangles, 3], "edges": [edges, 2],
                     "dual_vertices": [triangles, 3], "a": [3, vertices], "b": [3, edges], "c": [3, triangles],
                     "p": [3, triangles], "r": [3, vertices], "f": [3, vertices]}, f"shapes {shapes}")
    ends = table["edges"][1]
    check(max(abs(2 * (points[2 * j] - points[2 * i]) + 3 * (points[2 * j + 1] - points[2 * i + 1]) - value)
              for i, j, value in zip(ends[::2], ends[1::2], table["b"][1])) < 1e-14, "the numbers of a 1-form")
    check(abs(sum(table["c"][1]) / 3 - 10) < 1e-13 and abs(sum(table["r"][1]) / 3 - 22) < 1e-13, "2-forms in a table")
    corners, places = table["triangles"][1], table["dual_vertices"][1]
    check(max(abs(sum(points[2 * v + c] for v in corners[3 * t:3 * t + 3]) / 3 - place)
              for t in range(triangles) for c, place in enumerate(places[3 * t:3 * t + 2])) < 1e-14, "centres of mass")
    check(max(abs(value - points[2 * (k % vertices)] - 1.5 * (k // vertices))
              for k, value in enumerate(table["f"][1])) < 1e-14, "an unknown at three times")
    shown = blocks(os.path.join(folder, "c", "000002.vtu"))
    check(sorted(shown) == sorted(["TimeValue", "Points", *"abcprf", "turned"]), f"names {sorted(shown)}")
    for name, value in ("b", (2, 3, 0)), ("turned", (-3, 2, 0)), ("c", (5,)), ("p", (7,)), ("r", (11,)):
        size = len(value)
        check(max(abs(found - value[k % size]) for k, found in enumerate(shown.get(name, [math.nan]))) < 1e-12,
              f"{name} in a .vtu: {shown[name][:6]}")
    with open(os.path.join(folder, "c.csv"), encoding="utf-8") as stream:
        columns = stream.readline().strip().split(",")
    check(len(columns) == 1 + 3 * vertices + edges + 2 * triangles and columns[1] == "a[0]", "columns")

# lists: types, groups, factors, and what the equations keep
def listed(name, *words):
    done = subprocess.run([GEOMINT, "list", name, *words, "--json"], capture_output=True, text=True)
    check(done.returncode == 0, f"list {name}: {done.stderr}")
    return json.loads(done.stdout)


maxwell = listed("form-maxwell")
check(maxwell["splits"] == [["E"], ["B"]] and maxwell["linear"] and maxwell["factors"] == [] and
      [(form["name"], form["line"], form["type"]) for form in maxwell["forms"]] ==
      [("E", "field", "1-form"), ("B", "field", "2-form"), ("energy", "invariant", "number"),
       ("charge", "observe", "number"), ("inside", "let", "0-form")] and
      maxwell["invariants"][0]["kept"] and maxwell["mesh"]["betti"] == [1, 0, 0] and
      maxwell["mesh"]["vertices"] - maxwell["mesh"]["edges"] + maxwell["mesh"]["triangles"] == 1, f"{maxwell}")
vorticity = listed("form-vorticity")
check([form.get("equation") for form in vorticity["forms"][:2]] == [None, "0-form"] and
      [kept["kept"] for kept in vorticity["invariants"]] == [False, True] and
      [factor["symmetric"] for factor in vorticity["factors"]] == [True], f"{vorticity}")
# the lower triangle of the matrix is within its factor: 2562 vertices and 7680 edges
check(vorticity["factors"][0]["entries"] > 2562 + 7680, "the size of a factor")

# the numbers of a rectangle in their order, or with their names
check(observed("form-maxwell", "mesh=rectangle; height 1; width 2; edges 16; strips 10", "steps=20") ==
      observed("form-maxwell", "mesh=rectangle 2 1 16 10", "steps=20"), "numbers with names make another rectangle")
check(observed("form-darcy", "mesh=rectangle 2 1 16; irregular 0.1")["vertices"] ==
      observed("form-darcy", "mesh=rectangle 2 1 16")["vertices"], "the best number of strips is another one")

# a harmonic field goes round both circles alike, and a place is found on every mesh
found = written("""geomint: 1
mesh: annulus 1 2 24 3
let: a = harmonic(form(2*x - y^2/2 - 3*y/(x^2 + y^2), x^2 - x*y + 3*x/(x^2 + y^2)))
observe: far = integral(outer, a)
observe: near = integral(inner, a)
observe: both = integral(all, a)
observe: middle = at(3*x - y + 1, 1.2, 0.7)
let: v = form(2, 3)
let: u = -star(v)
observe: across = max(abs(interior(u, v)))
observe: slow = min(interior(u, u))
observe: fast = max(interior(u, u))
observe: centre = at(star(star(wedge(1, x))), 1.5, 0, 0)
""")
check(abs(found["far"] - 6 * math.pi) < 1e-10 and abs(found["near"] + 6 * math.pi) < 1e-10
      and abs(found["both"]) < 1e-10 and abs(found["middle"] - 3.9) < 1e-12 and abs(found["centre"] - 1.5) < 1e-12
      and found["across"] < 1e-13 and abs(found["slow"] - 13) < 1e-12 and abs(found["fast"] - 13) < 1e-12,
      f"circulations: {found}")

# values that are held change in time, and the stages of implicit schemes see them: collocation at two points is exact
# for a square of the time; a value of the step's begin would be wrong by dt
HELD = """geomint: 1
mesh: rectangle 1 1 6
field: u = 0-form
rate: u = laplace(u) + 2*t
boundary: left u = t^2
boundary: right u = 1 + t^2
start: u = x
exact: u = x + t^2
schemes: gauss4
dt: 0.1
until: 1
"""
check(written(HELD)["u_error"] < 1e-13, "held values of gauss4")
check(written(HELD, "scheme=rk4", "dt=.001", "star=incentric")["u_error"] < 1e-6, "held values of rk4")
found = written(HELD.replace("rate: u = laplace(u) + 2*t", "unknown: v = 0-form\nequation: v; laplace(v) = 0\n"
                             "boundary: left v = t\nboundary: right v = 1 + t\nexact: v = x + t\nrate: u = laplace(u) + 2*v - 2*x"))
check(found["u_error"] < 1e-13 and found["v_error"] < 1e-13, f"held values of unknowns: {found}")

# s is the length along a part of the boundary with the surface on the left, at vertices and along edges
ROUND = """geomint: 1
mesh: rectangle 2 1 16 10
unknown: u = 0-form
equation: u; laplace(u) = 0
field: E = 1-form, B = 1-form, C = 1-form
rate: E = 0, B = 0, C = 0
start: E = 0, B = 0, C = 0
boundary: bottom u = s
boundary: right u = 2 + s
boundary: top u = 3 - s
boundary: left u = 1 - s
boundary: all E = s^2
boundary: all B = form(2, 3)
boundary: all C = 2*B - d(y)
let: velocity = star(E)
boundary: all velocity = s
exact: u = x + y
observe: length = integral(all, E)
observe: lid = integral(top, B)
observe: side = integral(right, C)
observe: ended = integral(d(velocity))
dt: 0.5
until: 1
"""
found = written(ROUND)
check(found["u_error"] < 1e-14 and abs(found["length"] - 72) < 1e-12 and abs(found["lid"] + 4) < 1e-13
      and abs(found["side"] - 5) < 1e-13 and abs(found["ended"] - 18) < 1e-12, f"s along the boundary: {found}")
# a clockwise circle of 24 edges from its first vertex, where an edge of length l has the values k l and (k + 1) l
found = written(ROUND.replace("rectangle 2 1 16 10", "annulus 1 2 24 3").replace("boundary: all E = s^2", "boundary: inner E = s")
                .replace("integral(all, E)", "integral(inner, E)").replace("boundary: all velocity = s\n", "").replace("top", "inner")
                .replace("right", "outer").replace("boundary: bottom u = s\n", "").replace("boundary: left u = 1 - s\n", ""))
check(abs(found["length"] - (48 * math.sin(math.pi / 24)) ** 2 / 2) < 1e-12, f"s along a circle: {found}")

# values made of forms: a steady flow whose vorticity at walls is that of the velocity is the steady one of form-stokes
LID = """geomint: 1
mesh: rectangle 1 1 10
field: w = dual 2-form
unknown: psi = 0-form
let: u = -star(d(psi))
equation: psi; -laplace(psi) = star(w)
rate: w = laplace(w)
boundary: all psi = 0
boundary: top u = -1
boundary: all w = d(u)
start: w = 0
observe: least = min(psi)
schemes: rk4
dt: 0.0008
until: 1
"""
found = written(LID)
check(abs(found["least"] - observed("form-stokes", "mesh=rectangle 1 1 10")["psi_least"]) < 1e-13, f"walls of forms: {found}")
# from the start on: the circulation of the lid, its velocity times its length
with tempfile.TemporaryDirectory() as folder:
    with open(os.path.join(folder, "lid.system"), "w", encoding="utf-8") as stream:
        stream.write(LID)
    state = json.loads(run([os.path.join(folder, "lid.system"), "steps=0", "--state", "--json"])[1])["state"]
check(abs(sum(state) + 1) < 1e-14, f"walls of forms at the start: {sum(state)}")
MADE = (HELD.replace("field: u = 0-form", "field: u = 0-form, v = 0-form\nunknown: q = 0-form\nequation: q; laplace(q) = 0\n"
                     "boundary: left q = v\nboundary: right q = 1 + t^2\nrate: v = 2*t").replace("start: u = x", "start: u = x, v = 0")
        .replace("left u = t^2", "left u = v").replace("right u = 1 + t^2", "right u = q").replace("exact: u =", "exact: q = x + t^2, u ="))
found = written(MADE)
check(found["u_error"] < 1e-13 and found["q_error"] < 1e-13, f"values of other forms: {found}")
found = written(MADE.replace("left q = v", "left q = u"))
check(found["u_error"] < 1e-13 and found["q_error"] < 1e-13, f"values of values that are held: {found}")

# the flow of rooms as text: a lid drives the box of the room `cavity`, to the same steady state on the same mesh
LID = """geomint: 1
mesh: rectangle 1 1 12
field: w = dual 2-form
unknown: psi = 0-form
let: u = -star(d(psi))
equation: psi; -laplace(psi) = star(w)
rate: w = -lie(u, w) + laplace(w)/100
boundary: all psi = 0
boundary: top u = -1
boundary: all w = d(u)
start: w = 0
observe: least = min(psi)
observe: energy = inner(u, u)/2
schemes: rk4
dt: 0.02
until: 40
"""
mine, its = written(LID), observed("cavity", "columns=12", "rows=16", "reynolds=100")
check(abs(mine["least"] / its["psi_min"] - 1) < 1e-8 and abs(mine["energy"] / its["kinetic_energy"] - 1) < 1e-8,
      f"a lid as forms: {mine}, as a room: {its}")
WHIRLS = LID[:LID.index("boundary")].replace("rectangle 1 1 12", "flat-torus 2*pi 2*pi n\nparameter: n = 16; 4 .. 99").replace("/100", "/10") + """start: w = 2*sin(x)*sin(y)
exact: w = 2*sin(x)*sin(y)*exp(-t/5)
schemes: midpoint
dt: 0.02
until: 1
"""
coarse, fine = written(WHIRLS)["w_error"], written(WHIRLS, "n=32")["w_error"]
check(fine < 1e-3 and 1.9 < math.log2(coarse / fine) < 2.1, f"Taylor and Green's whirls: {coarse} {fine}")

# a boundary that a form gives to a let: a disc loses h u through its rim. Steady heating has a closed form; the slowest
# mode is J0(k r) exp(-k^2 t) with k J1(k) = h J0(k). Two lets have the same rim.
ROBIN = """geomint: 1
mesh: disc 1 n
parameter: n = 8; 1 .. 99
parameter: h = 0.7; 0 .. 9
field: u = 0-form
rate: u = star(d(q))
let: q = star(d(u))
boundary: rim q = -h*u
unknown: w = 0-form
equation: w; -star(d(flux)) = 4
let: flux = star(d(w))
boundary: rim flux = -h*w
start: u = mode
exact: u = mode*exp(-k2*t), w = 1 - x^2 - y^2 + 2/h
schemes: gauss4 rk4
dt: 0.01
until: 0.2
"""


def bessel(order, k):
    return sum((-1) ** m * (k / 2) ** (2 * m + order) / math.factorial(m) / math.factorial(m + order) for m in range(12))


low, high = 0.5, 2
for _ in range(60):
    k = (low + high) / 2
    low, high = (low, k) if k * bessel(1, k) > 0.7 * bessel(0, k) else (k, high)
mode = " + ".join(f"{(-k * k / 4) ** m / math.factorial(m) ** 2!r}*r2^{m}" for m in range(1, 9))
ROBIN = ROBIN.replace("mode", f"(1 + {mode})").replace("k2", repr(k * k)).replace("start:", "let: r2 = x^2 + y^2\nstart:")
coarse, fine = written(ROBIN), written(ROBIN, "n=16")
for name in ("u_error", "w_error"):
    check(fine[name] < 5e-4 and 1.9 < math.log2(coarse[name] / fine[name]) < 2.1, f"Robin's boundary, {name}: {coarse} {fine}")
explicit = written(ROBIN, "scheme=rk4", "dt=.001")
check(abs(coarse["u_error"] / explicit["u_error"] - 1) < 1e-4, f"Robin's boundary by rk4: {explicit}")
for value in ("-h*integral(u)/integral(1)", "form(-y, x)", "d(u)"):  # a number, a 1-form by its components, a 1-form
    found = written(ROBIN.replace("rim q = -h*u", f"rim q = {value}") + "observe: lost = integral(rate)\nlet: rate = d(q)\nobserve: mean = integral(u)\n")
    wanted = {"d(u)": 0, "form(-y, x)": 48 * math.sin(2 * math.pi / 48)}.get(
        value, -0.7 * found["mean"] / found["area"] * 96 * math.sin(math.pi / 48))
    check(abs(found["lost"] - wanted) < 1e-12, f"through the rim by {value}: {found['lost']}, not {wanted}")

status, out, err = run(["form-wave", "mesh=there/is/none.msh"])
check(status == 3 and "could not be read" in err, f"a mesh that is not there exits {status}: {err}")
for words, sentence in (
        (["form-poisson", "show=numbers"], "numbers and names are drawn on at most 200 vertices, edges and triangles, and this mesh has 15362"),
        (["form-cochain", "n=60", "show=mesh"], "this mesh has 243: take a coarser one"),
        (["form-poisson", "numbers=yes", "level=2"], "this mesh has 962"),
        (["form-maxwell", "elevation=3"], "the mesh is in the plane"),
        (["form-age", "N=48"], "rectangle: with 48 edges it takes 18 to 30 strips, not 10"),
        (["form-age", "mesh=rectangle 1 0.1 4"], "with 2 strips it takes about 15 edges"),
        (["form-wave", "level=2.5"], "mesh: sphere: 2.5 is not a whole number\n"),
        (["form-cochain", "n=61"], "60"), (["form-heat", "mesh=strip 1 0"], "0 is not a whole number from 1 to 4000")):
    status, out, err = run(words)
    check(status == 1 and sentence in err and out == "", f"{words} exits {status}: {out}{err}  not: {sentence}")

DISC = "mesh: disc 1 3\nunknown: u = 2-form\nequation: u; u = d(form(x, y))\n"
FREE = "unknown: u = 1-form\nequation: u; d(delta(u)) = form(x, y)"
REFUSED += [
    (STEADY, "= x*y", "= x*y\nboundary: all u = 0", "5:11: boundary: all is not a part"),
    (MADE, "left q = v", "left q = q", "6:11: an unknown is held at formulas and fields"),
    (MADE, "right u = q", "right u = 2*u", "6:11: boundary: a value that is held is made of forms that it changes"),
    (MADE, "left q = v", "left q = s*v", "6:20: s, the length along a part of the boundary, is in formulas without forms"),
    (MADE, "left q = v", "left q = d(v)", "6:20: d(v) is a 1-form, and has to be a 0-form here"),
    (MADE, "rate: v = 2*t", "rate: v = s", "8:11: there is no name s"),
    (ROBIN, "rim q = -h*u", "rim q = star(d(q))", "6:16: what a let has on the boundary depends on itself"),
    (ROBIN, "rim q = -h*u", "rim q = star(u)", "6:16: what a let has on the boundary is a 1-form, or its density: a number or a 0-form, "
     "and this is a dual 2-form"),
    (ROBIN, "rate: u = star(d(q))\nlet: q = star(d(u))", "rate: u = -delta(d(u))\nlet: q = d(u)",
     "8:11: a boundary of a let is along a dual 1-form, and this is a 1-form"),
    (ROBIN, "let: q = star(d(u))", "let: q = star(d(u))\nlet: p = star(d(u))", "9:15: p has the same formula, so it would get this boundary, too: "
     "use one let for both"),
    (ROBIN, "let: q = star(d(u))", "let: q = d(u)", "6:16: a boundary of a let is along a dual 1-form"),
    (STEADY, "u = 0-form\nequation: u; -laplace(u) = x*y", "u = 0-form, v = dual 1-form\nlet: a = star(v)\nequation: u; u = 1\n"
     "equation: v; v = star(u)", "6:14: v is a dual 1-form and star(u) a dual 2-form: they cannot be added"),
    (STEADY, "= x*y", "= x*y" + "".join(f"\nlet: a{i} = {i}*u" for i in range(1, 63)), "66:12: a system has at most 62 forms"),
    (STEADY, "= x*y", "= x*y\nexact: w = 0", "5:8: there is no name w"),
    (STEADY, STEADY[11:-1], DISC + "boundary: all u = 0", "5:11: u is a 2-form: a 0-form, a 1-form or a dual 2-form is held"),
    (STEADY, "= x*y", "= x*y\ninterior: up", "5:11: interior: is dual, whitney or upwind"),
    (STEADY, "= x*y", "= x*y\nobserve: a = integral(rim, d(u))", "5:23: observe: rim is not a part"),
    (STEADY, "= x*y", "= x*y\nobserve: a = integral(rim, u)", "5:14: the integral along a part of the boundary is of a 1-form"),
    (STEADY, "= x*y", "= x*y\nobserve: a = integral(u, d(u), u)", "5:14: integral takes a form, after a part"),
    (STEADY, "= x*y", "= x*y\nobserve: a = at(d(u), 1, 2)", "5:14: at is of a 0-form, and this is a 1-form"),
    (STEADY, "= x*y", "= x*y\nobserve: a = at(u, x, 2)", "5:14: the coordinates of at are numbers"),
    (STEADY, "= x*y", "= x*y\nobserve: a = at(u, 1)", "5:14: at takes a form and two or three coordinates"),
    (STEADY, "= x*y", "= x*y\nobserve: a = inner(exact(u), d(u))", "5:20: exact, coexact and harmonic are of a 1-form"),
    (STEADY, "-laplace(u) = x*y", "exact(d(u)) = d(x)", "4:14: an equation has no numbers that are made of its unknowns"),
    (HARMONIC, "annulus 1 2 24 3", "annulus 1 2 24 3", "4:11: equation: the equations do not determine f: 1 number is free"),
    (HARMONIC, "annulus 1 2 24 3", "torus 2 0.8 20", "4:11: equation: the equations do not determine f: 2 numbers are free"),
    (HARMONIC, "-laplace(f) = form(x, y)", "star(laplace(f)) = star(form(x, y))", "f: 1 number is free"),
    (HARMONIC, "unknown: f", "let: edges = star(1)\nunknown: f", "3:14: a form cannot be called edges"),
    (STEADY, "unknown: u = 0-form\nequation: u; -laplace(u) = x*y", FREE, "4:11: equation: the equations do not determine u"),
    (STEADY, "= x*y", "= x*y + t*u", "4:34: the factor of an unknown does not change in time"),
    (WAVE, "sphere 1 2", "flat-torus 1 1 8 10 0.6", "2:7: mesh: flat-torus: vertices are moved by 0.6 of an edge"),
    (WAVE, "sphere 1 2", "word.msh", "2:7: mesh: word.msh is not a Gmsh file"),
    (WAVE, "sphere 1 2", "strip.msh", "mesh: strip.msh cannot be oriented: its triangles disagree along the edge of nodes"),
    (WAVE, "sphere 1 2", "book.msh", "mesh: book.msh: the edge between nodes 1 and 2 belongs to three triangles"),
    (WAVE, "sphere 1 2", "none.msh", "mesh: none.msh has no triangle"),
    (WAVE, "sphere 1 2", "flat.msh\nboundary: door u = 0", "3:11: boundary: door is not a part of the boundary; the parts of flat.msh"),
]


def mesh_of(points, triangles):
    """a file of Gmsh, version 2.2"""
    nodes = [f"{i} {x:.17g} {y:.17g} {z:.17g}" for i, (x, y, z) in enumerate(points, 1)]
    elements = [f"{i} 2 2 1 1 {a + 1} {b + 1} {c + 1}" for i, (a, b, c) in enumerate(triangles, 1)]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes)), *nodes, "$EndNodes",
                      "$Elements", str(len(elements)), *elements, "$EndElements", ""])


def grid(rows, columns, closed, place, left_out=()):
    """two triangles for each square of a grid, in both orientations; rows and columns may close in circles"""
    number = lambda i, j: i % rows * columns + j % columns
    last = (0, 0) if closed else (1, 1)
    squares = [(i, j) for i in range(rows - last[0]) for j in range(columns - last[1]) if (i, j) not in left_out]
    triangles = [triangle for i, j in squares
                 for triangle in ((number(i, j), number(i + 1, j), number(i + 1, j + 1)),
                                  (number(i, j), number(i, j + 1), number(i + 1, j + 1)))]
    used = sorted({k for triangle in triangles for k in triangle})
    new = {k: i for i, k in enumerate(used)}
    return ([place(k // columns, k % columns) for k in used], [tuple(new[k] for k in triangle) for triangle in triangles])


def ellipsoid(level):
    """an octahedron, cut in four"""
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    triangles = [(a, b, c) for a in (0, 1) for b in (2, 3) for c in (4, 5)]
    for _ in range(level):
        middles, cut = {}, []
        for a, b, c in triangles:
            sides = []
            for p, q in ((a, b), (b, c), (c, a)):
                key = (min(p, q), max(p, q))
                if key not in middles:
                    middle = [(u + v) / 2 for u, v in zip(points[p], points[q])]
                    middles[key] = len(points)
                    points.append(tuple(u / math.hypot(*middle) for u in middle))
                sides.append(middles[key])
            cut += [(a, sides[0], sides[2]), (b, sides[0], sides[1]), (c, sides[1], sides[2]), tuple(sides)]
        triangles = cut
    return [(2 * x, y, z) for x, y, z in points], triangles


def tyre(i, j):
    a, b = 2 * math.pi * i / 48, 2 * math.pi * j / 24
    return (2 + .8 * math.cos(b)) * math.cos(a), (2 + .8 * math.cos(b)) * math.sin(a), .8 * math.sin(b)


STOKES = """geomint: 1
mesh: surface.msh
field: u = 0-form
rate: u = laplace(u)
start: u = 1 + x + y*z
let: a = form(y*z - y, x*x, x*y)
observe: outside = integral(d(a)){around}
observe: square = max(abs(star(d(d(u))))) + max(abs(star(d(d(x*y)))))
invariant: total = integral(u)
scheme: midpoint
dt: 0.01
until: 0.1
""".replace("scheme:", "schemes:")
HOLES = grid(13, 25, False, lambda i, j: (j / 12, i / 12, 0), {(i, j) for i in range(4, 8) for j in (4, 5, 6, 15, 16)})
for name, mesh, betti, area, near in (("ellipsoid", ellipsoid(4), [1, 0, 1], 21.4784, .01),
                                      ("tyre", grid(48, 24, True, tyre), [1, 2, 1], 4 * math.pi ** 2 * 1.6, .01),
                                      ("plate", HOLES, [1, 2, 0], 2 - 20 / 144, 1e-13)):
    around = "" if betti[2] else " - integral(all, a)"
    with tempfile.TemporaryDirectory() as folder:
        for file, text in (("surface.msh", mesh_of(*mesh)), ("it.system", STOKES.replace("{around}", around))):
            with open(os.path.join(folder, file), "w", encoding="utf-8") as stream:
                stream.write(text)
        found = observed(os.path.join(folder, "it.system"))
    check([found[f"betti{k}"] for k in range(3)] == betti and abs(found["area"] / area - 1) < near
          and abs(found["outside"]) < 1e-13 and found["square"] == 0 and found["total_error"] < 1e-13, f"{name}: {found}")

STRIP = [f(i, side) for i in range(7) for side in (.3, -.3) for f in [lambda i, side: (
    (1 + side * math.cos(math.pi * i / 7)) * math.cos(2 * math.pi * i / 7),
    (1 + side * math.cos(math.pi * i / 7)) * math.sin(2 * math.pi * i / 7), side * math.sin(math.pi * i / 7))]]
FILES = {"word.msh": "hello",
         "strip.msh": mesh_of(STRIP, [triangle for i in range(7) for p, q in [(2 * i, 2 * i + 1)]
                                      for r, s in [((2 * i + 2) % 14 + (i == 6), (2 * i + 3) % 14 - (i == 6))]
                                      for triangle in ((p, q, r), (q, s, r))]),
         "book.msh": mesh_of([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, -1, 0)], [(0, 1, 2), (0, 1, 3), (0, 1, 4)]),
         "none.msh": mesh_of([(0, 0, 0), (1, 0, 0)], []),
         "flat.msh": mesh_of([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])}
with tempfile.TemporaryDirectory() as folder:
    for name, text in FILES.items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as stream:
            stream.write(text)
    for text, old, new, sentence in REFUSED:
        assert old in text, old
        with open(os.path.join(folder, "wrong.system"), "w", encoding="utf-8") as stream:
            stream.write(text.replace(old, new, 1))
        status, out, err = run(["wrong.system"], cwd=folder)
        check(status == 1 and sentence in err and out == "" and sorted(os.listdir(folder)) == sorted([*FILES, "wrong.system"]) and len(err.splitlines()) in (1, 3),
              f"{new!r} exits {status}: {out}{err}  not: {sentence}")

sys.exit(failures > 0)
