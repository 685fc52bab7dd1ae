/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Structure is a matter of derivatives that vanish: H separates where d2H / dp dq does. What stands in the way is
   the first term of the sum whose own derivative does not vanish. */
#include "core/formula/facts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/formula/derivative.h"
#include "core/formula/equations.h"

enum { MOST_TERMS = 64 }; /* that are tried one by one */

static const struct {
    const char *word, *yes, *no;
} rows[GM_FACTS] = {
    [GM_FACT_SEPARABLE] = {"separable", "H = T(p) + V(q)", "holds coordinates and momenta"},
    [GM_FACT_NYSTROM] = {"nystrom", "T is quadratic in the momenta", "is not quadratic in the momenta"},
    [GM_FACT_QUADRATIC] = {"quadratic", "every rate is a polynomial of degree 2", "is not of degree 2"},
    [GM_FACT_VOLUME] = {"volume", "no rate contains its own variable",
                        "contains the variable whose rate it is"},
    [GM_FACT_DIVERGENCE_FREE] = {"divergence-free", "the divergence is 0", "is the divergence"},
    [GM_FACT_SMOOTH] = {"smooth", "no min, max, abs or mod", "is not smooth"},
    [GM_FACT_AUTONOMOUS] = {"autonomous", "the time does not occur", "contains the time"},
};

const char *gm_fact_word(enum gm_fact fact)
{
    return rows[fact].word;
}

static bool depends(struct gm_own_system *system, gm_node_id node, const bool *marked)
{
    bool *dependent = gm_formula_dependent(&system->graph, marked, system->variable_count);
    const bool answer = !dependent || dependent[node];
    system->graph.failed |= !dependent;
    free(dependent);
    return answer;
}

/* Whether all derivatives of a node, over sets[0], of these over sets[1], and so on, are 0. */
static enum gm_identity vanishes(struct gm_own_system *system, gm_node_id node, const bool *const *sets,
                                 size_t depth)
{
    if (depth == 0) {
        return gm_equations_vanishes(system, node);
    }
    if (!depends(system, node, sets[0])) {
        return GM_ZERO_PROVED;
    }
    enum gm_identity all = GM_ZERO_PROVED;
    gm_node_id *gradient = malloc((system->variable_count + 1) * sizeof *gradient);
    if (!gradient || !gm_gradient(&system->graph, node, sets[0], system->variable_count, gradient)) {
        system->graph.failed = true;
        all = GM_UNTESTED;
    }
    for (size_t i = 0; i < system->n && all != GM_NOT_ZERO && !system->graph.failed; i++) {
        const enum gm_identity found =
            sets[0][i] ? vanishes(system, gradient[i], sets + 1, depth - 1) : GM_ZERO_PROVED;
        all = found == GM_ZERO_PROVED ? all : found;
    }
    free(gradient);
    return all;
}

/* The terms that a node is the sum of; factors that hold no component are left aside. Returns how many, at most
   MOST_TERMS. */
static size_t terms_of(struct gm_own_system *system, gm_node_id root, const bool *components,
                       gm_node_id *terms)
{
    bool *dependent = gm_formula_dependent(&system->graph, components, system->variable_count);
    gm_node_id *stack = malloc((system->graph.count + (size_t)1) * sizeof *stack);
    size_t depth = 0, count = 0;
    if (dependent && stack) {
        stack[depth++] = root;
    }
    while (depth > 0 && count < MOST_TERMS) {
        const gm_node_id node = stack[--depth];
        const struct gm_node *here = &system->graph.nodes[node];
        const bool is_sum = here->operation == GM_OPERATION_ADD || here->operation == GM_OPERATION_SUBTRACT;
        if (is_sum) {
            stack[depth++] = here->b;
            stack[depth++] = here->a;
        } else if (here->operation == GM_OPERATION_NEGATE ||
                   ((here->operation == GM_OPERATION_MULTIPLY || here->operation == GM_OPERATION_DIVIDE) &&
                    !dependent[here->b])) {
            stack[depth++] = here->a;
        } else if (here->operation == GM_OPERATION_MULTIPLY && !dependent[here->a]) {
            stack[depth++] = here->b;
        } else {
            terms[count++] = node;
        }
    }
    system->graph.failed |= !dependent || !stack;
    free(dependent);
    free(stack);
    return count;
}

/* The first term whose derivatives do not vanish; the node itself where no term alone is to blame. */
static gm_node_id culprit(struct gm_own_system *system, gm_node_id node, const bool *components,
                          const bool *const *sets, size_t depth)
{
    gm_node_id terms[MOST_TERMS];
    const size_t count = terms_of(system, node, components, terms);
    for (size_t i = 0; i < count; i++) {
        if (vanishes(system, terms[i], sets, depth) == GM_NOT_ZERO) {
            return terms[i];
        }
    }
    return node;
}

static void conclude(struct gm_finding *finding, enum gm_identity found)
{
    finding->holds = finding->holds && (found == GM_ZERO_PROVED || found == GM_ZERO_TESTED);
    finding->how = found == GM_ZERO_PROVED ? finding->how : found;
}

static void find_hamiltonian(struct gm_own_system *system, struct gm_finding *findings, const bool *q,
                             const bool *p, const bool *components)
{
    struct gm_finding *separable = &findings[GM_FACT_SEPARABLE], *nystrom = &findings[GM_FACT_NYSTROM];
    separable->asked = nystrom->asked = true;
    conclude(separable, vanishes(system, system->energy, (const bool *const[]){p, q}, 2));
    if (!separable->holds) {
        separable->term = culprit(system, system->energy, components, (const bool *const[]){p, q}, 2);
        nystrom->holds = false;
        return;
    }
    conclude(nystrom, vanishes(system, system->energy, (const bool *const[]){p, p, p}, 3));
    if (!nystrom->holds) {
        nystrom->term = culprit(system, system->energy, components, (const bool *const[]){p, p, p}, 3);
    }
}

static void find_of_rates(struct gm_own_system *system, struct gm_finding *findings, const bool *components,
                          bool *own)
{
    struct gm_finding *quadratic = &findings[GM_FACT_QUADRATIC], *volume = &findings[GM_FACT_VOLUME],
                      *divergence = &findings[GM_FACT_DIVERGENCE_FREE];
    const bool *const thrice[] = {components, components, components}, *const once[] = {own};
    gm_node_id sum = gm_formula_constant(&system->graph, 0);
    gm_node_id *gradient = malloc((system->variable_count + 1) * sizeof *gradient);
    quadratic->asked = volume->asked = divergence->asked = true;
    for (size_t i = 0; gradient && i < system->n && !system->graph.failed; i++) {
        const gm_node_id rate = system->rates[i];
        if (quadratic->holds) {
            conclude(quadratic, vanishes(system, rate, thrice, 3));
            quadratic->component = i;
            quadratic->term = quadratic->holds ? GM_NO_NODE : culprit(system, rate, components, thrice, 3);
        }
        own[i] = true;
        if (volume->holds) {
            conclude(volume, vanishes(system, rate, once, 1));
            volume->component = i;
            volume->term = volume->holds ? GM_NO_NODE : culprit(system, rate, components, once, 1);
        }
        if (gm_gradient(&system->graph, rate, own, system->variable_count, gradient)) {
            system->graph.simplifies = true;
            sum = gm_formula_apply(&system->graph, GM_OPERATION_ADD, sum, gradient[i]);
            system->graph.simplifies = false;
        }
        own[i] = false;
    }
    system->graph.failed |= !gradient;
    free(gradient);
    conclude(divergence, gm_equations_vanishes(system, sum));
    divergence->term = divergence->holds ? GM_NO_NODE : sum;
}

/* Of all that the equations are made of, the first node of a kind. */
static void find_of_parts(struct gm_own_system *system, struct gm_finding *findings)
{
    struct gm_finding *smooth = &findings[GM_FACT_SMOOTH], *autonomous = &findings[GM_FACT_AUTONOMOUS];
    const size_t last = system->kind == GM_RATES ? system->n : system->n + 1;
    bool *reached = malloc(system->graph.count + (size_t)1);
    smooth->asked = autonomous->asked = true;
    for (size_t i = 0; reached && i < last; i++) {
        const gm_node_id root = i < system->n ? system->rates[i] : system->energy;
        if (root == GM_NO_NODE ||
            (i < system->n && system->kind != GM_RATES && system->kind != GM_CANONICAL)) {
            continue;
        }
        gm_formula_reach(&system->graph, root, reached);
        for (gm_node_id k = 0; k <= root; k++) {
            const struct gm_node *node = &system->graph.nodes[k];
            const bool written = system->graph.places[k] != SIZE_MAX || i < system->n;
            if (reached[k] && node->operation > GM_VARIABLE && !gm_operation_rows[node->operation].smooth &&
                written && (smooth->holds || system->graph.places[smooth->term] == SIZE_MAX)) {
                *smooth = (struct gm_finding){true, false, GM_NOT_ZERO, k, i};
            }
            if (reached[k] && node->operation == GM_VARIABLE && node->a == system->n && autonomous->holds) {
                *autonomous = (struct gm_finding){true, false, GM_NOT_ZERO, k, i};
            }
        }
    }
    system->graph.failed |= !reached;
    free(reached);
}

bool gm_facts_find(struct gm_own_system *system, struct gm_finding findings[GM_FACTS])
{
    const size_t half = system->n / 2;
    bool *marks = calloc(4 * system->variable_count, sizeof *marks);
    for (size_t i = 0; i < GM_FACTS; i++) {
        findings[i] = (struct gm_finding){
            .holds = true, .how = GM_ZERO_PROVED, .term = GM_NO_NODE, .component = system->n};
    }
    if (!marks) {
        return false;
    }
    bool *q = marks, *p = q + system->variable_count, *components = p + system->variable_count,
         *own = components + system->variable_count;
    for (size_t i = 0; i < system->n; i++) {
        q[i] = i < half;
        p[i] = i >= half;
        components[i] = true;
    }
    if (system->kind == GM_CANONICAL) {
        find_hamiltonian(system, findings, q, p, components);
    }
    if (system->kind != GM_LAGRANGIAN) {
        find_of_rates(system, findings, components, own);
    }
    find_of_parts(system, findings);
    free(marks);
    return !system->graph.failed;
}

char *gm_fact_reason(const struct gm_own_system *system, enum gm_fact fact, const struct gm_finding *finding)
{
    char *reason = NULL, *text = NULL;
    int made = -1;
    if (finding->holds) {
        made = asprintf(&reason, "%s%s", rows[fact].yes,
                        finding->how == GM_ZERO_TESTED ? " (at random points)" : "");
        return made < 0 ? NULL : reason;
    }
    if (fact == GM_FACT_NYSTROM && finding->term == GM_NO_NODE) {
        return strdup("H does not separate");
    }
    struct gm_naming naming = gm_system_naming(system);
    naming.part = NULL; /* written out: it is what is in it that matters */
    text = finding->term == GM_NO_NODE ? NULL : gm_formula_text(&system->graph, finding->term, &naming);
    char where[80] = "";
    const size_t place = finding->term == GM_NO_NODE ? SIZE_MAX : system->graph.places[finding->term];
    if (place != SIZE_MAX) {
        size_t line, column;
        gm_text_place(system->source, place, &line, &column);
        snprintf(where, sizeof where, " (line %zu, column %zu)", line, column);
    }
    const bool in_rate = finding->component < system->n && fact != GM_FACT_DIVERGENCE_FREE;
    made = asprintf(&reason, "%s%s %s%s%s", text ? text : "a long term", where, rows[fact].no,
                    in_rate ? ", in the rate of " : "",
                    in_rate ? system->variables[finding->component].name : "");
    free(text);
    return made < 0 ? NULL : reason;
}
