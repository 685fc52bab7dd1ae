/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The graph of a formula: every node once, constants folded by the C library of this machine, derivatives
   simplified. */
#include "core/expression/graph.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/residue.h"

const struct gm_operation_row gm_operation_rows[GM_OPERATIONS] = {
#define GM_OPERATION(constant, name, latex, arity, smooth, value, over_a, over_b)                            \
    [GM_OPERATION_##constant] = {name, latex, arity, smooth, #value, {over_a, over_b}},
#include "core/expression/operations.def"
#undef GM_OPERATION
};

struct gm_exact_value {
    gm_residue residue;
    bool known; /* false: of a pseudorandom residue */
};

double gm_operation_value(enum gm_operation operation, double a, double b)
{
    switch (operation) {
#define GM_OPERATION(constant, name, latex, arity, smooth, value, over_a, over_b)                            \
    case GM_OPERATION_##constant:                                                                            \
        return value;
#include "core/expression/operations.def"
#undef GM_OPERATION
    case GM_CONSTANT:
    case GM_VARIABLE:
    case GM_OPERATIONS:
        break;
    }
    return NAN;
}

gm_residue gm_rational_residue(enum gm_operation operation, gm_residue a, gm_residue b, double exponent,
                               bool *exists)
{
    const bool reciprocal = operation == GM_OPERATION_WHOLE_POWER && exponent < 0;
    *exists &= operation == GM_OPERATION_DIVIDE ? b != 0 : !reciprocal || a != 0;
    switch (operation) {
    case GM_OPERATION_ADD:
        return gm_residue_plus(a, b);
    case GM_OPERATION_SUBTRACT:
        return gm_residue_plus(a, gm_residue_minus(b));
    case GM_OPERATION_MULTIPLY:
        return gm_residue_times(a, b);
    case GM_OPERATION_DIVIDE:
        return gm_residue_times(a, gm_residue_inverse(b));
    case GM_OPERATION_NEGATE:
        return gm_residue_minus(a);
    default:
        return gm_residue_power(reciprocal ? gm_residue_inverse(a) : a, (uint64_t)fabs(exponent));
    }
}

void gm_formula_open(struct gm_formula *graph)
{
    *graph = (struct gm_formula){.place = GM_NO_PLACE, .origin = GM_NO_PLACE};
}

void gm_formula_close(void *formula)
{
    struct gm_formula *graph = formula;
    free(graph->nodes);
    free(graph->places);
    free(graph->origins);
    free(graph->exact);
    free(graph->table);
    *graph = (struct gm_formula){0};
}

/* a + b and b + a have the same bits, and are one node */
static bool commutes(const struct gm_node *node)
{
    return node->operation == GM_OPERATION_ADD || node->operation == GM_OPERATION_MULTIPLY;
}

static uint64_t bits_of(double value)
{
    uint64_t bits = 0;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static uint32_t hash_of(const struct gm_node *node)
{
    const bool constant = node->operation == GM_CONSTANT, turned = commutes(node) && node->a > node->b;
    const uint64_t a = constant ? bits_of(node->value)
                       : turned ? node->b
                                : node->a,
                   b = constant ? 0
                       : turned ? node->a
                                : node->b;
    uint64_t hash = (uint64_t)node->operation * UINT64_C(0x9e3779b97f4a7c15);
    hash = (hash ^ a) * UINT64_C(0xbf58476d1ce4e5b9);
    hash = (hash ^ (hash >> 29) ^ b) * UINT64_C(0x94d049bb133111eb);
    return (uint32_t)(hash ^ (hash >> 32));
}

static bool is_same(const struct gm_formula *graph, const struct gm_node *x, const struct gm_node *y)
{
    if (x->operation != y->operation) {
        return false;
    }
    if (x->operation == GM_CONSTANT) {
        const bool natural = x->a == 0 || y->a == 0;
        return bits_of(x->value) == bits_of(y->value) &&
               (natural ? x->a == y->a
                        : graph->exact[x->a - 1].residue == graph->exact[y->a - 1].residue &&
                              graph->exact[x->a - 1].known == graph->exact[y->a - 1].known);
    }
    return (x->a == y->a && x->b == y->b) || (x->a == y->b && x->b == y->a && commutes(x));
}

static gm_node_id number_in(uint64_t entry)
{
    return (gm_node_id)entry - 1;
}

/* The entry of the table with an equal node, or the free one for it. In a large graph memory access takes
   most of the time, so nodes are compared only if all bits of the hash agree. */
static uint64_t *entry_of(const struct gm_formula *graph, const struct gm_node *node, uint32_t hash)
{
    size_t slot = hash & (graph->slots - 1);
    while (graph->table[slot] && (graph->table[slot] >> 32 != hash ||
                                  !is_same(graph, &graph->nodes[number_in(graph->table[slot])], node))) {
        slot = (slot + 1) & (graph->slots - 1);
    }
    return &graph->table[slot];
}

/* The equal node, or GM_NO_NODE. */
static gm_node_id find(const struct gm_formula *graph, struct gm_node node)
{
    return number_in(*entry_of(graph, &node, hash_of(&node)));
}

static bool grow(struct gm_formula *graph)
{
    const size_t capacity = graph->capacity ? 2 * graph->capacity : 32;
    struct gm_node *nodes = realloc(graph->nodes, capacity * sizeof *nodes);
    graph->nodes = nodes ? nodes : graph->nodes;
    uint32_t *places = realloc(graph->places, capacity * sizeof *places);
    graph->places = places ? places : graph->places;
    uint32_t *origins = realloc(graph->origins, capacity * sizeof *origins);
    graph->origins = origins ? origins : graph->origins;
    uint64_t *table = calloc(2 * capacity, sizeof *table);
    if (!nodes || !places || !origins || !table || graph->count >= GM_MOST_NODES) {
        free(table);
        return false;
    }
    for (size_t i = 0; i < graph->slots; i++) {
        size_t slot = graph->table[i] >> 32 & (2 * capacity - 1);
        while (graph->table[i] && table[slot]) {
            slot = (slot + 1) & (2 * capacity - 1);
        }
        table[slot] = graph->table[i] ? graph->table[i] : table[slot];
    }
    free(graph->table);
    graph->table = table;
    graph->capacity = capacity;
    graph->slots = 2 * capacity;
    return true;
}

static gm_node_id intern(struct gm_formula *graph, struct gm_node node)
{
    if (graph->failed || (graph->count == graph->capacity && !grow(graph))) {
        graph->failed = true;
        return 0;
    }
    const uint32_t hash = hash_of(&node);
    uint64_t *entry = entry_of(graph, &node, hash);
    if (!*entry) {
        graph->nodes[graph->count] = node;
        graph->places[graph->count] = graph->simplifies ? GM_NO_PLACE : graph->place;
        graph->origins[graph->count] = GM_NO_PLACE;
        *entry = (uint64_t)hash << 32 | ++graph->count;
    }
    const gm_node_id number = number_in(*entry);
    if (graph->simplifies && graph->origins[number] == GM_NO_PLACE) {
        graph->origins[number] = graph->origin;
    }
    return number;
}

gm_node_id gm_formula_constant(struct gm_formula *graph, double value)
{
    /* all NaN are one constant */
    return intern(graph, (struct gm_node){.operation = GM_CONSTANT, .value = isnan(value) ? NAN : value});
}

bool gm_formula_residue(const struct gm_formula *graph, gm_node_id constant, gm_residue *residue)
{
    const struct gm_node *node = &graph->nodes[constant];
    if (node->a == 0) {
        return gm_residue_of(node->value, residue);
    }
    *residue = graph->exact[node->a - 1].residue;
    return graph->exact[node->a - 1].known;
}

/* A constant with an exact value of its own. */
static gm_node_id exact_constant(struct gm_formula *graph, double value, struct gm_exact_value exact)
{
    if ((graph->exact_count & (graph->exact_count - 1)) == 0) { /* full */
        struct gm_exact_value *more =
            realloc(graph->exact, (graph->exact_count ? 2 * (size_t)graph->exact_count : 1) * sizeof *more);
        graph->failed |= !more;
        graph->exact = more ? more : graph->exact;
    }
    if (graph->failed) {
        return 0;
    }
    graph->exact[graph->exact_count++] = exact;
    const struct gm_node node = {.operation = GM_CONSTANT, .a = graph->exact_count, .value = value};
    const gm_node_id number = intern(graph, node);
    graph->exact_count -= !graph->failed && graph->nodes[number].a != node.a; /* it was there */
    return number;
}

static bool is_short_whole(double value)
{
    return value == floor(value) && fabs(value) < 0x1p36;
}

/* The value of an operation on constants; it stands for that of what they stand for. */
static gm_node_id folded(struct gm_formula *graph, enum gm_operation operation, gm_node_id a, gm_node_id b)
{
    const double x = graph->nodes[a].value, y = graph->nodes[b].value,
                 value = gm_operation_value(operation, x, y);
    if (!gm_is_rational(operation) || value == 0 || !isfinite(value) || !isfinite(x) || !isfinite(y) ||
        (is_short_whole(value) && is_short_whole(x) && is_short_whole(y))) {
        return gm_formula_constant(graph, value);
    }
    gm_residue of_x, of_y, natural;
    const bool known_x = gm_formula_residue(graph, a, &of_x), known_y = gm_formula_residue(graph, b, &of_y);
    bool exists = true;
    const struct gm_exact_value exact = {.residue = gm_rational_residue(operation, of_x, of_y, y, &exists),
                                         .known = known_x && known_y};
    return !exists || (gm_residue_of(value, &natural) == exact.known && natural == exact.residue)
               ? gm_formula_constant(graph, value)
               : exact_constant(graph, value, exact);
}

gm_node_id gm_formula_variable(struct gm_formula *graph, size_t number)
{
    return intern(graph, (struct gm_node){.operation = GM_VARIABLE, .a = (gm_node_id)number});
}

static bool is_operation(const struct gm_formula *graph, gm_node_id node, enum gm_operation operation)
{
    return graph->nodes[node].operation == operation;
}

static bool is_number(const struct gm_formula *graph, gm_node_id node)
{
    return is_operation(graph, node, GM_CONSTANT);
}

static gm_node_id first_of(const struct gm_formula *graph, gm_node_id node)
{
    return graph->nodes[node].a;
}

static gm_node_id second_of(const struct gm_formula *graph, gm_node_id node)
{
    return graph->nodes[node].b;
}

static gm_node_id times(struct gm_formula *graph, gm_node_id a, gm_node_id b)
{
    return gm_formula_apply(graph, GM_OPERATION_MULTIPLY, a, b);
}

static gm_node_id over(struct gm_formula *graph, gm_node_id a, gm_node_id b)
{
    return gm_formula_apply(graph, GM_OPERATION_DIVIDE, a, b);
}

static gm_node_id negative(struct gm_formula *graph, gm_node_id a)
{
    return gm_formula_apply(graph, GM_OPERATION_NEGATE, a, a);
}

/* node = coefficient * rest */
static bool is_scaled(const struct gm_formula *graph, gm_node_id node)
{
    return is_operation(graph, node, GM_OPERATION_MULTIPLY) && is_number(graph, first_of(graph, node));
}

/* The coefficient that is written, or 1. */
static gm_node_id coefficient_of(struct gm_formula *graph, gm_node_id node)
{
    return is_scaled(graph, node) ? first_of(graph, node) : gm_formula_constant(graph, 1);
}

static gm_node_id rest_of(const struct gm_formula *graph, gm_node_id node)
{
    return is_scaled(graph, node) ? second_of(graph, node) : node;
}

static gm_node_id joined_coefficients(struct gm_formula *graph, gm_node_id a, gm_node_id b)
{
    return folded(graph, GM_OPERATION_ADD, coefficient_of(graph, a), coefficient_of(graph, b));
}

/* node = c / denominator, c a constant */
static bool is_reciprocal(const struct gm_formula *graph, gm_node_id node)
{
    return is_operation(graph, node, GM_OPERATION_DIVIDE) && is_number(graph, first_of(graph, node));
}

static bool begins_with_reciprocal(const struct gm_formula *graph, gm_node_id node)
{
    return is_operation(graph, node, GM_OPERATION_MULTIPLY) && is_reciprocal(graph, first_of(graph, node));
}

/* (c / y) * factor as (c factor) / y, where the constants are gathered above */
static gm_node_id times_above(struct gm_formula *graph, gm_node_id quotient, gm_node_id factor)
{
    const gm_node_id above = folded(graph, GM_OPERATION_MULTIPLY, first_of(graph, quotient), factor);
    return over(graph, above, second_of(graph, quotient));
}

static gm_node_id joined_reciprocals(struct gm_formula *graph, gm_node_id a, gm_node_id b)
{
    const gm_node_id below = times(graph, second_of(graph, a), second_of(graph, b));
    return over(graph, folded(graph, GM_OPERATION_MULTIPLY, first_of(graph, a), first_of(graph, b)), below);
}

/* The value of a constant, or of the coefficient that is written, or 1. */
static double scale_of(const struct gm_formula *graph, gm_node_id node)
{
    const gm_node_id scale = is_scaled(graph, node) ? first_of(graph, node) : node;
    return is_number(graph, scale) ? graph->nodes[scale].value : 1;
}

/* (c x) / (d y) as (c / d) (x / y) if c / d is exact, else as c (x / y); GM_NO_NODE: there is no c. */
static gm_node_id divided_coefficients(struct gm_formula *graph, gm_node_id a, gm_node_id b)
{
    const bool above = !is_number(graph, a), below = !is_number(graph, b);
    const double value_a = scale_of(graph, a), value_b = scale_of(graph, b), ratio = value_a / value_b;
    if (value_b != 1 && isnormal(ratio) && fma(ratio, value_b, -value_a) == 0) {
        const gm_node_id quotient = folded(graph, GM_OPERATION_DIVIDE, above ? coefficient_of(graph, a) : a,
                                           below ? coefficient_of(graph, b) : b),
                         top = above ? rest_of(graph, a) : quotient,
                         rest = below ? over(graph, top, rest_of(graph, b)) : top;
        return above ? times(graph, quotient, rest) : rest;
    }
    return above && value_a != 1 ? times(graph, first_of(graph, a), over(graph, rest_of(graph, a), b))
                                 : GM_NO_NODE;
}

/* The simpler node for an operation; GM_NO_NODE without one. */
static gm_node_id simpler(struct gm_formula *graph, enum gm_operation operation, gm_node_id a, gm_node_id b)
{
    const struct gm_node x = graph->nodes[a], y = graph->nodes[b];
#define GM_RULE(operation_, condition, node)                                                                 \
    if (operation == GM_OPERATION_##operation_ && (condition)) {                                             \
        return node;                                                                                         \
    }
#include "core/expression/simplifications.def"
#undef GM_RULE
    return GM_NO_NODE;
}

gm_node_id gm_formula_apply(struct gm_formula *graph, enum gm_operation operation, gm_node_id a, gm_node_id b)
{
    const bool single = gm_operation_rows[operation].arity == 1;
    b = single ? 0 : b;
    if (graph->failed || a >= graph->count || b >= graph->count) {
        return 0; /* an operand that could not be read */
    }
    const double exponent = graph->nodes[b].value;
    if (operation == GM_OPERATION_POWER && is_operation(graph, b, GM_CONSTANT) &&
        exponent == floor(exponent) && fabs(exponent) <= GM_MOST_CHAINED) {
        operation = GM_OPERATION_WHOLE_POWER;
    }
    if (!graph->keeps && is_operation(graph, a, GM_CONSTANT) &&
        (single || is_operation(graph, b, GM_CONSTANT))) {
        return folded(graph, operation, a, single ? a : b);
    }
    const gm_node_id simple = graph->simplifies ? simpler(graph, operation, a, b) : GM_NO_NODE;
    if (simple != GM_NO_NODE) {
        return simple;
    }
    return intern(graph, (struct gm_node){.operation = operation, .a = a, .b = b});
}

gm_node_id gm_simplified(struct gm_formula *graph, enum gm_operation operation, gm_node_id a, gm_node_id b)
{
    const bool before = graph->simplifies;
    graph->simplifies = true;
    const gm_node_id node = gm_formula_apply(graph, operation, a, b);
    graph->simplifies = before;
    return node;
}

void gm_formula_evaluate_parts(const struct gm_formula *graph, const gm_node_id *parts, size_t count,
                               const double *variables, double *values)
{
    for (size_t k = 0; k < count; k++) {
        const gm_node_id i = parts ? parts[k] : (gm_node_id)k;
        const struct gm_node *node = &graph->nodes[i];
        values[i] = node->operation == GM_CONSTANT   ? node->value
                    : node->operation == GM_VARIABLE ? variables[node->a]
                                                     : gm_operation_value(node->operation, values[node->a],
                                                                          values[gm_second_operand(node)]);
    }
}

void gm_formula_evaluate(const struct gm_formula *graph, gm_node_id count, const double *variables,
                         double *values)
{
    gm_formula_evaluate_parts(graph, NULL, count, variables, values);
}

enum { WORD = 64 };

/* A bit for each node, and one for each word of these that is not 0: a node has few parts in a large graph,
   and only their words are cleared. */
struct marks {
    uint64_t *bits, *words;
    size_t word_count; /* length of `words` */
};

static inline void mark(const struct marks *marks, gm_node_id node)
{
    const size_t word = node / WORD;
    const uint64_t bit = UINT64_C(1) << word % WORD;
    if (!(marks->words[word / WORD] & bit)) {
        marks->words[word / WORD] |= bit;
        marks->bits[word] = 0;
    }
    marks->bits[word] |= UINT64_C(1) << node % WORD;
}

static inline unsigned highest(uint64_t word)
{
    return WORD - 1 - (unsigned)__builtin_clzll(word);
}

static inline unsigned lowest(uint64_t word)
{
    return (unsigned)__builtin_ctzll(word);
}

/* Marks the operands of a word's nodes, from the highest bit down, as operands are below. Returns how many
   nodes it has. */
static size_t mark_operands(const struct gm_formula *graph, const struct marks *marks, size_t word)
{
    size_t count = 0;
    for (uint64_t below = UINT64_MAX; marks->bits[word] & below; count++) {
        const unsigned bit = highest(marks->bits[word] & below);
        const struct gm_node *node = &graph->nodes[word * WORD + bit];
        below = (UINT64_C(1) << bit) - 1;
        if (node->operation > GM_VARIABLE) {
            mark(marks, node->a);
            mark(marks, gm_second_operand(node));
        }
    }
    return count;
}

gm_node_id *gm_formula_parts_of(const struct gm_formula *graph, const gm_node_id *roots, size_t root_count,
                                size_t *count)
{
    const size_t bits = graph->count / WORD + (size_t)1;
    struct marks marks = {.word_count = bits / WORD + 1};
    marks.bits = malloc((bits + marks.word_count) * sizeof *marks.bits);
    marks.words = marks.bits ? memset(marks.bits + bits, 0, marks.word_count * sizeof *marks.words) : NULL;
    *count = 0;
    for (size_t k = 0; marks.bits && k < root_count; k++) {
        mark(&marks, roots[k]);
    }
    for (size_t i = marks.bits ? marks.word_count : 0; i-- > 0;) {
        for (uint64_t below = UINT64_MAX; marks.words[i] & below;) {
            const unsigned bit = highest(marks.words[i] & below);
            *count += mark_operands(graph, &marks, i * WORD + bit);
            below = (UINT64_C(1) << bit) - 1;
        }
    }
    gm_node_id *parts = marks.bits ? malloc((*count + 1) * sizeof *parts) : NULL, *next = parts;
    for (size_t i = 0; parts && i < marks.word_count; i++) {
        for (uint64_t words = marks.words[i]; words; words &= words - 1) {
            const size_t word = i * WORD + lowest(words);
            for (uint64_t left = marks.bits[word]; left; left &= left - 1) {
                *next++ = (gm_node_id)(word * WORD + lowest(left));
            }
        }
    }
    *count = parts ? *count : 0;
    free(marks.bits);
    return parts;
}

gm_node_id gm_formula_first(struct gm_formula *graph, gm_node_id node,
                            bool (*suits)(struct gm_formula *graph, gm_node_id part, const void *data),
                            const void *data)
{
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(graph, node, &count), found = GM_NO_NODE;
    for (size_t i = 0; parts && i < count && found == GM_NO_NODE; i++) {
        found = suits(graph, parts[i], data) ? parts[i] : GM_NO_NODE;
    }
    graph->failed |= !parts;
    free(parts);
    return found;
}

struct marked_variables {
    const bool *marked;
    size_t variables;
};

static bool is_marked(struct gm_formula *graph, gm_node_id part, const void *data)
{
    const struct marked_variables *set = data;
    const struct gm_node *node = &graph->nodes[part];
    return node->operation == GM_VARIABLE && node->a < set->variables && set->marked[node->a];
}

gm_node_id gm_formula_first_marked(struct gm_formula *graph, gm_node_id node, const bool *marked,
                                   size_t variables)
{
    return gm_formula_first(graph, node, is_marked, &(struct marked_variables){marked, variables});
}

bool gm_formula_holds(struct gm_formula *graph, gm_node_id node, const bool *marked, size_t variables)
{
    return gm_formula_first_marked(graph, node, marked, variables) != GM_NO_NODE;
}

static bool is_kink(struct gm_formula *graph, gm_node_id part, const void *data)
{
    const struct gm_operation_row *row = &gm_operation_rows[graph->nodes[part].operation];
    return row->name && !row->smooth && gm_formula_first(graph, part, is_marked, data) != GM_NO_NODE;
}

gm_node_id gm_formula_kink(struct gm_formula *graph, gm_node_id formula, const bool *marked, size_t variables)
{
    return gm_formula_first(graph, formula, is_kink, &(struct marked_variables){marked, variables});
}

gm_node_id *gm_formula_parts(const struct gm_formula *graph, gm_node_id node, size_t *count)
{
    return gm_formula_parts_of(graph, &node, 1, count);
}

bool gm_formula_rewrite(struct gm_formula *graph, gm_node_id *nodes, size_t count, gm_rewriter *become,
                        const void *data)
{
    size_t size = 0;
    gm_node_id *parts = gm_formula_parts_of(graph, nodes, count, &size);
    gm_node_id *others =
        malloc((graph->count + (size_t)1) * sizeof *others); /* [node], set for parts alone */
    graph->failed |= !parts || !others;
    for (size_t p = 0; p < size && !graph->failed; p++) {
        const gm_node_id i = parts[p];
        const struct gm_node node = graph->nodes[i];
        const bool applies = node.operation > GM_VARIABLE;
        const gm_node_id second = applies ? gm_second_operand(&node) : i, a = applies ? others[node.a] : i,
                         b = applies ? others[second] : i;
        graph->origin = applies ? gm_formula_origin(graph, i) : GM_NO_PLACE;
        others[i] = become(graph, i, a, b, data);
        if (others[i] == GM_NO_NODE) {
            const bool same = !applies || (a == node.a && b == second);
            others[i] = same ? i : gm_formula_apply(graph, node.operation, a, b);
        }
        graph->origin = GM_NO_PLACE;
    }
    for (size_t k = 0; k < count && !graph->failed; k++) {
        nodes[k] = others[nodes[k]];
    }
    free(parts);
    free(others);
    return !graph->failed;
}

struct replacement {
    const gm_node_id *nodes;
    size_t variables;
};

/* gm_rewriter */
static gm_node_id replaced(struct gm_formula *graph, gm_node_id node, gm_node_id a, gm_node_id b,
                           const void *data)
{
    const struct replacement *replacement = data;
    const struct gm_node *variable = &graph->nodes[node];
    (void)a;
    (void)b;
    return variable->operation == GM_VARIABLE && variable->a < replacement->variables
               ? replacement->nodes[variable->a]
               : GM_NO_NODE;
}

bool gm_formula_substitute(struct gm_formula *graph, gm_node_id *nodes, size_t count,
                           const gm_node_id *replacement, size_t variables)
{
    const bool before = graph->simplifies;
    graph->simplifies = true;
    const bool good =
        gm_formula_rewrite(graph, nodes, count, replaced, &(struct replacement){replacement, variables});
    graph->simplifies = before;
    return good;
}

/* node = y sqrt(y) */
static bool is_power_three_halves(const struct gm_formula *graph, gm_node_id node, gm_node_id *y,
                                  gm_node_id *root)
{
    const struct gm_node *product = &graph->nodes[node];
    if (product->operation != GM_OPERATION_MULTIPLY) {
        return false;
    }
    *root = is_operation(graph, product->a, GM_OPERATION_SQRT) ? product->a : product->b;
    *y = *root == product->a ? product->b : product->a;
    return is_operation(graph, *root, GM_OPERATION_SQRT) && graph->nodes[*root].a == *y;
}

static gm_node_id quicker(struct gm_formula *graph, enum gm_operation operation, gm_node_id a, gm_node_id b)
{
    gm_node_id y, root;
    if (operation != GM_OPERATION_DIVIDE || !is_power_three_halves(graph, b, &y, &root)) {
        return gm_formula_apply(graph, operation, a, b);
    }
    const gm_node_id one = gm_formula_constant(graph, 1), inverse = over(graph, one, y),
                     square = times(graph, inverse, inverse), power = times(graph, root, square);
    return gm_is_constant(graph, a, 1)    ? power
           : gm_is_constant(graph, a, -1) ? negative(graph, power)
                                          : times(graph, a, power);
}

/* Marks the parts, ascending, that enter operations other than sums and products: there an infinite quotient
   may lead to a finite value, and NaN does not. */
static void mark_harsh(const struct gm_formula *graph, const gm_node_id *parts, size_t size, bool *harsh)
{
    for (size_t k = size; k-- > 0;) {
        const struct gm_node *node = &graph->nodes[parts[k]];
        const bool gentle = node->operation == GM_OPERATION_ADD || node->operation == GM_OPERATION_SUBTRACT ||
                            node->operation == GM_OPERATION_MULTIPLY ||
                            node->operation == GM_OPERATION_NEGATE;
        if (node->operation > GM_VARIABLE && (!gentle || harsh[parts[k]])) {
            harsh[node->a] = true;
            harsh[gm_second_operand(node)] = true;
        }
    }
}

/* The part met before that is minus this one, c / x for -c / x; GM_NO_NODE without one. */
static gm_node_id twin_of(const struct gm_formula *graph, gm_node_id i, const bool *met)
{
    const struct gm_node *node = &graph->nodes[i];
    if ((node->operation != GM_OPERATION_MULTIPLY && node->operation != GM_OPERATION_DIVIDE) ||
        !is_operation(graph, node->a, GM_CONSTANT)) {
        return GM_NO_NODE;
    }
    const gm_node_id constant =
        find(graph, (struct gm_node){.operation = GM_CONSTANT, .value = -graph->nodes[node->a].value});
    const gm_node_id twin =
        constant == GM_NO_NODE
            ? GM_NO_NODE
            : find(graph, (struct gm_node){.operation = node->operation, .a = constant, .b = node->b});
    return twin != GM_NO_NODE && met[twin] ? twin : GM_NO_NODE;
}

/* A node, or minus that node. */
struct signed_node {
    gm_node_id node;
    bool negative;
};

static gm_node_id with_sign(struct gm_formula *graph, struct signed_node x)
{
    return x.negative ? negative(graph, x.node) : x.node;
}

/* An operation that leaves signs to later ones, as long as no bit changes, not even of 0. */
static struct signed_node apply_signed(struct gm_formula *graph, bool quick, enum gm_operation operation,
                                       struct signed_node a, struct signed_node b)
{
    const bool sum = operation == GM_OPERATION_ADD, difference = operation == GM_OPERATION_SUBTRACT;
    bool negative = false;
    if (operation == GM_OPERATION_MULTIPLY || operation == GM_OPERATION_DIVIDE) {
        negative = a.negative != b.negative;
        a.negative = b.negative = false;
    } else if (operation == GM_OPERATION_NEGATE && a.negative) {
        return (struct signed_node){.node = a.node};
    } else if (sum && a.negative && !b.negative) {
        return (struct signed_node){.node = gm_formula_apply(graph, GM_OPERATION_SUBTRACT, b.node, a.node)};
    } else if ((sum || difference) && b.negative) {
        operation = sum ? GM_OPERATION_SUBTRACT : GM_OPERATION_ADD;
        b.negative = false;
    }
    const gm_node_id first = with_sign(graph, a), second = with_sign(graph, b);
    return (struct signed_node){.node = (quick ? quicker : gm_formula_apply)(graph, operation, first, second),
                                .negative = negative};
}

bool gm_formula_quicken(struct gm_formula *graph, gm_node_id *nodes, size_t count)
{
    enum { MANY = 4096 }; /* parts; with more of them some can always be computed while others wait */
    size_t size = 0;
    gm_node_id *parts = gm_formula_parts_of(graph, nodes, count, &size);
    struct signed_node *others = malloc((graph->count + (size_t)1) * sizeof *others);
    bool *harsh = calloc(graph->count + (size_t)1, sizeof *harsh),
         *met = calloc(graph->count + (size_t)1, sizeof *met);
    graph->failed |= !parts || !others || !harsh || !met;
    if (!graph->failed) {
        mark_harsh(graph, parts, size, harsh);
    }
    for (size_t k = 0; k < size && !graph->failed; k++) {
        const gm_node_id i = parts[k], twin = twin_of(graph, i, met);
        const struct gm_node node = graph->nodes[i];
        met[i] = true;
        if (twin != GM_NO_NODE) {
            others[i] = (struct signed_node){others[twin].node, !others[twin].negative};
        } else if (node.operation > GM_VARIABLE) {
            others[i] = apply_signed(graph, size < MANY && !harsh[i], node.operation, others[node.a],
                                     others[gm_second_operand(&node)]);
        } else {
            others[i] = (struct signed_node){.node = i};
        }
    }
    for (size_t k = 0; k < count && !graph->failed; k++) {
        nodes[k] = with_sign(graph, others[nodes[k]]);
    }
    free(harsh);
    free(met);
    free(parts);
    free(others);
    return !graph->failed;
}

gm_node_id gm_formula_graft(struct gm_formula *graph, const struct gm_formula *other, gm_node_id root,
                            size_t inputs, const double *values)
{
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(other, root, &count);
    gm_node_id *made = malloc((root + (size_t)1) * sizeof *made); /* [node], set for parts alone */
    graph->failed |= !parts || !made;
    graph->simplifies = true;
    for (size_t k = 0; k < count && !graph->failed; k++) {
        const struct gm_node *node = &other->nodes[parts[k]];
        if (node->operation == GM_CONSTANT) {
            made[parts[k]] = node->a ? exact_constant(graph, node->value, other->exact[node->a - 1])
                                     : gm_formula_constant(graph, node->value);
        } else if (node->operation == GM_VARIABLE) {
            made[parts[k]] = node->a < inputs ? gm_formula_variable(graph, node->a)
                                              : gm_formula_constant(graph, values[node->a]);
        } else {
            made[parts[k]] =
                gm_formula_apply(graph, node->operation, made[node->a], made[gm_second_operand(node)]);
        }
    }
    graph->simplifies = false;
    const gm_node_id node = graph->failed ? GM_NO_NODE : made[root];
    free(parts);
    free(made);
    return node;
}

bool *gm_formula_dependent(const struct gm_formula *graph, const bool *marked, size_t variables)
{
    bool *dependent = malloc(graph->count + (size_t)1);
    for (gm_node_id i = 0; dependent && i < graph->count; i++) {
        const struct gm_node *node = &graph->nodes[i];
        if (node->operation <= GM_VARIABLE) {
            dependent[i] = node->operation == GM_VARIABLE && node->a < variables && marked[node->a];
        } else {
            dependent[i] = dependent[node->a] || dependent[gm_second_operand(node)];
        }
    }
    return dependent;
}
