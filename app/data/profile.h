/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_PROFILE_H
#define GM_APP_DATA_PROFILE_H

#include <stdio.h>

#include "core/run.h"

/* The state of a field on a line, a row of CSV a node: x, and each quantity that the nodes have. */

/* Whether the run's state is such a field. */
bool gm_profile_is_there(const struct gm_run *run);

/* "x,u,..." */
void gm_profile_columns(const struct gm_run *run, FILE *stream);

/* The rows, each beginning with `front`. False when memory is short. */
bool gm_profile_write(const struct gm_run *run, const char *front, FILE *stream);

#endif
