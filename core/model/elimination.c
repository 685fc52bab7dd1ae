/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/model/elimination.h"

#include <stdlib.h>

#include "core/model/equations.h"

struct gm_random_values gm_random_values_of(const struct gm_user_system *system, struct gm_arena *arena,
                                            const gm_node_id *nodes, size_t count, uint64_t first)
{
    struct gm_random_values values = {.graph = &system->graph,
                                      .fixed = gm_arena_keep(arena, gm_equations_fixed(system), free),
                                      .variables = system->variable_count,
                                      .number = first};
    gm_arena_need(arena, !system->graph.failed);
    values.parts =
        gm_arena_keep(arena, gm_formula_parts_of(&system->graph, nodes, count, &values.count), free);
    values.values = gm_arena_take(arena, system->graph.count, sizeof *values.values);
    return values;
}

struct gm_echelon gm_echelon_open(struct gm_arena *arena, size_t columns)
{
    struct gm_echelon echelon = {arena, columns, NULL};
    echelon.rows = gm_arena_take(arena, columns + 1, sizeof(gm_residue *));
    return echelon;
}

/* row += factor * other, from column `first` on */
static void add_multiple(gm_residue *row, gm_residue factor, const gm_residue *other, size_t first,
                         size_t columns)
{
    for (size_t i = first; i < columns; i++) {
        row[i] = gm_residue_fused(factor, other[i], row[i]);
    }
}

size_t gm_echelon_reduce(const struct gm_echelon *echelon, gm_residue *row)
{
    size_t c = 0;
    while (c < echelon->columns && (!row[c] || echelon->rows[c])) {
        if (row[c]) {
            add_multiple(row, gm_residue_minus(row[c]), echelon->rows[c], c, echelon->columns);
        }
        c++;
    }
    return c;
}

bool gm_echelon_add(struct gm_echelon *echelon, gm_residue *row)
{
    const size_t c = gm_echelon_reduce(echelon, row);
    if (c == echelon->columns) {
        return false;
    }
    gm_residue *rest = gm_arena_take(echelon->arena, echelon->columns, sizeof *rest);
    add_multiple(rest, gm_residue_inverse(row[c]), row, c, echelon->columns);
    echelon->rows[c] = rest;
    return true;
}

struct gm_null_vector *gm_echelon_null_space(const struct gm_echelon *echelon, size_t *count)
{
    struct gm_null_vector *basis = gm_arena_take(echelon->arena, echelon->columns + 1, sizeof *basis);
    *count = 0;
    for (size_t last = 0; last < echelon->columns; last++) {
        if (echelon->rows[last]) {
            continue;
        }
        gm_residue *entries = gm_arena_take(echelon->arena, echelon->columns, sizeof *entries);
        size_t terms = 1;
        entries[last] = 1;
        for (size_t c = last; c-- > 0;) {
            gm_residue sum = 0;
            for (size_t i = c + 1; i <= last && echelon->rows[c]; i++) {
                sum = gm_residue_fused(echelon->rows[c][i], entries[i], sum);
            }
            entries[c] = gm_residue_minus(sum);
            terms += sum != 0;
        }
        basis[(*count)++] = (struct gm_null_vector){entries, last, terms};
    }
    return basis;
}
