/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_ANY_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_ANY_H

#include "core/scheme.h"

/* Runge-Kutta methods for problems whose n is chosen at run time, through the problem's field, with their
   passive blocks. A passive particle that cannot be carried on - the implicit equations have no solution
   where a vortex turns it by more than a radian a step - is lost: NaN from then on; the run goes on. The
   workspaces hold the stages of the active components, and those of a few passive particles at a time, so a
   million of them need no more scratch than a hundred. */

enum { GM_PASSIVE_BLOCK = 64 };

/* The active components: n * m less the passive block. */
static inline size_t gm_active_count(const struct gm_problem *problem)
{
    return (problem->n - 2 * problem->passive) * problem->m;
}

/* to[i] = from[i] + increment[i]; where carry is not NULL with compensation (Kahan). carry_out may be carry,
   and to may be from. */
static inline void gm_add_increments(const double *from, const double *increment, const double *carry,
                                     double *to, double *carry_out, size_t count)
{
    if (!carry) {
        for (size_t i = 0; i < count; i++) {
            to[i] = from[i] + increment[i];
        }
        return;
    }
    for (size_t i = 0; i < count; i++) {
        const double old = from[i], whole = carry[i] + increment[i];
        to[i] = old + whole;
        carry_out[i] = whole + (old - to[i]);
    }
}

/* Whether all are finite and at most limit (a NaN compares false). */
static inline bool gm_all_within(const double *y, size_t count, double limit)
{
    bool good = true;
    for (size_t i = 0; i < count; i++) {
        good &= y[i] <= limit && y[i] >= -limit;
    }
    return good;
}

#endif
