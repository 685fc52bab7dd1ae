# SPDX-License-Identifier: GPL-3.0-or-later
"""States and pictures of the library in WebAssembly against the native one: same.py BUILD BUILD_WEB [FONTS [time]].
Each run of runs.txt must end in the same bits, made by the same engine, and each picture have the same pixels as the
program's own painter. With the word time it measures instead the processor time that runs take in node, and natively (of a
build with -Dloops=baseline, which has no wider vectors than WebAssembly)."""
import ctypes
import hashlib
import json
import os
import shlex
import statistics
import subprocess
import sys
import time

build, web = sys.argv[1:3]
fonts = sys.argv[3] if len(sys.argv) > 3 else "/usr/share/fonts/truetype/dejavu"
folder = os.path.dirname(os.path.abspath(__file__))
os.environ["GEOMINT_PAINTER"] = "own"
library = ctypes.CDLL(os.path.abspath(build + "/library/libgeomint.so.1"))
handle, size = ctypes.c_void_p, ctypes.c_size_t
for name, result, arguments in [
    ("open", handle, [ctypes.c_int, handle]),
    ("message", ctypes.c_char_p, [handle]),
    ("text", ctypes.c_char_p, [handle]),
    ("lanes", size, [handle]),
    ("steps_left", ctypes.c_int64, [handle, size]),
    ("step", ctypes.c_int, [handle, size, ctypes.c_int64]),
    ("state", handle, [handle, size, handle, handle]),
    ("draw", ctypes.c_int, [handle, ctypes.c_int, ctypes.c_int, ctypes.c_double, handle]),
    ("close", None, [handle]),
]:
    function = getattr(library, "geomint_" + name)
    function.restype, function.argtypes = result, arguments


def states(run):
    sums, n, m = [], size(), size()
    for lane in range(library.geomint_lanes(run)):
        while (left := library.geomint_steps_left(run, lane)) != 0:
            library.geomint_step(run, lane, left if left > 0 else 1000)
        state = library.geomint_state(run, lane, ctypes.byref(n), ctypes.byref(m))
        sums.append(hashlib.md5(ctypes.string_at(state, 8 * n.value * m.value)).hexdigest())
    if not sums:
        return [library.geomint_message(run).decode()]
    return sums + [lane.get("engine") for lane in json.loads(library.geomint_text(run))]


def picture(run, width, height, scale):
    rgba = ctypes.create_string_buffer(4 * width * height)
    library.geomint_draw(run, width, height, scale, rgba)
    return [hashlib.md5(rgba.raw).hexdigest()]


def native(words, shape):
    run = library.geomint_open(len(words), (ctypes.c_char_p * len(words))(*map(str.encode, words)))
    sums = states(run)
    if shape:
        sums = picture(run, *map(int, shape.split("x")))
    library.geomint_close(run)
    return sums


def in_wasm(lines, shape):
    command = ["node", folder + "/states.js", web + "/library/geomint.js", fonts, *([shape] if shape else [])]
    text = "".join(json.dumps(words) + "\n" for words in lines)
    answer = subprocess.run(command, input=text, capture_output=True, text=True, check=True)
    return [json.loads(line) for line in answer.stdout.splitlines()]


def times(runs, rounds=5):
    """Medians of the seconds of processor time of both, of rounds in turns, and their ratio."""
    for words in map(shlex.split, runs):
        native_times, wasm_times = [], []
        for _ in range(rounds):
            begun = time.process_time()
            native(words, "")
            native_times.append(time.process_time() - begun)
            wasm_times += in_wasm([words], "time")
        ours, wasm = statistics.median(native_times), statistics.median(wasm_times)
        print(f"{shlex.join(words)}: {ours:.3f} s, in WebAssembly {wasm:.3f} s, {wasm / ours:.2f} times", flush=True)


if sys.argv[4:] == ["time"]:
    # long runs: opening the first one takes .1 s in node, which compiles the program meanwhile
    times(["kepler scheme=verlet steps=2e8", "kepler scheme=rk4 steps=1e8", "kepler scheme=gauss4 steps=2e7",
           "disc scheme=verlet points=1e4 steps=1e5", "disc scheme=rk4 points=1e4 steps=4e4",
           "system 'H=p^2/2 - cos(q)' q=1 p=0 scheme=verlet steps=1e8"])
    sys.exit(0)

jobs = {}  # lines of words by the size of their pictures, "" for states
for line in open(folder + "/runs.txt", encoding="utf-8"):
    if line.strip() and not line.startswith("#"):
        first, *words = shlex.split(line)
        jobs.setdefault("" if first == "state" else first, []).append(words)
bad = count = 0
for shape, lines in jobs.items():
    for words, sums in zip(lines, in_wasm(lines, shape), strict=True):
        count += 1
        if sums != native(words, shape):
            bad += 1
            print("differs:", shape or "state", *words)
print(f"{count - bad} passed, {bad} failed")
sys.exit(bad > 0)
