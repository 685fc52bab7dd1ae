/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_META_H
#define GM_APP_DATA_META_H

#include <stdio.h>

#include "scenes/common/lane.h"

/* What was run, as JSON. */

/* {"key":value,...}: every parameter of the lane, those at their defaults too, and of its scheme. */
void gm_meta_parameters(FILE *stream, const struct gm_lane *lane);

/* ,"system":TEXT or ,"room":TEXT: what the scene was made of, where it was made of a text. */
void gm_meta_source(FILE *stream, const struct gm_scene *scene);

/* {"scene":...}: scene, scheme, parameters, how it ended (a status word and a sentence), t, steps, version,
   and the unit of time, the only one that there is; malloc'ed, NULL when memory is short. */
char *gm_meta_text(const struct gm_lane *lane, const char *status, const char *sentence);

#endif
