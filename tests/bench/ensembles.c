/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Facets as the program's own, with loops of over_kernels.c that it does without. */
#include "tests/bench/ensembles.h"

#include <string.h>

#include "core/ode/kernel/loops.h"
#include "tests/problems/problems.h"

GM_LOOPS_DECLARE(kepler_ensemble)
GM_LOOPS_DECLARE(oscillator_ensemble)

void gm_bench_ensemble(struct gm_problem *problem)
{
    static const struct gm_loops *const kepler[GM_ISA_COUNT] = GM_LOOPS(kepler_ensemble),
                                        *const oscillator[GM_ISA_COUNT] = GM_LOOPS(oscillator_ensemble);
    static struct gm_ode facets[2];
    const bool is_kepler = strcmp(problem->name, gm_problem_kepler.name) == 0;
    struct gm_ode *ode = &facets[is_kepler];
    *ode = *gm_ode_of(problem);
    memcpy(ode->loops, is_kepler ? kepler : oscillator, sizeof ode->loops);
    problem->facets = ode;
}
