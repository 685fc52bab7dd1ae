/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Collocation that keeps the energy of y' = B(y) grad H(y), B skew: sigma is the polynomial of degree s with
       sigma(0) = y_0,   sigma'(c_i) = h B(sigma(c_i)) int_0^1 l_i(t)/b_i grad H(sigma(t)) dt,   y_1 = sigma(1),
   c_i Gauss' nodes, l_i Lagrange's polynomials on them, b_i = int l_i. Then H(y_1) - H(y_0) is a sum of
   g' B g = 0. Integrals are taken by Gauss' rule of five nodes, exact where H is a polynomial of degree 10 (s = 1)
   or 5 (s = 2). Casimirs that are quadratic are kept as well. D. Cohen & E. Hairer, BIT 51 (2011) 91. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/ode/families/families.h"
#include "core/ode/kernel/members.h"

enum { MOST = 2, NODES = 5 };
#define ROOT 0.28867513459481288225 /* sqrt(3)/6 */

struct row {
    int stages;
    double c[MOST], b[MOST];
};
static const struct row one = {1, {0.5}, {1}}, two = {2, {0.5 - ROOT, 0.5 + ROOT}, {0.5, 0.5}};

static const double nodes[NODES] = {0.5 - 0.45308992296933199640, 0.5 - 0.26923465505284154552, 0.5,
                                    0.5 + 0.26923465505284154552, 0.5 + 0.45308992296933199640};
static const double weights[NODES] = {0.11846344252809454376, 0.23931433524968323402, 0.28444444444444444444,
                                      0.23931433524968323402, 0.11846344252809454376};

/* l_i(t), and its integral from 0 to t */
static double lagrange(const struct row *row, int i, double t)
{
    return row->stages == 1 ? 1 : (t - row->c[1 - i]) / (row->c[i] - row->c[1 - i]);
}

static double integral(const struct row *row, int i, double t)
{
    return row->stages == 1 ? t : t * (t / 2 - row->c[1 - i]) / (row->c[i] - row->c[1 - i]);
}

/* sigma(t), of slopes h sigma'(c_i) */
static void place(const struct row *row, const double *y, const double *slopes, double t, size_t n,
                  double *there)
{
    memcpy(there, y, n * sizeof *there);
    for (int i = 0; i < row->stages; i++) {
        const double part = integral(row, i, t);
        for (size_t c = 0; c < n; c++) {
            there[c] += part * slopes[(size_t)i * n + c];
        }
    }
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    enum { ITERATIONS = 100 };
    const struct row *row = task->scheme->coefficients;
    const struct gm_problem *problem = task->problem;
    const struct gm_poisson *poisson = gm_ode_of(problem)->poisson;
    const size_t n = problem->n;
    double *slopes = members->scratch, *means = slopes + MOST * n, *there = means + MOST * n,
           *gradient = there + n, *matrix = gradient + n, previous = INFINITY;
    memset(slopes, 0, MOST * n * sizeof *slopes);
    for (int iteration = 0; iteration < ITERATIONS; iteration++) {
        double change = 0, size = 0;
        memset(means, 0, MOST * n * sizeof *means);
        for (int k = 0; k < NODES; k++) {
            place(row, members->y, slopes, nodes[k], n, there);
            poisson->gradient(problem, there, gradient);
            for (int i = 0; i < row->stages; i++) {
                const double weight = weights[k] * lagrange(row, i, nodes[k]) / row->b[i];
                for (size_t c = 0; c < n; c++) {
                    means[(size_t)i * n + c] += weight * gradient[c];
                }
            }
        }
        /* the brackets are those of one polynomial: slopes change when all are known */
        double *next = means;
        for (int i = 0; i < row->stages; i++) {
            place(row, members->y, slopes, row->c[i], n, there);
            poisson->bracket(problem, there, matrix);
            for (size_t c = 0; c < n; c++) {
                gradient[c] = 0;
                for (size_t j = 0; j < n; j++) {
                    gradient[c] += matrix[c * n + j] * means[(size_t)i * n + j];
                }
            }
            memcpy(next + (size_t)i * n, gradient, n * sizeof *next);
        }
        for (size_t c = 0; c < (size_t)row->stages * n; c++) {
            const double slope = task->dt * next[c];
            change += fabs(slope - slopes[c]);
            size += fabs(slope);
            slopes[c] = slope;
        }
        progress->evaluations += NODES;
        progress->iterations++;
        for (size_t c = 0; c < n; c++) {
            size += fabs(members->y[c]);
        }
        progress->unsolved = gm_unsolved_by(change, size);
        if (!isfinite(change)) {
            return GM_NO_CONVERGENCE;
        }
        if (gm_is_settled(change, 1e-15 * size, &previous)) {
            place(row, members->y, slopes, 1, n, there);
            memcpy(members->y, there, n * sizeof *there);
            return GM_OK;
        }
    }
    return GM_NO_CONVERGENCE;
}

static struct gm_progress loop(const struct gm_task *task)
{
    return gm_members_advance(task, step);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const size_t n = problem->n;
    (void)scheme;
    return gm_members_open(problem, 0, (2 * MOST + 2) * n + n * n);
}

#define COLLOCATION(row, degree)                                                                             \
    .family = &gm_family_energy_collocation, .coefficients = &(row),                                         \
    .formula = "σ′(cᵢ) = h B(σ(cᵢ)) ∫ lᵢ(t)/bᵢ ∇H(σ(t)) dt,  σ of degree " degree ",  y₁ = σ(1)",            \
    .reference = "D. Cohen & E. Hairer, BIT 51 (2011) 91", .needs = GM_NEEDS_POISSON,                        \
    .claims = GM_SYMMETRIC | GM_KEEPS_ENERGY

static const struct gm_scheme schemes[] = {
    {
        .name = "energy-collocation2",
        .title = "energy collocation 2",
        COLLOCATION(one, "1"),
        .order = 2,
    },
    {
        .name = "energy-collocation4",
        .title = "energy collocation 4",
        COLLOCATION(two, "2"),
        .order = 4,
    },
};

const struct gm_family gm_family_energy_collocation = {
    .kind = &gm_kind_ode,
    .title = "energy-preserving collocation",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .loop = loop,
    .workspace_open = workspace_open,
    .workspace_close = free,
};
