/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_CERTIFY_QUANTITIES_H
#define GM_CORE_FLOW_CERTIFY_QUANTITIES_H

#include "core/quantity.h"

/* Of the complex: points and triangles. At its vertices: stream_function, vorticity and, where it is carried,
   scalar. On its triangles: velocity and, where there is a boundary, pressure: the total pressure over the
   density, of mean 0, after the last step, and no number before the first one. Of the tracers: tracer_x and
   tracer_y. */
size_t gm_flow_quantities(const struct gm_run *run, struct gm_quantity *quantities);

#endif
