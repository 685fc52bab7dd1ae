/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lagrangians that are linear in the velocities, L = theta(q, t) . q' - H(q, t). Their equations are
       Omega q' = dH/dq + d theta/dt,   Omega_ij = d theta_j/d q_i - d theta_i/d q_j,
   those of a Poisson system with the bracket Omega^-1. It is written with Pfaffians, rows counted from 1 and i < j:
       (Omega^-1)_ij = (-1)^(i + j) pf(Omega without i and j) / pf(Omega),
       pf(Omega) = sum over j > 1 of (-1)^j Omega_1j pf(Omega without 1 and j),
   so that it has no value where Omega is singular, and there alone: an elimination would need pivots that vanish
   nowhere. J. E. Marsden & T. S. Ratiu (1999), 7; Pfaffians: L. Lovasz & M. D. Plummer, Matching Theory (1986), 8.3 */
#include "core/model/one_form.h"

#include <stdlib.h>
#include <string.h>

#include "core/expression/derivative.h"
#include "core/model/equations.h"

enum { MOST_COORDINATES = 64, MOST_PFAFFIANS = 4096 };

static bool *marks_of_velocities(struct gm_user_system *system, size_t count)
{
    bool *marked = gm_arena_take(system->arena, system->variable_count, sizeof *marked);
    memset(marked + system->velocities, true, count * sizeof *marked);
    return marked;
}

static void close_graph(void *graph)
{
    gm_formula_close(graph);
}

/* Works in a copy of the graph: the derivatives of another Lagrangian are left to its own equations. */
bool gm_one_form_is_in(struct gm_user_system *system)
{
    struct gm_arena *arena = system->arena;
    const size_t half = system->n / 2, count = system->variable_count, mark = gm_arena_mark(arena);
    const bool *marked = marks_of_velocities(system, half);
    const double *fixed = gm_arena_keep(arena, gm_equations_fixed(system), free);
    gm_node_id *slopes = gm_arena_take(arena, count + 1, sizeof *slopes),
               *second = gm_arena_take(arena, count + 1, sizeof *second);
    struct gm_formula *copy = gm_arena_take(arena, 1, sizeof *copy);
    gm_formula_open(copy);
    gm_arena_keep(arena, copy, close_graph);
    const gm_node_id root = gm_formula_graft(copy, &system->graph, system->energy, count, NULL);
    gm_arena_need(arena, root != GM_NO_NODE && gm_gradient(copy, root, marked, count, slopes));
    bool linear = true;
    for (size_t i = 0; i < half && linear; i++) {
        gm_arena_need(arena, gm_gradient(copy, slopes[system->velocities + i], marked, count, second));
        for (size_t k = i; k < half && linear; k++) {
            const gm_node_id node = second[system->velocities + k];
            linear =
                gm_is_constant(copy, node, 0) || gm_identity_of(copy, node, fixed, count) == GM_ZERO_PROVED;
        }
    }
    gm_arena_release(arena, mark);
    return linear;
}

/* Pfaffians of the rows and columns in a set, bit i for number i. */
struct pfaffians {
    struct gm_user_system *system;
    struct pfaffian {
        uint64_t set;
        gm_node_id value;
    } list[MOST_PFAFFIANS];
    size_t count;
};

static gm_node_id pfaffian_of(struct pfaffians *known, uint64_t set)
{
    struct gm_user_system *system = known->system;
    struct gm_formula *graph = &system->graph;
    if (set == 0) {
        return gm_formula_constant(graph, 1);
    }
    for (size_t i = 0; i < known->count; i++) {
        if (known->list[i].set == set) {
            return known->list[i].value;
        }
    }
    const size_t first = (size_t)__builtin_ctzll(set);
    const uint64_t others = set & (set - 1);
    gm_node_id sum = gm_formula_constant(graph, 0);
    bool negative = false;
    for (uint64_t left = others; left; left &= left - 1, negative = !negative) {
        const gm_node_id entry = system->omega[first * system->n + (size_t)__builtin_ctzll(left)];
        if (!gm_is_constant(graph, entry, 0)) {
            const gm_node_id minor = pfaffian_of(known, others & ~(left & -left)),
                             term = gm_product(graph, entry, minor);
            sum = negative ? gm_difference(graph, sum, term) : gm_sum(graph, sum, term);
        }
    }
    gm_system_refuse_if(
        system, known->count == MOST_PFAFFIANS, system->bracket_place,
        "the form of theta has too many entries: its inverse is written for about 12 coordinates "
        "that all depend on each other");
    known->list[known->count++] = (struct pfaffian){set, sum};
    return sum;
}

/* Ends runs where the Pfaffian changes sign, unless the file says where, and names it in printed formulas if it is
   long. */
static void watch_pfaffian(struct gm_user_system *system)
{
    const gm_node_id node = system->pfaffian;
    bool *marked = gm_arena_take(system->arena, system->variable_count, sizeof *marked);
    memset(marked, true, (system->n + 1) * sizeof *marked); /* coordinates and t */
    if (!gm_formula_holds(&system->graph, node, marked, system->variable_count)) {
        return;
    }
    if (!gm_system_item_of(system, GM_WORD_STOP, 0)) {
        const size_t count = system->item_count + 1;
        system->items = gm_arena_resize(system->arena, system->items, count, sizeof *system->items);
        struct gm_system_item *item = &system->items[system->item_count++];
        *item = (struct gm_system_item){.word = GM_WORD_STOP, .name = "", .place = system->bracket_place};
        item->nodes = gm_arena_take(system->arena, 1, sizeof *item->nodes);
        item->nodes[item->count++] = node;
    }
    if (system->n > 2 && node >= system->part_count) {
        system->parts =
            gm_arena_resize(system->arena, system->parts, node + (size_t)1, sizeof *system->parts);
        while (system->part_count <= node) {
            system->parts[system->part_count++] = NULL;
        }
        system->parts[node] = "Pf";
    }
}

/* bracket := Omega^-1 */
static void invert(struct gm_user_system *system)
{
    const size_t n = system->n;
    struct gm_formula *graph = &system->graph;
    struct pfaffians *known = gm_arena_take(system->arena, 1, sizeof *known);
    const uint64_t all = ~(uint64_t)0 >> (MOST_COORDINATES - n);
    known->system = system;
    system->pfaffian = pfaffian_of(known, all);
    const gm_node_id inverse =
        gm_simplified(graph, GM_OPERATION_DIVIDE, gm_formula_constant(graph, 1), system->pfaffian);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = i + 1; j < n; j++) {
            const gm_node_id minor = pfaffian_of(known, all & ~((uint64_t)1 << i | (uint64_t)1 << j)),
                             entry = gm_product(graph, minor, inverse), minus = gm_negative(graph, entry);
            const bool odd = (i + j) % 2 == 1;
            system->bracket[i * n + j] = odd ? minus : entry;
            system->bracket[j * n + i] = odd ? entry : minus;
        }
    }
}

void gm_one_form_derive(struct gm_user_system *system)
{
    struct gm_formula *graph = &system->graph;
    const size_t n = system->n, mark = gm_arena_mark(system->arena);
    const uint32_t place = gm_formula_origin(graph, system->energy);
    system->bracket_place = place == GM_NO_PLACE ? 0 : place;
    gm_system_refuse_if(
        system, n % 2 == 1, system->bracket_place,
        "L is linear in the velocities, and the form of theta is singular: %zu coordinate%s an odd "
        "number",
        n, n == 1 ? " is" : "s are");
    gm_system_refuse_if(system, n > MOST_COORDINATES, system->bracket_place,
                        "a Lagrangian that is linear in the velocities has at most %d coordinates",
                        MOST_COORDINATES);
    gm_node_id *rest = gm_system_no_nodes(system, system->variable_count);
    const gm_node_id *slopes = gm_equations_gradient(system, system->energy, marks_of_velocities(system, n));
    for (size_t i = 0; i < n; i++) {
        system->theta[i] = slopes[system->velocities + i];
        rest[system->velocities + i] = gm_formula_constant(graph, 0);
    }
    gm_arena_need(system->arena,
                  gm_formula_substitute(graph, system->theta, n, rest, system->variable_count) &&
                      gm_formula_substitute(graph, &system->energy, 1, rest, system->variable_count));
    system->energy = gm_negative(graph, system->energy);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            const gm_node_id ahead = gm_system_derivative(system, system->theta[j], i),
                             back = gm_system_derivative(system, system->theta[i], j);
            graph->origin = place;
            system->omega[i * n + j] = gm_difference(graph, ahead, back);
        }
    }
    graph->origin = place;
    invert(system);
    graph->origin = GM_NO_PLACE;
    gm_system_need_graph(system);
    gm_arena_release(system->arena, mark);
    watch_pfaffian(system);
}

void gm_one_form_replace_velocities(struct gm_user_system *system)
{
    const size_t n = system->n, count = system->variable_count, mark = gm_arena_mark(system->arena);
    const bool *marked = marks_of_velocities(system, n);
    gm_node_id *rates = gm_system_no_nodes(system, count);
    memcpy(rates + system->velocities, system->rates, n * sizeof *rates);
    for (size_t i = 0; i < system->item_count; i++) {
        for (size_t k = 0; k < system->items[i].count; k++) {
            gm_node_id *node = &system->items[i].nodes[k];
            if (*node != GM_NO_NODE && gm_formula_holds(&system->graph, *node, marked, count)) {
                gm_arena_need(system->arena, gm_formula_substitute(&system->graph, node, 1, rates, count));
            }
        }
    }
    gm_system_need_graph(system);
    gm_arena_release(system->arena, mark);
}
