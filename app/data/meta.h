/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_META_H
#define GM_APP_DATA_META_H

#include <stdio.h>

#include "scenes/frame/lane.h"

/* What was run, as JSON. */

/* {"key":value,...}: every parameter of the lane, those at their defaults too, and of its scheme. */
void gm_meta_parameters(FILE *stream, const struct gm_lane *lane);

/* {"scene":...}: scene, scheme, parameters, how it ended (a status word and a sentence), t, steps, version,
   what a time of 1 is, and the units of quantities that have one; malloc'ed, NULL when memory is short. */
char *gm_meta_text(const struct gm_lane *lane, const char *status, const char *sentence);

#endif
