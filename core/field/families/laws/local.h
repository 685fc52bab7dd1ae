/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_LAWS_LOCAL_H
#define GM_CORE_FIELD_FAMILIES_LAWS_LOCAL_H

#include "core/field/multisymplectic.h"

/* Measures the residual of a local law of the scheme: of a box over a step in every cell, the next one, or of a wave the last
   one,
       energy     [S(b) - S(a) - (b - a)' grad S((a + b)/2)] / dt    from a = A_x s^n to b = A_x s^{n+1}
       momentum   the same over dx                                   from a = A_t s_i to b = A_t s_{i+1}
       A f = (f_i + f_{i+1})/2
   which is 0 if S is quadratic and else of second order, and round-off for mass or charge; of two-step schemes for waves at
   every node. Returns false if the scheme has no such law, when out of memory or if the step fails. */
bool gm_local_laws(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                   const double *y, enum gm_local_law law, double *residual);

#endif
