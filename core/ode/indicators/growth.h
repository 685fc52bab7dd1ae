/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The separation of neighbouring orbits: the Lyapunov exponents and MEGNO of a scheme's solution of a problem,
   and the volume between them, from the derivatives of the scheme's steps (tangent.h). */
#ifndef GM_CORE_ODE_INDICATORS_GROWTH_H
#define GM_CORE_ODE_INDICATORS_GROWTH_H

#include "core/run.h"

/* An orbit and a vector along it, or as many as span the space, with a separate run: other runs do not change. */
struct gm_growth;

/* The indicators after the time t with |v| = d(t), where s is the time since the start:
       exponent   ln(d(t) / d(0)) / t
       megno      (1/t) int_0^t Y(s) ds,   Y(t) = (2/t) int_0^t s d'(s)/d(s) ds
   MEGNO is 2 on a regular orbit (0 if its neighbours do not separate, as for an oscillator), and grows as t
   times half of the exponent on a chaotic one. P.M. Cincotta, C.M. Giordano & C. Simo, Physica D
   182 (2003) 151; G. Benettin, L. Galgani & J.-M. Strelcyn, Phys. Rev. A 14 (1976) 2338.
   With all vectors also:
       log_volume   ln |det D y_t/D y_0| of the scheme's map
       divergence   the same of the exact motion along its solution (gm_tangent_volume)
   The determinant is a product over the steps, each of the lengths that make the moved vectors orthonormal again.
   G. Benettin, L. Galgani, A. Giorgilli & J.-M. Strelcyn, Meccanica 15 (1980) 9. */
struct gm_growth_values {
    double exponent, megno;
    double exponent_change,
        megno_change; /* the change since half of the steps, or since the last record before that */
    double log_volume, divergence;
    double time; /* since the start */
};

/* Starts at the state y0 (n, one member, without its passive block) at t0. The vector starts in a fixed
   direction, without a part along a time component. `problem` may be freed, the data that it points to may
   not. Returns NULL when out of memory. */
struct gm_growth *gm_growth_open(const struct gm_problem *problem, const struct gm_scheme *scheme,
                                 const struct gm_settings *settings, double t0, double dt, const double *y0);
void gm_growth_close(struct gm_growth *growth);

/* Follows n vectors instead of one, at first the axes, from the start on. Returns false when out of memory. */
bool gm_growth_follow_all(struct gm_growth *growth);

/* Advances to `steps` steps in all; never back. Returns NULL, or the reason if the orbit or a neighbour stops before. */
const char *gm_growth_to(struct gm_growth *growth, int64_t steps);

/* Returns the run along the orbit. */
const struct gm_run *gm_growth_run(const struct gm_growth *growth);

/* Returns the indicators; NaN while no time has passed. */
struct gm_growth_values gm_growth_values(const struct gm_growth *growth);

/* Writes the exponents of all vectors, in descending order, and returns their number. Their sum is the mean of
   ln |det M| of the steps. */
size_t gm_growth_exponents(const struct gm_growth *growth, double *exponents);

#endif
