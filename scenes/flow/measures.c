/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Observables that several flows have, and profiles as rows of numbers. */
#include <math.h>

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

double gm_flows_obtuse_share(const struct gm_view *view)
{
    return (double)flow_of(view)->complex->obtuse / (double)flow_of(view)->complex->triangles;
}

double gm_flows_star_least(const struct gm_view *view)
{
    return flow_of(view)->complex->star_least;
}

double gm_flows_mean_edge(const struct gm_view *view)
{
    return flow_of(view)->complex->mean_edge;
}

double gm_flows_psi_error(const struct gm_view *view, double (*psi)(double y))
{
    const struct gm_complex *complex = flow_of(view)->complex;
    double largest = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        largest = fmax(largest, fabs(view->state[v] - psi(complex->point[2 * v + 1])));
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
