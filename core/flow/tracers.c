/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tracers: particles that a flow carries. They walk from triangle to triangle; nothing is searched for. */
#include "core/flow/flow.h"

#include <math.h>
#include <string.h>

/* Walks from place->triangle towards the point; returns false if the walk leaves the mesh. */
static bool locate(const struct gm_complex *complex, struct gm_flow_place *place, double w[3])
{
    enum { FARTHEST = 1000 };
    for (int i = 0; i < FARTHEST; i++) {
        gm_complex_coordinates(complex, (size_t)place->triangle, place->x, w);
        int worst = 0;
        for (int k = 1; k < 3; k++) {
            worst = w[k] < w[worst] ? k : worst;
        }
        if (w[worst] >= -1e-12) {
            return true;
        }
        const int *pair =
            complex->edge_triangle + 2 * complex->triangle_edge[3 * place->triangle + (worst + 1) % 3];
        const int next = pair[0] == place->triangle ? pair[1] : pair[0];
        if (next < 0) {
            return false;
        }
        place->triangle = next;
    }
    return false;
}

static void velocity_at(const struct gm_complex *complex, const double *velocities,
                        const struct gm_flow_place *place, const double w[3], double u[2])
{
    const int *t = complex->triangle + 3 * place->triangle;
    for (int c = 0; c < 2; c++) {
        u[c] = w[0] * velocities[2 * t[0] + c] + w[1] * velocities[2 * t[1] + c] +
               w[2] * velocities[2 * t[2] + c];
    }
}

static bool move(const struct gm_complex *complex, const double *velocities, double dt,
                 struct gm_flow_place *place)
{
    double w[3], u[2];
    if (!locate(complex, place, w)) {
        return false;
    }
    const struct gm_flow_place start = *place;
    for (int stage = 1; stage <= 2; stage++) {
        velocity_at(complex, velocities, place, w, u);
        for (int c = 0; c < 2; c++) {
            place->x[c] = start.x[c] + dt * u[c] * stage / 2;
        }
        if (!locate(complex, place, w)) {
            /* it hit the boundary: a wall stops it; through an opening it leaves */
            *place = start;
            return false;
        }
    }
    for (int c = 0; c < 2; c++) {
        const double period = complex->period[c];
        place->x[c] -= period > 0 ? period * floor(place->x[c] / period) : 0;
    }
    return true;
}

/* Returns true if a triangle touches an open vertex of the outlet. */
static bool at_outlet(const struct gm_flow *flow, int triangle)
{
    for (int k = 0; k < 3; k++) {
        const int v = flow->complex->triangle[3 * triangle + k];
        if (flow->open[v] == GM_OPEN_OUTLET) {
            return true;
        }
    }
    return false;
}

/* A point of the inflow line, by the share of the flux that enters below it. */
static void enter_with_air(const struct gm_flow *flow, double share, struct gm_flow_place *place)
{
    const struct gm_inflow *inflow = &flow->inflow;
    const double first = inflow->psi[0], last = inflow->psi[inflow->count - 1],
                 psi = first + share * (last - first);
    size_t i = 0;
    while (i + 2 < inflow->count && (inflow->psi[i + 1] - psi) * (last - first) < 0) {
        i++;
    }
    const double across = inflow->psi[i + 1] - inflow->psi[i], /* 0 while nothing enters */
        s = across != 0 ? (psi - inflow->psi[i]) / across : share;
    place->triangle = inflow->triangle[i];
    for (int c = 0; c < 2; c++) {
        place->x[c] = inflow->point[2 * i + (size_t)c] +
                      s * (inflow->point[2 * i + 2 + (size_t)c] - inflow->point[2 * i + (size_t)c]);
    }
}

/* Places an entering tracer, at its step: with the air of inlets or, every fourth of smoke, at a source. */
static void enter(const struct gm_flow *flow, size_t tracer, int64_t step, struct gm_flow_place *place)
{
    const bool smokes = flow->smoking_count > 0 && (tracer % 4 == 0 || flow->inflow.count == 0);
    double w[3];
    if (smokes) {
        *place = flow->smoking[tracer / 4 % flow->smoking_count];
    } else if (flow->inflow.count > 1) {
        const double turn = 0.6180339887498949 * (double)step + 0.7548776662466927 * (double)tracer;
        enter_with_air(flow, fmod(turn, 1), place);
    }
    locate(flow->complex, place, w); /* it comes near; the next step continues from there */
}

/* They are strewn by the golden ratio's multiples over the triangles, by area. */
void gm_tracers_strew(const struct gm_flow *flow, double *y)
{
    const struct gm_complex *complex = flow->complex;
    const bool wait = flow->smoke && (flow->inflow.count > 1 || flow->smoking_count > 0);
    double *tracer = y + gm_flow_block_numbers(flow) + 1, before = 0;
    size_t t = 0;
    for (size_t i = 0; i < flow->tracers; i++, tracer += GM_TRACER_NUMBERS) {
        const double at = ((double)i + 0.5) / (double)flow->tracers * complex->total_area;
        while (t + 1 < complex->triangles && before + complex->area[t] < at) {
            before += complex->area[t++];
        }
        double p[6];
        gm_complex_corners(complex, t, p);
        const double r = sqrt(fmod((double)i * 0.7548776662466927, 1)),
                     s = fmod((double)i * 0.5698402909980532, 1);
        const double w[3] = {1 - r, r * (1 - s), r * s};
        struct gm_flow_place place = {
            {w[0] * p[0] + w[1] * p[2] + w[2] * p[4], w[0] * p[1] + w[1] * p[3] + w[2] * p[5]}, (int)t};
        if (wait) {
            enter(flow, i, 0, &place);
        }
        tracer[GM_TRACER_X] = place.x[0];
        tracer[GM_TRACER_Y] = place.x[1];
        tracer[GM_TRACER_TRIANGLE] = place.triangle;
        tracer[GM_TRACER_AGE] = wait ? -1 - (double)i : 0;
    }
}

/* The number of tracers that enter during a step: each represents as much air as if they filled the room.
   Without inflow, one tracer enters in two steps. */
static double incoming(const struct gm_flow *flow, double dt)
{
    const struct gm_inflow *inflow = &flow->inflow;
    return inflow->count > 1
               ? (double)flow->tracers * dt * fabs(inflow->psi[inflow->count - 1] - inflow->psi[0]) /
                     flow->complex->total_area
               : 0.5;
}

void gm_tracers_carry(const struct gm_flow *flow, const double *velocities, double dt, int64_t step,
                      const double *y, double *out)
{
    const struct gm_complex *complex = flow->complex;
    const double rate = flow->smoke ? incoming(flow, dt) : 0;
    for (size_t i = 0; i < flow->tracers; i++) {
        const double *from = gm_flow_tracer(flow, y, i);
        double *to = out + (from - y);
        struct gm_flow_place place = {{from[GM_TRACER_X], from[GM_TRACER_Y]}, (int)from[GM_TRACER_TRIANGLE]};
        const bool waits = from[GM_TRACER_AGE] < 0;
        double age = from[GM_TRACER_AGE] + (waits ? rate : 1);
        const bool leaves =
            !waits && !move(complex, velocities, dt, &place) && at_outlet(flow, place.triangle);
        if (leaves || (waits && age >= 0)) {
            enter(flow, i, step, &place);
            age = 0;
        }
        to[GM_TRACER_X] = place.x[0];
        to[GM_TRACER_Y] = place.x[1];
        to[GM_TRACER_TRIANGLE] = place.triangle;
        to[GM_TRACER_AGE] = age;
    }
}
