/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The derivative of a scheme's own step, applied to a vector that is carried along an orbit: what becomes of
   a small error in a step. It looks at the run's states, and changes none of them. */
#ifndef GM_CORE_ODE_INDICATORS_TANGENT_H
#define GM_CORE_ODE_INDICATORS_TANGENT_H

#include "core/run.h"

/* How the derivative of a scheme's step is found: "exact" where theory knows the scheme by its coefficients,
   whose stages are varied; "differences" between two steps beside each other; "none" where what it remembers
   lies with a library. */
const char *gm_tangent_word(const struct gm_scheme *scheme);

/* A vector along a run of one member. Not to be shared between threads. */
struct gm_tangent;

/* At the present state of the run, which outlives it; the problem has no passive block, and the scheme's word
   is not "none". NULL: out of memory. Where the problem has no Jacobian, or too large a one, differences are
   taken too. */
struct gm_tangent *gm_tangent_open(struct gm_run *run);
void gm_tangent_close(struct gm_tangent *tangent);

/* How many numbers a vector has: those of the state and of the scheme's memory. */
size_t gm_tangent_size(const struct gm_tangent *tangent);

/* Completes v, whose part of the state is given, by how what the scheme remembers at the start differs beside
   it. The run is at its start. False where there is no start, or memory is short. */
bool gm_tangent_begin(struct gm_tangent *tangent, double *v);

/* One step of the run, with v := its derivative times v. False, with v undefined, where the run failed, or a
   step beside it; the run then says why, if it was its own. */
bool gm_tangent_step(struct gm_tangent *tangent, double *v);

/* After a step: the run's time, and by how much v has grown. */
struct gm_stretch {
    double t, length;
};

/* So many steps of the run, with v given the length 1 after each, that of its part of the state. Returns how
   many were made, fewer where one failed as above, or where v is no direction any more. Where the stages lead
   from step to step as the scheme does, to the last bit, the run makes its steps at once. */
size_t gm_tangent_advance(struct gm_tangent *tangent, double *v, size_t steps, struct gm_stretch *made);

#endif
