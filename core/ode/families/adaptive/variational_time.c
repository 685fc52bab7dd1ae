/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Variational integrators that vary time as well: the steps tau_n come from the discrete energy balance.

   Rectangle rule, L = v^2/2 - V(q), v_n = (q_{n+1} - q_n)/tau_n:
       v_{n-1} - v_n    = tau_n V'(q_n)
       v_n^2/2 + V(q_n) = H_0
   so v_n = +-sqrt(2 (H_0 - V(q_n))) and tau_n = (v_{n-1} - v_n)/V'(q_n). tau grows without bound at a turning
   point, and before it is reached there is no real root: step-collapse. The restarting variant turns there.

   Midpoint rule, qbar = q_n + tau v/2:
       v + tau/2 V'(qbar) = p_n,   v^2/2 + V(qbar) = E
       q_{n+1} = q_n + tau v,      p_{n+1} = v - tau/2 V'(qbar)
   E is fixed by a first step of length tau0.

   Razafindralandy et al. (2018), eqs. 55, 56, 58 and 59; C. Kane, J.E. Marsden & M. Ortiz, J. Math. Phys. 40
   (1999) 3353. The run's dt gives the direction of time only; the memory is tau, the energy, and the number
   of restarts. */
#include "core/ode/families/adaptive/variational_time.h"

#include "core/events.h"
#include "core/functions/functions.h"
#include "core/ode/families/family.h"

enum rule { RECTANGLE, RECTANGLE_RESTART, MIDPOINT };
static const enum rule rectangle = RECTANGLE, rectangle_restart = RECTANGLE_RESTART, midpoint = MIDPOINT;

enum {
    TAU = GM_VARIATIONAL_TAU,
    ENERGY = GM_VARIATIONAL_ENERGY,
    RESTARTS = GM_VARIATIONAL_RESTARTS,
    REMEMBERED = GM_VARIATIONAL_REMEMBERED,
};

static double first_step(const struct gm_task *task)
{
    return copysign(task->settings->tau0, task->dt);
}

/* Finds the root tau nearest to `near` in the logarithm, and its velocity; false if no root exists. */
static bool find_root(enum rule rule, double v, double slope, double square, double near, double tau0,
                      double *tau, double *velocity)
{
    if (!(square >= 0) || slope == 0) {
        return false;
    }
    const double root = sqrt(square);
    double best = INFINITY;
    for (int sign = 1; sign >= -1; sign -= 2) {
        const double candidate = (v - sign * root) / slope, ratio = candidate / tau0;
        const bool allowed = rule == RECTANGLE ? ratio > 0 : ratio > 0.3 && ratio < 3;
        const double away = fabs(gm_log(candidate / near));
        if (allowed && away < best) {
            best = away;
            *tau = candidate;
            *velocity = sign * root;
        }
    }
    return isfinite(best);
}

static enum gm_status rectangle_step(const struct gm_task *task, struct gm_members *members,
                                     struct gm_progress *progress)
{
    const struct gm_problem *problem = task->problem;
    const enum rule rule = *(const enum rule *)task->scheme->coefficients;
    double *y = members->y, *memory = members->memory;
    const double tau = memory[TAU], v = y[1], tau0 = first_step(task), next = y[0] + tau * v;
    double potential[3];
    gm_ode_of(problem)->lagrangian->potential(problem, next, potential);
    progress->evaluations++;
    const double square = 2 * (memory[ENERGY] - potential[0]);
    if (find_root(rule, v, potential[1], square, tau, tau0, &memory[TAU], &y[1])) {
        y[0] = next;
        progress->t += tau;
        return GM_OK;
    }
    if (rule == RECTANGLE) {
        return GM_STEP_COLLAPSE;
    }
    memory[TAU] = tau0;
    memory[RESTARTS]++;
    if (square >= 0) {
        y[0] = next;
        y[1] = copysign(sqrt(square), v);
        progress->t += tau;
    } else {
        y[1] = -v; /* beyond the turning point: the same place and time, the other way */
    }
    return GM_OK;
}

/* The midpoint rule's values at (q, p) with the step tau. */
struct middle {
    double v, q;         /* velocity and midpoint */
    double potential[3]; /* V, V', V'' at the midpoint */
};

static bool solve_velocity(const struct gm_problem *problem, const double *y, double tau,
                           struct middle *middle, struct gm_progress *progress)
{
    enum { ITERATIONS = 50 };
    double previous = INFINITY;
    middle->v = y[1];
    for (int i = 0; i < ITERATIONS; i++) {
        middle->q = y[0] + tau * middle->v / 2;
        gm_ode_of(problem)->lagrangian->potential(problem, middle->q, middle->potential);
        progress->evaluations++;
        progress->iterations++;
        const double residual = middle->v + tau / 2 * middle->potential[1] - y[1];
        const double change = residual / (1 + tau * tau / 4 * middle->potential[2]);
        if (!isfinite(change)) {
            return false;
        }
        middle->v -= change;
        const double size = fabs(middle->v) + fabs(y[1]) + fabs(tau * middle->potential[1]);
        if (gm_is_settled(fabs(change), 4 * 2.220446049250313e-16 * size, &previous)) {
            middle->q = y[0] + tau * middle->v / 2;
            gm_ode_of(problem)->lagrangian->potential(problem, middle->q, middle->potential);
            return true;
        }
    }
    return false;
}

/* Finds the step from y whose midpoint has the energy E, by Newton's method from the last one. */
static bool solve_step(const struct gm_problem *problem, const double *y, double energy, double *tau,
                       struct gm_progress *progress)
{
    enum { ITERATIONS = 50 };
    const double last = *tau;
    double previous = INFINITY;
    for (int i = 0; i < ITERATIONS; i++) {
        struct middle middle;
        if (!solve_velocity(problem, y, *tau, &middle, progress)) {
            return false;
        }
        const double slope = middle.potential[1], curvature = middle.potential[2];
        const double excess = middle.v * middle.v / 2 + middle.potential[0] - energy;
        const double dv = -(slope / 2 + *tau * middle.v * curvature / 4) / (1 + *tau * *tau / 4 * curvature);
        const double derivative = middle.v * dv + slope * (middle.v + *tau * dv) / 2;
        const double change = excess / derivative;
        if (!isfinite(change)) {
            return excess == 0;
        }
        *tau -= change;
        if (!(*tau / last > 0.2 && *tau / last < 5)) {
            return false;
        }
        const double size = (fabs(energy) + middle.v * middle.v) / fabs(derivative);
        if (gm_is_settled(fabs(change), 16 * 2.220446049250313e-16 * size, &previous)) {
            return true;
        }
    }
    return false;
}

/* Makes the step whose tau the memory holds, and stores the next tau, 0 if the search finds no root. */
static enum gm_status midpoint_step(const struct gm_task *task, struct gm_members *members,
                                    struct gm_progress *progress)
{
    double *y = members->y, *memory = members->memory;
    struct middle middle;
    if (memory[TAU] == 0 || !solve_velocity(task->problem, y, memory[TAU], &middle, progress)) {
        return GM_STEP_COLLAPSE;
    }
    y[0] += memory[TAU] * middle.v;
    y[1] = middle.v - memory[TAU] / 2 * middle.potential[1];
    progress->t += memory[TAU];
    if (!solve_step(task->problem, y, memory[ENERGY], &memory[TAU], progress)) {
        memory[TAU] = 0;
    }
    return GM_OK;
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const enum rule rule = *(const enum rule *)task->scheme->coefficients;
    return rule == MIDPOINT ? midpoint_step(task, members, progress)
                            : rectangle_step(task, members, progress);
}

static enum gm_status start(const struct gm_task *task)
{
    const struct gm_problem *problem = task->problem;
    const enum rule rule = *(const enum rule *)task->scheme->coefficients;
    double potential[3];
    const double last = task->memory_out[TAU];
    task->memory_out[TAU] = first_step(task);
    task->memory_out[RESTARTS] = 0;
    if (rule == MIDPOINT) {
        struct gm_progress ignored = {0};
        struct middle middle;
        if (last != 0) {
            /* a reversed run conserves its energy, and so comes back; the step of a new run is still zero */
            task->memory_out[TAU] = copysign(last, task->dt);
            if (!solve_step(problem, task->y, task->memory_out[ENERGY], &task->memory_out[TAU], &ignored)) {
                task->memory_out[TAU] = 0;
            }
            return GM_OK;
        }
        if (!solve_velocity(problem, task->y, task->memory_out[TAU], &middle, &ignored)) {
            return GM_STEP_COLLAPSE;
        }
        task->memory_out[ENERGY] = middle.v * middle.v / 2 + middle.potential[0];
        return GM_OK;
    }
    gm_ode_of(problem)->lagrangian->potential(problem, task->y[0], potential);
    task->memory_out[ENERGY] = task->y[1] * task->y[1] / 2 + potential[0];
    return GM_OK;
}

const char *gm_lacks_events(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    (void)scheme;
    return problem->events && problem->events->changes
               ? "a motion without events (its steps have their own length; rk4, gauss4 and dopri5 end one at an event)"
               : NULL;
}

const struct gm_family gm_family_variational_time = {
    .title = "variational, with variable time step",
    GM_MEMBERS_WITH_MEMORY(variational_time, .step = step, .remembered = REMEMBERED),
    .parameters = gm_settings_of_variational_time,
    .start = start,
    .lacks = gm_lacks_events,
    .adaptive = true,
};
