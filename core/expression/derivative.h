/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact derivatives, as further nodes of the same graph: a value and its slope share what they have in
   common, so that exp' is exp. */
#ifndef GM_CORE_EXPRESSION_DERIVATIVE_H
#define GM_CORE_EXPRESSION_DERIVATIVE_H

#include "core/expression/graph.h"

/* All return false, or GM_NO_NODE, where memory was refused (graph->failed, or none for an array). */

/* The slope of a node when the variables move along a vector: direction[i] is the node of variable i's
   component, of those there are `variables`; others rest. */
gm_node_id gm_derivative_along(struct gm_formula *graph, gm_node_id node, const gm_node_id *direction,
                               size_t variables);
/* The derivative of a node over each of the variables that are marked, in one pass downwards: gradient[i] is
   the node of that over variable i, a constant 0 where there is none. */
bool gm_gradient(struct gm_formula *graph, gm_node_id node, const bool *marked, size_t variables,
                 gm_node_id *gradient);

/* Those entries of a matrix of derivatives that are not 0 whatever the variables are, row by row. */
struct gm_sparse {
    struct gm_sparse_entry {
        size_t row, column;
        gm_node_id node;
    } * entries;
    size_t count;
};
/* d nodes[row] / d variable: the Jacobian matrix; of the components of a gradient, the Hessian. To be freed
   by free(entries), in any case. */
bool gm_sparse_jacobian(struct gm_formula *graph, const gm_node_id *nodes, size_t rows, const bool *marked,
                        size_t variables, struct gm_sparse *jacobian);

#endif
