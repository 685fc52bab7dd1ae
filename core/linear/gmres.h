/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GMRES: systems whose matrix is known by what it does to a vector. */
#ifndef GM_CORE_LINEAR_GMRES_H
#define GM_CORE_LINEAR_GMRES_H

#include <stdbool.h>
#include <stddef.h>

enum { GM_GMRES_BASIS = 60, GM_GMRES_CYCLES = 4 };

/* A system A x = b with a preconditioner that nearly is A's inverse; it may be another one in every call. */
struct gm_system {
    size_t n;
    void (*apply)(void *data, const double *x, double *y);        /* y = A x */
    void (*precondition)(void *data, const double *x, double *y); /* y ~ A^-1 x */
    void *data;
};

/* Numbers of scratch that a system of n unknowns needs. */
size_t gm_gmres_scratch(size_t n);

/* Restarted flexible GMRES, preconditioned from the right (Saad, SIAM J. Sci. Comput. 14 (1993) 461), from
   x = 0 until |b - A x| <= small. Adds to *iterations; false if that is not reached. */
bool gm_gmres(const struct gm_system *system, const double *b, double *x, double small, double *scratch,
              unsigned long *iterations);

#endif
