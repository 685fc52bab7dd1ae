/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two particles of masses 1 and 3 on a line, (q1, q2, p1, p2),
       H = p1^2/2 + p2^2/6 + d^2/2 + d^4/4 + a (q1^4 + q2^4)/4,   d = q1 - q2,
   a = *(const double *)parameters. Masses that differ catch a scheme that takes p for the velocity. */
#define GM_COMPONENTS 4
#define GM_SEPARABLE

GM_INLINE void K(velocity)(const real *p, real *dq, const void *parameters)
{
    (void)parameters;
    dq[0] = p[0];
    dq[1] = p[1] / 3;
}

GM_INLINE void K(force)(const real *q, real *dp, const void *parameters)
{
    const double well = *(const double *)parameters;
    const real d = q[0] - q[1];
    const real spring = d + d * d * d;
    dp[0] = -(spring + well * q[0] * q[0] * q[0]);
    dp[1] = spring - well * q[1] * q[1] * q[1];
}

#ifdef GM_PASS_SCALAR
static void K(jacobian)(const double *y, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    const double well = *(const double *)parameters;
    const double d = y[0] - y[1], stiffness = 1 + 3 * d * d;
    memset(jacobian, 0, sizeof(double[GM_COMPONENTS][GM_COMPONENTS]));
    jacobian[0][2] = 1;
    jacobian[1][3] = 1. / 3;
    jacobian[2][0] = -(stiffness + 3 * well * y[0] * y[0]);
    jacobian[2][1] = stiffness;
    jacobian[3][0] = stiffness;
    jacobian[3][1] = -(stiffness + 3 * well * y[1] * y[1]);
}
#endif
