/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_CERTIFY_QUANTITIES_H
#define GM_CORE_FLOW_CERTIFY_QUANTITIES_H

#include "core/quantity.h"

/* The arrays of a run. The complex: points and triangles. At its vertices: stream_function, vorticity and,
   if it is carried, scalar. On its triangles: velocity and, with a boundary, pressure: the total pressure
   over the density, of mean 0, after the last step, and NaN before the first one. The tracers: tracer_x
   and tracer_y. */
size_t gm_flow_quantities(const struct gm_run *run, struct gm_quantity *quantities);

#endif
