/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_TRACERS_H
#define GM_CORE_FLOW_TRACERS_H

#include "core/flow/flow.h"

/* Carries the tracers of y for the time dt into those of out, by the midpoint rule with velocities
   interpolated linearly between the vertices (gm_flow_vertex_velocities). They are passive: nothing else is
   read or written. Who leaves through an outlet comes back at the inflow, at a place that `step` and its
   number decide. */
void gm_tracers_carry(const struct gm_flow *flow, const double *velocities, double dt, int64_t step,
                      const double *y, double *out);

/* Has the tracers of the start y wait outside, to come in one after the other. */
void gm_tracers_wait(const struct gm_flow *flow, double *y);

#endif
