/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Splitting of y' = B(y) grad H(y), H = H_1 + ... + H_s, into the exact flows F_i of the pieces, symmetric,
       F = F_1(h/2) ... F_(s-1)(h/2) F_s(h) F_(s-1)(h/2) ... F_1(h/2)
   and compositions F(g_1 h) F(g_2 h) ... of it. Each is a Poisson map, and conserves Casimirs to round-off. A
   piece depends on components that commute, and so do not move in its flow; the others follow a linear
   equation. A free rigid body splits into three rotations, a heavy top into these and its potential, coupled
   spins into rotations about the axes, hunters and their prey into two exponentials; for the bracket of
   coordinates and momenta this is Verlet's scheme. R.I. McLachlan, Phys. Rev. Lett. 71 (1993) 3043; Hairer,
   Lubich & Wanner (2006), VII.4.2. */
#include <stdlib.h>

#include "core/basics.h"
#include "core/ode/families/compositions.h"
#include "core/ode/families/families.h"
#include "core/ode/kernel/members.h"

static void palindrome(const struct gm_problem *problem, double h, double *y)
{
    const struct gm_poisson *poisson = gm_ode_of(problem)->poisson;
    const size_t last = poisson->pieces - 1;
    for (size_t piece = 0; piece < last; piece++) {
        poisson->flow(problem, piece, h / 2, y);
    }
    poisson->flow(problem, last, h, y);
    for (size_t piece = last; piece-- > 0;) {
        poisson->flow(problem, piece, h / 2, y);
    }
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct gm_composition *composition = task->scheme->coefficients;
    for (int i = 0; i < composition->steps; i++) {
        palindrome(task->problem, gm_composition_fraction(composition, i) * task->dt, members->y);
        progress->evaluations++;
    }
    return GM_OK;
}

#define SPLITTING(composition)                                                                               \
    .family = &gm_family_bracket_splitting, .coefficients = &(composition), .needs = GM_NEEDS_PIECES,        \
    .claims = GM_SYMMETRIC | GM_KEEPS_CASIMIRS | GM_POISSON_MAP

static const struct gm_scheme schemes[] = {
    {
        .name = "bracket-splitting2",
        .title = "bracket splitting",
        .formula = "F(h) = F₁(h/2) … F_s(h) … F₁(h/2),  Fᵢ the exact flow of Hᵢ,  H = H₁ + … + H_s",
        .reference =
            "R.I. McLachlan, Phys. Rev. Lett. 71 (1993) 3043; Hairer, Lubich & Wanner (2006), VII.4.2",
        SPLITTING(gm_composition_none),
        .order = 2,
    },
    {
        .name = "bracket-splitting4",
        .title = "bracket splitting, Suzuki 4",
        .formula = "F(γ₁h) … F(γ₅h),  F that of bracket-splitting2",
        .reference =
            "M. Suzuki, Phys. Lett. A 146 (1990) 319; R.I. McLachlan, Phys. Rev. Lett. 71 (1993) 3043",
        SPLITTING(gm_composition_suzuki4),
        .order = 4,
    },
    {
        .name = "bracket-splitting6",
        .title = "bracket splitting, Kahan-Li 6",
        .formula = "F(γ₁h) … F(γ₉h),  F that of bracket-splitting2",
        .reference =
            "W. Kahan & R.-C. Li, Math. Comp. 66 (1997) 1089; R.I. McLachlan, Phys. Rev. Lett. 71 (1993) 3043",
        SPLITTING(gm_composition_kahan_li6),
        .order = 6,
    },
};

const struct gm_family gm_family_bracket_splitting = {
    .title = "bracket splitting",
    GM_MEMBERS(.step = step),
};
