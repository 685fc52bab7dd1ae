/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Symplectic schemes with steps that follow the motion, in Poincare's time s, ds = Q(y) dt for a monitor
   Q > 0, the density of steps. In the phase space extended by t and its momentum -E the motion of
       K(q, p, t, -E) = (H(q, p) - E) / Q(q, p),   E = H at the start,
   is that of H on K = 0, where
       y' = F(y) = f(y) / Q - (H(y) - E) / Q^2 J grad Q,   t' = 1 / Q,   E' = 0.
   Gauss' methods take steps of constant length ds, the run's dt, in s:
       Y_i = y_n + ds sum_j a_ij F(Y_j),   y_{n+1} = y_n + ds sum_j b_j F(Y_j),
       t_{n+1} = t_n + ds sum_j b_j / Q(Y_j)
   They are symplectic in the extended phase space: backward error analysis holds, and H - E stays small for
   exponentially long times, whatever the monitor. E. Hairer, Appl. Numer. Math. 25 (1997) 219; S. Reich, SIAM
   J. Numer. Anal. 36 (1999) 1549. The memory is E and what the sum of times carries over. */
#include "core/ode/families/family.h"
#include "core/ode/families/runge_kutta/implicit.h"

enum { ENERGY, TIME_CARRY, REMEMBERED };

/* Computes F(y) and 1/Q; false if Q is not a density. */
static bool slopes(const struct gm_problem *problem, double E, const double *y, double *gradient, double *F,
                   double *time)
{
    const size_t half = problem->n / 2;
    double density;
    gm_ode_of(problem)->monitor->density(problem, y, &density, gradient);
    gm_field(problem, y, F, 1);
    const double excess = gm_weight_of(problem) * (gm_energy(problem, y) - E) / (density * density);
    for (size_t i = 0; i < half; i++) {
        F[i] = F[i] / density - excess * gradient[half + i];
        F[half + i] = F[half + i] / density + excess * gradient[i];
    }
    *time = 1 / density;
    return density > 0 && isfinite(density);
}

/* A step from y; slopes are F at the stages, and times 1/Q there. */
struct work {
    const struct gm_task *task;
    const struct gm_members *members;
    double *stage, *gradient, times[GM_TABLEAU_STAGES];
    bool collapsed; /* Q was not a density */
    struct gm_progress *progress;
};

static bool sweep(void *data, const double *F, double *next, double *scale)
{
    struct work *work = data;
    const struct gm_tableau *row = work->task->scheme->coefficients;
    const double *y = work->members->y, ds = work->task->dt, E = work->members->memory[ENERGY];
    const size_t n = work->members->n, stages = (size_t)row->stages;
    for (size_t i = 0; i < stages; i++) {
        for (size_t c = 0; c < n; c++) {
            double sum = 0;
            for (size_t j = 0; j < stages; j++) {
                sum += row->a[i][j] * (j < i ? next : F)[j * n + c];
            }
            work->stage[c] = y[c] + ds * sum;
        }
        work->collapsed =
            !slopes(work->task->problem, E, work->stage, work->gradient, next + i * n, &work->times[i]);
        if (work->collapsed) {
            return false;
        }
    }
    work->progress->evaluations += stages;
    *scale += gm_sum_of(y, n) / fabs(ds) + gm_sum_of(next, stages * n);
    return true;
}

/* Makes a step by sweeps: in the time s the motion is gentle. */
static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct gm_tableau *row = task->scheme->coefficients;
    const size_t n = members->n, stages = (size_t)row->stages;
    struct work work = {.task = task,
                        .members = members,
                        .stage = members->scratch,
                        .gradient = members->scratch + n,
                        .progress = progress};
    double *F = work.gradient + n, *next = F + stages * n;
    const struct gm_implicit_equations equations = {
        .size = stages * n, .data = &work, .sweep = sweep, .roundoff = 1e-15};
    if (!slopes(task->problem, members->memory[ENERGY], members->y, work.gradient, F, work.times)) {
        return GM_STEP_COLLAPSE;
    }
    for (size_t i = 1; i < stages; i++) {
        memcpy(F + i * n, F, n * sizeof *F);
    }
    progress->evaluations++;
    if (!gm_sweeps_solve(&equations, next, F, progress)) {
        return work.collapsed ? GM_STEP_COLLAPSE : GM_NO_CONVERGENCE;
    }
    double time = 0;
    for (size_t j = 0; j < stages; j++) {
        time += task->dt * row->b[j] * work.times[j];
        for (size_t c = 0; c < n; c++) {
            members->y[c] += task->dt * row->b[j] * F[j * n + c];
        }
    }
    return gm_members_pass(progress, time, &members->memory[TIME_CARRY]);
}

static enum gm_status start(const struct gm_task *task)
{
    /* a reversed run has its E, and so comes back; a new run's E is still zero */
    double *E = &task->memory_out[ENERGY], density;
    *E = *E != 0 ? *E : gm_energy(task->problem, task->y);
    gm_ode_of(task->problem)->monitor->density(task->problem, task->y, &density, NULL);
    return density > 0 && isfinite(density) ? GM_OK : GM_STEP_COLLAPSE;
}

static size_t room(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    return (2 + 2 * (size_t)((const struct gm_tableau *)scheme->coefficients)->stages) * problem->n;
}

const struct gm_family gm_family_transformed_time = {
    .title = "transformed time",
    GM_MEMBERS_WITH_MEMORY(transformed_time, .step = step, .remembered = REMEMBERED, .room = room),
    .start = start,
    .adaptive = true,
};
