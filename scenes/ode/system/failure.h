/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reason that a run of a user-defined system failed. */
#ifndef GM_SCENES_ODE_SYSTEM_FAILURE_H
#define GM_SCENES_ODE_SYSTEM_FAILURE_H

#include "scenes/common/scene.h"

/* Writes the fault at the view's last state or before the next one; "" if none is found. */
void gm_system_tell_failure(const struct gm_view *view, char *text, size_t size);

#endif
