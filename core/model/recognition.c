/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rate is a sum of products of fields and derivatives with constant coefficients. A coefficient is the derivative over
   its factors where all fields are 0; the rate without all terms is then the zero of the graph. */
#include "core/model/recognition.h"

#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/model/equations.h"

enum { ONE = GM_EQUATION_CONSTANTS, MOST_TERMS = 6 };

/* Terms: in the rate of which field, which constant (ONE: 1), its sign, and its factors in rising order: u, u_x, u_xx ..
   are 0, 1, 2 .., and of a second field a, b, c .. */
static const struct known_equation {
    const char *name;
    size_t fields;
    const char *constants[GM_EQUATION_CONSTANTS];
    struct term {
        size_t rate, constant;
        int sign;
        const char *factors; /* NULL behind the last */
    } terms[MOST_TERMS];
} known_equations[] = {
    {"Korteweg-de Vries", 1, {"eta", "mu"}, {{0, 0, -1, "01"}, {0, 1, -1, "3"}}},
    {"Burgers", 1, {"nu"}, {{0, ONE, -1, "01"}, {0, 0, 1, "2"}}},
    {"heat", 1, {"c"}, {{0, 0, 1, "2"}}},
    {"nonlinear Schrödinger",
     2,
     {"k"},
     {{0, 0, -1, "00a"},
      {0, 0, -1, "aaa"},
      {0, ONE, -1, "c"},
      {1, 0, 1, "000"},
      {1, 0, 1, "0aa"},
      {1, ONE, 1, "2"}}},
};

static size_t variable_of(const struct gm_user_system *system, char factor)
{
    const size_t field = factor >= 'a', order = (size_t)(factor - (field ? 'a' : '0'));
    return order == 0 ? field : system->velocities + 1 + (order - 1) * system->n + field;
}

/* The coefficient of a term with its sign, in parameters; GM_NO_NODE if it is 0 or depends on the place. */
static gm_node_id coefficient_of(struct gm_user_system *system, const struct term *term,
                                 const gm_node_id *zeros)
{
    struct gm_formula *graph = &system->graph;
    gm_node_id node = system->rates[term->rate];
    double power = 0, product = term->sign;
    for (const char *at = term->factors; *at; at++) {
        power = at > term->factors && *at == at[-1] ? power + 1 : 1;
        product *= power;
        node = gm_system_derivative(system, node, variable_of(system, *at));
    }
    if (graph->failed || !gm_formula_substitute(graph, &node, 1, zeros, system->variable_count)) {
        return GM_NO_NODE;
    }
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(graph, node, &count);
    bool constant = parts && !gm_is_constant(graph, node, 0);
    for (size_t i = 0; constant && i < count; i++) {
        const struct gm_node *part = &graph->nodes[parts[i]];
        constant =
            part->operation != GM_VARIABLE || (part->a >= system->parameters && part->a < system->velocities);
    }
    free(parts);
    return constant ? gm_simplified(graph, GM_OPERATION_DIVIDE, node, gm_formula_constant(graph, product))
                    : GM_NO_NODE;
}

static bool is_equation(struct gm_user_system *system, const struct known_equation *equation,
                        const gm_node_id *zeros, gm_node_id values[ONE + 1])
{
    struct gm_formula *graph = &system->graph;
    gm_node_id rests[GM_MOST_FIELDS];
    memcpy(rests, system->rates, system->n * sizeof *rests);
    values[0] = values[1] = GM_NO_NODE;
    values[ONE] = gm_formula_constant(graph, 1);
    for (const struct term *term = equation->terms; term < equation->terms + MOST_TERMS && term->factors;
         term++) {
        gm_node_id *value = &values[term->constant], *rest = &rests[term->rate];
        *value = *value == GM_NO_NODE ? coefficient_of(system, term, zeros) : *value;
        if (*value == GM_NO_NODE) {
            return false;
        }
        gm_node_id product = *value;
        for (const char *at = term->factors; *at; at++) {
            product = gm_simplified(graph, GM_OPERATION_MULTIPLY, product,
                                    gm_formula_variable(graph, variable_of(system, *at)));
        }
        *rest =
            gm_simplified(graph, term->sign > 0 ? GM_OPERATION_SUBTRACT : GM_OPERATION_ADD, *rest, product);
    }
    bool vanish = !graph->failed;
    for (size_t i = 0; i < system->n && vanish; i++) {
        const enum gm_identity identity = gm_equations_vanishes(system, rests[i]);
        vanish = identity == GM_ZERO_PROVED || identity == GM_ZERO_TESTED;
    }
    return vanish;
}

bool gm_equation_recognise(struct gm_user_system *system, struct gm_recognised *found)
{
    gm_node_id *zeros = malloc(system->variable_count * sizeof *zeros), values[ONE + 1];
    *found = (struct gm_recognised){.name = NULL};
    for (size_t i = 0; zeros && i < system->variable_count; i++) {
        const bool varies = i < system->n || (i > system->velocities && i < system->initial);
        zeros[i] = varies ? gm_formula_constant(&system->graph, 0) : GM_NO_NODE;
    }
    for (size_t i = 0; zeros && i < GM_COUNT(known_equations) && !found->name; i++) {
        if (known_equations[i].fields == system->n && system->kind == GM_EVOLUTION &&
            !gm_system_item_of(system, GM_WORD_MASS, 0) &&
            is_equation(system, &known_equations[i], zeros, values)) {
            found->name = known_equations[i].name;
            memcpy(found->constants, known_equations[i].constants, sizeof found->constants);
            memcpy(found->values, values, sizeof found->values);
        }
    }
    free(zeros);
    return zeros && !system->graph.failed;
}
