/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A test whether a formula is identically 0. */
#ifndef GM_CORE_EXPRESSION_IDENTITY_H
#define GM_CORE_EXPRESSION_IDENTITY_H

#include "core/expression/graph.h"
#include "core/linear/residue.h"

enum gm_identity {
    GM_NOT_ZERO,
    GM_ZERO_PROVED, /* proved for all values of variables and parameters */
    GM_ZERO_TESTED, /* tested at random points, to rounding */
    GM_UNTESTED     /* not finite at any tested point, or out of memory */
};

/* The proof uses the field of the 2^61 - 1 residues: + - * / and whole powers are exact, roots are roots, and
   sin and cos, exp, sinh and cosh are points of their curves. A formula that is 0 at random points there is
   0; the probability of an error is below 1e-15 times the degree. Signs and roots have two values and take
   more points. If the proof fails, doubles at 20 random points must be 0 to 1e-12 of the sum of magnitudes.
   Variables are random; in the second test variable i < variables is fixed[i], unless that is NaN. */
enum gm_identity gm_identity_of(const struct gm_formula *graph, gm_node_id node, const double *fixed,
                                size_t variables);

/* Random point `number` of that field; variable i < variables is fixed[i], unless that is NaN. */
struct gm_random_point {
    uint64_t number;
    const double *fixed;
    size_t variables;
};
/* The values of `count` ascending nodes, which include all their operands: values[node]. False: they do not exist at
   this point. */
bool gm_residues_at_random(const struct gm_formula *graph, const gm_node_id *parts, size_t count,
                           const struct gm_random_point *point, gm_residue *values);

#endif
