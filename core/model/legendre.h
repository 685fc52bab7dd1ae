/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Legendre transform by numbers: the velocities that belong to momenta. */
#ifndef GM_CORE_SYSTEM_LEGENDRE_H
#define GM_CORE_SYSTEM_LEGENDRE_H

#include <stdbool.h>
#include <stddef.h>

/* The mass matrix d2L/dv2 of order n, by rows, or its factors, by Gaussian elimination with partial
   pivoting. */
struct gm_mass {
    size_t n;
    double *entries; /* n * n */
    size_t *pivots;  /* n; the row that was exchanged for row i */
};
/* False: out of memory, nothing is held. */
bool gm_mass_open(struct gm_mass *mass, size_t n);
void gm_mass_close(struct gm_mass *mass);
/* The matrix becomes its factors; false where a pivot is 0, or `least` of the largest entry, or no number. */
bool gm_mass_factor(struct gm_mass *mass, double least);
/* x := M^-1 x (n), by the factors */
void gm_mass_solve(const struct gm_mass *factors, double *x);

/* p = dL/dv (n) and the mass matrix at v (n). */
typedef void gm_legendre_momenta(void *data, const double *v, double *p, struct gm_mass *mass);

/* Solves dL/dv = p for v by Newton's method from the v that is given, with shortened steps where a whole one
   leads further away. `linear`: L is quadratic in v, and one step is exact. The mass matrix is afterwards
   that at the solution, as its factors; room has 3 n numbers. False, with v not finite, where the matrix is
   singular or no v is found. */
bool gm_legendre_solve(size_t n, bool linear, gm_legendre_momenta *momenta, void *data, const double *p,
                       struct gm_mass *mass, double *scratch, double *v);

#endif
