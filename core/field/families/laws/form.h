/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_LAWS_FORM_H
#define GM_CORE_FIELD_FAMILIES_LAWS_FORM_H

#include "core/field/multisymplectic.h"

/* The laws of energy and momentum that follow from M s_t + K s_x = grad S(s) by the product with s_t and with
   s_x,
       d/dt [S - s' K s_x / 2] + d/dx [s' K s_t / 2] = 0
       d/dt [s' M s_x / 2] + d/dx [S - s' M s_t / 2] = 0
   and what is left of them on a grid where the state is s. A f = (f_i + f_{i+1})/2, D f = (f_{i+1} -
   f_i)/dx. */

/* The integrals of S(s) - s' K s_x / 2 and s' M s_x / 2 at the stages of the cells, with the slopes that
   the boxes have there: of one stage dx sum [S(A s) - (A s)' K D s / 2] and dx sum (A s)' M D s / 2.
   `memory` belongs to a run with the scheme, a row of gm_family_any_form. NaN if it is NULL, or when out
   of memory. */
double gm_form_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *memory);
double gm_form_momentum(const struct gm_problem *problem, const struct gm_scheme *scheme,
                        const double *memory);

/* Measures the residual of a law over the next step of the box, from the nodes y, in every cell,
       energy     [S(b) - S(a) - (b - a)' grad S((a + b)/2)] / dt    from a = A_x s^n to b = A_x s^{n+1}
       momentum   the same over dx                                   from a = A_t s_i to b = A_t s_{i+1}
   0 if S is quadratic. False if the scheme has another law, when out of memory or if the
   step fails. */
bool gm_form_laws(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                  const double *y, enum gm_local_law law, double *residual);

#endif
