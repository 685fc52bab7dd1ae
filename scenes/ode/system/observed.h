/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The observables of a user-defined system. */
#ifndef GM_SCENES_ODE_SYSTEM_OBSERVED_H
#define GM_SCENES_ODE_SYSTEM_OBSERVED_H

#include "scenes/common/system/look.h"

/* Makes the observables. */
void gm_system_make_observables(struct gm_system_scene *system_scene, const struct gm_problem *problem);

/* Refuses an exact solution in the file that has not the system's start. */
void gm_system_check_exact(struct gm_system_scene *system_scene, const struct gm_problem *problem);

/* A change of its sign ends a run: the value at a view and at `count` other states of it, struct gm_scene,
   stops. */
double gm_system_stop(const struct gm_view *view);
void gm_system_stops(const struct gm_view *view, const double *states, const double *times, size_t count,
                     double *values);

#endif
