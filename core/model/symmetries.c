/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field a + A y is a symmetry of y' = f(y) if with some number c

       f'(y) (a + A y) - A f(y) = c f(y)   for all y.

   At random points these are linear equations for a, A and c, which are solved modulo a prime. P. J. Olver, Applications
   of Lie Groups to Differential Equations (1993), 2.3. */
#include "core/model/symmetries.h"

#include "core/model/elimination.h"

/* The equation of component k: the coefficients of a [n], A [n][n] and c. */
static void set_equation(gm_residue *row, size_t n, size_t k, const gm_residue *const point[3])
{
    const gm_residue *y = point[0], *f = point[1], *slope = point[2] + k * n; /* of f[k] */
    for (size_t i = 0; i < n; i++) {
        row[i] = slope[i];
        for (size_t j = 0; j < n; j++) {
            row[n + i * n + j] =
                gm_residue_plus(gm_residue_times(slope[i], y[j]), i == k ? gm_residue_minus(f[j]) : 0);
        }
    }
    row[n + n * n] = gm_residue_minus(f[k]);
}

/* a + A y */
static gm_node_id *write_field(struct gm_user_system *system, struct gm_arena *arena, const double *entries)
{
    struct gm_formula *graph = &system->graph;
    const size_t n = system->n;
    gm_node_id *field = gm_arena_take(arena, n, sizeof *field);
    for (size_t i = 0; i < n; i++) {
        field[i] = gm_formula_constant(graph, entries[i]);
        for (size_t j = 0; j < n; j++) {
            const gm_node_id factor = gm_formula_constant(graph, entries[n + i * n + j]);
            field[i] = gm_sum(graph, field[i], gm_product(graph, factor, gm_formula_variable(graph, j)));
        }
    }
    gm_arena_need(arena, !graph->failed);
    return field;
}

size_t gm_symmetries_find(struct gm_user_system *system, struct gm_arena *arena,
                          struct gm_symmetry **symmetries, size_t *unwritten)
{
    *unwritten = 0;
    const size_t n = system->n, unknowns = n + n * n + 1, points = 6 * n + 20, nodes = 2 * n + n * n;
    if (n > GM_MOST_WITH_SYMMETRIES) {
        return 0;
    }
    gm_node_id *wanted = gm_arena_take(arena, nodes, sizeof *wanted); /* y, f, f' */
    for (size_t i = 0; i < n; i++) {
        wanted[i] = gm_formula_variable(&system->graph, i);
        wanted[n + i] = system->rates[i];
        gm_gradient(&system->graph, system->rates[i], NULL, n, wanted + 2 * n + i * n);
    }
    struct gm_random_values random = gm_random_values_of(system, arena, wanted, nodes, 0);
    struct gm_echelon equations = gm_echelon_open(arena, unknowns);
    gm_residue *row = gm_arena_take(arena, unknowns + nodes, sizeof *row), *values = row + unknowns;
    const gm_residue *at = values;
    for (size_t p = 0; p < points && at; p++) {
        at = gm_random_values_next(&random);
        for (size_t i = 0; i < nodes && at; i++) {
            values[i] = at[wanted[i]];
        }
        for (size_t k = 0; k < n && at; k++) {
            set_equation(row, n, k, (const gm_residue *const[]){values, values + n, values + 2 * n});
            gm_echelon_add(&equations, row);
        }
    }
    size_t count = 0, found = 0;
    const struct gm_null_vector *basis = gm_echelon_null_space(&equations, &count);
    double *whole = gm_arena_take(arena, unknowns, sizeof *whole);
    *symmetries = gm_arena_take(arena, count + 1, sizeof **symmetries);
    for (size_t i = 0; i < count && at; i++) {
        const bool rest = basis[i].terms == 1 && basis[i].last == unknowns - 1; /* c alone, as f = 0 */
        if (rest) {
            continue;
        }
        if (!gm_residues_whole(basis[i].entries, unknowns, whole)) {
            ++*unwritten;
        } else {
            (*symmetries)[found++] =
                (struct gm_symmetry){write_field(system, arena, whole), whole[unknowns - 1]};
        }
    }
    return found;
}
