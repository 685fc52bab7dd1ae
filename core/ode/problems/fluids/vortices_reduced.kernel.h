/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Four point vortices of equal strength g with z3 = -z1 and z4 = -z2 built in, (x1, x2, y1, y2),
       z1' = (g/2 pi) [F(z1 - z2) + F(2 z1) + F(z1 + z2)],   F(d) = (-d_y, d_x)/|d|^2
       z2' = (g/2 pi) [F(z2 - z1) + F(2 z2) + F(z1 + z2)]
   g = *(const double *)parameters. The symmetric orbit of all four may be unstable; this one cannot leave
   it. */
#define GM_COMPONENTS 4

/* Both vortices in a register, for single runs alone: so two divisions serve for four. */
GM_INLINE void K(field)(const real *state, real *f, const void *parameters)
{
    const double factor = *(const double *)parameters / (2 * 3.14159265358979323846);
    const gm_packed *at = (const gm_packed *)state;
    gm_packed *out = (gm_packed *)f;
    const gm_packed x = at[0], y = at[1];
    /* the distances from the other vortex, and from the one opposite to it */
    const gm_packed dx = {x[0] - x[1], x[0] + x[1]}, dy = {y[0] - y[1], y[0] + y[1]};
    const gm_packed turn = 1 / (dx * dx + dy * dy), own = 0.5 / (x * x + y * y);
    const gm_packed u = dy * turn, v = dx * turn;
    out[0] = -(factor * ((gm_packed){u[0], -u[0]} + y * own + (gm_packed){u[1], u[1]}));
    out[1] = factor * ((gm_packed){v[0], -v[0]} + x * own + (gm_packed){v[1], v[1]});
}

#ifdef GM_PASS_SCALAR
/* dF/dd = [a, b; b, -a] */
static void K(strain)(double dx, double dy, double factor, double ab[2])
{
    const double square = dx * dx + dy * dy;
    ab[0] = factor * 2 * dx * dy / (square * square);
    ab[1] = factor * (dy * dy - dx * dx) / (square * square);
}

static void K(jacobian)(const double *state, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    const double factor = *(const double *)parameters / (2 * 3.14159265358979323846);
    double near[2], far[2];
    K(strain)(state[0] - state[1], state[2] - state[3], factor, near);
    K(strain)(state[0] + state[1], state[2] + state[3], factor, far);
    for (int i = 0; i < 2; i++) {
        double own[2], by[2][2];
        K(strain)(2 * state[i], 2 * state[2 + i], factor, own);
        for (int k = 0; k < 2; k++) {
            by[i][k] = near[k] + 2 * own[k] + far[k];
            by[1 - i][k] = far[k] - near[k];
        }
        for (int j = 0; j < 2; j++) {
            jacobian[i][j] = by[j][0];
            jacobian[i][2 + j] = by[j][1];
            jacobian[2 + i][j] = by[j][1];
            jacobian[2 + i][2 + j] = -by[j][0];
        }
    }
}
#endif
