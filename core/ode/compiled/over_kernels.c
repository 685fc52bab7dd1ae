/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every family's loop over one problem's kernels, for single runs and for ensembles. The build compiles this
   file once for each problem, and if it has ensembles for each instruction set, with
       GM_KERNELS   the problem's kernels ("core/ode/problems/oscillators/fpu.kernel.h")
       GM_PROBLEM   its name (pendulum)
       GM_ISA       the instruction set's name (baseline, avx2, avx512); the flags are set to match
       GM_BASELINE  with the loops of a single run, or
       GM_ALONE     with no others: an ensemble is advanced member by member
   and, if not all families are needed, one of GM_LOOP_EXPLICIT, GM_LOOP_IMPLICIT, GM_LOOP_SPLITTING and
   GM_LOOP_NONE. The kernel file is included for each pass, over the lane type `real`. It defines
       GM_COMPONENTS   n, a constant
       GM_SEPARABLE    if H = T(p) + V(q)
   and the kernels
       separable   K(velocity)(p, dq, parameters), K(force)(q, dp, parameters)
       otherwise   K(field)(y, f, parameters)
       both        K(jacobian)(y, J, parameters), J[row][column] = d f_row / d y_column, in the scalar pass;
                   with GM_WITHOUT_JACOBIAN, which no implicit family takes, none
       with GM_SURFACES, a constant   K(surfaces)(y, inside, parameters) in the scalar pass, as many numbers, which
                   are above 0 while no break is reached
   The operations, and so the bits, are the same for every instruction set: nothing is contracted. */

#include "core/ode/kernel/loops.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "core/linear/settled.h"
#include "core/ode/families/runge_kutta/explicit.h"
#include "core/ode/families/runge_kutta/implicit.h"
#include "core/ode/families/splitting/splitting.h"
#include "core/scheme.h"

/* Steps between two looks at whether they succeeded. The look and the copy for a second try take as long as some
   steps of a short scheme do: with 16 of them an eighth to a fifth of the time. */
enum { GM_BURST = 64 };

#if !defined(GM_LOOP_EXPLICIT) && !defined(GM_LOOP_IMPLICIT) && !defined(GM_LOOP_SPLITTING) &&               \
    !defined(GM_LOOP_NONE)
#define GM_LOOP_EXPLICIT
#define GM_LOOP_IMPLICIT
#define GM_LOOP_SPLITTING
#endif

#define GM_PASS_SCALAR
#include "core/ode/compiled/pass.h"
#undef GM_PASS_SCALAR
#ifndef GM_ALONE
#include "core/ode/compiled/pass.h"
#endif

/* One run takes the scalar loops, an ensemble the loops over lanes. A single run gains nothing from wide
   registers, so its loops are those of the baseline alone. */
#ifdef GM_ALONE
#define GM_RUN(family) family##_run_scalar(task)
#elif defined(GM_BASELINE)
#define GM_RUN(family) task->problem->m == 1 ? family##_run_scalar(task) : family##_run_lanes(task)
#else
#define GM_RUN(family) family##_run_lanes(task)
#endif
#define GM_DISPATCH(family)                                                                                  \
    static struct gm_progress family##_loop(const struct gm_task *task)                                      \
    {                                                                                                        \
        return GM_RUN(family);                                                                               \
    }
#ifdef GM_LOOP_EXPLICIT
GM_DISPATCH(explicit_runge_kutta)
#endif
#ifdef GM_LOOP_IMPLICIT
GM_DISPATCH(implicit_runge_kutta)
#endif
#if defined(GM_LOOP_SPLITTING) && defined(GM_SEPARABLE)
GM_DISPATCH(splitting)
#endif

/* The components [first, first + count) of m members through a kernel, which returns as many. */
#define GM_OVER_MEMBERS(name, first, count)                                                                  \
    static void name(const struct gm_problem *problem, const double *y, double *f, size_t m)                 \
    {                                                                                                        \
        for (size_t i = 0; i < m; i++) {                                                                     \
            double state[count], slope[count];                                                               \
            for (int c = 0; c < (count); c++) {                                                              \
                state[c] = y[(size_t)((first) + c) * m + i];                                                 \
            }                                                                                                \
            name##_scalar(state, slope, problem->parameters);                                                \
            for (int c = 0; c < (count); c++) {                                                              \
                f[(size_t)c * m + i] = slope[c];                                                             \
            }                                                                                                \
        }                                                                                                    \
    }
GM_OVER_MEMBERS(field, 0, GM_COMPONENTS)
#if defined(GM_SEPARABLE) && defined(GM_LOOP_NONE)
GM_OVER_MEMBERS(velocity, GM_COMPONENTS / 2, GM_COMPONENTS / 2)
GM_OVER_MEMBERS(force, 0, GM_COMPONENTS / 2)
#endif

#ifndef GM_WITHOUT_JACOBIAN
static void jacobian(const struct gm_problem *problem, const double *y, double *rows)
{
    double square[GM_COMPONENTS][GM_COMPONENTS];
    jacobian_scalar(y, square, problem->parameters);
    memcpy(rows, square, sizeof square);
}
#endif

#if defined(GM_KERNEL_KEY) && GM_COMPONENTS <= 4
/* Moves one piece; its number is constant, so that the compiler omits the other rates. */
static inline __attribute__((always_inline)) void shear_of(const struct gm_problem *problem, size_t piece,
                                                           double h, double *y, size_t m)
{
    for (size_t i = 0; i < m; i++) {
        double state[GM_COMPONENTS], slope[GM_COMPONENTS];
        for (size_t c = 0; c < GM_COMPONENTS; c++) {
            state[c] = y[c * m + i];
        }
        field_scalar(state, slope, problem->parameters);
        y[piece * m + i] += h * slope[piece];
    }
}

#define GM_CASE(piece)                                                                                       \
    case piece:                                                                                              \
        shear_of(problem, (piece) % GM_COMPONENTS, h, y, m);                                                 \
        break;

static void shear(const struct gm_problem *problem, size_t piece, double h, double *y, size_t m)
{
    switch (piece) {
        GM_CASE(0)
        GM_CASE(1)
        GM_CASE(2)
        GM_CASE(3)
    }
}
#define GM_SHEAR shear
#else
#define GM_SHEAR NULL
#endif

const struct gm_loops GM_LOOPS_NAME(GM_PROBLEM, GM_ISA) = {
    .field = field,
    .shear = GM_SHEAR,
#ifdef GM_SURFACES
    .watches = true,
#endif
#ifndef GM_WITHOUT_JACOBIAN
    .jacobian = jacobian,
#endif
#if defined(GM_SEPARABLE) && defined(GM_LOOP_NONE)
    .velocity = velocity,
    .force = force,
#endif
    .over_kernels =
        {
            [GM_OVER_NONE] = NULL,
#ifdef GM_LOOP_EXPLICIT
            [GM_OVER_EXPLICIT] = explicit_runge_kutta_loop,
#endif
#ifdef GM_LOOP_IMPLICIT
            [GM_OVER_IMPLICIT] = implicit_runge_kutta_loop,
#endif
#if defined(GM_LOOP_SPLITTING) && defined(GM_SEPARABLE)
            [GM_OVER_SPLITTING] = splitting_loop,
#endif
        },
};

#if defined(GM_ALONE) && defined(GM_LOOPS_X86)
/* aliases under the names of other instruction sets */
#define GM_SAME_LOOPS(isa)                                                                                   \
    extern const struct gm_loops GM_LOOPS_NAME(GM_PROBLEM, isa)                                              \
        __attribute__((alias(GM_IN_QUOTES(GM_LOOPS_NAME(GM_PROBLEM, GM_ISA)))));
#define GM_IN_QUOTES(name) GM_IN_QUOTES_(name)
#define GM_IN_QUOTES_(name) #name
GM_SAME_LOOPS(avx2)
GM_SAME_LOOPS(avx512)
#endif

#if defined(GM_KERNEL_KEY) && (defined(GM_ALONE) || defined(GM_BASELINE))
#ifndef GM_OF_ENSEMBLES
#define GM_OF_ENSEMBLES false
#endif
#ifndef GM_ALONE
GM_LOOPS_DECLARE(GM_PROBLEM)
#endif
const struct gm_compiled_kernel GM_COMPILED_NAME(GM_PROBLEM) = {
    {GM_KERNEL_KEY}, GM_COMPONENTS, GM_OF_ENSEMBLES, GM_LOOPS(GM_PROBLEM)};
#endif
