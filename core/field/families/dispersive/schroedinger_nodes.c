/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Euler box for the nonlinear Schroedinger equation, psi = p + i q, all but the field eliminated, with
   the state p^{n-1} and q^n (d2 is the second difference in x):
       (p^n - p^{n-1})/dt + d2 q^n + k (p^n p^n + q^n q^n) q^n = 0,   a quadratic equation for p^n
       (q^{n+1} - q^n)/dt - d2 p^n - k (p^n p^n + q^n q^n) p^n = 0
   stable for dt < dx^2/2. B. Moore & S. Reich, Numer. Math. 95 (2003) 625. There is no midpoint scheme
   for Schroedinger's equation: its second solution, of alternating sign in time, grows, and a soliton of
   amplitude 1 on 400 points blows up at t = 34 with dt = 0.4 dx^2, where 1 dx^2 is the limit of linear
   theory. */
#include "core/field/families/family.h"
#include "core/field/families/two_step.h"
#include "core/field/multisymplectic.h"
#include "core/field/problems/problems.h"

static double second(const double *u, size_t i, const struct gm_grid1 *grid)
{
    const size_t points = grid->points;
    return (u[(i + 1) % points] - 2 * u[i] + u[(i + points - 1) % points]) / (grid->dx * grid->dx);
}

/* p := p - dt [d2 q + k (p'^2 + q^2) q] with the new p' inside; returns false without a real p'. */
static bool nls_first(const struct gm_problem *problem, double dt, double *p, const double *q)
{
    const struct gm_grid1 *grid = &problem->line;
    const double k = gm_nls_of(problem)->k;
    for (size_t i = 0; i < grid->points; i++) {
        const double free = p[i] - dt * (second(q, i, grid) + k * (q[i] * q[i] * q[i]));
        const double discriminant = 1 + 4 * dt * k * q[i] * free;
        if (discriminant < 0) {
            return false;
        }
        p[i] = 2 * free / (1 + sqrt(discriminant));
    }
    return true;
}

static void nls_second(const struct gm_problem *problem, double dt, const double *p, double *q)
{
    const struct gm_grid1 *grid = &problem->line;
    const double k = gm_nls_of(problem)->k;
    for (size_t i = 0; i < grid->points; i++) {
        q[i] += dt * (second(p, i, grid) + k * (p[i] * p[i] + q[i] * q[i]) * p[i]);
    }
}

static struct gm_progress advance(const struct gm_task *task)
{
    const struct gm_grid1 *grid = &task->problem->line;
    double *p = task->out, *q = p + grid->points;
    struct gm_progress progress = {.status = GM_OK};
    memcpy(p, task->y, 2 * grid->points * sizeof *p);
    for (int64_t k = 0; k < task->steps; k++) {
        progress.iterations++;
        if (!nls_first(task->problem, task->dt, p, q)) {
            progress.status = GM_NO_CONVERGENCE;
            return progress;
        }
        nls_second(task->problem, task->dt, p, q);
        progress.evaluations++;
        if (!gm_field_stepped(task, &progress, p, 2 * grid->points)) {
            return progress;
        }
    }
    return progress;
}

/* The multisymplectic law: what elimination left out follows from v = D_- p and w = D_- q. */

/* A tangent of p^{n-1}, q^n and, a step ahead, of p^n, q^{n+1}. */
struct tangent {
    const struct gm_law *law;
    double *p[2], *q[2];
};

/* A tangent of the solution p^{n-1}, q^n becomes that of p^n, q^{n+1}. */
static void advance_tangent(const struct gm_problem *problem, double dt, const double *p_new, const double *q,
                            double *tangent_p, double *tangent_q)
{
    const struct gm_grid1 *grid = &problem->line;
    const double k = gm_nls_of(problem)->k;
    for (size_t i = 0; i < grid->points; i++) {
        const double p = p_new[i];
        tangent_p[i] = (tangent_p[i] -
                        dt * (second(tangent_q, i, grid) + k * (p * p + 3 * q[i] * q[i]) * tangent_q[i])) /
                       (1 + 2 * dt * k * q[i] * p);
    }
    for (size_t i = 0; i < grid->points; i++) {
        const double p = p_new[i];
        tangent_q[i] += dt * (second(tangent_p, i, grid) + k * (3 * p * p + q[i] * q[i]) * tangent_p[i] +
                              2 * k * q[i] * p * tangent_q[i]);
    }
}

/* Tangent 0 or 1. */
static struct tangent tangent_of(const struct gm_law *law, size_t which)
{
    const size_t points = law->problem->line.points;
    const double waves = 2 + (double)which, phase = 0.3 + 0.4 * (double)which;
    double *at = gm_arena_take(law->arena, 6 * points, sizeof *at), *made = at + 4 * points;
    const struct tangent a = {law, {at, at + points}, {at + 2 * points, at + 3 * points}};
    gm_tangent_start(a.p[0], points, waves, phase);
    gm_tangent_start(a.q[0], points, waves, phase + 1);
    if (law->by_differences) {
        const double *const from[] = {law->y, law->y + points}, *const along[] = {a.p[0], a.q[0]};
        gm_law_differentiate_levels(law, 2, from, along, (double *const[]){a.p[1], a.q[1]});
        return a;
    }
    memcpy(a.p[1], a.p[0], points * sizeof *at);
    memcpy(a.q[1], a.q[0], points * sizeof *at);
    if (!gm_law_step(law, 1, law->y, NULL, made, NULL)) { /* p^n comes first */
        gm_arena_leave(law->arena);
    }
    advance_tangent(law->problem, law->dt, made, law->y + points, a.p[1], a.q[1]);
    return a;
}

static void complete(const void *tangent, size_t node, double *levels)
{
    enum { P, Q, V, W, DIMENSION };
    const struct tangent *a = tangent;
    const size_t points = a->law->problem->line.points, l = (node + points - 1) % points;
    const double dx = a->law->problem->line.dx, *p = a->p[1], *q = a->q[0];
    memset(levels, 0, 3 * DIMENSION * sizeof *levels);
    levels[P] = a->p[0][node];
    levels[DIMENSION + P] = p[node];
    levels[DIMENSION + Q] = q[node];
    levels[DIMENSION + V] = (p[node] - p[l]) / dx;
    levels[DIMENSION + W] = (q[node] - q[l]) / dx;
    levels[2 * DIMENSION + Q] = a->q[1][node];
}

static double form(const struct gm_law *law)
{
    const struct tangent a = tangent_of(law, 0), b = tangent_of(law, 1);
    return gm_nodes_law(law, false, complete, &a, &b);
}

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_euler_box_of_schroedinger, .family = &gm_family_schroedinger_nodes,
     .needs = GM_NEEDS_FORM | GM_NEEDS_NLS},
};

const struct gm_family gm_family_schroedinger_nodes = {
    .title = "Schrödinger equation, multisymplectic",
    GM_FIELD_FAMILY,
    .loop = advance,
    .workspace_open = gm_two_step_open,
    .workspace_close = gm_two_step_close,
    .form = form,
};
