/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ring of members, the edge of a disc, as a closed curve in phase space. The last member, in the centre, does
   not belong to it. All are NaN without a ring or if its points do not resolve it, but for the resolution. */
#ifndef GM_SCENES_ODE_SYSTEM_RING_H
#define GM_SCENES_ODE_SYSTEM_RING_H

#include "scenes/common/scene.h"

/* The signed area within the ring, of a plane. */
double gm_ring_area(const struct gm_view *view);

/* The action, sum over k of the closed integral of p_k dq_k: Poincare's invariant of canonical and Lagrangian
   systems. Its error is A / A(0) - 1; with friction -c p, A / (A(0) exp(-c t)) - 1; if A(0) = 0, A divided by the
   sum of the magnitudes of the integrals. */
double gm_ring_action(const struct gm_view *view);
double gm_ring_action_error(const struct gm_view *view);
/* The share of waves of a quarter of the points and more in the action. Above 1e-3 the ring is not resolved; below, the
   waves that the points miss change the action by a few times this share at most. */
double gm_ring_resolution(const struct gm_view *view);

/* Return the reason for NaN. */
const char *gm_ring_why(const struct gm_view *view);
const char *gm_ring_error_why(const struct gm_view *view);

#endif
