/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Structure follows from derivatives that vanish: H separates if d2H / dp dq does. The reason against it
   is the first term of the sum whose own derivative does not vanish. Parts of a facet are terms of the
   sum, too. */
#include "core/model/facts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/expression/derivative.h"
#include "core/model/breaks.h"
#include "core/model/equations.h"

/* Limits of the search: terms of a sum, terms tried one by one, nodes visited and nodes added for it. */
enum { MOST_TERMS = 4096, MOST_TRIED = 64, MOST_LOOKED_AT = 1 << 20, MOST_GROWN = 1 << 18 };

static const struct {
    const char *word, *yes, *no;
} rows[GM_FACTS] = {
    [GM_FACT_SEPARABLE] = {"separable", "H = T(p) + V(q)", "holds coordinates and momenta"},
    [GM_FACT_NYSTROM] = {"nystrom", "T is quadratic in the momenta", "is not quadratic in the momenta"},
    [GM_FACT_SECOND_ORDER] = {"second-order", "x' = v and v' = g(x, t)", "holds a velocity"},
    [GM_FACT_MAGNETIC] = {"magnetic", "the velocity is rotated by a magnetic field",
                          "does not rotate the velocity"},
    [GM_FACT_LINEAR] = {"linear", "every rate is linear in the components", "is not linear"},
    [GM_FACT_QUADRATIC] = {"quadratic", "every rate is a polynomial of degree 2", "is not of degree 2"},
    [GM_FACT_VOLUME] = {"volume", "no rate contains its own variable",
                        "contains the variable whose rate it is"},
    [GM_FACT_DIVERGENCE_FREE] = {"divergence-free", "the divergence is 0", "is the divergence"},
    [GM_FACT_SMOOTH] = {"smooth", "no corner and no jump", "is not smooth"},
    [GM_FACT_AUTONOMOUS] = {"autonomous", "the time does not occur", "contains the time"},
    [GM_FACT_FAST_LINEAR] = {"fast-linear", "H = |p|^2/2 + omega^2 q^2/2 + U(q)",
                             "gives no coordinate a frequency of its own"},
    [GM_FACT_KEPLER_SPLIT] = {"kepler-split", "H = |p|^2/2 - 1/|q| + W(q)", "is not -1/|q|"},
    [GM_FACT_GRAVITY] = {"gravity", "H = sum |p_i|^2/(2 m_i) - sum G m_i m_j/|q_i - q_j|",
                         "is not the attraction of two bodies"},
    [GM_FACT_LAGRANGIAN] = {"lagrangian", "L = v^2/2 - V(q), one degree of freedom", ""},
    [GM_FACT_CONFORMAL] = {"conformal", "every force is the same multiple of the momentum",
                           "is not the multiple of the momentum that others are"},
    [GM_FACT_DEGENERATE] = {"degenerate", "L = theta(q) . q' - H(q), linear in the velocities", ""},
    [GM_FACT_HALF_GAUGE] =
        {"half-gauge", "half of theta is 0: degenerate-midpoint2 is symplectic",
         "less than half of theta is 0: certify measures how far degenerate-midpoint2 is from symplectic"},
};

const char *gm_fact_word(enum gm_fact fact)
{
    return rows[fact].word;
}

/* The search, inside a body of the system's arena. Sets of variables: coordinates; momenta, or velocities; all that
   moves; the time; `own` marks none, and now and then one. */
struct search {
    struct gm_user_system *system;
    struct gm_finding *findings;
    gm_node_id *nodes; /* of facets */
    bool *q, *p, *all, *own, *time;
};

/* true if a node depends on a marked variable */
static bool depends(struct gm_user_system *system, gm_node_id node, const bool *marked)
{
    return gm_formula_holds(&system->graph, node, marked, system->variable_count);
}

/* Sets of marked variables. */
struct sets {
    struct gm_user_system *system;
    const bool *const *sets;
    size_t depth;
};

/* True for a kink, or a root that may be one, that depends on each of the sets: derivatives vanish on both
   sides of it, and prove nothing. */
static bool is_kink(struct gm_formula *graph, gm_node_id part, const void *data)
{
    const struct sets *sets = data;
    const enum gm_operation operation = graph->nodes[part].operation;
    bool found =
        operation > GM_VARIABLE && (!gm_operation_rows[operation].smooth || operation == GM_OPERATION_SQRT);
    for (size_t k = 0; k < sets->depth && found; k++) {
        found = depends(sets->system, part, sets->sets[k]);
    }
    return found;
}

/* Tests if all derivatives of a node, over sets[0], of these over sets[1], and so on, are 0. */
static enum gm_identity vanishes(struct gm_user_system *system, gm_node_id node, const bool *const *sets,
                                 size_t depth)
{
    if (depth == 0) {
        return gm_equations_vanishes(system, node);
    }
    if (!depends(system, node, sets[0])) {
        return GM_ZERO_PROVED;
    }
    enum gm_identity all = GM_ZERO_PROVED;
    const size_t mark = gm_arena_mark(system->arena);
    const gm_node_id *gradient = gm_equations_gradient(system, node, sets[0]);
    for (size_t i = 0; i < system->variable_count && all != GM_NOT_ZERO; i++) {
        if (sets[0][i] && !gm_is_constant(&system->graph, gradient[i], 0)) {
            const enum gm_identity found = vanishes(system, gradient[i], sets + 1, depth - 1);
            all = found == GM_ZERO_PROVED ? all : found;
        }
    }
    gm_arena_release(system->arena, mark);
    gm_system_need_graph(system);
    const struct sets of = {system, sets, depth};
    const bool kinked =
        all != GM_NOT_ZERO && gm_formula_first(&system->graph, node, is_kink, &of) != GM_NO_NODE;
    return kinked ? GM_NOT_ZERO : all;
}

/* A term of a sum: coefficient * node; the coefficient is free of components. */
struct term {
    gm_node_id node, coefficient;
};

/* The terms of a node as a sum, at most MOST_TERMS. */
static struct term *terms_of(const struct search *search, gm_node_id root, size_t *count)
{
    struct gm_user_system *system = search->system;
    struct gm_formula *graph = &system->graph;
    const bool *dependent =
        gm_arena_keep(system->arena, gm_formula_dependent(graph, search->all, system->variable_count), free);
    struct term *terms = gm_arena_take(system->arena, 2 * (MOST_TERMS + 1), sizeof *terms),
                *stack = terms + MOST_TERMS + 1;
    size_t depth = 0;
    *count = 0;
    stack[depth++] = (struct term){root, gm_formula_constant(graph, 1)};
    while (depth > 0) {
        const struct term top = stack[--depth];
        const struct gm_node here = graph->nodes[top.node];
        const bool is_last = *count + depth + 2 > MOST_TERMS;
        switch (is_last ? GM_CONSTANT : here.operation) {
        case GM_OPERATION_ADD:
        case GM_OPERATION_SUBTRACT:
            stack[depth++] = (struct term){here.b, here.operation == GM_OPERATION_ADD
                                                       ? top.coefficient
                                                       : gm_negative(&system->graph, top.coefficient)};
            stack[depth++] = (struct term){here.a, top.coefficient};
            continue;
        case GM_OPERATION_NEGATE:
            stack[depth++] = (struct term){here.a, gm_negative(&system->graph, top.coefficient)};
            continue;
        case GM_OPERATION_MULTIPLY:
        case GM_OPERATION_DIVIDE:
            if (!dependent[here.b]) {
                stack[depth++] = (struct term){
                    here.a, gm_simplified(&system->graph, here.operation, top.coefficient, here.b)};
                continue;
            }
            if (here.operation == GM_OPERATION_MULTIPLY && !dependent[here.a]) {
                stack[depth++] = (struct term){here.b, gm_product(&system->graph, top.coefficient, here.a)};
                continue;
            }
            break;
        default:
            break;
        }
        terms[(*count)++] = top;
    }
    gm_system_need_graph(system);
    return terms;
}

/* The first term whose derivatives do not vanish; the node itself if no single term is the reason. */
static gm_node_id culprit(const struct search *search, gm_node_id node, const bool *const *sets, size_t depth)
{
    struct gm_user_system *system = search->system;
    size_t count = 0;
    const size_t mark = gm_arena_mark(system->arena);
    const struct term *terms = terms_of(search, node, &count);
    const size_t most = system->graph.count + MOST_GROWN;
    gm_node_id found = node;
    for (size_t i = 0; i < count && i < MOST_TRIED && system->graph.count < most; i++) {
        if (vanishes(system, terms[i].node, sets, depth) == GM_NOT_ZERO) {
            found = terms[i].node;
            break;
        }
    }
    gm_arena_release(system->arena, mark);
    return found;
}

static void conclude(struct gm_finding *finding, enum gm_identity found)
{
    finding->holds = finding->holds && (found == GM_ZERO_PROVED || found == GM_ZERO_TESTED);
    finding->how = found == GM_ZERO_PROVED ? finding->how : found;
}

static void deny(struct gm_finding *finding, gm_node_id term, const char *why)
{
    finding->holds = false;
    finding->how = GM_NOT_ZERO;
    finding->term = term;
    finding->why = why;
}

/* Concludes that the derivatives of a node over sets[0], of these over sets[1] .. vanish; else one of its terms is
   the reason. Returns whether the finding holds. */
static bool need_vanishing(const struct search *search, struct gm_finding *finding, gm_node_id node,
                           const bool *const *sets, size_t depth)
{
    conclude(finding, vanishes(search->system, node, sets, depth));
    finding->term = finding->holds ? GM_NO_NODE : culprit(search, node, sets, depth);
    return finding->holds;
}

/* Tests the energy, or L with velocities for momenta: if L = T(v) - V(q), H separates as well, and the
   transform of a quadratic T is quadratic. In a splitting the time moves with q, so its T may not hold it; the
   Lagrangian of a quadratic T may. */
static void find_split(const struct search *search)
{
    struct gm_finding *separable = &search->findings[GM_FACT_SEPARABLE],
                      *nystrom = &search->findings[GM_FACT_NYSTROM];
    const gm_node_id energy = search->system->energy;
    const bool lagrangian = search->system->kind == GM_LAGRANGIAN;
    const bool *const both[] = {search->p, search->q}, *const thrice[] = {search->p, search->p, search->p},
                      *const moving[] = {search->p, search->time};
    static const char *const why[2][2] = {
        {NULL, "holds momenta and the time"},
        {"holds coordinates and velocities", "holds velocities and the time"}};
    separable->asked = nystrom->asked = true;
    const bool splits = need_vanishing(search, separable, energy, both, 2);
    if (!splits || !need_vanishing(search, separable, energy, moving, 2)) {
        separable->why = why[lagrangian][splits];
    }
    if (!splits) {
        deny(nystrom, GM_NO_NODE, lagrangian ? "L does not separate" : "H does not separate");
    } else if (!need_vanishing(search, nystrom, energy, thrice, 3)) {
        nystrom->why = lagrangian ? "is not quadratic in the velocities" : NULL;
    }
}

/* Derivative over variable i. */
static gm_node_id slope_of(const struct search *search, gm_node_id node, size_t i)
{
    struct gm_arena *arena = search->system->arena;
    const size_t mark = gm_arena_mark(arena);
    search->own[i] = true;
    const gm_node_id slope = gm_equations_gradient(search->system, node, search->own)[i];
    search->own[i] = false;
    gm_arena_release(arena, mark);
    return slope;
}

/* True if a node depends on variable i. */
static bool depends_on(const struct search *search, gm_node_id node, size_t i)
{
    search->own[i] = true;
    const bool depending = depends(search->system, node, search->own);
    search->own[i] = false;
    return depending;
}

/* The first momentum, or velocity of a Lagrangian. */
static size_t first_moving(const struct gm_user_system *system)
{
    return system->kind == GM_LAGRANGIAN ? system->velocities : system->n / 2;
}

/* True if the system has unit masses, H = |p|^2/2 + V(q), or L = |v|^2/2 - V(q), and no forces. Else the
   finding has the reason. */
static bool is_of_unit_mass(const struct search *search, struct gm_finding *finding)
{
    struct gm_user_system *system = search->system;
    struct gm_formula *graph = &system->graph;
    const size_t half = system->n / 2, first = first_moving(system);
    const bool lagrangian = system->kind == GM_LAGRANGIAN;
    if (gm_system_item_of(system, GM_WORD_CONSTRAINT, 0)) {
        deny(finding, GM_NO_NODE, "it has constraints");
        return false;
    }
    for (size_t i = 0; i < half; i++) {
        if (system->variables[i].force != GM_NO_NODE) {
            deny(finding, system->variables[i].force, lagrangian ? "acts beside L" : "acts beside H");
            return false;
        }
    }
    if (!search->findings[GM_FACT_SEPARABLE].holds || system->timed) {
        deny(finding, GM_NO_NODE, system->timed ? "the time occurs" : search->findings[GM_FACT_NYSTROM].why);
        return false;
    }
    for (size_t i = 0; i < half && finding->holds; i++) {
        const gm_node_id p = gm_formula_variable(graph, first + i);
        const gm_node_id slope = lagrangian ? system->momenta[i] : system->rates[i];
        conclude(finding, gm_equations_vanishes(system, gm_difference(graph, slope, p)));
        size_t count = 0;
        const struct term *terms = finding->holds ? NULL : terms_of(search, system->energy, &count);
        finding->why = lagrangian ? "is not of |v|^2/2" : "is not of |p|^2/2";
        for (size_t k = 0; k < count && k < MOST_TRIED && finding->term == GM_NO_NODE; k++) {
            if (depends_on(search, terms[k].node, first + i)) {
                const gm_node_id part =
                    gm_product(graph, terms[k].coefficient, slope_of(search, terms[k].node, first + i));
                const gm_node_id rest = gm_difference(graph, part, p);
                finding->term =
                    gm_equations_vanishes(system, rest) == GM_NOT_ZERO ? terms[k].node : GM_NO_NODE;
            }
        }
    }
    if (!finding->holds && finding->term == GM_NO_NODE) {
        finding->why = lagrangian ? "the kinetic energy is not |v|^2/2" : "the kinetic energy is not |p|^2/2";
    }
    return finding->holds;
}

/* a node with `count` variables from `first` on set to 0 */
static gm_node_id at_zero(struct gm_user_system *system, gm_node_id node, size_t first, size_t count)
{
    const size_t mark = gm_arena_mark(system->arena);
    gm_node_id *replacement = gm_system_no_nodes(system, system->variable_count);
    const gm_node_id zero = gm_formula_constant(&system->graph, 0);
    for (size_t i = first; i < first + count; i++) {
        replacement[i] = zero;
    }
    gm_formula_substitute(&system->graph, &node, 1, replacement, system->variable_count);
    gm_arena_release(system->arena, mark);
    return node;
}

/* V of a system that is_of_unit_mass: H, or -L, at rest */
static gm_node_id potential_of(struct gm_user_system *system)
{
    const gm_node_id rest = at_zero(system, system->energy, first_moving(system), system->n / 2);
    return system->kind == GM_LAGRANGIAN ? gm_negative(&system->graph, rest) : rest;
}

/* values of all nodes at the start */
static const double *values_at_start(struct gm_user_system *system)
{
    return gm_equations_values(system, gm_arena_keep(system->arena, gm_equations_start(system, NULL), free));
}

/* forces[i] = -d node / d q_i */
static void forces_of(const struct search *search, gm_node_id node, gm_node_id *forces)
{
    const gm_node_id *gradient = gm_equations_gradient(search->system, node, search->q);
    for (size_t i = 0; i < search->system->n / 2; i++) {
        forces[i] = gm_negative(&search->system->graph, gradient[i]);
    }
}

/* A term of the potential that depends on one coordinate alone, and its second derivative. */
struct well {
    size_t coordinate; /* SIZE_MAX: the term depends on no coordinate, or on several */
    gm_node_id slope, stiffness;
};

/* The wells of all terms. A stiffness that depends on the state makes none. */
static struct well *wells_of(const struct search *search, const struct term *terms, size_t count)
{
    struct gm_user_system *system = search->system;
    struct gm_formula *graph = &system->graph;
    struct well *wells = gm_arena_take(system->arena, count + 1, sizeof *wells);
    const size_t most = graph->count + MOST_GROWN;
    for (size_t k = 0; k < count; k++) {
        struct well *well = &wells[k];
        size_t size = 0, held = 0;
        const gm_node_id *parts =
            gm_arena_keep(system->arena, gm_formula_parts(graph, terms[k].node, &size), free);
        *well = (struct well){.coordinate = SIZE_MAX};
        for (size_t i = 0; i < size; i++) {
            const struct gm_node *part = &graph->nodes[parts[i]];
            if (part->operation == GM_VARIABLE && search->q[part->a]) {
                well->coordinate = held++ == 0 ? part->a : SIZE_MAX;
            }
        }
        if (well->coordinate == SIZE_MAX || graph->count > most) {
            well->coordinate = SIZE_MAX;
            continue;
        }
        const size_t i = well->coordinate;
        well->slope = gm_product(graph, terms[k].coefficient, slope_of(search, terms[k].node, i));
        well->stiffness = slope_of(search, well->slope, i);
        well->coordinate = depends(system, well->stiffness, search->all) ? SIZE_MAX : i;
    }
    return wells;
}

/* The quadratic terms of each coordinate give its frequency; the rest of them, and all others, are U. */
static void find_fast_linear(const struct search *search, struct gm_finding *finding, gm_node_id potential,
                             gm_node_id *nodes)
{
    struct gm_user_system *system = search->system;
    struct gm_formula *graph = &system->graph;
    const size_t half = system->n / 2;
    size_t count = 0, frequencies = 0;
    const gm_node_id zero = gm_formula_constant(graph, 0);
    const struct term *terms = terms_of(search, potential, &count);
    const struct well *wells = wells_of(search, terms, count);
    const double *values = values_at_start(system);
    gm_node_id slow = zero, *squares = gm_arena_take(system->arena, 2 * half + 1, sizeof *squares),
               *rest = squares + half;
    for (size_t i = 0; i < half; i++) {
        squares[i] = rest[i] = zero;
    }
    for (size_t k = 0; k < count; k++) {
        const size_t i = wells[k].coordinate;
        if (i == SIZE_MAX || !(values[wells[k].stiffness] > 0)) {
            slow = gm_sum(graph, slow, gm_product(graph, terms[k].coefficient, terms[k].node));
            continue;
        }
        squares[i] = gm_sum(graph, squares[i], wells[k].stiffness);
        rest[i] = gm_sum(graph, rest[i], at_zero(system, wells[k].slope, i, 1));
        frequencies++;
    }
    if (frequencies == 0) {
        deny(finding, GM_NO_NODE, "no coordinate has a frequency of its own");
        for (size_t k = 0; k < count && finding->term == GM_NO_NODE; k++) {
            finding->term = depends(system, terms[k].node, search->q) ? terms[k].node : GM_NO_NODE;
            finding->why = finding->term == GM_NO_NODE ? finding->why : NULL;
        }
        return;
    }
    forces_of(search, slow, nodes + half);
    for (size_t i = 0; i < half; i++) {
        nodes[i] = squares[i] == zero ? zero : gm_simplified(graph, GM_OPERATION_SQRT, squares[i], 0);
        nodes[half + i] = gm_difference(graph, nodes[half + i], rest[i]);
    }
    finding->nodes = nodes;
}

/* 1/|q_i - q_j|; `other` NULL: 1/|q_i| */
static gm_node_id inverse_distance(struct gm_formula *graph, size_t dimensions, const size_t *one,
                                   const size_t *other)
{
    gm_node_id square = gm_formula_constant(graph, 0);
    for (size_t c = 0; c < dimensions; c++) {
        const gm_node_id q = gm_formula_variable(graph, one[c]),
                         x = other ? gm_difference(graph, q, gm_formula_variable(graph, other[c])) : q;
        square = gm_sum(graph, square, gm_product(graph, x, x));
    }
    return gm_simplified(graph, GM_OPERATION_DIVIDE, gm_formula_constant(graph, 1),
                         gm_simplified(graph, GM_OPERATION_SQRT, square, 0));
}

/* Finds the term -1/|q|; the others are the perturbation. */
static void find_kepler_split(const struct search *search, struct gm_finding *finding, gm_node_id potential,
                              gm_node_id *nodes)
{
    struct gm_user_system *system = search->system;
    struct gm_formula *graph = &system->graph;
    size_t count = 0;
    const struct term *terms = terms_of(search, potential, &count);
    const gm_node_id inverse = inverse_distance(graph, 2, (const size_t[]){0, 1}, NULL);
    gm_node_id perturbation = gm_formula_constant(graph, 0), other = GM_NO_NODE;
    bool found = false;
    for (size_t k = 0; k < count; k++) {
        const gm_node_id term = gm_product(graph, terms[k].coefficient, terms[k].node);
        const bool held = depends(system, terms[k].node, search->q);
        const enum gm_identity is_kepler = found || !held || k >= MOST_TRIED
                                               ? GM_NOT_ZERO
                                               : gm_equations_vanishes(system, gm_sum(graph, term, inverse));
        if (is_kepler == GM_ZERO_PROVED || is_kepler == GM_ZERO_TESTED) {
            conclude(finding, is_kepler);
            found = true;
        } else {
            perturbation = gm_sum(graph, perturbation, term);
            other = held && other == GM_NO_NODE ? terms[k].node : other;
        }
    }
    nodes[0] = potential;
    forces_of(search, perturbation, nodes + 1);
    if (!found) {
        deny(finding, other, other == GM_NO_NODE ? "there is no -1/|q|" : NULL);
    } else if (!(values_at_start(system)[potential] < 0)) {
        deny(finding, GM_NO_NODE, "the potential is not negative at the start");
    }
    finding->nodes = nodes;
}

/* V, V', V'' */
static void find_one_degree(const struct search *search, struct gm_finding *finding, gm_node_id potential,
                            gm_node_id *nodes)
{
    nodes[0] = potential;
    nodes[1] = slope_of(search, nodes[0], 0);
    nodes[2] = slope_of(search, nodes[1], 0);
    finding->nodes = nodes;
}

/* Finds c with -c p for every force, from the first one, by the derivatives of force and momentum. */
static void find_conformal(const struct search *search, struct gm_finding *finding, gm_node_id *nodes)
{
    static const char changes[] = "is not a constant multiple of the momentum";
    struct gm_user_system *system = search->system;
    struct gm_formula *graph = &system->graph;
    const size_t half = system->n / 2, first = first_moving(system);
    const bool lagrangian = system->kind == GM_LAGRANGIAN;
    for (size_t i = 0; i < half; i++) {
        finding->asked |= system->variables[i].force != GM_NO_NODE;
    }
    for (size_t i = 0; i < half && finding->asked && finding->holds; i++) {
        const gm_node_id written = system->variables[i].force;
        const gm_node_id p = lagrangian ? system->momenta[i] : gm_formula_variable(graph, first + i);
        gm_node_id force = written;
        if (force == GM_NO_NODE) {
            deny(finding, GM_NO_NODE, "no force acts");
            finding->component = half + i;
            break;
        }
        if (lagrangian) {
            gm_equations_in_velocities(system, &force, 1);
        }
        if (i == 0) {
            nodes[0] =
                gm_negative(graph, gm_simplified(graph, GM_OPERATION_DIVIDE, slope_of(search, force, first),
                                                 slope_of(search, p, first)));
        }
        const gm_node_id rest = gm_sum(graph, force, gm_product(graph, nodes[0], p));
        conclude(finding, gm_equations_vanishes(system, rest));
        const bool varies = depends(system, nodes[0], search->all) || depends_on(search, nodes[0], system->n);
        if (!finding->holds || varies) {
            deny(finding, written, i == 0 ? changes : NULL);
        }
    }
    finding->nodes = finding->holds ? nodes : NULL;
}

/* Finds the facets of H = |p|^2/2 + V(q), and of its Lagrangian. */
static void find_mechanical(const struct search *search, gm_node_id *nodes)
{
    struct gm_user_system *system = search->system;
    struct gm_finding common = search->findings[GM_FACT_SEPARABLE];
    const size_t n = system->n;
    const bool canonical =
        system->kind == GM_CANONICAL && system->tangents == 0; /* else more moves than H says */
    const bool holds = is_of_unit_mass(search, &common);
    const gm_node_id potential = holds ? potential_of(system) : GM_NO_NODE;
    const struct {
        enum gm_fact fact;
        bool asked;
        void (*find)(const struct search *search, struct gm_finding *finding, gm_node_id potential,
                     gm_node_id *nodes);
        gm_node_id *nodes;
        size_t count;
    } facets[] = {
        {GM_FACT_FAST_LINEAR, canonical, find_fast_linear, nodes, n},
        {GM_FACT_KEPLER_SPLIT, canonical && n == 4, find_kepler_split, nodes + n, 3},
        {GM_FACT_LAGRANGIAN, n == 2, find_one_degree, nodes + n + 3, 3},
    };
    enum { FACETS = GM_COUNT(facets) };
    for (size_t i = 0; i < FACETS; i++) {
        struct gm_finding *finding = &search->findings[facets[i].fact];
        *finding = common;
        finding->asked = facets[i].asked;
        if (holds && facets[i].asked) {
            facets[i].find(search, finding, potential, facets[i].nodes);
        }
    }
    const double *values = holds ? values_at_start(system) : NULL;
    for (size_t i = 0; i < FACETS && values; i++) {
        struct gm_finding *finding = &search->findings[facets[i].fact];
        for (size_t k = 0; k < facets[i].count && finding->asked && finding->holds; k++) {
            if (!isfinite(values[finding->nodes[k]])) { /* p^3/p at rest */
                deny(finding, GM_NO_NODE, "it cannot be taken apart as it is written");
            }
        }
    }
}

/* Denies that the divergence is 0 where rates jump along their own components, or H along the motion. */
static void need_passing(const struct search *search, struct gm_finding *finding)
{
    struct gm_user_system *system = search->system;
    gm_node_id at = GM_NO_NODE;
    conclude(finding, gm_breaks_pass(system->arena, system, system->rates, system->n, NULL, system->n, &at));
    finding->why = "jumps, and volume changes across the jump";
    if (finding->holds && system->kind != GM_RATES) {
        conclude(finding,
                 gm_breaks_pass(system->arena, system, &system->energy, 1, system->rates, system->n, &at));
        finding->why = "jumps in H, and the equations have no force for that";
    }
    finding->term = at;
}

static void find_of_rates(const struct search *search)
{
    struct gm_user_system *system = search->system;
    struct gm_finding *findings = search->findings, *volume = &findings[GM_FACT_VOLUME],
                      *divergence = &findings[GM_FACT_DIVERGENCE_FREE];
    const bool *const thrice[] = {search->all, search->all, search->all}, *const once[] = {search->own};
    gm_node_id sum = gm_formula_constant(&system->graph, 0);
    findings[GM_FACT_LINEAR].asked = findings[GM_FACT_QUADRATIC].asked = true;
    volume->asked = divergence->asked = true;
    for (size_t i = 0; i < system->n; i++) {
        const gm_node_id rate = system->rates[i];
        for (size_t degree = 1; degree <= 2; degree++) {
            struct gm_finding *polynomial = &findings[degree == 1 ? GM_FACT_LINEAR : GM_FACT_QUADRATIC];
            if (polynomial->holds) {
                need_vanishing(search, polynomial, rate, thrice, degree + 1);
                polynomial->component = i;
            }
        }
        if (!depends_on(search, rate, i)) { /* excludes most rates before a longer test */
            continue;
        }
        search->own[i] = true;
        if (volume->holds) {
            need_vanishing(search, volume, rate, once, 1);
            volume->component = i;
        }
        search->own[i] = false;
        sum = gm_sum(&system->graph, sum, slope_of(search, rate, i));
    }
    conclude(divergence, gm_equations_vanishes(system, sum));
    divergence->term = divergence->holds ? GM_NO_NODE : sum;
    if (divergence->holds) {
        need_passing(search, divergence);
    }
}

/* Finds x' = v, v' = g(x, t) for the first and the second half of the components. */
static void find_second_order(const struct search *search, struct gm_finding *finding)
{
    const struct gm_user_system *system = search->system;
    const size_t half = system->n / 2;
    const bool *const once[] = {search->p};
    finding->asked = true;
    if (system->n % 2 != 0) {
        deny(finding, GM_NO_NODE, "the number of components is odd");
        return;
    }
    for (size_t i = 0; i < system->n && finding->holds; i++) {
        const gm_node_id rate = system->rates[i];
        finding->component = i;
        if (i >= half) {
            need_vanishing(search, finding, rate, once, 1);
        } else if (rate != gm_formula_variable(&search->system->graph, half + i)) {
            deny(finding, rate, "is not a velocity");
        }
    }
}

/* Concludes that a node vanishes; else the rate of a component is the reason. */
static void need_zero(struct gm_user_system *system, struct gm_finding *finding, gm_node_id node,
                      size_t component)
{
    if (finding->holds) {
        conclude(finding, gm_equations_vanishes(system, node));
        finding->component = component;
        finding->term = finding->holds ? GM_NO_NODE : system->rates[component];
    }
}

/* Bodies whose potential is a sum over pairs. */
struct pairs {
    const struct term *terms;
    size_t count, dimensions, bodies;
    bool *held;     /* [count][n / 2]: the coordinates of each term */
    size_t *places; /* the coordinates, body by body */
    size_t *body;   /* of each coordinate */
};

/* Marks the coordinates that each term holds, those of two bodies. */
static bool find_pairs(const struct search *search, struct gm_finding *finding, struct pairs *pairs)
{
    struct gm_user_system *system = search->system;
    const size_t half = system->n / 2, mark = gm_arena_mark(system->arena);
    for (size_t k = 0; k < pairs->count; k++) {
        size_t size = 0, held = 0;
        const gm_node_id *parts =
            gm_arena_keep(system->arena, gm_formula_parts(&system->graph, pairs->terms[k].node, &size), free);
        for (size_t i = 0; i < size; i++) {
            const struct gm_node *part = &system->graph.nodes[parts[i]];
            if (part->operation == GM_VARIABLE && part->a < half) {
                pairs->held[k * half + part->a] = true;
                held++;
            }
        }
        gm_arena_release(system->arena, mark);
        pairs->dimensions = k == 0 ? held / 2 : pairs->dimensions;
        if ((held != 4 && held != 6) || held != 2 * pairs->dimensions) {
            deny(finding, pairs->terms[k].node, NULL);
            return false;
        }
    }
    pairs->bodies = pairs->count > 0 ? half / pairs->dimensions : 0;
    if (pairs->bodies * pairs->dimensions != half ||
        2 * pairs->count != pairs->bodies * (pairs->bodies - 1)) {
        deny(finding, GM_NO_NODE, "not every two bodies attract each other by one term");
    }
    return finding->holds;
}

/* Returns true if a coordinate is one of the first body, which has the coordinate 0: all terms hold both or none of them.
   The two bodies of a single term differ by their masses. */
static bool is_of_first(const struct search *search, const struct pairs *pairs, size_t coordinate)
{
    struct gm_user_system *system = search->system;
    const size_t half = system->n / 2;
    bool same = true;
    for (size_t k = 0; k < pairs->count; k++) {
        same = same && pairs->held[k * half] == pairs->held[k * half + coordinate];
    }
    return pairs->count > 1
               ? same
               : gm_equations_vanishes(
                     system, gm_difference(&system->graph, slope_of(search, system->rates[0], half),
                                           slope_of(search, system->rates[coordinate], half + coordinate))) !=
                     GM_NOT_ZERO;
}

/* Finds the coordinates of a body by the term that it shares with the first one, which holds the difference of theirs
   along each axis. */
static bool find_places(const struct search *search, const struct pairs *pairs, size_t term, size_t body)
{
    struct gm_user_system *system = search->system;
    const gm_node_id node = pairs->terms[term].node;
    const size_t half = system->n / 2, d = pairs->dimensions;
    const bool *held = pairs->held + term * half;
    size_t axes = 0;
    for (size_t a = 0; a < half; a++) {
        for (size_t b = a + 1; b < half && held[a]; b++) {
            if (!held[b] || gm_equations_vanishes(system, gm_sum(&system->graph, slope_of(search, node, a),
                                                                 slope_of(search, node, b))) == GM_NOT_ZERO) {
                continue;
            }
            const bool first = is_of_first(search, pairs, a);
            size_t axis = body == 1 ? axes : 0;
            while (body > 1 && axis < d && pairs->places[axis] != (first ? a : b)) {
                axis++;
            }
            if (axis == d) {
                return false;
            }
            pairs->places[axis] = first ? a : b;
            pairs->places[body * d + axis] = first ? b : a;
            pairs->body[first ? b : a] = body;
            axes++;
        }
    }
    return axes == d;
}

/* G of a term of the first two bodies, with the distance 1 along the axis of a coordinate. */
static gm_node_id strength_of(const struct search *search, const struct term *term, size_t coordinate)
{
    struct gm_user_system *system = search->system;
    gm_node_id *replacement = gm_system_no_nodes(system, system->variable_count), node = term->node;
    for (size_t i = 0; i < system->n / 2; i++) {
        replacement[i] = gm_formula_constant(&system->graph, i == coordinate);
    }
    gm_formula_substitute(&system->graph, &node, 1, replacement, system->variable_count);
    return gm_negative(&system->graph, gm_product(&system->graph, term->coefficient, node));
}

/* Writes the masses and G, and concludes that all terms are those of the energy. */
static void prove_gravity(const struct search *search, struct gm_finding *finding, const struct pairs *pairs,
                          gm_node_id strength, gm_node_id *nodes)
{
    struct gm_user_system *system = search->system;
    struct gm_formula *graph = &system->graph;
    const size_t half = system->n / 2, d = pairs->dimensions, bodies = pairs->bodies;
    gm_node_id *lightness = nodes + 1 + half; /* 1/m */
    bool *paired = gm_arena_take(system->arena, bodies * bodies, sizeof *paired);
    nodes[0] = gm_formula_constant(graph, (double)d);
    for (size_t i = 0; i < half; i++) {
        const size_t place = pairs->places[i];
        const gm_node_id rate = system->rates[place], p = gm_formula_variable(graph, half + place);
        nodes[1 + i] = gm_formula_variable(graph, place);
        lightness[i / d] = i % d == 0 ? slope_of(search, rate, half + place) : lightness[i / d];
        need_zero(system, finding, gm_difference(graph, rate, gm_product(graph, lightness[i / d], p)), place);
    }
    const gm_node_id G = gm_product(graph, strength, gm_product(graph, lightness[0], lightness[1]));
    for (size_t k = 0; k < pairs->count && finding->holds; k++) {
        size_t a = 0, b;
        while (!pairs->held[k * half + a]) {
            a++;
        }
        for (b = a; !pairs->held[k * half + b] || pairs->body[b] == pairs->body[a]; b++) {
        }
        const size_t i = pairs->body[a], j = pairs->body[b];
        const gm_node_id attraction = gm_product(
            graph,
            gm_simplified(graph, GM_OPERATION_DIVIDE, G, gm_product(graph, lightness[i], lightness[j])),
            inverse_distance(graph, d, pairs->places + i * d, pairs->places + j * d));
        const gm_node_id term = gm_product(graph, pairs->terms[k].coefficient, pairs->terms[k].node);
        conclude(finding, gm_equations_vanishes(system, gm_sum(graph, term, attraction)));
        if (!finding->holds || paired[i * bodies + j]) {
            deny(finding, pairs->terms[k].node, "is not G m_i m_j/|q_i - q_j| with the G of the first term");
        }
        paired[i * bodies + j] = paired[j * bodies + i] = true;
    }
    nodes[1 + half + bodies] = G;
    finding->nodes = nodes;
}

/* Finds bodies by their pairs, the first one in each of its terms, and then proves each term. */
static void find_gravity(const struct search *search, struct gm_finding *finding, gm_node_id *nodes)
{
    struct gm_user_system *system = search->system;
    const size_t half = system->n / 2;
    struct pairs pairs = {.dimensions = 0};
    pairs.terms = terms_of(search, at_zero(system, system->energy, half, half), &pairs.count);
    pairs.held = gm_arena_take(system->arena, pairs.count * half, sizeof *pairs.held);
    pairs.places = gm_arena_take(system->arena, 2 * half, sizeof *pairs.places);
    pairs.body = pairs.places + half;
    finding->asked = true;
    if (!find_pairs(search, finding, &pairs)) {
        return;
    }
    size_t body = 1;
    gm_node_id strength = GM_NO_NODE;
    for (size_t k = 0; k < pairs.count; k++) {
        if (!pairs.held[k * half]) {
            continue;
        }
        if (body == pairs.bodies || !find_places(search, &pairs, k, body)) {
            deny(finding, pairs.terms[k].node, NULL);
            return;
        }
        strength = body++ == 1 ? strength_of(search, &pairs.terms[k], 0) : strength;
    }
    if (body != pairs.bodies) {
        deny(finding, GM_NO_NODE, "not every two bodies attract each other by one term");
        return;
    }
    prove_gravity(search, finding, &pairs, strength, nodes);
}

/* Returns true if H is all that acts. */
static bool is_alone(const struct gm_user_system *system)
{
    bool alone = system->tangents == 0 && !gm_system_item_of(system, GM_WORD_CONSTRAINT, 0);
    for (size_t i = 0; i < system->n; i++) {
        alone = alone && system->variables[i].force == GM_NO_NODE;
    }
    return alone;
}

/* Writes the nodes of the facet: the velocity u of p = 0, or 0; g; W by rows, which are the slopes of v' over v, or
   those of u over x without their symmetric part; c, the slope of v over p, or 1. */
static void write_magnetic(const struct search *search, gm_node_id *nodes)
{
    struct gm_user_system *system = search->system;
    struct gm_formula *graph = &system->graph;
    const size_t n = system->n, half = n / 2;
    gm_node_id *u = nodes, *g = u + half, *w = g + half, *c = w + half * half;
    gm_node_id *replacement = gm_system_no_nodes(system, system->variable_count);
    const gm_node_id zero = gm_formula_constant(graph, 0);
    if (system->kind == GM_RATES) {
        for (size_t i = 0; i < half; i++) {
            u[i] = zero;
            g[i] = at_zero(system, system->rates[half + i], half, half);
        }
        *c = gm_formula_constant(graph, 1);
        return;
    }
    *c = w[0];
    for (size_t i = 0; i < half; i++) {
        u[i] = at_zero(system, system->rates[i], half, half);
        replacement[half + i] = gm_negative(graph, gm_simplified(graph, GM_OPERATION_DIVIDE, u[i], *c));
    }
    for (size_t i = 0; i < half; i++) {
        g[i] = system->rates[half + i];
        gm_formula_substitute(graph, &g[i], 1, replacement, system->variable_count);
        g[i] = gm_sum(graph, gm_product(graph, *c, g[i]), slope_of(search, u[i], n)); /* du/dt */
        for (size_t j = 0; j < half; j++) {
            w[i * half + j] = gm_difference(graph, slope_of(search, u[i], j), slope_of(search, u[j], i));
        }
    }
}

/* Finds v' = g + W v by the slopes of v' over v, which hold no v and are antisymmetric; or p = v/c + A by those of
   v = dH/dp over p, which are c times the unit matrix. */
static void find_magnetic(const struct search *search, struct gm_finding *finding, gm_node_id *nodes)
{
    struct gm_user_system *system = search->system;
    struct gm_formula *graph = &system->graph;
    const size_t half = system->n / 2;
    const bool canonical = system->kind == GM_CANONICAL;
    const size_t first = canonical ? 0 : half; /* of the rates that are looked at */
    const bool *const fixed = canonical ? search->all : search->p;
    gm_node_id *slopes = nodes + 2 * half;
    for (size_t i = 0; i < half && !canonical; i++) {
        const gm_node_id v = gm_formula_variable(graph, half + i);
        need_zero(system, finding, gm_difference(graph, system->rates[i], v), i);
    }
    for (size_t i = 0; i < half * half && finding->holds; i++) {
        const size_t row = i / half, column = i % half;
        slopes[i] = slope_of(search, system->rates[first + row], half + column);
        if (canonical) {
            need_zero(system, finding, row == column ? gm_difference(graph, slopes[i], slopes[0]) : slopes[i],
                      row);
        } else if (column <= row) {
            need_zero(system, finding, gm_sum(graph, slopes[i], slopes[column * half + row]), first + row);
        }
        if (finding->holds &&
            (depends(system, slopes[i], fixed) || (canonical && depends_on(search, slopes[i], system->n)))) {
            deny(finding, system->rates[first + row], NULL);
            finding->component = first + row;
        }
    }
    if (canonical && finding->holds && gm_equations_vanishes(system, slopes[0]) != GM_NOT_ZERO) {
        deny(finding, GM_NO_NODE, "H is not quadratic in the momenta");
        finding->component = system->n;
    }
    if (finding->holds) {
        write_magnetic(search, nodes);
        finding->nodes = nodes;
    }
}

/* Counts the components of theta that are 0. */
static void find_gauge(const struct search *search, struct gm_finding *finding)
{
    struct gm_user_system *system = search->system;
    size_t zeros = 0;
    finding->asked = true;
    for (size_t i = 0; i < system->n; i++) {
        const enum gm_identity found = gm_equations_vanishes(system, system->theta[i]);
        zeros += found == GM_ZERO_PROVED || found == GM_ZERO_TESTED;
        finding->how = found == GM_ZERO_TESTED ? found : finding->how;
    }
    if (2 * zeros < system->n) {
        deny(finding, GM_NO_NODE, NULL);
    }
}

static bool is_node(struct gm_formula *graph, gm_node_id part, const void *node)
{
    (void)graph;
    return part == *(const gm_node_id *)node;
}

/* Denies a finding that a node breaks, with the first of the roots that depends on it. */
static void deny_by(struct gm_user_system *system, struct gm_finding *finding, gm_node_id node,
                    const gm_node_id *roots)
{
    size_t i = 0;
    finding->asked = true;
    while (i < system->n && node != GM_NO_NODE &&
           (roots[i] == GM_NO_NODE ||
            gm_formula_first(&system->graph, roots[i], is_node, &node) == GM_NO_NODE)) {
        i++;
    }
    if (node != GM_NO_NODE) {
        *finding = (struct gm_finding){true, false, GM_NOT_ZERO, node, i, NULL, NULL};
    }
}

/* All that the equations, or the rates alone, depend on, ascending. */
static const gm_node_id *parts_of_equations(struct gm_arena *arena, const struct gm_user_system *system,
                                            bool of_rates, size_t *part_count)
{
    size_t count = 0;
    gm_node_id *roots = gm_arena_take(arena, system->n + 1, sizeof *roots);
    for (size_t i = 0; i < system->n; i++) {
        roots[count] = system->rates[i];
        count += roots[count] != GM_NO_NODE;
    }
    if (system->kind != GM_RATES && !of_rates) {
        roots[count++] = system->energy;
    }
    return gm_arena_keep(arena, gm_formula_parts_of(&system->graph, roots, count, part_count), free);
}

/* True for an operation whose jump or corner no break stands for, so that schemes step across it: of atan2, or of a
   square's root. */
static bool is_stepped_across(const struct search *search, gm_node_id part)
{
    const struct gm_formula *graph = &search->system->graph;
    const struct gm_node node = graph->nodes[part];
    if (node.operation == GM_OPERATION_ATAN2) {
        return depends(search->system, node.a, search->all) && depends(search->system, node.b, search->all);
    }
    if (node.operation != GM_OPERATION_SQRT || !depends(search->system, node.a, search->all)) {
        return false;
    }
    const struct gm_node under = graph->nodes[node.a];
    return (under.operation == GM_OPERATION_WHOLE_POWER && graph->nodes[under.b].value == 2) ||
           (under.operation == GM_OPERATION_MULTIPLY && under.a == under.b);
}

/* Finds the first switch of all equations, and the time; written nodes precede derived ones. */
static void find_of_parts(const struct search *search)
{
    struct gm_user_system *system = search->system;
    size_t count = 0;
    gm_node_id rough = GM_NO_NODE, time = GM_NO_NODE, across = GM_NO_NODE;
    const gm_node_id *parts = parts_of_equations(system->arena, system, true, &count);
    for (size_t k = count; k-- > 0;) {
        across = is_stepped_across(search, parts[k]) ? parts[k] : across;
    }
    parts = parts_of_equations(system->arena, system, false, &count);
    const bool *switches = gm_breaks_switches(system->arena, system);
    for (size_t k = count; k-- > 0;) {
        const struct gm_node *node = &system->graph.nodes[parts[k]];
        rough = switches[parts[k]] ? parts[k] : rough;
        time = node->operation == GM_VARIABLE && node->a == system->n ? parts[k] : time;
    }
    search->findings[GM_FACT_SMOOTH].term = across;
    deny_by(system, &search->findings[GM_FACT_SMOOTH], rough, system->rates);
    deny_by(system, &search->findings[GM_FACT_AUTONOMOUS], time, system->rates);
}

static void find_all(struct gm_arena *arena, void *data)
{
    struct search *search = data;
    struct gm_user_system *system = search->system;
    struct gm_finding *findings = search->findings;
    const size_t half = system->n / 2, count = system->variable_count, mark = gm_arena_mark(arena);
    const enum gm_system_kind kind = system->kind;
    search->q = gm_arena_take(arena, 5 * count, sizeof *search->q);
    search->p = search->q + count;
    search->all = search->p + count;
    search->own = search->all + count;
    search->time = search->own + count;
    search->time[system->n] = system->timed;
    memset(search->q, true, half);
    memset(search->all, true, system->n);
    if (kind <= GM_LAGRANGIAN || kind == GM_RATES) {
        memset(search->p + first_moving(system), true, half);
    }
    if (kind == GM_LAGRANGIAN) {
        memset(search->all + system->velocities, true, half);
    }
    find_of_parts(search);
    if (system->theta) {
        find_gauge(search, &findings[GM_FACT_HALF_GAUGE]);
        findings[GM_FACT_DEGENERATE].asked = true;
    }
    if (kind <= GM_LAGRANGIAN) {
        find_split(search);
        find_conformal(search, &findings[GM_FACT_CONFORMAL], search->nodes);
        find_mechanical(search, search->nodes + 1);
    }
    if (kind == GM_CANONICAL && is_alone(system) && !system->timed && half >= 4 &&
        (half % 2 == 0 || half % 3 == 0) && findings[GM_FACT_NYSTROM].holds) {
        find_gravity(search, &findings[GM_FACT_GRAVITY], search->nodes + system->n + 17);
    }
    if (kind == GM_RATES) {
        find_second_order(search, &findings[GM_FACT_SECOND_ORDER]);
    }
    const bool split = findings[GM_FACT_SEPARABLE].asked ? findings[GM_FACT_SEPARABLE].holds
                                                         : findings[GM_FACT_SECOND_ORDER].holds;
    if ((kind == GM_RATES || (kind == GM_CANONICAL && is_alone(system))) && !split &&
        (system->n == 4 || system->n == 6)) {
        findings[GM_FACT_MAGNETIC].asked = true;
        find_magnetic(search, &findings[GM_FACT_MAGNETIC], search->nodes + 1);
    }
    /* else the rates are only a part of the motion */
    if (kind != GM_LAGRANGIAN && !gm_system_item_of(system, GM_WORD_CONSTRAINT, 0)) {
        find_of_rates(search);
    }
    gm_system_need_graph(system);
    gm_arena_release(arena, mark);
}

bool gm_facts_find(struct gm_user_system *system, struct gm_finding findings[GM_FACTS])
{
    if (!system->facets) {
        system->facets = gm_arena_take(system->arena, 2 * system->n + 19, sizeof *system->facets);
    }
    struct search search = {.system = system, .findings = findings, .nodes = system->facets};
    for (size_t i = 0; i < GM_FACTS; i++) {
        findings[i] = (struct gm_finding){
            .holds = true, .how = GM_ZERO_PROVED, .term = GM_NO_NODE, .component = system->n};
    }
    /* the rates of forms are not formulas of numbers */
    return system->facets && (gm_system_is_form(system) || gm_arena_run(system->arena, find_all, &search));
}

/* Writes the place of a term, or of the origin of a derived equation; "" if unknown. */
static void write_place(const struct gm_user_system *system, gm_node_id term, bool derived, char *text,
                        size_t size)
{
    derived = derived && system->graph.origins[term] != GM_NO_PLACE;
    const uint32_t place = derived ? system->graph.origins[term] : gm_formula_origin(&system->graph, term);
    text[0] = '\0';
    if (place != GM_NO_PLACE && !system->typed) {
        size_t line, column;
        gm_text_place(system->source, place, &line, &column);
        derived |= system->graph.places[term] == GM_NO_PLACE;
        snprintf(text, size, " (%sline %zu, column %zu)", derived ? "from " : "", line, column);
    }
}

/* A reason that is written. */
struct reason {
    const struct gm_user_system *system;
    enum gm_fact fact;
    const struct gm_finding *finding;
    FILE *out;
};

/* Writes the other switches that the text has, with their places. */
static void write_switches(struct gm_arena *arena, const struct reason *reason)
{
    enum { MOST = 16 }; /* switches that are named */
    const struct gm_user_system *system = reason->system;
    const struct gm_naming naming = gm_system_naming(system);
    size_t count = 0, named = 0;
    const gm_node_id *parts = parts_of_equations(arena, system, false, &count);
    const bool *switches = gm_breaks_switches(arena, system);
    for (size_t k = 0; k < count && named < MOST; k++) {
        const gm_node_id node = parts[k];
        if (switches[node] && system->graph.places[node] != GM_NO_PLACE && node != reason->finding->term) {
            char place[80], *text = gm_formula_text(&system->graph, node, &naming);
            write_place(system, node, false, place, sizeof place);
            fprintf(reason->out, "; %s%s: %s", text ? text : "a long term", place,
                    gm_operation_jumps(system->graph.nodes[node].operation) ? "it jumps"
                                                                            : "its derivative jumps");
            free(text);
            named++;
        }
    }
}

/* Writes the term that is the reason, with its place. */
static void write_term(const struct gm_user_system *system, gm_node_id term, bool derived, FILE *out)
{
    struct gm_naming naming = gm_system_naming(system);
    naming.part = NULL; /* written out, without names, to show its contents */
    char place[80], *text = gm_formula_text(&system->graph, term, &naming);
    write_place(system, term, derived, place, sizeof place);
    fprintf(out, "%s%s", text ? text : "a long term", place);
    free(text);
}

static void write_reason(struct gm_arena *arena, void *data)
{
    const struct reason *reason = data;
    const struct gm_user_system *system = reason->system;
    const struct gm_finding *finding = reason->finding;
    FILE *out = reason->out;
    const bool in_rate = finding->component < system->n && reason->fact != GM_FACT_DIVERGENCE_FREE;
    if (finding->holds) {
        fprintf(out, "%s%s", rows[reason->fact].yes,
                finding->how == GM_ZERO_TESTED ? " (at random points)" : "");
        if (reason->fact == GM_FACT_SMOOTH && finding->term != GM_NO_NODE) {
            fputs(" but of ", out);
            write_term(system, finding->term, false, out);
            fputs(", across which schemes step", out);
        }
        return;
    }
    if (finding->term != GM_NO_NODE) {
        write_term(system, finding->term, in_rate && system->kind != GM_RATES, out);
        fputc(' ', out);
    }
    fprintf(out, "%s%s%s", finding->why ? finding->why : rows[reason->fact].no,
            in_rate ? ", in the rate of " : "", in_rate ? system->variables[finding->component].name : "");
    if (reason->fact == GM_FACT_SMOOTH) {
        fputs(gm_operation_jumps(system->graph.nodes[finding->term].operation) ? ": it jumps"
                                                                               : ": its derivative jumps",
              out);
        write_switches(arena, reason);
        if (system->kind <= GM_POISSON) {
            fputs(gm_system_locates_breaks(system) ? "; breaks are located, by schemes of one step"
                                                   : "; breaks are not located",
                  out);
        }
    }
}

char *gm_fact_reason(const struct gm_user_system *system, enum gm_fact fact, const struct gm_finding *finding)
{
    char *text = NULL;
    size_t size = 0;
    struct reason reason = {system, fact, finding, open_memstream(&text, &size)};
    const bool written = reason.out && gm_arena_run_once(write_reason, &reason);
    if (reason.out && fclose(reason.out) == 0 && written) {
        return text;
    }
    free(text);
    return NULL;
}
