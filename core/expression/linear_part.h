/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_EXPRESSION_LINEAR_PART_H
#define GM_CORE_EXPRESSION_LINEAR_PART_H

#include "core/expression/graph.h"

/* Splits a node into line + rest, node for node of its sums: the line is linear in the variables that are marked
   in `fields`, and its coefficients hold none of those that are marked in `varying`, which are these and others;
   so nothing of it cancels with the rest. What stands in a product with another field is of the rest, whole.
   False: out of memory. */
bool gm_linear_part(struct gm_formula *graph, gm_node_id node, const bool *fields, const bool *varying,
                    size_t variables, gm_node_id *line, gm_node_id *rest);

#endif
