/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The observables of somebody's system. */
#ifndef GM_SCENES_ODE_SYSTEM_OBSERVED_H
#define GM_SCENES_ODE_SYSTEM_OBSERVED_H

#include "scenes/ode/system/look.h"

/* Makes them; false, with a sentence or where memory was refused. */
bool gm_system_make_observables(struct gm_system_scene *system_scene, const struct gm_problem *problem,
                                char *sentence);

/* Whether the solution that the file tells begins where the system does; else a sentence. */
bool gm_system_check_exact(struct gm_system_scene *system_scene, const struct gm_problem *problem,
                           char *sentence);

/* What ends a run where it changes sign, at a view and at `count` other states of it: struct gm_scene, stops. */
double gm_system_stop(const struct gm_view *view);
void gm_system_stops(const struct gm_view *view, const double *states, const double *times, size_t count,
                     double *values);

#endif
