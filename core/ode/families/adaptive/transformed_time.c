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
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/ode/families/families.h"
#include "core/ode/families/runge_kutta/implicit.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"

enum { ENERGY, TIME_CARRY, REMEMBERED };

/* F(y), and 1/Q; false where Q is no density. */
static bool slopes(const struct gm_problem *problem, double E, const double *y, double *gradient, double *F,
                   double *time)
{
    const struct gm_hamiltonian *hamiltonian = gm_ode_of(problem)->hamiltonian;
    const size_t half = problem->n / 2;
    double density;
    gm_ode_of(problem)->monitor->density(problem, y, &density, gradient);
    gm_field(problem, y, F, 1);
    const double weight = hamiltonian->weight ? hamiltonian->weight(problem) : 1;
    const double excess = weight * (gm_energy(problem, y) - E) / (density * density);
    for (size_t i = 0; i < half; i++) {
        F[i] = F[i] / density - excess * gradient[half + i];
        F[half + i] = F[half + i] / density + excess * gradient[i];
    }
    *time = 1 / density;
    return density > 0 && isfinite(density);
}

static double size_of(const double *values, size_t count)
{
    double sum = 0;
    for (size_t c = 0; c < count; c++) {
        sum += fabs(values[c]);
    }
    return sum;
}

/* By fixed-point iteration: in the time s the motion is gentle. */
static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    enum { ITERATIONS = 100 };
    const struct gm_implicit_row *row = task->scheme->coefficients;
    const struct gm_problem *problem = task->problem;
    const size_t n = problem->n, stages = (size_t)row->stages;
    const double ds = task->dt, E = members->memory[ENERGY];
    double *stage = members->scratch, *gradient = stage + n, *next = gradient + n, *F = next + n;
    double times[GM_IMPLICIT_STAGES], previous = INFINITY;
    bool settled = false;
    if (!slopes(problem, E, members->y, gradient, F, times)) {
        return GM_STEP_COLLAPSE;
    }
    for (size_t i = 1; i < stages; i++) {
        memcpy(F + i * n, F, n * sizeof *F);
    }
    progress->evaluations++;
    for (int k = 0; k < ITERATIONS && !settled; k++) {
        double change = 0, size = 0;
        for (size_t i = 0; i < stages; i++) {
            for (size_t c = 0; c < n; c++) {
                double sum = 0;
                for (size_t j = 0; j < stages; j++) {
                    sum += row->a[i][j] * F[j * n + c];
                }
                stage[c] = members->y[c] + ds * sum;
            }
            if (!slopes(problem, E, stage, gradient, next, &times[i])) {
                return GM_STEP_COLLAPSE;
            }
            for (size_t c = 0; c < n; c++) {
                change += fabs(next[c] - F[i * n + c]);
            }
            size += size_of(next, n);
            memcpy(F + i * n, next, n * sizeof *F);
        }
        progress->evaluations += stages;
        progress->iterations++;
        const double scale = size_of(members->y, n) + fabs(ds) * size;
        progress->unsolved = gm_unsolved_by(fabs(ds) * change, scale);
        if (!isfinite(change)) {
            return GM_NO_CONVERGENCE;
        }
        settled = gm_is_settled(fabs(ds) * change, 1e-15 * scale, &previous);
    }
    double time = 0;
    for (size_t j = 0; j < stages; j++) {
        time += ds * row->b[j] * times[j];
        for (size_t c = 0; c < n; c++) {
            members->y[c] += ds * row->b[j] * F[j * n + c];
        }
    }
    const double before = progress->t, whole = members->memory[TIME_CARRY] + time;
    progress->t += whole;
    members->memory[TIME_CARRY] = whole + (before - progress->t);
    return !settled ? GM_NO_CONVERGENCE : progress->t == before ? GM_STEP_COLLAPSE : GM_OK;
}

static struct gm_progress loop(const struct gm_task *task)
{
    return gm_members_advance(task, step);
}

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    return REMEMBERED * problem->m;
}

static enum gm_status start(const struct gm_task *task)
{
    /* a run that turns round keeps its E, and so comes back; that of a new run is still zero */
    double *E = &task->memory_out[ENERGY], density;
    *E = *E != 0 ? *E : gm_energy(task->problem, task->y);
    gm_ode_of(task->problem)->monitor->density(task->problem, task->y, &density, NULL);
    return density > 0 && isfinite(density) ? GM_OK : GM_STEP_COLLAPSE;
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_implicit_row *row = scheme->coefficients;
    return gm_members_open(problem, REMEMBERED, (3 + (size_t)row->stages) * problem->n);
}

#define IN_POINCARES_TIME(row, name)                                                                         \
    .family = &gm_family_transformed_time, .coefficients = &(row),                                           \
    .formula = "Gauss' method " name " for y′ = f/Q − (H − E) J∇Q/Q²,  t′ = 1/Q;  dt is ds = Q dt",          \
    .reference = "E. Hairer, Appl. Numer. Math. 25 (1997) 219; S. Reich, SIAM J. Numer. Anal. 36 (1999) "    \
                 "1549",                                                                                     \
    .needs = GM_NEEDS_ENERGY | GM_NEEDS_MONITOR, .claims = GM_SYMMETRIC | GM_REVERSIBLE

static const struct gm_scheme schemes[] = {
    {
        .name = "poincare-midpoint2",
        .title = "midpoint, Poincaré's time",
        IN_POINCARES_TIME(gm_implicit_midpoint, "midpoint"),
        .order = 2,
    },
    {
        .name = "poincare-gauss4",
        .title = "Gauss 4, Poincaré's time",
        IN_POINCARES_TIME(gm_implicit_gauss4, "gauss4"),
        .order = 4,
    },
    {
        .name = "poincare-gauss6",
        .title = "Gauss 6, Poincaré's time",
        IN_POINCARES_TIME(gm_implicit_gauss6, "gauss6"),
        .order = 6,
    },
    {
        .name = "poincare-gauss8",
        .title = "Gauss 8, Poincaré's time",
        IN_POINCARES_TIME(gm_implicit_gauss8, "gauss8"),
        .order = 8,
    },
};

const struct gm_family gm_family_transformed_time = {
    .kind = &gm_kind_ode,
    .title = "transformed time",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .loop = loop,
    .memory = memory,
    .start = start,
    .workspace_open = workspace_open,
    .workspace_close = free,
    .adaptive = true,
};
