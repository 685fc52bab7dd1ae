# SPDX-License-Identifier: GPL-3.0-or-later
"""The tests of the package, where what they need is installed; else they are skipped."""
import os
import sys

try:
    import cffi  # noqa: F401
    import numpy  # noqa: F401
    import pytest
    import scipy  # noqa: F401
except ImportError as error:
    print(f"{error}: python3-cffi, python3-numpy, python3-pytest, python3-scipy")
    sys.exit(77)
sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", os.path.dirname(os.path.abspath(__file__))]))
