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

enum { NODES = 64 }; /* that are solved beside each other */

/* Solves c + dt^2 Q(now + c, past) = right by Newton's method for at most NODES nodes, each until it settles, from
   the guesses c; NaN if it does not. */
static void solve_nodes(const struct gm_problem *problem, double square, const double *past,
                        const double *now, const double *right, double *c, size_t count,
                        unsigned long *iterations)
{
    enum { MOST = 50 };
    const struct gm_wave *wave = gm_field_of(problem)->wave;
    double last[NODES], x[NODES], y[NODES], quotient[NODES], slope[NODES];
    size_t node[NODES], left = count;
    for (size_t i = 0; i < count; i++) {
        node[i] = i;
        last[i] = INFINITY;
    }
    for (int k = 0; k < MOST && left > 0; k++) {
        for (size_t j = 0; j < left; j++) {
            x[j] = now[node[j]] + c[node[j]];
            y[j] = past[node[j]];
        }
        wave->quotients(problem, x, y, quotient, slope, left);
        *iterations += left;
        size_t unsettled = 0;
        for (size_t j = 0; j < left; j++) {
            const size_t i = node[j];
            const double change = (c[i] + square * quotient[j] - right[i]) / (1 + square * slope[j]),
                         size = fabs(change);
            c[i] -= change;
            if (!gm_is_settled(size, 1e-14 * fmax(1, fabs(x[j])), &last[i]) && !isnan(size)) {
                node[unsettled++] = i;
            }
        }
        left = unsettled;
    }
    for (size_t j = 0; j < left; j++) {
        c[node[j]] = NAN;
    }
}

/* Solved for the change from level to level, which is kept apart from the levels: there it would be rounded
   as they are, and the energy would wander twenty times as far. */
static enum gm_status energy_conserving(struct gm_two_step_work *work, const struct gm_problem *problem,
                                        double dt, struct gm_progress *progress)
{
    const double square = dt * dt, ratio = square / (problem->line.dx * problem->line.dx);
    for (size_t first = 0; first < work->points; first += NODES) {
        const size_t count = work->points - first < NODES ? work->points - first : NODES;
        const double *past = work->level[0] + first, *now = work->level[1] + first;
        double right[NODES], *change = work->change + first, *next = work->level[2] + first;
        for (size_t i = 0; i < count; i++) {
            const double curvature = ((now + i)[1] - now[i]) - (now[i] - (now + i)[-1]);
            right[i] = change[i] + ratio * curvature;
        }
        solve_nodes(problem, square, past, now, right, change, count, &progress->iterations);
        for (size_t i = 0; i < count; i++) {
            next[i] = now[i] + change[i];
            if (isnan(next[i])) {
                return isfinite(right[i]) ? GM_NO_CONVERGENCE : GM_BLOW_UP;
            }
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

static const struct gm_step_limit explicit_limit = {"4/dt^2 >= 4/dx^2 + V''", 4, 4, false},
                                  conserving_limit = {"4/dt^2 + V'' >= 4/dx^2", 4, 4, true};

#define OF_LEAPFROG .family = &gm_family_leapfrog, .needs = GM_NEEDS_WAVE

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_leapfrog, OF_LEAPFROG, .limit = &explicit_limit, .coefficients = &rows[0]},
    {GM_TEXTS_energy_conserving, OF_LEAPFROG, .limit = &conserving_limit, .coefficients = &rows[1]},
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
