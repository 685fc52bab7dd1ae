/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rate is a sum of products of fields and derivatives with constant coefficients. A coefficient is the derivative over
   its factors where all fields are 0; the rate without all terms is then the zero of the graph. */
#include "core/model/recognition.h"

#include <math.h>
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
                                 const gm_node_id *zeros, const bool *varying)
{
    struct gm_formula *graph = &system->graph;
    gm_node_id node = system->rates[term->rate];
    double power = 0, product = term->sign;
    for (const char *at = term->factors; *at; at++) {
        power = at > term->factors && *at == at[-1] ? power + 1 : 1;
        product *= power;
        node = gm_system_derivative(system, node, variable_of(system, *at));
    }
    gm_system_need_graph(system);
    gm_arena_need(system->arena, gm_formula_substitute(graph, &node, 1, zeros, system->variable_count));
    return gm_is_constant(graph, node, 0) || gm_formula_holds(graph, node, varying, system->variable_count)
               ? GM_NO_NODE
               : gm_simplified(graph, GM_OPERATION_DIVIDE, node, gm_formula_constant(graph, product));
}

static bool is_equation(struct gm_user_system *system, const struct known_equation *equation,
                        const gm_node_id *zeros, const bool *varying, gm_node_id values[ONE + 1])
{
    struct gm_formula *graph = &system->graph;
    gm_node_id rests[GM_MOST_FIELDS];
    memcpy(rests, system->rates, system->n * sizeof *rests);
    values[0] = values[1] = GM_NO_NODE;
    values[ONE] = gm_formula_constant(graph, 1);
    for (const struct term *term = equation->terms; term < equation->terms + MOST_TERMS && term->factors;
         term++) {
        gm_node_id *value = &values[term->constant], *rest = &rests[term->rate];
        *value = *value == GM_NO_NODE ? coefficient_of(system, term, zeros, varying) : *value;
        if (*value == GM_NO_NODE) {
            return false;
        }
        gm_node_id product = *value;
        for (const char *at = term->factors; *at; at++) {
            product = gm_product(graph, product, gm_formula_variable(graph, variable_of(system, *at)));
        }
        *rest = (term->sign > 0 ? gm_difference : gm_sum)(graph, *rest, product);
    }
    bool vanish = true;
    for (size_t i = 0; i < system->n && vanish; i++) {
        const enum gm_identity identity = gm_equations_vanishes(system, rests[i]);
        vanish = identity == GM_ZERO_PROVED || identity == GM_ZERO_TESTED;
    }
    return vanish;
}

/* A system, and what is found of it. */
struct recognition {
    struct gm_user_system *system;
    struct gm_recognised *equation;
    struct gm_user_wave *wave;
};

static void recognise_equation(struct gm_arena *arena, void *data)
{
    struct gm_user_system *system = ((struct recognition *)data)->system;
    struct gm_recognised *found = ((struct recognition *)data)->equation;
    gm_node_id *zeros = gm_arena_take(arena, system->variable_count, sizeof *zeros), values[ONE + 1];
    bool *varying = gm_arena_take(arena, system->variable_count, sizeof *varying); /* all but parameters */
    *found = (struct gm_recognised){.name = NULL};
    for (size_t i = 0; i < system->variable_count; i++) {
        const bool is_field = i < system->n || (i > system->velocities && i < system->initial);
        varying[i] = i < system->parameters || i >= system->velocities;
        zeros[i] = is_field ? gm_formula_constant(&system->graph, 0) : GM_NO_NODE;
    }
    for (size_t i = 0; i < GM_COUNT(known_equations) && !found->name; i++) {
        if (known_equations[i].fields == system->n && system->kind == GM_EVOLUTION &&
            !gm_system_item_of(system, GM_WORD_MASS, 0) &&
            is_equation(system, &known_equations[i], zeros, varying, values)) {
            found->name = known_equations[i].name;
            memcpy(found->constants, known_equations[i].constants, sizeof found->constants);
            memcpy(found->values, values, sizeof found->values);
        }
    }
    gm_system_need_graph(system);
}

bool gm_equation_recognise(struct gm_user_system *system, struct gm_recognised *found)
{
    return gm_arena_run(system->arena, recognise_equation, &(struct recognition){system, found, NULL});
}

/* ---- waves, u_tt = u_xx - V'(u): derivatives of V, and of the field at the start ---- */

/* The degree of a formula as a polynomial in variable 0; INFINITY if it is not written as one. */
static double degree_of(const struct gm_user_system *system, gm_node_id formula)
{
    const struct gm_node *nodes = system->graph.nodes;
    double *degrees = gm_arena_take(system->arena, formula + (size_t)1, sizeof *degrees);
    for (gm_node_id i = 0; i <= formula; i++) {
        const struct gm_node *node = &nodes[i];
        const enum gm_operation operation = node->operation;
        if (operation <= GM_VARIABLE) {
            degrees[i] = operation == GM_VARIABLE && node->a == 0;
            continue;
        }
        const double a = degrees[node->a], b = gm_operation_rows[operation].arity == 2 ? degrees[node->b] : 0;
        degrees[i] = a + b == 0 ? 0 : INFINITY;
        if (operation == GM_OPERATION_ADD || operation == GM_OPERATION_SUBTRACT) {
            degrees[i] = fmax(a, b);
        } else if (operation == GM_OPERATION_MULTIPLY || operation == GM_OPERATION_NEGATE) {
            degrees[i] = a + b;
        } else if (operation == GM_OPERATION_DIVIDE && b == 0) {
            degrees[i] = a;
        } else if (operation == GM_OPERATION_WHOLE_POWER && a > 0 && nodes[node->b].value > 0) {
            degrees[i] = a * nodes[node->b].value;
        }
    }
    return degrees[formula];
}

/* Recognises 1 - cos u, however it is written. */
static bool is_sine_gordon(struct gm_user_system *system)
{
    struct gm_formula *graph = &system->graph;
    const gm_node_id u = gm_formula_variable(graph, 0),
                     known = gm_difference(graph, gm_formula_constant(graph, 1),
                                           gm_simplified(graph, GM_OPERATION_COS, u, u));
    const enum gm_identity identity =
        gm_equations_vanishes(system, gm_difference(graph, system->energy, known));
    return identity == GM_ZERO_PROVED || identity == GM_ZERO_TESTED;
}

/* With u at the start, f = V'(u), f' = V'', f'' = V''':
       u_tt   = u_xx - f
       u_ttt  = (u_t)_xx - f' u_t
       u_tttt = (u_tt)_xx - f'' u_t^2 - f' u_tt */
static void derive_start(struct gm_user_wave *wave, struct gm_user_system *system)
{
    enum { U, U_T, F = 0, F1, F2 };
    const size_t x = system->velocities;
    gm_node_id *at = wave->start,
               force[GM_TYPED_DERIVATIVES] = {wave->by_u[F], wave->by_u[F1], wave->by_u[F2]}, u[1];
    u[0] = at[0] = system->variables[U].start;
    at[1] = system->variables[U_T].start;
    gm_system_need_graph(system);
    gm_arena_need(system->arena, gm_formula_substitute(&system->graph, force, GM_TYPED_DERIVATIVES, u, 1));
    for (size_t k = 2; k < gm_wave_start_count(wave); k++) {
        const gm_node_id bend = gm_system_derivative(system, gm_system_derivative(system, at[k - 2], x), x);
        gm_node_id rate = force[F];
        if (k > 2) {
            rate = gm_product(&system->graph, force[F1], at[k - 2]);
        }
        if (k == 4) {
            const gm_node_id square = gm_product(&system->graph, at[1], at[1]);
            rate = gm_sum(&system->graph, rate, gm_product(&system->graph, force[F2], square));
        }
        gm_system_need_graph(system);
        at[k] = gm_difference(&system->graph, bend, rate);
    }
}

static void derive_wave(struct gm_arena *arena, void *data)
{
    struct gm_user_wave *wave = ((struct recognition *)data)->wave;
    struct gm_user_system *system = ((struct recognition *)data)->system;
    const struct gm_system_item *known = gm_system_item_of(system, GM_WORD_EXACT_WHILE, 0);
    *wave = (struct gm_user_wave){.system = system,
                                  .exact = system->variables[0].exact,
                                  .drift = system->drift,
                                  .exact_while = known ? known->nodes[0] : GM_NO_NODE};
    gm_node_id last = system->energy;
    for (size_t k = 0; k < GM_TYPED_DERIVATIVES; k++) {
        last = wave->by_u[k] = gm_system_derivative(system, last, 0);
    }
    gm_system_need_graph(system);
    wave->degree = degree_of(system, wave->by_u[0]);
    bool *others = gm_arena_take(arena, system->variable_count, sizeof *others);
    memset(others + 1, true, system->variable_count - 1);
    if (!gm_formula_holds(&system->graph, system->energy, others, system->variable_count)) {
        wave->sine_gordon = is_sine_gordon(system);
    }
    wave->start_slope = gm_system_derivative(system, system->variables[0].start, system->velocities);
    derive_start(wave, system);
    gm_node_id *const placed[] = {&wave->start_slope, &wave->drift, &wave->exact, &wave->exact_while};
    gm_arena_need(arena, gm_system_place(system, wave->start, GM_TYPED_START));
    for (size_t i = 0; i < GM_COUNT(placed); i++) {
        gm_arena_need(arena, *placed[i] == GM_NO_NODE || gm_system_place(system, placed[i], 1));
    }
}

bool gm_user_wave_derive(struct gm_user_wave *wave, struct gm_user_system *system)
{
    return gm_arena_run(system->arena, derive_wave, &(struct recognition){system, NULL, wave});
}
