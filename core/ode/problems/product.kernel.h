/* SPDX-License-Identifier: GPL-3.0-or-later */
/* (q, p), H = (1 + q^2)(1 + p^2)/2: a Hamiltonian that is not separable.
   M. Tao, Phys. Rev. E 94 (2016) 043303. */
#define GM_COMPONENTS 2

GM_INLINE void K(field)(const real *y, real *f, const void *parameters)
{
    (void)parameters;
    f[0] = y[1] * (1 + y[0] * y[0]);
    f[1] = -(y[0] * (1 + y[1] * y[1]));
}

#ifdef GM_PASS_SCALAR
static void K(jacobian)(const double *y, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    (void)parameters;
    jacobian[0][0] = 2 * y[0] * y[1];
    jacobian[0][1] = 1 + y[0] * y[0];
    jacobian[1][0] = -(1 + y[1] * y[1]);
    jacobian[1][1] = -2 * y[0] * y[1];
}
#endif
