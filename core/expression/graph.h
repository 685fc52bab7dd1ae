/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A formula as a graph: nodes that stand behind what they are made of, each of them once. */
#ifndef GM_CORE_EXPRESSION_GRAPH_H
#define GM_CORE_EXPRESSION_GRAPH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/expression/arithmetic.h"

enum gm_operation {
    GM_CONSTANT, /* `value` */
    GM_VARIABLE, /* number `a` of the array of variables */
#define GM_OPERATION(constant, ...) GM_OPERATION_##constant,
#include "core/expression/operations.def"
#undef GM_OPERATION
    GM_OPERATIONS
};

struct gm_operation_row {
    const char *name, *latex;
    unsigned arity;
    bool smooth;
    const char *value; /* C text in a and b */
    const char *partials[2];
};
/* Of the operations; the two that are leaves have no name. */
extern const struct gm_operation_row gm_operation_rows[GM_OPERATIONS];

/* The value of an operation: the same one wherever a formula is computed. */
double gm_operation_value(enum gm_operation operation, double a, double b);

/* A node's number. What it is made of has smaller numbers, so that a pass upwards evaluates, and one downwards
   gathers derivatives, without recursion. */
typedef uint32_t gm_node_id;
static const gm_node_id GM_NO_NODE = UINT32_MAX;

/* Where in a text nothing is. */
static const uint32_t GM_NO_PLACE = UINT32_MAX;

struct gm_node {
    enum gm_operation operation;
    gm_node_id a;
    union {
        gm_node_id b;
        double value; /* of a constant */
    };
};

struct gm_formula {
    struct gm_node *nodes;
    uint32_t *places;  /* where in the text a node was first written; GM_NO_PLACE: it was derived */
    uint32_t *origins; /* where what it was derived from was written; GM_NO_PLACE: nowhere */
    gm_node_id count;
    size_t capacity;
    uint64_t *table; /* open addressing; 0: free, else number + 1, and above it all bits of the hash */
    size_t slots;
    uint32_t place;  /* of the nodes to come that are written */
    uint32_t origin; /* and of those that are derived */
    /* Numbers of a formula as written are those of its operations one by one: only constants are folded. While
       derivatives are built this is set, and more is simplified: gm_formula_apply says what. */
    bool simplifies;
    bool keeps;  /* what is written of constants stays too: nothing is folded */
    bool failed; /* memory was refused, or there would be more than GM_MOST_NODES: the graph is of no use */
};
enum { GM_MOST_NODES = 20000000 };

void gm_formula_open(struct gm_formula *graph);
void gm_formula_close(struct gm_formula *graph);

gm_node_id gm_formula_constant(struct gm_formula *graph, double value);
gm_node_id gm_formula_variable(struct gm_formula *graph, size_t number);
/* b of an operation of one operand is not looked at. A power whose exponent is a constant whole number up to 16
   becomes a chain. While `simplifies` is set also, where x and y are finite:
     0 + x, x - 0, 1 x, x / 1, x^1 -> x    0 x, 0 / x, x^0 -> a constant    0 - x, -1 x -> -x    x - x -> 0
     -(-x) -> x    -(x - y) -> y - x    signs leave products, quotients and sums    c x + d x -> (c + d) x
     x x -> x^2    sqrt(x) sqrt(x) -> x    (x / y) / z -> x / (y z)
     constants gather in front: x (c y) -> c (x y), c (d x) -> (c d) x, and above:
     (c / x) (d y) -> ((c d) / x) y, (c / x) (d / y) -> (c d) / (x y),
     (c x) / (d y) -> (c / d) (x / y) where c / d is exact, else c (x / y) */
gm_node_id gm_formula_apply(struct gm_formula *graph, enum gm_operation operation, gm_node_id a,
                            gm_node_id b);
/* The same with `simplifies` set: what is derived of a formula, not written in it. */
gm_node_id gm_simplified(struct gm_formula *graph, enum gm_operation operation, gm_node_id a, gm_node_id b);

/* The nodes with others in place of variables, in place: replacement[i] for variable i, GM_NO_NODE: it stays.
   Simplified like a derivative. False where memory was refused. */
bool gm_formula_substitute(struct gm_formula *graph, gm_node_id *nodes, size_t count,
                           const gm_node_id *replacement, size_t variables);
/* Nodes that are those, in place, as quickly as they can be had. What occurs with both signs, c / x and -c / x,
   is computed once: no bit changes by that. Where there are few nodes, x / (y sqrt(y)) becomes x (1/y)^2 sqrt(y),
   where the quotient does not wait for the root and only sums and products are made of it. The bits are others;
   what is not finite is not, but between y = 1e-154 and 1e-205 the square is infinite where the quotient was not.
   False: out of memory. */
bool gm_formula_quicken(struct gm_formula *graph, gm_node_id *nodes, size_t count);

/* A node of another graph made again in this one, with the constant values[i] in place of every variable
   i >= inputs. Simplified like a derivative. GM_NO_NODE where memory was refused. */
gm_node_id gm_formula_graft(struct gm_formula *graph, const struct gm_formula *other, gm_node_id node,
                            size_t inputs, const double *values);

/* Values of nodes 0 .. count - 1 for these variables. */
void gm_formula_evaluate(const struct gm_formula *graph, gm_node_id count, const double *variables,
                         double *values);

/* The same of `count` nodes alone, ascending, with what they are made of; NULL: of the first. */
void gm_formula_evaluate_parts(const struct gm_formula *graph, const gm_node_id *parts, size_t count,
                               const double *variables, double *values);

/* What a node is made of, and itself: *count nodes, ascending. malloc'ed, NULL if memory is short. The time is
   that of these nodes, not of the graph. */
gm_node_id *gm_formula_parts(const struct gm_formula *graph, gm_node_id node, size_t *count);
/* What several nodes are made of. */
gm_node_id *gm_formula_parts_of(const struct gm_formula *graph, const gm_node_id *nodes, size_t node_count,
                                size_t *count);
/* Whether a node holds one of the variables that are marked; there are `variables` of these. Where memory was
   refused graph->failed is set. */
bool gm_formula_holds(struct gm_formula *graph, gm_node_id node, const bool *marked, size_t variables);
/* The first operation of a formula that is not smooth and holds one of the marked variables; GM_NO_NODE: none does.
   Where memory was refused graph->failed is set. */
gm_node_id gm_formula_kink(struct gm_formula *graph, gm_node_id formula, const bool *marked,
                           size_t variables);
/* For each node whether it depends on one of the variables that are marked; there are `variables` of these.
   malloc'ed, NULL if memory is short. */
bool *gm_formula_dependent(const struct gm_formula *graph, const bool *marked, size_t variables);

static inline bool gm_is_constant(const struct gm_formula *graph, gm_node_id node, double value)
{
    return graph->nodes[node].operation == GM_CONSTANT && graph->nodes[node].value == value;
}

/* Where in the text a node is, or else what it was derived from. */
static inline uint32_t gm_formula_origin(const struct gm_formula *graph, gm_node_id node)
{
    return graph->places[node] != GM_NO_PLACE ? graph->places[node] : graph->origins[node];
}

#endif
