/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Kepler problem in a fictitious time s, whose step ds is the run's dt: H = |p|^2/2 + V(q), V = -1/|q| +
   W(q) < 0, F_W = -grad W, B = -H at the start. A step is half a drift, a kick, half a drift. The memory is
   B. For W = 0 every point lies on the exact orbit; only the time has an error.

   levi-civita: with q = u^2 and w = 2 conj(u) p as complex numbers and dt = |q| ds,
       |q| (H + B) = |w|^2/8 + B |u|^2 - 1 + |u|^2 W(u^2),
   an oscillator and a perturbation:
       drift   the midpoint rule over ds/2 on  u' = w/4,   w' = -2 B u,   t' = |u|^2
       kick    w -= ds (2 u W - 2 |u|^2 conj(u) F_W)
   The drift keeps |w|^2/8 + B |u|^2, Im(conj(u) w) and w^2/8 + B u^2, which are quadratic: energy, angular
   momentum and the Laplace-Runge-Lenz vector. T. Levi-Civita, Acta Math. 42 (1920) 99; Y. Minesaki &
   Y. Nakamura, Phys. Lett. A 306 (2002) 127. */
#include <complex.h>

#include "core/functions/complex.h"
#include "core/ode/families/family.h"

static double square(double complex z)
{
    return creal(z) * creal(z) + cimag(z) * cimag(z);
}

/* Adds increments: the rounding of a factor near 1 would be the same in every step, and add up. */
static void drift_by_midpoint(double ds, double binding, double complex *u, double complex *w, double *t)
{
    const double turn = ds * ds * binding / 8;
    const double complex increment = (ds / 4 * *w - 2 * turn * *u) / (1 + turn);
    const double complex middle = *u + increment / 2;
    *u += increment;
    *w -= 2 * ds * binding * middle;
    *t += ds * square(middle);
}

/* One step of the state (q1, q2, p1, p2) and of the time; it evaluates the force once. */
static void levi_civita(const struct gm_problem *problem, double ds, double binding, double *y, double *t)
{
    double complex u = gm_csqrt(y[0] + I * y[1]), w = 2 * conj(u) * (y[2] + I * y[3]);
    drift_by_midpoint(ds / 2, binding, &u, &w, t);
    const double complex q = u * u;
    const double at[] = {creal(q), cimag(q)};
    double potential, force[2];
    gm_ode_of(problem)->kepler_split->potential(problem, at, &potential, 1);
    gm_ode_of(problem)->kepler_split->perturbing_force(problem, at, force, 1);
    const double r = sqrt(at[0] * at[0] + at[1] * at[1]), W = potential + 1 / r;
    w -= ds * (2 * W * u - 2 * r * conj(u) * (force[0] + I * force[1]));
    drift_by_midpoint(ds / 2, binding, &u, &w, t);
    const double complex end = u * u, p = w * u / (2 * square(u));
    y[0] = creal(end);
    y[1] = cimag(end);
    y[2] = creal(p);
    y[3] = cimag(p);
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const double before = progress->t;
    levi_civita(task->problem, task->dt, members->memory[0], members->y, &progress->t);
    progress->evaluations++;
    if (!isfinite(progress->t) || !((progress->t - before) * task->dt > 0)) {
        progress->t = before;
        return GM_STEP_COLLAPSE;
    }
    return GM_OK;
}

static enum gm_status start(const struct gm_task *task)
{
    /* a reversed run has its B, and so comes back; a new run's B is still zero */
    double *binding = task->memory_out;
    *binding = *binding != 0 ? *binding : -gm_energy(task->problem, task->y);
    return GM_OK;
}

const struct gm_family gm_family_fictitious_time = {
    .title = "fictitious time",
    GM_MEMBERS_WITH_MEMORY(fictitious_time, .step = step, .remembered = 1),
    .start = start,
    .adaptive = true,
};
