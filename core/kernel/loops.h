/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LOOPS_H
#define GM_CORE_LOOPS_H

#include "core/problem.h"

/* What core/kernel/loops.c makes of a problem's kernels for one instruction set. */
struct gm_loops {
    void (*field)(const struct gm_problem *problem, const double *y, double *f, size_t m);
    gm_loop *family[GM_FAMILY_COUNT]; /* NULL: the problem lacks what the family needs */
};

#define GM_LOOPS_NAME(problem, isa) GM_LOOPS_NAME_(problem, isa)
#define GM_LOOPS_NAME_(problem, isa) gm_loops_##problem##_##isa

/* Declares, and lists, a problem's loops; GM_LOOPS_X86 is set where the build made the wider ones. */
#ifdef GM_LOOPS_X86
#define GM_LOOPS_DECLARE(problem)                                                                            \
    extern const struct gm_loops gm_loops_##problem##_baseline, gm_loops_##problem##_avx2,                   \
        gm_loops_##problem##_avx512;
#define GM_LOOPS(problem)                                                                                    \
    {                                                                                                        \
        &gm_loops_##problem##_baseline, &gm_loops_##problem##_avx2, &gm_loops_##problem##_avx512             \
    }
#else
#define GM_LOOPS_DECLARE(problem) extern const struct gm_loops gm_loops_##problem##_baseline;
#define GM_LOOPS(problem)                                                                                    \
    {                                                                                                        \
        &gm_loops_##problem##_baseline                                                                       \
    }
#endif

/* The best instruction set of this machine and build: an index into problem->loops. */
enum gm_isa gm_isa_best(void);
const char *gm_isa_name(enum gm_isa isa);

#endif
