/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Motion under holonomic constraints g(q) = 0: the state stays on g = 0 with velocities in its tangent,
   the hidden constraint G v = 0, G = dg/dq. */
#ifndef GM_CORE_ODE_VARIATIONAL_MANIFOLD_H
#define GM_CORE_ODE_VARIATIONAL_MANIFOLD_H

#include "core/ode/variational/action.h"

struct gm_manifold {
    struct gm_action_at action;
    size_t constraints;
    double *at;                     /* q, v, t: n */
    double *g, *slopes, *curvature; /* the values of gm_action.constrain */
    double *multipliers;            /* constraints */
    double *unknowns;               /* half + constraints */
    double *right;                  /* scratch of Newton's method for the unknowns */
};

/* Returns the scratch size in doubles, zeros at first (gm_action_room). */
size_t gm_manifold_scratch_size(const struct gm_problem *problem);
struct gm_manifold gm_manifold_lay(const struct gm_problem *problem, double *scratch);

/* Fills g and slopes at q, and curvature for the current multipliers. */
void gm_manifold_constrain(const struct gm_manifold *manifold, const double *q);

/* Finds the velocities of the state y, in manifold->at, by Newton's method from the current ones; changes the
   momenta along G' such that G v = 0. Returns false if it finds none. */
bool gm_manifold_settle(const struct gm_manifold *manifold, double *y);

/* Writes f = (v, p') of m states, p' = dL/dq + F + G' multipliers such that g'' = 0; NaN if that is not
   determined, or when out of memory, which is noted. Problems with constraints are autonomous. */
void gm_manifold_field(const struct gm_problem *problem, const double *y, double *f, size_t m);

/* y := a nearby state that satisfies both constraints; false if none is found or when out of memory. */
bool gm_manifold_project(const struct gm_problem *problem, double *y);

/* The largest |g| and |G v| at one state; NaN if gm_manifold_field gives NaN. */
struct gm_manifold_defects {
    double constraint, hidden;
};
struct gm_manifold_defects gm_manifold_defects(const struct gm_problem *problem, const double *y);

#endif
