/* SPDX-License-Identifier: GPL-3.0-or-later */
#define GM_TANGENT
#include "core/ode/problems/oscillator.kernel.h"
