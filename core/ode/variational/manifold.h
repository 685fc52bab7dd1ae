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
    double *g, *slopes, *curvature; /* as struct gm_action says */
    double *multipliers;            /* constraints */
    double *unknowns;               /* half + constraints */
    double *right;                  /* what Newton's method for them works in */
};

/* Doubles of room, zeros at first, as gm_action_room's. */
size_t gm_manifold_scratch_size(const struct gm_problem *problem);
struct gm_manifold gm_manifold_lay(const struct gm_problem *problem, double *scratch);

/* Fills g and slopes at q; and curvature for the multipliers that are there. */
void gm_manifold_constrain(const struct gm_manifold *manifold, const double *q);

/* The velocities, in manifold->at, that belong to the state y, by Newton's method from those that are there;
   its momenta, changed along G', are made such that G v = 0. False where none are found. */
bool gm_manifold_settle(const struct gm_manifold *manifold, double *y);

/* Of m states: f = (v, p'), p' = dL/dq + F + G' multipliers, with which g'' = 0; NaN where that is not
   determined, or memory is short, which is noted. Problems with constraints are autonomous. */
void gm_manifold_field(const struct gm_problem *problem, const double *y, double *f, size_t m);

/* y := a state near to it that keeps both constraints; false where none is found or memory is short. */
bool gm_manifold_project(const struct gm_problem *problem, double *y);

/* The largest |g| and |G v| at one state; NaN as above. */
struct gm_manifold_defects {
    double constraint, hidden;
};
struct gm_manifold_defects gm_manifold_defects(const struct gm_problem *problem, const double *y);

#endif
