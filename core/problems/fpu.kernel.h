/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The chain of Fermi, Pasta & Ulam with three stiff springs, in the variables of Hairer, Lubich & Wanner
   (2006), I.5.1: (x, y, x', y'), x the displacements and y the scaled expansions of the stiff springs, H =
   (|x'|^2 + |y'|^2 + omega^2 |y|^2)/2 + sum_(i=0)^3 d_i^4/4, d_0 = x_1 - y_1,  d_i = x_(i+1) - y_(i+1) - x_i
   - y_i,  d_3 = x_3 + y_3, omega = *(const double *)parameters. */
#define GM_COMPONENTS 12
#define GM_SEPARABLE

GM_INLINE void K(velocity)(const real *p, real *dq, const void *parameters)
{
    (void)parameters;
    for (int c = 0; c < 6; c++) {
        dq[c] = p[c];
    }
}

GM_INLINE void K(force)(const real *q, real *dp, const void *parameters)
{
    const double omega = *(const double *)parameters;
    const real *x = q, *y = q + 3;
    const real d[4] = {x[0] - y[0], x[1] - y[1] - x[0] - y[0], x[2] - y[2] - x[1] - y[1], x[2] + y[2]};
    const real cubes[4] = {d[0] * d[0] * d[0], d[1] * d[1] * d[1], d[2] * d[2] * d[2], d[3] * d[3] * d[3]};
    dp[0] = cubes[1] - cubes[0];
    dp[1] = cubes[2] - cubes[1];
    dp[2] = -(cubes[3] + cubes[2]);
    dp[3] = cubes[0] + cubes[1] - omega * omega * y[0];
    dp[4] = cubes[1] + cubes[2] - omega * omega * y[1];
    dp[5] = cubes[2] - cubes[3] - omega * omega * y[2];
}

#ifdef GM_PASS_SCALAR
static void K(jacobian)(const double *state, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    const double omega = *(const double *)parameters;
    /* d_i = sum_c signs[i][c] q_c, V = sum d_i^4 / 4 */
    static const double signs[4][6] = {
        {1, 0, 0, -1, 0, 0}, {-1, 1, 0, -1, -1, 0}, {0, -1, 1, 0, -1, -1}, {0, 0, 1, 0, 0, 1}};
    memset(jacobian, 0, sizeof(double[GM_COMPONENTS][GM_COMPONENTS]));
    for (int i = 0; i < 4; i++) {
        double d = 0;
        for (int c = 0; c < 6; c++) {
            d += signs[i][c] * state[c];
        }
        for (int r = 0; r < 6; r++) {
            for (int c = 0; c < 6; c++) {
                jacobian[6 + r][c] -= 3 * d * d * signs[i][r] * signs[i][c];
            }
        }
    }
    for (int c = 0; c < 6; c++) {
        jacobian[c][6 + c] = 1;
        jacobian[6 + c][c] -= c >= 3 ? omega * omega : 0;
    }
}
#endif
