/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas at random points of a prime field, and elimination there, in which rank and null space are exact. All
   functions that take memory are called inside a body of their arena. */
#ifndef GM_CORE_MODEL_ELIMINATION_H
#define GM_CORE_MODEL_ELIMINATION_H

#include "core/model/system.h"

/* Values of some nodes of the system's graph, for its values of parameters, from random point `first` on. */
struct gm_random_values gm_random_values_of(const struct gm_user_system *system, struct gm_arena *arena,
                                            const gm_node_id *nodes, size_t count, uint64_t first);

/* Rows in echelon form: rows[c] begins with a 1 in column c; NULL: no row begins there. */
struct gm_echelon {
    struct gm_arena *arena;
    size_t columns;
    gm_residue **rows;
};

struct gm_echelon gm_echelon_open(struct gm_arena *arena, size_t columns);
/* Subtracts multiples of the rows. Returns the column in which the rest begins; `columns`: the row is a combination of
   the others. */
size_t gm_echelon_reduce(const struct gm_echelon *echelon, gm_residue *row);
/* Reduces a row, and adds a copy of the rest. Returns false if nothing is left. */
bool gm_echelon_add(struct gm_echelon *echelon, gm_residue *row);

/* A vector that all rows send to 0; no other one of its basis has an entry at `last`. */
struct gm_null_vector {
    gm_residue *entries; /* [columns]; entry `last` is 1, later ones are 0 */
    size_t last, terms;  /* terms: entries that are not 0 */
};
/* A basis of the null space, [*count], by rising `last`. */
struct gm_null_vector *gm_echelon_null_space(const struct gm_echelon *echelon, size_t *count);

#endif
