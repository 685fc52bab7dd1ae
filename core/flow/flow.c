/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flows: their memory, fluxes, vorticity and velocities, and the states that a run starts from. */
#include "core/flow/flow.h"
#include "core/arena.h"
#include "core/functions/functions.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

size_t gm_flow_size(const struct gm_flow *flow)
{
    return gm_flow_block_numbers(flow) + 1 + GM_TRACER_NUMBERS * flow->tracers;
}

size_t gm_flow_block_numbers(const struct gm_flow *flow)
{
    return (size_t)(flow->heat ? GM_FLOW_MOST_BLOCKS : GM_FLOW_BLOCKS) * flow->complex->vertices;
}

const double *gm_flow_block(const struct gm_flow *flow, const double *y, enum gm_flow_block block)
{
    return y + (size_t)block * flow->complex->vertices;
}

double gm_flow_step(const struct gm_flow *flow, const double *y)
{
    return y[gm_flow_block_numbers(flow)];
}

const double *gm_flow_tracer(const struct gm_flow *flow, const double *y, size_t tracer)
{
    return y + gm_flow_block_numbers(flow) + 1 + GM_TRACER_NUMBERS * tracer;
}

/* An array for n vertices: zeros, or a copy. */
static void *array(struct gm_arena *arena, size_t n, size_t size, const void *values)
{
    void *array = gm_arena_take(arena, n, size);
    return values ? memcpy(array, values, n * size) : array;
}

/* Opens a flow like the one that the data points to, with arrays of its own. */
static void open_flow(struct gm_arena *arena, void *data)
{
    const struct gm_flow *like = *(struct gm_flow **)data;
    struct gm_flow *flow = gm_arena_take(arena, 1, sizeof *flow);
    const size_t n = like->complex->vertices, boundary = like->complex->boundary;
    *flow = *like;
    flow->arena = arena;
    flow->kind = array(arena, n, 1, like->kind);
    flow->psi = array(arena, n, sizeof(double), like->psi);
    flow->hole = array(arena, n, sizeof(int), like->hole);
    flow->open = array(arena, n, 1, like->open);
    flow->sheet = array(arena, n, sizeof(double), like->sheet);
    flow->theta_fixed = array(arena, n, sizeof(bool), like->theta_fixed);
    flow->theta = array(arena, n, sizeof(double), like->theta);
    flow->temperature_fixed = array(arena, n, sizeof(bool), like->temperature_fixed);
    flow->temperature = array(arena, n, sizeof(double), like->temperature);
    flow->temperature_holder = array(arena, n, 1, like->temperature_holder);
    flow->heating = array(arena, n, sizeof(double), like->heating);
    flow->opening = gm_arena_take(arena, boundary + 1, sizeof *flow->opening);
    /* an opening has a point more than edges, of which there are two at least */
    flow->inflow = (struct gm_inflow){.point = gm_arena_take(arena, 3 * boundary + 2, sizeof(double)),
                                      .psi = gm_arena_take(arena, 2 * boundary + 1, sizeof(double)),
                                      .triangle = gm_arena_take(arena, 2 * boundary + 1, sizeof(int))};
    *(struct gm_flow **)data = flow;
}

struct gm_flow *gm_flow_open_now(const struct gm_flow *flow)
{
    const struct gm_flow *now = flow;
    return gm_arena_made(open_flow, &now) ? (struct gm_flow *)(uintptr_t)now : NULL;
}

struct gm_flow *gm_flow_open(struct gm_complex *complex)
{
    struct gm_flow *flow = gm_flow_open_now(&(struct gm_flow){.complex = complex, .time_unit = 1});
    if (!flow) {
        gm_complex_close(complex);
    } else if (!gm_arena_keep(flow->arena, complex, gm_complex_close)) {
        gm_flow_close(flow);
        flow = NULL;
    }
    return flow;
}

void gm_flow_close(void *flow)
{
    if (flow) {
        gm_arena_close(((struct gm_flow *)flow)->arena);
    }
}

void gm_flow_carry_heat(struct gm_flow *flow, double buoyancy, double reference_temperature)
{
    flow->heat = true;
    flow->buoyancy = buoyancy;
    flow->reference_temperature = reference_temperature;
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        flow->temperature[v] = reference_temperature;
    }
}

/* psi interpolated to the dual vertex of a triangle */
static double at_centre(const struct gm_complex *complex, const double *psi, size_t triangle)
{
    const int *t = complex->triangle + 3 * triangle;
    const double *w = complex->weight + 3 * triangle;
    return w[0] * psi[t[0]] + w[1] * psi[t[1]] + w[2] * psi[t[2]];
}

static double flux_between(const struct gm_complex *complex, const double *psi, const double *centre,
                           size_t edge)
{
    const int *side = complex->edge_triangle + 2 * edge;
    const double middle = (psi[complex->edge[2 * edge]] + psi[complex->edge[2 * edge + 1]]) / 2;
    double value[2];
    for (int k = 0; k < 2; k++) {
        value[k] = side[k] < 0 ? middle : centre ? centre[side[k]] : at_centre(complex, psi, (size_t)side[k]);
    }
    return value[0] - value[1];
}

double gm_flow_flux(const struct gm_complex *complex, const double *psi, size_t edge)
{
    return flux_between(complex, psi, NULL, edge);
}

void gm_flow_fluxes(const struct gm_complex *complex, const double *psi, double *scratch, double *flux)
{
    for (size_t t = 0; t < complex->triangles; t++) {
        scratch[t] = at_centre(complex, psi, t);
    }
    for (size_t e = 0; e < complex->edges; e++) {
        flux[e] = flux_between(complex, psi, scratch, e);
    }
}

double gm_flow_row(const struct gm_complex *complex, const double *psi, size_t vertex)
{
    double sum = 0;
    for (int k = complex->ring_start[vertex]; k < complex->ring_start[vertex + 1]; k++) {
        sum += complex->star1[complex->ring_edge[k]] * (psi[vertex] - psi[complex->ring_vertex[k]]);
    }
    return sum;
}

void gm_flow_vorticity(const struct gm_flow *flow, const double *psi, double *omega)
{
    const struct gm_complex *complex = flow->complex;
    for (size_t v = 0; v < complex->vertices; v++) {
        if (flow->kind[v] == GM_VERTEX_SOFT) {
            continue;
        }
        double sum = flow->sheet[v];
        for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
            sum += complex->star1[complex->ring_edge[k]] * (psi[v] - psi[complex->ring_vertex[k]]);
        }
        omega[v] = flow->kind[v] == GM_VERTEX_SLIP ? 0 : sum / complex->star0[v];
    }
}

void gm_flow_velocity(const struct gm_complex *complex, const double *psi, size_t triangle,
                      double velocity[2])
{
    double p[6];
    const int *t = complex->triangle + 3 * triangle;
    gm_complex_corners(complex, triangle, p);
    const double twice = 2 * complex->area[triangle], first = psi[t[1]] - psi[t[0]],
                 second = psi[t[2]] - psi[t[0]];
    velocity[0] = (second * (p[2] - p[0]) - first * (p[4] - p[0])) / twice;
    velocity[1] = -(first * (p[5] - p[1]) - second * (p[3] - p[1])) / twice;
}

double gm_flow_largest_speed(const struct gm_flow *flow, const double *psi)
{
    double largest = flow->speed, most = 0;
    for (size_t t = 0; t < flow->complex->triangles; t++) {
        double u[2];
        gm_flow_velocity(flow->complex, psi, t, u);
        const double square = u[0] * u[0] + u[1] * u[1];
        if (square >= most * (1 - 1e-14)) { /* it may be the largest: squares are cheaper than roots */
            most = fmax(most, square);
            largest = fmax(largest, gm_hypot(u[0], u[1]));
        }
    }
    return largest;
}

void gm_flow_vertex_velocities(const struct gm_complex *complex, const double *psi, double *velocities)
{
    memset(velocities, 0, 3 * complex->vertices * sizeof *velocities);
    double *weight = velocities + 2 * complex->vertices;
    for (size_t t = 0; t < complex->triangles; t++) {
        double u[2];
        gm_flow_velocity(complex, psi, t, u);
        for (int k = 0; k < 3; k++) {
            const int v = complex->triangle[3 * t + (size_t)k];
            velocities[2 * v] += complex->area[t] * u[0];
            velocities[2 * v + 1] += complex->area[t] * u[1];
            weight[v] += complex->area[t];
        }
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        velocities[2 * v] /= weight[v];
        velocities[2 * v + 1] /= weight[v];
    }
}

double gm_flow_star(const struct gm_complex *complex, const double *values, size_t edge)
{
    if (complex->star == GM_STAR_CIRCUMCENTRIC) {
        return complex->star1[edge] * (values[complex->edge[2 * edge + 1]] - values[complex->edge[2 * edge]]);
    }
    /* from the middle of the edge to the centre of mass of a triangle with the third corner c: (2 c - a - b)
       / 6 */
    double sum = 0;
    for (int side = 0; side < 2; side++) {
        const int t = complex->edge_triangle[2 * edge + (size_t)side];
        double p[6], u[2];
        int a = 0;
        if (t < 0) {
            continue;
        }
        while (complex->triangle_edge[3 * t + a] != (int)edge) {
            a++;
        }
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        gm_complex_corners(complex, (size_t)t, p);
        gm_flow_velocity(complex, values, (size_t)t, u);
        const double along = u[0] * (2 * p[2 * c] - p[2 * a] - p[2 * b]) / 6 +
                             u[1] * (2 * p[2 * c + 1] - p[2 * a + 1] - p[2 * b + 1]) / 6;
        sum += side == 0 ? -along : along;
    }
    return sum;
}

double gm_flow_lift(const struct gm_flow *flow, const double *temperature, size_t edge)
{
    const struct gm_complex *complex = flow->complex;
    const int *end = complex->edge + 2 * edge, *side = complex->edge_triangle + 2 * edge;
    const double middle = (temperature[end[0]] + temperature[end[1]]) / 2,
                 height = (complex->point[2 * end[0] + 1] + complex->point[2 * end[1] + 1]) / 2;
    double sum = 0;
    for (int k = 0; k < 2; k++) {
        double centre[2];
        if (side[k] < 0) {
            continue;
        }
        gm_complex_centre(complex, (size_t)side[k], centre);
        const double here = at_centre(complex, temperature, (size_t)side[k]),
                     part = ((here + middle) / 2 - flow->reference_temperature) * (centre[1] - height);
        sum += k == 0 ? part : -part;
    }
    return flow->buoyancy * sum;
}

void gm_flow_add_lift(const struct gm_flow *flow, const double *temperature, double scale, double *rate)
{
    const struct gm_complex *complex = flow->complex;
    for (size_t e = 0; e < complex->edges; e++) {
        const double lift = scale * gm_flow_lift(flow, temperature, e);
        rate[complex->edge[2 * e]] += lift;
        rate[complex->edge[2 * e + 1]] -= lift;
    }
    for (size_t b = 0; b < complex->boundary; b++) {
        const int v = complex->boundary_vertex[b], w = complex->boundary_vertex[gm_complex_next(complex, b)];
        const double half =
                         (complex->point[2 * w + 1] - complex->point[2 * v + 1]) / 2 * scale * flow->buoyancy,
                     from = temperature[v] - flow->reference_temperature,
                     to = temperature[w] - flow->reference_temperature;
        if (flow->hole[v] == 0) {
            rate[v] += half * (3 * from + to) / 4;
            rate[w] += half * (from + 3 * to) / 4;
        }
    }
}
