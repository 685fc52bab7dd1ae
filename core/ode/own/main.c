/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A program that the build runs: of a problem that is a system's file it writes the kernel file, as the one
   that is compiled of somebody's own system while the program runs, with its constants in it. Parameters of
   the file are the numbers that the problem's `parameters` lead to, in their order. Usage: write_kernel
   FILE.system FILE.kernel.h */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/formula/equations.h"
#include "core/ode/own/kernel.h"

static char *read_all(const char *name, size_t *size)
{
    char *text = NULL, part[4096];
    FILE *in = fopen(name, "r"), *out = in ? open_memstream(&text, size) : NULL;
    for (size_t count; out && (count = fread(part, 1, sizeof part, in)) > 0;) {
        fwrite(part, 1, count, out);
    }
    const bool good = out && !ferror(in) && fclose(out) == 0;
    if (in) {
        fclose(in);
    }
    return good ? text : NULL;
}

/* The text of the system's kernels; malloc'ed. NULL with what it lacks, or NULL for want of memory. */
static char *kernel_of(struct gm_own_system *system, const char **lacks)
{
    const size_t n = system->n, half = n / 2, inputs = system->velocities;
    struct gm_formula *graph = &system->graph;
    struct gm_sparse jacobian = {0};
    struct gm_tape field, velocity, force, slopes = {0};
    char *text = NULL;
    bool *marked = calloc(system->variable_count, sizeof *marked);
    *lacks = system->kind == GM_LAGRANGIAN || system->timed ? "it is not of the form y' = f(y)" : NULL;
    if (!marked || *lacks) {
        free(marked);
        return NULL;
    }
    memset(marked, true, n);
    bool good = gm_sparse_jacobian(graph, system->rates, n, marked, system->variable_count, &jacobian) &&
                gm_formula_quicken(graph, system->rates, n);
    gm_node_id *nodes = malloc((jacobian.count + 1) * sizeof *nodes);
    for (size_t i = 0; nodes && i < jacobian.count; i++) {
        nodes[i] = jacobian.entries[i].node;
    }
    good = gm_tape_open(&field, graph, system->rates, n, inputs, NULL) && nodes && good;
    good = gm_tape_open(&velocity, graph, system->rates, half, inputs, NULL) && good;
    good = gm_tape_open(&force, graph, system->rates + half, n - half, inputs, NULL) && good;
    good = good && gm_tape_open(&slopes, graph, nodes, jacobian.count, inputs, NULL);
    if (good) {
        struct gm_kernel_source source = {
            .components = n,
            .tapes = {&field, &velocity, &force, &slopes},
            .jacobian = &jacobian,
            .written_out = true,
            .parameters = system->parameters,
        };
        if (!gm_kernel_splits(&source)) {
            source.tapes[GM_KERNEL_VELOCITY] = source.tapes[GM_KERNEL_FORCE] = NULL;
        }
        text = gm_kernel_text(&source, lacks);
    }
    gm_tape_close(&field);
    gm_tape_close(&velocity);
    gm_tape_close(&force);
    gm_tape_close(&slopes);
    free(jacobian.entries);
    free(nodes);
    free(marked);
    return text;
}

int main(int argc, char *argv[])
{
    struct gm_own_system system;
    struct gm_fault fault;
    const char *lacks = "it could not be read";
    size_t size = 0;
    char *source = argc == 3 ? read_all(argv[1], &size) : NULL, *text = NULL;
    if (source) {
        if (gm_equations_open(&system, source, size, NULL, 0, &fault)) {
            text = kernel_of(&system, &lacks);
        } else {
            lacks = fault.sentence;
        }
        gm_system_close(&system);
    }
    FILE *out = text ? fopen(argv[2], "w") : NULL;
    const bool written = out && fputs(text, out) >= 0;
    const bool good = out && fclose(out) == 0 && written;
    if (!good) {
        fprintf(stderr, "%s: %s\n", argc > 1 ? argv[1] : "write_kernel", lacks ? lacks : "out of memory");
    }
    free(text);
    free(source);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
