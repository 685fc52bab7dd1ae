/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Kepler problem (kepler.kernel.h) with the perturbation -e/|q|^2. */
#define GM_PERTURBED
#include "tests/problems/kepler.kernel.h"
