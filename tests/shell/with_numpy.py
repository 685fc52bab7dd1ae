# SPDX-License-Identifier: GPL-3.0-or-later
"""NumPy for a test, by the system's Python where the one that runs has none; else the test is skipped."""
import os
import sys

SYSTEM = "/usr/bin/python3"  # another one may come first in PATH
try:
    import numpy
except ImportError:
    if os.path.exists(SYSTEM) and os.path.realpath(sys.executable) != os.path.realpath(SYSTEM):
        os.execv(SYSTEM, [SYSTEM] + sys.argv)
    print(f"{os.path.basename(sys.argv[0])}: NumPy is not installed")
    sys.exit(77)
