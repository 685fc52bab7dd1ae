/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A state of a system by the names of its components: each an array, or a list of them an array. */
#include <stdio.h>
#include <string.h>

#include "core/ode/ode.h"
#include "core/ode/user/forms.h"
#include "core/quantity.h"
#include "core/run.h"

/* Reads "q1 q2 p1 p2" or, with lists, "x[] y[]"; `lists` is how many of the names are lists. */
static size_t read_names(const char *names, struct gm_quantity *quantities, size_t *lists)
{
    size_t count = 0;
    *lists = 0;
    while (*names && count < GM_QUANTITIES) {
        const size_t length = strcspn(names, " "), name = strcspn(names, " [");
        const bool list = name < length;
        quantities[count] =
            (struct gm_quantity){.support = list ? GM_ON_BODIES : GM_ON_RUN, .count = 1, .width = 1};
        snprintf(quantities[count].name, sizeof quantities->name, "%.*s", (int)name, names);
        *lists += list;
        count++;
        names += length + strspn(names + length, " ");
    }
    return count;
}

/* Marks the components that are coordinates: in a Hamiltonian system the first half or, if that is one or
   belongs to several copies, a degree of freedom with its momentum; otherwise all; three at most. */
static void mark_axes(const struct gm_problem *problem, struct gm_quantity *quantities, size_t count)
{
    const struct gm_hamiltonian *hamiltonian = gm_ode_of(problem)->hamiltonian;
    const size_t half = count / 2;
    if (hamiltonian && (half == 1 || hamiltonian->partial)) {
        quantities[0].axis = 1;
        quantities[half].axis = 2;
        return;
    }
    for (size_t i = 0; i < (hamiltonian ? half : count) && i < 3; i++) {
        quantities[i].axis = (int)i + 1;
    }
}

/* The components of a system by their names (struct gm_ode), and its tracers. */
size_t gm_ode_quantities(const struct gm_run *run, struct gm_quantity *quantities)
{
    const struct gm_problem *problem = run->problem;
    const char *names = gm_ode_of(problem)->components;
    const size_t active = problem->n - 2 * problem->passive;
    size_t lists = 0, first = 0;
    if (gm_ode_of(problem)->forms) {
        return gm_form_quantities(run, quantities);
    }
    if (problem->line.points > 0) { /* fields on a line, which evolve by rates */
        quantities[0] = gm_quantity_grid(run);
        const size_t fields = read_names(names, quantities + 1, &lists);
        for (size_t i = 1; i <= fields; i++) {
            quantities[i].support = GM_ON_NODES;
            quantities[i].count = quantities[0].count;
            quantities[i].first = (i - 1) * problem->line.points;
        }
        return fields + 1;
    }
    size_t count = read_names(names ? names : "y[]", quantities, &lists);
    mark_axes(problem, quantities, count);
    for (size_t i = 0; i < count; i++) {
        if (quantities[i].support == GM_ON_BODIES) {
            quantities[i].count = (active - (count - lists)) / lists;
        }
        quantities[i].first = first;
        first += quantities[i].count;
    }
    for (int c = 0; c < 2 && problem->passive > 0; c++) {
        quantities[count] = (struct gm_quantity){
            .support = GM_ON_TRACERS, .count = problem->passive, .width = 1, .first = first, .axis = c + 1};
        snprintf(quantities[count].name, sizeof quantities->name, "tracer_%c", "xy"[c]);
        first += problem->passive;
        count++;
    }
    return count;
}
