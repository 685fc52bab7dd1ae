/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Affine symmetries that the equations of a system have. */
#ifndef GM_CORE_MODEL_SYMMETRIES_H
#define GM_CORE_MODEL_SYMMETRIES_H

#include "core/model/system.h"

enum { GM_MOST_WITH_SYMMETRIES = 20 /* components */ };

/* A field a + A y whose flow sends motions into motions, which become faster for c > 0. */
struct gm_symmetry {
    gm_node_id *field; /* [n], with whole coefficients, in the system's graph */
    double scaling;    /* c */
};

/* Finds a basis of the affine symmetries for the values of parameters, of a system of which gm_invariants_find lacks
   nothing. Returns their number, without the *unwritten ones, whose coefficients are not short fractions; 0 for too many
   components.
   Inside a body of the arena, which is left when out of memory. The graph grows. */
size_t gm_symmetries_find(struct gm_user_system *system, struct gm_arena *arena,
                          struct gm_symmetry **symmetries, size_t *unwritten);

#endif
