/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops over a problem's kernels, as its facets hold them for each instruction set. */
#ifndef GM_CORE_ODE_KERNEL_LOOPS_H
#define GM_CORE_ODE_KERNEL_LOOPS_H

#include <stdint.h>

#include "core/ode/kernel/digest.h"
#include "core/ode/ode.h"

struct gm_stages; /* core/ode/kernel/stages.h */

/* The families that have a loop over kernels: gm_family.over_kernels. A composition may need all of these loops. */
enum { GM_OVER_NONE, GM_OVER_EXPLICIT, GM_OVER_IMPLICIT, GM_OVER_SPLITTING, GM_OVER_COUNT };
enum { GM_OVER_ALL = GM_OVER_COUNT };

/* The functions that core/ode/compiled/over_kernels.c makes of a problem's kernels for one instruction set.
   */
struct gm_loops {
    /* f(y) of the active components of m members */
    void (*field)(const struct gm_problem *problem, const double *y, double *f, size_t m);
    /* q' and p' (n / 2 * m each) of the whole state y, whose last component may be t, if n is chosen at run
       time and H = T(p) + V(q); else NULL. */
    void (*velocity)(const struct gm_problem *problem, const double *y, double *velocity, size_t m);
    void (*force)(const struct gm_problem *problem, const double *y, double *force, size_t m);
    /* the Jacobian of one member, n * n row by row; NULL: not available */
    void (*jacobian)(const struct gm_problem *problem, const double *y, double *jacobian);
    /* Overwrites a residual of stages, count * n, with the change z that solves (1 - h a (x) J) z = residual,
       J a Jacobian at stages->y, exact or near enough for an iteration; its factors are kept from call to
       call. False if the matrix is singular, or when out of memory. NULL: not available */
    bool (*correct)(const struct gm_problem *problem, const struct gm_stages *stages, double *residual);
    /* The velocities of `count` passive particles at (x, y), carried by the active components `active`; if
       strain is not NULL also their derivatives, [a, b; b, -a] with a = strain[i], b = strain[count + i]. */
    void (*passive)(const struct gm_problem *problem, const double *active, const double *x, const double *y,
                    double *velocity_x, double *velocity_y, double *strain, size_t count);
    /* x_piece := x_piece + h times its rate, which holds the other components alone; NULL: not compiled */
    void (*shear)(const struct gm_problem *problem, size_t piece, double h, double *y, size_t m);
    /* H if it is a sum as long as the field's; NULL: only the Hamiltonian evaluates it */
    double (*energy)(const struct gm_problem *problem, const double *y);
    bool watches;                         /* gm_task.watches has an effect */
    gm_loop *over_kernels[GM_OVER_COUNT]; /* NULL: the problem lacks what the family needs */
};

#define GM_LOOPS_NAME(problem, isa) GM_LOOPS_NAME_(problem, isa)
#define GM_LOOPS_NAME_(problem, isa) gm_loops_##problem##_##isa

/* Declares and lists a problem's loops; GM_LOOPS_X86 is set if the build made the wider ones. */
#ifdef GM_LOOPS_X86
#define GM_LOOPS_DECLARE(problem)                                                                            \
    extern const struct gm_loops GM_LOOPS_NAME(problem, baseline), GM_LOOPS_NAME(problem, avx2),             \
        GM_LOOPS_NAME(problem, avx512);
#define GM_LOOPS(problem)                                                                                    \
    {                                                                                                        \
        &GM_LOOPS_NAME(problem, baseline), &GM_LOOPS_NAME(problem, avx2), &GM_LOOPS_NAME(problem, avx512)    \
    }
#else
#define GM_LOOPS_DECLARE(problem) extern const struct gm_loops GM_LOOPS_NAME(problem, baseline);
#define GM_LOOPS(problem)                                                                                    \
    {                                                                                                        \
        &GM_LOOPS_NAME(problem, baseline)                                                                    \
    }
#endif

/* The loops of a system of share/systems whose file has a line `compile:`. */
struct gm_compiled_kernel {
    uint64_t key[2]; /* of the digest of its kernel's functions */
    size_t components;
    bool of_ensembles; /* its file is one of many members */
    const struct gm_loops *loops[GM_ISA_COUNT];
};
#define GM_COMPILED_NAME(problem) GM_COMPILED_NAME_(problem)
#define GM_COMPILED_NAME_(problem) gm_compiled_##problem
/* Returns the program's loops of a kernel with this digest, for a number of members; NULL: not compiled in. */
const struct gm_loops *gm_compiled_loops(struct gm_digest digest, size_t members);
/* Returns true if the program has loops of a system with this number of components. */
bool gm_compiled_has(size_t components);

/* Writes f(y) of the active components of m members, for every form in which the problem gives it. */
void gm_field(const struct gm_problem *problem, const double *y, double *f, size_t m);

#endif
