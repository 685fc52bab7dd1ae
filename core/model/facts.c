/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Structure follows from derivatives that vanish: H separates if d2H / dp dq does. The reason against it
   is the first term of the sum whose own derivative does not vanish. Parts of a facet are terms of the
   sum, too. */
#include "core/model/facts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/derivative.h"
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
    [GM_FACT_LAGRANGIAN] = {"lagrangian", "L = v^2/2 - V(q), one degree of freedom", ""},
    [GM_FACT_CONFORMAL] = {"conformal", "every force is the same multiple of the momentum",
                           "is not the multiple of the momentum that others are"},
};

const char *gm_fact_word(enum gm_fact fact)
{
    return rows[fact].word;
}

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
    gm_node_id *gradient = gm_equations_gradient(system, node, sets[0]);
    for (size_t i = 0; i < system->variable_count && all != GM_NOT_ZERO && !system->graph.failed; i++) {
        const bool is_zero = !sets[0][i] || gm_is_constant(&system->graph, gradient[i], 0);
        const enum gm_identity found =
            is_zero ? GM_ZERO_PROVED : vanishes(system, gradient[i], sets + 1, depth - 1);
        all = found == GM_ZERO_PROVED ? all : found;
    }
    free(gradient);
    all = system->graph.failed ? GM_UNTESTED : all;
    const struct sets of = {system, sets, depth};
    const bool kinked =
        all != GM_NOT_ZERO && gm_formula_first(&system->graph, node, is_kink, &of) != GM_NO_NODE;
    return kinked ? GM_NOT_ZERO : all;
}

/* A term of a sum: coefficient * node; the coefficient is free of components. */
struct term {
    gm_node_id node, coefficient;
};

/* The terms of a node as a sum, at most MOST_TERMS; none when out of memory. */
static struct term *terms_of(struct gm_user_system *system, gm_node_id root, const bool *components,
                             size_t *count)
{
    struct gm_formula *graph = &system->graph;
    bool *dependent = gm_formula_dependent(graph, components, system->variable_count);
    struct term *terms = gm_arena_take(system->arena, 2 * (MOST_TERMS + 1), sizeof *terms),
                *stack = terms ? terms + MOST_TERMS + 1 : NULL;
    size_t depth = 0;
    *count = 0;
    if (dependent && terms) {
        stack[depth++] = (struct term){root, gm_formula_constant(graph, 1)};
    }
    while (depth > 0 && !graph->failed) {
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
    graph->failed |= !dependent || !terms;
    free(dependent);
    *count = graph->failed ? 0 : *count;
    return terms;
}

/* The first term whose derivatives do not vanish; the node itself if no single term is the reason. */
static gm_node_id culprit(struct gm_user_system *system, gm_node_id node, const bool *components,
                          const bool *const *sets, size_t depth)
{
    size_t count = 0;
    struct term *terms = terms_of(system, node, components, &count);
    const size_t most = system->graph.count + MOST_GROWN;
    gm_node_id found = GM_NO_NODE;
    for (size_t i = 0; i < count && i < MOST_TRIED && found == GM_NO_NODE && system->graph.count < most;
         i++) {
        found = vanishes(system, terms[i].node, sets, depth) == GM_NOT_ZERO ? terms[i].node : GM_NO_NODE;
    }
    return found == GM_NO_NODE ? node : found;
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

/* Tests the energy, or L with velocities for momenta: if L = T(v) - V(q), H separates as well, and the
   transform of a quadratic T is quadratic. */
static void find_split(struct gm_user_system *system, struct gm_finding *findings, const bool *q,
                       const bool *p, const bool *all)
{
    struct gm_finding *separable = &findings[GM_FACT_SEPARABLE], *nystrom = &findings[GM_FACT_NYSTROM];
    const bool lagrangian = system->kind == GM_LAGRANGIAN;
    separable->asked = nystrom->asked = true;
    conclude(separable, vanishes(system, system->energy, (const bool *const[]){p, q}, 2));
    if (!separable->holds) {
        separable->term = culprit(system, system->energy, all, (const bool *const[]){p, q}, 2);
        separable->why = lagrangian ? "holds coordinates and velocities" : NULL;
        deny(nystrom, GM_NO_NODE, lagrangian ? "L does not separate" : "H does not separate");
        return;
    }
    conclude(nystrom, vanishes(system, system->energy, (const bool *const[]){p, p, p}, 3));
    if (!nystrom->holds) {
        nystrom->term = culprit(system, system->energy, all, (const bool *const[]){p, p, p}, 3);
        nystrom->why = lagrangian ? "is not quadratic in the velocities" : NULL;
    }
}

/* Derivative over variable i; any node when out of memory. `own` marks no variable. */
static gm_node_id slope_of(struct gm_user_system *system, gm_node_id node, bool *own, size_t i)
{
    own[i] = true;
    gm_node_id *gradient = gm_equations_gradient(system, node, own);
    own[i] = false;
    const gm_node_id slope = gradient ? gradient[i] : 0;
    free(gradient);
    return slope;
}

/* True if a node depends on variable i. `own` marks no variable. */
static bool depends_on(struct gm_user_system *system, gm_node_id node, bool *own, size_t i)
{
    own[i] = true;
    const bool depending = depends(system, node, own);
    own[i] = false;
    return depending;
}

/* True if the system has unit masses, H = |p|^2/2 + V(q), or L = |v|^2/2 - V(q), and no forces. Else the
   finding has the reason. */
static bool is_of_unit_mass(struct gm_user_system *system, const struct gm_finding *findings,
                            struct gm_finding *finding, const bool *all, bool *own)
{
    const size_t half = system->n / 2;
    const bool lagrangian = system->kind == GM_LAGRANGIAN;
    const size_t first = lagrangian ? system->velocities : half;
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
    if (!findings[GM_FACT_SEPARABLE].holds || system->timed) {
        deny(finding, GM_NO_NODE, system->timed ? "the time occurs" : findings[GM_FACT_NYSTROM].why);
        return false;
    }
    for (size_t i = 0; i < half && finding->holds && !system->graph.failed; i++) {
        const gm_node_id p = gm_formula_variable(&system->graph, first + i);
        const gm_node_id slope = lagrangian ? system->momenta[i] : system->rates[i];
        conclude(finding, gm_equations_vanishes(system, gm_difference(&system->graph, slope, p)));
        size_t count = 0;
        struct term *terms = finding->holds ? NULL : terms_of(system, system->energy, all, &count);
        finding->why = lagrangian ? "is not of |v|^2/2" : "is not of |p|^2/2";
        for (size_t k = 0; k < count && k < MOST_TRIED && finding->term == GM_NO_NODE; k++) {
            if (depends_on(system, terms[k].node, own, first + i)) {
                const gm_node_id part = gm_product(&system->graph, terms[k].coefficient,
                                                   slope_of(system, terms[k].node, own, first + i));
                const gm_node_id rest = gm_difference(&system->graph, part, p);
                finding->term =
                    gm_equations_vanishes(system, rest) == GM_NOT_ZERO ? terms[k].node : GM_NO_NODE;
            }
        }
    }
    if (!finding->holds && finding->term == GM_NO_NODE) {
        finding->why = lagrangian ? "the kinetic energy is not |v|^2/2" : "the kinetic energy is not |p|^2/2";
    }
    return finding->holds && !system->graph.failed;
}

/* a node with `count` variables from `first` on set to 0 */
static gm_node_id at_zero(struct gm_user_system *system, gm_node_id node, size_t first, size_t count)
{
    gm_node_id *replacement = gm_system_no_nodes(system, system->variable_count);
    const gm_node_id zero = gm_formula_constant(&system->graph, 0);
    for (size_t i = first; replacement && i < first + count; i++) {
        replacement[i] = zero;
    }
    system->graph.failed |=
        !replacement || !gm_formula_substitute(&system->graph, &node, 1, replacement, system->variable_count);
    return node;
}

/* V of a system that is_of_unit_mass: H, or -L, at rest */
static gm_node_id potential_of(struct gm_user_system *system)
{
    return system->kind == GM_LAGRANGIAN
               ? gm_negative(&system->graph,
                             at_zero(system, system->energy, system->velocities, system->n / 2))
               : at_zero(system, system->energy, system->n / 2, system->n / 2);
}

/* values of all nodes at the start */
static double *values_at_start(struct gm_user_system *system)
{
    double *start = gm_equations_start(system, NULL),
           *values = start ? gm_arena_keep(system->arena, gm_equations_values(system, start), free) : NULL;
    system->graph.failed |= !values;
    free(start);
    return values;
}

/* forces[i] = -d node / d q_i */
static void forces_of(struct gm_user_system *system, gm_node_id node, const bool *q, gm_node_id *forces)
{
    gm_node_id *gradient = gm_equations_gradient(system, node, q);
    for (size_t i = 0; gradient && i < system->n / 2; i++) {
        forces[i] = gm_negative(&system->graph, gradient[i]);
    }
    free(gradient);
}

/* A term of the potential that depends on one coordinate alone, and its second derivative. */
struct well {
    size_t coordinate; /* SIZE_MAX: the term depends on no coordinate, or on several */
    gm_node_id slope, stiffness;
};

/* The wells of all terms. A stiffness that depends on the state makes none. */
static struct well *wells_of(struct gm_user_system *system, const struct term *terms, size_t count,
                             const bool *q, const bool *all, bool *own)
{
    struct well *wells = gm_arena_take(system->arena, count + 1, sizeof *wells);
    const size_t most = system->graph.count + MOST_GROWN;
    system->graph.failed |= !wells;
    for (size_t k = 0; k < count && !system->graph.failed; k++) {
        struct well *well = &wells[k];
        size_t size = 0, held = 0;
        gm_node_id *parts = gm_formula_parts(&system->graph, terms[k].node, &size);
        *well = (struct well){.coordinate = SIZE_MAX};
        for (size_t i = 0; i < size; i++) {
            const struct gm_node *part = &system->graph.nodes[parts[i]];
            if (part->operation == GM_VARIABLE && q[part->a]) {
                well->coordinate = held++ == 0 ? part->a : SIZE_MAX;
            }
        }
        system->graph.failed |= !parts;
        free(parts);
        if (well->coordinate == SIZE_MAX || system->graph.count > most) {
            well->coordinate = SIZE_MAX;
            continue;
        }
        const size_t i = well->coordinate;
        well->slope =
            gm_product(&system->graph, terms[k].coefficient, slope_of(system, terms[k].node, own, i));
        well->stiffness = slope_of(system, well->slope, own, i);
        well->coordinate = depends(system, well->stiffness, all) ? SIZE_MAX : i;
    }
    return wells;
}

/* The quadratic terms of each coordinate give its frequency; the rest of them, and all others, are U. */
static void find_fast_linear(struct gm_user_system *system, struct gm_finding *finding, gm_node_id potential,
                             gm_node_id *nodes, const bool *q, const bool *all, bool *own)
{
    const size_t half = system->n / 2;
    size_t count = 0, frequencies = 0;
    struct gm_formula *graph = &system->graph;
    const gm_node_id zero = gm_formula_constant(graph, 0);
    struct term *terms = terms_of(system, potential, all, &count);
    struct well *wells = wells_of(system, terms, count, q, all, own);
    double *values = graph->failed ? NULL : values_at_start(system);
    gm_node_id slow = zero, *squares = gm_arena_take(system->arena, 2 * half + 1, sizeof *squares),
               *rest = squares ? squares + half : NULL;
    graph->failed |= !squares;
    for (size_t i = 0; i < half && !graph->failed; i++) {
        squares[i] = rest[i] = zero;
    }
    for (size_t k = 0; k < count && !graph->failed; k++) {
        const size_t i = wells[k].coordinate;
        if (i == SIZE_MAX || !(values[wells[k].stiffness] > 0)) {
            slow =
                gm_sum(&system->graph, slow, gm_product(&system->graph, terms[k].coefficient, terms[k].node));
            continue;
        }
        squares[i] = gm_sum(&system->graph, squares[i], wells[k].stiffness);
        rest[i] = gm_sum(&system->graph, rest[i], at_zero(system, wells[k].slope, i, 1));
        frequencies++;
    }
    if (frequencies == 0 && !graph->failed) {
        deny(finding, GM_NO_NODE, "no coordinate has a frequency of its own");
        for (size_t k = 0; k < count && finding->term == GM_NO_NODE; k++) {
            finding->term = depends(system, terms[k].node, q) ? terms[k].node : GM_NO_NODE;
            finding->why = finding->term == GM_NO_NODE ? finding->why : NULL;
        }
    } else if (!graph->failed) {
        forces_of(system, slow, q, nodes + half);
        for (size_t i = 0; i < half; i++) {
            nodes[i] =
                squares[i] == zero ? zero : gm_simplified(&system->graph, GM_OPERATION_SQRT, squares[i], 0);
            nodes[half + i] = gm_difference(&system->graph, nodes[half + i], rest[i]);
        }
        finding->nodes = nodes;
    }
}

/* Finds the term -1/|q|; the others are the perturbation. */
static void find_kepler_split(struct gm_user_system *system, struct gm_finding *finding, gm_node_id potential,
                              gm_node_id *nodes, const bool *q, const bool *all)
{
    size_t count = 0;
    struct term *terms = terms_of(system, potential, all, &count);
    const gm_node_id x = gm_formula_variable(&system->graph, 0), y = gm_formula_variable(&system->graph, 1);
    const gm_node_id square =
        gm_sum(&system->graph, gm_product(&system->graph, x, x), gm_product(&system->graph, y, y));
    const gm_node_id inverse =
        gm_simplified(&system->graph, GM_OPERATION_DIVIDE, gm_formula_constant(&system->graph, 1),
                      gm_simplified(&system->graph, GM_OPERATION_SQRT, square, 0));
    gm_node_id perturbation = gm_formula_constant(&system->graph, 0), other = GM_NO_NODE;
    bool found = false;
    for (size_t k = 0; k < count && !system->graph.failed; k++) {
        const gm_node_id term = gm_product(&system->graph, terms[k].coefficient, terms[k].node);
        const bool held = depends(system, terms[k].node, q);
        const enum gm_identity is_kepler =
            found || !held || k >= MOST_TRIED
                ? GM_NOT_ZERO
                : gm_equations_vanishes(system, gm_sum(&system->graph, term, inverse));
        if (is_kepler == GM_ZERO_PROVED || is_kepler == GM_ZERO_TESTED) {
            conclude(finding, is_kepler);
            found = true;
        } else {
            perturbation = gm_sum(&system->graph, perturbation, term);
            other = held && other == GM_NO_NODE ? terms[k].node : other;
        }
    }
    nodes[0] = potential;
    forces_of(system, perturbation, q, nodes + 1);
    double *values = system->graph.failed ? NULL : values_at_start(system);
    if (!found) {
        deny(finding, other, other == GM_NO_NODE ? "there is no -1/|q|" : NULL);
    } else if (values && !(values[potential] < 0)) {
        deny(finding, GM_NO_NODE, "the potential is not negative at the start");
    }
    finding->nodes = nodes;
}

/* V, V', V'' */
static void find_one_degree(struct gm_user_system *system, struct gm_finding *finding, gm_node_id potential,
                            gm_node_id *nodes, bool *own)
{
    nodes[0] = potential;
    nodes[1] = slope_of(system, nodes[0], own, 0);
    nodes[2] = slope_of(system, nodes[1], own, 0);
    finding->nodes = nodes;
}

/* Finds c with -c p for every force, from the first one, by the derivatives of force and momentum. */
static void find_conformal(struct gm_user_system *system, struct gm_finding *finding, gm_node_id *nodes,
                           const bool *all, bool *own)
{
    static const char changes[] = "is not a constant multiple of the momentum";
    const size_t half = system->n / 2;
    const bool lagrangian = system->kind == GM_LAGRANGIAN;
    const size_t first = lagrangian ? system->velocities : half;
    for (size_t i = 0; i < half; i++) {
        finding->asked |= system->variables[i].force != GM_NO_NODE;
    }
    for (size_t i = 0; i < half && finding->asked && finding->holds && !system->graph.failed; i++) {
        const gm_node_id written = system->variables[i].force;
        const gm_node_id p = lagrangian ? system->momenta[i] : gm_formula_variable(&system->graph, first + i);
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
            nodes[0] = gm_negative(&system->graph, gm_simplified(&system->graph, GM_OPERATION_DIVIDE,
                                                                 slope_of(system, force, own, first),
                                                                 slope_of(system, p, own, first)));
        }
        const gm_node_id rest = gm_sum(&system->graph, force, gm_product(&system->graph, nodes[0], p));
        conclude(finding, gm_equations_vanishes(system, rest));
        const bool varies = depends(system, nodes[0], all) || depends_on(system, nodes[0], own, system->n);
        if (!finding->holds || varies) {
            deny(finding, written, i == 0 ? changes : NULL);
        }
    }
    finding->nodes = finding->holds ? nodes : NULL;
}

/* Finds the facets of H = |p|^2/2 + V(q), and of its Lagrangian. */
static void find_mechanical(struct gm_user_system *system, struct gm_finding *findings, gm_node_id *nodes,
                            const bool *q, const bool *all, bool *own)
{
    struct gm_finding common = findings[GM_FACT_SEPARABLE];
    const size_t n = system->n;
    const bool canonical =
        system->kind == GM_CANONICAL && system->tangents == 0; /* else more moves than H says */
    const bool holds = is_of_unit_mass(system, findings, &common, all, own);
    const gm_node_id potential = holds ? potential_of(system) : GM_NO_NODE;
    static const enum gm_fact facts[] = {GM_FACT_FAST_LINEAR, GM_FACT_KEPLER_SPLIT, GM_FACT_LAGRANGIAN};
    for (size_t i = 0; i < sizeof facts / sizeof *facts; i++) {
        findings[facts[i]] = common;
    }
    findings[GM_FACT_FAST_LINEAR].asked = canonical;
    findings[GM_FACT_KEPLER_SPLIT].asked = canonical && n == 4;
    findings[GM_FACT_LAGRANGIAN].asked = n == 2;
    if (holds && canonical) {
        find_fast_linear(system, &findings[GM_FACT_FAST_LINEAR], potential, nodes, q, all, own);
    }
    if (holds && canonical && n == 4) {
        find_kepler_split(system, &findings[GM_FACT_KEPLER_SPLIT], potential, nodes + n, q, all);
    }
    if (holds && n == 2) {
        find_one_degree(system, &findings[GM_FACT_LAGRANGIAN], potential, nodes + n + 3, own);
    }
    double *values = holds && !system->graph.failed ? values_at_start(system) : NULL;
    for (size_t i = 0; i < sizeof facts / sizeof *facts && values && !system->graph.failed; i++) {
        struct gm_finding *finding = &findings[facts[i]];
        const size_t count = facts[i] == GM_FACT_FAST_LINEAR ? n : 3;
        for (size_t k = 0; k < count && finding->asked && finding->holds; k++) {
            if (!isfinite(values[finding->nodes[k]])) { /* p^3/p at rest */
                deny(finding, GM_NO_NODE, "it cannot be taken apart as it is written");
            }
        }
    }
}

static void find_of_rates(struct gm_user_system *system, struct gm_finding *findings, const bool *components,
                          bool *own)
{
    struct gm_finding *volume = &findings[GM_FACT_VOLUME], *divergence = &findings[GM_FACT_DIVERGENCE_FREE];
    const bool *const thrice[] = {components, components, components}, *const once[] = {own};
    gm_node_id sum = gm_formula_constant(&system->graph, 0);
    findings[GM_FACT_LINEAR].asked = findings[GM_FACT_QUADRATIC].asked = true;
    volume->asked = divergence->asked = true;
    for (size_t i = 0; i < system->n && !system->graph.failed; i++) {
        const gm_node_id rate = system->rates[i];
        for (size_t degree = 1; degree <= 2; degree++) {
            struct gm_finding *polynomial = &findings[degree == 1 ? GM_FACT_LINEAR : GM_FACT_QUADRATIC];
            if (polynomial->holds) {
                conclude(polynomial, vanishes(system, rate, thrice, degree + 1));
                polynomial->component = i;
                polynomial->term =
                    polynomial->holds ? GM_NO_NODE : culprit(system, rate, components, thrice, degree + 1);
            }
        }
        if (!depends_on(system, rate, own, i)) { /* excludes most rates before a longer test */
            continue;
        }
        own[i] = true;
        if (volume->holds) {
            conclude(volume, vanishes(system, rate, once, 1));
            volume->component = i;
            volume->term = volume->holds ? GM_NO_NODE : culprit(system, rate, components, once, 1);
        }
        own[i] = false;
        sum = gm_sum(&system->graph, sum, slope_of(system, rate, own, i));
    }
    conclude(divergence, gm_equations_vanishes(system, sum));
    divergence->term = divergence->holds ? GM_NO_NODE : sum;
}

/* Finds x' = v, v' = g(x, t) for the first and the second half of the components. */
static void find_second_order(struct gm_user_system *system, struct gm_finding *finding, const bool *all,
                              const bool *velocities)
{
    const size_t half = system->n / 2;
    const bool *const once[] = {velocities};
    finding->asked = true;
    if (system->n % 2 != 0) {
        deny(finding, GM_NO_NODE, "the number of components is odd");
        return;
    }
    for (size_t i = 0; i < system->n && finding->holds && !system->graph.failed; i++) {
        const gm_node_id rate = system->rates[i];
        finding->component = i;
        if (i >= half) {
            conclude(finding, vanishes(system, rate, once, 1));
            finding->term = finding->holds ? GM_NO_NODE : culprit(system, rate, all, once, 1);
        } else if (rate != gm_formula_variable(&system->graph, half + i)) {
            deny(finding, rate, "is not a velocity");
        }
    }
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

/* Concludes that a node vanishes; else the rate of a component is the reason. */
static void need_zero(struct gm_user_system *system, struct gm_finding *finding, gm_node_id node,
                      size_t component)
{
    if (finding->holds && !system->graph.failed) {
        conclude(finding, gm_equations_vanishes(system, node));
        finding->component = component;
        finding->term = finding->holds ? GM_NO_NODE : system->rates[component];
    }
}

/* Writes the nodes of the facet: the velocity u of p = 0, or 0; g; W by rows, which are the slopes of v' over v, or
   those of u over x without their symmetric part; c, the slope of v over p, or 1. */
static void write_magnetic(struct gm_user_system *system, gm_node_id *nodes, bool *own)
{
    struct gm_formula *graph = &system->graph;
    const size_t n = system->n, half = n / 2;
    const gm_node_id zero = gm_formula_constant(graph, 0);
    gm_node_id *u = nodes, *g = u + half, *w = g + half, *c = w + half * half;
    gm_node_id *replacement = gm_system_no_nodes(system, system->variable_count);
    system->graph.failed |= !replacement;
    if (system->kind == GM_RATES) {
        for (size_t i = 0; i < half; i++) {
            u[i] = zero;
            g[i] = at_zero(system, system->rates[half + i], half, half);
        }
        *c = gm_formula_constant(graph, 1);
        return;
    }
    *c = w[0];
    for (size_t i = 0; i < half && replacement; i++) {
        u[i] = at_zero(system, system->rates[i], half, half);
        replacement[half + i] = gm_negative(graph, gm_simplified(graph, GM_OPERATION_DIVIDE, u[i], *c));
    }
    for (size_t i = 0; i < half && replacement; i++) {
        g[i] = system->rates[half + i];
        system->graph.failed |= !gm_formula_substitute(graph, &g[i], 1, replacement, system->variable_count);
        g[i] = gm_sum(graph, gm_product(graph, *c, g[i]), slope_of(system, u[i], own, n)); /* du/dt */
        for (size_t j = 0; j < half; j++) {
            w[i * half + j] =
                gm_difference(graph, slope_of(system, u[i], own, j), slope_of(system, u[j], own, i));
        }
    }
}

/* Finds v' = g + W v by the slopes of v' over v, which hold no v and are antisymmetric; or p = v/c + A by those of
   v = dH/dp over p, which are c times the unit matrix. */
static void find_magnetic(struct gm_user_system *system, struct gm_finding *finding, gm_node_id *nodes,
                          const bool *all, const bool *velocities, bool *own)
{
    const size_t half = system->n / 2;
    const bool canonical = system->kind == GM_CANONICAL;
    const size_t first = canonical ? 0 : half; /* of the rates that are looked at */
    gm_node_id *slopes = nodes + 2 * half;
    for (size_t i = 0; i < half && !canonical; i++) {
        const gm_node_id v = gm_formula_variable(&system->graph, half + i);
        need_zero(system, finding, gm_difference(&system->graph, system->rates[i], v), i);
    }
    for (size_t i = 0; i < half * half && finding->holds; i++) {
        const size_t row = i / half, column = i % half;
        slopes[i] = slope_of(system, system->rates[first + row], own, half + column);
        if (canonical) {
            need_zero(system, finding,
                      row == column ? gm_difference(&system->graph, slopes[i], slopes[0]) : slopes[i], row);
        } else if (column <= row) {
            need_zero(system, finding, gm_sum(&system->graph, slopes[i], slopes[column * half + row]),
                      first + row);
        }
        const bool *const fixed = canonical ? all : velocities;
        if (finding->holds && (depends(system, slopes[i], fixed) ||
                               (canonical && depends_on(system, slopes[i], own, system->n)))) {
            deny(finding, system->rates[first + row], NULL);
            finding->component = first + row;
        }
    }
    if (canonical && finding->holds && gm_equations_vanishes(system, slopes[0]) != GM_NOT_ZERO) {
        deny(finding, GM_NO_NODE, "H is not quadratic in the momenta");
        finding->component = system->n;
    }
    if (finding->holds && !system->graph.failed) {
        write_magnetic(system, nodes, own);
        finding->nodes = nodes;
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

/* All that the equations depend on, ascending; freed by the caller. */
static gm_node_id *parts_of_equations(const struct gm_user_system *system, size_t *part_count)
{
    size_t count = 0;
    gm_node_id *roots = malloc((system->n + 1) * sizeof *roots), *parts = NULL;
    for (size_t i = 0; roots && i < system->n; i++) {
        roots[count] = system->rates[i];
        count += roots[count] != GM_NO_NODE;
    }
    if (roots && system->kind != GM_RATES) {
        roots[count++] = system->energy;
    }
    *part_count = 0;
    if (roots) {
        parts = gm_formula_parts_of(&system->graph, roots, count, part_count);
    }
    free(roots);
    return parts;
}

/* A flag for each node that is not smooth in the state or the time; freed by the caller. */
static bool *find_switches(const struct gm_user_system *system)
{
    const struct gm_formula *graph = &system->graph;
    bool *varying = calloc(system->variable_count + 1, sizeof *varying);
    for (size_t i = 0; varying && i < system->initial; i++) {
        varying[i] = i < system->parameters || i >= system->velocities;
    }
    bool *found = varying ? gm_formula_dependent(graph, varying, system->variable_count) : NULL;
    for (gm_node_id i = 0; found && i < graph->count; i++) {
        const enum gm_operation operation = graph->nodes[i].operation;
        found[i] = found[i] && operation > GM_VARIABLE && !gm_operation_rows[operation].smooth;
    }
    free(varying);
    return found;
}

/* Finds the first switch of all equations, and the time; written nodes precede derived ones. */
static void find_of_parts(struct gm_user_system *system, struct gm_finding *findings)
{
    size_t count = 0;
    gm_node_id rough = GM_NO_NODE, time = GM_NO_NODE, *parts = parts_of_equations(system, &count);
    bool *switches = find_switches(system);
    for (size_t k = count; parts && switches && k-- > 0;) {
        const struct gm_node *node = &system->graph.nodes[parts[k]];
        rough = switches[parts[k]] ? parts[k] : rough;
        time = node->operation == GM_VARIABLE && node->a == system->n ? parts[k] : time;
    }
    deny_by(system, &findings[GM_FACT_SMOOTH], rough, system->rates);
    deny_by(system, &findings[GM_FACT_AUTONOMOUS], time, system->rates);
    system->graph.failed |= !parts || !switches;
    free(parts);
    free(switches);
}

bool gm_facts_find(struct gm_user_system *system, struct gm_finding findings[GM_FACTS])
{
    const size_t half = system->n / 2, count = system->variable_count;
    gm_node_id *nodes =
        system->facets ? system->facets : gm_arena_take(system->arena, system->n + 17, sizeof *nodes);
    for (size_t i = 0; i < GM_FACTS; i++) {
        findings[i] = (struct gm_finding){
            .holds = true, .how = GM_ZERO_PROVED, .term = GM_NO_NODE, .component = system->n};
    }
    system->facets = nodes;
    if (gm_system_is_form(system)) { /* its rates are forms, and no formulas of numbers */
        return true;
    }
    const size_t mark = gm_arena_mark(system->arena);
    bool *marks = gm_arena_take(system->arena, 5 * count, sizeof *marks);
    if (!marks || !nodes) {
        return false;
    }
    bool *q = marks, *p = q + count, *components = p + count, *all = components + count, *own = all + count;
    const size_t moving = system->kind == GM_LAGRANGIAN ? system->velocities : half;
    for (size_t i = 0; i < system->n; i++) {
        q[i] = i < half;
        components[i] = all[i] = true;
    }
    for (size_t i = 0; i < half && system->kind <= GM_LAGRANGIAN; i++) {
        p[moving + i] = all[moving + i] = true;
    }
    find_of_parts(system, findings);
    if (system->kind <= GM_LAGRANGIAN) {
        find_split(system, findings, q, p, all);
        find_conformal(system, &findings[GM_FACT_CONFORMAL], nodes, all, own);
        find_mechanical(system, findings, nodes + 1, q, all, own);
    }
    if (system->kind == GM_RATES) {
        for (size_t i = 0; i < half; i++) {
            p[half + i] = true;
        }
        find_second_order(system, &findings[GM_FACT_SECOND_ORDER], components, p);
    }
    const bool split = findings[GM_FACT_SEPARABLE].asked ? findings[GM_FACT_SEPARABLE].holds
                                                         : findings[GM_FACT_SECOND_ORDER].holds;
    if ((system->kind == GM_RATES || (system->kind == GM_CANONICAL && is_alone(system))) && !split &&
        (system->n == 4 || system->n == 6)) {
        findings[GM_FACT_MAGNETIC].asked = true;
        find_magnetic(system, &findings[GM_FACT_MAGNETIC], nodes + 1, components, p, own);
    }
    /* else the rates are only a part of the motion */
    if (system->kind != GM_LAGRANGIAN && !gm_system_item_of(system, GM_WORD_CONSTRAINT, 0)) {
        find_of_rates(system, findings, components, own);
    }
    gm_arena_release(system->arena, mark);
    return !system->graph.failed;
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

/* True if the value of a switch jumps, not only a derivative. */
static bool jumps(enum gm_operation operation)
{
    return operation != GM_OPERATION_ABS && operation != GM_OPERATION_MIN && operation != GM_OPERATION_MAX;
}

/* Adds the other switches that the text has, with their places. Returns false when out of memory. */
static bool add_switches(const struct gm_user_system *system, gm_node_id first, char **reason)
{
    enum { MOST = 16 }; /* switches that are named */
    const struct gm_naming naming = gm_system_naming(system);
    size_t count = 0, named = 0;
    gm_node_id *parts = parts_of_equations(system, &count);
    bool *switches = find_switches(system), good = parts && switches;
    for (size_t k = 0; good && k < count; k++) {
        const gm_node_id node = parts[k];
        if (!switches[node] || system->graph.places[node] == GM_NO_PLACE || node == first ||
            named++ >= MOST) {
            continue;
        }
        char place[80], *text = gm_formula_text(&system->graph, node, &naming), *before = *reason;
        write_place(system, node, false, place, sizeof place);
        good =
            asprintf(reason, "%s; %s%s: %s", before, text ? text : "a long term", place,
                     jumps(system->graph.nodes[node].operation) ? "it jumps" : "its derivative jumps") >= 0;
        *reason = good ? *reason : NULL;
        free(before);
        free(text);
    }
    free(parts);
    free(switches);
    return good;
}

char *gm_fact_reason(const struct gm_user_system *system, enum gm_fact fact, const struct gm_finding *finding)
{
    char *reason = NULL, *text = NULL;
    int made = -1;
    if (finding->holds) {
        made = asprintf(&reason, "%s%s", rows[fact].yes,
                        finding->how == GM_ZERO_TESTED ? " (at random points)" : "");
        return made < 0 ? NULL : reason;
    }
    const bool in_rate = finding->component < system->n && fact != GM_FACT_DIVERGENCE_FREE;
    const char *where = in_rate ? ", in the rate of " : "",
               *component = in_rate ? system->variables[finding->component].name : "",
               *why = finding->why ? finding->why : rows[fact].no;
    if (finding->term == GM_NO_NODE) {
        made = asprintf(&reason, "%s%s%s", why, where, component);
    } else {
        struct gm_naming naming = gm_system_naming(system);
        naming.part = NULL; /* written out, without names, to show its contents */
        text = gm_formula_text(&system->graph, finding->term, &naming);
        char place[80];
        write_place(system, finding->term, in_rate && system->kind != GM_RATES, place, sizeof place);
        const bool value = jumps(system->graph.nodes[finding->term].operation);
        made = asprintf(&reason, "%s%s %s%s%s%s", text ? text : "a long term", place, why, where, component,
                        fact != GM_FACT_SMOOTH ? ""
                        : value                ? ": it jumps"
                                               : ": its derivative jumps");
    }
    free(text);
    if (made >= 0 && fact == GM_FACT_SMOOTH && !add_switches(system, finding->term, &reason)) {
        free(reason);
        return NULL;
    }
    return made < 0 ? NULL : reason;
}
