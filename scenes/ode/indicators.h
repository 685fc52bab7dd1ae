/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Indicators of chaos of ordinary differential equations: the growth of distances and of the volume beside the last
   member's orbit, the time of its return, the time of its escape. */
#ifndef GM_SCENES_ODE_INDICATORS_H
#define GM_SCENES_ODE_INDICATORS_H

#include "scenes/common/scene.h"

/* Return the values of core/ode/indicators/growth.h; NaN after an escape or a failure. */
double gm_lyapunov(const struct gm_view *view);
double gm_lyapunov_change(const struct gm_view *view);
double gm_megno(const struct gm_view *view);
double gm_megno_change(const struct gm_view *view);
const char *gm_growth_why(const struct gm_view *view);

/* Return ln |det D y_t/D y_0| of the scheme's map, of at most GM_NEWTON_LARGEST components; and
   |det D y_t/D y_0| / exp(integral of div f along the computed motion) - 1. */
double gm_log_volume(const struct gm_view *view);
double gm_volume_error(const struct gm_view *view);
const char *gm_volume_why(const struct gm_view *view);

/* Return the length of the move that projected(...) made in the last step, and gamma - 1 of relaxed(...). */
double gm_projection(const struct gm_view *view);
const char *gm_projection_why(const struct gm_view *view);
double gm_relaxation(const struct gm_view *view);
const char *gm_relaxation_why(const struct gm_view *view);

/* Returns the time until the scene's first section is first passed; NaN: not yet. */
double gm_return_time(const struct gm_view *view);
const char *gm_return_why(const struct gm_view *view);

/* Returns the time until a component exceeds the problem's bound, or the scene's stop is passed; NaN: not
   yet. */
double gm_escape_time(const struct gm_view *view);
const char *gm_escape_why(const struct gm_view *view);

#endif
