/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_EXPRESSION_LINEAR_PART_H
#define GM_CORE_EXPRESSION_LINEAR_PART_H

#include "core/expression/graph.h"

struct gm_linear_split {
    gm_node_id line, rest;
};
/* Splits a node into line + rest, term by term of its sums. The line is linear in the variables marked in
   `fields`; its coefficients depend on no variable marked in `varying`, which includes the fields, so nothing
   of it cancels with the rest. A product with another field belongs to the rest. Returns false when out of
   memory. */
bool gm_linear_part(struct gm_formula *graph, gm_node_id node, const bool *fields, const bool *varying,
                    size_t variables, struct gm_linear_split *split);
/* True if a node is proved to be of degree 1 in the marked variables, for all values of the others: its second
   derivatives are 0. Works in a copy of the graph; out of memory sets graph->failed. */
bool gm_is_affine(struct gm_formula *graph, gm_node_id node, const bool *marked, size_t variables);

/* The largest skew matrix that is inverted. */
enum { GM_MOST_ROWS_OF_SKEW = 64 };

/* Writes the Pfaffian of a skew matrix of formulas, n * n by rows with an even n, and its inverse. Returns false if the
   matrix has too many entries: more than about 10 rows that all depend on each other; or when out of memory
   (graph->failed). */
bool gm_skew_inverse(struct gm_formula *graph, const gm_node_id *matrix, size_t n, gm_node_id *inverse,
                     gm_node_id *pfaffian);

#endif
