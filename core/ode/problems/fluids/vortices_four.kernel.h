/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kirchhoff's equations of four point vortices of equal strength g in the plane, (x1..x4, y1..y4),
       x_i' = -(g/2 pi) sum_{j != i} (y_i - y_j)/r_ij^2
       y_i' =  (g/2 pi) sum_{j != i} (x_i - x_j)/r_ij^2
   g = *(const double *)parameters. Every pair is taken once. */
#define GM_COMPONENTS 8

GM_INLINE void K(field)(const real *state, real *f, const void *parameters)
{
    const double factor = *(const double *)parameters * 0.15915494309189533577; /* 1/(2 pi) */
    const real *x = state, *y = state + 4;
    real pull_x[4][4], pull_y[4][4]; /* of pair i < j, with the factor: it would come after the sums */
#pragma GCC unroll 4
    for (int i = 0; i < 4; i++) {
#pragma GCC unroll 4
        for (int j = i + 1; j < 4; j++) {
            const real dx = x[i] - x[j], dy = y[i] - y[j];
            const real turn = factor / (dx * dx + dy * dy);
            pull_x[i][j] = dx * turn;
            pull_y[i][j] = dy * turn;
        }
    }
    f[0] = -((pull_y[0][1] + pull_y[0][2]) + pull_y[0][3]);
    f[1] = (pull_y[0][1] - pull_y[1][2]) - pull_y[1][3];
    f[2] = (pull_y[0][2] + pull_y[1][2]) - pull_y[2][3];
    f[3] = (pull_y[0][3] + pull_y[1][3]) + pull_y[2][3];
    f[4] = (pull_x[0][1] + pull_x[0][2]) + pull_x[0][3];
    f[5] = (pull_x[1][2] + pull_x[1][3]) - pull_x[0][1];
    f[6] = pull_x[2][3] - (pull_x[0][2] + pull_x[1][2]);
    f[7] = -((pull_x[0][3] + pull_x[1][3]) + pull_x[2][3]);
}

#ifdef GM_PASS_SCALAR
static void K(jacobian)(const double *state, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    const double factor = *(const double *)parameters / (2 * 3.14159265358979323846);
    memset(jacobian, 0, sizeof(double[GM_COMPONENTS][GM_COMPONENTS]));
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            if (j == i) {
                continue;
            }
            const double dx = state[i] - state[j], dy = state[4 + i] - state[4 + j];
            const double square = dx * dx + dy * dy;
            const double a = factor * 2 * dx * dy / (square * square);
            const double b = factor * (dy * dy - dx * dx) / (square * square);
            /* of the velocity (-dy, dx)/r^2 by (dx, dy): [a, b; b, -a] */
            for (int sign = 1; sign >= -1; sign -= 2) {
                const int by = sign > 0 ? i : j;
                jacobian[i][by] += sign * a;
                jacobian[i][4 + by] += sign * b;
                jacobian[4 + i][by] += sign * b;
                jacobian[4 + i][4 + by] -= sign * a;
            }
        }
    }
}
#endif
