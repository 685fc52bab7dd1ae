/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A switch at g, whose mode s is the sign of g, is frozen with
       sign(x) = s    abs(x) = s x    heaviside(x) = 1 - [s < 0]    [a < b] = [s < 0], g = a - b
       min(a, b) = [a < b] a + (1 - [a < b]) b
   and one at the whole numbers of g, whose mode k is the one below, with
       floor(x) = k    ceil(x) = -k, g = -x    mod(a, b) = a - b k, g = a/b */
#include "core/model/breaks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"

const bool *gm_breaks_switches(struct gm_arena *arena, const struct gm_user_system *system)
{
    const struct gm_formula *graph = &system->graph;
    bool *varying = gm_arena_take(arena, system->variable_count, sizeof *varying);
    for (size_t i = 0; i < system->initial; i++) {
        varying[i] = i < system->parameters || i >= system->velocities;
    }
    bool *found = gm_arena_keep(arena, gm_formula_dependent(graph, varying, system->variable_count), free);
    for (gm_node_id i = 0; i < graph->count; i++) {
        const enum gm_operation operation = graph->nodes[i].operation;
        found[i] = found[i] && operation > GM_VARIABLE && !gm_operation_rows[operation].smooth;
    }
    return found;
}

/* The number of operations in the rates that are not smooth. */
static size_t count_switches(const struct gm_user_system *system)
{
    const size_t mark = gm_arena_mark(system->arena);
    const bool *switches = gm_breaks_switches(system->arena, system);
    size_t count = 0, found = 0;
    const gm_node_id *parts = gm_arena_keep(
        system->arena, gm_formula_parts_of(&system->graph, system->rates, system->n, &count), free);
    for (size_t k = 0; k < count; k++) {
        found += switches[parts[k]];
    }
    gm_arena_release(system->arena, mark);
    return found;
}

static bool can_be_located(const struct gm_user_system *system)
{
    bool free = true;
    for (size_t i = 0; i < system->velocities; i++) {
        free = free && strcmp(system->variables[i].name, GM_BREAKS_KEY) != 0;
    }
    return free && (system->kind == GM_CANONICAL || system->kind == GM_RATES) &&
           !gm_system_item_of(system, GM_WORD_CONSTRAINT, 0) && system->choices.count < GM_MOST_CHOICES;
}

void gm_breaks_declare(struct gm_user_system *system)
{
    static const char *const words[] = {"located", "ignored"};
    const size_t switches = can_be_located(system) ? count_switches(system) : 0;
    if (switches == 0 || switches > GM_MOST_BREAKS || gm_choice_named(&system->choices, GM_BREAKS_KEY)) {
        return;
    }
    struct gm_written_choice *choice = &system->choices.list[system->choices.count++];
    *choice = (struct gm_written_choice){
        .name = GM_BREAKS_KEY, .count = GM_COUNT(words), .chosen = system->ignores_breaks};
    for (size_t i = 0; i < GM_COUNT(words); i++) {
        snprintf(choice->words[i], sizeof choice->words[i], "%s", words[i]);
    }
}

/* Returns the variable with the mode of a switch, new if it is not known; GM_NO_NODE: it is not frozen. */
static gm_node_id mode_of(struct gm_freezing *freezing, gm_node_id surface, bool whole)
{
    struct gm_formula *graph = &freezing->system->graph;
    size_t i = 0;
    while (i < freezing->count &&
           (freezing->list[i].surface != surface || freezing->list[i].whole != whole)) {
        i++;
    }
    if (i == freezing->count) {
        freezing->full |= !freezing->closed && i == freezing->most;
        if (freezing->closed || freezing->full) {
            return GM_NO_NODE;
        }
        freezing->list[freezing->count++] =
            (struct gm_break){surface, freezing->system->variable_count++, whole, NULL};
    }
    return gm_formula_variable(graph, freezing->list[i].variable);
}

/* gm_rewriter */
static gm_node_id frozen(struct gm_formula *graph, gm_node_id node, gm_node_id a, gm_node_id b,
                         const void *data)
{
    struct gm_freezing *freezing = *(struct gm_freezing *const *)data;
    const enum gm_operation operation = graph->nodes[node].operation;
    if (operation <= GM_VARIABLE || gm_operation_rows[operation].smooth ||
        (node < freezing->node_count && !freezing->varying[node])) {
        return GM_NO_NODE;
    }
    const bool whole = operation == GM_OPERATION_FLOOR || operation == GM_OPERATION_CEIL ||
                       operation == GM_OPERATION_MOD,
               compares = operation == GM_OPERATION_BELOW || operation == GM_OPERATION_MIN ||
                          operation == GM_OPERATION_MAX;
    const gm_node_id zero = gm_formula_constant(graph, 0), one = gm_formula_constant(graph, 1),
                     x = operation == GM_OPERATION_CEIL  ? gm_formula_apply(graph, GM_OPERATION_NEGATE, a, a)
                         : operation == GM_OPERATION_MOD ? gm_formula_apply(graph, GM_OPERATION_DIVIDE, a, b)
                         : operation == GM_OPERATION_MAX ? b
                                                         : a,
                     y = !compares                       ? zero
                         : operation == GM_OPERATION_MAX ? a
                                                         : b;
    const bool turned = compares && (x == zero || (y != zero && y < x)); /* x < y and y < x are one switch */
    const gm_node_id low = turned ? y : x, high = turned ? x : y,
                     g = high == zero ? low : gm_formula_apply(graph, GM_OPERATION_SUBTRACT, low, high),
                     mode = mode_of(freezing, g, whole);
    if (mode == GM_NO_NODE) {
        return mode;
    }
    const gm_node_id below =
        gm_formula_apply(graph, GM_OPERATION_BELOW, turned ? zero : mode, turned ? mode : zero);
    const gm_node_id other = gm_formula_apply(graph, GM_OPERATION_SUBTRACT, one, below);
    switch (operation) {
    case GM_OPERATION_ABS:
        return gm_formula_apply(graph, GM_OPERATION_MULTIPLY, mode, a);
    case GM_OPERATION_HEAVISIDE:
        return other;
    case GM_OPERATION_BELOW:
        return below;
    case GM_OPERATION_CEIL:
        return gm_formula_apply(graph, GM_OPERATION_NEGATE, mode, mode);
    case GM_OPERATION_MOD:
        return gm_formula_apply(graph, GM_OPERATION_SUBTRACT, a,
                                gm_formula_apply(graph, GM_OPERATION_MULTIPLY, b, mode));
    case GM_OPERATION_MIN:
    case GM_OPERATION_MAX:
        return gm_formula_apply(graph, GM_OPERATION_ADD,
                                gm_formula_apply(graph, GM_OPERATION_CHOSEN, below, a),
                                gm_formula_apply(graph, GM_OPERATION_CHOSEN, other, b));
    default: /* sign, floor */
        return mode;
    }
}

void gm_breaks_freeze(struct gm_arena *arena, struct gm_freezing *freezing, gm_node_id *nodes, size_t count)
{
    struct gm_formula *graph = &freezing->system->graph;
    gm_node_id *given = gm_arena_take(arena, count + 1, sizeof *given);
    size_t known = 0;
    for (size_t i = 0; i < count; i++) {
        given[known] = nodes[i];
        known += nodes[i] != GM_NO_NODE;
    }
    gm_arena_need(arena, gm_formula_rewrite(graph, given, known, frozen, &freezing));
    for (size_t i = 0, k = 0; i < count; i++) {
        nodes[i] = nodes[i] != GM_NO_NODE ? given[k++] : nodes[i];
    }
}
