/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_CHOLESKY_H
#define GM_CORE_LINEAR_CHOLESKY_H

#include <stdbool.h>
#include <stddef.h>

/* The Cholesky factor of a sparse symmetric positive definite matrix, by CHOLMOD (Chen, Davis, Hager &
   Rajamanickam, ACM Trans. Math. Softw. 35 (2008) 22). Solving
   allocates nothing, and its bits do not depend on a BLAS but through the factor's. */
struct gm_cholesky;

/* Opens the libraries on the first call. Returns NULL, or why they cannot be opened. Without them no matrix
   is factored. */
const char *gm_cholesky_missing(void);
/* Lets the libraries be missing from now on, for this reason: what they solve is refused, as on a machine without them. */
void gm_cholesky_do_without(const char *reason);

/* A rough factor is a preconditioner. It is stored in single precision or, if it is large and the solution
   loses little, in 16-bit integers. */
enum gm_cholesky_precision { GM_CHOLESKY_EXACT, GM_CHOLESKY_ROUGH };

/* Factors a matrix: row i has the columns column[k], start[i] <= k < start[i + 1], of which those above i are
   ignored. NULL when out of memory or not positive definite. */
struct gm_cholesky *gm_cholesky_open(size_t n, const int *start, const int *column, const double *value,
                                     enum gm_cholesky_precision precision);
void gm_cholesky_close(void *cholesky); /* for arenas too */
/* About the inverse of the condition number: the least of the factor's diagonal over the largest, squared. */
double gm_cholesky_condition(struct gm_cholesky *cholesky);
/* The numbers that an exact factor holds. */
size_t gm_cholesky_entries(const struct gm_cholesky *cholesky);
/* b, x: n; may be the same */
void gm_cholesky_solve(struct gm_cholesky *cholesky, const double *b, double *x);

/* The factors of a sparse matrix by LU (UMFPACK; Davis, ACM Trans. Math. Softw. 30 (2004) 196), rows as in
   gm_cholesky_open, with all columns. */
struct gm_lu;

/* The matrix outlives the factors. NULL when out of memory or, if `vanishing` is NULL, if it is singular; else that is
   the number of pivots that are round-off: the dimension of its kernel, if there is no smaller scale in the matrix. */
struct gm_lu *gm_lu_open(size_t n, const int *start, const int *column, const double *value,
                         size_t *vanishing);
void gm_lu_close(void *lu);                   /* for arenas too */
size_t gm_lu_entries(const struct gm_lu *lu); /* of both triangles */
/* Solves A x = b; allocates. False when out of memory. */
bool gm_lu_apply(const struct gm_lu *lu, const double *b, double *x);
/* The same once. False when out of memory or if A is singular. */
bool gm_lu_solve(size_t n, const int *start, const int *column, const double *value, const double *b,
                 double *x);

#endif
