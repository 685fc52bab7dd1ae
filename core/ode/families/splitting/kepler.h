/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_FAMILIES_SPLITTING_KEPLER_H
#define GM_CORE_ODE_FAMILIES_SPLITTING_KEPLER_H

#include <stdbool.h>
#include <stddef.h>

/* Advances q and v = q' in place, in a plane or in space, by the exact motion q'' = -mu q/|q|^3 over the time h: ellipses
   of many revolutions, parabolas and hyperbolas. Returns false if it is not found, as at the origin. */
bool gm_kepler_flow(size_t dimensions, double mu, double h, double *q, double *v);

#endif
