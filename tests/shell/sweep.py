#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ranges and geomint sweep: rows that are those of runs alone, whatever stops it in between. sweep.py GEOMINT [few]"""
import csv
import fcntl
import json
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time

geomint = os.path.realpath(sys.argv[1])
failures = 0
SWEEP = ["kepler", "eccentricity=0..0.9:10", "dt=1e-3..1e-1:log7", "scheme=verlet,rk4"]


def check(good, what):
    global failures
    if not good:
        failures += 1
        print("FAILED:", what)


def sweep(*words, status=0, **more):
    done = subprocess.run([geomint, "sweep", *words], capture_output=True, text=True, **more)
    check(done.returncode == status, f"sweep {' '.join(words)}: {done.returncode}, not {status}: {done.stderr}")
    return done


def says(sentence, command, *words, status=1):
    done = subprocess.run([geomint, command, *words], capture_output=True, text=True)
    check(done.returncode == status and sentence in done.stderr and done.stderr.count("\n") == 1,
          f"{command} {' '.join(words)}: {done.returncode} {done.stderr!r}, not {sentence!r}")


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def bare(path):
    """The table without its times."""
    found = rows(path)
    for row in found:
        del row["seconds"]
    return found


def content(path):
    with open(path, "rb") as file:
        return file.read()


def values(key, text):
    """The values of a list, as lanes of run have them."""
    words = [f"{key}={text}"] + (["until=0.1"] if key != "until" else [])
    done = subprocess.run([geomint, "run", "kepler", *words, "--json"], capture_output=True, text=True)
    return [json.loads(line)["parameters"][key] for line in done.stdout.splitlines()]


def test_ranges():
    check(values("eccentricity", "0..0.9:10") == [i / 10 for i in range(10)], "ten values evenly")
    decades = values("dt", "1e-4..1e-1:log4")
    check(decades == [1e-4, 1e-3, 1e-2, 1e-1], f"by equal factors: {decades}")
    check(values("dt", "0.01,0.02..0.04:3") == [0.01, 0.02, 0.03, 0.04], "mixed with a value")
    turns = values("until", "0..2*pi:9")
    check(turns[4] == 3.141592653589793 and turns[2] == 3.141592653589793 / 2, f"expressions as ends: {turns}")
    for text, sentence in {"2..1:3": "ends above its start", "1..1:3": "ends above its start",
                           "-1..1:log3": "does not lead through 0", "0..1:log3": "does not lead through 0",
                           "1..2:1": "from 2 to 1e15", "1..2:0": "from 2 to 1e15", "1..2:1.5": "from 2 to 1e15",
                           "1..2": "START..END:COUNT", "1..x:3": "ends of a range are numbers",
                           "1e-3..2e-3:1000000000000": "more than 64 lanes"}.items():
        for command in ("run", "render"):
            says(sentence, command, "kepler", f"dt={text}")
    says("dt=2..1:3", "sweep", "kepler", "dt=2..1:3")
    says("whole numbers", "run", "disc", "points=3..4:3")
    says("out of range", "sweep", "kepler", "eccentricity=0..1.5:4")
    says("no..such:2.msh could not be read", "run", "room", "mesh=no..such:2.msh", status=3)


def test_sweep(folder):
    one, two = (os.path.join(folder, name) for name in ("one.csv", "two.csv"))
    sweep(*SWEEP, "--jobs", "1", "--table", one)
    sweep(*SWEEP, "--jobs", "2", "--table", two)
    found = rows(one)
    check(len(found) == 140 and bare(one) == bare(two), "140 rows, the same with one and with two at once")
    check([row["scheme"] for row in found[:4]] == ["verlet", "rk4"] * 2, "the first list changes slowest")
    check(content(one).splitlines()[0].decode().startswith(
        "scene,scheme,eccentricity,dt,status,warning,t,steps,evaluations,solves,seconds,energy_error,"), "the columns")
    for row in found[5::15]:
        alone = subprocess.run([geomint, "run", "kepler", "--json",
                                *(f"{key}={row[key]}" for key in ("eccentricity", "dt", "scheme"))],
                               capture_output=True, text=True)
        run = json.loads(alone.stdout)
        for key in ("status", "t", "steps", "evaluations", "solves"):
            check(row[key] == (run[key] if key == "status" else f"{run[key]:.17g}"), f"{key} of {row}")
        for key, value in run["observables"].items():
            check(row[key] == ("" if value is None else f"{value:.17g}"), f"{key} of {row}")
    # killed at three moments, and gone on with by another number of jobs
    for jobs in ("1", "2"):
        table = os.path.join(folder, f"killed{jobs}.csv")
        for lines in (5, 50, 110):
            process = subprocess.Popen([geomint, "sweep", *SWEEP, "--jobs", jobs, "--table", table],
                                       stderr=subprocess.DEVNULL)
            while process.poll() is None and (not os.path.exists(table) or content(table).count(b"\n") < lines):
                time.sleep(0.001)
            process.send_signal(signal.SIGKILL)
            process.wait()
        with open(table, "ab") as file:
            file.write(b"kepler,verlet,0.0")  # a torn row
        sweep(*SWEEP, "--jobs", jobs, "--table", table)
        check(bare(table) == bare(one), f"killed three times, {jobs} at once: the same rows")
    # an interruption
    table = os.path.join(folder, "stopped.csv")
    process = subprocess.Popen([geomint, "sweep", *SWEEP, "--table", table], stderr=subprocess.DEVNULL)
    while process.poll() is None and (not os.path.exists(table) or content(table).count(b"\n") < 9):
        time.sleep(0.001)
    process.send_signal(signal.SIGINT)
    check(process.wait() == 130 and content(table).endswith(b"\n") and len(rows(table)) < 140, "interrupted: 130")
    sweep(*SWEEP, "--table", table)
    check(bare(table) == bare(one), "interrupted and given again: the same rows")
    return one


def test_refusals(folder, one):
    before = content(one)
    says("row 3 is not that of run 2", "sweep", "kepler", "eccentricity=0..0.9:10", "dt=1e-3..1e-1:log8",
         "scheme=verlet,rk4", "--table", one, status=3)
    says("its columns are others", "sweep", "kepler", "dt=1e-3..1e-1:log7", "--table", one, status=3)
    says("its columns are others", "sweep", *SWEEP, "--measure", "energy_error", "--table", one, status=3)
    other = os.path.join(folder, "notes.csv")
    with open(other, "w") as file:
        file.write("no table")
    says("its columns are others", "sweep", *SWEEP, "--table", other, status=3)
    check(content(one) == before and content(other) == b"no table", "what is refused is left as it is")
    with open(one) as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        says("another process", "sweep", *SWEEP, "--table", one, status=3)
    says("1000000000000 runs", "sweep", "kepler", "eccentricity=0..0.9:1000000", "dt=1e-2..1e-1:1000000")
    says("--yes makes them", "sweep", "kepler", "eccentricity=0..0.9:1000000", "dt=1e-2..1e-1:1000000")
    says("is none of: ok, blow-up", "sweep", *SWEEP, "--table", one, "--retry", "bad")
    says("needs a table", "sweep", *SWEEP, "--shard", "1/2")
    says("--table - is not a file", "sweep", *SWEEP, "--table", "-")
    says("no observable", "sweep", *SWEEP, "--measure", "energy_eror")
    says("a sweep has none", "sweep", *SWEEP, "overlay=yes")
    # a full disk, in the middle of a row
    table = os.path.join(folder, "full.csv")
    full = sweep(*SWEEP, "--table", table, status=3,
                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000)))
    check("could not be written" in full.stderr and full.stderr.count("\n") == 1 and content(table).endswith(b"\n"),
          f"a full disk: {full.stderr}")
    sweep(*SWEEP, "--table", table)
    check(bare(table) == bare(one), "a disk that was full: the same rows")


def test_warnings(one):
    """What is told of rows that are ok is what runs alone say."""
    warned = []
    for run, row in enumerate(rows(one)):
        if warned:
            break
        alone = subprocess.run([geomint, "run", "kepler", "--json",
                                *(f"{key}={row[key]}" for key in ("eccentricity", "dt", "scheme"))],
                               capture_output=True, text=True)
        warning = json.loads(alone.stdout)["warning"]
        warned += [(run, warning)] if warning else []
    done = sweep("kepler", "eccentricity=0..0.9:10", "dt=1e-3..1e-1:log7", "scheme=verlet,rk4")
    check(warned and f"runs made now are ok, but with a warning; the first, run {warned[0][0]}: {warned[0][1]}\n"
          in done.stderr, f"the first warning: {warned[:1]}, {done.stderr}")
    done = sweep("kepler", "dt=0.1,0.3", "until=1.2", "scheme=midpoint")
    check(done.stderr == "", f"runs without a warning: {done.stderr}")
    done = sweep("kepler", "dt=0.1,0.5", "until=1.2", "scheme=rk4,gsl-rk4")
    check(done.stderr == "", f"an end that is not until is a message: {done.stderr}")
    done = sweep("kepler", "eccentricity=0.5,0.9999", "steps=30", "scheme=verlet")
    check("1 of 2 runs made now is ok, but with a warning; the first, run 1: energy_error is " in done.stderr,
          f"one warning: {done.stderr}")


def test_output(one):
    shown = sweep(*SWEEP, "--measure", "energy_error,position_error")
    found = list(csv.DictReader(shown.stdout.splitlines()))
    check(len(found) == 140 and list(found[0])[-2:] == ["energy_error", "position_error"] and
          [row["energy_error"] for row in found] == [row["energy_error"] for row in rows(one)],
          "without a table rows go to standard output")
    with open("/dev/full", "w") as full:
        done = subprocess.run([geomint, "sweep", *SWEEP], stdout=full, stderr=subprocess.PIPE, text=True)
    check(done.returncode == 3 and done.stderr.count("\n") == 1, f"/dev/full: {done.returncode} {done.stderr}")
    done = subprocess.run(f"'{geomint}' sweep {' '.join(SWEEP)} | head -n 1; exit ${{PIPESTATUS[0]}}", shell=True,
                          executable="/bin/bash", capture_output=True, text=True)
    check(done.returncode == 141 and done.stderr == "", f"a broken pipe: {done.returncode} {done.stderr}")


def test_kinds(folder):
    """Runs of every wing of the core, two at once, are what they are one by one."""
    for words in (["room", "dt=0.002..0.004:2", "until=0.02"], ["soliton", "dt=0.01,0.02", "until=0.1"],
                  ["nls", "dt=0.001,0.002", "until=0.1"], ["kepler", "scheme=gsl-msbdf,gauss4,verlet", "until=9"]):
        tables = [os.path.join(folder, f"{words[0]}{jobs}.csv") for jobs in (1, 2)]
        for jobs, table in enumerate(tables, 1):
            sweep(*words, "--jobs", str(jobs), "--table", table)
        check(bare(tables[0]) == bare(tables[1]), f"{words[0]}: other rows with two at once")


def test_shards(folder, one):
    table = os.path.join(folder, "shards.csv")
    for shard in (3, 1):
        sweep(*SWEEP, "--table", table, "--shard", f"{shard}/3")
    check(len(rows(os.path.join(folder, "shards.3-of-3.csv"))) == 46, "a shard of three")
    done = sweep("--join", table, status=3)
    check("run 1 has no row: geomint run kepler eccentricity=0 dt=0.001 scheme=rk4\n" in done.stderr and
          "93 of 140" in done.stderr, f"missing rows are named: {done.stderr}")
    says("another sweep", "sweep", *SWEEP, "--table", table, "--shard", "2/4", status=3)
    says("another sweep", "sweep", "kepler", "dt=0.1,0.2", "--table", table, "--shard", "2/3", status=3)
    sweep(*SWEEP, "--table", table, "--shard", "2/3")
    gaps = content(table)
    says("misses rows", "sweep", *SWEEP, "--table", table, status=3)
    check(content(table) == gaps, "a table with gaps stays as it is")
    sweep("--join", table)
    check(bare(table) == bare(one), "three shards joined: the same rows")
    pictures = os.path.join(folder, "joined")
    picture = os.path.join(pictures, "kepler-sweep.png")
    sweep("--join", table, "--out", pictures)
    subprocess.run([geomint, "again", picture, "--out", pictures], capture_output=True)
    check(content(picture) == content(picture.replace(".png", "-again.png")), "the joined picture, made again")
    says("contradict", "sweep", "--join", table, "--shard", "1/3")
    says("could not be read", "sweep", "--join", os.path.join(folder, "none.csv"), status=3)


def test_statuses(folder):
    table = os.path.join(folder, "disc.csv")
    words = ["disc", "scheme=explicit-euler,midpoint", "dt=0.1,2", "until=100", "points=3", "--table", table]
    done = sweep(*words)
    found = rows(table)
    check([row["status"] for row in found] == ["ok", "blow-up", "ok", "ok"] and "1 of them" in done.stderr,
          f"a run that fails is a row: {found}")
    first = content(table)
    done = sweep(*words, "--retry", "blow-up")
    check("1 of 4 runs made now" in done.stderr and len(rows(table)) == 4 and bare(table) == found_without(found),
          f"only what failed is made anew: {done.stderr}")
    check(first.splitlines()[0] == content(table).splitlines()[0], "the head stays")
    # a run that is ok and yet lost what it should keep has its warning beside its status
    alone = subprocess.run([geomint, "run", *words[:1], "scheme=explicit-euler", "dt=0.1", "until=100", "points=3",
                            "--json"], capture_output=True, text=True)
    check(content(table).splitlines()[1].count(b',ok,"') == 1, "in quotes")
    warnings = [row["warning"] for row in found]
    check(warnings[0] == json.loads(alone.stdout)["warning"] != "" and warnings[1:] == [""] * 3, f"{warnings}")
    done = sweep(*words, "--retry", "warning")
    check("1 of 4 runs made now" in done.stderr and bare(table) == found_without(found),
          f"only what has a warning is made anew: {done.stderr}")
    older = content(table)
    with open(table, "wb") as file:
        file.write(older.replace(b",warning,", b",", 1))
    says("it has no column warning", "sweep", *words, status=3)
    with open(table, "wb") as file:
        file.write(older)
    # a warning with commas, and a scheme with one, are a cell each
    with tempfile.TemporaryDirectory() as other:
        comma = ["kepler", "scheme=composition(verlet; 1/2, 1/2),verlet", "eccentricity=0.9999", "steps=30", "--table",
                 os.path.join(other, "comma.csv")]
        sweep(*comma)
        check("0 of 2 runs made now" in sweep(*comma).stderr, "a table with commas in its cells is gone on with")
        check(all(row["warning"].startswith("energy_error is") for row in rows(comma[-1])), f"{rows(comma[-1])}")
    with open(table, "a", encoding="utf-8") as file:
        file.write("disc,of,another,sweep\n")
    first = content(table)
    says("is not a table of this sweep", "sweep", *words, "--retry", "ok", status=3)
    check(content(table) == first, "a row of another sweep leaves the table as it is, whatever is made anew")
    # what a scheme does not take is left to those that do
    done = sweep("kepler", "scheme=verlet,gsl-rk8pd", "tolerance=1e-9,1e-3", "dt=0.5", "until=10", "--measure",
                 "energy_error")
    errors = [line.split(",")[-1] for line in done.stdout.splitlines()[1:]]
    check(len(errors) == 4 and errors[0] == errors[1] and errors[2] != errors[3], f"tolerance of GSL's: {errors}")
    says("these do", "sweep", "kepler", "scheme=verlet", "tolerance=1e-9,1e-3")
    done = sweep("oscillator", "scheme=verlet,rk4", "dt=0.1,0.2", "zip=yes", "until=1")
    check(len(done.stdout.splitlines()) == 3, "zip=yes pairs")


def found_without(found):
    return [{key: value for key, value in row.items() if key != "seconds"} for row in found]


def test_pictures(folder):
    """Three lines over one key, two maps over two keys; made again, they are the same."""
    for words in (["disc", "dt=0.5..2.5:5", "scheme=rk4,midpoint,explicit-euler"],
                  ["kepler", "eccentricity=0..0.9:4", "dt=1e-2..1e-1:log3", "scheme=verlet,rk4"]):
        name = os.path.join(folder, f"{words[0]}-sweep.png")
        sweep(*words, "until=100", "--out", folder)
        done = subprocess.run([geomint, "again", name, "--out", folder], capture_output=True, text=True)
        check(done.returncode == 0 and content(name) == content(name.replace(".png", "-again.png")),
              f"{name} made again: {done.stderr}")
    drawn = os.path.join(folder, "maps", "kepler.svg")
    sweep("kepler", "dt=1e-2,2e-2", "eccentricity=0,0.1", "until=1", "--output", drawn)
    with open(drawn, encoding="utf-8") as picture:
        check("<svg" in picture.read() and len(rows(drawn.replace(".svg", ".csv"))) == 4, "-o FILE.svg")
    drawn = os.path.join(folder, "maps", "even.svg")
    sweep("system", "H=p^2/2", "q=1,2", "p=0,1", "until=1", "scheme=verlet", "-o", drawn)
    with open(drawn, encoding="utf-8") as picture:
        text = picture.read()
        check(">0 everywhere<" in text and "radient" not in text, "of one number there is no scale")
    maps = []
    for values in ("0.1,0.2,0.4", "0.2,0.1,0.4"):
        drawn = os.path.join(folder, "maps", f"{values}.svg")
        sweep("disc", f"dt={values}", "radius=0.3,0.1", "until=1", "--title", "a map", "-o", drawn)
        with open(drawn, encoding="utf-8") as picture:
            maps.append(set(re.findall(r'd="([^"]*)"', picture.read())))
    check(len(maps[0]) > 2 and maps[0] == maps[1], "a map of values that were typed in any order")
    says("are to write to one file", "sweep", "disc", "dt=.1,.2", "--table", drawn, "-o", f"{folder}/maps/../maps/{values}.svg")
    says("--output - needs a table", "sweep", "kepler", "dt=1e-2,2e-2", "--output", "-", "--format", "pdf")
    says("system has no observable", "sweep", "system", "rate=x=-k*x", "x=1", "k=0..1:3", "until=1", "--out", folder)
    says("of two, and not of 3", "sweep", "kepler", "dt=1,2", "eccentricity=0,0.1", "until=1,2", "--out", folder)
    says("up to 9 maps, and these are 20", "sweep", "kepler", "dt=1,2", "eccentricity=0,0.1", "--out", folder,
         "scheme=verlet,rk4,rk2,midpoint,gauss4", "--measure",
         "energy_error,position_error,lrl_angle,angular_momentum_error")


def test_memory(folder):
    peaks = []
    for runs in (1000, 20000):
        words = ["kepler", f"eccentricity=0..0.9:{runs}", "dt=0.05", "until=0.1",
                 "--table", os.path.join(folder, f"{runs}.csv")]
        process = subprocess.Popen([geomint, "sweep", *words], stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        check(status == 0 and len(rows(words[-1])) == runs, f"{runs} rows")
        peaks.append(usage.ru_maxrss)
    check(peaks[1] < peaks[0] + 2048, f"memory does not grow with the runs: {peaks} KB")


with tempfile.TemporaryDirectory() as folder:
    test_ranges()
    one = test_sweep(folder)
    test_refusals(folder, one)
    test_warnings(one)
    test_output(one)
    test_kinds(folder)
    test_shards(folder, one)
    test_statuses(folder)
    test_pictures(folder)
    if "few" not in sys.argv:  # a sanitizer keeps notes of its own, which grow
        test_memory(folder)
sys.exit(failures > 0)
