/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How fast orbits part that begin beside one another: the largest Lyapunov exponent and MEGNO of what a
   scheme makes of a problem, by the derivatives of its own steps (tangent.h). */
#ifndef GM_CORE_ODE_INDICATORS_GROWTH_H
#define GM_CORE_ODE_INDICATORS_GROWTH_H

#include "core/run.h"

/* An orbit and a vector along it: a run of its own, so that looking at it changes no other. */
struct gm_growth;

/* What is told after the time t with |v| = d(t), where s is the time since the start:
       exponent   ln(d(t) / d(0)) / t
       megno      (1/t) int_0^t Y(s) ds,   Y(t) = (2/t) int_0^t s d'(s)/d(s) ds
   MEGNO is 2 on a regular orbit (0 on one whose neighbours do not part at all, as of an oscillator), and
   grows as t times half of the exponent on a chaotic one. P.M. Cincotta, C.M. Giordano & C. Simo, Physica D
   182 (2003) 151; G. Benettin, L. Galgani & J.-M. Strelcyn, Phys. Rev. A 14 (1976) 2338. */
struct gm_growth_values {
    double exponent, megno;
    double exponent_change, megno_change; /* since half of the steps, or since the last record before that */
};

/* From the state y0 (n, of one member, without its passive block) at t0. The vector begins in a fixed
   direction, none of it in that of a time that the system carries. `problem` need not outlive it, but for what it points to. NULL: out of memory. */
struct gm_growth *gm_growth_open(const struct gm_problem *problem, const struct gm_scheme *scheme,
                                 const struct gm_settings *settings, double t0, double dt, const double *y0);
void gm_growth_close(struct gm_growth *growth);

/* Goes on until so many steps are made in all; it goes back to none. False where the orbit, or one beside it,
   comes to no number before. */
bool gm_growth_to(struct gm_growth *growth, int64_t steps);

/* The state to which it came, n numbers, after so many steps. */
const double *gm_growth_state(const struct gm_growth *growth);
int64_t gm_growth_steps(const struct gm_growth *growth);

/* NaN while no time has passed. */
struct gm_growth_values gm_growth_values(const struct gm_growth *growth);

#endif
