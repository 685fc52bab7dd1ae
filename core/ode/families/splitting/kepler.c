/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Splitting of the perturbed Kepler problem, H = (|p|^2/2 - 1/|q|) + W(q):
       p += h/2 F_W(q);   (q, p) := exact Kepler flow over h;   p += h/2 F_W(q),   F_W = -grad W.
   J. Wisdom & M. Holman, Astron. J. 102 (1991) 1528.

   The Kepler flow in universal variables: r0 = |q|, alpha = 2/r0 - |p|^2, G_k(s) = s^k c_k(alpha s^2), and s
   the root of
       r0 G1 + (q . p) G2 + G3 = h,
   whose left side grows with the derivative r = r0 G0 + (q . p) G1 + G2, the distance at the end:
       q1 = f  q + g  p,   f  = 1 - G2/r0,      g  = h - G3
       p1 = f' q + g' p,   f' = -G1/(r r0),     g' = 1 - G2/r
   K. Stumpff (1956); J.M.A. Danby, Fundamentals of Celestial Mechanics, section 6.9. The memory is the
   perturbing force at the end of the step, which the next one begins with. */
#include "core/ode/families/splitting/kepler.h"

#include <math.h>
#include <stdlib.h>

#include "core/basics.h"
#include "core/functions/functions.h"
#include "core/ode/families/families.h"
#include "core/ode/kernel/members.h"
#include "core/ode_scheme_texts.h"

/* s^k c_k(alpha s^2), k = 0..3, c_k(z) = 1/k! - z/(k + 2)! + z^2/(k + 4)! - ... (K. Stumpff) */
static void stumpff(double alpha, double s, double G[4])
{
    const double z = alpha * s * s;
    double c2, c3;
    if (fabs(z) < 0.1) {
        c2 = 0;
        c3 = 0;
        for (int k = 8; k >= 0; k--) {
            const double n = 2 * k;
            c2 = 1 - z / ((n + 3) * (n + 4)) * c2;
            c3 = 1 - z / ((n + 4) * (n + 5)) * c3;
        }
        c2 /= 2;
        c3 /= 6;
    } else {
        const double root = sqrt(fabs(z)), sine = z > 0 ? gm_sin(root / 2) : gm_sinh(root / 2);
        c2 = 2 * sine * sine / fabs(z);
        c3 = (z > 0 ? root - gm_sin(root) : gm_sinh(root) - root) / (fabs(z) * root);
    }
    G[0] = 1 - z * c2;
    G[1] = s * (1 - z * c3);
    G[2] = s * s * c2;
    G[3] = s * s * s * c3;
}

/* The root s by Newton's method, kept between bounds that enclose it. */
static bool solve_universal(double h, double r0, double slope, double alpha, double G[4])
{
    enum { ITERATIONS = 200, NEWTON = 50 };
    double low = -INFINITY, high = INFINITY, s = h / r0, previous = INFINITY;
    for (int i = 0; i < ITERATIONS; i++) {
        stumpff(alpha, s, G);
        const double excess = r0 * G[1] + slope * G[2] + G[3] - h;
        const double r = r0 * G[0] + slope * G[1] + G[2];
        if (excess > 0) {
            high = fmin(high, s);
        } else {
            low = fmax(low, s);
        }
        double next = s - excess / r;
        if (!(next >= low && next <= high) || i > NEWTON) { /* the ends may lead to each other */
            next = isfinite(low) && isfinite(high) ? (low + high) / 2
                   : excess > 0                    ? s - 1 - fabs(s)
                                                   : s + 1 + fabs(s);
        }
        const double size = fabs(r0 * G[1]) + fabs(slope * G[2]) + fabs(G[3]) + fabs(h);
        const double roundoff = 4 * 2.220446049250313e-16 * (size / r + fabs(s));
        if (gm_is_settled(fabs(next - s), roundoff, &previous)) {
            return true;
        }
        s = next;
    }
    return false;
}

bool gm_kepler_flow(double h, double y[4])
{
    const double r0 = gm_hypot(y[0], y[1]), slope = y[0] * y[2] + y[1] * y[3];
    const double alpha = 2 / r0 - (y[2] * y[2] + y[3] * y[3]);
    if (!(r0 > 0) || !isfinite(alpha)) {
        return false;
    }
    if (alpha > 0) {
        h = remainder(h, 2 * M_PI / (alpha * sqrt(alpha))); /* whole revolutions lead back */
    }
    double G[4];
    if (!solve_universal(h, r0, slope, alpha, G)) {
        return false;
    }
    const double r = r0 * G[0] + slope * G[1] + G[2];
    const double f = 1 - G[2] / r0, g = h - G[3], df = -(G[1] / (r * r0)), dg = 1 - G[2] / r;
    for (int c = 0; c < 2; c++) {
        const double q = y[c], p = y[2 + c];
        y[c] = f * q + g * p;
        y[2 + c] = df * q + dg * p;
    }
    return true;
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    double *y = members->y, *force = members->memory;
    for (int c = 0; c < 2; c++) {
        y[2 + c] += task->dt / 2 * force[c];
    }
    if (!gm_kepler_flow(task->dt, y)) {
        progress->unsolved.obstacle = GM_NOT_FINITE;
        return GM_NO_CONVERGENCE;
    }
    gm_ode_of(task->problem)->kepler_split->perturbing_force(task->problem, y, force, 1);
    progress->evaluations++;
    for (int c = 0; c < 2; c++) {
        y[2 + c] += task->dt / 2 * force[c];
    }
    return GM_OK;
}

static enum gm_status start(const struct gm_task *task)
{
    const struct gm_problem *problem = task->problem;
    gm_ode_of(problem)->kepler_split->perturbing_force(problem, task->y, task->memory_out, problem->m);
    return GM_OK;
}

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_wisdom_holman2, .family = &gm_family_kepler, .needs = GM_NEEDS_KEPLER_SPLIT},
};

const struct gm_family gm_family_kepler = {
    .title = "Kepler splitting",
    GM_MEMBERS_WITH_MEMORY(.step = step, .remembered = 2, .evaluated_at_start = true),
    .start = start,
};
