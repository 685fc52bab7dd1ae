/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/linear/curve.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "core/linear/fourier.h"

/* The trapezoidal rule, which on a closed curve converges faster than any power of `count`. A chord is the
   mean derivative at its ends times a length that is exact for every ellipse. If this differs by a hundredth
   of the curve's length, the area of a pendulum's disc of 8 and more points has an error of 1e-6. */
double gm_curve_area(const double complex *points, const double complex *derivatives, size_t count)
{
    const double most = 0.01, step = 2 * M_PI / (double)count, chord = tan(step / 2);
    double sum = 0, length = 0, apart = 0;
    for (size_t i = 0; i < count; i++) {
        const size_t next = i + 1 < count ? i + 1 : 0;
        const double complex along = points[next] - points[i];
        sum += cimag(conj(points[i]) * derivatives[i]);
        length += cabs(along);
        apart += cabs(along - chord * (derivatives[i] + derivatives[next]));
    }
    return apart <= most * length ? sum * step / 2 : NAN;
}

/* The trapezoidal rule on p times the derivative of the trigonometric polynomial through q, by Parseval's theorem
       sum_j p_j q'_j 2 pi / N = 2 pi sum_w i w q_w conj(p_w) = -4 pi sum_(w > 0) w im(q_w conj(p_w)),
   exact for curves of fewer than N / 2 waves. Of constant p exactly 0 is left. */
bool gm_curve_add_loop(const double *q, const double *p, size_t count, struct gm_loop *loop)
{
    double complex *waves = malloc(2 * count * sizeof *waves);
    struct gm_fourier *fourier = waves ? gm_fourier_open(count) : NULL;
    if (!fourier) {
        free(waves);
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        waves[i] = q[i] - q[0];
        waves[count + i] = p[i] - p[0];
    }
    gm_fourier_forward(fourier, waves);
    gm_fourier_forward(fourier, waves + count);
    gm_fourier_close(fourier);
    double action = 0;
    for (size_t w = 1; 2 * w < count; w++) {
        const double complex share = waves[w] / (double)count * conj(waves[count + w]) / (double)count;
        const double factor = 4 * M_PI * (double)w, size = factor * cabs(share);
        action -= factor * cimag(share);
        loop->waves += size;
        loop->short_waves += 4 * w >= count ? size : 0;
    }
    loop->action += action;
    loop->magnitude += fabs(action);
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
