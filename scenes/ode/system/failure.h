/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Why a run of somebody's system could not go on. */
#ifndef GM_SCENES_ODE_SYSTEM_FAILURE_H
#define GM_SCENES_ODE_SYSTEM_FAILURE_H

#include "scenes/common/scene.h"

/* What is wrong at the view's last state, or on the way to the next one; "" where nothing is found. */
void gm_system_tell_failure(const struct gm_view *view, char *text, size_t size);

#endif
