/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tapes that are made at first use: few schemes use all, and for a large system they take longer than all
   else. */
#ifndef GM_CORE_ODE_USER_LAZY_TAPE_H
#define GM_CORE_ODE_USER_LAZY_TAPE_H

#include <stdatomic.h>

#include "core/tape.h"

/* A tape of `count` nodes, the arguments of gm_tape_open; graph, nodes and values outlive it, and do not
   change. */
struct gm_late_tape {
    const struct gm_formula *graph;
    const gm_node_id *nodes;
    size_t count, inputs;
    const double *values;
    _Atomic(struct gm_tape *) tape; /* NULL: not yet */
};

/* Returns the tape, which the first thread makes. NULL: out of memory. */
const struct gm_tape *gm_late_tape(struct gm_late_tape *late);
/* The counterparts of gm_tape_values and gm_tape_block; NaN when out of memory. */
void gm_late_tape_values(struct gm_late_tape *late, const double *inputs, double *outputs, size_t m);
void gm_late_tape_block(struct gm_late_tape *late, const double *inputs, size_t inputs_apart, double *outputs,
                        size_t outputs_apart, size_t m);
void gm_late_tape_close(void *late); /* for arenas */

#endif
