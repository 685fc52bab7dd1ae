/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_EXPRESSION_PFAFFIAN_H
#define GM_CORE_EXPRESSION_PFAFFIAN_H

#include "core/expression/graph.h"

/* The largest skew matrix that is inverted. */
enum { GM_MOST_ROWS_OF_SKEW = 64 };

/* Writes the Pfaffian of a skew matrix of formulas, n * n by rows with an even n, and its inverse. Returns false if the
   matrix has too many entries: more than about 10 rows that all depend on each other; or when out of memory
   (graph->failed). */
bool gm_skew_inverse(struct gm_formula *graph, const gm_node_id *matrix, size_t n, gm_node_id *inverse,
                     gm_node_id *pfaffian);

#endif
