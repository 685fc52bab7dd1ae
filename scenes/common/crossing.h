/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_CROSSING_H
#define GM_SCENES_COMMON_CROSSING_H

#include "scenes/common/scene.h"

/* Where in the last step of a view's run `value` passed 0, as the fraction of the step that ends there, just
   beyond: the step is made again by its scheme, shorter, so that the place is as good as the scheme is.
   `state` (n * m) is where that leads. NaN where the step cannot be made again (gm_run_repeats), `value` is
   of one sign, or memory is short. The step that was made has to begin where the caller was last. */
double gm_crossing_find(const struct gm_view *view, double (*value)(const struct gm_view *view),
                        double *state);

#endif
