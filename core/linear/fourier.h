/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_FOURIER_H
#define GM_CORE_LINEAR_FOURIER_H

#include <stdbool.h>
#include <stddef.h>

/* Discrete Fourier transforms of any length in a time proportional to count log(count), prime or not. */
struct gm_fourier;

/* Returns NULL when out of memory. */
struct gm_fourier *gm_fourier_open(size_t count);
void gm_fourier_close(void *fourier); /* for arenas too */

/* Replace x by sum_j x_j exp(-2 pi i j k / count), and by the inverse, with the factor 1 / count. */
void gm_fourier_forward(struct gm_fourier *fourier, double _Complex *x);
void gm_fourier_inverse(struct gm_fourier *fourier, double _Complex *x);

/* Real fields on a ring as sums of waves: [field * points + node] and [field * points + mode]. */
struct gm_modes {
    size_t points, fields;
    struct gm_real_fourier *fourier;
};

/* Returns false when out of memory; the caller closes it in both cases. */
bool gm_modes_open(struct gm_modes *modes, size_t points, size_t fields);
void gm_modes_close(void *modes); /* for arenas too */

/* The modes that are their own: 0 .. points / 2; the others are conjugates of these. */
static inline size_t gm_modes_half(size_t points)
{
    return points / 2 + 1;
}

/* sum_j y_j exp(-2 pi i j k / points) of every field, for the modes 0 .. points / 2; the others are not written */
void gm_modes_forward(const struct gm_modes *modes, const double *y, double _Complex *waves);
/* The inverse of gm_modes_forward, from modes 0 .. points / 2. */
void gm_modes_back(const struct gm_modes *modes, const double _Complex *waves, double *y);

#endif
