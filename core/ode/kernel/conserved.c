/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas with exact derivatives; the energy of a Lagrangian, or of a problem computed by hand, has
       dH/dq = -p'/w,   dH/dp = q'/w
   from the field (struct gm_hamiltonian). */
#include "core/ode/kernel/conserved.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"

static gm_node_id node_of(struct gm_conserved *conserved, size_t i, const char *name,
                          struct gm_formula *graph, char *lacks)
{
    const struct gm_ode *ode = gm_ode_of(conserved->problem);
    const bool energy = strcmp(name, "H") == 0 && ode->hamiltonian && !ode->hamiltonian->partial;
    gm_node_id node = GM_NO_NODE;
    if (energy && !ode->hamiltonian->formula) {
        conserved->energy = i;
        return gm_formula_constant(graph, 0);
    }
    if (ode->conserved) {
        return ode->conserved(conserved->problem, name, graph, lacks);
    }
    if (energy) {
        return ode->hamiltonian->formula(conserved->problem, graph, &node) ? node : GM_NO_NODE;
    }
    snprintf(lacks, GM_FAULT_SENTENCE, "an invariant %.60s", name);
    return GM_NO_NODE;
}

/* Opens the tapes. slopes: room for the slopes, and the values behind them. */
static bool open_tapes(struct gm_conserved *conserved, const char *const *names, struct gm_formula *graph,
                       gm_node_id *slopes, char lacks[GM_FAULT_SENTENCE])
{
    const size_t count = conserved->count, n = conserved->n;
    gm_node_id *nodes = slopes + count * n;
    for (size_t i = 0; i < count; i++) {
        nodes[i] = node_of(conserved, i, names[i], graph, lacks);
        if (nodes[i] == GM_NO_NODE || !gm_gradient(graph, nodes[i], NULL, n, slopes + i * n)) {
            return false;
        }
        for (size_t k = 0; k < i; k++) {
            if (nodes[k] == nodes[i] && conserved->energy != i && conserved->energy != k) {
                snprintf(lacks, GM_FAULT_SENTENCE, "every invariant once; %.60s is %.60s", names[i],
                         names[k]);
                return false;
            }
        }
    }
    for (size_t i = 0; i < count * n; i++) {
        conserved->linear &= graph->nodes[slopes[i]].operation == GM_CONSTANT && conserved->energy == count;
    }
    return gm_tape_open(&conserved->values, graph, nodes, count, n, NULL) &&
           gm_tape_open(&conserved->slopes, graph, slopes, count * n, n, NULL) &&
           gm_tape_open(&conserved->both, graph, slopes, count * (n + 1), n, NULL);
}

bool gm_conserved_open(struct gm_conserved *conserved, const struct gm_problem *problem,
                       const char *const *names, size_t count, char lacks[GM_FAULT_SENTENCE])
{
    const size_t n = problem->n - 2 * problem->passive;
    struct gm_formula graph;
    gm_node_id *slopes = malloc((count * (n + 1) + 1) * sizeof *slopes);
    *conserved =
        (struct gm_conserved){.problem = problem, .count = count, .n = n, .energy = count, .linear = true};
    lacks[0] = '\0';
    gm_formula_open(&graph);
    const bool opened = slopes && open_tapes(conserved, names, &graph, slopes, lacks);
    if (!opened) {
        gm_conserved_close(conserved);
    }
    gm_formula_close(&graph);
    free(slopes);
    return opened;
}

void gm_conserved_close(void *data)
{
    struct gm_conserved *conserved = data;
    gm_tape_close(&conserved->values);
    gm_tape_close(&conserved->slopes);
    gm_tape_close(&conserved->both);
}

void gm_conserved_values(const struct gm_conserved *conserved, const double *y, double *values)
{
    gm_tape_values(&conserved->values, y, values, 1);
    if (conserved->energy < conserved->count) {
        values[conserved->energy] = gm_energy(conserved->problem, y);
    }
}

/* An H without a formula: its gradient, of the field. */
static void find_energy(const struct gm_conserved *conserved, const double *y, double *gradient)
{
    const struct gm_problem *problem = conserved->problem;
    const double weight = gm_weight_of(problem);
    const size_t half = conserved->n / 2;
    gm_field(problem, y, gradient, 1);
    for (size_t i = 0; i < half; i++) {
        const double velocity = gradient[i];
        gradient[i] = -gradient[half + i] / weight;
        gradient[half + i] = velocity / weight;
    }
}

void gm_conserved_slopes(const struct gm_conserved *conserved, const double *y, double *slopes)
{
    gm_tape_values(&conserved->slopes, y, slopes, 1);
    if (conserved->energy < conserved->count) {
        find_energy(conserved, y, slopes + conserved->energy * conserved->n);
    }
}

void gm_conserved_both(const struct gm_conserved *conserved, const double *y, double *slopes)
{
    gm_tape_values(&conserved->both, y, slopes, 1);
    if (conserved->energy < conserved->count) {
        find_energy(conserved, y, slopes + conserved->energy * conserved->n);
        slopes[conserved->count * conserved->n + conserved->energy] = gm_energy(conserved->problem, y);
    }
}
