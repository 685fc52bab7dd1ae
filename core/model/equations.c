/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equations of motion by exact derivatives, and the checks of a file's claims. */
#include "core/model/equations.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/derivative.h"
#include "core/expression/linear_part.h"
#include "core/functions/functions.h"
#include "core/linear/iteration.h"
#include "core/model/breaks.h"
#include "core/tape.h"

static gm_node_id add_force(struct gm_user_system *system, gm_node_id rate, gm_node_id force)
{
    return force == GM_NO_NODE ? rate : gm_sum(&system->graph, rate, force);
}

gm_node_id *gm_equations_gradient(struct gm_user_system *system, gm_node_id node, const bool *marked)
{
    gm_node_id *gradient = gm_arena_take(system->arena, system->variable_count + 1, sizeof *gradient);
    gm_arena_need(system->arena, gm_gradient(&system->graph, node, marked, system->variable_count, gradient));
    return gradient;
}

double *gm_equations_values(const struct gm_user_system *system, const double *variables)
{
    double *values = gm_arena_take(system->arena, system->graph.count + (size_t)1, sizeof *values);
    gm_formula_evaluate(&system->graph, system->graph.count, variables, values);
    return values;
}

/* A flag for each variable, true from number `first` on for `count` ones. */
static bool *marks_of(const struct gm_user_system *system, size_t first, size_t count)
{
    bool *marked = gm_arena_take(system->arena, system->variable_count, sizeof *marked);
    memset(marked + first, true, count * sizeof *marked);
    return marked;
}

/* A direction of all components and the time: these nodes, and the speed of the time; NULL: it is not set. Other
   variables rest. */
static gm_node_id *direction_of(struct gm_user_system *system, const gm_node_id *nodes, double time)
{
    gm_node_id *direction = gm_arena_take(system->arena, system->variable_count, sizeof *direction);
    for (size_t i = 0; i < system->variable_count; i++) {
        direction[i] = gm_formula_constant(&system->graph, 0);
    }
    if (nodes) {
        memcpy(direction, nodes, system->n * sizeof *direction);
    }
    direction[system->n] = gm_formula_constant(&system->graph, time);
    return direction;
}

/* Ends runs where the Pfaffian changes sign, unless the file says where, and names it in printed formulas if it is
   long. */
static void watch_pfaffian(struct gm_user_system *system)
{
    const gm_node_id node = system->pfaffian;
    if (!gm_formula_holds(&system->graph, node, marks_of(system, 0, system->n + 1), system->variable_count)) {
        return; /* it depends on parameters alone */
    }
    if (!gm_system_item_of(system, GM_WORD_STOP, 0)) {
        const size_t count = system->item_count + 1;
        system->items = gm_arena_resize(system->arena, system->items, count, sizeof *system->items);
        struct gm_system_item *item = &system->items[system->item_count++];
        *item = (struct gm_system_item){
            .word = GM_WORD_STOP, .name = "", .place = system->bracket_place, .ends = true};
        item->nodes = gm_arena_take(system->arena, 1, sizeof *item->nodes);
        item->nodes[item->count++] = node;
    }
    if (system->n > 2 && node >= system->part_count) {
        system->parts =
            gm_arena_resize(system->arena, system->parts, node + (size_t)1, sizeof *system->parts);
        while (system->part_count <= node) {
            system->parts[system->part_count++] = NULL;
        }
        system->parts[node] = "Pf";
    }
}

/* The equations of L = theta(q, t) . q' - H(q, t) are
       Omega q' = dH/dq + d theta/dt,   Omega_ij = d theta_j/d q_i - d theta_i/d q_j:
   a Poisson system with the bracket Omega^-1, whose Jacobi identity says that Omega is closed. Derives theta, Omega
   and the bracket, and replaces L by H. M. Kraus, arXiv:1708.07356 (2017), 2 */
static void derive_form(struct gm_user_system *system)
{
    struct gm_formula *graph = &system->graph;
    const size_t n = system->n, mark = gm_arena_mark(system->arena);
    const uint32_t origin = gm_formula_origin(graph, system->energy);
    const size_t place = system->bracket_place = origin == GM_NO_PLACE ? 0 : origin;
    gm_system_refuse_if(
        system, n % 2 == 1, place,
        "L is linear in the velocities, and the form of theta is singular: %zu coordinate%s an odd "
        "number",
        n, n == 1 ? " is" : "s are");
    gm_system_refuse_if(system, n > GM_MOST_ROWS_OF_SKEW, place,
                        "a Lagrangian that is linear in the velocities has at most %d coordinates",
                        GM_MOST_ROWS_OF_SKEW);
    gm_node_id *rest = gm_system_no_nodes(system, system->variable_count);
    const gm_node_id *slopes =
        gm_equations_gradient(system, system->energy, marks_of(system, system->velocities, n));
    for (size_t i = 0; i < n; i++) {
        system->theta[i] = slopes[system->velocities + i];
        rest[system->velocities + i] = gm_formula_constant(graph, 0);
    }
    gm_arena_need(system->arena,
                  gm_formula_substitute(graph, system->theta, n, rest, system->variable_count) &&
                      gm_formula_substitute(graph, &system->energy, 1, rest, system->variable_count));
    system->energy = gm_negative(graph, system->energy);
    for (size_t i = 0; i < n * n; i++) {
        const size_t row = i / n, column = i % n;
        const gm_node_id ahead = gm_system_derivative(system, system->theta[column], row),
                         back = gm_system_derivative(system, system->theta[row], column);
        graph->origin = origin;
        system->omega[i] = gm_difference(graph, ahead, back);
    }
    const bool inverted = gm_skew_inverse(graph, system->omega, n, system->bracket, &system->pfaffian);
    graph->origin = GM_NO_PLACE;
    gm_system_need_graph(system);
    gm_system_refuse_if(
        system, !inverted, place,
        "the form of theta has too many entries: its inverse is written for about 10 coordinates that "
        "all depend on each other");
    gm_arena_release(system->arena, mark);
    watch_pfaffian(system);
}

/* Replaces the velocities of theta's system in the formulas of all lines by the rates. */
static void replace_velocities(struct gm_user_system *system)
{
    const size_t n = system->n, count = system->variable_count;
    const bool *marked = marks_of(system, system->velocities, n);
    gm_node_id *rates = gm_system_no_nodes(system, count);
    memcpy(rates + system->velocities, system->rates, n * sizeof *rates);
    for (size_t i = 0; i < system->item_count; i++) {
        for (size_t k = 0; k < system->items[i].count; k++) {
            gm_node_id *node = &system->items[i].nodes[k];
            if (*node != GM_NO_NODE && gm_formula_holds(&system->graph, *node, marked, count)) {
                gm_arena_need(system->arena, gm_formula_substitute(&system->graph, node, 1, rates, count));
            }
        }
    }
}

static void derive_poisson(struct gm_user_system *system, const gm_node_id *gradient)
{
    const size_t n = system->n;
    gm_node_id *slopes = gm_arena_take(system->arena, n + 1, sizeof *slopes); /* dH/dy + d theta/dt */
    for (size_t k = 0; k < n; k++) {
        slopes[k] = system->theta ? gm_sum(&system->graph, gradient[k],
                                           gm_system_derivative(system, system->theta[k], n))
                                  : gradient[k];
    }
    for (size_t i = 0; i < n; i++) {
        system->rates[i] = gm_formula_constant(&system->graph, 0);
        for (size_t k = 0; k < n; k++) {
            const gm_node_id entry = system->bracket[i * n + k];
            system->graph.origin = gm_formula_origin(&system->graph, entry);
            const gm_node_id term = gm_product(&system->graph, entry, slopes[k]);
            system->graph.origin = GM_NO_PLACE;
            system->rates[i] = gm_sum(&system->graph, system->rates[i], term);
        }
    }
}

/* momenta and forces */
static void derive_lagrangian(struct gm_user_system *system, const gm_node_id *gradient)
{
    const size_t half = system->n / 2;
    for (size_t i = 0; i < half; i++) {
        system->momenta[i] = gradient[system->velocities + i];
        system->rates[half + i] = add_force(system, gradient[i], system->variables[i].force);
    }
}

static void derive_mass(struct gm_user_system *system)
{
    const size_t half = system->n / 2;
    system->mass = gm_sparse_jacobian(system->arena, &system->graph, system->momenta, half,
                                      marks_of(system, system->velocities, half), system->variable_count);
    for (size_t i = 0; i < system->mass.count; i++) {
        system->mass.entries[i].column -= system->velocities;
    }
}

static gm_node_id along(struct gm_user_system *system, gm_node_id node, const gm_node_id *direction)
{
    return gm_derivative_along(&system->graph, node, direction, system->variable_count);
}

/* The rates of tangents: the derivatives of the motion's rates along them. */
static void derive_tangents(struct gm_user_system *system)
{
    const size_t n = gm_system_motion(system);
    gm_node_id *direction = direction_of(system, NULL, 0);
    for (size_t i = 0; i < system->n; i++) {
        direction[i] = direction[system->n];
    }
    for (size_t k = 1; k <= system->tangents; k++) {
        for (size_t c = 0; c < n; c++) {
            direction[gm_system_component(system, c, 0)] =
                gm_formula_variable(&system->graph, gm_system_component(system, c, k));
        }
        for (size_t c = 0; c < n; c++) {
            system->rates[gm_system_component(system, c, k)] =
                along(system, system->rates[gm_system_component(system, c, 0)], direction);
        }
    }
}

static void derive(struct gm_user_system *system)
{
    const size_t half = system->n / 2;
    const bool rates = system->kind == GM_RATES || system->kind == GM_EVOLUTION;
    system->momenta = system->kind == GM_LAGRANGIAN
                          ? gm_arena_take(system->arena, half + 1, sizeof *system->momenta)
                          : NULL;
    if (system->theta) {
        derive_form(system);
    }
    const size_t mark = gm_arena_mark(system->arena);
    const gm_node_id *gradient = rates ? NULL : gm_equations_gradient(system, system->energy, NULL);
    if (system->kind == GM_CANONICAL) {
        for (size_t i = 0; i < half; i++) {
            system->rates[i] = gradient[half + i];
            system->rates[half + i] =
                add_force(system, gm_negative(&system->graph, gradient[i]), system->variables[i].force);
        }
    } else if (system->kind == GM_LAGRANGIAN) {
        derive_lagrangian(system, gradient);
    } else if (system->kind == GM_POISSON) {
        derive_poisson(system, gradient);
        if (system->theta) {
            replace_velocities(system);
        }
    } else if (system->kind == GM_MATRICES) {
        memcpy(system->rates, gradient, system->n * sizeof *gradient);
    } else if (system->kind == GM_FIELD) {
        system->rates[0] = gm_formula_variable(&system->graph, 1);
        system->rates[1] = gm_negative(&system->graph, gradient[0]);
    }
    derive_tangents(system);
    gm_system_need_graph(system);
    const bool *timed = gm_arena_keep(
        system->arena,
        gm_formula_dependent(&system->graph, marks_of(system, system->n, 1), system->variable_count), free);
    for (size_t i = 0; i < system->n; i++) {
        system->timed |= system->rates[i] != GM_NO_NODE && timed[system->rates[i]];
        system->timed |= system->theta && timed[system->theta[i]];
    }
    system->timed |= !rates && timed[system->energy];
    gm_arena_release(system->arena, mark);
    if (system->kind == GM_LAGRANGIAN) {
        derive_mass(system);
    }
}

bool gm_equations_in_velocities(struct gm_user_system *system, gm_node_id *nodes, size_t count)
{
    const size_t half = system->n / 2;
    gm_node_id *others = gm_system_no_nodes(system, system->n);
    if (others) {
        memcpy(others + half, system->momenta, half * sizeof *others);
    }
    system->graph.failed |=
        !others || !gm_formula_substitute(&system->graph, nodes, count, others, system->n);
    return !system->graph.failed;
}

double *gm_equations_fixed(const struct gm_user_system *system)
{
    double *fixed = malloc(system->variable_count * sizeof *fixed);
    for (size_t i = 0; fixed && i < system->variable_count; i++) {
        fixed[i] = i == system->n ? NAN : system->variables[i].value; /* any time */
    }
    return fixed;
}

enum gm_identity gm_equations_vanishes(const struct gm_user_system *system, gm_node_id node)
{
    double *fixed = gm_equations_fixed(system);
    const enum gm_identity identity =
        fixed ? gm_identity_of(&system->graph, node, fixed, system->variable_count) : GM_UNTESTED;
    free(fixed);
    return identity;
}

static enum gm_identity weaker(enum gm_identity a, enum gm_identity b)
{
    return a == GM_NOT_ZERO || b == GM_NOT_ZERO ? GM_NOT_ZERO : a > b ? a : b;
}

/* Tests if a node jumps where it moves along the direction. */
static enum gm_identity passes(struct gm_user_system *system, gm_node_id node, const gm_node_id *direction)
{
    gm_node_id at = GM_NO_NODE;
    return gm_breaks_pass(system->arena, system, &node, 1, direction, system->variable_count, &at);
}

/* Tests if a node is constant along the direction: its slope vanishes, and it does not jump. */
static enum gm_identity is_constant(struct gm_user_system *system, gm_node_id node,
                                    const gm_node_id *direction)
{
    return weaker(gm_equations_vanishes(system, along(system, node, direction)),
                  passes(system, node, direction));
}

/* The direction of the motion, of a Lagrangian with its velocities. */
static gm_node_id *motion_of(struct gm_user_system *system)
{
    gm_node_id *direction = direction_of(system, system->rates, 1);
    for (size_t i = 0; system->kind == GM_LAGRANGIAN && i < system->n / 2; i++) {
        direction[i] = gm_formula_variable(&system->graph, system->velocities + i);
    }
    return direction;
}

/* Tests if a node is constant along the motion. With a Lagrangian its rate is dI/dq v + dI/dp (dL/dq + F), with dL/dv
   for p. Rates of velocities need the inverse of the mass matrix, so for nodes with velocities this is unknown; and with
   constraints. */
static enum gm_identity is_conserved(struct gm_user_system *system, gm_node_id node)
{
    const size_t half = system->n / 2;
    const bool lagrangian = system->kind == GM_LAGRANGIAN;
    if (gm_system_item_of(system, GM_WORD_CONSTRAINT, 0) ||
        (lagrangian && gm_formula_holds(&system->graph, node, marks_of(system, system->velocities, half),
                                        system->variable_count))) {
        return GM_UNTESTED;
    }
    const gm_node_id *direction = motion_of(system);
    gm_node_id rate = along(system, node, direction);
    if (lagrangian) {
        gm_equations_in_velocities(system, &rate, 1);
    }
    return weaker(gm_equations_vanishes(system, rate), passes(system, node, direction));
}

static bool varies(const struct gm_user_system *system, size_t i, size_t k)
{
    return system->graph.nodes[system->bracket[i * system->n + k]].operation != GM_CONSTANT;
}

/* Tests the sum over l of {i, l} d{j, k}/dl and cyclic. */
static enum gm_identity test_jacobi(struct gm_user_system *system, const size_t triple[3],
                                    gm_node_id *direction)
{
    const size_t n = system->n;
    enum gm_identity all = GM_ZERO_PROVED;
    gm_node_id sum = gm_formula_constant(&system->graph, 0);
    for (int turn = 0; turn < 3; turn++) {
        const size_t a = triple[turn], b = triple[(turn + 1) % 3], c = triple[(turn + 2) % 3];
        memcpy(direction, &system->bracket[a * n], n * sizeof *direction);
        direction[n] = gm_formula_constant(&system->graph, 0);
        if (varies(system, b, c)) {
            sum = gm_sum(&system->graph, sum, along(system, system->bracket[b * n + c], direction));
            all = weaker(all, passes(system, system->bracket[b * n + c], direction));
        }
    }
    return weaker(all, gm_equations_vanishes(system, sum));
}

/* Checks each triple with a varying bracket once: for other triples the sum has no terms. */
static void check_jacobi(struct gm_user_system *system)
{
    const size_t n = system->n;
    gm_node_id *direction = direction_of(system, NULL, 0);
    system->jacobi = GM_ZERO_PROVED;
    for (size_t j = 0; j < n; j++) {
        for (size_t k = j + 1; k < n; k++) {
            for (size_t i = 0; varies(system, j, k) && i < n; i++) {
                /* a triple is checked at the first of its varying pairs */
                const bool elsewhere = (i < j && (varies(system, i, j) || varies(system, i, k))) ||
                                       (i > j && i < k && varies(system, j, i));
                if (i == j || i == k || elsewhere) {
                    continue;
                }
                const size_t triple[] = {i < j ? i : j, i < j ? j : i < k ? i : k, i < k ? k : i};
                const enum gm_identity found = test_jacobi(system, triple, direction);
                gm_system_refuse_if(system, found == GM_NOT_ZERO, system->bracket_place,
                                    "the bracket breaks Jacobi's identity for %.60s, %.60s and %.60s",
                                    system->variables[triple[0]].name, system->variables[triple[1]].name,
                                    system->variables[triple[2]].name);
                system->jacobi = weaker(system->jacobi, found);
            }
        }
    }
}

/* {x_i, C} = 0 for all i */
static enum gm_identity check_casimir(struct gm_user_system *system, gm_node_id node)
{
    enum gm_identity all = GM_ZERO_PROVED;
    for (size_t i = 0; i < system->n && all != GM_NOT_ZERO; i++) {
        all =
            weaker(all, is_constant(system, node, direction_of(system, &system->bracket[i * system->n], 0)));
    }
    return all;
}

/* A nonzero rate that should vanish, and its quantity. */
struct broken {
    const char *what; /* kind of quantity; NULL: all rates vanish */
    gm_node_id node;
};

/* True if the constraints are constant along the generator. */
static bool keeps_constraints(struct gm_user_system *system, const struct gm_system_item *symmetry,
                              struct broken *broken)
{
    gm_node_id *direction = direction_of(system, NULL, 0);
    for (size_t i = 0; i < system->n; i++) {
        direction[i] = i < system->n / 2 ? symmetry->nodes[i] : direction[system->n];
    }
    const struct gm_system_item *item;
    for (size_t i = 0; (item = gm_system_item_of(system, GM_WORD_CONSTRAINT, i)); i++) {
        *broken = (struct broken){"a constraint", along(system, item->nodes[0], direction)};
        if (is_constant(system, item->nodes[0], direction) == GM_NOT_ZERO) {
            return false;
        }
    }
    return true;
}

/* Tests if the forces do no work along the generator: then the momentum map is conserved with them too. */
static enum gm_identity check_work(struct gm_user_system *system, const struct gm_system_item *symmetry)
{
    gm_node_id work = gm_formula_constant(&system->graph, 0);
    for (size_t i = 0; i < system->n / 2; i++) {
        const gm_node_id force = system->variables[i].force;
        if (force != GM_NO_NODE) {
            work = gm_sum(&system->graph, work, gm_product(&system->graph, force, symmetry->nodes[i]));
        }
    }
    return gm_equations_vanishes(system, work);
}

/* Generator and field commute. */
static enum gm_identity check_commuting(struct gm_user_system *system, const struct gm_system_item *item,
                                        struct broken *broken)
{
    const gm_node_id *generator = direction_of(system, item->nodes, 0),
                     *motion = direction_of(system, system->rates, 1);
    enum gm_identity all = GM_ZERO_PROVED;
    for (size_t i = 0; i < system->n && all != GM_NOT_ZERO; i++) {
        const gm_node_id one = along(system, system->rates[i], generator),
                         other = along(system, item->nodes[i], motion);
        *broken = (struct broken){"the motion", gm_difference(&system->graph, one, other)};
        all = weaker(all, gm_equations_vanishes(system, broken->node));
        all = weaker(
            all, weaker(passes(system, system->rates[i], generator), passes(system, item->nodes[i], motion)));
    }
    return all;
}

/* With coordinates: the energy is constant along the generator, lifted to momenta or velocities. Appends the
   momentum map. */
static enum gm_identity check_symmetry(struct gm_user_system *system, struct gm_system_item *item,
                                       struct broken *broken)
{
    struct gm_formula *graph = &system->graph;
    const size_t half = system->n / 2;
    const bool canonical = system->kind == GM_CANONICAL;
    gm_node_id map = gm_formula_constant(graph, 0);
    if (system->kind > GM_LAGRANGIAN) {
        return check_commuting(system, item, broken);
    }
    const gm_node_id *gradient = gm_equations_gradient(system, system->energy, NULL);
    gm_node_id *direction = direction_of(system, NULL, 0), change = map;
    for (size_t i = 0; i < half; i++) {
        const gm_node_id momentum = gm_formula_variable(graph, half + i);
        map = gm_sum(graph, map, gm_product(graph, momentum, item->nodes[i]));
        direction[i] = item->nodes[i];
    }
    /* H: lift to momenta, -p dX/dq; L: lift to velocities, dX/dq v */
    for (size_t i = 0; i < (canonical ? 1 : half); i++) {
        const size_t mark = gm_arena_mark(system->arena);
        const gm_node_id *slopes = gm_equations_gradient(system, canonical ? map : item->nodes[i], NULL);
        for (size_t k = 0; k < half; k++) {
            gm_node_id *lift = &direction[canonical ? half + k : system->velocities + i];
            *lift = canonical ? gm_negative(graph, slopes[k])
                              : gm_sum(graph, *lift,
                                       gm_product(graph, slopes[k],
                                                  gm_formula_variable(graph, system->velocities + k)));
        }
        gm_arena_release(system->arena, mark);
    }
    if (!keeps_constraints(system, item, broken)) {
        return GM_NOT_ZERO;
    }
    /* of the gradient, whose terms the rates have: other terms would change the text of a compiled system */
    for (size_t i = 0; i < system->variable_count; i++) {
        change = gm_sum(graph, change, gm_product(graph, gradient[i], direction[i]));
    }
    *broken = (struct broken){canonical ? "H" : "L", change};
    item->nodes = gm_arena_resize(system->arena, item->nodes, half + 1, sizeof *item->nodes);
    item->nodes[half] = map;
    item->count = half + 1;
    const enum gm_identity found = weaker(gm_equations_vanishes(system, change),
                                          passes(system, system->energy, direction)),
                           passing = passes(system, map, motion_of(system));
    gm_system_refuse_if(system, found != GM_NOT_ZERO && passing == GM_NOT_ZERO, item->place,
                        "the momentum map of this symmetry jumps, so the motion does not conserve it");
    return weaker(found, passing);
}

/* Refuses a symmetry, with the rate of the broken quantity at one of three points, whose coordinates are 1/2,
   1 and 3/2 in turn. */
static _Noreturn void refuse_symmetry(struct gm_user_system *system, const struct gm_system_item *item,
                                      struct broken broken)
{
    size_t count = 0, used = 0;
    const gm_node_id *parts =
        gm_arena_keep(system->arena, gm_formula_parts(&system->graph, broken.node, &count), free);
    double *variables = gm_arena_take(system->arena, system->variable_count, sizeof *variables);
    char point[160] = "", rate[40] = "";
    for (size_t turn = 0; turn < 3 && rate[0] == '\0'; turn++) {
        for (size_t i = 0; i < system->variable_count; i++) {
            const bool parameter = i >= system->parameters && i < system->velocities;
            variables[i] = parameter ? system->variables[i].value : 0.5 * (double)((i + turn) % 3 + 1);
        }
        const double value = gm_equations_values(system, variables)[broken.node];
        if (isfinite(value) && fabs(value) > 1e-9) {
            snprintf(rate, sizeof rate, ", at the rate %.4g", value);
        }
    }
    for (size_t i = 0; rate[0] && i < system->variable_count && used < sizeof point - 60; i++) {
        bool holds = false;
        for (size_t k = 0; k < count && (i < system->parameters || i >= system->velocities); k++) {
            const struct gm_node *part = &system->graph.nodes[parts[k]];
            holds |= part->operation == GM_VARIABLE && part->a == i;
        }
        if (holds) {
            used += (size_t)snprintf(point + used, sizeof point - used, "%s%.30s = %g",
                                     used > 0 ? ", " : " at ", system->variables[i].name, variables[i]);
        }
    }
    gm_system_refuse(system, item->place, "this is not a symmetry: it changes %s%s%s", broken.what, rate,
                     point);
}

/* A flag for each variable but parameters and `count` ones from number `first` on. */
static bool *others_than(const struct gm_user_system *system, size_t first, size_t count)
{
    bool *others = marks_of(system, 0, system->variable_count);
    memset(others + system->parameters, false, system->velocities - system->parameters);
    memset(others + first, false, count);
    return others;
}

/* True if a node depends only on parameters and the first `components` components. */
static bool is_of_components(struct gm_user_system *system, gm_node_id node, size_t components)
{
    return !gm_formula_holds(&system->graph, node, others_than(system, 0, components),
                             system->variable_count);
}

/* A surface is fixed: its size depends only on parameters and conserved quantities. */
static void check_surface(struct gm_user_system *system, const struct gm_system_item *item)
{
    for (size_t k = 0; k < item->count; k++) {
        const enum gm_identity found = is_conserved(system, item->nodes[k]);
        const bool kept =
            found == GM_UNTESTED ? is_of_components(system, item->nodes[k], 0) : found != GM_NOT_ZERO;
        gm_system_refuse_if(
            system, !kept, item->place,
            "a surface does not move: its size depends only on parameters and conserved quantities");
    }
}

/* The state of a Lagrangian is coordinates and momenta. */
static void check_event(struct gm_user_system *system, const struct gm_system_item *item)
{
    gm_system_refuse_if(system, is_of_components(system, item->nodes[0], 0), item->place,
                        "what an event waits for never changes: it holds no component, and no t");
    const bool *velocities =
        marks_of(system, system->velocities, system->kind == GM_LAGRANGIAN ? system->n / 2 : 0);
    for (size_t i = 0; i < item->count; i++) {
        const bool holds =
            gm_formula_holds(&system->graph, item->nodes[i], velocities, system->variable_count);
        gm_system_refuse_if(system, holds, item->place,
                            "an event is of coordinates and momenta, not of velocities");
    }
    gm_system_need_graph(system);
}

static bool holds_time(struct gm_user_system *system, const struct gm_system_item *item)
{
    const bool *time = marks_of(system, system->n, 1);
    size_t i = 0;
    while (i < item->count &&
           (item->nodes[i] == GM_NO_NODE ||
            !gm_formula_holds(&system->graph, item->nodes[i], time, system->variable_count))) {
        i++;
    }
    return i < item->count;
}

static void check_item(struct gm_user_system *system, struct gm_system_item *item, bool forced)
{
    struct broken broken = {NULL, GM_NO_NODE};
    bool jumps;
    switch (item->word) {
    case GM_WORD_INVARIANT:
        item->check = is_conserved(system, item->nodes[0]);
        jumps =
            item->check == GM_NOT_ZERO && passes(system, item->nodes[0], motion_of(system)) == GM_NOT_ZERO;
        gm_system_refuse_if(system, item->check == GM_NOT_ZERO && !forced, item->place,
                            "%.60s is not an invariant%s; observe: takes nearly conserved quantities",
                            item->name, jumps ? ": it jumps in the motion" : "");
        break;
    case GM_WORD_SURFACE:
        check_surface(system, item);
        break;
    case GM_WORD_SECTION:
        gm_system_refuse_if(
            system, !item->periodic && !item->at_event && is_of_components(system, item->nodes[0], 0),
            item->place, "what a section waits for never changes: it holds no component, and no t");
        break;
    case GM_WORD_EVENT:
        check_event(system, item);
        break;
    case GM_WORD_PART:
    case GM_WORD_LET:
        item->check = system->timed || !holds_time(system, item) ? GM_UNTESTED : GM_NOT_ZERO;
        gm_system_refuse_if(
            system, item->check == GM_NOT_ZERO && item->word == GM_WORD_PART, item->place,
            "a part holds the time, which the whole does not hold: no other part can move it");
        break;
    case GM_WORD_CASIMIR:
        item->check = check_casimir(system, item->nodes[0]);
        gm_system_refuse_if(system, item->check == GM_NOT_ZERO, item->place,
                            "%.60s is not a Casimir: its bracket with the components is not 0", item->name);
        break;
    case GM_WORD_SYMMETRY:
        item->check = check_symmetry(system, item, &broken);
        if (item->check == GM_NOT_ZERO) {
            refuse_symmetry(system, item, broken);
        }
        if (system->kind <= GM_LAGRANGIAN && check_work(system, item) == GM_NOT_ZERO) {
            item->check = GM_NOT_ZERO; /* still a symmetry, but a force breaks its law */
        }
        break;
    default:
        break;
    }
}

static void check_items(struct gm_user_system *system)
{
    bool forced = gm_system_item_of(system, GM_WORD_CONSTRAINT, 0) != NULL;
    for (size_t i = 0; i < system->n; i++) {
        forced |= system->variables[i].force != GM_NO_NODE;
    }
    for (size_t i = 0; i < system->item_count; i++) {
        const size_t mark = gm_arena_mark(system->arena);
        check_item(system, &system->items[i], forced);
        gm_arena_release(system->arena, mark);
    }
}

/* A Lagrangian at some coordinates. */
struct transform {
    const struct gm_user_system *system;
    double *variables, *values; /* values of variables; values of nodes of the graph */
    const gm_node_id *parts;    /* [part_count] nodes to evaluate; NULL: the first part_count */
    size_t part_count;
    const bool *given;    /* given velocities; NULL: none */
    const double *wanted; /* momenta, or given velocities */
};

/* p - dL/dv and the mass matrix; for a given velocity, its difference; gm_linear_equations */
static bool momenta_at(void *data, const double *v, double *residual, double *matrix, double *scale)
{
    const struct transform *transform = data;
    const struct gm_user_system *system = transform->system;
    const size_t half = system->n / 2;
    memcpy(transform->variables + system->velocities, v, half * sizeof *v);
    gm_formula_evaluate_parts(&system->graph, transform->parts, transform->part_count, transform->variables,
                              transform->values);
    memset(matrix, 0, half * half * sizeof *matrix);
    for (size_t i = 0; i < half; i++) {
        const bool given = transform->given && transform->given[i];
        residual[i] = transform->wanted[i] - (given ? v[i] : transform->values[system->momenta[i]]);
        matrix[i * half + i] = given;
    }
    for (size_t i = 0; i < system->mass.count; i++) {
        const struct gm_sparse_entry *entry = &system->mass.entries[i];
        if (!transform->given || !transform->given[entry->row]) {
            matrix[entry->row * half + entry->column] = transform->values[entry->node];
        }
    }
    *scale += gm_sum_of(v, half);
    return true;
}

/* Computes velocities that were not given from the momenta. */
static void find_velocities(struct gm_arena *arena, struct transform transform)
{
    const size_t half = transform.system->n / 2;
    double *v = transform.variables + transform.system->velocities;
    double *scratch = gm_arena_take(arena, gm_newton_scratch(half), sizeof *scratch),
           *wanted = gm_arena_take(arena, half, sizeof *wanted),
           *found = gm_arena_take(arena, half, sizeof *found);
    bool *given = gm_arena_take(arena, half, sizeof *given);
    const struct gm_implicit_equations equations = {.size = half,
                                                    .data = &transform,
                                                    .linear = momenta_at,
                                                    .counted = half,
                                                    .least = 0x1p-52,
                                                    .roundoff = 0x1p-40,
                                                    .halved = true};
    struct gm_progress ignored = {0};
    transform.given = given;
    transform.wanted = wanted;
    for (size_t i = 0; i < half; i++) {
        given[i] = !isnan(v[i]);
        wanted[i] = given[i] ? v[i] : transform.variables[half + i];
        found[i] = given[i] ? v[i] : 0;
    }
    const bool solved = gm_newton_solve(&equations, scratch, found, &ignored);
    for (size_t i = 0; i < half; i++) {
        v[i] = solved ? found[i] : NAN;
    }
}

/* All nodes that the start depends on: formulas, and momenta with the mass matrix. */
static gm_node_id *parts_of_start(struct gm_arena *arena, const struct gm_user_system *system, size_t *count)
{
    const size_t half = system->momenta ? system->n / 2 : 0;
    const size_t solutions = system->variable_count - system->exact;
    gm_node_id *nodes =
        gm_arena_take(arena, system->initial + solutions + half + system->mass.count + 1, sizeof *nodes);
    size_t found = 0;
    for (size_t i = 0; i < system->initial + solutions; i++) {
        nodes[found] =
            i < system->initial ? system->variables[i].start : system->variables[i - system->initial].exact;
        found += nodes[found] != GM_NO_NODE;
    }
    for (size_t i = 0; i < half; i++) {
        nodes[found++] = system->momenta[i];
    }
    for (size_t i = 0; half > 0 && i < system->mass.count; i++) {
        nodes[found++] = system->mass.entries[i].node;
    }
    return gm_arena_keep(arena, gm_formula_parts_of(&system->graph, nodes, found, count), free);
}

/* A start that is computed: the values that replace the file's, and the values of all variables. */
struct start {
    const struct gm_user_system *system;
    const double *given; /* NULL: none */
    double *variables;
};

static bool is_given(const struct start *start, size_t number)
{
    return start->given && !isnan(start->given[number]);
}

/* Sets momenta that have no start of their own. */
static void set_momenta(const struct start *start, const double *values)
{
    const struct gm_user_system *system = start->system;
    for (size_t i = 0; system->momenta && i < system->n / 2; i++) {
        const size_t p = system->n / 2 + i;
        if (system->variables[p].start == GM_NO_NODE && !is_given(start, p)) {
            start->variables[p] = values[system->momenta[i]];
        }
    }
}

static void find_start(struct gm_arena *arena, void *data)
{
    const struct start *start = data;
    const struct gm_user_system *system = start->system;
    double *variables = start->variables,
           *values = gm_arena_take(arena, system->graph.count + (size_t)1, sizeof *values);
    struct transform transform = {.system = system, .variables = variables, .values = values};
    transform.parts = parts_of_start(arena, system, &transform.part_count);
    for (size_t i = 0; i < system->variable_count; i++) {
        const bool follows = i < system->initial && system->variables[i].start != GM_NO_NODE;
        variables[i] = follows ? NAN : system->variables[i].value;
        variables[i] = is_given(start, i) ? start->given[i] : variables[i];
    }
    /* a start may depend on others: each round uses the values of the last one */
    size_t found = 0, before = 0;
    for (bool first = true; first || found > before; first = false) {
        before = found;
        gm_formula_evaluate_parts(&system->graph, transform.parts, transform.part_count, variables, values);
        for (size_t i = 0; i < system->initial; i++) {
            const gm_node_id node = system->variables[i].start;
            variables[i] = node == GM_NO_NODE || is_given(start, i) ? variables[i] : values[node];
        }
        set_momenta(start, values);
        memcpy(variables + system->initial, variables, system->n * sizeof *variables);
        for (size_t i = system->exact; i < system->variable_count; i++) {
            const gm_node_id node = system->variables[i - system->exact].exact;
            variables[i] = node == GM_NO_NODE ? NAN : values[node];
        }
        found = 0;
        for (size_t i = 0; i < system->variable_count; i++) {
            found += !isnan(variables[i]);
        }
    }
    bool unknown = false;
    for (size_t i = 0; system->momenta && i < system->n / 2; i++) {
        unknown |= isnan(variables[system->velocities + i]);
    }
    if (unknown) {
        find_velocities(arena, transform);
        gm_formula_evaluate_parts(&system->graph, transform.parts, transform.part_count, variables, values);
        set_momenta(start, values);
    }
    memcpy(variables + system->initial, variables, system->n * sizeof *variables);
}

double *gm_equations_start(const struct gm_user_system *system, const double *given)
{
    struct start start = {system, given, malloc(system->variable_count * sizeof *start.variables)};
    if (!start.variables || !gm_arena_run_once(find_start, &start)) {
        free(start.variables);
        start.variables = NULL;
    }
    return start.variables;
}

/* The rank of a matrix, which is overwritten: pivots are larger than a part of its largest entry. And the first column that depends on those before it; `columns`
   without one. */
static size_t rank_of(double *matrix, size_t rows, size_t columns, double part, size_t *dependent)
{
    double largest = 0;
    size_t rank = 0;
    *dependent = columns;
    for (size_t i = 0; i < rows * columns; i++) {
        largest = fmax(largest, fabs(matrix[i]));
    }
    for (size_t column = 0; column < columns; column++) {
        size_t pivot = rank;
        for (size_t i = rank; i < rows; i++) {
            pivot = fabs(matrix[i * columns + column]) > fabs(matrix[pivot * columns + column]) ? i : pivot;
        }
        if (rank == rows || !(fabs(matrix[pivot * columns + column]) > part * largest)) {
            *dependent = *dependent < columns ? *dependent : column;
            continue;
        }
        for (size_t j = column; j < columns; j++) {
            const double kept = matrix[pivot * columns + j];
            matrix[pivot * columns + j] = matrix[rank * columns + j];
            matrix[rank * columns + j] = kept;
        }
        for (size_t i = rank + 1; i < rows; i++) {
            const double factor = matrix[i * columns + column] / matrix[rank * columns + column];
            for (size_t j = column; j < columns; j++) {
                matrix[i * columns + j] -= factor * matrix[rank * columns + j];
            }
        }
        rank++;
    }
    return rank;
}

/* The matrix that determines the velocities at these values: Omega of theta, or the mass matrix of a Lagrangian.
   Returns false if it is not finite, which the check of the rates reports. */
static bool find_matrix(const struct gm_user_system *system, double *start, double *values, double *matrix)
{
    const size_t n = system->n;
    double *residual = matrix + n * n, *wanted = residual + n, unused = 0;
    struct transform transform = {system, start, values, NULL, system->graph.count, NULL, wanted};
    bool finite = true;
    if (!system->theta) {
        memcpy(wanted, start + system->velocities, n / 2 * sizeof *wanted);
        return momenta_at(&transform, wanted, residual, matrix, &unused);
    }
    gm_formula_evaluate(&system->graph, system->graph.count, start, values);
    for (size_t i = 0; i < n * n; i++) {
        matrix[i] = values[system->omega[i]];
        finite &= isfinite(matrix[i]);
    }
    return finite;
}

bool gm_equations_check_velocities(const struct gm_user_system *system, double *start, struct gm_fault *fault)
{
    const size_t n = system->n, size = system->theta ? n : n / 2; /* coordinates */
    size_t first, rank = size;
    if (system->kind != GM_LAGRANGIAN && !system->theta) {
        return true;
    }
    double *matrix = malloc((n + 2) * n * sizeof *matrix),
           *values = malloc((system->graph.count + (size_t)1) * sizeof *values);
    const bool opened = matrix && values;
    if (opened && find_matrix(system, start, values, matrix)) {
        rank = rank_of(matrix, size, size, 1e-14, &first);
    }
    free(values);
    free(matrix);
    if (!opened || rank == size) {
        return opened;
    }
    char where[120] = "";
    size_t length = 0;
    for (size_t i = 0; i < size && length + 40 < sizeof where; i++) {
        length += (size_t)snprintf(where + length, sizeof where - length, "%s%.16s = %.6g", i > 0 ? ", " : "",
                                   system->variables[i].name, start[i]);
    }
    const uint32_t place = gm_formula_origin(&system->graph, system->energy);
    if (system->theta) {
        return gm_fail(
            fault, system->bracket_place,
            "theta has a form of rank %zu of %zu at the start, %s: L = theta . q' - H does not determine "
            "the velocities",
            rank, size, where);
    }
    return gm_fail(
        fault, place == GM_NO_PLACE ? 0 : place,
        "the Legendre transform of L is singular at the start, %s: momenta do not determine velocities",
        where);
}

static bool is_not_finite(struct gm_formula *graph, gm_node_id part, const void *values)
{
    return graph->places[part] != GM_NO_PLACE && !isfinite(((const double *)values)[part]);
}

/* The offset of the first written part of a node that is not finite; 0: no such part. */
static size_t first_not_finite(struct gm_user_system *system, gm_node_id node, const double *values)
{
    const gm_node_id part = gm_formula_first(&system->graph, node, is_not_finite, values);
    return part == GM_NO_NODE ? 0 : system->graph.places[part];
}

/* The start must satisfy the constraints, with rates 0; and constraints must be independent. */
static void check_constraints(struct gm_user_system *system, const double *start)
{
    const size_t half = system->n / 2;
    size_t count = 0, last = 0, dependent;
    const struct gm_system_item *item;
    gm_node_id *nodes = gm_arena_take(system->arena, system->item_count + 1, sizeof *nodes);
    for (; (item = gm_system_item_of(system, GM_WORD_CONSTRAINT, count)); count++) {
        nodes[count] = item->nodes[0];
        last = item->place;
        gm_system_refuse_if(system, !is_of_components(system, item->nodes[0], half), item->place,
                            "a constraint holds coordinates and parameters alone");
    }
    const struct gm_sparse slopes = gm_sparse_jacobian(system->arena, &system->graph, nodes, count,
                                                       marks_of(system, 0, half), system->variable_count);
    double *matrix = gm_arena_take(system->arena, count * half + 1, sizeof *matrix),
           *rates = gm_arena_take(system->arena, count + 1, sizeof *rates);
    const double *values = gm_equations_values(system, start);
    for (size_t i = 0; i < slopes.count; i++) {
        const struct gm_sparse_entry *slope = &slopes.entries[i];
        const double velocity = system->kind == GM_LAGRANGIAN ? start[system->velocities + slope->column]
                                                              : values[system->rates[slope->column]];
        matrix[slope->row * half + slope->column] = values[slope->node];
        rates[slope->row] += values[slope->node] * velocity;
    }
    for (size_t k = 0; k < count; k++) {
        item = gm_system_item_of(system, GM_WORD_CONSTRAINT, k);
        gm_system_refuse_if(system, !(fabs(values[nodes[k]]) <= 1e-10), item->place,
                            "the start breaks this constraint: it is %g, not 0", values[nodes[k]]);
        gm_system_refuse_if(system, !(fabs(rates[k]) <= 1e-10), item->place,
                            "the start breaks this constraint: its rate of change is %g, not 0", rates[k]);
    }
    const size_t rank = rank_of(matrix, count, half, 1e-10, &dependent);
    gm_system_refuse_if(system, rank != count, last,
                        "the constraints depend on each other at the start: the derivatives of %zu have "
                        "the rank %zu",
                        count, rank);
}

/* A density of steps must be positive and depend on the state alone. */
static void check_monitor(struct gm_user_system *system, const double *values)
{
    const struct gm_system_item *item = gm_system_item_of(system, GM_WORD_MONITOR, 0);
    if (item && !is_of_components(system, item->nodes[0], system->n)) {
        gm_system_refuse(system, item->place, "a monitor holds %s and parameters alone",
                         system->kind <= GM_LAGRANGIAN ? "coordinates, momenta" : "components");
    }
    const double density = item ? values[item->nodes[0]] : 1;
    if (!(density > 0 && isfinite(density))) {
        gm_system_refuse(system, item->place,
                         "the monitor is %g at the start: how dense steps are is a number above 0", density);
    }
}

/* Half axes must be positive; stops and conserved quantities must be finite at the start. */
static void check_values_of_items(struct gm_user_system *system, const double *values)
{
    const struct gm_system_item *item;
    for (size_t i = 0; (item = gm_system_item_of(system, GM_WORD_SURFACE, i)); i++) {
        for (size_t k = 0; k < item->count; k++) {
            const double size = values[item->nodes[k]];
            gm_system_refuse_if(system, !(size > 0 && isfinite(size)), item->place,
                                "the size of a surface is %g, and has to be above 0", size);
        }
    }
    for (size_t i = 0; i < system->item_count; i++) {
        item = &system->items[i];
        const bool stops = item->word == GM_WORD_STOP || item->word == GM_WORD_EVENT;
        gm_system_refuse_if(system,
                            (stops || item->word == GM_WORD_INVARIANT || item->word == GM_WORD_CASIMIR) &&
                                !isfinite(values[item->nodes[0]]),
                            item->place, "%.60s is not finite at the start",
                            item->word == GM_WORD_EVENT ? "the function of the event"
                            : stops                     ? "what ends the run"
                                                        : item->name);
    }
}

static bool is_unknown(struct gm_formula *graph, gm_node_id part, const void *start)
{
    const struct gm_node *node = &graph->nodes[part];
    return node->operation == GM_VARIABLE && !isfinite(((const double *)start)[node->a]);
}

/* Reports a start that is not finite, whose variables all are; if every start waits for another, they form a
   circle. */
static void check_values(struct gm_user_system *system, const double *start, const double *values)
{
    size_t waiting = system->n, waits_for = 0;
    for (size_t i = 0; i < system->n; i++) {
        const struct gm_system_variable *variable = &system->variables[i];
        if (isfinite(start[i])) {
            continue;
        }
        const gm_node_id other = variable->start == GM_NO_NODE
                                     ? GM_NO_NODE
                                     : gm_formula_first(&system->graph, variable->start, is_unknown, start);
        if (other == GM_NO_NODE) {
            gm_system_refuse(
                system, variable->start == GM_NO_NODE ? 0 : first_not_finite(system, variable->start, values),
                "%.60s is not finite at the start", variable->name);
        }
        waits_for = waiting == system->n ? system->graph.nodes[other].a : waits_for;
        waiting = waiting == system->n ? i : waiting;
    }
    if (waiting < system->n) {
        gm_system_refuse(system, system->variables[waiting].start_place,
                         "a circle: the start of %.60s needs that of %.60s", system->variables[waiting].name,
                         system->variables[waits_for].name);
    }
}

/* Rates, and the energy, must be finite at the start. */
static void check_rates(struct gm_user_system *system, const double *values)
{
    for (size_t i = 0; i < system->n; i++) {
        if (system->rates[i] == GM_NO_NODE || isfinite(values[system->rates[i]])) {
            continue;
        }
        /* place of the rate, or of its origin */
        size_t place = first_not_finite(system, system->rates[i], values);
        if (place == 0 && system->kind != GM_RATES) {
            place = first_not_finite(system, system->energy, values);
        }
        if (place == 0 && system->kind != GM_RATES && system->graph.places[system->energy] != GM_NO_PLACE) {
            place = system->graph.places[system->energy]; /* a derivative is too large, although all written
                                                             parts are finite */
        }
        gm_system_refuse(system, place, "the rate of %.60s is not finite at the start",
                         system->variables[i].name);
    }
    if ((system->kind == GM_CANONICAL || system->kind == GM_POISSON) && !isfinite(values[system->energy])) {
        gm_system_refuse(system, first_not_finite(system, system->energy, values),
                         "H is not finite at the start");
    }
}

static void check_start(struct gm_user_system *system)
{
    const size_t mark = gm_arena_mark(system->arena);
    double *start = gm_arena_keep(system->arena, gm_equations_start(system, NULL), free);
    const double *values = gm_equations_values(system, start);
    if (!gm_equations_check_velocities(system, start, system->fault)) {
        gm_arena_leave(system->arena);
    }
    check_values(system, start, values);
    if (gm_system_item_of(system, GM_WORD_CONSTRAINT, 0)) {
        check_constraints(system, start);
    }
    check_rates(system, values);
    check_monitor(system, values);
    check_values_of_items(system, values);
    gm_arena_release(system->arena, mark);
}

/* A field's formula does not hold the others. A fault is at the place of the item, as other lines may contain the
   variable too; NULL: of the node. */
static void need_none(struct gm_user_system *system, gm_node_id node, const bool *others, const char *what,
                      const struct gm_system_item *item)
{
    const gm_node_id part = gm_formula_first_marked(&system->graph, node, others, system->variable_count);
    if (part != GM_NO_NODE) {
        const size_t place = system->graph.places[node] == GM_NO_PLACE ? 0 : system->graph.places[node];
        gm_system_refuse(system, item ? item->place : place, "%s does not hold %.60s", what,
                         system->variables[system->graph.nodes[part].a].name);
    }
}

/* V and S may have corners in parameters only, which are constant. */
static void need_smooth(struct gm_user_system *system, const char *what)
{
    const gm_node_id kink =
        gm_formula_kink(&system->graph, system->energy, marks_of(system, 0, system->n), system->n);
    if (kink != GM_NO_NODE) {
        gm_system_refuse(system, system->graph.places[kink],
                         "%s has to be smooth, and %s is not: its force would jump", what,
                         gm_operation_rows[system->graph.nodes[kink].operation].name);
    }
}

/* All but the fields, the place, and derivatives: `count` variables from the place on. */
static bool *others_in_density(const struct gm_user_system *system, size_t count)
{
    bool *others = others_than(system, system->velocities, count);
    memset(others, false, system->n);
    return others;
}

/* Checks the variables in starts, exact solutions, densities and numbers of a field. */
static void check_line(struct gm_user_system *system, size_t densities)
{
    const size_t n = system->n;
    const bool *in_number = others_than(system, 0, 0), *in_start = others_than(system, system->velocities, 1),
               *in_density = others_in_density(system, densities);
    bool *in_exact = others_than(system, system->velocities, 1);
    in_exact[n] = false;
    for (size_t i = 0; i < n; i++) {
        const struct gm_system_variable *field = &system->variables[i];
        need_none(system, field->start, in_start, "the start of a field", NULL);
        if (field->exact != GM_NO_NODE) {
            need_none(system, field->exact, in_exact, "the exact solution of a field", NULL);
        }
    }
    if (system->drift != GM_NO_NODE) {
        need_none(system, system->drift, in_start, "the start of a field", NULL);
    }
    for (size_t i = 0; i < system->item_count; i++) {
        struct gm_system_item *item = &system->items[i];
        if (item->word == GM_WORD_INVARIANT || item->word == GM_WORD_OBSERVE) {
            item->check = GM_UNTESTED;
            need_none(system, item->nodes[0], in_density, "a density", NULL);
        }
        const bool constant = item->word == GM_WORD_ENDS || item->word == GM_WORD_ALPHA;
        const char *what = item->word == GM_WORD_ENDS ? "ends:" : "alpha:";
        for (size_t k = 0; constant && k < item->count + item->option_count; k++) {
            const gm_node_id node = k < item->count ? item->nodes[k] : item->options[k - item->count].node;
            need_none(system, node, in_number, what, item);
        }
    }
}

size_t gm_system_mass_field(const struct gm_user_system *system, gm_node_id node)
{
    const size_t n = system->n;
    size_t found = n, count = 0;
    gm_node_id *parts = gm_formula_parts(&system->graph, node, &count);
    for (size_t k = 0; parts && k < count; k++) {
        const struct gm_node *part = &system->graph.nodes[parts[k]];
        if (part->operation == GM_VARIABLE && (part->a < n || part->a > system->velocities)) {
            const size_t field = part->a < n ? part->a : (part->a - system->velocities - 1) % n;
            found = found == n || found == field ? field : n + 1;
        }
    }
    free(parts);
    return found < n ? found : n;
}

bool gm_system_linear_part(struct gm_user_system *system, gm_node_id node, gm_node_id *line, gm_node_id *rest)
{
    bool *fields = calloc(system->variable_count, sizeof *fields),
         *varying = calloc(system->variable_count, sizeof *varying);
    for (size_t i = 0; fields && varying && i < system->variable_count; i++) {
        fields[i] = i < system->n || (i > system->velocities && i < system->initial);
        varying[i] = i < system->parameters || i >= system->velocities;
    }
    struct gm_linear_split split = {GM_NO_NODE, GM_NO_NODE};
    system->graph.failed |=
        !fields || !varying ||
        !gm_linear_part(&system->graph, node, fields, varying, system->variable_count, &split);
    *line = split.line;
    *rest = split.rest;
    free(fields);
    free(varying);
    return !system->graph.failed;
}

static void check_masses(struct gm_user_system *system)
{
    bool known[GM_MOST_FIELDS] = {false};
    const struct gm_system_item *item;
    for (size_t i = 0; (item = gm_system_item_of(system, GM_WORD_MASS, i)); i++) {
        const size_t field = gm_system_mass_field(system, item->nodes[0]);
        gm_system_refuse_if(system, field == system->n, item->place,
                            "a mass is of one of the fields, as in mass: u - u_xx");
        gm_system_refuse_if(system, known[field], item->place, "the mass of %.60s is given twice",
                            system->variables[field].name);
        known[field] = true;
        gm_node_id line, rest;
        gm_arena_need(system->arena, gm_system_linear_part(system, item->nodes[0], &line, &rest));
        gm_system_refuse_if(system, !gm_is_constant(&system->graph, rest, 0), item->place,
                            "a mass is linear in %.60s and its derivatives, with constant coefficients",
                            system->variables[field].name);
    }
}

static void check_evolution(struct gm_user_system *system)
{
    const size_t densities = GM_MOST_DERIVATIVES * system->n + 1;
    const bool *in_rate = others_in_density(system, densities);
    for (size_t i = 0; i < system->n; i++) {
        need_none(system, system->rates[i], in_rate, "the rate of a field", NULL);
    }
    check_masses(system);
    check_line(system, densities);
}

static void check_field(struct gm_user_system *system)
{
    enum { U, U_T };
    need_smooth(system, "V");
    need_none(system, system->energy, others_than(system, U, 1), "V", NULL);
    gm_system_refuse_if(system, system->variables[U_T].exact != GM_NO_NODE, 0, "exact: is of %.60s alone",
                        system->variables[U].name);
    check_line(system, 2);
}

/* K = -K', entry by entry. */
static void check_skew(struct gm_user_system *system, size_t which)
{
    const size_t n = system->n;
    const gm_node_id *entries = system->matrices + which * n * n;
    const size_t *places = system->matrix_places + which * n * n;
    const bool *in_entry = others_than(system, 0, 0);
    const char *name = which == 0 ? "K" : "L";
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j <= i; j++) {
            const size_t pair[] = {i * n + j, j * n + i};
            for (size_t side = 0; side < 2; side++) {
                need_none(system, entries[pair[side]], in_entry, "an entry of a matrix", NULL);
            }
            for (size_t side = 0; side < 2; side++) {
                const struct gm_node *entry = &system->graph.nodes[entries[pair[side]]];
                gm_system_refuse_if(system, entry->operation == GM_CONSTANT && !isfinite(entry->value),
                                    places[pair[side]], "an entry of %s is not a finite number", name);
            }
            const gm_node_id sum = gm_sum(&system->graph, entries[pair[0]], entries[pair[1]]);
            if (gm_equations_vanishes(system, sum) != GM_NOT_ZERO) {
                continue;
            }
            gm_system_refuse_if(system, i == j, places[pair[0]], "%s has to be skew: entry %zu, %zu is not 0",
                                name, i + 1, i + 1);
            gm_system_refuse(system, places[pair[0]],
                             "%s has to be skew: entry %zu, %zu is not minus entry %zu, %zu", name, i + 1,
                             j + 1, j + 1, i + 1);
        }
    }
}

/* a K + b L - S'' is regular for some a and b at some point: else a component lacks an equation. */
static void check_determined(struct gm_user_system *system)
{
    enum { TRIALS = 4 };
    const size_t n = system->n;
    double *values = gm_arena_keep(system->arena, gm_equations_start(system, NULL), free);
    const struct gm_sparse hessian = gm_sparse_jacobian(system->arena, &system->graph, system->rates, n,
                                                        marks_of(system, 0, n), system->variable_count);
    size_t free_one = 0;
    for (int trial = 0; trial < TRIALS && free_one < n; trial++) {
        double matrix[GM_MOST_OF_MATRICES * GM_MOST_OF_MATRICES];
        for (size_t i = 0; i < n; i++) {
            values[i] = 0.3 + 0.37 * gm_sin(1 + 2.3 * (double)i + 5.1 * trial);
        }
        const double *all = gm_equations_values(system, values);
        for (size_t i = 0; i < n * n; i++) {
            matrix[i] = (1.31 + 0.4 * trial) * all[system->matrices[i]] +
                        (0.73 - 0.3 * trial) * all[system->matrices[n * n + i]];
        }
        for (size_t i = 0; i < hessian.count; i++) {
            matrix[hessian.entries[i].row * n + hessian.entries[i].column] -= all[hessian.entries[i].node];
        }
        rank_of(matrix, n, n, 1e-10, &free_one);
    }
    if (free_one < n) {
        gm_system_refuse(system, gm_formula_origin(&system->graph, system->energy),
                         "the equations do not determine %.60s: a K + b L - S'' is singular for all a and b",
                         system->variables[free_one].name);
    }
}

static void check_matrices(struct gm_user_system *system)
{
    for (size_t i = 0; i < system->n; i++) {
        if (system->variables[i].jump != GM_NO_NODE) {
            need_none(system, system->variables[i].jump, others_than(system, 0, 0), "a jump", NULL);
        }
    }
    check_skew(system, 0);
    check_skew(system, 1);
    need_smooth(system, "S");
    need_none(system, system->energy, others_than(system, 0, system->n), "S", NULL);
    check_determined(system);
    check_line(system, 1);
}

/* The motion does not depend on its tangents. */
static void check_tangents(struct gm_user_system *system)
{
    const size_t n = gm_system_motion(system);
    bool *tangents = marks_of(system, 0, 0);
    for (size_t i = 0; i < system->n; i++) {
        tangents[i] = gm_system_is_tangent(system, i);
    }
    for (size_t c = 0; c <= n && system->tangents > 0; c++) {
        const bool energy = c == n && system->kind == GM_CANONICAL;
        const gm_node_id node =
                             energy ? system->energy : system->rates[gm_system_component(system, c % n, 0)],
                         part = gm_formula_first_marked(&system->graph, node, tangents, system->n);
        if (part != GM_NO_NODE) {
            gm_system_refuse(system, system->graph.places[part],
                             "the motion does not depend on its tangents");
        }
    }
}

static void derive_and_check(struct gm_arena *arena, void *data)
{
    struct gm_user_system *system = data;
    derive(system);
    const size_t mark = gm_arena_mark(arena);
    check_tangents(system);
    if (system->kind == GM_FIELD) {
        check_field(system);
    } else if (system->kind == GM_MATRICES) {
        check_matrices(system);
    } else if (system->kind == GM_EVOLUTION) {
        check_evolution(system);
    } else {
        if (system->theta) {
            system->jacobi = GM_ZERO_PROVED; /* Omega is closed: it is the differential of theta */
        } else if (system->kind == GM_POISSON) {
            check_jacobi(system);
        }
        check_start(system);
        check_items(system);
        gm_breaks_declare(system);
    }
    gm_system_need_graph(system);
    gm_arena_release(arena, mark);
}

bool gm_equations_derive(struct gm_user_system *system, struct gm_fault *fault)
{
    *fault = (struct gm_fault){0};
    system->fault = fault;
    /* core/form compiles forms */
    return gm_system_is_form(system) || gm_arena_run(system->arena, derive_and_check, system);
}

bool gm_equations_open(struct gm_user_system *system, const char *text, size_t length,
                       const struct gm_system_value *values, size_t count, struct gm_fault *fault)
{
    const bool derived =
        gm_system_read(system, text, length, values, count, fault) && gm_equations_derive(system, fault);
    bool named = false;
    for (size_t i = system->choices.count; i > 0 && !derived && fault->sentence[0]; i--) {
        const struct gm_written_choice *choice = &system->choices.list[i - 1];
        const struct gm_fault plain = *fault;
        if (choice->chosen != choice->standard) {
            snprintf(fault->sentence, sizeof fault->sentence, "with %s=%s%s%.240s", choice->name,
                     choice->words[choice->chosen], named ? ", " : ": ",
                     plain.sentence + (named ? strlen("with ") : 0));
            named = true;
        }
    }
    return derived;
}
