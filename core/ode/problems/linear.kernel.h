/* SPDX-License-Identifier: GPL-3.0-or-later */
/* y' = A y in three dimensions, A = parameters, 9 doubles row by row; linear.c says which A. */
#define GM_COMPONENTS 3

GM_INLINE void K(field)(const real *y, real *f, const void *parameters)
{
    const double *a = parameters;
    for (int r = 0; r < 3; r++) {
        f[r] = a[3 * r] * y[0] + a[3 * r + 1] * y[1] + a[3 * r + 2] * y[2];
    }
}

#ifdef GM_PASS_SCALAR
static void K(jacobian)(const double *y, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    (void)y;
    memcpy(jacobian, parameters, sizeof(double[GM_COMPONENTS][GM_COMPONENTS]));
}
#endif
