/* SPDX-License-Identifier: GPL-3.0-or-later */
#define GM_PERTURBED
#include "core/problems/kepler.kernel.h"
