#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What decides on numbers of a run calls no function of the C library's mathematics but exact ones: the bits of others
depend on the processor. Usage: functions.py BUILD"""
import glob
import os
import subprocess
import sys

build = sys.argv[1]
EXACT = set("""sqrt fabs floor ceil trunc rint nearbyint round lround lrint llround fmod remainder fma ldexp frexp scalbn ilogb logb
fmin fmax copysign modf nextafter cproj conj creal cimag""".split())


def symbols(*arguments):
    lines = subprocess.run(["nm", *arguments], capture_output=True, text=True, check=True).stdout.split("\n")
    return [line.split()[-1].split("@")[0] for line in lines if line.strip() and not line.endswith(":")]


program = os.path.join(build, "app/geomint")
loaded = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
library = next(line.split("=>")[1].split()[0] for line in loaded.split("\n") if "libm.so" in line)
of_library = set(symbols("-D", "--defined-only", library))
if not {"sin", "pow", "cexp"} <= of_library:
    sys.exit("no functions found in " + library)
archives = sorted(glob.glob(os.path.join(build, "core/*.a")) + glob.glob(os.path.join(build, "scenes/*.a")))
found = False
for archive in archives:
    for name in sorted(set(symbols("-u", archive)) & of_library - EXACT):
        found = True
        print(f"{os.path.relpath(archive, build)} calls {name}: core/functions has gm_{name}")
if not archives or found:
    sys.exit(1)
