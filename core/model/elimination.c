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

enum { TOGETHER = 8 }; /* products that are added with one reduction modulo the prime */

struct multiples {
    gm_residue factors[TOGETHER]; /* 0: none */
    const gm_residue *rows[TOGETHER];
};

static inline gm_residue with_multiples(const struct multiples *multiples, gm_residue entry, size_t column)
{
    gm_wide sum = entry;
    for (size_t k = 0; k < TOGETHER; k++) {
        sum += (gm_wide)multiples->factors[k] * multiples->rows[k][column];
    }
    return gm_residue_folded(sum);
}

size_t gm_echelon_reduce(const struct gm_echelon *echelon, gm_residue *row)
{
    struct multiples multiples;
    size_t c = 0;
    for (bool stopped = false; !stopped;) { /* rows wait for others */
        size_t count = 0;
        for (size_t k = 0; k < TOGETHER; k++) {
            multiples.factors[k] = 0;
            multiples.rows[k] = row;
        }
        for (; count < TOGETHER && !stopped; c += !stopped) {
            stopped = c == echelon->columns;
            if (!stopped) {
                row[c] = count ? with_multiples(&multiples, row[c], c) : row[c];
                stopped = row[c] && !echelon->rows[c];
            }
            if (!stopped && row[c]) {
                multiples.factors[count] = gm_residue_minus(row[c]);
                multiples.rows[count++] = echelon->rows[c];
                row[c] = 0;
            }
        }
        for (size_t i = c + stopped; i < echelon->columns && count; i++) {
            row[i] = with_multiples(&multiples, row[i], i);
        }
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
    const gm_residue factor = gm_residue_inverse(row[c]);
    for (size_t i = c; i < echelon->columns; i++) {
        rest[i] = gm_residue_times(factor, row[i]);
    }
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
            for (size_t i = c + 1; i <= last && echelon->rows[c];) {
                gm_wide part = sum;
                for (const size_t end = i + TOGETHER; i < end && i <= last; i++) {
                    part += (gm_wide)echelon->rows[c][i] * entries[i];
                }
                sum = gm_residue_folded(part);
            }
            entries[c] = gm_residue_minus(sum);
            terms += sum != 0;
        }
        basis[(*count)++] = (struct gm_null_vector){entries, last, terms};
    }
    return basis;
}
