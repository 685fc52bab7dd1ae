/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the kinds of boundary edges to what is given at the boundary's vertices: psi, sheets, the scalar. */
#include "core/flow/boundary.h"

#include <math.h>
#include <stdlib.h>

/* A run of boundary edges of one side: `first` .. `first + count`, cyclic; psi goes from `from` to `to` along
   it. */
struct run {
    size_t first, count;
    double from, to;
};

static size_t next_edge(const struct gm_complex *complex, size_t edge)
{
    return edge + 1 < complex->boundary ? edge + 1 : 0;
}

static size_t edge_before(const struct gm_complex *complex, size_t edge)
{
    return edge > 0 ? edge - 1 : complex->boundary - 1;
}

/* The only run of edges of this side; count = 0 if there is none. */
static enum gm_boundary_fault find_run(const struct gm_complex *complex, const unsigned char *sides,
                                       enum gm_edge_kind side, struct run *run)
{
    size_t runs = 0, total = 0;
    *run = (struct run){0};
    for (size_t e = 0; e < complex->boundary; e++) {
        total += sides[e] == side;
        if (sides[e] == side && sides[edge_before(complex, e)] != side) {
            runs++;
            run->first = e;
        }
    }
    run->count = total;
    return total == complex->boundary ? GM_BOUNDARY_WHOLE
           : runs > 1                 ? GM_BOUNDARY_SEVERAL
           : total == 1               ? GM_BOUNDARY_SHORT
                                      : GM_BOUNDARY_OK;
}

static double run_length(const struct gm_complex *complex, const struct run *run)
{
    double length = 0;
    size_t e = run->first;
    for (size_t i = 0; i < run->count; i++, e = next_edge(complex, e)) {
        length += complex->length[complex->boundary_edge[e]];
    }
    return length;
}

/* Gives the vertices inside a run the kind and the parabolic profile. */
static void open_run(struct gm_flow *flow, const struct run *run, enum gm_vertex_kind kind, bool theta_fixed,
                     double theta)
{
    const struct gm_complex *complex = flow->complex;
    const double length = run_length(complex, run);
    double passed = 0;
    size_t e = run->first;
    for (size_t i = 0; i < run->count; i++, e = next_edge(complex, e)) {
        const int v = complex->boundary_vertex[e];
        if (i > 0) {
            const double s = passed / length;
            flow->kind[v] = (unsigned char)kind;
            flow->psi[v] =
                kind == GM_VERTEX_OPEN ? 0 : run->from + (run->to - run->from) * s * s * (3 - 2 * s);
            flow->theta_fixed[v] = theta_fixed;
            flow->theta[v] = theta_fixed ? theta : 0;
        }
        passed += complex->length[complex->boundary_edge[e]];
    }
}

static bool list_inflow(struct gm_flow *flow, const struct run *run)
{
    const struct gm_complex *complex = flow->complex;
    struct gm_inflow *inflow = &flow->inflow;
    inflow->point = malloc(2 * (run->count + 1) * sizeof *inflow->point);
    inflow->psi = malloc((run->count + 1) * sizeof *inflow->psi);
    if (!inflow->point || !inflow->psi) {
        return false;
    }
    size_t e = run->first;
    for (size_t i = 0; i <= run->count; i++, e = next_edge(complex, e)) {
        const int v = complex->boundary_vertex[e];
        inflow->point[2 * i] = complex->point[2 * v];
        inflow->point[2 * i + 1] = complex->point[2 * v + 1];
        inflow->psi[i] = flow->psi[v];
    }
    inflow->count = run->count + 1;
    return true;
}

enum gm_boundary_fault gm_flow_set_boundary(struct gm_flow *flow, const unsigned char *sides, double speed,
                                            enum gm_vertex_kind outlet, double theta)
{
    const struct gm_complex *complex = flow->complex;
    struct run in, out;
    if (complex->loops != 1) {
        return GM_BOUNDARY_LOOPS;
    }
    enum gm_boundary_fault fault = find_run(complex, sides, GM_EDGE_INLET, &in);
    if (fault == GM_BOUNDARY_OK) {
        fault = find_run(complex, sides, GM_EDGE_OUTLET, &out);
    }
    if (fault != GM_BOUNDARY_OK) {
        return fault;
    }
    if ((in.count > 0) != (out.count > 0)) {
        return in.count > 0 ? GM_BOUNDARY_NO_OUTLET : GM_BOUNDARY_NO_INLET;
    }
    const double through = 2.0 / 3 * speed * run_length(complex, &in);
    for (size_t e = 0; e < complex->boundary; e++) {
        const int v = complex->boundary_vertex[e], end = complex->boundary_vertex[next_edge(complex, e)];
        const bool slip = sides[e] == GM_EDGE_SLIP && sides[edge_before(complex, e)] == GM_EDGE_SLIP;
        flow->kind[v] = slip ? GM_VERTEX_SLIP : GM_VERTEX_FIXED;
        flow->theta_fixed[v] = true;
        flow->theta[v] = 0;
        if (sides[e] == GM_EDGE_LID) {
            const double half = complex->length[complex->boundary_edge[e]] / 2;
            flow->sheet[v] -= speed * half;
            flow->sheet[end] -= speed * half;
        }
    }
    flow->speed = speed;
    if (in.count == 0) {
        return GM_BOUNDARY_OK;
    }
    flow->speed = fmax(speed, 1.5 * through / run_length(complex, &out));
    /* psi rises over the outlet, stays, and falls over the inlet */
    size_t e = out.first;
    for (size_t i = 0; i < out.count; i++) {
        e = next_edge(complex, e);
    }
    for (; e != in.first; e = next_edge(complex, e)) {
        flow->psi[complex->boundary_vertex[e]] = through;
    }
    flow->psi[complex->boundary_vertex[in.first]] = through;
    in.from = out.to = through;
    open_run(flow, &in, GM_VERTEX_FIXED, true, theta);
    open_run(flow, &out, outlet, false, 0);
    return list_inflow(flow, &in) ? GM_BOUNDARY_OK : GM_BOUNDARY_MEMORY;
}
