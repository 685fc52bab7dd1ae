/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_POLYNOMIAL_H
#define GM_CORE_THEORY_POLYNOMIAL_H

#include "core/theory/ball.h"

/* Polynomials, sum_k at[k] x^k. */

enum { GM_POLYNOMIAL_DEGREE = 128 };

struct gm_polynomial {
    int degree; /* -1: zero */
    struct gm_ball at[GM_POLYNOMIAL_DEGREE + 1];
};

/* The constant. */
void gm_polynomial_set(struct gm_polynomial *p, struct gm_ball constant);
/* p := p + factor x^shift q; false where the degree is too high. */
bool gm_polynomial_add(struct gm_polynomial *p, struct gm_ball factor, int shift,
                       const struct gm_polynomial *q);
/* p := p + factor q r */
bool gm_polynomial_add_product(struct gm_polynomial *p, struct gm_ball factor, const struct gm_polynomial *q,
                               const struct gm_polynomial *r);
/* Takes coefficients that may vanish for zeros, where structure says that some are. */
void gm_polynomial_settle(struct gm_polynomial *p);
/* Where p, on x > 0, first becomes surely negative: 0 where it is so from the start, INFINITY where it never
   does. A zero that it only touches, within what is known of its coefficients, is no such place. */
double gm_polynomial_first_negative(const struct gm_polynomial *p);
/* Whether all zeros of p surely have a negative real part; Routh's scheme. */
bool gm_polynomial_is_hurwitz(const struct gm_polynomial *p);

#endif
