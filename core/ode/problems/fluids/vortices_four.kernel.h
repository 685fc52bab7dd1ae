/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kirchhoff's equations of four point vortices of equal strength g in the plane, (x1..x4, y1..y4),
       x_i' = -(g/2 pi) sum_{j != i} (y_i - y_j)/r_ij^2
       y_i' =  (g/2 pi) sum_{j != i} (x_i - x_j)/r_ij^2
   g = *(const double *)parameters. Every pair is taken once. */
#define GM_COMPONENTS 8

/* Two pairs i < j in a register, for single runs alone: 01 and 23, 02 and 13, 03 and 12; so three divisions serve for
   six. */
GM_INLINE void K(field)(const real *state, real *f, const void *parameters)
{
    const double factor = *(const double *)parameters * 0.15915494309189533577; /* 1/(2 pi) */
    const gm_packed *at = (const gm_packed *)state;
    gm_packed *out = (gm_packed *)f;
    const gm_packed x01 = at[0], x23 = at[1], y01 = at[2], y23 = at[3];
    /* pulls u on x and v on y have the factor, which would else come after the sums */
    const gm_packed near_x = (gm_packed){x01[0], x23[0]} - (gm_packed){x01[1], x23[1]};
    const gm_packed near_y = (gm_packed){y01[0], y23[0]} - (gm_packed){y01[1], y23[1]};
    const gm_packed near = factor / (near_x * near_x + near_y * near_y);
    const gm_packed near_u = near_y * near, near_v = near_x * near;
    const gm_packed across_x = x01 - x23, across_y = y01 - y23;
    const gm_packed across = factor / (across_x * across_x + across_y * across_y);
    const gm_packed across_u = across_y * across, across_v = across_x * across;
    const gm_packed turned_x = x01 - (gm_packed){x23[1], x23[0]};
    const gm_packed turned_y = y01 - (gm_packed){y23[1], y23[0]};
    const gm_packed turned = factor / (turned_x * turned_x + turned_y * turned_y);
    const gm_packed turned_u = turned_y * turned, turned_v = turned_x * turned;
    out[0] = -(((gm_packed){near_u[0], -near_u[0]} + (gm_packed){across_u[0], turned_u[1]}) +
               (gm_packed){turned_u[0], across_u[1]});
    out[1] = ((gm_packed){across_u[0], turned_u[0]} + (gm_packed){turned_u[1], across_u[1]}) +
             (gm_packed){-near_u[1], near_u[1]};
    out[2] = ((gm_packed){near_v[0], turned_v[1]} + across_v) + (gm_packed){turned_v[0], -near_v[0]};
    out[3] = -(((gm_packed){across_v[0], turned_v[0]} + (gm_packed){turned_v[1], across_v[1]}) +
               (gm_packed){-near_v[1], near_v[1]});
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
            /* the derivative of the velocity (-dy, dx)/r^2 over (dx, dy): [a, b; b, -a] */
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
