/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy of a built-in problem as a formula, for schemes that need its derivatives. */
#include "core/ode/hamiltonian.h"

#include <string.h>

#include "core/expression/reader.h"

struct reading {
    const struct gm_problem *problem;
    struct gm_formula *graph;
};

/* The words of struct gm_ode's components are lists of equal length, or single ones. */
static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    const struct reading *reading = data;
    (void)sentence;
    const struct gm_problem *problem = reading->problem;
    const char *words = gm_ode_of(problem)->components;
    size_t count = 1;
    for (const char *at = words; *at; at++) {
        count += *at == ' ';
    }
    const size_t each = (problem->n - 2 * problem->passive) / count;
    for (size_t word = 0; word < count; word++) {
        const size_t length = strcspn(words, " [");
        if (length == name->length && strncmp(words, name->text, length) == 0) {
            *node = gm_formula_variable(reading->graph,
                                        word * each + (name->indexed ? (size_t)name->index - 1 : 0));
            return GM_KNOWN;
        }
        words += strcspn(words, " ") + 1;
    }
    return GM_UNKNOWN;
}

bool gm_hamiltonian_read(const struct gm_problem *problem, const char *text, struct gm_formula *graph,
                         gm_node_id *energy)
{
    struct reading reading = {problem, graph};
    const struct gm_scope scope = {.find = find, .data = &reading};
    struct gm_fault fault;
    return gm_formula_read(graph, text, 0, strlen(text), &scope, energy, &fault);
}
