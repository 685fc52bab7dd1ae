/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A formula as a graph: each node exists once, after its operands. */
#ifndef GM_CORE_EXPRESSION_GRAPH_H
#define GM_CORE_EXPRESSION_GRAPH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/expression/arithmetic.h"

enum gm_operation {
    GM_CONSTANT, /* the field `value` */
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
/* The rows of operations; the two leaves have empty rows. */
extern const struct gm_operation_row gm_operation_rows[GM_OPERATIONS];

/* The value of an operation: the same bits wherever a formula is computed. */
double gm_operation_value(enum gm_operation operation, double a, double b);

static inline bool gm_is_rational(enum gm_operation operation)
{
    return (operation > GM_VARIABLE && operation <= GM_OPERATION_NEGATE) ||
           operation == GM_OPERATION_WHOLE_POWER;
}
/* The value of such an operation on residues. `exponent` is the value of b. A division by 0 sets *exists to false. */
uint64_t gm_rational_residue(enum gm_operation operation, uint64_t a, uint64_t b, double exponent,
                             bool *exists);

/* A node's number. Operands have smaller numbers, so that a pass upwards evaluates, and one downwards gathers
   derivatives, without recursion. */
typedef uint32_t gm_node_id;
static const gm_node_id GM_NO_NODE = UINT32_MAX;

/* The place of a node that is not in a text. */
static const uint32_t GM_NO_PLACE = UINT32_MAX;

struct gm_node {
    enum gm_operation operation;
    gm_node_id a; /* of a constant: 1 + the number of its exact value; 0: gm_residue_of(value) */
    union {
        gm_node_id b;
        double value; /* value of a constant */
    };
};

/* The exact value of a constant that was computed from others: 3/10 of 0.1 + 0.2, not 0.3 + 5.6e-17. */
struct gm_exact_value;

struct gm_formula {
    struct gm_node *nodes;
    uint32_t *places;  /* byte offset where a node was first written; GM_NO_PLACE: it was derived */
    uint32_t *origins; /* byte offset of the text it was derived from */
    gm_node_id count;
    size_t capacity;
    struct gm_exact_value *exact;
    gm_node_id exact_count;
    uint64_t *table; /* open addressing; 0: free, else number + 1, with the hash in the high 32 bits */
    size_t slots;
    uint32_t place;  /* place of further nodes that are written */
    uint32_t origin; /* origin of further nodes that are derived */
    /* A formula as written is computed operation by operation: only constants are folded. While derivatives
       are built this is set, and gm_formula_apply simplifies more. */
    bool simplifies;
    bool keeps;  /* operations of constants stay as written: nothing is folded */
    bool failed; /* out of memory, or more than GM_MOST_NODES: the graph cannot be used */
};
enum { GM_MOST_NODES = 20000000 };

void gm_formula_open(struct gm_formula *graph);
void gm_formula_close(void *graph); /* for arenas too */

gm_node_id gm_formula_constant(struct gm_formula *graph, double value);
gm_node_id gm_formula_variable(struct gm_formula *graph, size_t number);
/* The residue of what a constant stands for, as gm_residue_of. */
bool gm_formula_residue(const struct gm_formula *graph, gm_node_id constant, uint64_t *residue);
/* b of an operation of one operand is ignored. A power whose exponent is a constant whole number up to 16
   becomes a chain. While `simplifies` is set also core/expression/simplifications.def holds, for finite values. */
gm_node_id gm_formula_apply(struct gm_formula *graph, enum gm_operation operation, gm_node_id a,
                            gm_node_id b);
/* gm_formula_apply with `simplifies` set, for derived formulas. */
gm_node_id gm_simplified(struct gm_formula *graph, enum gm_operation operation, gm_node_id a, gm_node_id b);

/* Returns what a node becomes when its operands have become a and b; GM_NO_NODE: the same operation of these. */
typedef gm_node_id gm_rewriter(struct gm_formula *graph, gm_node_id node, gm_node_id a, gm_node_id b,
                               const void *data);
/* Rewrites the nodes, in place, from their operands up. Returns false when out of memory. */
bool gm_formula_rewrite(struct gm_formula *graph, gm_node_id *nodes, size_t count, gm_rewriter *become,
                        const void *data);
/* Replaces variable i by replacement[i], unless that is GM_NO_NODE, in the nodes, in place. Simplifies like a
   derivative. Returns false when out of memory. */
bool gm_formula_substitute(struct gm_formula *graph, gm_node_id *nodes, size_t count,
                           const gm_node_id *replacement, size_t variables);
/* Replaces the nodes, in place, by faster ones. Parts with both signs, c / x and -c / x, are computed once;
   no bit changes. If there are few nodes, x / (y sqrt(y)) becomes x (1/y)^2 sqrt(y) when only sums and
   products use it: the quotient does not wait for the root. This changes bits. Values that are not finite
   stay so, but for y between 1e-154 and 1e-205 the square is infinite and the quotient was not. Returns false
   when out of memory. */
bool gm_formula_quicken(struct gm_formula *graph, gm_node_id *nodes, size_t count);

/* Copies a node of another graph into this one, with the constant values[i] for each variable i >= inputs.
   Simplifies like a derivative. Returns GM_NO_NODE when out of memory. */
gm_node_id gm_formula_graft(struct gm_formula *graph, const struct gm_formula *other, gm_node_id node,
                            size_t inputs, const double *values);

/* The values of nodes 0 .. count - 1 for these variables. */
void gm_formula_evaluate(const struct gm_formula *graph, gm_node_id count, const double *variables,
                         double *values);

/* The values of `count` ascending nodes, which include all their operands; NULL: of the first nodes. */
void gm_formula_evaluate_parts(const struct gm_formula *graph, const gm_node_id *parts, size_t count,
                               const double *variables, double *values);

/* A node and all that it depends on: *count nodes, ascending. The caller frees; NULL when out of memory. The
   time depends on these nodes, not on the graph. */
gm_node_id *gm_formula_parts(const struct gm_formula *graph, gm_node_id node, size_t *count);
/* The parts of several nodes together. */
gm_node_id *gm_formula_parts_of(const struct gm_formula *graph, const gm_node_id *nodes, size_t node_count,
                                size_t *count);
/* The first part of a node that suits, or GM_NO_NODE. Out of memory sets graph->failed. */
gm_node_id gm_formula_first(struct gm_formula *graph, gm_node_id node,
                            bool (*suits)(struct gm_formula *graph, gm_node_id part, const void *data),
                            const void *data);
/* The first marked variable of a node, or GM_NO_NODE; `marked` has `variables` entries. Out of memory sets
   graph->failed. */
gm_node_id gm_formula_first_marked(struct gm_formula *graph, gm_node_id node, const bool *marked,
                                   size_t variables);
/* True if it has one. */
bool gm_formula_holds(struct gm_formula *graph, gm_node_id node, const bool *marked, size_t variables);
/* The first operation of a formula that is not smooth and depends on a marked variable, or GM_NO_NODE. Out of
   memory sets graph->failed. */
gm_node_id gm_formula_kink(struct gm_formula *graph, gm_node_id formula, const bool *marked,
                           size_t variables);
/* A flag for each node, true if it depends on a marked variable; `marked` has `variables` entries. The caller
   frees; NULL when out of memory. */
bool *gm_formula_dependent(const struct gm_formula *graph, const bool *marked, size_t variables);

/* Derived formulas. */
static inline gm_node_id gm_sum(struct gm_formula *graph, gm_node_id a, gm_node_id b)
{
    return gm_simplified(graph, GM_OPERATION_ADD, a, b);
}
static inline gm_node_id gm_difference(struct gm_formula *graph, gm_node_id a, gm_node_id b)
{
    return gm_simplified(graph, GM_OPERATION_SUBTRACT, a, b);
}
static inline gm_node_id gm_product(struct gm_formula *graph, gm_node_id a, gm_node_id b)
{
    return gm_simplified(graph, GM_OPERATION_MULTIPLY, a, b);
}
static inline gm_node_id gm_negative(struct gm_formula *graph, gm_node_id a)
{
    return gm_simplified(graph, GM_OPERATION_NEGATE, a, a);
}

/* The second operand of an operation; of one operand that one. */
static inline gm_node_id gm_second_operand(const struct gm_node *node)
{
    return gm_operation_rows[node->operation].arity == 2 ? node->b : node->a;
}

static inline bool gm_is_constant(const struct gm_formula *graph, gm_node_id node, double value)
{
    return graph->nodes[node].operation == GM_CONSTANT && graph->nodes[node].value == value;
}

/* The byte offset of a node, or of the text it was derived from. */
static inline uint32_t gm_formula_origin(const struct gm_formula *graph, gm_node_id node)
{
    return graph->places[node] != GM_NO_PLACE ? graph->places[node] : graph->origins[node];
}

#endif
