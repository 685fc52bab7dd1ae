/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A circulant band matrix is a polynomial in the shift z. Each of its linear factors is inverted by one
   recursion, forwards where the root lies inside the unit circle, backwards where it lies outside, so that
   rounding errors die out:
       (1 - r / z) f = b   f_i = b_i + r f_{i-1}
       (1 - r z) f = b     f_i = b_i + r f_{i+1}
   The recursion's start follows from the closed ring: a geometric sum, cut where it no longer
   counts.

   A band around a ring that is folded flat, 0, n - 1, 1, n - 2, ..., is a band of twice the width. */
#include "core/linear/ring/ring.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/functions/complex.h"
#include "core/functions/functions.h"

/* Returns the number of terms of 1 + r + r^2 + ... that count; all of them if |r| is 1, or rounded to it. */
static size_t terms(double magnitude, size_t count)
{
    if (magnitude < 1e-18) {
        return 1;
    }
    const double needed = magnitude < 1 ? ceil(-42 / gm_log(magnitude)) : INFINITY; /* e^-42 = 6e-19 */
    return needed < (double)count ? (size_t)needed : count;
}

struct gm_ring gm_ring_make(size_t count, double diagonal, double off)
{
    const double scale = (diagonal + sqrt((diagonal - 2 * off) * (diagonal + 2 * off))) / 2;
    return (struct gm_ring){.count = count, .scale = scale, .root = -off / scale};
}

void gm_ring_solve(const struct gm_ring *ring, double *b)
{
    const size_t n = ring->count;
    const double r = ring->root, over = 1 / ring->scale;
    if (r == 0) {
        for (size_t i = 0; i < n; i++) {
            b[i] *= over;
        }
        return;
    }
    const size_t reach = terms(fabs(r), n);
    const double closed = reach == n ? 1 / (1 - gm_pow(r, (double)n)) : 1;
    double before = 0;
    for (size_t i = n - reach; i < n; i++) {
        before = b[i] + r * before;
    }
    before *= closed;
    for (size_t i = 0; i < n; i++) {
        before = b[i] + r * before;
        b[i] = before;
    }
    double after = 0;
    for (size_t i = reach; i-- > 0;) {
        after = b[i] + r * after;
    }
    after *= closed;
    for (size_t i = n; i-- > 0;) {
        after = b[i] + r * after;
        b[i] = after * over;
    }
}

bool gm_ring_roots_make(struct gm_ring_roots *ring, size_t count, int power, double complex mean,
                        double complex difference, double h)
{
    /* ((1+z)/(z-1))^power = -ratio; with w one of the power-th roots, z = (w+1)/(w-1) */
    const double complex a = mean / gm_pow(2, power), d = difference / gm_pow(h, power);
    const double complex ratio = gm_cdivide(-d, a);
    *ring = (struct gm_ring_roots){.count = count, .scale = a + d, .number = power};
    const double size = gm_pow(gm_cabs(ratio), 1.0 / power);
    for (int k = 0; k < power; k++) {
        const double turn = (gm_carg(ratio) + 2 * M_PI * k) / power;
        const double complex w = size * (gm_cos(turn) + I * gm_sin(turn));
        const double distance = gm_cabs(w - 1);
        ring->roots[k] = gm_cdivide(w + 1, w - 1);
        if (!(distance > 1e-12) || !(fabs(gm_cabs(ring->roots[k]) - 1) > 1e-14)) {
            return false;
        }
    }
    return true;
}

/* x := b + r x */
static inline void fold(double *x_re, double *x_im, double r_re, double r_im, double b_re, double b_im)
{
    const double re = b_re + (r_re * *x_re - r_im * *x_im);
    *x_im = b_im + (r_re * *x_im + r_im * *x_re);
    *x_re = re;
}

void gm_ring_roots_solve(const struct gm_ring_roots *ring, double *re, double *im, double *scratch)
{
    const size_t n = ring->count;
    const double complex over = gm_cdivide(1, ring->scale);
    size_t shift = 0;
    double complex factor = over;
    for (int k = 0; k < ring->number; k++) {
        const bool inside = gm_cabs(ring->roots[k]) < 1;
        /* inside: (1 - root/z) z, forwards; outside: -root (1 - z/root), backwards */
        const double complex root = inside ? ring->roots[k] : gm_cdivide(1, ring->roots[k]);
        const double r_re = creal(root), r_im = cimag(root);
        const size_t reach = terms(gm_cabs(root), n);
        double complex closed = 1;
        if (reach == n) {
            closed = gm_cdivide(1, 1 - gm_cpow(root, (double)n));
        }
        double x_re = 0, x_im = 0;
        if (inside) {
            shift++;
            for (size_t i = n - reach; i < n; i++) {
                fold(&x_re, &x_im, r_re, r_im, re[i], im[i]);
            }
        } else {
            factor *= -root;
            for (size_t i = reach; i-- > 0;) {
                fold(&x_re, &x_im, r_re, r_im, re[i], im[i]);
            }
        }
        const double complex x = (x_re + I * x_im) * closed;
        x_re = creal(x);
        x_im = cimag(x);
        for (size_t i = 0; i < n; i++) {
            const size_t at = inside ? i : n - 1 - i;
            fold(&x_re, &x_im, r_re, r_im, re[at], im[at]);
            re[at] = x_re;
            im[at] = x_im;
        }
    }
    /* the rest: z^shift f = x, times the factor */
    memcpy(scratch, re, n * sizeof *re);
    memcpy(scratch + n, im, n * sizeof *im);
    const double f_re = creal(factor), f_im = cimag(factor);
    for (size_t i = 0; i < n; i++) {
        const size_t to = (i + shift) % n;
        re[to] = f_re * scratch[i] - f_im * scratch[n + i];
        im[to] = f_re * scratch[n + i] + f_im * scratch[i];
    }
}

bool gm_ring_band_open(struct gm_ring_band *band, size_t count, size_t parts, size_t reach)
{
    *band = (struct gm_ring_band){.count = count, .parts = parts};
    band->right = malloc(count * parts * sizeof *band->right);
    if (!band->right || !gm_banded_open(&band->folded, count * parts, (2 * reach + 1) * parts - 1)) {
        free(band->right);
        *band = (struct gm_ring_band){0};
        return false;
    }
    return true;
}

void gm_ring_band_close(void *data)
{
    struct gm_ring_band *band = data;
    gm_banded_close(&band->folded);
    free(band->right);
}

void gm_ring_band_clear(struct gm_ring_band *band)
{
    gm_banded_clear(&band->folded);
}

/* Returns the index of a point on the folded ring. */
static size_t folded_place(size_t point, size_t count)
{
    return 2 * point < count ? 2 * point : 2 * (count - 1 - point) + 1;
}

void gm_ring_band_add(struct gm_ring_band *band, size_t point, size_t row_part, long by, size_t column_part,
                      double value)
{
    const size_t n = band->count, at = by < 0 ? point + n - (size_t)-by % n : point + (size_t)by;
    gm_banded_add(&band->folded, folded_place(point, n) * band->parts + row_part,
                  folded_place(at % n, n) * band->parts + column_part, value);
}

bool gm_ring_band_factor(struct gm_ring_band *band)
{
    return gm_banded_factor(&band->folded);
}

void gm_ring_band_solve(struct gm_ring_band *band, double *b)
{
    const size_t n = band->count, parts = band->parts;
    for (size_t i = 0; i < n; i++) {
        for (size_t part = 0; part < parts; part++) {
            band->right[folded_place(i, n) * parts + part] = b[part * n + i];
        }
    }
    gm_banded_solve(&band->folded, band->right);
    for (size_t i = 0; i < n; i++) {
        for (size_t part = 0; part < parts; part++) {
            b[part * n + i] = band->right[folded_place(i, n) * parts + part];
        }
    }
}
