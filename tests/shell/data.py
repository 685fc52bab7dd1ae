#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What leaves the program: `run --save`, `--save-tracks`, `--checkpoint` and `--continue`, read by NumPy and, where
it is installed, by VTK.

    data.py GEOMINT"""

import contextlib
import csv
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree
import zipfile

from with_numpy import numpy

_, most = resource.getrlimit(resource.RLIMIT_FSIZE)
resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30 if most < 0 else most, most))  # whatever goes wrong, disks stay usable
GEOMINT = os.path.abspath(sys.argv[1])
TANGENTS = ("q", "xi1_q", "xi2_q", "p", "xi1_p", "xi2_p")  # of the disc: a point with two tangent vectors
faults = 0


def check(holds, what):
    global faults
    if not holds:
        faults += 1
        print("data:", what, file=sys.stderr)


def geomint(words, status=0, **more):
    done = subprocess.run([GEOMINT] + words.split(), capture_output=True, text=True, timeout=600, **more)
    allowed = status if isinstance(status, tuple) else (status,)
    check(done.returncode in allowed, f"{words}: exit status {done.returncode}, not {status}: {done.stderr}")
    return done


def state_after(words, steps):
    """The final state as JSON tells it, by components and members."""
    told = json.loads(geomint(f"run {words} steps={steps} --json --state").stdout)
    n, m = map(int, re.search(r"n = (\d+) components, m = (\d+)", told["layout"]).groups())
    return numpy.array(told["state"], dtype=float).reshape(n, m)


def same(one, other):
    one, other = numpy.asarray(one), numpy.asarray(other)
    return one.shape == other.shape and one.tobytes() == other.tobytes()


def rows_equal_states():
    """Each array of each row equals the block of --state that bears its name."""
    def of(words, blocks, steps):
        geomint(f"run {words} steps={steps} --save s.npz")
        with numpy.load("s.npz", allow_pickle=False) as saved:
            meta = json.loads(str(saved["meta"]))
            check(meta["scene"] == words.split()[0] and meta["status"] == "ok" and meta["units"]["t"],
                  f"{words}: meta {meta}")
            check(saved["t"].shape == (steps + 1,), f"{words}: t has the shape {saved['t'].shape}")
            blocks = [(name, count or saved[name].shape[1]) for name, count in blocks]
            for step in range(steps + 1):
                state = state_after(words, step)
                place = 0
                for name, count in blocks:
                    block = state[place:place + count].reshape(saved[name][step].shape)
                    check(same(block, saved[name][step]),
                          f"{words}: {name} of row {step} is not that of --state")
                    place += count
    of("kepler scheme=rk4 dt=0.1", [("q1", 1), ("q2", 1), ("p1", 1), ("p2", 1)], 6)
    of("disc scheme=midpoint points=7", [(name, 1) for name in TANGENTS], 4)
    of("abc", [("x", 1), ("y", 1), ("z", 1)], 3)
    of("stiff system=fpu", [("x", 3), ("y", 3), ("p_x", 3), ("p_y", 3)], 3)
    of("sine-gordon points=101", [("u", 101), ("u_other", 101), ("other_time", 1)], 3)
    of("nls points=64", [("psi_re", 64), ("psi_im", 64)], 3)
    of("burgers dx=.05 test=front", [("u", None)], 2)
    of("soliton points=21", [("u", 21), ("x", 21), ("u_dot", 21), ("x_dot", 21)], 3)


def shapes():
    """Members and mesh have axes of their own; what does not change is there once."""
    geomint("run disc points=7 scheme=rk4,midpoint steps=3 --save new/folder/d.npz")
    with numpy.load("new/folder/d.npz", allow_pickle=False) as saved:
        names = {f"lane{i}/{name}" for i in (0, 1) for name in ("t", "meta") + TANGENTS}
        check(set(saved.files) == names, f"arrays of two lanes: {saved.files}")
        members = saved["lane0/q"].shape[1]
        check(saved["lane1/p"].shape == (4, members) and members > 6, "members are the second axis")
    geomint("run sine-gordon points=101 steps=2 --save s.npz")
    with numpy.load("s.npz", allow_pickle=False) as saved:
        check(saved["grid"].shape == (101,) and saved["u"].shape == (3, 101), "a grid, and u over it")
    # fields of one's own that evolve by rates have their grid; between walls what is seen of it
    with open("wall.system", "w") as file:
        file.write("field: u v\nrate: u = u_xx\nrate: v = -v_x*u + v_xx\nstart: u = exp(-x^2), v = exp(-x^2)\n"
                   "half_length: 5\npoints: 41\ndt: 0.01\nuntil: 0.02\n")
    for walls, points in (("", 41), ("boundary=walls", 41)):
        geomint(f"run wall.system scheme=rk4 {walls} --save wall.npz")
        with numpy.load("wall.npz") as saved:
            check(saved["grid"].shape == (points,) and saved["u"].shape == (3, points) and saved["v"].shape == (3, points)
                  and abs(saved["u"][0] - numpy.exp(-saved["grid"]**2)).max() < 1e-12, f"the grid of rates {walls}")
    geomint("run soliton points=21 steps=2 --save s.npz")
    with numpy.load("s.npz", allow_pickle=False) as saved:
        check(saved["x"].shape == saved["u"].shape == (3, 21), "x(t, i) of a moving mesh")
        check(bool((numpy.diff(saved["x"], axis=1) > 0).all()), "nodes in their order")
    geomint("run vortices steps=2 --save s.npz")
    with numpy.load("s.npz", allow_pickle=False) as saved:
        check(saved["x"].ndim == 2 and saved["x"].shape == saved["y"].shape, "x(t, vortex)")


def dual_areas(points, triangles):
    """The areas of the circumcentric dual cells: of each corner, to the circumcentre, by its angles' cotangents."""
    areas = numpy.zeros(len(points))
    a, b, c = (points[triangles[:, k]] for k in range(3))
    for one, two, opposite, first, second in ((a, b, c, 0, 1), (b, c, a, 1, 2), (c, a, b, 2, 0)):
        to_one, to_two = one - opposite, two - opposite
        cross = to_one[:, 0] * to_two[:, 1] - to_one[:, 1] * to_two[:, 0]
        part = (to_one * to_two).sum(axis=1) / cross * ((one - two) ** 2).sum(axis=1) / 8
        for corner in (first, second):
            numpy.add.at(areas, triangles[:, corner], part)
    return areas


def observables(path, key):
    with open(path, newline="") as file:
        return [(float(row["t"]), float(row[key])) for row in csv.DictReader(file)]


def flows():
    geomint("run room steps=8 --every 2 --save r.npz --csv r.csv")
    told = observables("r.csv", "scalar_total")
    with numpy.load("r.npz", allow_pickle=False) as saved:
        points, triangles = saved["points"], saved["triangles"]
        check(points.shape[1] == 2 and triangles.shape[1] == 3 and triangles.dtype == numpy.int64, "a mesh")
        areas = dual_areas(points, triangles)
        check(len(saved["t"]) == len(told) == 5, "a row at the start and every second step")
        for (t, total), time_saved, scalar in zip(told, saved["t"], saved["scalar"]):
            check(t == time_saved, "the time of the history")
            check(abs(float(areas @ scalar) - total) <= 1e-12 * max(1, abs(total)), "the scalar's total")
        psi, velocity = saved["stream_function"][-1], saved["velocity"][-1]
        a, b, c = (points[triangles[:, k]] for k in range(3))
        cross = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
        pa, pb, pc = (psi[triangles[:, k]] for k in range(3))
        slope = ((pb - pa)[:, None] * (c - a) - (pc - pa)[:, None] * (b - a)) / cross[:, None]
        u = slope[:, 0] * -1  # d psi / dy = ((pb - pa) (c - a)_x - (pc - pa) (b - a)_x) / -cross
        check(bool(numpy.allclose(velocity[:, 0], u, atol=1e-9)), "u = d psi / dy on every triangle")
        check(bool(numpy.isnan(saved["pressure"][0]).all() and numpy.isfinite(saved["pressure"][1:]).all()),
              "pressure after the first step")


def read_vtu(path):
    """The arrays of a .vtu file by name, from its appended bytes."""
    with open(path, "rb") as file:
        data = file.read()
    start = data.index(b"_", data.index(b"<AppendedData")) + 1
    head = data[:start] + b"</AppendedData></VTKFile>"
    arrays = {}
    for array in xml.etree.ElementTree.fromstring(head).iter("DataArray"):
        at = start + int(array.get("offset"))
        size = int(numpy.frombuffer(data, "<u8", 1, at)[0])
        kind = {"Float64": "<f8", "Int64": "<i8", "UInt8": "u1"}[array.get("type")]
        values = numpy.frombuffer(data, kind, size // numpy.dtype(kind).itemsize, at + 8)
        width = int(array.get("NumberOfComponents", 1))
        arrays[array.get("Name")] = values.reshape(-1, width) if width > 1 else values
    return arrays


def entries(path):
    return [(float(e.get("timestep")), e.get("file"))
            for e in xml.etree.ElementTree.parse(path).getroot().iter("DataSet")]


def vtk():
    geomint("run room steps=4 --save v/r.pvd --csv r.csv")
    geomint("run room steps=4 --save r.npz")
    told = observables("r.csv", "scalar_total")
    listed = entries("v/r.pvd")
    with numpy.load("r.npz", allow_pickle=False) as saved:
        tracers = "tracer_x" in saved.files
        mesh = [entry for entry in listed if "tracers" not in entry[1]]
        check(len(mesh) == 5 and len(listed) == (10 if tracers else 5), f"rows of a room: {listed}")
        areas = dual_areas(saved["points"], saved["triangles"])
        for row, (t, name) in enumerate(mesh):
            arrays = read_vtu(os.path.join("v", name))
            check(t == arrays["TimeValue"][0] == told[row][0], "model time")
            check(same(arrays["scalar"], saved["scalar"][row]), "the scalar of npz and of vtu")
            check(same(arrays["velocity"][:, :2], saved["velocity"][row]), "velocity")
            check(abs(float(areas @ arrays["scalar"]) - told[row][1]) <= 1e-12, "the scalar's total")
            check(same(arrays["connectivity"].reshape(-1, 3), saved["triangles"]), "the triangles")
    for words, points, cells in (("sine-gordon points=101", 101, 1), ("soliton points=21", 21, 1),
                                 ("kepler", 1, 1)):
        geomint(f"run {words} steps=2 --save w.pvd")
        for t, name in entries("w.pvd"):
            arrays = read_vtu(name)
            check(arrays["Points"].shape == (points, 3) and len(arrays["types"]) == cells, f"{words} for VTK")
    double = "run system H=p^2/2+q^2/2--1 q=1 p=0 scheme=verlet steps=1 --save "  # XML has no -- in comments
    geomint(double + "w.pvd")
    geomint(double + "w.npz")
    with open("w.pvd", encoding="utf-8") as file, numpy.load("w.npz", allow_pickle=False) as saved:
        notes = re.findall("<!-- (.*) -->", file.read())
        check(len(notes) == 1 and json.loads(notes[0]) == json.loads(str(saved["meta"])), f"what {notes} is")
    check(entries("w.pvd")[1][0] > 0, "a list with a comment")
    try:
        import vtk as library
    except ImportError:
        print("data: VTK is not installed: its own reader is not asked")
        return
    for _, name in mesh:
        reader = library.vtkXMLUnstructuredGridReader()
        reader.SetFileName(os.path.join("v", name))
        reader.Update()
        grid = reader.GetOutput()
        scalar = grid.GetPointData().GetArray("scalar")
        total = sum(areas[k] * scalar.GetValue(k) for k in range(scalar.GetNumberOfTuples()))
        row = mesh.index((_, name))
        check(abs(total - told[row][1]) <= 1e-12, "the scalar's total by VTK")
        check(grid.GetFieldData().GetArray("TimeValue").GetValue(0) == _, "model time by VTK")
        check(grid.GetCellData().GetArray("velocity").GetNumberOfComponents() == 3, "vectors for VTK")
    geomint("run taylor-green steps=2 --save torus.pvd")
    reader.SetFileName(os.path.join("torus", "000002.vtu"))
    reader.Update()
    sizes = library.vtkCellSizeFilter()
    sizes.SetInputData(reader.GetOutput())
    sizes.Update()
    areas = sizes.GetOutput().GetCellData().GetArray("Area")
    total = sum(areas.GetValue(k) for k in range(areas.GetNumberOfTuples()))
    check(abs(total - 1) <= 1e-12, f"the torus' area by VTK is {total}")


def read_xdmf(path):
    """Of each lane the rows: the time, and of each grid the arrays by name."""
    def values(item):
        shape = [int(n) for n in item.get("Dimensions").split()]
        if item.get("Format") == "XML":
            return numpy.array(item.text.split(), dtype=int).reshape(shape)
        kind = {"Float": "<f8", "Int": "<i8"}[item.get("NumberType")]
        return numpy.fromfile(os.path.join(os.path.dirname(path), item.text), kind, numpy.prod(shape),
                              offset=int(item.get("Seek"))).reshape(shape)
    return [[(float(row.find("Time").get("Value")),
              {grid.get("Name"): {part.get("Name", part.tag): values(part.find("DataItem")) for part in grid if part.tag != "Time"}
               for grid in row.findall("Grid")}) for row in lane.findall("Grid")]
            for lane in xml.etree.ElementTree.parse(path).getroot().find("Domain")]


def series():
    """An .xdmf has the numbers of the .vtu files, in one file a lane, and what does not change once."""
    for words in ("room steps=4", "taylor-green steps=2", "sine-gordon points=101 steps=3", "soliton points=21 steps=2",
                  "kepler scheme=verlet,rk4 steps=3", "disc points=7 steps=2", "vortices steps=2"):
        geomint(f"run {words} --save x/m.xdmf")
        geomint(f"run {words} --save m.pvd")
        lanes = read_xdmf("x/m.xdmf")
        rows = [(t, grids[name]) for lane in lanes for t, grids in lane for name in grids]
        listed = entries("m.pvd")
        check(len(rows) == len(listed) and sorted(os.listdir("x")) == ["m", "m.xdmf"], f"{words}: {len(rows)} of {len(listed)} grids")
        check(sorted(os.listdir("x/m")) == [f"lane{i}.bin" for i in range(len(lanes))], f"{words}: files of an .xdmf")
        for (t, grid), (time_listed, name) in zip(rows, listed):
            alone = read_vtu(name)
            check(t == time_listed, f"{words}: the times of an .xdmf")
            check(same(grid.pop("Geometry"), alone["Points"]), f"{words}: the points at {t}")
            check(same(grid.pop("Topology").ravel(), alone["connectivity"]), f"{words}: the cells at {t}")
            check(set(grid) == set(alone) - {"TimeValue", "Points", "connectivity", "offsets", "types"}, f"{words}: {set(grid)}")
            check(all(same(grid[key].ravel(), alone[key].ravel()) for key in grid), f"{words}: the numbers at {t}")
        shutil.rmtree("m")
        shutil.rmtree("x")
    geomint("run room steps=40 --save m.xdmf")
    geomint("run room steps=40 --save n.pvd")
    size = sum(os.path.getsize(f"n/{name}") for name in os.listdir("n"))
    check(os.path.getsize("m/lane0.bin") < 0.52 * size, f"{os.path.getsize('m/lane0.bin')} bytes, and {size} with a mesh in each row")
    for words in ("kepler scheme=verlet,rk4", "room"):
        geomint(f"run {words} steps=4 --checkpoint m.check --save c.xdmf")
        geomint(f"run {words} steps=9 --continue m.check --save c.xdmf")
        geomint(f"run {words} steps=9 --save d.xdmf")
        check(bytes_of("c.xdmf").replace(b">c/", b">d/") == bytes_of("d.xdmf"), f"{words}: an .xdmf gone on with")
        check(all(bytes_of(f"c/{name}") == bytes_of(f"d/{name}") for name in os.listdir("d")), f"{words}: rows gone on with")
    geomint("run sine-gordon steps=300 --save whole.xdmf")
    for size in (2000, 200000, 700000):
        done = geomint("run sine-gordon steps=300 --save some.xdmf", 3, preexec_fn=no_room_for(size))
        told = re.fullmatch("geomint: some.xdmf ends after ([0-9]+) rows: File too large\n", done.stderr)
        check((told is None) == (size == 2000) and len(done.stderr.splitlines()) == 1, f"no room for all rows: {done.stderr}")
        if told is None:
            check(not os.path.exists("some") and not os.path.exists("some.xdmf"), "no room for a row: nothing stays")
            continue
        some, whole = read_xdmf("some.xdmf")[0], read_xdmf("whole.xdmf")[0]
        check(len(some) == int(told[1]) > 2 and all(same(one["state"]["u"], other["state"]["u"]) for (_, one), (_, other) in
                                                    zip(some, whole)), f"the rows that fit into {size} bytes")
        check(bytes_of("whole/lane0.bin").startswith(bytes_of("some/lane0.bin")), f"nothing beside the rows that fit into {size} bytes")
    process = subprocess.Popen([GEOMINT] + "run kepler steps=1e12 --yes --every 1000 --save i.xdmf".split(),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while not os.path.exists("i.xdmf"):
        time.sleep(0.01)
    process.kill()
    process.wait()
    check(len(read_xdmf("i.xdmf")[0]) >= 1, "an .xdmf of a run that was killed")


def warm():
    room = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "share", "rooms", "heated.room")
    geomint(f"run {room} steps=2 --save v/h.pvd --csv h.csv")
    geomint(f"run {room} steps=2 --save h.npz")
    means = observables("h.csv", "temperature_mean")
    with numpy.load("h.npz", allow_pickle=False) as saved:
        areas = dual_areas(saved["points"], saved["triangles"])
        mesh = [entry for entry in entries("v/h.pvd") if "tracers" not in entry[1]]
        check(len(mesh) == 3, "rows of a warm room")
        with open(room, encoding="utf-8") as file:
            check(json.loads(str(saved["meta"]))["room"] == file.read(), "the room's text")
        for row, (t, name) in enumerate(mesh):
            warmth = saved["temperature"][row]
            check(same(read_vtu(os.path.join("v", name))["temperature"], warmth), "the temperature of npz and of vtu")
            check(abs(float(areas @ warmth) / areas.sum() - means[row][1]) <= 1e-9, "the mean temperature")


def tables():
    geomint("run kepler steps=5 --save k.csv")
    geomint("run kepler steps=5 --save k.npz")
    with open("k.csv", newline="") as file:
        rows = list(csv.reader(file))
    with numpy.load("k.npz", allow_pickle=False) as saved:
        check(rows[0] == ["t", "q1", "q2", "p1", "p2"], f"a head: {rows[0]}")
        for column, name in enumerate(rows[0]):
            values = numpy.array([float(row[column]) for row in rows[1:]])
            check(same(values, saved[name]), f"{name} in CSV and in npz")
    geomint("run nls points=8 steps=1 --save n.csv")
    with open("n.csv") as file:
        head = file.readline().strip().split(",")
    check(head == ["t"] + [f"psi_re[{i}]" for i in range(8)] + [f"psi_im[{i}]" for i in range(8)], f"head {head}")
    done = geomint("run nls points=8,16 steps=1 --save two.csv", 1)
    check(".npz does" in done.stderr and done.stdout == "" and not os.path.exists("two.csv"), "lanes of two sizes in one table")


def rows():
    """Which steps have a row."""
    def times(words):
        geomint(f"run kepler scheme=verlet {words} --save k.npz")
        with numpy.load("k.npz") as saved:
            return list(numpy.round(saved["t"], 9))
    check(times("dt=0.1 steps=7 --every 3") == [0, .3, .6, .7], "every third step and the end")
    check(times("dt=0.1 until=1 --interval 0.25") == [0, .2, .5, .8, 1] or
          times("dt=0.1 until=1 --interval 0.25") == [0, .3, .5, .8, 1], "the steps next to .25, .5 ...")
    check(times("dt=0.1 steps=3 --interval 0.01") == [0, .1, .2, .3], "no more rows than steps")
    check(times("steps=0") == [0], "no steps: one row")
    geomint("run kepler --every 2 --interval 1 --save k.npz", 1)
    geomint("run kepler --interval 0 --save k.npz", 1)


def profiles():
    for words, columns in (("sine-gordon points=101", ["u", "u_other"]), ("kdv points=101", ["u", "u_other"]),
                           ("wave points=64", ["u", "u_other"]), ("nls points=64", ["psi_re", "psi_im"]),
                           ("burgers dx=.05", ["u"]), ("soliton points=21", ["u", "u_dot", "x_dot"])):
        geomint(f"run {words} steps=3 --profile p.csv --save p.npz")
        with open("p.csv", newline="") as file:
            told = list(csv.DictReader(file))
        with numpy.load("p.npz") as saved:
            check(list(told[0]) == ["scene", "lane", "scheme", "t", "x"] + columns, f"{words}: {list(told[0])}")
            for name in columns:
                values = numpy.array([float(row[name]) for row in told])
                check(same(values, saved[name][-1]), f"{words}: {name} of the profile")
    check("no profiles" in geomint("run kepler steps=3 --profile p.csv", 1).stderr, "a profile of an orbit")


def tracks():
    geomint("run henon-heiles until=200 --save-tracks t.npz")
    with numpy.load("t.npz", allow_pickle=False) as saved:
        keys = [name for name in saved.files if not name.endswith("_t")]
        check(json.loads(str(saved["meta"]))["scene"] == "henon-heiles", "what the tracks are of")
        check(len(keys) > 1 and all(len(saved[k]) == len(saved[k + "_t"]) > 0 for k in keys if k != "meta"),
              f"tracks {saved.files}")
    check("npz" in geomint("run henon-heiles until=2 --save-tracks t.csv", 1).stderr, "tracks to a CSV file")
    # those that are thinned, or hold the last entries alone, have the states of the saved rows: every eighth of 50000
    geomint("run kepler scheme=verlet dt=0.01 steps=50000 --save-tracks t.npz --save s.npz")
    with numpy.load("t.npz") as saved, numpy.load("s.npz") as rows:
        states = numpy.stack([rows[name] for name in ("q1", "q2", "p1", "p2")], axis=1)
        check(same(saved["past_t"], rows["t"][::8]) and same(saved["past"], states[::8]), "a track that was thinned")
        last = len(saved["trail"])
        check(last > 1000 and same(saved["trail_t"], rows["t"][-last:]) and same(saved["trail"], states[-last:]), "a trail")


def memory():
    """It does not grow with the rows."""
    def peak(steps):
        script = ("import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True, "
                  "stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL); "
                  "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")
        words = f"run kepler scheme=verlet steps={steps} --save m.npz".split()
        return int(subprocess.run([sys.executable, "-c", script, GEOMINT] + words, capture_output=True, text=True,
                                  check=True).stdout)
    few, many = peak(100000), peak(1000000)
    check(zipfile.ZipFile("m.npz").testzip() is None, "the checksums of a million rows")
    check(many - few < 2048, f"memory of a million rows: {many} KiB, of a tenth of them {few}")


def bytes_of(path):
    with open(path, "rb") as file:
        return file.read()


def numbers_of(path):
    with numpy.load(path, allow_pickle=False) as saved:
        return {name: saved[name].tobytes() for name in saved.files if not name.endswith("meta")}


def killed():
    """SIGKILL leaves a readable file or none, and a run that goes on ends where an undisturbed one does."""
    words = "run kepler scheme=gauss8,verlet steps=900000 --every 50 --max --json --state"
    whole = geomint(f"{words} --save whole.npz").stdout
    rows_of_whole = numbers_of("whole.npz")
    for late in (None, 0.1, 0.7):
        for path in ("k.npz", "k.check"):
            if os.path.exists(path):
                os.remove(path)
        shutil.rmtree("k.npz.part", ignore_errors=True)
        process = subprocess.Popen([GEOMINT] + f"{words} --save k.npz --checkpoint k.check".split(),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if late is None:
            time.sleep(0.5)
        else:
            while not os.path.exists("k.check") and process.poll() is None:
                time.sleep(0.05)
            time.sleep(late)
        process.kill()
        process.wait()
        if os.path.exists("k.npz"):
            numbers_of("k.npz")
        goes_on = " --continue k.check" if os.path.exists("k.check") else ""
        end = geomint(f"{words} --save k.npz --checkpoint k.check{goes_on}").stdout
        without = lambda text: re.sub(r'"seconds":[^,]*', "", text)
        check(without(end) == without(whole), f"a run that was killed and gone on with ({late})")
        check(numbers_of("k.npz") == rows_of_whole, f"a save that was killed and gone on with ({late})")
        check(os.path.isdir("k.npz.part"), "what the file was made of stays with --checkpoint")


def continued():
    """A longer end, bit for bit: states, counts, maxima and saved rows."""
    for ending in ("csv", "pvd"):
        geomint(f"run kepler scheme=verlet,rk4 steps=7 --every 2 --checkpoint c.check --save c.{ending}")
        geomint(f"run kepler scheme=verlet,rk4 steps=12 --every 2 --continue c.check --save c.{ending}")
        geomint(f"run kepler scheme=verlet,rk4 steps=12 --every 2 --save d.{ending}")
        check(bytes_of(f"c.{ending}").replace(b'"c/', b'"d/') == bytes_of(f"d.{ending}"), f"{ending} gone on with")
    for words in ("kepler scheme=verlet,rk4 dt=0.1", "disc points=9", "sine-gordon points=101", "soliton points=21",
                  "room", "vortices", "stiff", "burgers dx=.05",
                  "kdv scheme=zabusky-kruskal-invariant,evolution-projection lambda=0.6 points=301 dt=0.002"):
        geomint(f"run {words} steps=7 --every 2 --max --json --checkpoint c.check --save c.npz")
        one = geomint(f"run {words} steps=12 --every 2 --max --json --state --continue c.check --save c.npz")
        other = geomint(f"run {words} steps=12 --every 2 --max --json --state --save d.npz")
        strip = lambda text: re.sub(r'"seconds":[^,]*', "", text)
        check(strip(one.stdout) == strip(other.stdout), f"{words}: gone on with, it ends elsewhere")
        check(numbers_of("c.npz") == numbers_of("d.npz"), f"{words}: saved rows of a run gone on with")
        check(not os.path.exists("c.npz.part"), "what the file was made of is gone")
    geomint("run kepler steps=7 --every 2 --checkpoint c.check --save c.npz")
    for spacing in ("--every 3", "--interval 0.5", ""):
        refused = geomint(f"run kepler steps=12 {spacing} --continue c.check --save c.npz", 3)
        check("spaced otherwise" in refused.stderr, f"rows of another spacing ({spacing})")
    geomint("run kepler steps=12 --every 2 --continue c.check --save c.npz")
    # rows of another run to the same file are not taken for those of the checkpoint
    for ending in ("npz", "csv", "pvd", "xdmf"):
        geomint(f"run kepler steps=7 --checkpoint c.check --save c.{ending}")
        geomint(f"run kepler eccentricity=0.3 steps=9 --checkpoint other.check --save c.{ending}")
        refused = geomint(f"run kepler steps=12 --continue c.check --save c.{ending}", 3)
        check("of another run" in refused.stderr and len(refused.stderr.splitlines()) == 1, "rows of another run")
        geomint(f"run kepler eccentricity=0.3 steps=12 --continue other.check --save c.{ending}")
        geomint(f"run kepler eccentricity=0.3 steps=12 --save d.{ending}")
        check(bytes_of(f"c.{ending}").replace(b'"c/', b'"d/').replace(b">c/", b">d/") == bytes_of(f"d.{ending}"), "a refused run left the other's")
    # rows that are fewer than the checkpoint counts
    for ending in ("npz", "csv", "pvd", "xdmf"):
        geomint(f"run kepler steps=7 --checkpoint c.check --save c.{ending}")
        os.truncate(f"c.{ending}.part/lane-0", 90)
        refused = geomint(f"run kepler steps=12 --continue c.check --save c.{ending}", 3).stderr
        check(refused == f"geomint: c.{ending} could not be written: its rows so far are damaged; run it without --continue\n", refused)
    # a slip loses nothing of what was saved, and of a system with time in it there is one t
    with open("driven.system", "w") as file:
        file.write("coordinates: q\nH: p_q^2/2 + q^2/2 - q*sin(t)\nstart: q = 1, p_q = 0\ndt: 0.1\n")
    geomint("run driven.system steps=9 --checkpoint c.check --save c.csv")
    geomint("run driven.system steps=5 --continue c.check --save c.csv", 3)
    geomint("run driven.system steps=12 --continue c.check --save c.csv")
    geomint("run driven.system steps=12 --save d.csv")
    check(bytes_of("c.csv") == bytes_of("d.csv"), "a save is lost to a slip")
    check(bytes_of("d.csv").startswith(b"t,q,p_q\n"), "the columns of a system with time in it")
    geomint("run kepler steps=9 --checkpoint c.check")
    kept = bytes_of("c.check")
    for words in ("run kepler dt=0.3 steps=20", "run disc steps=20", "run kepler steps=5"):
        done = geomint(f"{words} --continue c.check --checkpoint c.check", 3)
        check(len(done.stderr.splitlines()) == 1 and bytes_of("c.check") == kept, f"{words}: {done.stderr}")
    with open("c.check", "wb") as file:
        file.write(kept[:-3] + b"xyz")
    check("damaged" in geomint("run kepler steps=12 --continue c.check", 3).stderr, "a damaged checkpoint")
    geomint("run kepler steps=12 --continue nowhere.check", 3)


def interrupted():
    """SIGINT: what is there is complete."""
    process = subprocess.Popen([GEOMINT] + "run kepler steps=1e12 --yes --every 1000 --save i.npz --csv i.csv".split(),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while not os.path.exists("i.csv") or os.path.getsize("i.csv") == 0:  # which is written many rows at a time
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    check(process.wait() == 130, "exit status of an interrupted save")
    with numpy.load("i.npz") as saved:
        check(len(saved["t"]) == len(saved["q1"]) > 2, "rows of an interrupted save")
        check(json.loads(str(saved["meta"]))["status"] == "interrupted", "its status")


def no_room_for(size):
    """No file may be longer, which stands for a full disk."""
    return lambda: (signal.signal(signal.SIGXFSZ, signal.SIG_IGN), resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))


def full():
    """Without room for all rows those that fit are there; a run with a checkpoint goes on when there is room."""
    words = "run kepler scheme=verlet steps=20000 --save"
    geomint(f"{words} whole.npz")
    geomint(f"{words} whole.csv")
    geomint("run kepler scheme=controlled-verlet2 dt=.01 until=200 --save adaptive.npz")
    for path in ("full.npz", "adaptive-full.npz"):
        whole, asked = ("whole.npz", words) if path == "full.npz" else ("adaptive.npz", "run kepler scheme=controlled-verlet2 dt=.01 until=200 --save")
        done = geomint(f"{asked} {path}", 3, preexec_fn=no_room_for(300000))
        told = re.fullmatch(f"geomint: {path} ends after ([0-9]+) rows: File too large\n", done.stderr)
        check(told is not None, f"no room for all rows: {done.stderr}")
        with numpy.load(path, allow_pickle=False) as saved, numpy.load(whole, allow_pickle=False) as all_rows:
            count = len(saved["t"])
            check(told and count == int(told[1]) and 1000 < count < len(all_rows["t"]), f"{count} rows of {path}")
            check(all(same(saved[name], all_rows[name][:count]) for name in ("t", "q1", "q2", "p1", "p2")),
                  f"the rows of {path} that fit")
            check(json.loads(str(saved["meta"]))["status"] == "interrupted", "what a file without all rows says")
        check(zipfile.ZipFile(path).testzip() is None, f"the checksums of {path}")
        check(not os.path.exists(f"{path}.part"), "no room: nothing else stays")
    done = geomint(f"{words} full.csv", 3, preexec_fn=no_room_for(300000))
    told = re.fullmatch("geomint: full.csv ends after ([0-9]+) rows: File too large\n", done.stderr)
    table = bytes_of("full.csv")
    check(told and table.count(b"\n") == int(told[1]) + 1 and table.endswith(b"\n"), f"rows of a table: {done.stderr}")
    check(len(table) > 290000 and bytes_of("whole.csv").startswith(table), "the rows of a table that fit")
    done = geomint("run kepler scheme=verlet,rk4 steps=5000 --save lanes.npz", 3, preexec_fn=no_room_for(300000))
    check("the first 1 of 2 lanes" in done.stderr and len(numbers_of("lanes.npz")["lane0/t"]) == 8 * 5001, "lanes that fit")
    with disk(256) as there:  # no room for the second lane to begin
        if there:
            done = geomint("run kepler scheme=verlet,rk4 dt=.01 until=40 --save small/lanes.npz", 3)
            check("ends after 4001 rows of lane 0" in done.stderr, f"a lane that cannot begin: {done.stderr}")
            check(len(numbers_of("small/lanes.npz")["lane0/t"]) == 8 * 4001, "the lane before one that cannot begin")
    with disk(1000) as there:  # two lanes without room for one of them twice; one whose number of rows is not known
        for asked, name, lane, least in (("verlet,rk4 steps=8000", "two.npz", "lane1/", 8001), ("verlet,rk4 steps=8000", "two.csv", "", 1500),
                                         ("controlled-verlet2 dt=.001 until=100", "own.npz", "", 23000)):
            if not there:
                break
            done = geomint(f"run kepler scheme={asked} --save small/{name}", (0, 3))
            geomint(f"run kepler scheme={asked} --save {name}")
            if name == "two.csv":
                table = bytes_of(f"small/{name}")
                told = re.fullmatch("geomint: small/two.csv ends after ([0-9]+) rows of lane 1: No space left on device\n", done.stderr)
                check(told and int(told[1]) >= least and table.count(b"\n") == 8002 + int(told[1]), f"{name}: {done.stderr}")
                check(bytes_of(name).startswith(table), f"the rows of {name}")
            else:
                some, every = numbers_of(f"small/{name}"), numbers_of(name)
                count = len(some.get(f"{lane}t", "")) // 8
                check(count >= least, f"only {count} rows fit into {name}: {done.stderr}")
                check(all(every[key].startswith(some[key]) for key in some if not key.endswith("meta")), f"the rows of {name}")
                check(zipfile.ZipFile(f"small/{name}").testzip() is None, f"the checksums of {name}")
            os.remove(f"small/{name}")
            os.remove(name)
    own = "run kepler scheme=controlled-verlet2 dt=.002"
    for size in range(500, 2000, 100):  # there may be room for all rows, but not for the file beside them
        with disk(size) as there:
            if not there:
                break
            geomint(f"{own} until=10 --save small/own.npz --checkpoint own.check", (0, 3))
            if os.path.exists("own.check"):
                geomint(f"{own} until=20 --save small/own.npz --continue own.check --checkpoint own.check", (0, 3))
                subprocess.run(["mount", "-o", "remount,size=9000k", "small"], check=True)
                geomint(f"{own} until=30 --save small/own.npz --continue own.check")
                geomint(f"{own} until=30 --save own.npz")
                some, every = numbers_of("small/own.npz"), numbers_of("own.npz")
                check(all(some[key] == every[key] for key in every if key != "meta"), f"a disk of {size} KiB that was full at the end: other rows")
                os.remove("own.check")
                os.remove("own.npz")
    with open("long.system", "w") as file:  # its text, which is in meta, is longer than what else ends an archive
        file.write("# " + 300 * 200 * "x" + "\ncoordinates: q\nH: p_q^2/2 + q^2/2\nstart: q = 1, p_q = 0\ndt: 0.1\n")
    with disk(1000) as there:
        if there:
            done = geomint("run long.system scheme=verlet steps=100000 --save small/long.npz", 3)
            check("ends after" in done.stderr and len(numbers_of("small/long.npz")["t"]) > 8 * 20000, f"a long text: {done.stderr}")
    done = geomint(f"{words} on.npz --checkpoint on.check", 3, preexec_fn=no_room_for(300000))
    check("on.npz ends after" in done.stderr and len(numbers_of("on.npz")["t"]) > 8 * 1000, "no room before a checkpoint")
    check(not os.path.exists("on.npz.part") and not os.path.exists("on.check"), "no room before a checkpoint: nothing else")
    geomint("run kepler scheme=verlet steps=3000 --save on.npz --checkpoint on.check")
    done = geomint(f"{words} on.npz --continue on.check --checkpoint on.check", 3, preexec_fn=no_room_for(300000))
    check(len(done.stderr.splitlines()) == 1 and os.path.isdir("on.npz.part"), f"no room, with a checkpoint: {done.stderr}")
    check(len(numbers_of("on.npz")["t"]) == 8 * 3001, "no room, with a checkpoint: the file is what it was")
    geomint(f"{words} on.npz --continue on.check --checkpoint on.check")
    check(bytes_of("on.npz") == bytes_of("whole.npz"), "with room again it goes on")
    for size in (12000, 40000, None):  # files that may be so long; a disk that is full
        listed("list", "run kepler scheme=verlet steps=2000 --save", size)
        listed("strip", "run sine-gordon points=401 steps=2000 --save", size)


@contextlib.contextmanager
def disk(size):
    """A folder `small` that is a disk of so many KiB; False where nobody may mount one."""
    os.makedirs("small", exist_ok=True)
    there = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}k,nr_inodes=100k", "tmpfs", "small"],
                           stderr=subprocess.DEVNULL).returncode == 0
    try:
        yield there
    finally:
        if there:
            subprocess.run(["umount", "small"], check=True)


def beside():
    """What cannot be written beside the rows costs none of them."""
    too_long = 300 * "n"

    def rows_stay(what, more, status, said, words="kepler scheme=verlet,rk4 steps=3000", **how):
        geomint(f"run {words} --save whole.npz")
        done = subprocess.run([GEOMINT] + f"run {words} --save beside.npz {more}".split(),
                              stderr=subprocess.PIPE, text=True, timeout=600, **{"stdout": subprocess.DEVNULL, **how})
        check(done.returncode == status, f"{what}: exit status {done.returncode}, not {status}")
        check(sorted(done.stderr.splitlines()) == sorted(f"geomint: {line}" for line in said), f"{what}: {done.stderr}")
        check(os.path.exists("beside.npz") and bytes_of("beside.npz") == bytes_of("whole.npz"), f"{what}: rows are lost")
        check(not os.path.exists("beside.npz.part"), f"{what}: something stays")
        if os.path.exists("beside.npz"):
            os.remove("beside.npz")
    written = "wrote beside.npz"
    rows_stay("a checkpoint's name", f"--checkpoint {too_long}", 3, [f"cannot write {too_long}: File name too long", written])
    rows_stay("a profile's name", f"--profile {too_long}", 3, [f"{too_long} could not be written: File name too long", written],
              "wave points=11 dt=.01,.005 steps=3")
    reader, writer = os.pipe()
    os.close(reader)
    rows_stay("standard output without a reader", "--csv -", 141, [written], stdout=writer)
    os.close(writer)
    with open("full.csv", "wb") as table:
        rows_stay("standard output without room", "--csv -", 3, ["standard output could not be written: File too large", written],
                  stdout=table, preexec_fn=no_room_for(400000))
    table = bytes_of("full.csv")
    check(len(table) == 400000, "standard output has what fits")
    rows_stay("a history without room", "--csv full.csv", 3, ["full.csv could not be written: File too large", written],
              preexec_fn=no_room_for(400000))
    check(bytes_of("full.csv") == table, "a history has what fits")
    with disk(8) as there:
        if there:
            with open("small/other", "wb") as file:
                file.write(bytes(8192))
            rows_stay("a checkpoint without room", "--checkpoint small/c.check", 3,
                      ["cannot write small/c.check: No space left on device", written])
    # without anything beside it a run whose rows nobody reads ends
    process = subprocess.Popen([GEOMINT] + "run kepler scheme=verlet,rk4 steps=1e14 --yes --csv -".split(), stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE)
    process.stdout.readline()
    process.stdout.close()
    check(process.stderr.read() == b"" and process.wait(timeout=600) == 141, "rows that nobody reads")


def listed(name, words, size):
    """A list without room for all names the rows that are there, and no others are."""
    with disk(600) if size is None else contextlib.nullcontext(True) as there:
        os.makedirs("small", exist_ok=True)
        if not there:
            return
        done = geomint(f"{words} small/{name}.pvd", 3, **({} if size is None else {"preexec_fn": no_room_for(size)}))
        told = re.fullmatch(f"geomint: small/{name}.pvd ends after ([0-9]+) rows: .*\n", done.stderr)
        there = sorted(os.listdir(f"small/{name}")) if os.path.exists(f"small/{name}") else None
        if size is not None and told is None:  # no row fits into a file
            check(there is None and len(done.stderr.splitlines()) == 1, f"no row of {name}.pvd: {done.stderr}")
        else:
            names = re.findall(rf'file="{name}/([^"]+)"', bytes_of(f"small/{name}.pvd").decode())
            check(told and len(names) == int(told[1]) > 2 and names == there, f"{name}.pvd, {size}: {len(names)} of {len(there)} {done.stderr}")
            check(not os.path.exists(f"small/{name}.pvd.part"), f"{name}.pvd: nothing else stays")
    shutil.rmtree(f"small/{name}", ignore_errors=True)


def beginnings():
    """Whatever length of a file is the last that fits: one sentence, and a file that is whole or none."""
    whole = {}
    for name, words in (("one", "run kepler scheme=verlet steps=2000"), ("two", "run kepler scheme=verlet,rk4 steps=1000"),
                        ("own", "run kepler scheme=controlled-verlet2 dt=.01 until=40"), ("grid", "run sine-gordon points=101 steps=100")):
        geomint(f"{words} --save {name}-whole.npz")
        with numpy.load(f"{name}-whole.npz") as saved:
            whole[name] = {key: saved[key] for key in saved}
        for size in (0, 100, 4095, 30000, 65536, 70001, 100000):
            for more in ("", f" --checkpoint {name}.check"):
                done = geomint(f"{words} --save {name}.npz{more}", (0, 3), preexec_fn=no_room_for(size))
                what = f"{name}.npz of {size} bytes{more}: {done.stderr}"
                check(done.returncode == 0 or len(done.stderr.splitlines()) == 1, what)
                if os.path.exists(f"{name}.npz"):
                    check(zipfile.ZipFile(f"{name}.npz").testzip() is None, f"the checksums of {what}")
                    with numpy.load(f"{name}.npz") as saved:
                        check(all(same(saved[key], whole[name][key][:len(saved[key])]) for key in saved if not key.endswith("meta")), what)
                    os.remove(f"{name}.npz")
                check(not os.path.exists(f"{name}.npz.part") or os.path.exists(f"{name}.check"), f"the rest of {what}")
                shutil.rmtree(f"{name}.npz.part", ignore_errors=True)
                if os.path.exists(f"{name}.check"):
                    os.remove(f"{name}.check")


def together():
    """Steps and rows that are made many at once are those that are made one by one."""
    for words in ("kepler scheme=verlet steps=5000", "kepler scheme=rk4,gauss4 until=30", "henon-heiles scheme=verlet steps=3000",
                  "kepler scheme=controlled-verlet2 dt=.01 until=40", "kepler scheme=verlet steps=1", "oscillator scheme=explicit-euler dt=.1 steps=8000"):  # which blows up within some rows at once
        geomint(f"run {words} --save many.npz", (0, 2))
        geomint(f"run {words} --save single.npz --max", (0, 2))
        check(bytes_of("many.npz") == bytes_of("single.npz"), f"{words}: many rows at once")


def pipes():
    """Named pipes wait for a reader, as those of other programs do; Ctrl-C ends the waiting."""
    for words, path in (("run kepler steps=3 --csv", "pipe.csv"), ("render kepler until=1 -o", "pipe.svg")):
        os.mkfifo(path)
        process = subprocess.Popen([GEOMINT] + f"{words} {path}".split(), stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        with open(path, "rb") as reader:
            check(len(reader.read()) > 100, f"{words} to a pipe")
        check(process.wait() == 0, f"{words} to a pipe that is read")
        process = subprocess.Popen([GEOMINT] + f"{words} {path}".split(), stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        for _ in range(100):  # until it waits, where the system tells: earlier the signal stops the run, with 130 too
            with open(f"/proc/{process.pid}/wchan") as place:
                if "partner" in place.read():
                    break
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=60)[1]
        check(process.returncode == 130, f"{words} to a pipe without a reader: {process.returncode}, {said}")
        check("Traceback" not in said and len(said.splitlines()) <= 2, f"{words} to a pipe: {said}")
        os.remove(path)
    os.mkfifo("pipe.npz")
    for option in ("save", "save-tracks"):
        check("not a file that can be replaced" in geomint(f"run kepler steps=3 --{option} pipe.npz", 3).stderr, f"--{option} to a pipe")
    for kept in ("pipe.npz", "link", "folder"):
        if kept != "pipe.npz":
            os.symlink("nowhere", kept) if kept == "link" else os.mkdir(kept)
        mode = os.lstat(kept).st_mode
        done = geomint(f"run kepler steps=3 --save beside.npz --checkpoint {kept}", 3)
        check(done.stderr == f"geomint: {kept} is not a file that can be replaced\n", f"a checkpoint to a {kept}: {done.stderr}")
        check(os.lstat(kept).st_mode == mode and not os.path.exists("beside.npz.part"), f"{kept} is what it was")


def refusals():
    done = geomint("run kepler steps=3 --save k.hdf5", 1)
    check(all(ending in done.stderr for ending in (".npz", ".csv", ".pvd", ".xdmf")), "the known endings")
    with open("file", "w"):
        pass
    geomint("run kepler steps=3 --save file/k.npz", 3)
    check(not os.path.exists("k.hdf5"), "nothing is written")
    for ending in ("npz", "csv", "pvd"):
        done = geomint(f"run sine-gordon points=401 steps=40 --save none.{ending}", 3, preexec_fn=no_room_for(2000))
        check(len(done.stderr.splitlines()) == 1, f"no room for a row: {done.stderr}")
        check(not os.path.exists(f"none.{ending}.part"), "no room for a row: nothing stays")
        check(ending == "pvd" or not os.path.exists(f"none.{ending}"), "no room for a row: no half file")
    process = subprocess.Popen([GEOMINT] + "run kepler steps=1e12 --yes --every 1000 --save two.npz".split(),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while not os.path.exists("two.npz.part/lane-0"):
        time.sleep(0.01)
    check("a run with gsl-rk4 cannot be resumed" in
          geomint("run kepler scheme=verlet,gsl-rk4 steps=3 --checkpoint g.check", 1).stderr, "a scheme that has no way back")
    check("another process" in geomint("run kepler steps=3 --save two.npz", 3).stderr, "two processes, one file")
    process.kill()
    process.wait()
    geomint("run kepler steps=3 --save two.npz")
    check(len(numbers_of("two.npz")["t"]) == 32, "a file whose writer was killed can be written")
    geomint("run disc scheme=explicit-euler dt=2 until=1000 --save bad.npz", 2)
    with numpy.load("bad.npz") as saved:
        check(json.loads(str(saved["meta"]))["status"] != "ok" and len(saved["t"]) >= 1, "a run that fails")


def kepler_at(t, e):
    """The orbit of the unit of time 2 pi from its pericentre, by Kepler's equation."""
    angle = t
    for _ in range(60):
        angle -= (angle - e * numpy.sin(angle) - t) / (1 - e * numpy.cos(angle))
    side, distance = numpy.sqrt(1 - e * e), 1 - e * numpy.cos(angle)
    return numpy.array([numpy.cos(angle) - e, side * numpy.sin(angle), -numpy.sin(angle) / distance,
                        side * numpy.cos(angle) / distance])


PLEIADES = """parameter: m[1..7] = 1, 2, 3, 4, 5, 6, 7
coordinates: x[1..7] y[1..7]
let: r(i, j) = sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2)
H: sum(i = 1 .. 7, (p_x[i]^2 + p_y[i]^2)/(2*m[i])) - sum(i = 1 .. 7, j = i+1 .. 7, m[i]*m[j]/r(i, j))
start: x[1] = 3, x[2] = 3, x[3] = -1, x[4] = -3, x[5] = 2, x[6] = -2, x[7] = 2
start: y[1] = 3, y[2] = -3, y[3] = 2, y[4] = 0, y[5] = 0, y[6] = -4, y[7] = 4
start: p_x[i] = 0, p_y[i] = 0
monitor: sum(i = 1 .. 7, j = i+1 .. 7, r(i, j)^-1.5)
dt: 0.05
until: 3
""".replace("p_x[i] = 0, p_y[i] = 0", ", ".join(
    [f"p_x[{i}] = {p}" for i, p in zip(range(1, 8), (0, 0, 0, 0, 0, 10.5, -10.5))] +
    [f"p_y[{i}] = {p}" for i, p in zip(range(1, 8), (0, 0, 0, -5, 5, 0, 0))]))


def ends():
    """Schemes that choose their steps end at `until`, and go on from a checkpoint as if they had not ended."""
    for scheme, off in (("controlled-gauss8", 1e-9), ("controlled-kahan-li8", 1e-8), ("poincare-gauss8", 1e-9),
                        ("logh-sofroniou-spaletta10", 1e-8), ("levi-civita", 1e-4), ("controlled-verlet2", 1e-3)):
        words = f"kepler scheme={scheme} eccentricity=0.5 dt=0.01"
        told = json.loads(geomint(f"run {words} until=7.3 --json --state --save e.csv").stdout)
        check(abs(told["t"] - 7.3) <= 4 * numpy.spacing(7.3) and told["message"] == "", f"{words}: it ends at {told['t']!r}")
        check(abs(numpy.array(told["state"]) - kepler_at(7.3, 0.5)).max() < off, f"{words}: the state at its end")
        with open("e.csv", encoding="utf-8") as file:
            check(float(list(csv.DictReader(file))[-1]["t"]) == told["t"], f"{words}: the last row is the end")
        geomint(f"run {words} until=7.3 --checkpoint e.check")
        one, other = (json.loads(geomint(f"run {words} until=9 --json --state {more}").stdout)
                      for more in ("", "--continue e.check"))
        check(same(one["state"], other["state"]) and one["steps"] == other["steps"], f"{words}: it is gone on with")
    with open("stars.system", "w", encoding="utf-8") as file:
        file.write(PLEIADES)
    told = json.loads(geomint("run ./stars.system scheme=controlled-gauss8 --json --state").stdout)
    check(told["t"] == 3 and abs(told["state"][0] - 0.370613914) < 1e-8, f"the Pleiades: {told['t']}, {told['state'][0]}")
    for words, until in (("kepler", 7.3), ("kepler", 0.001), ("lotka-volterra", 3)):  # the last has a line stop:
        told = json.loads(geomint(f"run {words} scheme=relaxed(rk4;H) until={until} --json").stdout)
        check(abs(told["t"] - until) <= 1e-12 and told["message"] == told["warning"] == "" and told["steps"] < 200,
              f"relaxed on {words}: it ends at {told['t']!r} after {told['steps']} steps")
    told = json.loads(geomint("run oscillator scheme=variational-midpoint until=7.3 --json").stdout)
    check(told["t"] > 7.3 and "is adaptive" in told["message"], "steps of a variational principle stay whole")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for part in (rows_equal_states, shapes, flows, vtk, series, warm, tables, rows, profiles, tracks, memory, continued, killed, interrupted,
                 full, beside, beginnings, together, pipes, refusals, ends):
        if sys.argv[2:] == ["few"] and part in (memory, killed):  # where a sanitizer watches: they are long
            continue
        if sys.argv[2:] in ([], ["few"]) or part.__name__ in sys.argv[2:]:
            part()
    os.chdir("/")
sys.exit(1 if faults else 0)
