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
#include "core/ode_scheme_texts.h"

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

#define SPLITTING .family = &gm_family_bracket_splitting, .needs = GM_NEEDS_PIECES

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_bracket_splitting2, .coefficients = &gm_composition_none, SPLITTING},
    {GM_TEXTS_bracket_splitting4, .coefficients = &gm_composition_suzuki4, SPLITTING},
    {GM_TEXTS_bracket_splitting6, .coefficients = &gm_composition_kahan_li6, SPLITTING},
};

const struct gm_family gm_family_bracket_splitting = {
    .title = "bracket splitting",
    GM_MEMBERS(.step = step),
};
