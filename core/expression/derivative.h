/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact derivatives, as further nodes of the same graph: a value and its slope share their common parts, so
   that exp' is exp. */
#ifndef GM_CORE_EXPRESSION_DERIVATIVE_H
#define GM_CORE_EXPRESSION_DERIVATIVE_H

#include "core/expression/graph.h"

/* All functions return false, or GM_NO_NODE, when out of memory (graph->failed is set, or an array is
   missing). */

/* The slope of a node when the variables move along a vector: direction[i] is the node of component i, i <
   variables; other variables rest. */
gm_node_id gm_derivative_along(struct gm_formula *graph, gm_node_id node, const gm_node_id *direction,
                               size_t variables);
/* Computes the derivatives of a node over all marked variables, or over all if `marked` is NULL, in one pass
   downwards: gradient[i] is that over variable i, a constant 0 for the others. */
bool gm_gradient(struct gm_formula *graph, gm_node_id node, const bool *marked, size_t variables,
                 gm_node_id *gradient);

/* The entries of a matrix of derivatives that are not identically 0, row by row. */
struct gm_sparse {
    struct gm_sparse_entry {
        size_t row, column;
        gm_node_id node;
    } * entries;
    size_t count;
};
#endif
