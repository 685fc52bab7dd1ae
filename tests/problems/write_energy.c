/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A program that the build runs. For a problem given by a system's file it writes the functions of its energy, for
   over_energy.c: the file's H, or its observable or invariant H if the file has rates.
   Usage: write_energy FILE.system FILE.energy.h */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/derivative.h"
#include "core/files/generated.h"
#include "core/model/equations.h"
#include "core/ode/user/kernel.h"

/* Returns GM_NO_NODE if the file gives no energy. */
static gm_node_id energy_of(const struct gm_user_system *system)
{
    gm_node_id energy = system->kind == GM_CANONICAL ? system->energy : GM_NO_NODE;
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if ((item->word == GM_WORD_INVARIANT || item->word == GM_WORD_OBSERVE) &&
            strcmp(item->name, "H") == 0) {
            energy = item->nodes[0];
        }
    }
    return energy;
}

/* V, V' and V'' where p is 0, for H = p^2/2 + V(q). An empty tape of other systems. */
static bool potential_open(struct gm_tape *tape, struct gm_user_system *system)
{
    const double rest[] = {NAN, 0};
    const bool marked[] = {true, false};
    gm_node_id nodes[3] = {system->energy}, slope[2];
    memset(tape, 0, sizeof *tape);
    if (system->kind != GM_CANONICAL || system->n != 2 || system->parameters < system->velocities ||
        system->rates[0] != gm_formula_variable(&system->graph, 1)) {
        return true;
    }
    for (int k = 1; k < 3; k++) {
        if (!gm_gradient(&system->graph, nodes[k - 1], marked, 2, slope)) {
            return false;
        }
        nodes[k] = slope[0];
    }
    return gm_tape_open(tape, &system->graph, nodes, 3, 1, rest);
}

/* Writes the functions, and the energy as text if there are no parameters. */
static bool write_energy(FILE *out, struct gm_user_system *system)
{
    struct gm_tape tapes[2] = {{0}};
    const struct gm_naming naming = gm_system_naming(system),
                           written_out = {.variable = naming.variable, .data = naming.data};
    const gm_node_id energy = energy_of(system);
    const char *lacks;
    char *text = NULL, *formula = NULL;
    bool good = potential_open(&tapes[1], system);
    if (energy != GM_NO_NODE) {
        good = good && gm_tape_open(&tapes[0], &system->graph, &energy, 1, system->velocities, NULL);
    }
    const struct gm_kernel_source source = {
        .components = system->n,
        .tapes = {[GM_KERNEL_ENERGY] = tapes[0].outputs > 0 ? &tapes[0] : NULL,
                  [GM_KERNEL_POTENTIAL] = tapes[1].outputs > 0 ? &tapes[1] : NULL},
        .written_out = true,
        .parameters = system->parameters};
    text = good ? gm_kernel_text(&source, &lacks) : NULL;
    good = text && fprintf(out, "%s%s%s", tapes[0].outputs > 0 ? "#define GM_WITH_ENERGY\n" : "",
                           tapes[1].outputs > 0 ? "#define GM_WITH_POTENTIAL\n" : "", text) > 0;
    if (energy != GM_NO_NODE && system->parameters == system->velocities) {
        formula = gm_formula_text(&system->graph, energy, &written_out);
        good = good && formula && fprintf(out, "#define GM_ENERGY_TEXT \"%s\"\n", formula) > 0;
    }
    gm_tape_close(&tapes[0]);
    gm_tape_close(&tapes[1]);
    free(formula);
    free(text);
    return good;
}

int main(int argc, char *argv[])
{
    struct gm_user_system system;
    struct gm_fault fault;
    size_t size = 0;
    char *source = argc == 3 ? gm_input_read(argv[1], &size) : NULL;
    bool good = source && gm_equations_open(&system, source, size, NULL, 0, &fault);
    FILE *out = good ? fopen(argv[2], "w") : NULL;
    good = out && write_energy(out, &system);
    good = out && fclose(out) == 0 && good;
    if (source) {
        gm_system_close(&system);
    }
    free(source);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
