/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Observables of flows, and errors where the exact flow is known. */
#include <math.h>
#include <stdlib.h>

#include "scenes/flow/flows.h"

static const struct gm_flow *flow_of(const struct gm_view *view)
{
    return gm_flow_of(view->problem);
}

double gm_flows_kinetic_energy(const struct gm_view *view)
{
    return gm_flow_kinetic_energy(flow_of(view), view->state);
}

double gm_flows_speed_max(const struct gm_view *view)
{
    return gm_flow_largest_speed(flow_of(view), view->state);
}

double gm_flows_enstrophy(const struct gm_view *view)
{
    return gm_flow_enstrophy(flow_of(view), view->state);
}

double gm_flows_divergence(const struct gm_view *view)
{
    return gm_flow_divergence(flow_of(view), view->state);
}

double gm_flows_circulation_error(const struct gm_view *view)
{
    return gm_flow_circulation_error(flow_of(view), view->state);
}

double gm_flows_scalar_total(const struct gm_view *view)
{
    return gm_flow_scalar_total(flow_of(view), view->state);
}

double gm_flows_scalar_outflow(const struct gm_view *view)
{
    return gm_flow_budget(flow_of(view), view->state).outflow;
}

double gm_flows_budget_defect(const struct gm_view *view)
{
    return view->t == view->t0 ? 0 : gm_flow_budget(flow_of(view), view->state).defect;
}

double gm_flows_psi_low(const struct gm_view *view)
{
    double low = INFINITY;
    for (size_t v = 0; v < flow_of(view)->complex->vertices; v++) {
        low = fmin(low, view->state[v]);
    }
    return low;
}

double gm_flows_change(const struct gm_view *view)
{
    const double *before = gm_flow_block(flow_of(view), view->state, GM_FLOW_PSI_BEFORE);
    double change = 0, size = 0;
    for (size_t v = 0; v < flow_of(view)->complex->vertices; v++) {
        change = fmax(change, fabs(view->state[v] - before[v]));
        size = fmax(size, fabs(view->state[v]));
    }
    return size > 0 ? change / size : 0;
}

double gm_flows_triangles(const struct gm_view *view)
{
    return (double)flow_of(view)->complex->triangles;
}

double gm_flows_mean_edge(const struct gm_view *view)
{
    return flow_of(view)->complex->mean_edge;
}

/* |values - exact| / |exact| in the norm sum star0 w^2 */
static double vertex_error(const struct gm_view *view, enum gm_flow_block block, double (*exact)(double))
{
    const struct gm_complex *complex = flow_of(view)->complex;
    const double *values = gm_flow_block(flow_of(view), view->state, block);
    double error = 0, size = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        const double z = complex->point[2 * v + 1], truth = exact ? exact(z) : z, away = values[v] - truth;
        error += complex->star0[v] * away * away;
        size += complex->star0[v] * truth * truth;
    }
    return sqrt(error / size);
}

double gm_shear_psi_error(const struct gm_shear *shear, const struct gm_view *view)
{
    return vertex_error(view, GM_FLOW_PSI, shear->psi);
}

double gm_shear_theta_error(const struct gm_shear *shear, const struct gm_view *view)
{
    return vertex_error(view, GM_FLOW_THETA, shear->theta);
}

/* An end of a dual edge: a circumcentre, or on the boundary the edge's middle. */
static void dual_end(const struct gm_complex *complex, size_t e, int side, double p[2])
{
    const int t = complex->edge_triangle[2 * e + (size_t)side];
    if (t >= 0) {
        gm_complex_circumcentre(complex, (size_t)t, p);
        return;
    }
    for (int c = 0; c < 2; c++) {
        p[c] = (complex->point[2 * complex->edge[2 * e] + c] +
                complex->point[2 * complex->edge[2 * e + 1] + c]) /
               2;
    }
}

double gm_shear_flux_error(const struct gm_shear *shear, const struct gm_view *view)
{
    const struct gm_complex *complex = flow_of(view)->complex;
    double error = 0, size = 0;
    for (size_t e = 0; e < complex->edges; e++) {
        double from[2], to[2];
        dual_end(complex, e, 1, from);
        dual_end(complex, e, 0, to);
        /* Simpson's rule is exact for a parabola */
        const double exact =
            (to[0] - from[0]) *
            (shear->velocity(from[1]) + 4 * shear->velocity((from[1] + to[1]) / 2) + shear->velocity(to[1])) /
            6;
        const double circulation =
            -complex->star1[e] * (view->state[complex->edge[2 * e + 1]] - view->state[complex->edge[2 * e]]);
        error += complex->length[e] * (circulation - exact) * (circulation - exact);
        size += complex->length[e] * exact * exact;
    }
    return sqrt(error / size);
}

double gm_shear_velocity_error(const struct gm_shear *shear, const struct gm_view *view)
{
    const struct gm_complex *complex = flow_of(view)->complex;
    double error = 0, size = 0;
    for (size_t t = 0; t < complex->triangles; t++) {
        double u[2], p[6];
        gm_flow_velocity(complex, view->state, t, u);
        gm_complex_corners(complex, t, p);
        const double exact = shear->velocity((p[1] + p[3] + p[5]) / 3);
        error += complex->area[t] * ((u[0] - exact) * (u[0] - exact) + u[1] * u[1]);
        size += complex->area[t] * exact * exact;
    }
    return sqrt(error / size);
}

/* The error of the total pressure over the triangles whose circumcentre is further than `margin` from the
   boundary of the unit square; both pressures with mean 0 there. */
static double pressure_error_within(const struct gm_shear *shear, const struct gm_view *view, double margin)
{
    const struct gm_complex *complex = flow_of(view)->complex;
    double *pressure = malloc(3 * complex->triangles * sizeof *pressure);
    if (!pressure || !gm_flow_pressure(flow_of(view), view->state, pressure)) {
        free(pressure);
        return NAN;
    }
    double *exact = pressure + complex->triangles, *area = exact + complex->triangles;
    double mean = 0, exact_mean = 0, total = 0, error = 0, size = 0;
    for (size_t t = 0; t < complex->triangles; t++) {
        double centre[2];
        gm_complex_circumcentre(complex, t, centre);
        const double to_wall = fmin(fmin(centre[0], 1 - centre[0]), fmin(centre[1], 1 - centre[1]));
        exact[t] = shear->pressure(centre[0], centre[1], flow_of(view)->viscosity);
        area[t] = to_wall >= margin ? complex->area[t] : 0;
        mean += area[t] * pressure[t];
        exact_mean += area[t] * exact[t];
        total += area[t];
    }
    for (size_t t = 0; t < complex->triangles; t++) {
        const double truth = exact[t] - exact_mean / total, away = pressure[t] - mean / total - truth;
        error += area[t] * away * away;
        size += area[t] * truth * truth;
    }
    free(pressure);
    return sqrt(error / size);
}

double gm_shear_pressure_error(const struct gm_shear *shear, const struct gm_view *view)
{
    return pressure_error_within(shear, view, -INFINITY);
}

double gm_shear_pressure_error_middle(const struct gm_shear *shear, const struct gm_view *view)
{
    return pressure_error_within(shear, view, 0.2);
}

double gm_shear_solution_error(const struct gm_shear *shear, const struct gm_view *view)
{
    const struct gm_complex *complex = flow_of(view)->complex;
    double largest = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        largest = fmax(largest, fabs(view->state[v] - shear->psi(complex->point[2 * v + 1])));
    }
    return largest;
}

void gm_flows_write_sample(const struct gm_view *view, const char *front, const char *name, double x,
                           double z, double reference, FILE *stream)
{
    struct gm_sample s;
    if (!gm_flow_sample(flow_of(view), view->state, x, z, &s)) {
        return;
    }
    fprintf(stream, "%s,%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,", front, name, x, z, s.psi, s.u, s.v,
            s.theta, s.omega);
    if (!isnan(reference)) {
        fprintf(stream, "%.17g", reference);
    }
    fputc('\n', stream);
}

void gm_flows_write_profile(const struct gm_view *view, const char *front, const struct gm_profile *profile,
                            FILE *stream)
{
    for (size_t i = 0; i < profile->count; i++) {
        const double s = (double)i / (double)(profile->count - 1);
        gm_flows_write_sample(view, front, profile->name, profile->a[0] + s * (profile->b[0] - profile->a[0]),
                              profile->a[1] + s * (profile->b[1] - profile->a[1]),
                              profile->reference ? profile->reference(view, s) : NAN, stream);
    }
}
