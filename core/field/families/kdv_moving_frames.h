/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Symmetries of the Korteweg-de Vries equation, and the moving frames that its invariant schemes step in. */
#ifndef GM_CORE_FIELD_FAMILIES_KDV_MOVING_FRAMES_H
#define GM_CORE_FIELD_FAMILIES_KDV_MOVING_FRAMES_H

#include "core/field/field.h"
#include "core/field/problems/dispersive.h"

/* A boost, then a scaling, about (t, x) = (0, 0):
       (t, x, u) -> (t, x + b t, u + b/eta)
       (t, x, u) -> (s^3 t, s x, u/s^2) */
struct gm_kdv_symmetry {
    double boost, scale;
};
struct gm_event gm_kdv_carried(const struct gm_kdv *kdv, const struct gm_kdv_symmetry *symmetry,
                               struct gm_event event);

/* Returns true if a scheme steps in a moving frame, and if it then solves a system, so that every step is
   allowed. */
bool gm_kdv_has_frames(const struct gm_scheme *scheme);
bool gm_kdv_solves(const struct gm_scheme *scheme);

/* The boosts of the frames in which a step of length k is made at all nodes, from a state of the problem.
   Returns false if the step fails, or when out of memory. The scheme has frames. */
bool gm_kdv_moving_frames(const struct gm_problem *problem, const struct gm_scheme *scheme, double k,
                          const double *y, double *boosts);

/* The defect of one step of length k under a symmetry: the step of the carried state against the carried
   step, in units of the carried u, the largest over all nodes. NaN for schemes without frames, and if a
   step is not solved. */
double gm_kdv_defect(const struct gm_problem *problem, const struct gm_scheme *scheme, double k,
                     const struct gm_kdv_symmetry *symmetry, const double *y);

#endif
