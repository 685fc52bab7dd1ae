/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plane Kepler problem, (q1, q2, p1, p2),
       H = |p|^2/2 - 1/|q|,   with GM_PERTURBED H - e/|q|^2,   e = *(const double *)parameters. */
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
    const real square = q[0] * q[0] + q[1] * q[1];
    const real inverse = 1 / square; /* beside the root, not after it */
    real pull = K(root)(square) * (inverse * inverse);
#ifdef GM_PERTURBED
    pull += 2 * *(const double *)parameters * (inverse * inverse);
#else
    (void)parameters;
#endif
    dp[0] = -(pull * q[0]);
    dp[1] = -(pull * q[1]);
}

#ifdef GM_PASS_SCALAR
static void K(jacobian)(const double *y, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    const double square = y[0] * y[0] + y[1] * y[1], r = sqrt(square);
    double pull = 1 / (square * r), slope = 3 / (square * square * r); /* slope = -pull'(r) / r */
#ifdef GM_PERTURBED
    const double strength = 2 * *(const double *)parameters;
    pull += strength / (square * square);
    slope += 4 * strength / (square * square * square);
#else
    (void)parameters;
#endif
    memset(jacobian, 0, sizeof(double[GM_COMPONENTS][GM_COMPONENTS]));
    jacobian[0][2] = jacobian[1][3] = 1;
    jacobian[2][0] = slope * y[0] * y[0] - pull;
    jacobian[2][1] = jacobian[3][0] = slope * y[0] * y[1];
    jacobian[3][1] = slope * y[1] * y[1] - pull;
}
#endif
