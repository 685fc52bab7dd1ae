/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Newmark's method with gamma = 1/2 as a variational integrator. Of q'' = a(q) it makes
       Q_1 = Q_0 + h v_0 + h^2 [(1/2 - beta) a(Q_0) + beta a(Q_1)],   v_1 = v_0 + h/2 [a(Q_0) + a(Q_1)],
   which in x = Q - beta h^2 a(Q) is Verlet's scheme with the force at Q, and that has the potential
   V(Q) + (Q - x)' M (Q - x) / (2 beta h^2). The state is x with its momenta: their map is symplectic, and a
   symmetry conserves their momentum map.
   C. Kane, J.E. Marsden, M. Ortiz & M. West, Int. J. Numer. Meth. Engng 49 (2000) 1295.

   For every Lagrangian, whose mass matrix M may be of Q: with Q = x + sqrt(beta) d, and d stationary,
       h/2 sum over both ends of  2 L(Q, v +- d / (h sqrt(2))) - L(Q, v +- d sqrt(2) / h),   v = (x_1 - x_0) / h,
   + at x_0, - at x_1; the velocities are such that their mean is v, and that of their squares v^2 - d^2/h^2. */
#include "core/ode/families/family.h"
#include "core/ode/families/variational/discrete_lagrangian.h"

/* Writes the tables over x_0, d_0, d_1, x_1 at two points of each end. */
static void tables(const struct gm_settings *settings, double *values, double *slopes)
{
    const double root = sqrt(settings->newmark_beta), along[] = {M_SQRT1_2, M_SQRT2, -M_SQRT1_2, -M_SQRT2};
    for (int i = 0; i < 4; i++) {
        const bool late = i >= 2;
        memcpy(values + 4 * i, (const double[]){!late, late ? 0 : root, late ? root : 0, late},
               4 * sizeof *values);
        memcpy(slopes + 4 * i, (const double[]){-1, late ? 0 : along[i], late ? along[i] : 0, 1},
               4 * sizeof *slopes);
    }
}

static const struct gm_variational_row newmark = {
    .degree = 3, .points = 4, .b = {1, -0.5, 1, -0.5}, .c = {0, 0, 1, 1}, .tables = tables};

const struct gm_family gm_family_newmark = {
    .title = "variational Newmark",
    GM_ROWS(newmark),
    .parameters = gm_settings_of_newmark,
    GM_MEMBERS_BY(&gm_variational_members),
};
