/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Centred differences in time and space for M s_t + K s_x = grad S(s),
       M (s^{n+1} - s^{n-1})/(2 dt) + K (s_{i+1} - s_{i-1})/(2 dx) = grad S(s),
   which for u_tt - u_xx + V'(u) = 0 are, with D0 f = (f_{i+1} - f_{i-1})/(2 dx),
       u^{n+1} = u^{n-1} + 2 dt v^n
       w^n     = D0 u^n
       v^{n+1} = v^{n-1} + 2 dt [D0 w^n - V'(u^n)]
   With v and w eliminated these are four leapfrogs on the grid of steps (2 dt, 2 dx) that know nothing of
   each other: the solution splits into a checkerboard. Stable for dt <= dx. The memory is v at the two levels
   of the state. Razafindralandy et al. (2018), the multisymplectic midpoint scheme. */
#include "core/field/families/family.h"
#include "core/field/families/two_step.h"
#include "core/field/families/waves/form.h"

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    return 2 * problem->line.points;
}

/* u_tt: by centred differences twice over, or the usual ones */
static double acceleration(const struct gm_problem *problem, const double *u, size_t i, long reach,
                           double slope)
{
    const struct gm_grid1 *grid = &problem->line;
    const double step = (double)reach * grid->dx;
    return (gm_grid1_value(grid, u, i, reach) - 2 * u[i] + gm_grid1_value(grid, u, i, -reach)) /
               (step * step) -
           slope;
}

/* v at both levels of the state, to second order, from their difference and the accelerations there. */
static enum gm_status start(const struct gm_task *task)
{
    const struct gm_problem *problem = task->problem;
    const size_t points = problem->line.points;
    const double *u = task->y, *other = task->y + points, gap = task->y[2 * points];
    double *v = task->memory_out, *v_other = v + points;
    gm_field_of(problem)->wave->slopes(problem, u, v, points);
    gm_field_of(problem)->wave->slopes(problem, other, v_other, points);
    for (size_t i = 0; i < points; i++) {
        const double quotient = (other[i] - u[i]) / gap;
        v[i] = quotient - gap / 2 * acceleration(problem, u, i, 1, v[i]);
        v_other[i] = quotient + gap / 2 * acceleration(problem, other, i, 1, v_other[i]);
    }
    return GM_OK;
}

/* The first level after a change of the step: Heun's method, once. */
static void first_level(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                        double gap)
{
    (void)gap;
    const double *now = work->level[1];
    double *next = work->level[2], *const *v = work->rate;
    gm_field_of(problem)->wave->slopes(problem, now, work->force, work->points);
    for (size_t i = 0; i < work->points; i++) {
        v[2][i] = acceleration(problem, now, i, 1, work->force[i]);
        next[i] = now[i] + dt * (v[1][i] + dt / 2 * v[2][i]);
    }
    gm_field_of(problem)->wave->slopes(problem, next, work->force, work->points);
    for (size_t i = 0; i < work->points; i++) {
        v[2][i] = v[1][i] + dt / 2 * (v[2][i] + acceleration(problem, next, i, 1, work->force[i]));
    }
}

static enum gm_status centred_step(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                                   struct gm_progress *progress)
{
    const double *past = work->level[0], *now = work->level[1];
    double *next = work->level[2];
    double *const *v = work->rate;
    gm_field_of(problem)->wave->slopes(problem, now, work->force, work->points);
    for (size_t i = 0; i < work->points; i++) {
        next[i] = past[i] + 2 * dt * v[1][i];
        v[2][i] = v[0][i] + 2 * dt * acceleration(problem, now, i, 2, work->force[i]);
    }
    progress->evaluations++;
    return GM_OK;
}

/* The energy of both levels, with the slopes of the scheme. */
static double wave_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y,
                          const double *memory)
{
    (void)scheme;
    const struct gm_grid1 *grid = &problem->line;
    const struct gm_wave *wave = gm_field_of(problem)->wave;
    const size_t points = grid->points;
    const double *u = y, *o = y + points, *v_u = memory, *v_o = memory + points;
    double sum = 0;
    for (size_t i = 0; i < points; i++) {
        const double slope =
                         (gm_grid1_value(grid, u, i, 1) - gm_grid1_value(grid, u, i, -1)) / (2 * grid->dx),
                     other =
                         (gm_grid1_value(grid, o, i, 1) - gm_grid1_value(grid, o, i, -1)) / (2 * grid->dx);
        sum += (v_u[i] * v_o[i] + slope * other + wave->potential(problem, u[i]) +
                wave->potential(problem, o[i])) /
               2;
    }
    return grid->dx * sum;
}

static const struct gm_two_step_row row = {
    .step = centred_step, .start = first_level, .law = GM_LAW_CENTRED, .keeps_rates = true};

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_midpoint_box_of_waves, .family = &gm_family_midpoint_box, .needs = GM_NEEDS_WAVE,
     .coefficients = &row},
};

const struct gm_family gm_family_midpoint_box = {
    .title = "multisymplectic midpoint",
    GM_FIELD_FAMILY,
    GM_TWO_STEP_LOOP,
    .memory = memory,
    .start = start,
    .form = gm_wave_form,
    .wave_energy = wave_energy,
};
