/* SPDX-License-Identifier: GPL-3.0-or-later */
#define GM_PERTURBED
#include "core/ode/problems/kepler.kernel.h"
