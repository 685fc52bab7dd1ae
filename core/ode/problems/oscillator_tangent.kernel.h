/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The harmonic oscillator (oscillator.kernel.h) with two tangent vectors; see
   core/ode/kernel/one_degree.h. */
#define GM_TANGENT
#include "core/ode/problems/oscillator.kernel.h"
