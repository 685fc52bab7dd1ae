/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elementary differentials F(u) and elementary Hamiltonians H(t) = D^m H(F(u_1), ..., F(u_m)) by derivatives
   along vectors, which are further variables of the formula: exact, and computed on a tape, all trees with
   equally many branches at once. Where f = w J grad H (vortices) this is done for w H. */
#include "core/ode/backward/modified_energy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/expression/derivative.h"
#include "core/kind.h"
#include "core/ode/ode.h"
#include "core/tape.h"
#include "core/theory/modified.h"
#include "core/theory/theory.h"

enum {
    MOST_BRANCHES = GM_MODIFIED_ORDER - 1,
    MOST_NODES = 500000, /* largest size of the graph: a longer formula is refused */
};

struct gm_modified_energy {
    size_t n; /* active components: q, then p */
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

/* nodes := their derivatives along a further vector, number m from 1 */
static bool differentiate(struct gm_formula *graph, gm_node_id *nodes, size_t count, size_t n, size_t m)
{
    gm_node_id *direction = malloc((n + 1) * sizeof *direction);
    for (size_t i = 0; direction && i < n; i++) {
        direction[i] = gm_formula_variable(graph, m * n + i);
    }
    graph->failed |= !direction;
    for (size_t i = 0; i < count && !graph->failed; i++) {
        nodes[i] = gm_derivative_along(graph, nodes[i], direction, n);
    }
    free(direction);
    return !graph->failed;
}

/* tapes[m] := D^m of the nodes, m = first .. last */
static bool open_tapes(struct gm_tape *tapes, int last, struct gm_formula *graph, gm_node_id *nodes,
                       size_t count, size_t n, bool *too_long)
{
    double *none = calloc((size_t)GM_MODIFIED_ORDER * n, sizeof *none); /* no variable is a constant */
    bool good = none != NULL;
    for (int m = 0; good && m <= last; m++) {
        good = m == 0 || differentiate(graph, nodes, count, n, (size_t)m);
        *too_long = good && graph->count > MOST_NODES;
        good = good && !*too_long && gm_tape_open(&tapes[m], graph, nodes, count, (size_t)(m + 1) * n, none);
    }
    free(none);
    return good;
}

/* f = (dK/dp, -dK/dq) */
static bool field_of(struct gm_formula *graph, gm_node_id energy, size_t n, gm_node_id *field)
{
    const size_t half = n / 2;
    gm_node_id *gradient = malloc((n + 1) * sizeof *gradient);
    bool *marked = malloc(n + 1);
    bool good = gradient && marked;
    if (good) {
        memset(marked, true, n);
        good = gm_gradient(graph, energy, marked, n, gradient);
    }
    for (size_t i = 0; good && i < half; i++) {
        field[i] = gradient[half + i];
        field[half + i] = gm_formula_apply(graph, GM_OPERATION_NEGATE, gradient[i], gradient[i]);
    }
    free(gradient);
    free(marked);
    return good && !graph->failed;
}

static bool is_smooth(const struct gm_formula *graph, gm_node_id node)
{
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(graph, node, &count);
    bool smooth = true;
    for (size_t i = 0; i < count; i++) {
        const enum gm_operation operation = graph->nodes[parts[i]].operation;
        smooth = smooth && (operation <= GM_VARIABLE || gm_operation_rows[operation].smooth);
    }
    free(parts);
    return smooth;
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

/* Finds the terms from the scheme's coefficients; false with the reason. */
static bool open_terms(struct gm_modified_energy *energy, const struct gm_scheme *scheme,
                       char why[GM_MODIFIED_WHY])
{
    struct gm_coefficients coefficients;
    if (!gm_scheme_coefficients_open(scheme, &coefficients)) {
        snprintf(why, GM_MODIFIED_WHY,
                 "what %.80s solves is not worked out: it is no Runge-Kutta method, splitting or composition",
                 scheme->title);
        return false;
    }
    gm_coefficients_reduce(&coefficients);
    const bool symplectic = gm_theory_is_symplectic(&coefficients), nystrom = coefficients.nystrom > 0;
    const bool good =
        symplectic && !nystrom && gm_modified_open(&energy->modified, &coefficients, energy->power + 1);
    gm_coefficients_close(&coefficients);
    if (!symplectic) {
        snprintf(why, GM_MODIFIED_WHY,
                 "%.80s is not symplectic: the equation that it solves has no Hamiltonian", scheme->title);
    } else if (nystrom) {
        snprintf(why, GM_MODIFIED_WHY, "what a Nystrom method solves is not worked out");
    }
    if (!good) {
        return false;
    }
    int branches[MOST_BRANCHES];
    for (size_t i = 0; i < energy->modified.count; i++) {
        energy->with[branches_of(&energy->modified.trees, energy->modified.terms[i].tree, branches)]++;
    }
    const int order = (energy->power + 1) / 2;
    energy->differentials = order > 0 ? energy->modified.trees.first[order + 1] : 0;
    return true;
}

static bool open_formula(struct gm_modified_energy *energy, const struct gm_problem *problem,
                         char why[GM_MODIFIED_WHY])
{
    const struct gm_hamiltonian *hamiltonian = gm_ode_of(problem)->hamiltonian;
    const size_t n = energy->n;
    struct gm_formula graph;
    gm_node_id node = GM_NO_NODE, *field = malloc((n + 1) * sizeof *field);
    gm_formula_open(&graph);
    bool good = field && hamiltonian->formula(problem, &graph, &node), too_long = false;
    if (good && !is_smooth(&graph, node)) {
        snprintf(why, GM_MODIFIED_WHY, "H is not smooth: it has no further derivatives");
        good = false;
    }
    if (good) {
        energy->weight = hamiltonian->weight ? hamiltonian->weight(problem) : 1;
        node = gm_product(&graph, gm_formula_constant(&graph, energy->weight), node);
        good = !graph.failed && field_of(&graph, node, n, field);
    }
    int most = 0;
    for (int m = 0; m < GM_MODIFIED_ORDER; m++) {
        most = energy->with[m] > 0 ? m : most;
    }
    good = good && open_tapes(energy->hamiltonian, most, &graph, &node, 1, n, &too_long) &&
           (energy->differentials == 0 ||
            open_tapes(energy->field, (energy->power + 1) / 2 - 1, &graph, field, n, n, &too_long));
    if (too_long) {
        snprintf(why, GM_MODIFIED_WHY, "the derivatives of H up to order %d are too long to be worked out",
                 most);
    }
    gm_formula_close(&graph);
    free(field);
    return good;
}

struct gm_modified_energy *gm_modified_energy_open(const struct gm_problem *problem,
                                                   const struct gm_scheme *scheme, int power,
                                                   char why[GM_MODIFIED_WHY])
{
    why[0] = '\0';
    const struct gm_hamiltonian *hamiltonian =
        problem->kind == &gm_kind_ode ? gm_ode_of(problem)->hamiltonian : NULL;
    if (!hamiltonian || !hamiltonian->formula) {
        snprintf(why, GM_MODIFIED_WHY, "%s",
                 hamiltonian ? "H is not written as a formula"
                             : "there is no Hamiltonian in canonical variables that stands still");
        return NULL;
    }
    struct gm_modified_energy *energy = calloc(1, sizeof *energy);
    if (!energy) {
        return NULL;
    }
    energy->n = problem->n - 2 * problem->passive;
    energy->power = power;
    bool good = open_terms(energy, scheme, why) && open_formula(energy, problem, why);
    if (good) {
        size_t widest = energy->n, longest = energy->n; /* F is found one by one */
        for (int m = 0; m < GM_MODIFIED_ORDER; m++) {
            longest = energy->with[m] > longest ? energy->with[m] : longest;
            const size_t width = (size_t)(m + 1) * energy->n * (energy->with[m] ? energy->with[m] : 1);
            widest = width > widest ? width : widest;
        }
        energy->vectors = malloc(((size_t)energy->differentials + 1) * energy->n * sizeof *energy->vectors);
        energy->inputs = malloc(widest * sizeof *energy->inputs);
        energy->values = malloc(longest * sizeof *energy->values);
        good = energy->vectors && energy->inputs && energy->values;
    }
    if (!good) {
        gm_modified_energy_close(energy);
        energy = NULL;
    }
    return energy;
}

void gm_modified_energy_close(struct gm_modified_energy *energy)
{
    if (!energy) {
        return;
    }
    for (size_t m = 0; m < GM_COUNT(energy->field); m++) {
        gm_tape_close(&energy->field[m]);
    }
    for (size_t m = 0; m < GM_COUNT(energy->hamiltonian); m++) {
        gm_tape_close(&energy->hamiltonian[m]);
    }
    gm_modified_close(&energy->modified);
    free(energy->vectors);
    free(energy->inputs);
    free(energy->values);
    free(energy);
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
