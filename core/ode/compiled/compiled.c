/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of systems that the build compiled: a copy of their file, or another file with the same formulas, has them
   too. GM_COMPILED_ROWS is a row GM_ROW(NAME) for each. */
#include "core/ode/kernel/loops.h"

#define GM_ROW(name) extern const struct gm_compiled_kernel gm_compiled_##name;
GM_COMPILED_ROWS
#undef GM_ROW

static const struct gm_compiled_kernel *const compiled[] = {
#define GM_ROW(name) &gm_compiled_##name,
    GM_COMPILED_ROWS
#undef GM_ROW
        NULL};

const struct gm_loops *gm_compiled_loops(struct gm_digest digest, size_t members)
{
    /* Loops that advance an ensemble member by member are faster than the interpreter for few members (Kepler with
       scheme=verlet: 0.9 of its time for 13 members, 3 times as long for 100). */
    enum { FEW = 16 };
    for (size_t i = 0; compiled[i]; i++) {
        if (compiled[i]->key[0] == digest.a && compiled[i]->key[1] == digest.b) {
            return members > FEW && !compiled[i]->of_ensembles
                       ? NULL
                       : compiled[i]->loops[members == 1 ? GM_ISA_BASELINE : gm_isa_best()];
        }
    }
    return NULL;
}

bool gm_compiled_has(size_t components)
{
    size_t i = 0;
    while (compiled[i] && compiled[i]->components != components) {
        i++;
    }
    return compiled[i] != NULL;
}
