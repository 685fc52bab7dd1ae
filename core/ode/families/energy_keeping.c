/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Energy-keeping methods for y' = f(y) = S grad H(y), S constant and skew:
       average vector field   y1 = y0 + h integral_0^1 f((1 - s) y0 + s y1) ds
       discrete gradient      y1 = y0 + h S G
                              G  = g + (H(y1) - H(y0) - g . d) / |d|^2 d
                              g  = grad H((y0 + y1)/2),   d = y1 - y0
   Both give H(y1) - H(y0) = 0: the first as the integral of grad H . d, the second as G . d. G.R.W. Quispel &
   D.I. McLaren, J. Phys. A 41 (2008) 045206; O. Gonzalez, J. Nonlinear Sci. 6 (1996) 449.

   The integral is a Gauss-Legendre sum of 8 nodes, exact for polynomials of degree 15. Both are solved for d
   to round-off by fixed-point iteration, and if that does not contract by Newton's method with the
   Jacobian of the midpoint rule, from which they differ by O(h^2 d). */
#include "core/ode/families/family.h"

enum { NODES = 8 };

static const struct {
    double node, weight;
} quadrature[NODES] = {
    {0.01985507175123188415822, 0.05061426814518812957627},
    {0.1016667612931866302042, 0.1111905172266872352722},
    {0.2372337950418355070911, 0.156853322938943643669},
    {0.4082826787521750975303, 0.1813418916891809914826},
    {0.5917173212478249024697, 0.1813418916891809914826},
    {0.7627662049581644929089, 0.156853322938943643669},
    {0.8983332387068133697958, 0.1111905172266872352722},
    {0.9801449282487681158418, 0.05061426814518812957627},
};

/* Scratch arrays of n doubles, then the scratch of the solvers. */
enum { D, AT, F, VECTORS };

/* One step, or one substep of a composition. */
struct substep {
    const struct gm_task *task;
    const struct gm_members *members;
    double h;
    struct gm_progress *progress;
};

/* mean := the discrete f between y and y + d. Returns the level of its round-off, times |d| / |f|. */
typedef double mean_field(const struct substep *substep, const double *d, double *mean);

struct method {
    mean_field *mean;
    const struct gm_composition *composition;
};

static double average_field(const struct substep *substep, const double *d, double *mean)
{
    const size_t n = substep->members->n;
    const double *y = substep->members->y;
    double *at = substep->members->scratch + AT * n, *f = substep->members->scratch + F * n;
    memset(mean, 0, n * sizeof *mean);
    for (int k = 0; k < NODES; k++) {
        for (size_t c = 0; c < n; c++) {
            at[c] = y[c] + quadrature[k].node * d[c];
        }
        gm_field(substep->task->problem, at, f, 1);
        for (size_t c = 0; c < n; c++) {
            mean[c] += quadrature[k].weight * f[c];
        }
    }
    substep->progress->evaluations += NODES;
    return 0;
}

/* f at the midpoint is S g, S = w J, and so g = (-f_p, f_q) / w. */
static double gradient_field(const struct substep *substep, const double *d, double *mean)
{
    const struct gm_problem *problem = substep->task->problem;
    const size_t n = problem->n, half = n / 2;
    const double *y = substep->members->y;
    double *at = substep->members->scratch + AT * n, *f = substep->members->scratch + F * n;
    const double weight = gm_weight_of(problem);
    double square = 0, along = 0;
    for (size_t c = 0; c < n; c++) {
        at[c] = y[c] + 0.5 * d[c];
    }
    gm_field(problem, at, mean, 1);
    substep->progress->evaluations++;
    for (size_t c = 0; c < half; c++) {
        along += mean[c] * d[half + c] - mean[half + c] * d[c];
        square += d[c] * d[c] + d[half + c] * d[half + c];
    }
    if (!(square > 0)) {
        return 0;
    }
    for (size_t c = 0; c < n; c++) {
        f[c] = y[c] + d[c];
    }
    const double before = gm_energy(problem, y);
    const double excess = weight * (gm_energy(problem, f) - before - along / weight) / square;
    for (size_t c = 0; c < half; c++) {
        mean[c] += excess * d[half + c];
        mean[half + c] -= excess * d[c];
    }
    return fabs(weight * before) / sqrt(square);
}

/* next := h mean, for gm_sweeps_solve */
static bool sweep(void *data, const double *d, double *next, double *scale)
{
    const struct substep *substep = data;
    const struct gm_members *members = substep->members;
    const struct method *method = substep->task->scheme->coefficients;
    const size_t n = members->n;
    *scale += fabs(substep->h) * method->mean(substep, d, next);
    for (size_t c = 0; c < n; c++) {
        next[c] *= substep->h;
        *scale += fabs(members->y[c]) + fabs(d[c]);
    }
    return true;
}

/* Writes the residual, and the matrix of the midpoint rule. */
static bool linear(void *data, const double *d, double *residual, double *matrix, double *scale)
{
    const struct substep *substep = data;
    const struct gm_members *members = substep->members;
    const size_t n = members->n;
    double *at = members->scratch + AT * n;
    sweep(data, d, residual, scale);
    *scale *= 2;
    for (size_t c = 0; c < n; c++) {
        residual[c] -= d[c];
        at[c] = members->y[c] + 0.5 * d[c];
    }
    if (!gm_jacobian(substep->task->problem, at, matrix)) {
        return false;
    }
    for (size_t i = 0; i < n * n; i++) {
        matrix[i] = (i % (n + 1) == 0 ? 1 : 0) - 0.5 * substep->h * matrix[i];
    }
    return true;
}

static bool solve(struct substep *substep, double *d)
{
    const struct gm_problem *problem = substep->task->problem;
    const struct gm_members *members = substep->members;
    const size_t n = members->n;
    const bool newton = gm_matrix_size(problem) > 0;
    const struct gm_implicit_equations equations = {.size = n,
                                                    .counted = n,
                                                    .data = substep,
                                                    .sweep = sweep,
                                                    .linear = newton ? linear : NULL,
                                                    .y = members->y,
                                                    .n = n,
                                                    .roundoff = 16 * GM_EPSILON};
    double *scratch = members->scratch + VECTORS * n;
    if (!gm_ode_of(problem)->stiff) {
        gm_field(problem, members->y, d, 1);
        substep->progress->evaluations++;
        for (size_t c = 0; c < n; c++) {
            d[c] *= substep->h;
        }
        if (gm_sweeps_solve(&equations, scratch, d, substep->progress)) {
            return true;
        }
    }
    memset(d, 0, n * sizeof *d);
    return newton && gm_newton_solve(&equations, scratch, d, substep->progress);
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct method *method = task->scheme->coefficients;
    double *d = members->scratch + D * members->n;
    for (int i = 0; i < method->composition->steps; i++) {
        struct substep substep = {task, members, task->dt * gm_composition_fraction(method->composition, i),
                                  progress};
        if (!solve(&substep, d)) {
            return GM_NO_CONVERGENCE;
        }
        for (size_t c = 0; c < members->n; c++) {
            members->y[c] += d[c];
        }
    }
    return GM_OK;
}

static size_t room(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    const size_t n = problem->n;
    return VECTORS * n + (gm_matrix_size(problem) > 0 ? gm_newton_scratch(n) : n);
}

static const struct method avf2 = {average_field, &gm_composition_none};
static const struct method avf4 = {average_field, &gm_composition_yoshida4};
static const struct method discrete_gradient2 = {gradient_field, &gm_composition_none};

const struct gm_family gm_family_energy_keeping = {
    .title = "energy-keeping",
    GM_MEMBERS(energy_keeping, .step = step, .room = room),
};
