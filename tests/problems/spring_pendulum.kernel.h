/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mass on a stiff spring of rest length 1 in gravity, (q1, q2, p1, p2),
       H = |p|^2/2 + k (|q| - 1)^2/2 + q2,   k = *(const double *)parameters.
   Hairer, Lubich & Wanner (2006), XIII.1. */
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
    const double stiffness = *(const double *)parameters;
    const real pull = stiffness * (1 - 1 / K(root)(q[0] * q[0] + q[1] * q[1]));
    dp[0] = -(pull * q[0]);
    dp[1] = -(pull * q[1]) - 1;
}

#ifdef GM_PASS_SCALAR
static void K(jacobian)(const double *y, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    const double stiffness = *(const double *)parameters;
    const double square = y[0] * y[0] + y[1] * y[1], r = sqrt(square);
    const double pull = stiffness * (1 - 1 / r), slope = stiffness / (square * r);
    memset(jacobian, 0, sizeof(double[GM_COMPONENTS][GM_COMPONENTS]));
    jacobian[0][2] = jacobian[1][3] = 1;
    jacobian[2][0] = -(pull + slope * y[0] * y[0]);
    jacobian[2][1] = jacobian[3][0] = -(slope * y[0] * y[1]);
    jacobian[3][1] = -(pull + slope * y[1] * y[1]);
}
#endif
