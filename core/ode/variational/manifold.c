/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Accelerations, velocities and multipliers under constraints, and the way back onto their manifold. E.
   Hairer, C. Lubich & G. Wanner (2006), sections VII.1.2 and IV.4; E. Hairer & G. Wanner, Solving Ordinary
   Differential Equations II (1996), section VII.1. */
#include "core/ode/variational/manifold.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/kernel/members.h"

size_t gm_manifold_scratch_size(const struct gm_problem *problem)
{
    const size_t half = problem->n / 2, constraints = gm_action_constraints(problem),
                 all = half + constraints;
    return gm_action_room(problem) + problem->n + 2 * constraints + constraints * half + half * half + all +
           gm_newton_scratch(all);
}

struct gm_manifold gm_manifold_lay(const struct gm_problem *problem, double *scratch)
{
    const size_t half = problem->n / 2, constraints = gm_action_constraints(problem);
    struct gm_manifold manifold = {.action = gm_action_lay(problem, scratch), .constraints = constraints};
    manifold.at = scratch + gm_action_room(problem);
    manifold.g = manifold.at + problem->n;
    manifold.slopes = manifold.g + constraints;
    manifold.curvature = manifold.slopes + constraints * half;
    manifold.multipliers = manifold.curvature + half * half;
    manifold.unknowns = manifold.multipliers + constraints;
    manifold.right = manifold.unknowns + half + constraints;
    return manifold;
}

void gm_manifold_constrain(const struct gm_manifold *manifold, const double *q)
{
    const struct gm_problem *problem = manifold->action.problem;
    if (manifold->constraints > 0) {
        gm_ode_of(problem)->action->constrain(problem, q, manifold->multipliers, manifold->g,
                                              manifold->slopes, manifold->curvature);
    }
}

/* matrix := [dL2/dv2, -G'; G, 0] of the latest evaluations */
static inline __attribute__((always_inline)) void fill(const struct gm_manifold *manifold,
                                                       double *restrict matrix)
{
    const size_t half = manifold->action.half, constraints = manifold->constraints, all = half + constraints;
    memset(matrix, 0, all * all * sizeof(double));
    for (size_t i = 0; i < half; i++) {
        for (size_t j = 0; j < half; j++) {
            matrix[i * all + j] = manifold->action.motion.momenta_v[i * half + j];
        }
        for (size_t k = 0; k < constraints; k++) {
            matrix[i * all + half + k] = -manifold->slopes[k * half + i];
            matrix[(half + k) * all + i] = manifold->slopes[k * half + i];
        }
    }
}

/* pushed := p + G' multipliers */
static inline void push(const struct gm_manifold *manifold, const double *multipliers, const double *p,
                        double *pushed)
{
    const size_t half = manifold->action.half;
    for (size_t i = 0; i < half; i++) {
        double sum = p[i];
        for (size_t k = 0; k < manifold->constraints; k++) {
            sum += manifold->slopes[k * half + i] * multipliers[k];
        }
        pushed[i] = sum;
    }
}

/* A state that is moved onto the manifold, and its own momenta. */
struct settling {
    const struct gm_manifold *manifold;
    const double *p;
};

/* dL/dv = p + G' multipliers, G v = 0: the velocities and multipliers. */
static bool settle(void *data, const double *v, double *residual, double *matrix, double *scale)
{
    const struct settling *settling = data;
    const struct gm_manifold *manifold = settling->manifold;
    const size_t half = manifold->action.half;
    memcpy(manifold->at + half, v, half * sizeof *v);
    if (!gm_action_evaluate(&manifold->action, manifold->at)) {
        return false;
    }
    push(manifold, v + half, settling->p, residual);
    for (size_t i = 0; i < half; i++) {
        residual[i] -= manifold->action.motion.momenta[i];
        *scale += fabs(v[i]);
    }
    for (size_t k = 0; k < manifold->constraints; k++) {
        double sum = 0;
        for (size_t i = 0; i < half; i++) {
            sum -= manifold->slopes[k * half + i] * v[i];
        }
        residual[half + k] = sum;
    }
    fill(manifold, matrix);
    return true;
}

/* g(q) = 0, by the directions in which momenta are pushed at the first state. */
static bool approach(void *data, const double *q, double *residual, double *matrix, double *scale)
{
    const struct settling *settling = data;
    const struct gm_manifold *manifold = settling->manifold;
    const size_t half = manifold->action.half;
    memcpy(manifold->at, q, half * sizeof *q);
    gm_manifold_constrain(manifold, q);
    memset(residual, 0, half * sizeof *residual);
    for (size_t k = 0; k < manifold->constraints; k++) {
        residual[half + k] = -manifold->g[k];
    }
    if (!gm_action_evaluate(&manifold->action, manifold->at)) {
        return false;
    }
    fill(manifold, matrix);
    *scale += gm_sum_of(q, half);
    return true;
}

/* Solves from the current unknowns: half coordinates or velocities, and multipliers. */
static inline __attribute__((always_inline)) bool solve(const struct gm_manifold *manifold,
                                                        gm_linear_equations *linear, const double *p)
{
    const size_t half = manifold->action.half;
    struct settling settling = {manifold, p};
    struct gm_progress ignored = {0};
    const struct gm_implicit_equations equations = {.linear = linear,
                                                    .size = half + manifold->constraints,
                                                    .data = &settling,
                                                    .counted = half,
                                                    .least = 0x1p-52,
                                                    .roundoff = 0x1p-46};
    memset(manifold->unknowns + half, 0, manifold->constraints * sizeof(double));
    return gm_newton_solve(&equations, manifold->right, manifold->unknowns, &ignored);
}

bool gm_manifold_settle(const struct gm_manifold *manifold, double *y)
{
    const size_t half = manifold->action.half, n = manifold->action.problem->n;
    double *v = manifold->at + half, *unknowns = manifold->unknowns;
    memcpy(manifold->at, y, half * sizeof *y);
    memcpy(manifold->at + 2 * half, y + 2 * half, (n - 2 * half) * sizeof *y);
    gm_manifold_constrain(manifold, y);
    memcpy(unknowns, v, half * sizeof *v);
    if (!solve(manifold, settle, y + half)) {
        return false;
    }
    memcpy(v, unknowns, half * sizeof *v);
    push(manifold, unknowns + half, y + half, y + half);
    return true;
}

/* g'' = G a + v' g_qq v = 0 and dp/dt = M a + (d dL/dv / dq) v = dL/dq + F + G' multipliers, for a and
   multipliers. */
static bool accelerate(const struct gm_manifold *manifold, const double *y, double *f)
{
    const struct gm_action_at *action = &manifold->action;
    const size_t half = action->half, constraints = manifold->constraints;
    double state[GM_NEWTON_LARGEST], bent[GM_NEWTON_LARGEST];
    const double *v = manifold->at + half;
    memcpy(state, y, action->problem->n * sizeof *y);
    memset(manifold->at + half, 0, half * sizeof *y);
    if (!gm_manifold_settle(manifold, state)) {
        return false;
    }
    /* v' g_qq v, of one constraint after the other */
    for (size_t k = 0; k < constraints; k++) {
        for (size_t i = 0; i < constraints; i++) {
            manifold->multipliers[i] = i == k;
        }
        gm_manifold_constrain(manifold, y);
        bent[k] = 0;
        for (size_t i = 0; i < half; i++) {
            for (size_t j = 0; j < half; j++) {
                bent[k] += v[i] * manifold->curvature[i * half + j] * v[j];
            }
        }
    }
    for (size_t i = 0; i < half; i++) {
        manifold->right[i] = action->motion.forces[i];
        for (size_t j = 0; j < half; j++) {
            manifold->right[i] -= action->motion.momenta_q[i * half + j] * v[j];
        }
    }
    for (size_t k = 0; k < constraints; k++) {
        manifold->right[half + k] = -bent[k];
    }
    double *matrix = manifold->right + half + constraints;
    fill(manifold, matrix);
    if (!gm_eliminate(half + constraints, matrix, manifold->right)) {
        return false;
    }
    memcpy(f, v, half * sizeof *f);
    push(manifold, manifold->right + half, action->motion.forces, f + half);
    return true;
}

void gm_manifold_field(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    const size_t n = problem->n;
    double *scratch =
        gm_has_action(problem) ? calloc(gm_manifold_scratch_size(problem) + 2 * n, sizeof *scratch) : NULL;
    if (!scratch) {
        for (size_t i = 0; i < n * m; i++) {
            f[i] = NAN;
        }
        return;
    }
    double *state = scratch, *rates = scratch + n;
    const struct gm_manifold manifold = gm_manifold_lay(problem, scratch + 2 * n);
    for (size_t l = 0; l < m; l++) {
        gm_member_take(y, state, n, m, l);
        const bool found = accelerate(&manifold, state, rates);
        for (size_t i = 0; i < n; i++) {
            f[i * m + l] = found ? rates[i] : NAN;
        }
    }
    free(scratch);
}

bool gm_manifold_project(const struct gm_problem *problem, double *y)
{
    double *scratch = calloc(gm_manifold_scratch_size(problem), sizeof *scratch);
    bool good = false;
    if (scratch) {
        const struct gm_manifold manifold = gm_manifold_lay(problem, scratch);
        const size_t half = manifold.action.half;
        memcpy(manifold.unknowns, y, half * sizeof *y);
        good = solve(&manifold, approach, NULL);
        memcpy(y, manifold.unknowns, half * sizeof *y);
        memset(manifold.at + half, 0, half * sizeof *y);
        good = good && gm_manifold_settle(&manifold, y);
    }
    free(scratch);
    return good;
}

struct gm_manifold_defects gm_manifold_defects(const struct gm_problem *problem, const double *y)
{
    struct gm_manifold_defects defects = {NAN, NAN};
    double *scratch = calloc(gm_manifold_scratch_size(problem) + problem->n, sizeof *scratch);
    if (scratch) {
        struct gm_manifold manifold = gm_manifold_lay(problem, scratch + problem->n);
        const size_t half = manifold.action.half, constraints = manifold.constraints;
        memcpy(scratch, y, problem->n * sizeof *y);
        manifold.constraints = 0; /* the velocities as they are */
        const bool found = gm_manifold_settle(&manifold, scratch);
        manifold.constraints = constraints;
        gm_manifold_constrain(&manifold, y);
        defects = found ? (struct gm_manifold_defects){0, 0} : defects;
        for (size_t k = 0; found && k < constraints; k++) {
            double sum = 0;
            for (size_t i = 0; i < half; i++) {
                sum += manifold.slopes[k * half + i] * manifold.at[half + i];
            }
            defects.constraint = fmax(defects.constraint, fabs(manifold.g[k]));
            defects.hidden = fmax(defects.hidden, fabs(sum));
        }
    }
    free(scratch);
    return defects;
}
