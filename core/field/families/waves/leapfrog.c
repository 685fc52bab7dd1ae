/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes of two steps, on nodes, for u_tt - u_xx + V'(u) = 0, d2 u = (u_{i+1} - 2 u_i + u_{i-1}) / dx^2:
       leapfrog            (u^{n+1} - 2 u^n + u^{n-1}) / dt^2 = d2 u^n - V'(u^n)
       energy-conserving   (u^{n+1} - 2 u^n + u^{n-1}) / dt^2 = d2 u^n - [V(u^{n+1}) - V(u^{n-1})]
                                                                         / (u^{n+1} - u^{n-1})
       Euler box           M+ D_t^+ s - M+' D_t^- s + K+ D_x^+ s - K+' D_x^- s = grad S(s)
   In the Euler box M = M+ - M+', K = K+ - K+' are split into triangles; with v and w eliminated it is
   leapfrog, so leapfrog is multisymplectic as well. B. Moore & S. Reich, Numer. Math. 95 (2003) 625.
   Energy-conserving: W. Strauss & L. Vazquez, J. Comput. Phys. 28 (1978) 271. Stable where, with V'' at the
   solution,
       leapfrog            4/dt^2        >= 4/dx^2 + V''
       energy-conserving   4/dt^2 + V''  >= 4/dx^2 */
#include "core/field/families/family.h"
#include "core/field/families/two_step.h"
#include "core/field/families/waves/form.h"
#include "core/linear/settled.h"

GM_CLONES static void explicit_step(const double *restrict past, const double *restrict now,
                                    const double *restrict force, double *restrict next, size_t points,
                                    double ratio, double square)
{
    for (size_t i = 1; i <= points; i++) {
        const double curvature = now[i + 1] - 2 * now[i] + now[i - 1];
        next[i] = 2 * now[i] - past[i] + ratio * curvature - square * force[i];
    }
}

static enum gm_status leapfrog(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                               struct gm_progress *progress)
{
    const double *past = work->level[0], *now = work->level[1];
    double *next = work->level[2];
    const double dx = problem->line.dx;
    gm_field_of(problem)->wave->slopes(problem, now, work->force, work->points);
    explicit_step(past - 1, now - 1, work->force - 1, next - 1, work->points, dt * dt / (dx * dx), dt * dt);
    progress->evaluations++;
    return GM_OK;
}

/* c + dt^2 Q(now + c, past) = right, from the guess c; NaN if Newton's method does not settle */
static double solve_node(const struct gm_problem *problem, double square, double past, double now,
                         double right, double c, unsigned long *iterations)
{
    enum { MOST = 50 };
    const struct gm_wave *wave = gm_field_of(problem)->wave;
    double last = INFINITY;
    for (int k = 0; k < MOST; k++) {
        const double x = now + c;
        const double change = (c + square * wave->quotient(problem, x, past) - right) /
                              (1 + square * wave->quotient_slope(problem, x, past));
        const double size = fabs(change);
        ++*iterations;
        c -= change;
        if (gm_is_settled(size, 1e-14 * fmax(1, fabs(x)), &last) || isnan(size)) {
            return c;
        }
    }
    return NAN;
}

/* Solved for the change from level to level, which is kept apart from the levels: there it would be rounded
   as they are, and the energy would wander twenty times as far. */
static enum gm_status energy_conserving(struct gm_two_step_work *work, const struct gm_problem *problem,
                                        double dt, struct gm_progress *progress)
{
    const double *past = work->level[0], *now = work->level[1];
    double *next = work->level[2];
    const double square = dt * dt, ratio = square / (problem->line.dx * problem->line.dx);
    for (size_t i = 0; i < work->points; i++) {
        const double before = work->change[i];
        const double curvature = ((now + i)[1] - now[i]) - (now[i] - (now + i)[-1]);
        const double right = before + ratio * curvature;
        work->change[i] = solve_node(problem, square, past[i], now[i], right, before, &progress->iterations);
        next[i] = now[i] + work->change[i];
        if (isnan(next[i])) {
            return isfinite(right) ? GM_NO_CONVERGENCE : GM_BLOW_UP;
        }
    }
    progress->evaluations++;
    return GM_OK;
}

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_two_step_row *row = scheme->coefficients;
    return row->keeps_change ? problem->line.points : 0;
}

/* Starts the stored change, u at t less u at the other time; a first step of another formula replaces it. */
static enum gm_status start(const struct gm_task *task)
{
    const size_t points = task->problem->line.points;
    if (memory(task->problem, task->scheme) > 0) {
        for (size_t i = 0; i < points; i++) {
            task->memory_out[i] = task->y[i] - task->y[points + i];
        }
    }
    return GM_OK;
}

static const struct gm_two_step_row rows[] = {
    {.step = leapfrog, .start = gm_wave_start, .law = GM_LAW_NODES},
    {.step = energy_conserving,
     .start = gm_wave_start,
     .law = GM_LAW_NODES,
     .average = true,
     .keeps_change = true},
};

static const struct gm_step_limit explicit_limit = {"4/dt^2 >= 4/dx^2 + V''", 4, 4};

#define OF_LEAPFROG .family = &gm_family_leapfrog, .needs = GM_NEEDS_WAVE

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_leapfrog, OF_LEAPFROG, .limit = &explicit_limit, .coefficients = &rows[0]},
    {GM_TEXTS_energy_conserving, OF_LEAPFROG, .coefficients = &rows[1]},
    {GM_TEXTS_euler_box_of_waves, OF_LEAPFROG, .limit = &explicit_limit, .coefficients = &rows[0]},
};

const struct gm_family gm_family_leapfrog = {
    .title = "two-step wave schemes",
    GM_FIELD_FAMILY,
    GM_TWO_STEP_LOOP,
    .memory = memory,
    .start = start,
    .form = gm_wave_form,
};
