/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The linear part of a formula, from the leaves upwards: sums, and products with constants; and skew matrices of
   formulas. */
#include "core/expression/linear_part.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "core/expression/derivative.h"
#include "core/expression/identity.h"

static struct gm_linear_split split_of(struct gm_formula *graph, gm_node_id node,
                                       const struct gm_linear_split *of, const bool *fields,
                                       const bool *constant)
{
    const struct gm_node made = graph->nodes[node];
    const gm_node_id zero = gm_formula_constant(graph, 0);
    const enum gm_operation operation = made.operation;
    const bool two = operation == GM_OPERATION_ADD || operation == GM_OPERATION_SUBTRACT ||
                     operation == GM_OPERATION_MULTIPLY || operation == GM_OPERATION_DIVIDE;
    const struct gm_linear_split none = {zero, zero}, a = operation > GM_VARIABLE ? of[made.a] : none,
                                 b = two ? of[made.b] : none;
    const bool by_right = operation == GM_OPERATION_MULTIPLY && constant[made.a],
               by_left = (operation == GM_OPERATION_MULTIPLY || operation == GM_OPERATION_DIVIDE) &&
                         constant[made.b];
    if (operation == GM_VARIABLE && fields[made.a]) {
        return (struct gm_linear_split){node, zero};
    }
    if (operation == GM_OPERATION_ADD || operation == GM_OPERATION_SUBTRACT) {
        return (struct gm_linear_split){gm_simplified(graph, operation, a.line, b.line),
                                        gm_simplified(graph, operation, a.rest, b.rest)};
    }
    if (operation == GM_OPERATION_NEGATE) {
        return (struct gm_linear_split){gm_simplified(graph, operation, a.line, a.line),
                                        gm_simplified(graph, operation, a.rest, a.rest)};
    }
    if (operation > GM_VARIABLE && !constant[node] && (by_left || by_right)) {
        return by_left ? (struct gm_linear_split){gm_simplified(graph, operation, a.line, made.b),
                                                  gm_simplified(graph, operation, a.rest, made.b)}
                       : (struct gm_linear_split){gm_simplified(graph, operation, made.a, b.line),
                                                  gm_simplified(graph, operation, made.a, b.rest)};
    }
    return (struct gm_linear_split){zero, node};
}

bool gm_linear_part(struct gm_formula *graph, gm_node_id node, const bool *fields, const bool *varying,
                    size_t variables, struct gm_linear_split *split)
{
    const size_t known = graph->count;
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(graph, node, &count);
    struct gm_linear_split *of = calloc(known, sizeof *of);
    bool *moves = gm_formula_dependent(graph, varying, variables);
    for (size_t i = 0; moves && i < known; i++) {
        moves[i] = !moves[i]; /* it now marks constants */
    }
    graph->failed |= !parts || !of || !moves;
    for (size_t i = 0; i < count && !graph->failed; i++) {
        of[parts[i]] = split_of(graph, parts[i], of, fields, moves);
    }
    if (!graph->failed) {
        *split = of[node];
    }
    free(parts);
    free(of);
    free(moves);
    return !graph->failed;
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

/* The inverse of a skew matrix A of formulas by Pfaffians, rows counted from 1 and i < j:
       (A^-1)_ij = (-1)^(i + j) pf(A without i and j) / pf(A),
       pf(A) = sum over j > 1 of (-1)^j A_1j pf(A without 1 and j),   pf(A)^2 = det A.
   It has no value where A is singular, and there alone: an elimination would need pivots that vanish nowhere.
   D. E. Knuth, Electron. J. Combin. 3 (2) (1996) R5 */
enum { MOST = 1024 }; /* Pfaffians of sets of rows */

/* Pfaffians of the rows and columns in a set, bit i for row i + 1. */
struct pfaffians {
    struct gm_formula *graph;
    const gm_node_id *matrix;
    size_t n, count;
    bool full; /* there are too many: values have no meaning */
    struct pfaffian {
        uint64_t set;
        gm_node_id value;
    } list[MOST];
};

static gm_node_id pfaffian_of(struct pfaffians *known, uint64_t set)
{
    struct gm_formula *graph = known->graph;
    for (size_t i = 0; i < known->count; i++) {
        if (known->list[i].set == set) {
            return known->list[i].value;
        }
    }
    const size_t first = set ? (size_t)__builtin_ctzll(set) : 0;
    const uint64_t others = set & (set - 1);
    gm_node_id sum = gm_formula_constant(graph, set == 0);
    bool negative = false;
    for (uint64_t left = others; left && !known->full; left &= left - 1, negative = !negative) {
        const gm_node_id entry = known->matrix[first * known->n + (size_t)__builtin_ctzll(left)];
        if (gm_is_constant(graph, entry, 0)) {
            continue;
        }
        const gm_node_id term = gm_product(graph, entry, pfaffian_of(known, others & ~(left & -left)));
        sum = negative ? gm_difference(graph, sum, term) : gm_sum(graph, sum, term);
    }
    known->full |= known->count == MOST;
    if (!known->full) {
        known->list[known->count++] = (struct pfaffian){set, sum};
    }
    return sum;
}

bool gm_skew_inverse(struct gm_formula *graph, const gm_node_id *matrix, size_t n, gm_node_id *inverse,
                     gm_node_id *pfaffian)
{
    struct pfaffians *known = malloc(sizeof *known);
    const uint64_t all = ~(uint64_t)0 >> (GM_MOST_ROWS_OF_SKEW - n);
    graph->failed |= !known;
    if (!known) {
        return false;
    }
    *known = (struct pfaffians){.graph = graph, .matrix = matrix, .n = n};
    *pfaffian = pfaffian_of(known, all);
    const gm_node_id one = gm_formula_constant(graph, 1),
                     factor = gm_simplified(graph, GM_OPERATION_DIVIDE, one, *pfaffian);
    for (size_t i = 0; i < n; i++) {
        inverse[i * n + i] = gm_formula_constant(graph, 0);
        for (size_t j = i + 1; j < n && !known->full; j++) {
            const gm_node_id minor = pfaffian_of(known, all & ~((uint64_t)1 << i | (uint64_t)1 << j)),
                             entry = gm_product(graph, minor, factor), minus = gm_negative(graph, entry);
            const bool odd = (i + j) % 2 == 1;
            inverse[i * n + j] = odd ? minus : entry;
            inverse[j * n + i] = odd ? entry : minus;
        }
    }
    const bool whole = !known->full && !graph->failed;
    free(known);
    return whole;
}
