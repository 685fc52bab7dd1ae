/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/ode/trace_free.h"

#include <math.h>
#include <stdbool.h>

#include "core/functions/functions.h"

/* exp(h M) for M = [[a, b], [c, -a]]: cosh(w) 1 + sinh(w)/w h M with w^2 = h^2 (a^2 + b c). */
static void plane_flow(double a, double b, double c, double h, double flow[2][2])
{
    const double square = h * h * (a * a + b * c), w = sqrt(fabs(square));
    double cosine = square < 0 ? gm_cos(w) : gm_cosh(w), sine = h;
    if (w > 0) {
        sine *= (square < 0 ? gm_sin(w) : gm_sinh(w)) / w;
    }
    flow[0][0] = cosine + sine * a;
    flow[0][1] = sine * b;
    flow[1][0] = sine * c;
    flow[1][1] = cosine - sine * a;
}

void gm_trace_free_flow(const double a[9], size_t piece, double h, double *y, size_t m)
{
    const size_t j = piece, k = 1 - piece;
    const bool last = piece == 1;
    /* moving: (y_j, y_3); fixed: y_k, which drives them by (a_jk y_k, d y_k), d = a_3k in the last piece */
    const double own = a[4 * j], to_j = a[3 * j + 2], to_3 = last ? a[6 + j] : 0;
    double whole[2][2], half[2][2];
    plane_flow(own, to_j, to_3, h, whole);
    plane_flow(own, to_j, to_3, h / 2, half);
    const double drive_j = a[3 * j + k], drive_3 = last ? a[6 + k] : 0;
    /* int_0^h exp(s M) ds = (2/w) sinh(w h / 2) exp(h M / 2), for M^2 = w^2 times 1 */
    const double square = own * own + to_j * to_3, w = sqrt(fabs(square)) * h / 2;
    const double twice = h * (w != 0 ? (square < 0 ? gm_sin(w) : gm_sinh(w)) / w : 1);
    for (size_t i = 0; i < m; i++) {
        const double p = y[j * m + i], q = y[2 * m + i], s = y[k * m + i];
        const double f = drive_j * s, g = drive_3 * s;
        y[j * m + i] = whole[0][0] * p + whole[0][1] * q + twice * (half[0][0] * f + half[0][1] * g);
        y[2 * m + i] = whole[1][0] * p + whole[1][1] * q + twice * (half[1][0] * f + half[1][1] * g);
    }
}
