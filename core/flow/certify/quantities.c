/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A flow's mesh and state by names. */
#include <math.h>
#include <string.h>

#include "core/basics.h"
#include "core/flow/flow.h"
#include "core/quantity.h"
#include "core/run.h"

static const struct gm_flow *flow_of(const struct gm_run *run)
{
    return gm_flow_of(run->problem);
}

static void points(const struct gm_run *run, size_t first, double *values)
{
    (void)first;
    const struct gm_complex *complex = flow_of(run)->complex;
    memcpy(values, complex->point, 2 * complex->vertices * sizeof *values);
}

static void triangles(const struct gm_run *run, size_t first, double *values)
{
    (void)first;
    const struct gm_complex *complex = flow_of(run)->complex;
    for (size_t i = 0; i < 3 * complex->triangles; i++) {
        values[i] = complex->triangle[i];
    }
}

static void velocity(const struct gm_run *run, size_t first, double *values)
{
    (void)first;
    const struct gm_complex *complex = flow_of(run)->complex;
    for (size_t t = 0; t < complex->triangles; t++) {
        gm_flow_velocity(complex, gm_run_state(run), t, values + 2 * t);
    }
}

static void pressure(const struct gm_run *run, size_t first, double *values)
{
    (void)first;
    const struct gm_flow *flow = flow_of(run);
    if (run->steps == 0 || !gm_flow_pressure(flow, gm_run_state(run), values)) {
        for (size_t t = 0; t < flow->complex->triangles; t++) {
            values[t] = NAN;
        }
    }
}

static void tracers(const struct gm_run *run, size_t number, double *values)
{
    const struct gm_flow *flow = flow_of(run);
    for (size_t i = 0; i < flow->tracers; i++) {
        values[i] = gm_flow_tracer(flow, gm_run_state(run), i)[number];
    }
}

/* The arrays of a run. The complex: points and triangles. At its vertices: stream_function, vorticity and,
   if it is carried, scalar. On its triangles: velocity and, with a boundary, pressure: the total pressure
   over the density, of mean 0, after the last step, and NaN before the first one. The tracers: tracer_x
   and tracer_y. */
size_t gm_flow_quantities(const struct gm_run *run, struct gm_quantity *quantities)
{
    const struct gm_flow *flow = flow_of(run);
    const size_t v = flow->complex->vertices, t = flow->complex->triangles, count = flow->tracers;
    const struct {
        bool there;
        struct gm_quantity quantity;
    } all[] = {
        {true,
         {"points", GM_ON_NODES, v, 2, .axis = 1,
          .period = {flow->complex->period[0], flow->complex->period[1]}, .fixed = true, .derive = points}},
        {true, {"triangles", GM_ON_CELLS, t, 3, .fixed = true, .whole = true, .derive = triangles}},
        {true, {"stream_function", GM_ON_NODES, v, 1, .first = GM_FLOW_PSI * v}},
        {true, {"vorticity", GM_ON_NODES, v, 1, .first = GM_FLOW_OMEGA * v}},
        {flow->scalar, {"scalar", GM_ON_NODES, v, 1, .first = GM_FLOW_THETA * v}},
        {flow->heat, {"temperature", GM_ON_NODES, v, 1, .first = GM_FLOW_TEMPERATURE * v}},
        {true, {"velocity", GM_ON_CELLS, t, 2, .derive = velocity}},
        {flow->complex->boundary > 0, {"pressure", GM_ON_CELLS, t, 1, .derive = pressure}},
        {count > 0,
         {"tracer_x", GM_ON_TRACERS, count, 1, .first = GM_TRACER_X, .axis = 1, .derive = tracers}},
        {count > 0,
         {"tracer_y", GM_ON_TRACERS, count, 1, .first = GM_TRACER_Y, .axis = 2, .derive = tracers}},
    };
    size_t there = 0;
    for (size_t i = 0; i < GM_COUNT(all); i++) {
        if (all[i].there) {
            quantities[there++] = all[i].quantity;
        }
    }
    return there;
}
