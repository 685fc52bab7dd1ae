/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Periodic orbits of a flow, and of the map that steps of a scheme make, by Newton's method with the derivative M
   of the steps (tangent.h):
       [ M - 1   f(phi_T(y)) ] [dy]   [ y - phi_T(y) ]
       [ f(y)'   0           ] [dT] = [ 0            ]
   for a flow, of which the last row is a unit vector if a component is held; for a map only M - 1. Singular values
   below 1e-9 of the largest are left out, which gives the shortest correction in a family of orbits. C. Simo, On the
   analytical and numerical approximation of invariant manifolds, in: D. Benest & C. Froeschle, Modern Methods in
   Celestial Mechanics (1990). */
#ifndef GM_CORE_ODE_INDICATORS_PERIODIC_H
#define GM_CORE_ODE_INDICATORS_PERIODIC_H

#include "core/run.h"

enum gm_periodic_status { GM_PERIODIC_FOUND, GM_PERIODIC_NO_CONVERGENCE, GM_PERIODIC_EQUILIBRIUM };

struct gm_periodic {
    /* Given. The problem has one member, no passive block and at most GM_NEWTON_LARGEST components; the scheme fits
       it, and gm_tangent_word is not "none". */
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    const struct gm_settings *settings;
    double t0;
    bool free;           /* the period is unknown: a flow */
    bool refined;        /* steps are halved until the end changes by less than 2e-12 of the extent */
    size_t held;         /* the component that is held; SIZE_MAX: the correction is normal to f */
    size_t by_structure; /* multipliers that are 1 by the structure of the problem */
    /* A first guess, then the orbit. */
    double *start; /* n */
    double period; /* in model time */
    int64_t steps; /* in a period */
    /* Found. */
    enum gm_periodic_status status;
    double residual; /* |phi(y) - y| */
    int iterations;
    double
        *multipliers; /* the real parts of n eigenvalues of M by falling modulus, then the imaginary ones */
    size_t count;     /* their number: without the time, if that is a component; 0: no orbit was found */
    double error;     /* the error of a single multiplier */
};

/* Rates of the same state, at a time and a period later. */
struct gm_period_miss {
    size_t component;
    double t, rates[2];
};
/* Returns true unless the right side has another period, at one of several states along the motion; or when out of
   memory. */
bool gm_period_fits(const struct gm_periodic *orbit, struct gm_period_miss *miss);

/* Returns true if the motion rests at the start: f in a step of dt is below the rounding of the state. */
bool gm_start_rests(const struct gm_periodic *orbit, double dt);

/* Returns the time of the first return to the plane through y normal to f(y), in the direction of f and within half of
   the largest distance from y so far, with steps of dt. NAN if `steps` steps have none: the start is then the state after
   them, which may be next to an orbit that attracts. */
double gm_first_return(struct gm_periodic *orbit, double dt, int64_t steps);

/* Finds the orbit; returns false when out of memory. */
bool gm_periodic_find(struct gm_periodic *orbit);

/* "elliptic", "hyperbolic", "inverse hyperbolic" or "parabolic" of a map that preserves volume, else "stable",
   "unstable" or "parabolic", by the multipliers beside those of the structure. */
const char *gm_periodic_kind(const struct gm_periodic *orbit);

/* The error of multiplier i. Of k that are close to 1 beside those of the structure, which may be a root of order k + 2, it
   is that root of the error of one. */
double gm_multiplier_error(const struct gm_periodic *orbit, size_t i);

#endif
