/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_TRACERS_H
#define GM_CORE_FLOW_TRACERS_H

#include "core/flow/flow.h"

/* Carries the tracers of y for the time dt into those of out, with the midpoint rule and velocities
   interpolated linearly between the vertices (gm_flow_vertex_velocities). They are passive: the flow does
   not depend on them. A tracer that leaves through an outlet returns at the inflow, at a place given by
   `step` and its number. */
void gm_tracers_carry(const struct gm_flow *flow, const double *velocities, double dt, int64_t step,
                      const double *y, double *out);

/* Has the tracers of the start y wait outside, to come in one after the other. */
void gm_tracers_wait(const struct gm_flow *flow, double *y);

#endif
