/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A program that the build runs. For a problem given by a system's file it writes the kernel file, in the
   form used for user-defined systems that are compiled during the run, with the constants in it. The
   problem's `parameters` points to the file's parameters, in their order.
   Usage: write_kernel FILE.system FILE.kernel.h
   With a third word, `yes` or PARAMETER=VALUE, for a system of share/ with a line `compile:`: the kernel file
   that the program would write of it, with the digest by which the program finds its loops. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/derivative.h"
#include "core/files/generated.h"
#include "core/model/equations.h"
#include "core/ode/user/kernel.h"
#include "core/ode/user/model.h"

/* Opens the tapes of the n rates and of their Jacobian, with this number of inputs (core/tape.h). Returns false
   when out of memory. */
static bool open_tapes(struct gm_tape *tapes, const struct gm_formula *graph,
                       const struct gm_user_rates *rates, size_t n, size_t inputs, const double *values)
{
    const gm_node_id *const nodes = rates->nodes;
    return gm_tape_open(&tapes[GM_KERNEL_FIELD], graph, nodes, n, inputs, values) &&
           gm_tape_open(&tapes[GM_KERNEL_VELOCITY], graph, nodes, n / 2, inputs, values) &&
           gm_tape_open(&tapes[GM_KERNEL_FORCE], graph, nodes + n / 2, n / 2, inputs, values) &&
           gm_tape_open(&tapes[GM_KERNEL_JACOBIAN], graph, rates->slopes, rates->jacobian.count, inputs,
                        values);
}

/* Returns the text of a system's kernels; the caller frees. NULL with the reason, which is NULL when out of
   memory. `written_out`: of a problem of the build, with constants; else of a system of share/, as the program
   writes it (gm_user_problem_kernel): for all values of the parameters, or for the system's. */
static char *kernel_of(struct gm_user_system *system, bool written_out, bool general, const char **lacks)
{
    struct gm_user_model model;
    struct gm_tape tapes[GM_KERNEL_FUNCTIONS] = {0};
    char *text = NULL;
    double *start = gm_user_model_open(&model, system) ? gm_equations_start(system, NULL) : NULL;
    *lacks = start ? gm_user_model_refuses_kernels(&model) : NULL;
    if (start && !*lacks) {
        const struct gm_user_rates *rates = general ? model.rates : gm_user_model_rates(&model, start);
        const size_t n = model.components;
        const bool opened = open_tapes(tapes, &system->graph, rates, n, written_out ? system->velocities : n,
                                       written_out ? NULL : start);
        struct gm_kernel_source source = {.components = n,
                                          .tapes = {&tapes[GM_KERNEL_FIELD], &tapes[GM_KERNEL_VELOCITY],
                                                    &tapes[GM_KERNEL_FORCE],
                                                    model.has_jacobian ? &tapes[GM_KERNEL_JACOBIAN] : NULL},
                                          .jacobian = &rates->jacobian,
                                          .jacobian_wanted = true,
                                          .written_out = written_out,
                                          .parameters = system->parameters};
        if (opened && !(written_out ? gm_kernel_splits(&source) : gm_user_model_splits(&model, start))) {
            source.tapes[GM_KERNEL_VELOCITY] = source.tapes[GM_KERNEL_FORCE] = NULL;
        }
        text = opened ? gm_kernel_text(&source, lacks) : NULL;
    }
    for (int i = 0; i < GM_KERNEL_FUNCTIONS; i++) {
        gm_tape_close(&tapes[i]);
    }
    free(start);
    return text;
}

int main(int argc, char *argv[])
{
    struct gm_user_system system;
    struct gm_fault fault;
    struct gm_system_value value;
    const char *lacks = "it could not be read";
    size_t size = 0;
    char *source = argc == 3 || argc == 4 ? gm_input_read(argv[1], &size) : NULL, *text = NULL,
         *equals = argc == 4 ? strchr(argv[3], '=') : NULL;
    if (equals) {
        *equals = '\0';
        value = (struct gm_system_value){argv[3], equals + 1};
    }
    if (source) {
        if (gm_equations_open(&system, source, size, &value, equals != NULL, &fault)) {
            text = kernel_of(&system, argc == 3, !equals, &lacks);
        } else {
            lacks = fault.sentence;
        }
        gm_system_close(&system);
    }
    FILE *out = text ? fopen(argv[2], "w") : NULL;
    bool written = out && fputs(text, out) >= 0;
    if (written && argc == 4) {
        const struct gm_digest key = gm_kernel_digest(text);
        written = fprintf(out, "#define GM_KERNEL_KEY UINT64_C(0x%llx), UINT64_C(0x%llx)\n",
                          (unsigned long long)key.a, (unsigned long long)key.b) > 0;
    }
    const bool good = out && fclose(out) == 0 && written;
    if (!good) {
        fprintf(stderr, "%s: %s\n", argc > 1 ? argv[1] : "write_kernel", lacks ? lacks : "out of memory");
    }
    free(text);
    free(source);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
