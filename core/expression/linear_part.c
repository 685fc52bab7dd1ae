/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The linear part of a formula, from the leaves upwards: sums, and products with constants. */
#include "core/expression/linear_part.h"

#include <math.h>
#include <stdlib.h>

#include "core/expression/derivative.h"
#include "core/expression/identity.h"

struct parts {
    gm_node_id line, rest;
};

static struct parts split(struct gm_formula *graph, gm_node_id node, const struct parts *of,
                          const bool *fields, const bool *constant)
{
    const struct gm_node made = graph->nodes[node];
    const gm_node_id zero = gm_formula_constant(graph, 0);
    const enum gm_operation operation = made.operation;
    const bool two = operation == GM_OPERATION_ADD || operation == GM_OPERATION_SUBTRACT ||
                     operation == GM_OPERATION_MULTIPLY || operation == GM_OPERATION_DIVIDE;
    const struct parts none = {zero, zero}, a = operation > GM_VARIABLE ? of[made.a] : none,
                       b = two ? of[made.b] : none;
    const bool by_right = operation == GM_OPERATION_MULTIPLY && constant[made.a],
               by_left = (operation == GM_OPERATION_MULTIPLY || operation == GM_OPERATION_DIVIDE) &&
                         constant[made.b];
    if (operation == GM_VARIABLE && fields[made.a]) {
        return (struct parts){node, zero};
    }
    if (operation == GM_OPERATION_ADD || operation == GM_OPERATION_SUBTRACT) {
        return (struct parts){gm_simplified(graph, operation, a.line, b.line),
                              gm_simplified(graph, operation, a.rest, b.rest)};
    }
    if (operation == GM_OPERATION_NEGATE) {
        return (struct parts){gm_simplified(graph, operation, a.line, a.line),
                              gm_simplified(graph, operation, a.rest, a.rest)};
    }
    if (operation > GM_VARIABLE && !constant[node] && (by_left || by_right)) {
        return by_left ? (struct parts){gm_simplified(graph, operation, a.line, made.b),
                                        gm_simplified(graph, operation, a.rest, made.b)}
                       : (struct parts){gm_simplified(graph, operation, made.a, b.line),
                                        gm_simplified(graph, operation, made.a, b.rest)};
    }
    return (struct parts){zero, node};
}

bool gm_linear_part(struct gm_formula *graph, gm_node_id node, const bool *fields, const bool *varying,
                    size_t variables, gm_node_id *line, gm_node_id *rest)
{
    const size_t known = graph->count;
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(graph, node, &count);
    struct parts *of = calloc(known, sizeof *of);
    bool *moves = gm_formula_dependent(graph, varying, variables);
    for (size_t i = 0; moves && i < known; i++) {
        moves[i] = !moves[i]; /* it now marks constants */
    }
    const bool good = parts && of && moves;
    for (size_t i = 0; good && i < count && !graph->failed; i++) {
        of[parts[i]] = split(graph, parts[i], of, fields, moves);
    }
    if (good && !graph->failed) {
        *line = of[node].line;
        *rest = of[node].rest;
    }
    free(parts);
    free(of);
    free(moves);
    return good && !graph->failed;
}

/* Tests the derivatives over marked variables of each derivative in `slopes`. */
static bool are_constant(struct gm_formula *graph, const gm_node_id *slopes, const bool *marked,
                         size_t variables)
{
    gm_node_id *second = malloc((variables + 1) * sizeof *second);
    graph->failed |= !second;
    bool constant = true;
    for (size_t i = 0; i < variables && constant && !graph->failed; i++) {
        if (marked[i] && gm_gradient(graph, slopes[i], marked, variables, second)) {
            for (size_t k = i; k < variables && constant; k++) {
                constant = !marked[k] || gm_is_constant(graph, second[k], 0) ||
                           gm_identity_of(graph, second[k], NULL, 0) == GM_ZERO_PROVED;
            }
        }
    }
    free(second);
    return constant;
}

bool gm_is_affine(struct gm_formula *graph, gm_node_id node, const bool *marked, size_t variables)
{
    struct gm_formula copy;
    gm_node_id *slopes = malloc((variables + 1) * sizeof *slopes);
    gm_formula_open(&copy);
    const gm_node_id root = gm_formula_graft(&copy, graph, node, variables, NULL);
    const bool opened = slopes && root != GM_NO_NODE && gm_gradient(&copy, root, marked, variables, slopes);
    const bool affine = opened && are_constant(&copy, slopes, marked, variables);
    graph->failed |= !opened || copy.failed;
    gm_formula_close(&copy);
    free(slopes);
    return affine;
}
