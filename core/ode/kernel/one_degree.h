/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kernels of H = p^2/2 + V(q) in one degree of freedom, over the lane type. The problem's file gives
       K(slope)(q) = V',   K(curvature)(q) = V'',   K(third)(q) = V'''
   With GM_TANGENT the state carries two tangent vectors, (q, xi_1, xi_2; p, eta_1, eta_2), where
       xi_i' = eta_i,   eta_i' = -V''(q) xi_i :
   the variational equation, which is Hamiltonian with the same split. A Runge-Kutta method or a splitting
   applied to it gives the derivative of its own step, exactly. */

GM_INLINE void K(velocity)(const real *p, real *dq, const void *parameters)
{
    (void)parameters;
    for (int c = 0; c < GM_COMPONENTS / 2; c++) {
        dq[c] = p[c];
    }
}

GM_INLINE void K(force)(const real *q, real *dp, const void *parameters)
{
    (void)parameters;
    dp[0] = -K(slope)(q[0]);
#ifdef GM_TANGENT
    const real curvature = K(curvature)(q[0]);
    for (int c = 1; c < GM_COMPONENTS / 2; c++) {
        dp[c] = -(curvature * q[c]);
    }
#endif
}

#ifdef GM_PASS_SCALAR
static void K(jacobian)(const double *y, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    (void)parameters;
    enum { HALF = GM_COMPONENTS / 2 };
    memset(jacobian, 0, sizeof(double[GM_COMPONENTS][GM_COMPONENTS]));
    for (int c = 0; c < HALF; c++) {
        jacobian[c][HALF + c] = 1;
        jacobian[HALF + c][c] = -K(curvature)(y[0]);
        if (c > 0) {
            jacobian[HALF + c][0] = -(K(third)(y[0]) * y[c]);
        }
    }
}
#endif
