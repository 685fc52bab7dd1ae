/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_THEORY_H
#define GM_CORE_THEORY_THEORY_H

#include "core/scheme.h"
#include "core/theory/coefficients.h"
#include "core/theory/stability.h"

/* The theory of a method from its coefficients: order conditions and structure. A condition fails if its residual is
   certainly not 0, given the precision of the written coefficients. */

enum { GM_CONDITION_TEXT = 96 };

struct gm_theory {
    bool known;     /* false: no coefficients, or out of memory; the other fields are not set */
    int order;      /* the order conditions hold up to this order */
    bool at_least;  /* higher orders were not checked */
    int at_most;    /* with at_least: a condition of a plain method fails above this order; 0: not known */
    int digits;     /* number of digits of the shortest decimal; 0: all is exact */
    int conditions; /* number of conditions that hold; of the next order, `failing` of `of` fail */
    int failing, of;
    char
        condition[GM_CONDITION_TEXT]; /* the tree of the condition with the largest residual; "": not known */
    double residual;                  /* sum_i b_i Phi_i - 1 / gamma of that tree */
    /* sqrt(sum ((sum_i b_i Phi_i - 1 / gamma) / sigma)^2) over the trees of the next order, times the number
       of evaluations in a step to the power of the order. It compares methods of equal order at equal cost.
       Prince & Dormand, J. Comput. Appl. Math. 7 (1981) 67. NaN if no condition fails. */
    double error_constant;
    bool symplectic, symmetric;
    /* All components of the state have the same coefficients; of a Nystrom method also if that is not known. */
    bool plain;
    /* The power of h up to which a plain method that is not symplectic has symplectic steps. A. Aubry &
       P. Chartier, BIT 38 (1998) 439. */
    int pseudo_symplectic;
    int b, c, d; /* simplifying assumptions B(b), C(c), D(d) of a plain method; Butcher (1964) */
    struct gm_theory_stability stability;
};

/* Opens the coefficients of a scheme in an arena's body; returns false without any. */
bool gm_scheme_coefficients_open(struct gm_arena *arena, const struct gm_scheme *scheme,
                                 struct gm_coefficients *coefficients);

/* Return true if the coefficients satisfy the conditions of symplecticity or symmetry, to their precision; in an
   arena's body. */
bool gm_theory_is_symplectic(struct gm_arena *arena, const struct gm_coefficients *coefficients);
bool gm_theory_is_symmetric(struct gm_arena *arena, const struct gm_coefficients *coefficients);

/* Returns the theory of coefficients, in an arena's body, which is left when out of memory. */
struct gm_theory gm_theory_of(struct gm_arena *arena, const struct gm_coefficients *coefficients);

/* Returns the *count residuals of the conditions of an order and of the claimed structure. The caller frees them;
   NULL when out of memory. */
struct gm_ball *gm_theory_residuals(const struct gm_coefficients *coefficients, int order, bool symplectic,
                                    bool symmetric, size_t *count);

#endif
