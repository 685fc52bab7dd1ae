/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Henon & Heiles, (q1, q2, p1, p2), H = (|p|^2 + |q|^2)/2 + q1^2 q2 - q2^3/3. Astron. J. 69 (1964) 73. */
#define GM_COMPONENTS 4
#define GM_SEPARABLE

GM_INLINE void K(velocity)(const real *p, real *dq, const void *parameters)
{
    (void)parameters;
    dq[0] = p[0];
    dq[1] = p[1];
}

GM_INLINE void K(force)(const real *q, real *dp, const void *parameters)
{
    (void)parameters;
    dp[0] = -(q[0] + 2 * q[0] * q[1]);
    dp[1] = -(q[1] + q[0] * q[0] - q[1] * q[1]);
}

#ifdef GM_PASS_SCALAR
static void K(jacobian)(const double *y, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    (void)parameters;
    memset(jacobian, 0, sizeof(double[GM_COMPONENTS][GM_COMPONENTS]));
    jacobian[0][2] = jacobian[1][3] = 1;
    jacobian[2][0] = -(1 + 2 * y[1]);
    jacobian[2][1] = jacobian[3][0] = -2 * y[0];
    jacobian[3][1] = -(1 - 2 * y[1]);
}
#endif
