/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Differentiation of the graph with the partial derivatives of operations.def: upwards along a vector,
   downwards for a gradient. */
#include "core/expression/derivative.h"

#include <stdlib.h>
#include <string.h>

#include "core/expression/reader.h"

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    const gm_node_id *operands = data;
    (void)sentence;
    *node = operands[name->text[0] == 'a' ? 0 : name->text[0] == 'b' ? 1 : 2];
    return GM_KNOWN;
}

/* d node / d operand number i */
static gm_node_id partial(struct gm_formula *graph, gm_node_id node, int i)
{
    gm_node_id operands[3] = {graph->nodes[node].a, graph->nodes[node].b, node}, result;
    const char *text = gm_operation_rows[graph->nodes[node].operation].partials[i];
    const struct gm_scope scope = {.find = find, .data = operands, .derives = true};
    struct gm_fault fault;
    gm_formula_read(graph, text, 0, strlen(text), &scope, &result, &fault);
    return result;
}

/* True for a sum of chosen parts. */
static bool is_chosen(const struct gm_formula *graph, gm_node_id node)
{
    const struct gm_node *here = &graph->nodes[node];
    return here->operation == GM_OPERATION_CHOSEN ||
           (here->operation == GM_OPERATION_ADD && is_chosen(graph, here->a) && is_chosen(graph, here->b));
}

/* The product of a factor and a slope, which need not be finite where the factor is not chosen: a choice encloses
   the product. */
static gm_node_id product(struct gm_formula *graph, gm_node_id factor, gm_node_id slope)
{
    const struct gm_node here = graph->nodes[factor];
    if (!is_chosen(graph, factor)) {
        return gm_formula_apply(graph, GM_OPERATION_MULTIPLY, factor, slope);
    }
    const bool sum = here.operation == GM_OPERATION_ADD;
    const gm_node_id a = sum ? product(graph, here.a, slope) : here.a, b = product(graph, here.b, slope);
    return gm_formula_apply(graph, here.operation, a, b);
}

/* sum + factor * d node / d operand i */
static gm_node_id add_product(struct gm_formula *graph, gm_node_id sum, gm_node_id factor, gm_node_id node,
                              int i)
{
    const bool choice = graph->nodes[node].operation == GM_OPERATION_CHOSEN && i == 1;
    const gm_node_id slope = choice
                                 ? gm_formula_apply(graph, GM_OPERATION_CHOSEN, graph->nodes[node].a, factor)
                                 : product(graph, factor, partial(graph, node, i));
    return sum == GM_NO_NODE ? slope : gm_formula_apply(graph, GM_OPERATION_ADD, sum, slope);
}

gm_node_id gm_derivative_along(struct gm_formula *graph, gm_node_id root, const gm_node_id *direction,
                               size_t variables)
{
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(graph, root, &count), slope = GM_NO_NODE;
    gm_node_id *slopes = malloc((root + (size_t)1) * sizeof *slopes); /* [node], set for parts alone */
    if (!parts || !slopes) {
        free(parts);
        free(slopes);
        graph->failed = true;
        return GM_NO_NODE;
    }
    graph->simplifies = true;
    const gm_node_id zero = gm_formula_constant(graph, 0);
    for (size_t k = 0; k < count && !graph->failed; k++) {
        const gm_node_id i = parts[k];
        const struct gm_node node = graph->nodes[i];
        slopes[i] = node.operation == GM_VARIABLE && node.a < variables ? direction[node.a] : zero;
        if (node.operation > GM_VARIABLE) {
            slope = GM_NO_NODE;
            graph->origin = gm_formula_origin(graph, i);
            if (slopes[node.a] != zero) {
                slope = add_product(graph, slope, slopes[node.a], i, 0);
            }
            if (gm_operation_rows[node.operation].arity == 2 && slopes[node.b] != zero) {
                slope = add_product(graph, slope, slopes[node.b], i, 1);
            }
            slopes[i] = slope == GM_NO_NODE ? zero : slope;
        }
    }
    graph->origin = GM_NO_PLACE;
    graph->simplifies = false;
    slope = graph->failed ? GM_NO_NODE : slopes[root];
    free(parts);
    free(slopes);
    return slope;
}

bool gm_gradient(struct gm_formula *graph, gm_node_id root, const bool *marked, size_t variables,
                 gm_node_id *gradient)
{
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(graph, root, &count);
    gm_node_id *adjoint = malloc((root + (size_t)1) * sizeof *adjoint); /* [node], set for parts alone */
    bool *active = malloc(root + (size_t)1);
    if (parts && adjoint && active) {
        graph->simplifies = true;
        const gm_node_id zero = gm_formula_constant(graph, 0);
        for (size_t i = 0; i < variables; i++) {
            gradient[i] = zero;
        }
        for (size_t k = 0; k < count; k++) {
            const struct gm_node *node = &graph->nodes[parts[k]];
            adjoint[parts[k]] = GM_NO_NODE;
            active[parts[k]] = node->operation == GM_VARIABLE
                                   ? node->a < variables && (!marked || marked[node->a])
                                   : node->operation > GM_VARIABLE &&
                                         (active[node->a] ||
                                          (gm_operation_rows[node->operation].arity == 2 && active[node->b]));
        }
        adjoint[root] = gm_formula_constant(graph, 1);
        for (size_t k = count; k-- > 0 && !graph->failed;) {
            const gm_node_id i = parts[k];
            const struct gm_node node = graph->nodes[i];
            if (adjoint[i] == GM_NO_NODE || adjoint[i] == zero || !active[i]) {
                continue;
            }
            if (node.operation == GM_VARIABLE) {
                gradient[node.a] = adjoint[i];
                continue;
            }
            graph->origin = gm_formula_origin(graph, i);
            if (active[node.a]) {
                adjoint[node.a] = add_product(graph, adjoint[node.a], adjoint[i], i, 0);
            }
            if (gm_operation_rows[node.operation].arity == 2 && active[node.b]) {
                adjoint[node.b] = add_product(graph, adjoint[node.b], adjoint[i], i, 1);
            }
        }
        graph->origin = GM_NO_PLACE;
        graph->simplifies = false;
    } else {
        graph->failed = true;
    }
    free(parts);
    free(active);
    free(adjoint);
    return !graph->failed;
}
