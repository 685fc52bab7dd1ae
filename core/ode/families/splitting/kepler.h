/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_FAMILIES_SPLITTING_KEPLER_H
#define GM_CORE_ODE_FAMILIES_SPLITTING_KEPLER_H

#include <stdbool.h>

/* Advances y = q1 q2 p1 p2 in place by the exact motion of H = |p|^2/2 - 1/|q| in the plane over the time h.
   Returns false if it is not found, as at the origin. */
bool gm_kepler_flow(double h, double y[4]);

#endif
