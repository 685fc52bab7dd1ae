/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Partitioned Runge-Kutta methods for Hamiltonians that do not separate, (q, p)' = (f_q, f_p):
       Q_i = q0 + h sum_j a_ij f_q(Q_j, P_j),   P_i = p0 + h sum_j c_ij f_p(Q_j, P_j)
       q1  = q0 + h sum_i b_i  f_q(Q_i, P_i),   p1  = p0 + h sum_i d_i  f_p(Q_i, P_i)
   symplectic if b = d and b_i c_ij + b_j a_ji = b_i b_j: the Lobatto IIIA-IIIB pairs, the symplectic Euler
   methods. Solved to round-off by fixed-point iteration, and if that does not contract by Newton's method.
   Hairer, Lubich & Wanner (2006), sections VI.3, VI.4, II.2. */
#include "core/ode/families/family.h"
#include "core/ode/families/runge_kutta/row.h"
#include "core/ode/kernel/stage_solver.h"
#include "core/theory/coefficients.h"

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct gm_partitioned_row *tableau = task->scheme->coefficients;
    const size_t n = members->n;
    double *increment = members->scratch, unused = 0;
    struct gm_stage_solver solver = gm_stage_solver_lay(task->problem, tableau->stages, increment + n);
    struct gm_stages *stages = &solver.stages;
    stages->h = task->dt;
    stages->y = members->y;
    stages->a = tableau->a;
    stages->b = tableau->b;
    stages->c = tableau->c;
    stages->d = tableau->d;
    stages->progress = progress;
    if (!gm_ode_of(task->problem)->stiff && gm_stages_by_sweeps(&solver)) {
        gm_stages_increment(stages, NULL, increment);
    } else if (gm_stages_by_newton(&solver)) {
        gm_stages_sweep(stages, solver.z, solver.scratch, &unused); /* the slopes at the last z */
        gm_stages_increment(stages, solver.z, increment);
    } else {
        return GM_NO_CONVERGENCE;
    }
    for (size_t c = 0; c < n; c++) {
        members->y[c] += increment[c];
    }
    return GM_OK;
}

static size_t room(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const size_t stages = ((const struct gm_partitioned_row *)scheme->coefficients)->stages;
    return problem->n + gm_stage_solver_room(problem, stages);
}

static const struct gm_partitioned_row symplectic_euler = {
    .stages = 1, .a = {{0}}, .c = {{1}}, .b = {1}, .d = {1}};
static const struct gm_partitioned_row symplectic_euler_adjoint = {
    .stages = 1, .a = {{1}}, .c = {{0}}, .b = {1}, .d = {1}};
static const struct gm_partitioned_row lobatto2 = {
    .stages = 2, .a = {{0, 0}, {0.5, 0.5}}, .c = {{0.5, 0}, {0.5, 0}}, .b = {0.5, 0.5}, .d = {0.5, 0.5}};
static const struct gm_partitioned_row lobatto4 = {
    .stages = 3,
    .a = {{0, 0, 0}, {5. / 24, 1. / 3, -1. / 24}, {1. / 6, 2. / 3, 1. / 6}},
    .c = {{1. / 6, -1. / 6, 0}, {1. / 6, 1. / 3, 0}, {1. / 6, 5. / 6, 0}},
    .b = {1. / 6, 2. / 3, 1. / 6},
    .d = {1. / 6, 2. / 3, 1. / 6},
};

static void coefficients_open(struct gm_arena *arena, const struct gm_scheme *scheme,
                              struct gm_coefficients *coefficients)
{
    const struct gm_partitioned_row *tableau = scheme->coefficients;
    gm_coefficients_open(arena, coefficients, GM_EQUATIONS_PARTITIONED, (int)tableau->stages);
    gm_coefficients_write(coefficients, GM_SIDE_Q, tableau->a[0], GM_TABLEAU_STAGES, tableau->b);
    gm_coefficients_write(coefficients, GM_SIDE_P, tableau->c[0], GM_TABLEAU_STAGES, tableau->d);
}

const struct gm_family gm_family_partitioned = {
    .title = "partitioned Runge-Kutta",
    GM_MEMBERS(partitioned, .step = step, .room = room),
    .coefficients_open = coefficients_open,
};
