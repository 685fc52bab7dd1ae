/* SPDX-License-Identifier: GPL-3.0-or-later */
#define GM_SPRINGS 5
#include "core/ode/problems/fpu.kernel.h"
