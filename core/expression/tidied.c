/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tidies formulas from their leaves upwards: products by their factors, sums by their terms. */
#include "core/expression/tidied.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 32, MOST_VISITED = 4 * MOST, MOST_POWER = 64 };

struct tidying {
    struct gm_formula *graph;
    const struct gm_naming *naming;
    int visited; /* nodes visited in the current product or sum; one that is too long stays as it is */
};

/* above / below times the factors, each raised to halves / 2 */
struct product {
    double above, below;
    struct {
        gm_node_id base;
        long halves;
    } factors[MOST];
    size_t count;
};

struct sum {
    struct {
        gm_node_id node;
        bool minus;
    } terms[MOST];
    size_t count;
};

static bool is_named(const struct tidying *tidying, gm_node_id node)
{
    return tidying->naming->part && tidying->naming->part(node, tidying->naming->data);
}

static bool is_sum(const struct tidying *tidying, gm_node_id node)
{
    const enum gm_operation operation = tidying->graph->nodes[node].operation;
    return operation == GM_OPERATION_ADD || operation == GM_OPERATION_SUBTRACT;
}

static gm_node_id apply(const struct tidying *tidying, enum gm_operation operation, gm_node_id a,
                        gm_node_id b)
{
    return gm_formula_apply(tidying->graph, operation, a, b);
}

/* ---- products ---- */

/* Adds a factor, in the order of numbers, so that equal products are one node. False: too many. */
static bool add_factor(struct product *product, gm_node_id base, long halves)
{
    size_t i = 0;
    while (i < product->count && product->factors[i].base < base) {
        i++;
    }
    if (i < product->count && product->factors[i].base == base) {
        product->factors[i].halves += halves;
        return true;
    }
    if (product->count == MOST) {
        return false;
    }
    memmove(&product->factors[i + 1], &product->factors[i],
            (product->count++ - i) * sizeof product->factors[i]);
    product->factors[i].base = base;
    product->factors[i].halves = halves;
    return true;
}

/* Multiplies by the power halves / 2 of a tidy node. False: too long. */
static bool multiply(struct tidying *tidying, struct product *product, gm_node_id node, long halves)
{
    const struct gm_node here = tidying->graph->nodes[node];
    if (++tidying->visited > MOST_VISITED) {
        return false;
    }
    if (halves % 2 == 0 && here.operation == GM_OPERATION_SQRT) {
        return add_factor(product, here.a, halves / 2);
    }
    if (halves % 2 != 0 || labs(halves) > MOST_POWER || is_named(tidying, node)) {
        return add_factor(product, node, halves);
    }
    switch (here.operation) {
    case GM_CONSTANT:
        *(halves > 0 ? &product->above : &product->below) *= pow(here.value, (double)labs(halves / 2));
        return true;
    case GM_OPERATION_NEGATE:
        product->above *= halves / 2 % 2 ? -1 : 1;
        return multiply(tidying, product, here.a, halves);
    case GM_OPERATION_MULTIPLY:
        return multiply(tidying, product, here.a, halves) && multiply(tidying, product, here.b, halves);
    case GM_OPERATION_DIVIDE:
        return multiply(tidying, product, here.a, halves) && multiply(tidying, product, here.b, -halves);
    case GM_OPERATION_POWER:
    case GM_OPERATION_WHOLE_POWER: {
        const struct gm_node exponent = tidying->graph->nodes[here.b];
        if (exponent.operation == GM_CONSTANT && exponent.value == floor(exponent.value) &&
            fabs(exponent.value) <= MOST_POWER) {
            return multiply(tidying, product, here.a, halves * (long)exponent.value);
        }
        return add_factor(product, node, halves);
    }
    default:
        return add_factor(product, node, halves);
    }
}

static gm_node_id times_power(const struct tidying *tidying, gm_node_id product, gm_node_id base,
                              long exponent)
{
    const gm_node_id number = gm_formula_constant(tidying->graph, (double)exponent);
    const gm_node_id power = exponent == 1 ? base : apply(tidying, GM_OPERATION_POWER, base, number);
    return product == GM_NO_NODE ? power : apply(tidying, GM_OPERATION_MULTIPLY, product, power);
}

/* Divides two numbers by their common divisor; 0.5 becomes 1 above 2. */
static void reduce(double *above, double *below)
{
    enum { PARTS = 1024 };
    double a = fabs(*above) * PARTS, b = fabs(*below) * PARTS;
    if (a != floor(a) || b != floor(b) || fmax(a, b) > 0x1p53) {
        return;
    }
    while (b > 0) {
        const double rest = fmod(a, b);
        a = b;
        b = rest;
    }
    *above *= PARTS / a;
    *below *= PARTS / a;
}

/* The node; GM_NO_NODE if its numbers are not finite. */
static gm_node_id written_product(const struct tidying *tidying, struct product *product)
{
    if (!isfinite(product->above) || !isfinite(product->below) || product->below == 0) {
        return GM_NO_NODE;
    }
    if (product->above == 0) {
        return gm_formula_constant(tidying->graph, 0);
    }
    reduce(&product->above, &product->below);
    const bool minus = (product->above < 0) != (product->below < 0);
    gm_node_id sides[2] = {GM_NO_NODE, GM_NO_NODE};
    const double numbers[2] = {fabs(product->above), fabs(product->below)};
    for (int side = 0; side < 2; side++) {
        if (numbers[side] != 1) {
            sides[side] = gm_formula_constant(tidying->graph, numbers[side]);
        }
        for (size_t i = 0; i < product->count; i++) {
            const gm_node_id base = product->factors[i].base;
            const long halves = side ? -product->factors[i].halves : product->factors[i].halves;
            const gm_node_id root = apply(tidying, GM_OPERATION_SQRT, base, base);
            const bool rooted = halves > 0 && is_named(tidying, root);
            if (halves > 1 && !rooted) {
                sides[side] = times_power(tidying, sides[side], base, halves / 2);
            }
            if (rooted || (halves > 0 && halves % 2)) {
                sides[side] = times_power(tidying, sides[side], root, rooted ? halves : 1);
            }
        }
    }
    gm_node_id node = sides[0] == GM_NO_NODE ? gm_formula_constant(tidying->graph, 1) : sides[0];
    node = sides[1] == GM_NO_NODE ? node : apply(tidying, GM_OPERATION_DIVIDE, node, sides[1]);
    return minus ? apply(tidying, GM_OPERATION_NEGATE, node, node) : node;
}

/* ---- sums ---- */

/* Adds the terms of a node; a term cancels an equal one with the other sign. False: too long. */
static bool add(struct tidying *tidying, struct sum *sum, gm_node_id node, bool minus)
{
    const struct gm_node here = tidying->graph->nodes[node];
    const bool named = is_named(tidying, node);
    if (++tidying->visited > MOST_VISITED || sum->count == MOST) {
        return false;
    }
    if (!named && is_sum(tidying, node)) {
        return add(tidying, sum, here.a, minus) &&
               add(tidying, sum, here.b, minus != (here.operation == GM_OPERATION_SUBTRACT));
    }
    if (!named && here.operation == GM_OPERATION_NEGATE) {
        return add(tidying, sum, here.a, !minus);
    }
    for (size_t i = 0; i < sum->count; i++) {
        if (sum->terms[i].node == node && sum->terms[i].minus != minus) {
            memmove(&sum->terms[i], &sum->terms[i + 1], (--sum->count - i) * sizeof sum->terms[i]);
            return true;
        }
    }
    if (named || !gm_is_constant(tidying->graph, node, 0)) {
        sum->terms[sum->count].node = node;
        sum->terms[sum->count++].minus = minus;
    }
    return true;
}

/* The node; it begins with a positive term, if there is one. */
static gm_node_id written_sum(const struct tidying *tidying, const struct sum *sum)
{
    size_t first = 0;
    while (first < sum->count && sum->terms[first].minus) {
        first++;
    }
    gm_node_id node = first < sum->count ? sum->terms[first].node : gm_formula_constant(tidying->graph, 0);
    for (size_t i = 0; i < sum->count; i++) {
        const gm_node_id term = sum->terms[i].node;
        if (i == 0 && first == sum->count) {
            node = apply(tidying, GM_OPERATION_NEGATE, term, term);
        } else if (i != first) {
            node = apply(tidying, sum->terms[i].minus ? GM_OPERATION_SUBTRACT : GM_OPERATION_ADD, node, term);
        }
    }
    return node;
}

/* ---- both ---- */

/* The node of a product. A derived sum among the factors is multiplied out: differentiation adds parentheses
   that were not typed. GM_NO_NODE: too long. */
static gm_node_id expanded(struct tidying *tidying, struct product *product)
{
    size_t at = 0;
    while (at < product->count &&
           (product->factors[at].halves != 2 || !is_sum(tidying, product->factors[at].base) ||
            is_named(tidying, product->factors[at].base) ||
            tidying->graph->places[product->factors[at].base] != GM_NO_PLACE)) {
        at++;
    }
    if (at == product->count) {
        return written_product(tidying, product);
    }
    struct sum sum = {.count = 0}, all = {.count = 0};
    tidying->visited = 0;
    bool good = add(tidying, &sum, product->factors[at].base, false);
    product->factors[at].halves = 0;
    for (size_t i = 0; good && i < sum.count; i++) {
        struct product term = *product;
        tidying->visited = 0;
        good = multiply(tidying, &term, sum.terms[i].node, 2);
        const gm_node_id node = good ? written_product(tidying, &term) : GM_NO_NODE;
        good = node != GM_NO_NODE && add(tidying, &all, node, sum.terms[i].minus);
    }
    return good ? written_sum(tidying, &all) : GM_NO_NODE;
}

/* Tidies a node whose operands are tidy. */
static gm_node_id tidy(struct tidying *tidying, gm_node_id node)
{
    const struct gm_node here = tidying->graph->nodes[node];
    struct sum sum = {.count = 0};
    struct product product = {.above = 1, .below = 1};
    gm_node_id tidied = GM_NO_NODE;
    tidying->visited = 0;
    if (is_sum(tidying, node) || (here.operation == GM_OPERATION_NEGATE && is_sum(tidying, here.a))) {
        tidied = add(tidying, &sum, node, false) ? written_sum(tidying, &sum) : GM_NO_NODE;
    } else if (here.operation == GM_OPERATION_MULTIPLY || here.operation == GM_OPERATION_DIVIDE ||
               here.operation == GM_OPERATION_NEGATE || here.operation == GM_OPERATION_WHOLE_POWER) {
        tidied = multiply(tidying, &product, node, 2) ? expanded(tidying, &product) : GM_NO_NODE;
    }
    return tidied == GM_NO_NODE ? node : tidied;
}

gm_node_id gm_formula_tidied(struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming)
{
    struct tidying tidying = {graph, naming, 0};
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(graph, node, &count);
    gm_node_id *tidied = malloc((node + (size_t)1) * sizeof *tidied); /* [node], set for parts alone */
    const bool good = parts && tidied;
    for (size_t k = 0; good && k < count && !graph->failed; k++) {
        const gm_node_id part = parts[k];
        const struct gm_node here = graph->nodes[part];
        tidied[part] = part;
        if (here.operation > GM_VARIABLE && (part == node || !is_named(&tidying, part))) {
            const gm_node_id second = tidied[gm_second_operand(&here)];
            tidied[part] = tidy(&tidying, apply(&tidying, here.operation, tidied[here.a], second));
        }
    }
    node = good && !graph->failed ? tidied[node] : GM_NO_NODE;
    free(parts);
    free(tidied);
    return node;
}
