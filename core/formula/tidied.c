/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tidies formulas from their leaves upwards: products by their factors, sums by their terms. */
#include "core/formula/tidied.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 32, MOST_VISITED = 4 * MOST, MOST_POWER = 64 };

struct tidying {
    struct gm_formula *graph;
    const struct gm_naming *naming;
};

struct factor {
    gm_node_id base;
    long halves; /* its power, in halves */
};

/* above / below times the factors */
struct product {
    double above, below;
    struct factor factors[MOST];
    size_t count, visited;
    bool long_winded; /* there is no room for them */
};

struct term {
    gm_node_id node;
    bool minus;
};

struct sum {
    struct term terms[MOST];
    size_t count, visited;
    bool long_winded;
};

static bool is_named(const struct tidying *tidying, gm_node_id node)
{
    return tidying->naming->part && tidying->naming->part(node, tidying->naming->data);
}

static bool is_whole(double value, double most)
{
    return value == floor(value) && fabs(value) <= most;
}

static gm_node_id apply(const struct tidying *tidying, enum gm_operation operation, gm_node_id a,
                        gm_node_id b)
{
    return gm_formula_apply(tidying->graph, operation, a, b);
}

/* ---- products ---- */

/* In the order in which they were first written, so that equal products are one node. */
static void add_factor(struct product *product, gm_node_id base, long halves)
{
    size_t i = 0;
    while (i < product->count && product->factors[i].base < base) {
        i++;
    }
    if (i < product->count && product->factors[i].base == base) {
        product->factors[i].halves += halves;
        return;
    }
    product->long_winded = product->count == MOST;
    if (!product->long_winded) {
        memmove(&product->factors[i + 1], &product->factors[i],
                (product->count++ - i) * sizeof product->factors[i]);
        product->factors[i] = (struct factor){base, halves};
    }
}

/* The power of a constant. */
static void multiply_constant(struct product *product, double value, long power)
{
    double *to = power > 0 ? &product->above : &product->below;
    *to *= pow(value, fabs((double)power));
}

/* Multiplies by the power of a node that is tidy. */
static void multiply(const struct tidying *tidying, struct product *product, gm_node_id node, long halves)
{
    product->long_winded = product->long_winded || ++product->visited > MOST_VISITED;
    if (product->long_winded) {
        return;
    }
    const struct gm_node here = tidying->graph->nodes[node];
    const struct gm_node *exponent =
        here.operation == GM_OPERATION_POWER || here.operation == GM_OPERATION_WHOLE_POWER
            ? &tidying->graph->nodes[here.b]
            : NULL;
    const bool raised =
        exponent && exponent->operation == GM_CONSTANT && is_whole(exponent->value, MOST_POWER);
    const bool whole = halves % 2 == 0 && labs(halves) <= MOST_POWER && !is_named(tidying, node);
    if (whole && here.operation == GM_CONSTANT) {
        multiply_constant(product, here.value, halves / 2);
    } else if (whole && here.operation == GM_OPERATION_NEGATE) {
        product->above *= halves / 2 % 2 ? -1 : 1;
        multiply(tidying, product, here.a, halves);
    } else if (whole && (here.operation == GM_OPERATION_MULTIPLY || here.operation == GM_OPERATION_DIVIDE)) {
        multiply(tidying, product, here.a, halves);
        multiply(tidying, product, here.b, here.operation == GM_OPERATION_DIVIDE ? -halves : halves);
    } else if (whole && raised) {
        multiply(tidying, product, here.a, halves * (long)exponent->value);
    } else if (halves % 2 == 0 && here.operation == GM_OPERATION_SQRT) {
        add_factor(product, here.a, halves / 2);
    } else {
        add_factor(product, node, halves);
    }
}

static gm_node_id times(const struct tidying *tidying, gm_node_id product, gm_node_id factor)
{
    return product == GM_NO_NODE ? factor : apply(tidying, GM_OPERATION_MULTIPLY, product, factor);
}

static gm_node_id power(const struct tidying *tidying, gm_node_id base, long exponent)
{
    const gm_node_id number = gm_formula_constant(tidying->graph, (double)exponent);
    return exponent == 1 ? base : apply(tidying, GM_OPERATION_POWER, base, number);
}

/* `product` times base^(halves / 2), halves > 0. */
static gm_node_id times_power(const struct tidying *tidying, gm_node_id product, gm_node_id base, long halves)
{
    const gm_node_id root = apply(tidying, GM_OPERATION_SQRT, base, base);
    if (is_named(tidying, root)) {
        return times(tidying, product, power(tidying, root, halves));
    }
    if (halves > 1) {
        product = times(tidying, product, power(tidying, base, halves / 2));
    }
    return halves % 2 ? times(tidying, product, root) : product;
}

/* Divides two whole numbers by what they have in common; 0.5 is 1 above 2. */
static void reduce(double *above, double *below)
{
    enum { MOST_HALVED = 1024 };
    if (is_whole(*above * MOST_HALVED, 0x1p53) && is_whole(*below * MOST_HALVED, 0x1p53)) {
        *above *= MOST_HALVED;
        *below *= MOST_HALVED;
    }
    double a = fabs(*above), b = fabs(*below);
    if (!is_whole(a, 0x1p53) || !is_whole(b, 0x1p53)) {
        return;
    }
    while (b > 0) {
        const double rest = fmod(a, b);
        a = b;
        b = rest;
    }
    *above /= a;
    *below /= a;
}

static gm_node_id written_product(const struct tidying *tidying, struct product *product)
{
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
            const long halves = side ? -product->factors[i].halves : product->factors[i].halves;
            if (halves > 0) {
                sides[side] = times_power(tidying, sides[side], product->factors[i].base, halves);
            }
        }
    }
    gm_node_id node = sides[0] == GM_NO_NODE ? gm_formula_constant(tidying->graph, 1) : sides[0];
    node = sides[1] == GM_NO_NODE ? node : apply(tidying, GM_OPERATION_DIVIDE, node, sides[1]);
    return minus ? apply(tidying, GM_OPERATION_NEGATE, node, node) : node;
}

/* ---- sums ---- */

/* A term and the same with the other sign are nothing. */
static void add_term(struct sum *sum, gm_node_id node, bool minus)
{
    for (size_t i = 0; i < sum->count; i++) {
        if (sum->terms[i].node == node && sum->terms[i].minus != minus) {
            memmove(&sum->terms[i], &sum->terms[i + 1], (--sum->count - i) * sizeof sum->terms[i]);
            return;
        }
    }
    if (sum->count == MOST) {
        sum->long_winded = true;
        return;
    }
    sum->terms[sum->count++] = (struct term){node, minus};
}

static void add(const struct tidying *tidying, struct sum *sum, gm_node_id node, bool minus)
{
    sum->long_winded = sum->long_winded || ++sum->visited > MOST_VISITED;
    if (sum->long_winded) {
        return;
    }
    const struct gm_node here = tidying->graph->nodes[node];
    const bool named = is_named(tidying, node);
    if (!named && (here.operation == GM_OPERATION_ADD || here.operation == GM_OPERATION_SUBTRACT)) {
        add(tidying, sum, here.a, minus);
        add(tidying, sum, here.b, minus != (here.operation == GM_OPERATION_SUBTRACT));
    } else if (!named && here.operation == GM_OPERATION_NEGATE) {
        add(tidying, sum, here.a, !minus);
    } else if (named || !gm_is_constant(tidying->graph, node, 0)) {
        add_term(sum, node, minus);
    }
}

static gm_node_id written_sum(const struct tidying *tidying, const struct sum *sum)
{
    size_t first = 0;
    if (sum->count == 0) {
        return gm_formula_constant(tidying->graph, 0);
    }
    while (first < sum->count && sum->terms[first].minus) {
        first++;
    }
    first = first == sum->count ? 0 : first;
    gm_node_id node = sum->terms[first].node;
    node = sum->terms[first].minus ? apply(tidying, GM_OPERATION_NEGATE, node, node) : node;
    for (size_t i = 0; i < sum->count; i++) {
        if (i != first) {
            node = apply(tidying, sum->terms[i].minus ? GM_OPERATION_SUBTRACT : GM_OPERATION_ADD, node,
                         sum->terms[i].node);
        }
    }
    return node;
}

/* ---- both ---- */

/* The factor that is a sum which was derived, where others are beside it: differentiation puts terms in parentheses that
   nobody has typed. MOST: there is none. */
static size_t derived_sum(const struct tidying *tidying, const struct product *product)
{
    for (size_t i = 0; i < product->count; i++) {
        const gm_node_id base = product->factors[i].base;
        const enum gm_operation operation = tidying->graph->nodes[base].operation;
        if (product->factors[i].halves == 2 && !is_named(tidying, base) &&
            tidying->graph->places[base] == GM_NO_PLACE &&
            (operation == GM_OPERATION_ADD || operation == GM_OPERATION_SUBTRACT)) {
            return i;
        }
    }
    return MOST;
}

/* A product, a derived sum among its factors term by term; GM_NO_NODE: it is too long. */
static gm_node_id expanded(const struct tidying *tidying, struct product *product)
{
    const size_t at = derived_sum(tidying, product);
    struct sum sum = {.count = 0}, all = {.count = 0};
    if (at == MOST) {
        return written_product(tidying, product);
    }
    add(tidying, &sum, product->factors[at].base, false);
    product->factors[at].halves = 0;
    for (size_t i = 0; i < sum.count; i++) {
        struct product term = *product;
        multiply(tidying, &term, sum.terms[i].node, 2);
        if (term.long_winded || !isfinite(term.above) || !isfinite(term.below) || term.below == 0) {
            return GM_NO_NODE;
        }
        add(tidying, &all, written_product(tidying, &term), sum.terms[i].minus);
    }
    return sum.long_winded || all.long_winded ? GM_NO_NODE : written_sum(tidying, &all);
}

/* An operation on what is tidy. */
static gm_node_id tidy(const struct tidying *tidying, enum gm_operation operation, gm_node_id a, gm_node_id b)
{
    const gm_node_id plain = apply(tidying, operation, a, b);
    const enum gm_operation inner = tidying->graph->nodes[a].operation;
    const bool negated_sum =
        operation == GM_OPERATION_NEGATE && (inner == GM_OPERATION_ADD || inner == GM_OPERATION_SUBTRACT);
    if (operation == GM_OPERATION_ADD || operation == GM_OPERATION_SUBTRACT || negated_sum) {
        struct sum sum = {.count = 0};
        add(tidying, &sum, plain, false);
        return sum.long_winded ? plain : written_sum(tidying, &sum);
    }
    if (operation == GM_OPERATION_MULTIPLY || operation == GM_OPERATION_DIVIDE ||
        operation == GM_OPERATION_NEGATE || operation == GM_OPERATION_WHOLE_POWER) {
        struct product product = {.above = 1, .below = 1};
        multiply(tidying, &product, plain, 2);
        const bool number =
            isfinite(product.above) && isfinite(product.below) && product.above != 0 && product.below != 0;
        const gm_node_id node = product.long_winded || !number ? GM_NO_NODE : expanded(tidying, &product);
        return node == GM_NO_NODE ? plain : node;
    }
    return plain;
}

gm_node_id gm_formula_tidied(struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming)
{
    const struct tidying tidying = {graph, naming};
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(graph, node, &count);
    gm_node_id *tidied = malloc((node + (size_t)1) * sizeof *tidied); /* of the parts alone */
    const bool good = parts && tidied;
    for (size_t k = 0; good && k < count && !graph->failed; k++) {
        const struct gm_node here = graph->nodes[parts[k]];
        const bool whole =
            here.operation <= GM_VARIABLE || (parts[k] != node && is_named(&tidying, parts[k]));
        const bool two = !whole && gm_operation_rows[here.operation].arity == 2;
        tidied[parts[k]] =
            whole ? parts[k] : tidy(&tidying, here.operation, tidied[here.a], tidied[two ? here.b : here.a]);
    }
    node = good && !graph->failed ? tidied[node] : GM_NO_NODE;
    free(parts);
    free(tidied);
    return node;
}
