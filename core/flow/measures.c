/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functionals of a flow's state. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/flow/flow.h"
#include "core/functions/functions.h"

double gm_flow_kinetic_energy(const struct gm_flow *flow, const double *y)
{
    const struct gm_complex *complex = flow->complex;
    double sum = 0;
    for (size_t e = 0; e < complex->edges; e++) {
        const double difference = y[complex->edge[2 * e + 1]] - y[complex->edge[2 * e]];
        sum += complex->star1[e] * difference * difference;
    }
    return sum / 2;
}

static double total(const struct gm_flow *flow, const double *values)
{
    double sum = 0;
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        sum += flow->complex->star0[v] * values[v];
    }
    return sum;
}

double gm_flow_enstrophy(const struct gm_flow *flow, const double *y)
{
    const double *omega = gm_flow_block(flow, y, GM_FLOW_OMEGA);
    double sum = 0;
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        sum += flow->complex->star0[v] * omega[v] * omega[v];
    }
    return sum / 2;
}

double gm_flow_circulation_error(const struct gm_flow *flow, const double *y)
{
    const double *omega = gm_flow_block(flow, y, GM_FLOW_OMEGA);
    double sizes = 0;
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        sizes += flow->complex->star0[v] * fabs(omega[v]);
    }
    return sizes > 0 ? fabs(total(flow, omega)) / sizes : 0;
}

double gm_flow_divergence(const struct gm_flow *flow, const double *y)
{
    const struct gm_complex *complex = flow->complex;
    double largest = 0;
    for (size_t t = 0; t < complex->triangles; t++) {
        double sum = 0;
        for (size_t k = 3 * t; k < 3 * t + 3; k++) {
            const int *edge = complex->edge + 2 * complex->triangle_edge[k];
            sum += complex->triangle_sign[k] * (y[edge[1]] - y[edge[0]]);
        }
        largest = fmax(largest, fabs(sum));
    }
    return largest;
}

double gm_flow_scalar_total(const struct gm_flow *flow, const double *y)
{
    return total(flow, gm_flow_block(flow, y, GM_FLOW_THETA));
}

/* Row v of -d0' diag(F) A theta + kappa K theta, and q = d0' F there; `theta`: the scalar or temperature. */
static double transport_row(const struct gm_flow *flow, const double *y, const double *theta, size_t v,
                            double *out)
{
    const struct gm_complex *complex = flow->complex;
    const double *psi = gm_flow_block(flow, y, GM_FLOW_PSI_HALF);
    double sum = 0;
    *out = 0;
    for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
        const size_t e = (size_t)complex->ring_edge[k];
        const int w = complex->ring_vertex[k];
        const double flux = gm_flow_flux(complex, psi, e) * (complex->edge[2 * e] == (int)v ? 1 : -1);
        sum +=
            flux * (theta[v] + theta[w]) / 2 + flow->diffusivity * complex->star1[e] * (theta[v] - theta[w]);
        *out -= flux;
    }
    return sum;
}

struct gm_budget gm_flow_budget(const struct gm_flow *flow, const double *y)
{
    const struct gm_complex *complex = flow->complex;
    const double *theta = gm_flow_block(flow, y, GM_FLOW_THETA);
    const double *before = gm_flow_block(flow, y, GM_FLOW_THETA_BEFORE);
    const double dt = gm_flow_step(flow, y);
    struct gm_budget budget = {0};
    for (size_t v = 0; dt != 0 && v < complex->vertices; v++) {
        budget.rate += complex->star0[v] * (theta[v] - before[v]) / dt;
    }
    for (size_t v = 0; flow->source && v < complex->vertices; v++) {
        budget.sourced += flow->theta_fixed[v] ? 0 : flow->source[v];
    }
    for (size_t b = 0; b < complex->boundary; b++) {
        const size_t v = (size_t)complex->boundary_vertex[b];
        double out = 0;
        const double row = transport_row(flow, y, theta, v, &out);
        if (flow->theta_fixed[v]) {
            budget.convected -= out * theta[v];
            budget.reaction += row + out * theta[v];
            budget.reaction += dt != 0 ? complex->star0[v] * (theta[v] - before[v]) / dt : 0;
        } else {
            budget.outflow += out * theta[v];
        }
    }
    const double largest = fmax(fmax(fabs(budget.rate), fabs(budget.convected)),
                                fmax(fabs(budget.reaction), fabs(budget.outflow)));
    const double defect = budget.rate - budget.convected - budget.reaction + budget.outflow - budget.sourced;
    budget.defect = largest > 0 ? fabs(defect) / largest : 0;
    return budget;
}

double gm_flow_heat(const struct gm_flow *flow, const double *y, size_t side)
{
    const struct gm_complex *complex = flow->complex;
    const double dt = gm_flow_step(flow, y);
    double sum = 0;
    for (size_t b = 0; flow->heat && b < complex->boundary; b++) {
        const size_t v = (size_t)complex->boundary_vertex[b];
        if (flow->temperature_holder[v] == side + 1) {
            const double *temperature = gm_flow_block(flow, y, GM_FLOW_TEMPERATURE),
                         *before = gm_flow_block(flow, y, GM_FLOW_TEMPERATURE_BEFORE);
            double out = 0;
            sum += transport_row(flow, y, temperature, v, &out);
            sum += out * temperature[v];
            sum += dt != 0 ? complex->star0[v] * (temperature[v] - before[v]) / dt : 0;
        }
    }
    return sum;
}

double gm_flow_heated(const struct gm_flow *flow)
{
    double most = 0, sum = 0, through = 0;
    const struct gm_complex *complex = flow->complex;
    for (size_t b = 0; flow->heat && b < complex->boundary; b++) {
        const int v = complex->boundary_vertex[b];
        const double beside = complex->length[complex->boundary_edge[b]] +
                              complex->length[complex->boundary_edge[gm_complex_previous(complex, b)]];
        most = fmax(most, fabs(flow->heating[v]) / (beside / 2));
        sum += fabs(flow->heating[v]);
    }
    for (size_t i = 0; i < flow->openings; i++) {
        through += flow->opening[i].inlet ? flow->opening[i].flow : 0;
    }
    const double size = sqrt(complex->total_area), conducted = most * size / flow->diffusivity,
                 rayleigh = flow->buoyancy * most * gm_pow(size, 4) /
                            (flow->viscosity * flow->diffusivity * flow->diffusivity),
                 convected = conducted / fmax(1, 0.4 * gm_pow(fabs(rayleigh), 0.2));
    return through > 0 ? fmin(convected, 2 * sum / through) : convected;
}

double gm_flow_temperature_mean(const struct gm_flow *flow, const double *y)
{
    return flow->heat ? total(flow, gm_flow_block(flow, y, GM_FLOW_TEMPERATURE)) / flow->complex->total_area
                      : 0;
}

/* P(left) - P(right) over an inner edge: the mean of omega on the flux, viscosity, what accelerates U, and buoyancy. */
static double pressure_step(const struct gm_flow *flow, const double *y, size_t e)
{
    const struct gm_complex *complex = flow->complex;
    const double *omega = gm_flow_block(flow, y, GM_FLOW_OMEGA_USED);
    const double *before = gm_flow_block(flow, y, GM_FLOW_PSI_BEFORE);
    const int a = complex->edge[2 * e], b = complex->edge[2 * e + 1];
    const double dt = gm_flow_step(flow, y);
    const double flux = gm_flow_flux(complex, gm_flow_block(flow, y, GM_FLOW_PSI_HALF), e);
    double step = -flux * (omega[a] + omega[b]) / 2;
    if (complex->star == GM_STAR_CIRCUMCENTRIC) {
        const double rate = dt != 0 ? (y[b] - before[b] - (y[a] - before[a])) / dt : 0;
        step += complex->star1[e] * (flow->viscosity * (omega[b] - omega[a]) + rate);
    } else {
        const double moved = gm_flow_star(complex, y, e) - gm_flow_star(complex, before, e);
        step += flow->viscosity * gm_flow_star(complex, omega, e);
        step += dt != 0 ? moved / dt : 0;
    }
    return flow->heat ? step + gm_flow_lift(flow, gm_flow_block(flow, y, GM_FLOW_TEMPERATURE), e) : step;
}

bool gm_flow_pressure(const struct gm_flow *flow, const double *y, double *pressure)
{
    const struct gm_complex *complex = flow->complex;
    int *queue = complex->boundary > 0 ? calloc(2 * complex->triangles, sizeof *queue) : NULL;
    if (!queue) {
        return false;
    }
    int *met = queue + complex->triangles; /* flags */
    size_t count = 1;                      /* the first triangle is in the queue */
    double mean = 0;
    met[0] = true;
    pressure[0] = 0;
    for (size_t i = 0; i < count; i++) {
        const int t = queue[i];
        mean += complex->area[t] * pressure[t] / complex->total_area;
        for (int k = 0; k < 3; k++) {
            const size_t e = (size_t)complex->triangle_edge[3 * t + k];
            const bool left = complex->edge_triangle[2 * e] == t;
            const int next = complex->edge_triangle[2 * e + (left ? 1 : 0)];
            if (next >= 0 && !met[next]) {
                met[next] = true;
                pressure[next] = pressure[t] + (left ? -1 : 1) * pressure_step(flow, y, e);
                queue[count++] = next;
            }
        }
    }
    for (size_t i = 0; i < count; i++) {
        pressure[i] -= mean;
    }
    free(queue);
    return true;
}

double gm_flow_circulation(const struct gm_flow *flow, const double *y, size_t hole)
{
    double sum = 0;
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        sum += flow->hole[v] == (int)hole ? gm_flow_row(flow->complex, y, v) : 0;
    }
    return sum;
}

/* The pressure at a wall's next edge minus that at this one, summed over the triangles around their common vertex. */
static double pressure_around(const struct gm_flow *flow, const double *y, size_t edge, int vertex)
{
    const struct gm_complex *complex = flow->complex;
    const int *beside = complex->edge_triangle + 2 * edge;
    double change = 0;
    for (int t = beside[0] >= 0 ? beside[0] : beside[1]; t >= 0;) {
        int k = 0;
        while (complex->triangle[3 * t + k] != vertex) {
            k++;
        }
        const size_t next =
            (size_t)complex->triangle_edge[3 * t + k]; /* on from the vertex, counter-clockwise */
        const bool left = complex->edge_triangle[2 * next] == t;
        t = complex->edge_triangle[2 * next + (left ? 1 : 0)];
        change += t < 0 ? 0 : (left ? -1 : 1) * pressure_step(flow, y, next);
    }
    return change;
}

void gm_flow_force(const struct gm_flow *flow, const double *y, size_t hole, double force[2])
{
    const struct gm_complex *complex = flow->complex;
    const double *omega = gm_flow_block(flow, y, GM_FLOW_OMEGA_USED);
    size_t first = 0;
    force[0] = force[1] = 0;
    while (first < complex->boundary && flow->hole[complex->boundary_vertex[first]] != (int)hole) {
        first++;
    }
    if (first == complex->boundary) {
        return;
    }
    double pressure = 0; /* at the first edge: around the hole a constant has no force */
    size_t b = first;
    do {
        const size_t next = gm_complex_next(complex, b), e = (size_t)complex->boundary_edge[b];
        const int v = complex->boundary_vertex[b], w = complex->boundary_vertex[next];
        const bool left = complex->edge_triangle[2 * e] >= 0;
        const double here = pressure + (left ? -1 : 1) * pressure_step(flow, y, e);
        const double friction = -flow->viscosity * (omega[v] + omega[w]) / 2;
        const double x = complex->point[2 * w] - complex->point[2 * v],
                     z = complex->point[2 * w + 1] - complex->point[2 * v + 1];
        force[0] += here * z + friction * x;
        force[1] += -here * x + friction * z;
        pressure += pressure_around(flow, y, e, w);
        b = next;
    } while (b != first);
}

enum { NEAREST = 24, TERMS = 10, VALUES = 4 };

struct near {
    double distance, x, z;
    size_t index;
};

/* Values at points of a mesh, up to VALUES of them at each. */
struct samples {
    const struct gm_complex *complex;
    const double *points;
    size_t count;
    const double *fields[VALUES]; /* NULL: 0 */
};

/* The points nearest to a place, with relative coordinates; on a torus their nearest images. */
static size_t find_nearest(const struct samples *samples, const double place[2], struct near nearest[NEAREST])
{
    const struct gm_complex *complex = samples->complex;
    size_t count = 0;
    for (size_t v = 0; v < samples->count; v++) {
        double d[2] = {samples->points[2 * v] - place[0], samples->points[2 * v + 1] - place[1]};
        for (int c = 0; c < 2; c++) {
            const double period = complex->period[c];
            d[c] -= period > 0 ? period * round(d[c] / period) : 0;
        }
        const double distance = d[0] * d[0] + d[1] * d[1];
        if (count == NEAREST && distance >= nearest[count - 1].distance) {
            continue;
        }
        size_t at = count < NEAREST ? count++ : NEAREST - 1;
        for (; at > 0 && nearest[at - 1].distance > distance; at--) {
            nearest[at] = nearest[at - 1];
        }
        nearest[at] = (struct near){distance, d[0], d[1], v};
    }
    return count;
}

/* Least squares by Householder's reflections: rows of TERMS coefficients and VALUES right sides. */
static void least_squares(double a[NEAREST][TERMS + VALUES], size_t rows, double solution[VALUES][TERMS])
{
    for (size_t k = 0; k < TERMS; k++) {
        double norm = 0, w[NEAREST] = {0};
        for (size_t i = k; i < rows; i++) {
            norm += a[i][k] * a[i][k];
        }
        norm = copysign(sqrt(norm), a[k][k]);
        double length = 0;
        for (size_t i = k; i < rows; i++) {
            w[i] = a[i][k] + (i == k ? norm : 0);
            length += w[i] * w[i];
        }
        for (size_t c = k; length > 0 && c < TERMS + VALUES; c++) {
            double sum = 0;
            for (size_t i = k; i < rows; i++) {
                sum += w[i] * a[i][c];
            }
            for (size_t i = k; i < rows; i++) {
                a[i][c] -= 2 * sum / length * w[i];
            }
        }
    }
    for (size_t s = 0; s < VALUES; s++) {
        for (size_t i = TERMS; i-- > 0;) {
            double sum = a[i][TERMS + s];
            for (size_t k = i + 1; k < TERMS; k++) {
                sum -= a[i][k] * solution[s][k];
            }
            solution[s][i] = a[i][i] != 0 ? sum / a[i][i] : 0;
        }
    }
}

/* Cubic polynomials fitted to values at the points nearest to a place. The first coefficients are the
   values there, and the derivatives times `scale`. Returns false with too few points. */
static bool fit(const struct samples *samples, const double at[2], double solution[VALUES][TERMS],
                double *scale)
{
    struct near nearest[NEAREST];
    const size_t rows = find_nearest(samples, at, nearest);
    if (rows < TERMS) {
        return false;
    }
    const double farthest = *scale = sqrt(nearest[rows - 1].distance);
    double a[NEAREST][TERMS + VALUES];
    for (size_t i = 0; i < rows; i++) {
        const struct near *near = &nearest[i];
        const double p = near->x / farthest, q = near->z / farthest;
        const double weight = gm_exp(-(p * p + q * q)); /* the square root, for the rows */
        const double terms[TERMS] = {1,     p,         q,         p * p,     p * q,
                                     q * q, p * p * p, p * p * q, p * q * q, q * q * q};
        for (size_t k = 0; k < TERMS; k++) {
            a[i][k] = weight * terms[k];
        }
        for (size_t s = 0; s < VALUES; s++) {
            a[i][TERMS + s] = samples->fields[s] ? weight * samples->fields[s][near->index] : 0;
        }
    }
    least_squares(a, rows, solution);
    return true;
}

bool gm_flow_sample(const struct gm_flow *flow, const double *y, double x, double z, struct gm_sample *sample)
{
    const struct gm_complex *complex = flow->complex;
    const struct samples samples = {complex,
                                    complex->point,
                                    complex->vertices,
                                    {y, gm_flow_block(flow, y, GM_FLOW_THETA),
                                     gm_flow_block(flow, y, GM_FLOW_OMEGA),
                                     flow->heat ? gm_flow_block(flow, y, GM_FLOW_TEMPERATURE) : NULL}};
    double solution[VALUES][TERMS], scale;
    if (!fit(&samples, (const double[]){x, z}, solution, &scale)) {
        return false;
    }
    *sample = (struct gm_sample){.psi = solution[0][0],
                                 .u = solution[0][2] / scale,
                                 .v = -solution[0][1] / scale,
                                 .theta = solution[1][0],
                                 .omega = solution[2][0],
                                 .temperature = solution[3][0]};
    return true;
}

bool gm_flow_pressure_at(const struct gm_flow *flow, const double *y, double x, double z, double *pressure)
{
    const struct gm_complex *complex = flow->complex;
    double *total = malloc(3 * complex->triangles * sizeof *total), solution[VALUES][TERMS], scale;
    struct gm_sample sample;
    if (!total || !gm_flow_pressure(flow, y, total) || !gm_flow_sample(flow, y, x, z, &sample)) {
        free(total);
        return false;
    }
    double *centres = total + complex->triangles;
    for (size_t t = 0; t < complex->triangles; t++) {
        gm_complex_centre(complex, t, centres + 2 * t);
    }
    const struct samples samples = {complex, centres, complex->triangles, {total}};
    const bool fits = fit(&samples, (const double[]){x, z}, solution, &scale);
    *pressure = fits ? solution[0][0] - (sample.u * sample.u + sample.v * sample.v) / 2 : NAN;
    free(total);
    return fits;
}
