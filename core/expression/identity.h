/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a formula is 0 whatever its variables are. */
#ifndef GM_CORE_EXPRESSION_IDENTITY_H
#define GM_CORE_EXPRESSION_IDENTITY_H

#include "core/expression/graph.h"

enum gm_identity {
    GM_NOT_ZERO,
    GM_ZERO_PROVED, /* for every value of variables and parameters */
    GM_ZERO_TESTED, /* at random points, to rounding */
    GM_UNTESTED     /* finite at none of the points that were tried, or no memory */
};

/* Proved by values in the field of the 2^61 - 1 residues, where + - * / and whole powers are exact, roots are
   roots, and sin and cos, exp, sinh and cosh are points of the curves that they run along: what is 0 at
   random points there is 0 (the odds of being wrong are below 1e-15 times the degree; of signs and roots, of
   which there are two, as many points are asked). Where that fails,
   doubles at 20 random points: 0 to 1e-12 of what was added up. Variables have random values, but in the
   latter those for which `fixed` holds a number; they are `variables`. */
enum gm_identity gm_identity_of(const struct gm_formula *graph, gm_node_id node, const double *fixed,
                                size_t variables);

#endif
