/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_START_H
#define GM_CORE_FLOW_START_H

#include "core/flow/flow.h"

/* States that a run may start from: psi for a vorticity, the given scalar, tracers strewn evenly. */

/* The start without vorticity: K psi = 0 inside. Vertices of soft outlets have omega = 0. Returns false
   when out of memory, or if the boundary leaves psi undetermined. */
bool gm_flow_start_irrotational(const struct gm_flow *flow, double *y);
/* The start from vorticity at the vertices, on a closed surface or between slip walls: K psi = star0 omega,
   omega less its mean on a closed surface. */
bool gm_flow_start_vorticity(const struct gm_flow *flow, const double *omega, double *y);

#endif
