/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elementary differentials F(u) and elementary Hamiltonians H(t) = D^m H(F(u_1), ..., F(u_m)) by derivatives
   along vectors, which are further variables of the formula: exact, and computed on a tape, all trees with
   equally many branches at once. Where f = w J grad H (vortices) this is done for w H. */
#include "core/ode/backward/modified_energy.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/arena.h"
#include "core/expression/derivative.h"
#include "core/kind.h"
#include "core/ode/ode.h"
#include "core/schemes.h"
#include "core/tape.h"
#include "core/theory/modified.h"
#include "core/theory/theory.h"

enum {
    MOST_BRANCHES = GM_MODIFIED_ORDER - 1,
    MOST_NODES = 500000, /* largest size of the graph: a longer formula is refused */
};

struct gm_modified_energy {
    struct gm_arena *arena; /* owns all of this */
    size_t n;               /* active components: q, then p */
    int power;
    double weight; /* w */
    struct gm_modified modified;
    int differentials;                             /* number of trees whose F is needed */
    struct gm_tape field[GM_MODIFIED_BRANCH];      /* D^m f (v_1, ..., v_m) of the state and these */
    struct gm_tape hamiltonian[GM_MODIFIED_ORDER]; /* D^m w H (v_1, ..., v_m) */
    size_t with[GM_MODIFIED_ORDER];                /* number of terms with m branches */
    double *vectors;                               /* F, differentials * n */
    double *inputs, *values;                       /* the tapes' inputs and outputs */
};

/* ---- derivatives of the formula ---- */

/* A Hamiltonian that is opened, in an arena's body. */
struct opening {
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    int power;
    struct gm_modified_energy *energy;
    struct gm_formula graph;
    int most; /* the most branches of a term */
};

/* nodes := their derivatives along a further vector, number m from 1 */
static void differentiate(struct opening *opening, gm_node_id *nodes, size_t count, size_t m)
{
    struct gm_formula *graph = &opening->graph;
    const size_t n = opening->energy->n;
    gm_node_id *direction = gm_arena_take(opening->energy->arena, n + 1, sizeof *direction);
    for (size_t i = 0; i < n; i++) {
        direction[i] = gm_formula_variable(graph, m * n + i);
    }
    for (size_t i = 0; i < count && !graph->failed; i++) {
        nodes[i] = gm_derivative_along(graph, nodes[i], direction, n);
    }
    gm_arena_need(opening->energy->arena, !graph->failed);
}

/* tapes[m] := D^m of the nodes, m = 0 .. last */
static void open_tapes(struct opening *opening, struct gm_tape *tapes, int last, gm_node_id *nodes,
                       size_t count)
{
    struct gm_formula *graph = &opening->graph;
    struct gm_arena *arena = opening->energy->arena;
    const size_t n = opening->energy->n;
    /* no variable is a constant */
    const double *none = gm_arena_take(arena, (size_t)GM_MODIFIED_ORDER * n, sizeof *none);
    for (int m = 0; m <= last; m++) {
        if (m > 0) {
            differentiate(opening, nodes, count, (size_t)m);
        }
        if (graph->count > MOST_NODES) {
            gm_arena_refuse(arena, "the derivatives of H up to order %d are too long to be worked out",
                            opening->most);
        }
        gm_tape_keep(arena, &tapes[m],
                     gm_tape_open(&tapes[m], graph, nodes, count, (size_t)(m + 1) * n, none));
    }
}

/* f = (dK/dp, -dK/dq) */
static gm_node_id *field_of(struct opening *opening, gm_node_id energy)
{
    struct gm_formula *graph = &opening->graph;
    struct gm_arena *arena = opening->energy->arena;
    const size_t n = opening->energy->n, half = n / 2;
    gm_node_id *gradient = gm_arena_take(arena, n + 1, sizeof *gradient),
               *field = gm_arena_take(arena, n + 1, sizeof *field);
    gm_arena_need(arena, gm_gradient(graph, energy, NULL, n, gradient));
    for (size_t i = 0; i < half; i++) {
        field[i] = gradient[half + i];
        field[half + i] = gm_formula_apply(graph, GM_OPERATION_NEGATE, gradient[i], gradient[i]);
    }
    gm_arena_need(arena, !graph->failed);
    return field;
}

static bool is_rough(struct gm_formula *graph, gm_node_id part, const void *data)
{
    const enum gm_operation operation = graph->nodes[part].operation;
    (void)data;
    return operation > GM_VARIABLE && !gm_operation_rows[operation].smooth;
}

/* ---- trees ---- */

/* The branches of a tree; their number. */
static int branches_of(const struct gm_trees *trees, int tree, int branches[MOST_BRANCHES])
{
    int count = 0;
    for (const struct gm_tree *at = &trees->trees[tree]; at->last >= 0; at = &trees->trees[at->without]) {
        branches[count++] = at->last;
    }
    return count;
}

/* ---- from a problem and a scheme ---- */

/* Finds the terms from the scheme's coefficients. */
static void open_terms(struct opening *opening)
{
    struct gm_modified_energy *energy = opening->energy;
    struct gm_arena *arena = energy->arena;
    const char *title = opening->scheme->title;
    /* another scheme may make the same steps on this problem by coefficients whose conditions are fulfilled */
    const struct gm_scheme *same = gm_scheme_same_as(opening->scheme, opening->problem);
    struct gm_coefficients coefficients;
    if (!gm_scheme_coefficients_open(arena, same ? same : opening->scheme, &coefficients)) {
        gm_arena_refuse(
            arena,
            "the modified equation of %.80s is unknown: it is not a Runge-Kutta method, a splitting into T and V, or a "
            "composition of these",
            title);
    }
    gm_coefficients_reduce(&coefficients);
    if (!gm_theory_is_symplectic(arena, &coefficients)) {
        gm_arena_refuse(
            arena, "%.80s is not symplectic: no Hamiltonian of the equation that it solves is known", title);
    }
    gm_arena_check(arena, coefficients.nystrom == 0, "the modified equation of a Nystrom method is unknown");
    energy->modified = gm_modified_of(arena, &coefficients, energy->power + 1);
    int branches[MOST_BRANCHES];
    for (size_t i = 0; i < energy->modified.count; i++) {
        energy->with[branches_of(&energy->modified.trees, energy->modified.terms[i].tree, branches)]++;
    }
    const int order = (energy->power + 1) / 2;
    energy->differentials = order > 0 ? energy->modified.trees.first[order + 1] : 0;
}

static void open_formula(struct opening *opening)
{
    struct gm_modified_energy *energy = opening->energy;
    struct gm_formula *graph = &opening->graph;
    const struct gm_hamiltonian *hamiltonian = gm_ode_of(opening->problem)->hamiltonian;
    gm_node_id node = GM_NO_NODE;
    gm_arena_need(energy->arena, hamiltonian->formula(opening->problem, graph, &node));
    gm_arena_check(energy->arena, gm_formula_first(graph, node, is_rough, NULL) == GM_NO_NODE,
                   "H is not smooth: it has no further derivatives");
    energy->weight = gm_weight_of(opening->problem);
    node = gm_product(graph, gm_formula_constant(graph, energy->weight), node);
    gm_arena_need(energy->arena, !graph->failed);
    gm_node_id *field = field_of(opening, node);
    for (int m = 0; m < GM_MODIFIED_ORDER; m++) {
        opening->most = energy->with[m] > 0 ? m : opening->most;
    }
    open_tapes(opening, energy->hamiltonian, opening->most, &node, 1);
    if (energy->differentials > 0) {
        open_tapes(opening, energy->field, (energy->power + 1) / 2 - 1, field, energy->n);
    }
}

static void open_energy(struct gm_arena *arena, void *data)
{
    struct opening *opening = data;
    struct gm_modified_energy *energy = opening->energy = gm_arena_take(arena, 1, sizeof *energy);
    const struct gm_problem *problem = opening->problem;
    const struct gm_hamiltonian *hamiltonian =
        problem->kind == &gm_kind_ode ? gm_ode_of(problem)->hamiltonian : NULL;
    gm_arena_check(arena, hamiltonian, "there is no Hamiltonian in canonical variables that stands still");
    gm_arena_check(arena, hamiltonian->formula, "H is not written as a formula");
    energy->arena = arena;
    energy->n = problem->n - 2 * problem->passive;
    energy->power = opening->power;
    open_terms(opening);
    open_formula(opening);
    size_t widest = energy->n, longest = energy->n; /* F is found one by one */
    for (int m = 0; m < GM_MODIFIED_ORDER; m++) {
        longest = energy->with[m] > longest ? energy->with[m] : longest;
        const size_t width = (size_t)(m + 1) * energy->n * (energy->with[m] ? energy->with[m] : 1);
        widest = width > widest ? width : widest;
    }
    energy->vectors =
        gm_arena_take(arena, ((size_t)energy->differentials + 1) * energy->n, sizeof *energy->vectors);
    energy->inputs = gm_arena_take(arena, widest, sizeof *energy->inputs);
    energy->values = gm_arena_take(arena, longest, sizeof *energy->values);
}

struct gm_modified_energy *gm_modified_energy_open(const struct gm_problem *problem,
                                                   const struct gm_scheme *scheme, int power,
                                                   char why[GM_MODIFIED_WHY])
{
    struct gm_arena *arena = gm_arena_open();
    struct opening opening = {.problem = problem, .scheme = scheme, .power = power};
    gm_formula_open(&opening.graph);
    const bool opened = gm_arena_run(arena, open_energy, &opening);
    gm_formula_close(&opening.graph);
    snprintf(why, GM_MODIFIED_WHY, "%s", opened ? "" : gm_arena_reason(arena));
    if (!opened) {
        gm_arena_close(arena);
    }
    return opened ? opening.energy : NULL;
}

void gm_modified_energy_close(struct gm_modified_energy *energy)
{
    if (energy) {
        gm_arena_close(energy->arena);
    }
}

/* ---- in a state ---- */

/* The state and F of a tree's branches as member number `member` of `members` inputs; the number of
   branches. */
static int put_inputs(struct gm_modified_energy *energy, const double *y, int tree, size_t member,
                      size_t members)
{
    int branches[MOST_BRANCHES];
    const int count = branches_of(&energy->modified.trees, tree, branches);
    for (int m = 0; m <= count; m++) {
        const double *from = m == 0 ? y : energy->vectors + (size_t)branches[m - 1] * energy->n;
        for (size_t i = 0; i < energy->n; i++) {
            energy->inputs[((size_t)m * energy->n + i) * members + member] = from[i];
        }
    }
    return count;
}

void gm_modified_energy_terms(struct gm_modified_energy *energy, const double *y, double *terms)
{
    const struct gm_modified *modified = &energy->modified;
    const struct gm_trees *trees = &modified->trees;
    const size_t half = energy->n / 2;
    for (int tree = 0; tree < energy->differentials; tree++) {
        double *vector = energy->vectors + (size_t)tree * energy->n;
        gm_tape_values(&energy->field[put_inputs(energy, y, tree, 0, 1)], energy->inputs, vector, 1);
        if (trees->equations != GM_EQUATIONS_PLAIN) {
            const size_t other = trees->trees[tree].side == GM_SIDE_Q ? half : 0;
            memset(vector + other, 0, half * sizeof *vector);
        }
    }
    gm_tape_values(&energy->hamiltonian[0], y, &terms[0], 1);
    for (int k = 1; k <= energy->power; k++) {
        terms[k] = 0;
    }
    for (int m = 1; m < GM_MODIFIED_ORDER; m++) {
        int branches[MOST_BRANCHES];
        for (size_t pass = 0, member = 0; pass < 2 && energy->with[m] > 0; pass++, member = 0) {
            for (size_t i = 0; i < modified->count; i++) {
                const int tree = modified->terms[i].tree;
                if (branches_of(trees, tree, branches) != m) {
                    continue;
                }
                if (pass == 0) {
                    put_inputs(energy, y, tree, member, energy->with[m]);
                } else {
                    terms[trees->trees[tree].order - 1] += modified->terms[i].weight * energy->values[member];
                }
                member++;
            }
            if (pass == 0) {
                gm_tape_values(&energy->hamiltonian[m], energy->inputs, energy->values, energy->with[m]);
            }
        }
    }
    for (int k = 0; k <= energy->power; k++) {
        terms[k] /= energy->weight;
    }
}
