/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_FOURIER_H
#define GM_CORE_LINEAR_FOURIER_H

#include <stddef.h>

/* Discrete Fourier transforms of any length in a time proportional to count log(count), prime or not. */
struct gm_fourier;

/* Returns NULL when out of memory. */
struct gm_fourier *gm_fourier_open(size_t count);
void gm_fourier_close(struct gm_fourier *fourier);

/* Replace x by sum_j x_j exp(-2 pi i j k / count), and by the inverse, with the factor 1 / count. */
void gm_fourier_forward(struct gm_fourier *fourier, double _Complex *x);
void gm_fourier_inverse(struct gm_fourier *fourier, double _Complex *x);

#endif
