/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A switch at g, of sign s, is frozen with
       sign(x) = s    abs(x) = s x    heaviside(x) = 1 - [s < 0]    [a < b] = [s < 0], g = a - b
       min(a, b) = [a < b] a + (1 - [a < b]) b
   which are the same bits where g has that sign. */
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

/* The number of operations in the rates that are not smooth; floor, ceil and mod jump more than once, and g with them,
   and count as too many. */
static size_t count_switches(const struct gm_user_system *system)
{
    const size_t mark = gm_arena_mark(system->arena);
    const bool *switches = gm_breaks_switches(system->arena, system);
    size_t count = 0, found = 0;
    const gm_node_id *parts = gm_arena_keep(
        system->arena, gm_formula_parts_of(&system->graph, system->rates, system->n, &count), free);
    for (size_t k = 0; k < count; k++) {
        const enum gm_operation operation = system->graph.nodes[parts[k]].operation;
        const bool jumps_often = operation == GM_OPERATION_FLOOR || operation == GM_OPERATION_CEIL ||
                                 operation == GM_OPERATION_MOD;
        found += !switches[parts[k]] ? 0 : jumps_often ? GM_MOST_BREAKS + 1 : 1;
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

static gm_node_id applied(struct gm_formula *graph, enum gm_operation operation, gm_node_id a, gm_node_id b)
{
    return gm_formula_apply(graph, operation, a, b);
}

/* The variable that freezes a switch, new if it is not known; GM_NO_NODE: it is not frozen. */
static gm_node_id frozen_at(struct gm_freezing *freezing, gm_node_id surface)
{
    struct gm_formula *graph = &freezing->system->graph;
    for (size_t i = 0; i < freezing->count; i++) {
        if (freezing->list[i].surface == surface) {
            return gm_formula_variable(graph, freezing->list[i].variable);
        }
    }
    freezing->full |= !freezing->closed && freezing->count == GM_MOST_BREAKS;
    if (freezing->closed || freezing->full) {
        return GM_NO_NODE;
    }
    struct gm_break *new = &freezing->list[freezing->count++];
    *new = (struct gm_break){surface, freezing->system->variable_count++};
    return gm_formula_variable(graph, new->variable);
}

/* [a < b] */
static gm_node_id frozen_below(struct gm_freezing *freezing, gm_node_id a, gm_node_id b)
{
    struct gm_formula *graph = &freezing->system->graph;
    const gm_node_id zero = gm_formula_constant(graph, 0);
    const bool turned = a == zero || (b != zero && b < a);
    const gm_node_id low = turned ? b : a, high = turned ? a : b,
                     sign = frozen_at(freezing,
                                      high == zero ? low : applied(graph, GM_OPERATION_SUBTRACT, low, high));
    return sign == GM_NO_NODE
               ? sign
               : applied(graph, GM_OPERATION_BELOW, turned ? zero : sign, turned ? sign : zero);
}

/* c a + (1 - c) b */
static gm_node_id chosen(struct gm_formula *graph, gm_node_id c, gm_node_id a, gm_node_id b)
{
    const gm_node_id other = applied(graph, GM_OPERATION_SUBTRACT, gm_formula_constant(graph, 1), c);
    return applied(graph, GM_OPERATION_ADD, applied(graph, GM_OPERATION_CHOSEN, c, a),
                   applied(graph, GM_OPERATION_CHOSEN, other, b));
}

/* gm_rewriter */
static gm_node_id frozen(struct gm_formula *graph, gm_node_id node, gm_node_id a, gm_node_id b,
                         const void *data)
{
    struct gm_freezing *freezing = *(struct gm_freezing *const *)data;
    const struct gm_node here = graph->nodes[node];
    if (here.operation <= GM_VARIABLE || gm_operation_rows[here.operation].smooth ||
        (node < freezing->node_count && !freezing->varying[node])) {
        return GM_NO_NODE;
    }
    const gm_node_id one = gm_formula_constant(graph, 1);
    gm_node_id held = GM_NO_NODE;
    switch (here.operation) {
    case GM_OPERATION_SIGN:
    case GM_OPERATION_ABS:
        held = frozen_at(freezing, here.a);
        return held == GM_NO_NODE || here.operation == GM_OPERATION_SIGN
                   ? held
                   : applied(graph, GM_OPERATION_MULTIPLY, held, a);
    case GM_OPERATION_HEAVISIDE:
        held = frozen_below(freezing, here.a, gm_formula_constant(graph, 0));
        return held == GM_NO_NODE ? held : applied(graph, GM_OPERATION_SUBTRACT, one, held);
    case GM_OPERATION_BELOW:
        return frozen_below(freezing, here.a, here.b);
    case GM_OPERATION_MIN:
        held = frozen_below(freezing, here.a, here.b);
        return held == GM_NO_NODE ? held : chosen(graph, held, a, b);
    case GM_OPERATION_MAX:
        held = frozen_below(freezing, here.b, here.a);
        return held == GM_NO_NODE ? held : chosen(graph, held, a, b);
    default: /* floor, ceil and mod in formulas that are not rates */
        return GM_NO_NODE;
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
