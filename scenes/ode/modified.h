/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The modified Hamiltonian that a scheme conserves, for scenes of ordinary differential equations. */
#ifndef GM_SCENES_ODE_MODIFIED_H
#define GM_SCENES_ODE_MODIFIED_H

#include "scenes/common/lane.h"

/* Errors of H + dt H_1 + ... up to dt^2, dt^4, dt^6, of the last member, on the scale of the scene's energy
   error; NaN if there are no values, and why. */
enum { GM_MODIFIED_OBSERVABLES = 3 };
double gm_modified_error_2(const struct gm_view *view);
double gm_modified_error_4(const struct gm_view *view);
double gm_modified_error_6(const struct gm_view *view);
const char *gm_modified_why(const struct gm_view *view);

/* The choice of a scene's parameter `show` whose picture is gm_draw_modified. */
#define GM_SHOW_MODIFIED "modified"
/* The parameter `show`, for a scene whose picture is all or this: member `show` of its struct. */
extern const char *const gm_modified_shows[];
#define GM_SHOW_ROW(own)                                                                                     \
    GM_CHOICE_ROW(own, show, "show", "all", gm_modified_shows,                                               \
                  "what the picture shows: all, or errors of the modified energy", .live = true)
/* Returns the number of errors to show, all or 0: gm_scene.asked_shown. */
size_t gm_modified_shown(const struct gm_scene *scene, const void *parameters);

/* Draws a picture without states: for every lane the errors of H and of its modifications, in one graph. */
void gm_draw_modified(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

#endif
