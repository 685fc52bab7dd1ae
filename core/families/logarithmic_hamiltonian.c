/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Leapfrog for the logarithmic Hamiltonian ln(|p|^2/2 + B) - ln(-V(q)), B = -H at the start, whose orbits are
   those of H = |p|^2/2 + V in a fictitious time s with dt = ds / (|p|^2/2 + B): drift, kick, drift with drift
   d = (ds/2) / (|p|^2/2 + B),  q += d p,  t += d;      kick  p += ds F(q) / (-V(q)). The step ds is the run's
   dt. For the Kepler problem every point lies on the exact orbit; only the time errs. S. Mikkola & K.
   Tanikawa, Celest. Mech. Dyn. Astron. 74 (1999) 287; M. Preto & S. Tremaine, Astron. J. 118 (1999) 2532. The
   memory is B. */
#include <math.h>
#include <stdlib.h>

#include "core/families/families.h"
#include "core/families/members.h"
#include "core/kernel/loops.h"

static void drift(double ds, double binding, double *y, double *t)
{
    const double d = ds / 2 / ((y[2] * y[2] + y[3] * y[3]) / 2 + binding);
    y[0] += d * y[2];
    y[1] += d * y[3];
    *t += d;
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct gm_problem *problem = task->problem;
    double *y = members->y, *f = members->scratch, potential;
    const double binding = members->memory[0], before = progress->t;
    drift(task->dt, binding, y, &progress->t);
    gm_field(problem, y, f, 1);
    problem->kepler_split->potential(problem, y, &potential, 1);
    progress->evaluations++;
    for (int c = 0; c < 2; c++) {
        y[2 + c] -= task->dt * f[2 + c] / potential;
    }
    drift(task->dt, binding, y, &progress->t);
    if (!isfinite(progress->t) || !((progress->t - before) * task->dt > 0)) {
        progress->t = before;
        return GM_STEP_COLLAPSE;
    }
    return GM_OK;
}

static struct gm_progress loop(const struct gm_task *task)
{
    return gm_members_advance(task, step);
}

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    return problem->m;
}

static enum gm_status start(const struct gm_task *task)
{
    const double *y = task->y;
    double potential;
    task->problem->kepler_split->potential(task->problem, y, &potential, 1);
    task->memory_out[0] = -potential - (y[2] * y[2] + y[3] * y[3]) / 2;
    return GM_OK;
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    return gm_members_open(problem, 1, problem->n);
}

static const struct gm_scheme schemes[] = {
    {
        .name = "logh2",
        .title = "logarithmic Hamiltonian",
        .formula = "drift q += d p, t += d, d = (ds/2)/(|p|²/2 + B);  kick p += ds F(q)/(−V(q));  drift\n"
                   "B = −H(0);  dt is the step ds of the fictitious time",
        .reference = "S. Mikkola & K. Tanikawa, Celest. Mech. Dyn. Astron. 74 (1999) 287; "
                     "M. Preto & S. Tremaine, Astron. J. 118 (1999) 2532",
        .family = &gm_family_logarithmic_hamiltonian,
        .order = 2,
        .needs = GM_NEEDS_ODE | GM_NEEDS_KEPLER_SPLIT,
    },
};

const struct gm_family gm_family_logarithmic_hamiltonian = {
    .id = GM_FAMILY_logarithmic_hamiltonian,
    .title = "logarithmic Hamiltonian",
    .schemes = schemes,
    .count = sizeof schemes / sizeof schemes[0],
    .loop = loop,
    .memory = memory,
    .start = start,
    .workspace_open = workspace_open,
    .workspace_close = free,
    .own_time = true,
};
