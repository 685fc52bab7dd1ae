/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The free rigid body with the moments of inertia I = (2, 1, 2/3): Euler's equations for y = I * angular
   velocity,
       y_1' = (1/I_3 - 1/I_2) y_2 y_3,   y_2' = (1/I_1 - 1/I_3) y_3 y_1,   y_3' = (1/I_2 - 1/I_1) y_1 y_2.
   Hairer, Lubich & Wanner (2006), IV.1. */
#define GM_COMPONENTS 3

GM_INLINE void K(field)(const real *y, real *f, const void *parameters)
{
    (void)parameters;
    f[0] = 0.5 * y[1] * y[2];
    f[1] = -1.0 * y[2] * y[0];
    f[2] = 0.5 * y[0] * y[1];
}

#ifdef GM_PASS_SCALAR
static void K(jacobian)(const double *y, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    (void)parameters;
    const double rows[3][3] = {{0, 0.5 * y[2], 0.5 * y[1]}, {-y[2], 0, -y[0]}, {0.5 * y[1], 0.5 * y[0], 0}};
    memcpy(jacobian, rows, sizeof rows);
}
#endif
