/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small complex matrices. The phi functions of a number follow from the exponential if that loses nothing,
   and of a matrix by Taylor's formula of z / 2^s, doubled s times:
       phi_k(2z) = 2^-k [phi_0(z) phi_k(z) + sum_{j=1..k} phi_j(z) / (k-j)!]
   M. Hochbruck & A. Ostermann, Acta Numerica 19 (2010) 209; B. Skaflestad & W.M. Wright, Appl. Numer. Math.
   59 (2009) 783. */
#include "core/linear/complex_matrix.h"

#include <complex.h>
#include <math.h>
#include <string.h>

enum { SIZE = GM_COMPLEX_LARGEST * GM_COMPLEX_LARGEST, TERMS = 20 };

static const double factorials[GM_PHI_MOST] = {1, 1, 2, 6};

#define ENTRY double complex
#define DIVIDE gm_cdivide
#define MAGNITUDE gm_cabs
#define ELIMINATE eliminate_columns
#include "core/functions/complex.h"
#include "core/linear/eliminate.loop.h"

bool gm_complex_eliminate(size_t n, double complex *a, double complex *r)
{
    return eliminate_columns(n, a, 1, r);
}

void gm_complex_multiply(size_t n, const double complex *a, const double complex *x, double complex *y)
{
    for (size_t i = 0; i < n; i++) {
        double complex sum = 0;
        for (size_t j = 0; j < n; j++) {
            sum += a[i * n + j] * x[j];
        }
        y[i] = sum;
    }
}

/* a b, which may not overlap with the result */
static void product(size_t n, const double complex *a, const double complex *b, double complex *result)
{
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            double complex sum = 0;
            for (size_t k = 0; k < n; k++) {
                sum += a[i * n + k] * b[k * n + j];
            }
            result[i * n + j] = sum;
        }
    }
}

/* The last by Taylor's formula, those before it by phi_(k-1) = z phi_k + 1/(k-1)!; |z| is below 1. */
static void by_taylor(size_t n, const double complex *z, size_t count, double complex *phi)
{
    const size_t size = n * n;
    double complex *last = phi + (count - 1) * size, term[SIZE], next[SIZE];
    double factor = 1 / factorials[count - 1];
    for (size_t i = 0; i < size; i++) {
        term[i] = last[i] = i % (n + 1) == 0 ? factor : 0;
    }
    for (size_t j = 0; j < TERMS; j++) {
        product(n, term, z, next);
        for (size_t i = 0; i < size; i++) {
            term[i] = next[i] / (double)(j + count);
            last[i] += term[i];
        }
    }
    for (size_t k = count - 1; k-- > 0;) {
        product(n, z, phi + (k + 1) * size, phi + k * size);
        for (size_t i = 0; i < n; i++) {
            phi[k * size + i * (n + 1)] += 1 / factorials[k];
        }
    }
}

static void twice(size_t n, size_t count, double complex *phi)
{
    const size_t size = n * n;
    double complex doubled[GM_PHI_MOST * SIZE];
    for (size_t k = 0; k < count; k++) {
        double complex *own = doubled + k * size;
        product(n, phi, phi + k * size, own);
        for (size_t j = 1; j <= k; j++) {
            for (size_t i = 0; i < size; i++) {
                own[i] += phi[j * size + i] / factorials[k - j];
            }
        }
        for (size_t i = 0; i < size; i++) {
            own[i] = ldexp(creal(own[i]), -(int)k) + I * ldexp(cimag(own[i]), -(int)k);
        }
    }
    memcpy(phi, doubled, count * size * sizeof *phi);
}

void gm_complex_phi(size_t n, const double complex *z, size_t count, double complex *phi)
{
    double norm = 0;
    for (size_t i = 0; i < n * n; i++) {
        norm += gm_cabs(z[i]);
    }
    if (n == 1 && norm >= 1) {
        phi[0] = gm_cexp(z[0]);
        for (size_t k = 1; k < count; k++) {
            phi[k] = gm_cdivide(phi[k - 1] - 1 / factorials[k - 1], z[0]);
        }
        return;
    }
    int halvings = 0;
    (void)frexp(norm, &halvings);
    halvings = halvings > 0 && isfinite(norm) ? halvings : 0;
    double complex part[SIZE];
    for (size_t i = 0; i < n * n; i++) {
        part[i] = z[i] * ldexp(1, -halvings);
    }
    by_taylor(n, part, count, phi);
    for (int i = 0; i < halvings; i++) {
        twice(n, count, phi);
    }
}
