/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The observables that every scene of ordinary differential equations computes on request. */
#ifndef GM_SCENES_ODE_SYSTEM_OPTIONAL_H
#define GM_SCENES_ODE_SYSTEM_OPTIONAL_H

#include "scenes/common/lane.h"

/* First the errors of H + dt H_1 + ... up to dt^2, dt^4, dt^6, of the last member, on the scale of the scene's energy
   error; then indicators of chaos (core/ode/indicators/growth.h), of a return and an escape, what invariants cost, and
   the volume, the last of which a hook may have; after those of every scene the action of a ring of members, the edge
   of a disc, of systems with momenta: the sum over k of the closed integral of p_k dq_k, Poincare's invariant. Its
   error is A / A(0) - 1; with friction -c p, A / (A(0) exp(-c t)) - 1; if A(0) = 0, A divided by the sum of the
   magnitudes of the integrals. Its resolution is the share of waves of a quarter of the points and more: above 1e-3 the
   ring is not resolved; below, the waves that the points miss change the action by a few times this share at most. */
enum {
    GM_MODIFIED_OBSERVABLES = 3,
    GM_INDICATORS = 10,
    GM_RING_OBSERVABLES = 3,
    GM_ODE_ASKED = GM_MODIFIED_OBSERVABLES + GM_INDICATORS
};
extern const struct gm_observable gm_ode_asked[GM_ODE_ASKED + GM_RING_OBSERVABLES];

/* Gives a scene of n components these rows, and those of the Lyapunov spectrum if n is at most GM_NEWTON_LARGEST; in a
   body of the arena. */
void gm_ode_ask(struct gm_arena *arena, struct gm_scene *scene, const struct gm_observable *rows,
                size_t count, size_t n);

/* The signed area within the ring of members, of a plane; NaN without a ring or if its points do not resolve it, and the
   reason. The last member, in the centre, does not belong to it. */
double gm_ring_area(const struct gm_view *view);
const char *gm_ring_why(const struct gm_view *view);

/* The choice of a scene's parameter `show` whose picture is gm_draw_modified. */
#define GM_SHOW_MODIFIED "modified"
/* Returns the number of errors to show, all or 0: gm_scene.asked_shown. */
size_t gm_modified_shown(const struct gm_scene *scene, const void *parameters);

/* Draws a picture without states: for every lane the errors of H and of its modifications, in one graph. Returns false if
   the lanes show another one. */
bool gm_draw_modified(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

#endif
