/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_FAMILIES_SPLITTING_LINEAR_FLOW_H
#define GM_CORE_ODE_FAMILIES_SPLITTING_LINEAR_FLOW_H

#include "core/tape.h"

/* The formulas of rates that are linear in the components that they move. */
struct gm_linear_flow {
    size_t n;
    gm_node_id *nodes;       /* the rates, n, and the slopes */
    struct gm_sparse slopes; /* d rates[row] / d y of the moving components, functions of the others */
    bool constant;           /* the rates are of degree 1: no slope holds a component */
};
/* Derives them from n rates; the graph grows. The arena owns them, and its body is left when out of memory.
   Returns false if the rates are not linear so. */
bool gm_linear_flow_derive(struct gm_arena *arena, struct gm_linear_flow *flow, struct gm_formula *graph,
                           const gm_node_id *rates, size_t n, size_t variables);
/* y := the flow over h, exact to round-off; NaN where the motion is too fast for its series. The tape is of the
   flow's nodes; `values` are those of its outputs, at y, and are overwritten, as is the scratch, 3 n numbers. */
void gm_linear_flow_advance(const struct gm_linear_flow *flow, double h, double *values, double *scratch,
                            double *y);

/* E := exp(A), of n * n by rows; A is destroyed, the scratch has n * n numbers. */
void gm_exponential(size_t n, double *A, double *E, double *scratch);

#endif
