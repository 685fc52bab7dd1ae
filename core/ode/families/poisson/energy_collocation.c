/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Collocation that conserves the energy of y' = B(y) grad H(y), B skew. sigma is the polynomial of degree s,
       sigma(0) = y_0,   sigma'(c_i) = h B(sigma(c_i)) int_0^1 l_i(t)/b_i grad H(sigma(t)) dt,   y_1 = sigma(1),
   c_i Gauss' nodes, l_i Lagrange's polynomials on them, b_i = int l_i. Then H(y_1) - H(y_0) is a sum of
   g' B g = 0. Integrals are taken by Gauss' rule of five nodes, exact where H is a polynomial of degree 10 (s = 1)
   or 5 (s = 2). It conserves quadratic Casimirs as well. D. Cohen & E. Hairer, BIT 51 (2011) 91. */
#include "core/ode/families/family.h"

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

/* A step; means of gradients are in the scratch, and a place, a gradient, a bracket. */
struct work {
    const struct gm_task *task;
    const struct gm_members *members;
    struct gm_progress *progress;
};

/* Computes new slopes; all brackets belong to one polynomial, so slopes change together. */
static bool sweep(void *data, const double *slopes, double *next, double *scale)
{
    const struct work *work = data;
    const struct gm_members *members = work->members;
    const struct gm_problem *problem = work->task->problem;
    const struct row *row = work->task->scheme->coefficients;
    const struct gm_poisson *poisson = gm_ode_of(problem)->poisson;
    const size_t n = problem->n, size = (size_t)row->stages * n;
    double *means = members->scratch, *there = means + MOST * n, *gradient = there + n,
           *matrix = gradient + n;
    memset(means, 0, size * sizeof *means);
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
    for (int i = 0; i < row->stages; i++) {
        place(row, members->y, slopes, row->c[i], n, there);
        poisson->bracket(problem, there, matrix);
        for (size_t c = 0; c < n; c++) {
            double sum = 0;
            for (size_t j = 0; j < n; j++) {
                sum += matrix[c * n + j] * means[(size_t)i * n + j];
            }
            next[(size_t)i * n + c] = work->task->dt * sum;
        }
    }
    work->progress->evaluations += NODES;
    *scale += gm_sum_of(next, size) + gm_sum_of(members->y, n);
    return true;
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct row *row = task->scheme->coefficients;
    const size_t n = members->n;
    double *slopes = members->scratch + (MOST + 2) * n + n * n, *next = slopes + MOST * n;
    struct work work = {task, members, progress};
    const struct gm_implicit_equations equations = {
        .size = (size_t)row->stages * n, .data = &work, .sweep = sweep, .roundoff = 1e-15};
    memset(slopes, 0, MOST * n * sizeof *slopes);
    if (!gm_sweeps_solve(&equations, next, slopes, progress)) {
        return GM_NO_CONVERGENCE;
    }
    place(row, members->y, slopes, 1, n, next);
    memcpy(members->y, next, n * sizeof *next);
    return GM_OK;
}

const struct gm_family gm_family_energy_collocation = {
    .title = "energy-preserving collocation",
    GM_MEMBERS(energy_collocation, .step = step, .vectors = 3 * MOST + 2, .squares = 1),
};
