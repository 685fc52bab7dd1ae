/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The inverse of a skew matrix A of formulas by Pfaffians, rows counted from 1 and i < j:
       (A^-1)_ij = (-1)^(i + j) pf(A without i and j) / pf(A),
       pf(A) = sum over j > 1 of (-1)^j A_1j pf(A without 1 and j),   pf(A)^2 = det A.
   It has no value where A is singular, and there alone: an elimination would need pivots that vanish nowhere.
   D. E. Knuth, Electron. J. Combin. 3 (2) (1996) R5 */
#include "core/expression/pfaffian.h"

#include <stdint.h>
#include <stdlib.h>

enum { MOST = 1024 };

/* Pfaffians of the rows and columns in a set, bit i for row i + 1. */
struct pfaffians {
    struct gm_formula *graph;
    const gm_node_id *matrix;
    size_t n, count;
    struct pfaffian {
        uint64_t set;
        gm_node_id value;
    } list[MOST];
};

/* GM_NO_NODE if there are too many. */
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
    for (uint64_t left = others; left; left &= left - 1, negative = !negative) {
        const gm_node_id entry = known->matrix[first * known->n + (size_t)__builtin_ctzll(left)];
        if (gm_is_constant(graph, entry, 0)) {
            continue;
        }
        const gm_node_id minor = pfaffian_of(known, others & ~(left & -left));
        if (minor == GM_NO_NODE) {
            return minor;
        }
        const gm_node_id term = gm_product(graph, entry, minor);
        sum = negative ? gm_difference(graph, sum, term) : gm_sum(graph, sum, term);
    }
    if (known->count == MOST) {
        return GM_NO_NODE;
    }
    known->list[known->count++] = (struct pfaffian){set, sum};
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
    bool good = *pfaffian != GM_NO_NODE;
    const gm_node_id one = gm_formula_constant(graph, 1),
                     factor = good ? gm_simplified(graph, GM_OPERATION_DIVIDE, one, *pfaffian) : one;
    for (size_t i = 0; i < n; i++) {
        inverse[i * n + i] = gm_formula_constant(graph, 0);
        for (size_t j = i + 1; j < n && good; j++) {
            const gm_node_id minor = pfaffian_of(known, all & ~((uint64_t)1 << i | (uint64_t)1 << j));
            good = minor != GM_NO_NODE;
            if (good) {
                const bool odd = (i + j) % 2 == 1;
                const gm_node_id entry = gm_product(graph, minor, factor), minus = gm_negative(graph, entry);
                inverse[i * n + j] = odd ? minus : entry;
                inverse[j * n + i] = odd ? entry : minus;
            }
        }
    }
    free(known);
    return good && !graph->failed;
}
