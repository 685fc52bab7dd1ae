/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_POLYNOMIAL_H
#define GM_CORE_THEORY_POLYNOMIAL_H

#include "core/theory/ball.h"

/* Polynomials, sum_k at[k] x^k. No result may have a higher degree than GM_POLYNOMIAL_DEGREE. */

enum { GM_POLYNOMIAL_DEGREE = 128 };

struct gm_polynomial {
    int degree; /* -1: zero */
    struct gm_ball at[GM_POLYNOMIAL_DEGREE + 1];
};

/* The constant. */
void gm_polynomial_set(struct gm_polynomial *p, struct gm_ball constant);
/* p := p + factor x^shift q */
void gm_polynomial_add(struct gm_polynomial *p, struct gm_ball factor, int shift,
                       const struct gm_polynomial *q);
/* p := p + factor q r */
void gm_polynomial_add_product(struct gm_polynomial *p, struct gm_ball factor, const struct gm_polynomial *q,
                               const struct gm_polynomial *r);
/* Sets coefficients that may vanish to 0, for polynomials whose structure implies it. */
void gm_polynomial_settle(struct gm_polynomial *p);
/* Returns the smallest x > 0 beyond which p is certainly negative: 0 if it is so from the start, INFINITY if it never
   is. A double zero, to the precision of the coefficients, does not count. */
double gm_polynomial_first_negative(const struct gm_polynomial *p);
/* Returns true if all zeros of p certainly have a negative real part, by Routh's scheme. */
bool gm_polynomial_is_hurwitz(const struct gm_polynomial *p);

#endif
