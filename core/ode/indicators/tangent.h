/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The derivative of a scheme's step, applied to a vector that is carried along an orbit: the change of a
   small error in a step. It reads the run's states, and changes none of them. */
#ifndef GM_CORE_ODE_INDICATORS_TANGENT_H
#define GM_CORE_ODE_INDICATORS_TANGENT_H

#include "core/run.h"

/* Returns how the derivative of a scheme's step is computed: "exact" if theory has the scheme's coefficients,
   whose stages are varied; "differences" between neighbouring steps; "none" if a library stores the scheme's
   memory. */
const char *gm_tangent_word(const struct gm_scheme *scheme);

/* Vectors along a run of one member. Not to be shared between threads. */
struct gm_tangent;

/* Opens vectors at the current state of the run, which outlives it; the problem has no passive block, and
   the scheme's word is not "none". Without a Jacobian, or with too large a one, differences are used. Returns
   NULL when out of memory. */
struct gm_tangent *gm_tangent_open(struct gm_run *run);
void gm_tangent_close(void *tangent);

/* Returns the length of a vector: the state and the scheme's memory. */
size_t gm_tangent_size(const struct gm_tangent *tangent);

/* Returns the units of the state's components, in which its numbers are of similar size: 1, but for the momenta of
   bodies that attract each other: there the mass over the time step. */
const double *gm_tangent_units(const struct gm_tangent *tangent);

/* Completes v, whose part of the state is given, by the derivative of the scheme's initial memory. The run is
   at its start. Returns false if the run cannot start, or when out of memory. */
bool gm_tangent_begin(struct gm_tangent *tangent, double *v);

/* Makes one step of the run, with v := its derivative times v, also through events (S of core/events.h), for `count`
   vectors one after the other in v. Returns false, with v undefined, if the run or a step beside it failed; the run
   holds the reason if its own step failed. */
bool gm_tangent_step(struct gm_tangent *tangent, double *v, size_t count);

/* From here on steps also follow ln |det| of the exact motion along the run: the integral of div f over their parts, by
   Simpson's rule with the state after half of the scheme's step, and ln |det S| of events and breaks (core/events.h).
   `square` is the caller's, n * n numbers of scratch. */
void gm_tangent_follow_volume(struct gm_tangent *tangent, double *square);
/* Returns it; NaN if the problem has no Jacobian. */
double gm_tangent_volume(const struct gm_tangent *tangent);

/* Makes vector k, of `size` numbers each, orthogonal in its first n to the k unit vectors before it, twice against
   round-off, and of length 1. Returns the square of the length that was left. A vector of which only round-off was left
   was mapped to 0, and becomes 0. */
double gm_tangent_orthonormalise(double *vectors, size_t k, size_t n, size_t size);

/* Returns true if a step failed since the motion only touched the surface of an event. */
bool gm_tangent_grazes(const struct gm_tangent *tangent);

/* The run's time after a step, and the factor by which v has grown. */
struct gm_stretch {
    double t, length;
};

/* Makes `steps` steps of the run; after each, v is scaled so that its part of the state has length 1. Returns
   the number of steps made, fewer if one failed or v has no direction any more. If the stages reproduce the
   scheme to the last bit, the run makes its steps at once. */
size_t gm_tangent_advance(struct gm_tangent *tangent, double *v, size_t steps, struct gm_stretch *made);

#endif
