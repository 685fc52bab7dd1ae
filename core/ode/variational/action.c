/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A Lagrangian's momenta and forces with their derivatives, from the problem or from a Hamiltonian with
   quadratic kinetic energy. */
#include "core/ode/variational/action.h"

#include <string.h>

#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"

static const struct gm_loops *loops_of(const struct gm_problem *problem)
{
    const struct gm_ode *ode = gm_ode_of(problem);
    return ode->action && ode->action->free ? ode->action->free : ode->loops[GM_ISA_BASELINE];
}

bool gm_has_action(const struct gm_problem *problem)
{
    const struct gm_ode *ode = gm_ode_of(problem);
    if (problem->n > GM_NEWTON_LARGEST || problem->passive > 0) {
        return false;
    }
    const struct gm_split *split = ode->split;
    const bool natural = ode->action || (split && split->nystrom && !split->no_potential);
    return (ode->action && ode->action->motion) ||
           (natural && loops_of(problem) && loops_of(problem)->jacobian);
}

size_t gm_action_constraints(const struct gm_problem *problem)
{
    const struct gm_action *action = gm_ode_of(problem)->action;
    return action ? action->constraints : 0;
}

static bool is_given(const struct gm_problem *problem)
{
    return gm_ode_of(problem)->action && gm_ode_of(problem)->action->motion;
}

size_t gm_action_room(const struct gm_problem *problem)
{
    const size_t n = problem->n, half = n / 2;
    return 2 * half + 4 * half * half + (is_given(problem) ? 0 : 1 + 2 * half * half + half + 2 * n + n * n);
}

struct gm_action_at gm_action_lay(const struct gm_problem *problem, double *scratch)
{
    const size_t n = problem->n, half = n / 2, square = half * half;
    double *matrices = scratch + 2 * half, *own = matrices + 4 * square;
    struct gm_action_at action = {
        .problem = problem,
        .half = half,
        .motion = {.momenta = scratch,
                   .forces = scratch + half,
                   .momenta_q = matrices,
                   .momenta_v = matrices + square,
                   .forces_q = matrices + 2 * square,
                   .forces_v = matrices + 3 * square},
    };
    if (!is_given(problem)) {
        action.known = own;
        action.mass = own + 1; /* the matrix and the scratch of its inversion */
        action.drift = action.mass + 2 * square;
        action.state = action.drift + half;
        action.field = action.state + n;
        action.jacobian = action.field + n;
    }
    return action;
}

/* Computes A^-1 and b, which do not depend on the state at one time. */
static bool find_mass(const struct gm_action_at *action, const double *at)
{
    const size_t n = action->problem->n, half = action->half;
    double *a = action->mass + half * half;
    memcpy(action->state, at, n * sizeof *at);
    memset(action->state + half, 0, half * sizeof *at);
    loops_of(action->problem)->field(action->problem, action->state, action->field, 1);
    memcpy(action->drift, action->field, half * sizeof *at);
    loops_of(action->problem)->jacobian(action->problem, action->state, action->jacobian);
    memset(action->mass, 0, half * half * sizeof *a); /* the inverse by columns: it is symmetric */
    for (size_t i = 0; i < half; i++) {
        memcpy(a + i * half, action->jacobian + i * n + half, half * sizeof *a);
        action->mass[i * (half + 1)] = 1;
    }
    if (!gm_eliminate_columns(half, a, half, action->mass)) {
        return false;
    }
    *action->known = 1;
    return true;
}

static bool by_hamiltonian(const struct gm_action_at *action, const double *at)
{
    const struct gm_motion *motion = &action->motion;
    const struct gm_loops *loops = loops_of(action->problem);
    const size_t n = action->problem->n, half = action->half;
    const double *mass = action->mass;
    const bool timed = n % 2 != 0;
    if ((timed || *action->known == 0) && !find_mass(action, at)) {
        return false;
    }
    memcpy(action->state, at, n * sizeof *at);
    for (size_t i = 0; i < half; i++) {
        double sum = 0;
        for (size_t k = 0; k < half; k++) {
            sum += mass[i * half + k] * (at[half + k] - action->drift[k]);
        }
        action->state[half + i] = motion->momenta[i] = sum;
    }
    loops->field(action->problem, action->state, action->field, 1);
    loops->jacobian(action->problem, action->state, action->jacobian);
    memcpy(motion->forces, action->field + half, half * sizeof *at);
    memset(motion->momenta_q, 0, half * half * sizeof *at);
    memcpy(motion->momenta_v, mass, half * half * sizeof *at);
    for (size_t i = 0; i < half; i++) {
        const double *row = action->jacobian + (half + i) * n;
        for (size_t j = 0; j < half; j++) {
            double sum = 0;
            for (size_t k = 0; k < half; k++) {
                sum += row[half + k] * mass[k * half + j];
            }
            motion->forces_q[i * half + j] = row[j];
            motion->forces_v[i * half + j] = sum;
        }
    }
    return true;
}

bool gm_action_evaluate(const struct gm_action_at *action, const double *at)
{
    if (!is_given(action->problem)) {
        return by_hamiltonian(action, at);
    }
    gm_ode_of(action->problem)->action->motion(action->problem, at, &action->motion);
    return true;
}
