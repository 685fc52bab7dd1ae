/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GSL's transforms by small factors cost count * p for a prime factor p. Where p is large, by the chirp z
   transform: with jk = (j^2 + k^2 - (k - j)^2)/2,
       X_k = w_k sum_j (x_j w_j) conj(w_{k-j}),  w_j = exp(-i pi j^2 / count),
   a convolution, which two transforms by factors of 2 make. Bluestein, IEEE Trans. Audio Electroacoust. 18
   (1970) 451. */
#include "core/linear/fourier.h"

#include <complex.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include <gsl/gsl_fft_complex.h>

#include "core/functions/complex.h"
#include "core/functions/functions.h"
#include "core/memory.h"

/* Factors of GSL's above this cost more than the chirp. */
enum { LARGEST_FACTOR = 100 };

struct gm_fourier {
    size_t count;
    gsl_fft_complex_wavetable *table;
    gsl_fft_complex_workspace *space;
    size_t length;                    /* length of the convolution, a power of 2; 0: no convolution */
    double complex *chirp;            /* w, count of them */
    double complex *kernel, *scratch; /* the transform of conj(w); length */
};

static size_t largest_factor(size_t count)
{
    size_t largest = 1;
    for (size_t p = 2; p * p <= count; p++) {
        while (count % p == 0) {
            largest = p;
            count /= p;
        }
    }
    return count > largest ? count : largest;
}

/* Fills in the numbers of a table again, exp(-2 pi i m / n) in GSL's order: GSL's are the C
   library's, whose bits depend on the processor. */
static void put_turns(gsl_fft_complex_wavetable *table)
{
    size_t product = 1;
    gsl_complex *turn = table->trig;
    for (size_t f = 0; f < table->nf; f++) {
        const size_t before = product;
        product *= table->factor[f];
        for (size_t j = 1; j < table->factor[f]; j++) {
            for (size_t k = 1; k <= table->n / product; k++) {
                const double angle = -2 * M_PI / (double)table->n * (double)(j * k * before % table->n);
                GSL_SET_COMPLEX(turn, gm_cos(angle), gm_sin(angle));
                turn++;
            }
        }
    }
}

/* The tables of a length, with memory of GSL's. */
static bool make_tables(void *data)
{
    struct gm_fourier *fourier = data;
    const size_t length = fourier->length > 0 ? fourier->length : fourier->count;
    fourier->table = gsl_fft_complex_wavetable_alloc(length);
    fourier->space = gsl_fft_complex_workspace_alloc(length);
    return fourier->table && fourier->space;
}

static bool open_tables(struct gm_fourier *fourier)
{
    if (!gm_memory_guard_gsl(make_tables, fourier)) {
        return false;
    }
    put_turns(fourier->table);
    return true;
}

static void transform(struct gm_fourier *fourier, double complex *x)
{
    gsl_fft_complex_forward((double *)x, 1, fourier->length, fourier->table, fourier->space);
}

static struct gm_fourier *open_chirp(struct gm_fourier *fourier)
{
    const size_t count = fourier->count;
    size_t length = 1;
    while (length < 2 * count - 1) {
        length *= 2;
    }
    fourier->length = length;
    fourier->chirp = calloc(count + 2 * length, sizeof *fourier->chirp);
    if (!fourier->chirp || !open_tables(fourier)) {
        gm_fourier_close(fourier);
        return NULL;
    }
    fourier->kernel = fourier->chirp + count;
    fourier->scratch = fourier->kernel + length;
    for (size_t j = 0; j < count; j++) {
        /* the square in its period, so that no digit of the angle is lost */
        const uint64_t square = (uint64_t)j * j % (2 * (uint64_t)count);
        fourier->chirp[j] = gm_cexp(-I * (M_PI * (double)square / (double)count));
        fourier->kernel[j] = conj(fourier->chirp[j]);
        fourier->kernel[j ? length - j : 0] = fourier->kernel[j];
    }
    transform(fourier, fourier->kernel);
    return fourier;
}

struct gm_fourier *gm_fourier_open(size_t count)
{
    struct gm_fourier *fourier = calloc(1, sizeof *fourier);
    if (!fourier) {
        return NULL;
    }
    fourier->count = count;
    if (largest_factor(count) > LARGEST_FACTOR) {
        return open_chirp(fourier);
    }
    if (!open_tables(fourier)) {
        gm_fourier_close(fourier);
        return NULL;
    }
    return fourier;
}

void gm_fourier_close(void *transform)
{
    struct gm_fourier *fourier = transform;
    if (!fourier) {
        return;
    }
    gsl_fft_complex_wavetable_free(fourier->table);
    gsl_fft_complex_workspace_free(fourier->space);
    free(fourier->chirp);
    free(fourier);
}

void gm_fourier_forward(struct gm_fourier *fourier, double complex *x)
{
    const size_t count = fourier->count, length = fourier->length;
    if (length == 0) {
        gsl_fft_complex_forward((double *)x, 1, count, fourier->table, fourier->space);
        return;
    }
    double complex *y = fourier->scratch;
    for (size_t j = 0; j < length; j++) {
        y[j] = j < count ? x[j] * fourier->chirp[j] : 0;
    }
    transform(fourier, y);
    /* back by the conjugate of the transform of the conjugate */
    for (size_t j = 0; j < length; j++) {
        y[j] = conj(y[j] * fourier->kernel[j]);
    }
    transform(fourier, y);
    for (size_t k = 0; k < count; k++) {
        x[k] = conj(y[k]) / (double)length * fourier->chirp[k];
    }
}

void gm_fourier_inverse(struct gm_fourier *fourier, double complex *x)
{
    if (fourier->length == 0) {
        gsl_fft_complex_inverse((double *)x, 1, fourier->count, fourier->table, fourier->space);
        return;
    }
    for (size_t j = 0; j < fourier->count; j++) {
        x[j] = conj(x[j]);
    }
    gm_fourier_forward(fourier, x);
    for (size_t j = 0; j < fourier->count; j++) {
        x[j] = conj(x[j]) / (double)fourier->count;
    }
}

/* ---- real fields ---- */

bool gm_modes_open(struct gm_modes *modes, size_t points, size_t fields)
{
    *modes = (struct gm_modes){.points = points, .fields = fields, .fourier = gm_fourier_open(points)};
    return modes->fourier != NULL;
}

void gm_modes_close(void *modes)
{
    struct gm_modes *self = modes;
    gm_fourier_close(self->fourier);
    self->fourier = NULL;
}

void gm_modes_forward(const struct gm_modes *modes, const double *y, double complex *waves)
{
    for (size_t i = 0; i < modes->fields * modes->points; i++) {
        waves[i] = y[i];
    }
    for (size_t field = 0; field < modes->fields; field++) {
        gm_fourier_forward(modes->fourier, waves + field * modes->points);
    }
}

void gm_modes_back(const struct gm_modes *modes, double complex *waves, double *y)
{
    const size_t points = modes->points;
    for (size_t field = 0; field < modes->fields; field++) {
        double complex *own = waves + field * points;
        for (size_t k = gm_modes_half(points); k < points; k++) {
            own[k] = conj(own[points - k]);
        }
        gm_fourier_inverse(modes->fourier, own);
        for (size_t i = 0; i < points; i++) {
            y[field * points + i] = creal(own[i]);
        }
    }
}
