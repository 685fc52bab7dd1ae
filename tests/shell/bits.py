#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every scene, system and room has the same bits whatever functions the C library chooses for the processor, and
whichever compiler built the program, which contains no instruction that multiplies and adds with one rounding. Usage:
bits.py GEOMINT [GEOMINT OF ANOTHER BUILD...]"""
import hashlib
import os
import re
import subprocess
import sys

SETTINGS = ["", "glibc.cpu.hwcaps=-FMA,-FMA4", "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F"]
MORE = """disc system=pendulum scheme=rk4 until=60
disc system=pendulum scheme=midpoint steps=50
sine-gordon scheme=energy-conserving steps=50
nls scheme=split-step2 steps=50
kdv scheme=fourier-rk4 points=1009 steps=20
kepler scheme=dopri5 until=20"""


def output(program, words, settings=""):
    environment = dict(os.environ, GLIBC_TUNABLES=settings)
    done = subprocess.run([program, *words], capture_output=True, text=True, env=environment, check=False)
    return re.sub(r'"[a-z_]*seconds[a-z_]*":[-0-9.e+]+', "", done.stdout)


def names(program, kind):
    return {line.split()[0] for line in output(program, ["list", kind]).split("\n") if line[:1].strip()}


programs = sys.argv[1:]
found = set().union(*(names(programs[0], kind) for kind in ("scenes", "systems", "rooms")))
runs = [[name, "steps=6"] for name in sorted(found)] + [line.split() for line in MORE.split("\n")]
wrong = 0
digest = hashlib.md5()
for run in runs:
    words = ["run", *run, "--json", "--state"]
    outputs = [output(program, words, settings) for program in programs for settings in SETTINGS]
    digest.update(outputs[0].encode())
    if '"state"' not in outputs[0] or len(set(outputs)) > 1:
        wrong += 1
        print("run", *run, "has", len(set(outputs)), "results")
for program in programs:
    code = subprocess.run(["objdump", "-d", "--no-show-raw-insn", program], capture_output=True, text=True, check=False).stdout
    fused = re.findall(r"^.*\b(?:vfn?m(?:add|sub)|fn?m(?:add|sub|la|ls)\b).*$", code, re.MULTILINE)
    if fused or "<main>:" not in code:
        wrong += 1
        print(program, "has", len(fused), "fused instructions or no code:", *fused[:3])
print(digest.hexdigest(), len(runs), "runs,", wrong, "differ")
sys.exit(wrong > 0 or len(runs) < 60)
