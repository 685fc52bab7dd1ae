/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The chain of Fermi, Pasta & Ulam with GM_SPRINGS = m stiff springs, three unless said otherwise, in the
   variables of Hairer, Lubich & Wanner (2006), I.5.1: (x, y, x', y'), x the displacements and y the scaled
   expansions of the stiff springs,
       H   = (|x'|^2 + |y'|^2 + omega^2 |y|^2)/2 + sum_{i=0}^m d_i^4/4
       d_0 = x_1 - y_1,   d_i = x_{i+1} - y_{i+1} - x_i - y_i,   d_m = x_m + y_m
   omega = *(const double *)parameters. */
#ifndef GM_SPRINGS
#define GM_SPRINGS 3
#endif
#define GM_COMPONENTS (4 * GM_SPRINGS)
#define GM_SEPARABLE

GM_INLINE void K(velocity)(const real *p, real *dq, const void *parameters)
{
    (void)parameters;
    for (int c = 0; c < 2 * GM_SPRINGS; c++) {
        dq[c] = p[c];
    }
}

GM_INLINE void K(force)(const real *q, real *dp, const void *parameters)
{
    const double omega = *(const double *)parameters;
    const real *x = q, *y = q + GM_SPRINGS;
    real cubes[GM_SPRINGS + 1];
#pragma GCC unroll 8
    for (int i = 0; i <= GM_SPRINGS; i++) {
        const real d = i == 0            ? x[0] - y[0]
                       : i == GM_SPRINGS ? x[i - 1] + y[i - 1]
                                         : x[i] - y[i] - x[i - 1] - y[i - 1];
        cubes[i] = d * d * d;
    }
#pragma GCC unroll 8
    for (int i = 0; i < GM_SPRINGS; i++) {
        const bool last = i == GM_SPRINGS - 1; /* the last wall pushes back */
        dp[i] = last ? -(cubes[i + 1] + cubes[i]) : cubes[i + 1] - cubes[i];
        dp[GM_SPRINGS + i] =
            (last ? cubes[i] - cubes[i + 1] : cubes[i] + cubes[i + 1]) - omega * omega * y[i];
    }
}

#ifdef GM_PASS_SCALAR
static void K(jacobian)(const double *state, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    enum { HALF = 2 * GM_SPRINGS };
    const double omega = *(const double *)parameters;
    memset(jacobian, 0, sizeof(double[GM_COMPONENTS][GM_COMPONENTS]));
    for (int i = 0; i <= GM_SPRINGS; i++) {
        double signs[HALF] = {0}, d = 0; /* d_i = sum_c signs[c] q_c, V = sum d_i^4 / 4 */
        if (i < GM_SPRINGS) {
            signs[i] = 1;
            signs[GM_SPRINGS + i] = -1;
        }
        if (i > 0) {
            signs[i - 1] = i < GM_SPRINGS ? -1 : 1;
            signs[GM_SPRINGS + i - 1] = i < GM_SPRINGS ? -1 : 1;
        }
        for (int c = 0; c < HALF; c++) {
            d += signs[c] * state[c];
        }
        for (int r = 0; r < HALF; r++) {
            for (int c = 0; c < HALF; c++) {
                jacobian[HALF + r][c] -= 3 * d * d * signs[r] * signs[c];
            }
        }
    }
    for (int c = 0; c < HALF; c++) {
        jacobian[c][HALF + c] = 1;
        jacobian[HALF + c][c] -= c >= GM_SPRINGS ? omega * omega : 0;
    }
}
#endif
