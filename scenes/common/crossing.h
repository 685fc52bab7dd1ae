/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_CROSSING_H
#define GM_SCENES_COMMON_CROSSING_H

#include "scenes/common/scene.h"

/* Finds the place in the last step of a view's run at which `value` passes 0. Returns the fraction of the
   step that ends just beyond; `state` (n * m) is the state there. The scheme repeats its step, shorter, so
   the place has the scheme's accuracy. Returns NaN if the step cannot be repeated (gm_run_repeats), `value`
   does not change its sign, or when out of memory. The step must have begun at the caller's last state. */
double gm_crossing_find(const struct gm_view *view, double (*value)(const struct gm_view *view),
                        double *state);

#endif
