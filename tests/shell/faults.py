#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The n-th allocation fails, the n-th file call fails: what comes of it is a sentence on standard error with its
exit status, or what would have come anyway; never a crash, a hang, a wrong number or a damaged file. Where memory is
short, nothing else is blamed.

    faults.py GEOMINT FAULTS_LIBRARY [--all] [--most N] [--third | --rest] [--only WORDS] [--day NUMBER]

--all takes every n of every command, two millions in days; --most: N of them at most of each command, spread from
another place every day (--day); without --all a few; --third: a third of these, another one every day; --rest: the
other two thirds. --only: commands that hold these words alone. For `list` every n is taken, or every third with --third
and --rest, of one system of each kind, another one every day (--day)."""

import argparse
import concurrent.futures
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zipfile
import zlib

LONGEST = 600  # seconds that a command may take before it counts as hanging
SAMPLE = 9  # values of n in a command

# OUT stands for a folder that is made anew, SHARE for that of the systems. "timed": holds run times, which differ from run to run; "made": OUT
# holds a picture of these words; "before": a command that runs without a fault first; "lost": OUT holds all that the
# command makes but this file; "usual": the exit status without a fault; "partial": a text may have gaps
# where the exit status says that memory was short; "statuses": those that a failing file may have.
COMMANDS = [
    ("run disc scheme=rk4,midpoint points=20 steps=5 --json", {}),
    ("run kepler steps=20 scheme=gsl-rk8pd --json --max", {}),
    ("run kepler steps=3 scheme=gsl-rk4 tolerance=1e-6 --json", {}),
    ("run kepler steps=3 scheme=gsl-msadams --json", {}),
    ("run kepler steps=3 scheme=gsl-msbdf --json", {}),
    ("run vortices steps=5 --json", {}),
    ("run vortices configuration=random count=300 multipole=1e-3 steps=2 --json", {}),
    ("run stiff springs=2 steps=5 --json", {}),
    ("run henon-heiles steps=5 --json", {}),
    ("run henon-heiles steps=5 scheme=verlet,gauss4 --measure lyapunov,return_time --json", {}),
    ("run oscillator scheme=variational-midpoint steps=5 --measure megno --json", {}),
    ("run abc steps=5 --json", {}),
    ("run bouncing-ball scheme=gauss4 steps=40 --measure events,log_volume --json", {}),
    ("run oscillator scheme=variational-midpoint steps=5 --json", {}),
    ("run sine-gordon points=101 steps=3 --json", {}),
    ("run kepler steps=5 --save OUT/a.npz", {}),
    ("run kepler scheme=verlet,controlled-verlet2 dt=.01 steps=5000 --save OUT/a.npz", {}),
    ("run abc steps=5 --save OUT/a.csv --checkpoint OUT/a.checkpoint", {}),
    ("run henon-heiles until=20 --save-tracks OUT/a.npz", {}),
    ("run kdv points=101 steps=3 --json --state", {}),
    ("run nls points=64 steps=3 --json", {}),
    ("run wave points=64 steps=3 --json", {}),
    ("run burgers dx=.05 steps=3 --json --csv OUT/burgers.csv", {}),
    ("run soliton steps=2 points=21 --json --csv OUT/soliton.csv", {}),
    ("run soliton steps=1 points=301 alpha=20 --json", {}),
    ("run soliton steps=1 points=9 scheme=given-gauss2,free-gauss2 density=sqrt(1+u_x^2+u^2/9) "
     "mesh=X=x+sin(pi*x/25)*sin(t) cell=(d_t/d)^2/20 --json", {}),
    ("run soliton steps=1 points=9 scheme=control-radau3 relax=0.3 --json", {}),
    ("run peakons steps=1 nodes=-8,-2 --json", {}),
    ("run room steps=2 --json", {}),
    ("run room steps=2 --csv OUT/room.csv", {}),
    ("run cavity steps=2 rows=14 columns=10 --profile OUT/cavity.csv", {}),
    ("run channel steps=1 outlet=dirichlet --json", {}),
    ("run room steps=1 mesh=MESHES/room-small.msh --json", {"statuses": (1, 3)}),
    ("run poiseuille steps=1 --json", {}),
    ("list scenes --json", {}),
    ("list schemes --json --long", {}),
    ("list figures", {}),
    ("list systems --json", {}),
    ("list rooms --long", {}),
    ("list toda --source", {}),
    ("list kepler --invariants --degree 2", {}),
    ("list rigid-body --invariants --degree 2 --json", {}),
    ("list office --json", {}),
    ("list room --json", {}),
    ("list schemes --markdown", {}),
    ("render disc until=1 points=20 --size 200x150 --out OUT", {}),
    ("render room until=.02 --size 200x150 --out OUT", {}),
    ("render couette until=.05 --size 200x150 -o OUT/a.svg", {}),
    # Cairo calls a font that it cannot open a lack of memory
    ("render couette until=.05 --size 200x150 -o OUT/a.pdf", {"statuses": (3, 5)}),
    ("render disc until=1 points=20 --frames 3 --size 128x96 --out OUT", {}),
    ("render disc until=1 points=20 --frames 3 --size 128x96 --movie OUT/disc.mp4", {}),
    ("render disc until=1 points=20 --frames 3 --size 128x96 --out OUT", {"lost": "disc-render-000001.png"}),
    ("render disc until=1 points=20 --frames 3 --size 128x96 --movie OUT/disc.mp4 --out OUT",
     {"lost": "disc-render-000001.png"}),
    ("certify rk4 --json", {}),
    ("certify semi-implicit", {}),
    ("certify gauss-box2 --json", {}),
    ("certify multiplier-lobatto4", {}),
    ("certify leapfrog --on SHARE/systems/phi4.system points=60 --json", {}),
    ("certify box --on SHARE/systems/nonlinear-dirac.system points=61 dt=0.2 --json", {}),
    ("certify rk4 --on SHARE/systems/bbm.system points=80 --json", {}),
    ("certify rk4 --on disc system=pendulum points=5 --json", {}),
    ("certify gsl-msbdf --json", {}),
    ("work-precision disc scheme=rk4,verlet until=1 --out OUT", {"timed": True}),
    ("stability stiff scheme=verlet until=1 --out OUT", {}),
    ("stability --region rk4 --out OUT", {}),
    ("sweep disc dt=.1..3:3 scheme=rk4 until=9 points=5 --table OUT/a.csv", {"timed": True}),
    ("sweep disc dt=.1,.2 scheme=rk4 until=1 points=5 --table OUT/a.csv --shard 1/2", {"timed": True}),
    ("sweep disc dt=.1,.2 scheme=rk4 until=1 points=5 --size 128x96 --out OUT", {"timed": True}),
    ("figures razafindralandy-2 --quick --out OUT", {"timed": True}),
    ("again OUT/made.png --out OUT", {"made": "disc until=1 points=20 --size 200x150"}),
    ("tour", {}),
    ("tour area --size 128x96 --out OUT", {}),
    ("run system H=p^2/2-cos(q) q=1 p=0 steps=5 --json", {}),
    ("run system H=p^2/2-cos(q) q=1 p=0 steps=5 scheme=gauss4 --engine native --json", {}),
    ("run MESHES/../pieces.system steps=2 --json", {}),
    ("list MESHES/../pieces.system --long", {}),
    ("run MESHES/../events.system steps=9 --json", {}),
    ("run MESHES/../breaks.system scheme=rk4 --measure events,lyapunov_spectrum --json", {}),
    ("run MESHES/../breaks.system scheme=rk4 --engine native --json", {}),
    ("orbit van-der-pol steps=9 scheme=rk4 dt=.1 --json", {}),
    ("orbit clock v=0.6 scheme=gauss4 dt=.1 --json", {}),
    ("sweep MESHES/../breaks.system w=2,3 scheme=rk4 --values y:2 --table OUT/a.csv", {"timed": True}),
    ("sweep kicked-rotor K=0.5,1 until=5 --values p:2 --table OUT/a.csv", {"timed": True}),
    ("run MESHES/../forms.system steps=1 --json", {}),
    ("run MESHES/../nodes.system steps=1 --json", {}),
    ("run SHARE/systems/argon.system steps=2 --json", {}),
    ("run SHARE/systems/phi4.system steps=2 --json", {}),
    ("run SHARE/rooms/heated.room steps=1 --json", {"statuses": (1, 3)}),
    ("run disc scheme=composition(verlet;1/2,1/2) steps=3 --json", {}),
    ("certify SHARE/schemes/kutta38.scheme --json", {}),
    ("backward kepler scheme=verlet until=1 -o OUT/a.svg", {}),
    ("run cavity steps=2 rows=14 columns=10 --save OUT/a.pvd", {}),
    ("run cavity steps=2 rows=14 columns=10 --save OUT/a.xdmf", {}),
    ("run kepler steps=9 --continue OUT/a.checkpoint --json",
     {"before": "run kepler steps=5 --checkpoint OUT/a.checkpoint"}),
    ("cache", {}),
    ("run disc steps=3 nosuchkey=1", {"usual": 1}),
    ("manual", {}),
    ("--help", {}),
    ("--version", {}),
    ("terminal", {}),
]


# Of each kind of system, one a day: a child is forked for every allocation, and for every stream into memory that is
# closed, of these commands.
SYSTEMS = [
    ("double-pendulum", "duffing", "kicked-rotor", "klein-gordon", "spherical-pendulum", "kepler-space",
     "bouncing-ball"),
    ("bowl", "cartesian-pendulum"),
    ("lorenz", "clock", "bbm"),
    ("lotka-volterra", "rigid-body", "heavy-top"),
    ("phi4", "boussinesq", "double-sine-gordon", "camassa-holm"),
    ("driven-pendulum", "charged-particle", "restricted-three-body"),
    ("nonlinear-dirac",),
]
EACH = ["list SHARE/systems/NAME.system", "list SHARE/systems/NAME.system --latex"]


def png_is_whole(path):
    with open(path, "rb") as file:
        data = file.read()
    at, kind = 8, b""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        return False
    pixels = b""
    while at + 12 <= len(data) and kind != b"IEND":
        (size,) = struct.unpack(">I", data[at : at + 4])
        kind, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + size]
        if zlib.crc32(kind + body) != struct.unpack(">I", data[at + 8 + size : at + 12 + size])[0]:
            return False
        pixels += body if kind == b"IDAT" else b""
        at += 12 + size
    return kind == b"IEND" and at == len(data) and len(zlib.decompress(pixels)) > 0


def movie_is_whole(path):
    probe = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0", path]
    found = subprocess.run(probe, capture_output=True, text=True, check=False)
    return found.returncode == 0 and not found.stderr


def without_times(text):
    text = re.sub(r'"engine":"[a-z]+"', '"engine":""', text) # where one cannot be had the other makes the same
    text = re.sub(r'"seconds":[-0-9.e+]+', '"seconds":0', text)
    return re.sub(r"^(  seconds +).*$", r"\1", text, flags=re.M)


class Command:
    def __init__(self, words, options, arguments, folder):
        self.words, self.options, self.arguments, self.folder = words, options, arguments, folder

    def run(self, fault, ends=""):
        """Exit status, output, complaints, files, calls that were counted; `ends`: a folder for those of children."""
        out = tempfile.mkdtemp(dir=self.folder)
        count = tempfile.mktemp(dir=self.folder)
        if "made" in self.options:
            shutil.copy(os.path.join(self.folder, "made.png"), out)
        tests = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
        meshes = os.path.join(tests, "reference", "meshes")
        share = os.path.join(os.path.dirname(tests), "share")
        usual = dict(
            os.environ, GEOMINT_KERNEL=os.path.dirname(tests), XDG_CACHE_HOME=os.path.join(self.folder, "cache"))
        environment = dict(usual, GM_FAULT=fault, GM_FAULT_COUNT=count, GM_FAULT_FOLDER=ends,
                           LD_PRELOAD=self.arguments.library)

        def words_of(text):
            return text.replace("OUT", out).replace("MESHES", meshes).replace("SHARE", share).split()

        words = words_of(self.words)
        first = words if "lost" in self.options else words_of(self.options.get("before", ""))
        if first:
            subprocess.run([self.arguments.geomint] + first, env=usual, check=True, capture_output=True)
        if "lost" in self.options:
            os.unlink(os.path.join(out, self.options["lost"]))
        with tempfile.TemporaryFile(dir=self.folder) as file:
            try:
                done = subprocess.run(
                    [self.arguments.geomint] + words, env=environment, stdout=file, stderr=subprocess.PIPE,
                    timeout=LONGEST, check=False, cwd=out, stdin=subprocess.DEVNULL)
                file.seek(0)
                status, output, said = done.returncode, file.read(), done.stderr
            except subprocess.TimeoutExpired:
                status, output, said = None, b"", b""
        files = {}
        for place, _, names in os.walk(out):
            for name in names:
                path = os.path.join(place, name)
                with open(path, "rb") as file:
                    content = file.read()
                whole = True
                if name.endswith(".png"):
                    whole = png_is_whole(path)
                elif name.endswith(".mp4"):
                    whole = movie_is_whole(path)
                elif name.endswith(".npz"):
                    whole = zipfile.is_zipfile(path) and zipfile.ZipFile(path).testzip() is None
                files[os.path.relpath(path, out)] = (content.replace(out.encode(), b"OUT"), whole)
        calls = 0
        if os.path.exists(count):
            with open(count, encoding="ascii") as file:
                calls = int(file.read() or 0)
            os.unlink(count)
        shutil.rmtree(out)
        output = without_times(output.decode(errors="replace").replace(out, "OUT"))
        return status, output, said.decode(errors="replace"), files, calls

    def numbers_are_right(self, output, whole, full):
        """Every line that came is one that would have come anyway, or says that memory was short; it is whole, but for
        the last one on a disk that is full."""
        known = set(whole.splitlines())
        lines = output.splitlines()
        if not output.endswith("\n") and lines:
            last = lines.pop()
            if not full or not any(line.startswith(last) for line in known):
                return f"half a line: {last[:200]}"
        for line in lines:
            if line in known or not re.search(r"\d", line):
                continue
            if re.match(r'\{.*"status":"(out-of-memory|interrupted)".*\}$', line):
                continue
            if re.search(r"^  status +(out-of-memory|interrupted)$", output, re.M):
                continue
            return f"a line that should not be: {line[:300]}"
        return ""

    def judge(self, kind, usual, found):
        """What is wrong, in words; "" if nothing is."""
        status, output, said, files, _ = found
        if status is None:
            return "it hangs"
        if status < 0 or status > 130:
            return f"it was ended by signal {-status if status < 0 else status - 128}: {said[-300:]}"
        if "Sanitizer" in said:
            return said
        for name, (content, whole) in files.items():
            if not whole:
                return f"{name} is damaged (exit {status}: {said})"
            if os.path.basename(name).startswith("."):
                return f"{name} was left behind (exit {status}: {said})"
        if status == usual[0]:
            if self.options.get("timed"):
                return "" if set(files) == set(usual[3]) else f"other files: {sorted(files)} (exit {status}: {said})"
            if output != usual[1]:
                return f"another output with exit {status}: {output[:400]} ({said})"
            for name, (content, _) in usual[3].items():
                if name not in files:
                    return f"{name} is missing with exit {status} ({said})"
                if name.endswith((".png", ".csv", ".html")) and files[name][0] != content:
                    return f"{name} differs with exit {status} ({said})"
            return ""
        if status not in ((5,) if kind != "files" else self.options.get("statuses", (3,))):
            return f"exit {status}: {said} {output[:200]}"
        if not re.search(r"^geomint: \S+ \S+ \S+", said, re.M):
            return f"exit {status} without a sentence: {said}"
        blamed = [line for line in said.splitlines() if line.startswith("geomint: ")]
        blamed = [line for line in blamed if not re.search(r"memory|^geomint: (wrote|stopped|the run ends|\d+ of) ", line)]
        if kind != "files" and blamed:
            return f"memory is short, and this is blamed: {blamed}"
        for name, (content, _) in files.items():
            if name.endswith(".png") and name in usual[3] and not self.options.get("timed"):
                if content != usual[3][name][0]:
                    return f"{name} differs (exit {status}: {said})"
        if self.options.get("timed") or self.options.get("partial"):
            return ""
        return self.numbers_are_right(output, usual[1], kind == "files")


def sample(count, arguments):
    """Which n of count: all, or as many as asked for, or the first, the last and some between, the same ones every time."""
    if arguments.all and count > arguments.most:
        return [1 + int((k + arguments.day % 10 / 10) * count / arguments.most) for k in range(arguments.most)]
    if arguments.all or count <= SAMPLE:
        return range(1, count + 1)
    between = {1 + k * count // (SAMPLE - 2) + k % 3 for k in range(SAMPLE - 2)}
    return sorted(n for n in between | {1, 2, count} if n <= count)


def todays(items, arguments):
    """All of a list, or with --third every third of it, from another one every day, or with --rest the others."""
    third = items[arguments.day % 3 :: 3]
    return third if arguments.third else [item for item in items if item not in third] if arguments.rest else items


def sweep(command, kind, arguments):
    usual = command.run(kind + ":0")
    if usual[0] != command.options.get("usual", 0):
        return 0, [f"{command.words}: exit {usual[0]} without a fault: {usual[2]}"]
    faults = [f"{kind}:{n}" for n in sample(usual[4], arguments)]
    if kind == "memory":
        faults += [f"{kind}:{n}+" for n in sample(usual[4], arguments)]
    faults = todays(faults, arguments)
    wrong = []
    for fault in faults:
        reason = command.judge(kind, usual, command.run(fault))
        if reason:
            wrong.append(f"GM_FAULT={fault} geomint {command.words}: {reason.strip()}")
    return len(faults), wrong


def sweep_each(command, kind, arguments):
    """As sweep, of every n or every third, in children of one process: of a command that writes to standard output
    alone."""
    which = f"each3.{arguments.day % 3}" if arguments.third or arguments.rest else "each"
    wrong, count = [], 0
    with tempfile.TemporaryDirectory(dir=command.folder) as ends:
        usual = command.run(f"{kind}:{which}", ends)
        if usual[0] != 0:
            return 0, [f"{command.words}: exit {usual[0]} without a fault: {usual[2]}"]

        def text_of(n, ending):
            with open(os.path.join(ends, f"{n}.{ending}"), "rb") as file:
                return file.read()

        for line in text_of(0, "ended").decode().splitlines():
            n, status, written = map(int, line.split())
            output = usual[1].encode()[:written] + text_of(n, "out")
            found = (os.waitstatus_to_exitcode(status), output.decode(), text_of(n, "err").decode(errors="replace"), {}, 0)
            reason = command.judge(kind, usual, found)
            if reason:
                wrong.append(f"GM_FAULT={kind}:{n} geomint {command.words}: {reason.strip()}")
            count += 1
    return count, wrong


def limit(arguments, painter, megabytes, folder):
    """Little address space: Mesa may die of it, but not without a sentence."""
    words = ["prlimit", f"--as={megabytes * 1000000}", arguments.geomint, "render", "disc", "until=1", "--out", folder]
    # what fontconfig cannot read for want of space it takes for no font, and writes that down for all: not here
    with tempfile.TemporaryDirectory() as caches:
        fonts = os.path.join(caches, "fonts.conf")
        with open(fonts, "w", encoding="utf-8") as file:
            file.write(f"<fontconfig><cachedir>{caches}</cachedir><include>/etc/fonts/fonts.conf</include></fontconfig>")
        done = subprocess.run(words, capture_output=True, text=True, timeout=LONGEST, check=False,
                              env=dict(os.environ, FONTCONFIG_FILE=fonts, GEOMINT_PAINTER=painter))
    told = re.search(r"^geomint: \S+ \S+ \S+", done.stderr, re.M) and "not installed" not in done.stderr
    if done.returncode == 0 or (done.returncode == 5 and told):
        return []
    return [f"GEOMINT_PAINTER={painter} {' '.join(words)}: exit {done.returncode}: {done.stderr}"]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("geomint")
    parser.add_argument("library")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--most", type=int, default=sys.maxsize)
    parser.add_argument("--third", action="store_true")
    parser.add_argument("--rest", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--day", type=int, default=int(time.time() / 86400))
    arguments = parser.parse_args()
    arguments.geomint, arguments.library = os.path.abspath(arguments.geomint), os.path.abspath(arguments.library)
    os.environ["GEOMINT_PAINTER"] = "own" # Mesa ends of memory that it is refused
    runs, wrong = 0, []
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        made = [options["made"] for words, options in COMMANDS if "made" in options][0]
        subprocess.run([arguments.geomint, "render"] + made.split() + ["--out", folder], check=True)
        os.rename(os.path.join(folder, "disc-render.png"), os.path.join(folder, "made.png"))
        jobs = []
        for words, options in COMMANDS:
            if arguments.only in words:
                command = Command(words, options, arguments, folder)
                jobs += [(words, kind, pool.submit(sweep, command, kind, arguments)) for kind in ("memory", "files")]
        each = [words.replace("NAME", names[arguments.day % len(names)]) for names in SYSTEMS for words in EACH]
        for words in todays(each, arguments):
            if arguments.only in words:
                command = Command(words, {"partial": True}, arguments, folder)
                jobs += [(words, kind, pool.submit(sweep_each, command, kind, arguments)) for kind in ("memory", "streams")]
        limits = [("osmesa", megabytes) for megabytes in (50, 100, 180, 220, 240, 260, 280, 285, 290, 300, 400)]
        limits += [("own", megabytes) for megabytes in (26, 28, 30, 32, 36, 40, 50, 100)]
        limits += [("auto", megabytes) for megabytes in (40, 100, 280)]
        for painter, megabytes in todays(limits, arguments) if arguments.only in "prlimit" else ():
            runs += 1
            found = limit(arguments, painter, megabytes, folder)
            print("".join(found), end="", flush=True)
            wrong += found
        for words, kind, job in jobs:
            count, found = job.result()
            runs += count
            wrong += found
            for line in found:
                print(line, flush=True)
            if arguments.all:
                print(f"{words}: {count} faults of {kind}, {len(found)} wrong", flush=True)
    print(f"{runs} faults on day {arguments.day}, {len(wrong)} answered wrongly")
    return 1 if wrong or runs == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
