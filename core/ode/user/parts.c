/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A part is a function H_k, whose rates are J grad H_k or B grad H_k, or the rates themselves. Parts of the
   structure are
       kinetic, potential    the rates of q, and those of p, where these separate
       linear, rest          the terms of degree 1 of the rates, and all others
       kepler, interaction   |p|^2/2 - 1/|q|, or the Kepler motions of Jacobi coordinates, and all else */
#include "core/ode/user/data.h"
#include "core/ode/user/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/linear_part.h"

enum structural { KINETIC, POTENTIAL, LINEAR, REST, KEPLER, INTERACTION, STRUCTURAL };
static const char *const structural[STRUCTURAL] = {"kinetic", "potential", "linear",
                                                   "rest",    "kepler",    "interaction"};

/* The line of a part; NULL: no line has that name. */
static const struct gm_system_item *item_of(const struct gm_user_system *system, const char *name)
{
    const struct gm_system_item *found = NULL;
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        const bool is_part =
            item->word == GM_WORD_PART || (item->word == GM_WORD_LET && system->kind != GM_RATES);
        found = is_part && strcmp(item->name, name) == 0 && item->nodes[0] != GM_NO_NODE &&
                        item->check != GM_NOT_ZERO /* else it has a time that the equations do not have */
                    ? item
                    : found;
    }
    return found;
}

static const struct gm_user_system *system_of(const struct gm_problem *problem)
{
    return gm_user_data_of(problem)->model->system;
}

static gm_node_id graft(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id node)
{
    return node == GM_NO_NODE ? gm_formula_constant(graph, 0)
                              : gm_formula_graft(graph, &system_of(problem)->graph, node, problem->n,
                                                 gm_user_data_of(problem)->values);
}

/* The rates of the energy `part`. */
static void rates_of_energy(struct gm_arena *arena, const struct gm_problem *problem,
                            struct gm_formula *graph, gm_node_id part, gm_node_id *rates)
{
    const struct gm_user_system *system = system_of(problem);
    const size_t n = system->n, half = n / 2;
    gm_node_id *gradient = gm_arena_take(arena, problem->n + 1, sizeof *gradient);
    gm_arena_need(arena, gm_gradient(graph, part, NULL, problem->n, gradient) && !graph->failed);
    for (size_t i = 0; i < n; i++) {
        rates[i] = system->kind == GM_POISSON ? gm_formula_constant(graph, 0)
                   : i < half                 ? gradient[half + i]
                                              : gm_negative(graph, gradient[i - half]);
        for (size_t k = 0; k < n && system->kind == GM_POISSON; k++) {
            const gm_node_id entry = graft(problem, graph, system->bracket[i * n + k]);
            rates[i] = gm_sum(graph, rates[i], gm_product(graph, entry, gradient[k]));
        }
    }
}

/* The rates of a field, of which the time has none. */
static void all_rates(const struct gm_problem *problem, struct gm_formula *graph, const gm_node_id *field,
                      gm_node_id *rates)
{
    for (size_t i = 0; i < problem->n; i++) {
        rates[i] = graft(problem, graph, field && i < system_of(problem)->n ? field[i] : GM_NO_NODE);
    }
}

/* Returns true unless a fact excludes such a part; the terms of degree 1 are looked for when they are asked for. */
static bool may_have(const struct gm_problem *problem, enum structural which)
{
    const struct gm_user_data *data = gm_user_data_of(problem);
    const struct gm_user_system *system = data->model->system;
    const bool written = system->kind == GM_CANONICAL || system->kind == GM_RATES;
    return which >= KEPLER   ? data->ode.kepler_split || data->ode.gravity
           : which >= LINEAR ? written && !system->timed
                             : written && gm_user_model_splits(data->model, data->values);
}

static gm_node_id scaled(struct gm_formula *graph, double factor, gm_node_id node)
{
    return gm_product(graph, gm_formula_constant(graph, factor), node);
}

/* The energy of the Kepler motions in Jacobi coordinates: with M = m_0 + ... + m_i, and M_0, P_0 the mass and momentum of
   the bodies before i, the sum of
       |p_i'|^2/(2 m_i M_0/M) - G m_i M_0/|x_i|,  p_i' = (M_0 p_i - m_i P_0)/M,
   and the motion of the centre of mass. */
static gm_node_id energy_in_jacobi(const struct gm_problem *problem, struct gm_formula *graph)
{
    const struct gm_gravity *gravity = gm_ode_of(problem)->gravity;
    const size_t d = gravity->dimensions, half = gravity->bodies * d;
    const gm_node_id zero = gm_formula_constant(graph, 0);
    gm_node_id centre[] = {zero, zero, zero}, momentum[] = {zero, zero, zero}, energy = zero;
    for (size_t i = 0; i < gravity->bodies; i++) {
        const double m = gravity->masses[i], M = gravity->sums[i], before = i > 0 ? gravity->sums[i - 1] : 0;
        gm_node_id square = zero, motion = zero, all = zero;
        for (size_t c = 0; c < d; c++) {
            const size_t place = gravity->places[i * d + c];
            const gm_node_id p = gm_formula_variable(graph, half + place),
                             x = gm_difference(graph, gm_formula_variable(graph, place), centre[c]),
                             own = gm_difference(graph, scaled(graph, before / M, p),
                                                 scaled(graph, m / M, momentum[c]));
            square = gm_sum(graph, square, gm_product(graph, x, x));
            motion = gm_sum(graph, motion, gm_product(graph, own, own));
            centre[c] = gm_sum(graph, centre[c], scaled(graph, m / M, x));
            momentum[c] = gm_sum(graph, momentum[c], p);
            all = gm_sum(graph, all, gm_product(graph, momentum[c], momentum[c]));
        }
        if (i > 0) {
            const gm_node_id root = gm_simplified(graph, GM_OPERATION_SQRT, square, 0),
                             attraction = gm_formula_constant(graph, gravity->G * m * before);
            energy = gm_sum(graph, energy, scaled(graph, M / (2 * m * before), motion));
            energy =
                gm_difference(graph, energy, gm_simplified(graph, GM_OPERATION_DIVIDE, attraction, root));
        }
        energy = i + 1 == gravity->bodies ? gm_sum(graph, energy, scaled(graph, 1 / (2 * M), all)) : energy;
    }
    return energy;
}

/* Writes a part of the structure. Returns false if the system has no such structure. */
static bool structural_rates(struct gm_arena *arena, const struct gm_problem *problem, enum structural which,
                             struct gm_formula *graph, gm_node_id *rates)
{
    const struct gm_user_data *data = gm_user_data_of(problem);
    const size_t n = problem->n, half = data->model->system->n / 2;
    const bool fast = gm_user_model_holds(data->model, data->values, GM_FACT_FAST_LINEAR);
    const bool kepler = which >= KEPLER, linear = !kepler && which >= LINEAR, second = which % 2 == 1;
    const gm_node_id *found_nodes =
        data->model->findings[kepler ? GM_FACT_KEPLER_SPLIT : GM_FACT_FAST_LINEAR].nodes;
    if (!may_have(problem, which)) {
        return false;
    }
    const gm_node_id zero = gm_formula_constant(graph, 0);
    bool *fields = gm_arena_take(arena, n, sizeof *fields), found = !linear;
    gm_node_id *motions = gm_arena_take(arena, n, sizeof *motions);
    const bool gravity = kepler && gm_ode_of(problem)->gravity;
    if (gravity) {
        rates_of_energy(arena, problem, graph, energy_in_jacobi(problem, graph), motions);
    }
    all_rates(problem, graph, data->model->system->rates, rates);
    memset(fields, true, n * sizeof *fields);
    for (size_t i = 0; i < n; i++) {
        gm_node_id first = i < half ? rates[i] : zero, other = gm_difference(graph, rates[i], first);
        if (gravity && i >= half) { /* both have all of q' and nothing of it */
            first = motions[i];
            other = gm_difference(graph, rates[i], first);
        } else if (i >= half && (kepler || (linear && fast))) {
            other = graft(problem, graph, found_nodes[kepler ? 1 + i - half : i]);
            first = gm_difference(graph, rates[i], other);
        } else if (linear && !fast) {
            struct gm_linear_split split;
            gm_arena_need(arena, gm_linear_part(graph, rates[i], fields, fields, n, &split));
            first = split.line;
            other = split.rest;
        }
        gm_arena_need(arena, !graph->failed);
        found = found || !gm_is_constant(graph, first, 0);
        rates[i] = second ? other : first;
    }
    return found;
}

static bool part_rates(struct gm_arena *arena, const struct gm_problem *problem, const char *name,
                       struct gm_formula *graph, gm_node_id *rates)
{
    const struct gm_user_system *system = system_of(problem);
    const struct gm_system_item *item = item_of(system, name);
    bool found = item;
    all_rates(problem, graph, item && system->kind == GM_RATES ? item->nodes : NULL, rates);
    if (item && system->kind != GM_RATES) {
        rates_of_energy(arena, problem, graph, graft(problem, graph, item->nodes[0]), rates);
    }
    for (enum structural which = 0; which < STRUCTURAL && !item; which++) {
        found = found || (strcmp(structural[which], name) == 0 &&
                          structural_rates(arena, problem, which, graph, rates));
    }
    gm_arena_need(arena, !graph->failed);
    return found;
}

/* The names with plus signs between them. */
static const char *sum_of(struct gm_arena *arena, const char *const *names, size_t count, const char *sign)
{
    const char *text = "";
    for (size_t i = 0; i < count; i++) {
        text = gm_arena_print(arena, "%s%s%.40s", text, i ? sign : "", names[i]);
    }
    return text;
}

/* Returns true for two parts of the structure of which one is made as all that the other is not. */
static bool is_pair(const struct gm_user_system *system, const char *const *names)
{
    size_t which[2] = {0};
    for (size_t k = 0; k < 2; k++) {
        while (which[k] < STRUCTURAL && strcmp(structural[which[k]], names[k]) != 0) {
            which[k]++;
        }
        which[k] = item_of(system, names[k]) ? STRUCTURAL : which[k];
    }
    return which[0] < STRUCTURAL && (which[0] ^ 1) == which[1];
}

static const char *parts_differ(struct gm_arena *arena, const struct gm_problem *problem,
                                const char *const *names, size_t count)
{
    const struct gm_user_system *system = system_of(problem);
    const size_t n = system->n;
    if (count == 2 && is_pair(system, names)) {
        return NULL;
    }
    struct gm_formula *graph = gm_arena_take(arena, 1, sizeof *graph);
    gm_node_id *rest = gm_arena_take(arena, problem->n + 1, sizeof *rest),
               *rates = gm_arena_take(arena, problem->n + 1, sizeof *rates);
    gm_formula_open(graph);
    gm_arena_keep(arena, graph, gm_formula_close);
    all_rates(problem, graph, system->rates, rest);
    gm_node_id energy = system->kind == GM_RATES ? GM_NO_NODE : graft(problem, graph, system->energy);
    for (size_t k = 0; k < count; k++) {
        const struct gm_system_item *item = item_of(system, names[k]);
        gm_arena_need(arena, part_rates(arena, problem, names[k], graph, rates));
        for (size_t i = 0; i < n; i++) {
            rest[i] = gm_difference(graph, rest[i], rates[i]);
        }
        energy = !item || energy == GM_NO_NODE
                     ? GM_NO_NODE
                     : gm_difference(graph, energy, graft(problem, graph, item->nodes[0]));
    }
    size_t wrong = 0;
    gm_arena_need(arena, !graph->failed);
    while (wrong < n && gm_identity_of(graph, rest[wrong], NULL, 0) != GM_NOT_ZERO) {
        wrong++;
    }
    const gm_node_id shown = energy != GM_NO_NODE ? energy : rest[wrong < n ? wrong : 0];
    double *at = gm_arena_keep(arena, malloc((shown + (size_t)1) * sizeof *at), free);
    gm_formula_evaluate(graph, shown + 1, gm_user_data_of(problem)->values, at);
    if (wrong == n && (energy == GM_NO_NODE || isfinite(at[energy]))) {
        return NULL;
    }
    const struct gm_naming naming = gm_system_naming(system),
                           written = {.variable = naming.variable, .data = naming.data};
    char *text = gm_formula_text(graph, shown, &written);
    const char *difference = text ? gm_arena_print(arena, "%.120s", text) : "a long formula";
    free(text);
    const char *sum = sum_of(arena, names, count, " + ");
    return energy == GM_NO_NODE
               ? gm_arena_print(
                     arena,
                     "parts that sum to the rates: the rate of %s has, beside %s, %s (%.6g at the start)",
                     system->variables[wrong].name, sum, difference, at[shown] + 0)
               : gm_arena_print(arena, "parts that sum to H: %s is not H, H - %s = %s (%.6g at the start)",
                                sum, sum_of(arena, names, count, " - "), difference, at[shown]);
}

void gm_user_parts_open(const struct gm_problem *problem)
{
    struct gm_user_data *data = gm_user_data_of(problem);
    const struct gm_user_system *system = data->model->system;
    const bool written =
        system->kind == GM_CANONICAL || system->kind == GM_POISSON || system->kind == GM_RATES;
    size_t count = 0;
    const char **names = gm_arena_take(data->arena, system->item_count + STRUCTURAL + 1, sizeof *names);
    for (size_t i = 0; i < system->item_count && written; i++) {
        if (item_of(system, system->items[i].name ? system->items[i].name : "") == &system->items[i]) {
            names[count++] = system->items[i].name;
        }
    }
    const size_t given = count;
    for (enum structural which = 0; which < STRUCTURAL && written; which++) {
        if (!item_of(system, structural[which]) && may_have(problem, which)) {
            names[count++] = structural[which];
        }
    }
    data->parts = (struct gm_parts){names, given, system->timed, part_rates, parts_differ};
    data->ode.parts = count > 0 ? &data->parts : NULL;
}
