/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_THEORY_H
#define GM_CORE_THEORY_THEORY_H

#include "core/theory/coefficients.h"
#include "core/theory/stability.h"

/* What the coefficients of a method say of it, by order conditions and algebra. A condition fails where its
   residual is surely not 0: the coefficients are known as well as they are written. */

enum { GM_CONDITION_TEXT = 96 };

struct gm_theory {
    bool known;     /* false: out of memory, and nothing else is told */
    int order;      /* the order conditions hold up to here */
    bool at_least;  /* and no further ones were asked for */
    int at_most;    /* then: but for this order a condition of plain methods fails; 0: none is known */
    int digits;     /* to so many, of the decimals of which fewest are written; 0: all is exact */
    int conditions; /* so many hold; of the next order so many of how many fail */
    int failing, of;
    char condition[GM_CONDITION_TEXT]; /* the tree of the one that fails most; "": none is known */
    double residual;                   /* sum_i b_i Phi_i - 1 / gamma of it */
    /* sqrt(sum ((sum_i b_i Phi_i - 1 / gamma) / sigma)^2) over the trees of the next order, times the number
       of evaluations in a step to the power of the order: what methods of equal order, at equal cost, are
       compared by. Prince & Dormand, J. Comput. Appl. Math. 7 (1981) 67. NaN where none fails. */
    double error_constant;
    bool symplectic, symmetric;
    /* Of plain methods that are not symplectic: its steps are up to this power of h. A. Aubry & P. Chartier,
       BIT 38 (1998) 439. */
    int pseudo_symplectic;
    int b, c, d; /* of plain methods: the simplifying assumptions B(b), C(c), D(d); Butcher (1964) */
    struct gm_theory_stability stability;
};

/* Whether its coefficients satisfy the conditions of symplecticity, as far as they are known. */
bool gm_theory_is_symplectic(const struct gm_coefficients *coefficients);

struct gm_theory gm_theory_of(const struct gm_coefficients *coefficients);

/* What has to vanish for an order, and for what is claimed of structure. malloc'ed, how many; NULL: out of
   memory. */
struct gm_ball *gm_theory_residuals(const struct gm_coefficients *coefficients, int order, bool symplectic,
                                    bool symmetric, size_t *count);

#endif
