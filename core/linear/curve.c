/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/linear/curve.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "core/functions/complex.h"

/* The trapezoidal rule on p times the derivative of the trigonometric polynomial through q, by Parseval's theorem
       sum_j p_j q'_j 2 pi / N = 2 pi sum_w i w q_w conj(p_w) = -4 pi sum_(w > 0) w im(q_w conj(p_w)),
   exact for curves of fewer than N / 2 waves. Of constant p exactly 0 is left. */
bool gm_curve_add_action(struct gm_fourier *fourier, const double *q, const double *p, size_t count,
                         struct gm_curve_action *sum)
{
    double complex *waves = malloc(2 * count * sizeof *waves);
    if (!waves) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        waves[i] = q[i] - q[0];
        waves[count + i] = p[i] - p[0];
    }
    gm_fourier_forward(fourier, waves);
    gm_fourier_forward(fourier, waves + count);
    double action = 0;
    for (size_t w = 1; 2 * w < count; w++) {
        const double complex share = waves[w] / (double)count * conj(waves[count + w]) / (double)count;
        const double factor = 4 * M_PI * (double)w, size = factor * gm_cabs(share);
        action -= factor * cimag(share);
        sum->waves += size;
        sum->short_waves += 4 * w >= count ? size : 0;
        sum->middle_waves += 4 * w < count && 8 * w >= count ? size : 0;
    }
    sum->action += action;
    sum->magnitude += fabs(action);
    free(waves);
    return true;
}

bool gm_curve_differentiate(double complex *points, size_t count)
{
    struct gm_fourier *fourier = gm_fourier_open(count);
    if (!fourier) {
        return false;
    }
    gm_fourier_forward(fourier, points);
    for (size_t k = 0; k < count; k++) {
        const double wave = 2 * k < count ? (double)k : (double)k - (double)count;
        points[k] *= 2 * k == count ? 0 : I * wave;
    }
    gm_fourier_inverse(fourier, points);
    gm_fourier_close(fourier);
    return true;
}
