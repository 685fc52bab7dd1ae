/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A test whether a formula is identically 0. */
#ifndef GM_CORE_EXPRESSION_IDENTITY_H
#define GM_CORE_EXPRESSION_IDENTITY_H

#include "core/expression/graph.h"
#include "core/expression/residue.h"

enum gm_identity {
    GM_NOT_ZERO,
    GM_ZERO_PROVED, /* proved for all values of variables and parameters */
    GM_ZERO_TESTED, /* at random points, to rounding; or proved for the values that are fixed */
    GM_UNTESTED /* not finite at any tested point, not proved for all pieces of its formula, or out of memory */
};

/* The proof uses the field of the 2^61 - 1 residues (gm_residue_of): + - * / and whole powers are exact, roots are
   roots, and sin and cos, exp, sinh and cosh are points of their curves. A formula that is 0 at random points there is
   0; the probability of an error is below 1e-15 times the degree. Signs and roots have two values and take
   more points. If the proof fails it is tried where variable i < variables is fixed[i], unless that is NaN.
   A formula of known numbers, rational but for one root, that is not 0 there is refuted. For others doubles
   at 20 random points must be 0 to their rounding error. */
enum gm_identity gm_identity_of(const struct gm_formula *graph, gm_node_id node, const double *fixed,
                                size_t variables);

/* Values of some nodes at random points of that field, one point after the other. */
struct gm_random_values {
    const struct gm_formula *graph;
    const double *fixed; /* variable i < variables is fixed[i], unless that is NaN */
    size_t variables;
    uint64_t number;         /* of the next point */
    const gm_node_id *parts; /* [count] ascending nodes, which include all their operands */
    size_t count;
    gm_residue *values; /* [node], set for parts alone */
};
/* The values at the next point where they exist, values[node]; NULL: they exist at none of a thousand. */
const gm_residue *gm_random_values_next(struct gm_random_values *values);

#endif
