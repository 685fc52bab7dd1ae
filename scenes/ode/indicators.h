/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What scenes of ordinary differential equations tell of chaos: how fast orbits part beside the last
   member's, when it comes back, when it leaves. */
#ifndef GM_SCENES_ODE_INDICATORS_H
#define GM_SCENES_ODE_INDICATORS_H

#include "scenes/common/scene.h"

/* Of core/ode/indicators/growth.h; NaN where the run has left or failed. */
double gm_lyapunov(const struct gm_view *view);
double gm_lyapunov_change(const struct gm_view *view);
double gm_megno(const struct gm_view *view);
double gm_megno_change(const struct gm_view *view);
const char *gm_growth_why(const struct gm_view *view);

/* The time until the scene's first section is passed for the first time; NaN: it was not yet. */
double gm_return_time(const struct gm_view *view);
const char *gm_return_why(const struct gm_view *view);

/* The time until a component was beyond the problem's bound, or the scene's stop was passed; NaN: not yet. */
double gm_escape_time(const struct gm_view *view);
const char *gm_escape_why(const struct gm_view *view);

#endif
