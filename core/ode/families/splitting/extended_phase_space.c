/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Explicit symplectic integration of Hamiltonians that do not separate, on two copies (q, p), (x, y) of phase
   space,
       H(q, y) + H(x, p) + omega (|q - x|^2 + |p - y|^2)/2,
   whose three parts have exact flows:
       A(h)   p -= h H_q(q, y),   x += h H_p(q, y)
       B(h)   q += h H_p(x, p),   y -= h H_q(x, p)
       C(h)   (q - x, p - y) turns by the angle 2 omega h, the sums q + x and p + y stay
       tao2 = A(h/2) B(h/2) C(h) B(h/2) A(h/2),   tao4 = three of them (core/ode/families/compositions.h)
   The state is the first copy, the memory the other. M. Tao, Phys. Rev. E 94 (2016) 043303.

   The largest stable binding omega for stiff springs, measured on the Fermi-Pasta-Ulam chain, the same with
   Omega = 20, 50 and 150: the energy stays to t = 100. Twice as much at h Omega = 0.5 and 0.25 loses it.
       h Omega         0.5    0.25    0.15
       omega, tao2      5      20     40 at least
       omega, tao4      2      10     40 at least */
#include "core/functions/functions.h"
#include "core/ode/families/family.h"

/* One copy moves by f = (H_p, -H_q) taken at (q of one, p of the other): q of the second, p of the first. */
static void shear(const struct gm_problem *problem, double h, double *first, double *second, double *scratch)
{
    const size_t half = problem->n / 2;
    double *mixed = scratch, *f = scratch + problem->n;
    memcpy(mixed, first, half * sizeof *mixed);
    memcpy(mixed + half, second + half, half * sizeof *mixed);
    gm_field(problem, mixed, f, 1);
    for (size_t c = 0; c < half; c++) {
        second[c] += h * f[c];
        first[half + c] += h * f[half + c];
    }
}

static void turn(size_t n, double angle, double *first, double *second)
{
    const size_t half = n / 2;
    const double cosine = gm_cos(angle), sine = gm_sin(angle);
    for (size_t c = 0; c < half; c++) {
        const double q_sum = first[c] + second[c], q_apart = first[c] - second[c];
        const double p_sum = first[half + c] + second[half + c], p_apart = first[half + c] - second[half + c];
        const double q_turned = cosine * q_apart + sine * p_apart,
                     p_turned = cosine * p_apart - sine * q_apart;
        first[c] = 0.5 * (q_sum + q_turned);
        second[c] = 0.5 * (q_sum - q_turned);
        first[half + c] = 0.5 * (p_sum + p_turned);
        second[half + c] = 0.5 * (p_sum - p_turned);
    }
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct gm_composition *composition = task->scheme->coefficients;
    const struct gm_problem *problem = task->problem;
    double *y = members->y, *twin = members->memory;
    for (int substep = 0; substep < composition->steps; substep++) {
        const double h = task->dt * gm_composition_fraction(composition, substep);
        shear(problem, h / 2, y, twin, members->scratch);
        shear(problem, h / 2, twin, y, members->scratch);
        turn(problem->n, 2 * task->settings->binding * h, y, twin);
        shear(problem, h / 2, twin, y, members->scratch);
        shear(problem, h / 2, y, twin, members->scratch);
        progress->evaluations += 4;
    }
    return GM_OK;
}

static enum gm_status start(const struct gm_task *task)
{
    memcpy(task->memory_out, task->y, task->problem->n * task->problem->m * sizeof(double));
    return GM_OK;
}

const struct gm_family gm_family_extended_phase_space = {
    .title = "extended phase space",
    GM_MEMBERS_WITH_MEMORY(extended_phase_space, .step = step, .halves = 2, .vectors = 2),
    .parameters = gm_settings_of_tao,
    .start = start,
    .doubled = true,
};
