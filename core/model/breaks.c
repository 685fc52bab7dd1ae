/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A switch at g, whose mode s is the sign of g, is frozen with
       sign(x) = s    abs(x) = s x    heaviside(x) = 1 - [s < 0]    [a < b] = [s < 0], g = a - b
       min(a, b) = [a < b] a + (1 - [a < b]) b
   and one at the whole numbers of g, whose mode k is the one below, with
       floor(x) = k    ceil(x) = -k, g = -x    mod(a, b) = a - b k, g = a/b

   atan2(y, x) is smooth for the schemes, but its value jumps at g = y. */
#include "core/model/breaks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/expression/derivative.h"

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

bool gm_operation_jumps(enum gm_operation operation)
{
    return !gm_operation_rows[operation].smooth && operation > GM_VARIABLE && operation != GM_OPERATION_ABS &&
           operation != GM_OPERATION_MIN && operation != GM_OPERATION_MAX;
}

/* A switch at the zeros of g, or at its whole numbers, and what is compared on both sides of it. */
struct passage {
    struct gm_user_system *system;
    const gm_node_id *nodes, *direction, *gradient, *parts;
    size_t count, variables, part_count;
    gm_node_id g;
    bool whole;
    bool indirect; /* the operation itself does not jump, but abs(x)/x does, or atan(1/x) where x is 0 */
    double *point, *base, *unit; /* [variable_count]; the point of the switch, and the unit normal there */
    double *sides[2];            /* the values of all nodes on both sides */
};

static void evaluate(const struct passage *passage, double *values)
{
    gm_formula_evaluate_parts(&passage->system->graph, passage->parts, passage->part_count, passage->point,
                              values);
}

/* Moves a random point to the switch by Newton's method. Returns true if it is there. */
static bool find_point(const struct passage *passage, uint64_t seed)
{
    enum { MOST_MOVES = 60 };
    const struct gm_user_system *system = passage->system;
    const size_t count = system->variable_count;
    double target = NAN, *values = passage->sides[0];
    for (size_t i = 0; i < count; i++) {
        const bool parameter = i >= system->parameters && i < system->velocities;
        const uint64_t drawn = gm_mixed(seed ^ gm_mixed(i));
        passage->base[i] = parameter ? system->variables[i].value
                                     : ((double)(drawn >> 12) * 0x1p-52 * 4 - 2) * (seed % 4 == 3 ? 10 : 1);
    }
    for (int move = 0; move < MOST_MOVES; move++) {
        memcpy(passage->point, passage->base, count * sizeof(double));
        evaluate(passage, values);
        double square = 0;
        for (size_t i = 0; i < count; i++) {
            passage->unit[i] = values[passage->gradient[i]];
            square += passage->unit[i] * passage->unit[i];
        }
        target = !passage->whole ? 0 : isnan(target) ? round(values[passage->g]) : target;
        const double away = (values[passage->g] - target) / sqrt(square);
        if (!isfinite(away)) {
            return false;
        }
        double size = 1;
        for (size_t i = 0; i < count; i++) {
            passage->unit[i] /= sqrt(square);
            passage->base[i] -= away * passage->unit[i];
            size = fmax(size, passage->unit[i] == 0 ? 0 : fabs(passage->base[i]));
        }
        if (fabs(away) <= 1e-14 * size) {
            return true;
        }
    }
    return false;
}

/* The sum of the jumps over twice this distance, times the slopes of g; *size is what rounding is measured by. */
static double jump_over(const struct passage *passage, double distance, double *size)
{
    double sums[2] = {0};
    *size = 0;
    for (int side = 0; side < 2; side++) {
        for (size_t i = 0; i < passage->system->variable_count; i++) {
            passage->point[i] = passage->base[i] + (side ? distance : -distance) * passage->unit[i];
        }
        evaluate(passage, passage->sides[side]);
    }
    for (int side = 0; side < 2; side++) {
        double along = 0, speed = 0;
        for (size_t i = 0; passage->direction && i < passage->variables; i++) {
            const double part = passage->sides[side][passage->direction[i]] * passage->unit[i];
            along += part;
            speed += fabs(part);
        }
        for (size_t i = 0; i < passage->count; i++) {
            const double slope = passage->direction ? along : passage->unit[i],
                         below = passage->sides[0][passage->nodes[i]],
                         above = passage->sides[1][passage->nodes[i]];
            sums[side] += slope == 0 ? 0 : (above - below) * slope;
            *size += slope == 0 ? 0 : (fabs(above) + fabs(below)) * fmax(speed, fabs(slope));
        }
    }
    return fmax(fabs(sums[0]), fabs(sums[1]));
}

/* The values of a continuous formula differ less and less when the sides come nearer, also like a root. */
static enum gm_identity test_passage(const struct passage *passage)
{
    enum { TRIES = 64, TESTS = 8 };
    int tests = 0;
    for (uint64_t seed = 0; seed < TRIES && tests < TESTS; seed++) {
        double size;
        if (find_point(passage, seed)) {
            const double far = jump_over(passage, 1e-4, &size), near = jump_over(passage, 1e-9, &size);
            const bool pole = passage->indirect && near > 10 * far; /* which no motion passes */
            if (near > far / 10 + 1e-12 * size && !pole) {
                return GM_NOT_ZERO;
            }
            tests += isfinite(near) && isfinite(far);
        }
    }
    return passage->indirect ? GM_ZERO_PROVED : tests > 0 ? GM_ZERO_TESTED : GM_UNTESTED;
}

static bool is_node(struct gm_formula *graph, gm_node_id part, const void *node)
{
    (void)graph;
    return part == *(const gm_node_id *)node;
}

/* Returns true if the switch of a node rests by its formula: no direction moves its g. */
static bool rests(const struct passage *passage, gm_node_id jump)
{
    struct gm_formula *graph = &passage->system->graph;
    bool rest = true;
    if (passage->direction) {
        const gm_node_id rate =
            gm_derivative_along(graph, passage->g, passage->direction, passage->variables);
        return rate != GM_NO_NODE && gm_identity_of(graph, rate, NULL, 0) == GM_ZERO_PROVED;
    }
    for (size_t i = 0; i < passage->count && rest; i++) {
        rest = gm_is_constant(graph, passage->gradient[i], 0) ||
               gm_formula_first(graph, passage->nodes[i], is_node, &jump) == GM_NO_NODE;
    }
    return rest;
}

enum gm_identity gm_breaks_pass(struct gm_arena *arena, struct gm_user_system *system,
                                const gm_node_id *nodes, size_t count, const gm_node_id *direction,
                                size_t variables, gm_node_id *at)
{
    enum { MOST = 256 }; /* switches that are tested */
    struct gm_formula *graph = &system->graph;
    const size_t mark = gm_arena_mark(arena), all = system->variable_count;
    size_t part_count = 0, found = 0;
    const gm_node_id *parts =
        gm_arena_keep(arena, gm_formula_parts_of(graph, nodes, count, &part_count), free);
    gm_arena_need(arena, parts);
    gm_node_id jumps[MOST], *roots = gm_arena_take(arena, count + variables + all + 1, sizeof *roots);
    const bool *switches = NULL;
    bool *varying = gm_arena_take(arena, all, sizeof *varying);
    enum gm_identity worst = GM_ZERO_PROVED;
    bool turns = false; /* atan turns a pole into a jump */
    for (size_t k = 0; k < part_count; k++) {
        turns |= graph->nodes[parts[k]].operation == GM_OPERATION_ATAN;
    }
    for (size_t k = 0; k < part_count && found < MOST; k++) {
        const enum gm_operation operation = graph->nodes[parts[k]].operation;
        const bool angle = operation == GM_OPERATION_ATAN2 || (turns && operation == GM_OPERATION_DIVIDE);
        jumps[found] = parts[k];
        if (operation > GM_VARIABLE && !angle && !gm_operation_rows[operation].smooth) {
            switches = switches ? switches : gm_breaks_switches(arena, system);
            found += switches[parts[k]];
        }
        found += angle;
    }
    for (size_t i = 0; i < system->initial; i++) {
        varying[i] = i < system->parameters || i >= system->velocities;
    }
    memcpy(roots, nodes, count * sizeof *roots);
    if (direction) {
        memcpy(roots + count, direction, variables * sizeof *roots);
    }
    for (size_t k = 0; k < found && worst != GM_NOT_ZERO; k++) {
        const struct gm_node node = graph->nodes[jumps[k]];
        const bool quotient = node.operation == GM_OPERATION_DIVIDE;
        const size_t inner = gm_arena_mark(arena), given = count + (direction ? variables : 0);
        struct passage passage = {.system = system,
                                  .nodes = nodes,
                                  .count = count,
                                  .direction = direction,
                                  .variables = variables,
                                  .indirect = quotient || (node.operation != GM_OPERATION_ATAN2 &&
                                                           !gm_operation_jumps(node.operation)),
                                  .whole = node.operation == GM_OPERATION_FLOOR ||
                                           node.operation == GM_OPERATION_CEIL ||
                                           node.operation == GM_OPERATION_MOD};
        passage.g = node.operation == GM_OPERATION_MOD
                        ? gm_simplified(graph, GM_OPERATION_DIVIDE, node.a, node.b)
                    : quotient ? node.b
                    : node.operation == GM_OPERATION_BELOW || node.operation == GM_OPERATION_MIN ||
                            node.operation == GM_OPERATION_MAX
                        ? gm_difference(graph, node.a, node.b)
                        : node.a;
        passage.gradient = roots + given;
        gm_arena_need(arena, gm_gradient(graph, passage.g, varying, all, roots + given));
        roots[given + all] = passage.g;
        gm_arena_need(arena, !graph->failed);
        passage.parts = gm_arena_keep(
            arena, gm_formula_parts_of(graph, roots, given + all + 1, &passage.part_count), free);
        gm_arena_need(arena, passage.parts);
        passage.point = gm_arena_take(arena, 3 * all, sizeof(double));
        passage.base = passage.point + all;
        passage.unit = passage.base + all;
        for (int side = 0; side < 2; side++) {
            passage.sides[side] = gm_arena_take_unset(arena, graph->count, sizeof(double));
        }
        const enum gm_identity here = rests(&passage, jumps[k]) ? GM_ZERO_PROVED : test_passage(&passage);
        *at = here == GM_NOT_ZERO ? jumps[k] : *at;
        worst = here == GM_NOT_ZERO || here > worst ? here : worst;
        gm_arena_release(arena, inner);
    }
    gm_arena_release(arena, mark);
    return found == MOST && worst != GM_NOT_ZERO ? GM_UNTESTED : worst;
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
