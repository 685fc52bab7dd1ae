/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_FAMILIES_DISPERSIVE_BOX_H
#define GM_FAMILIES_DISPERSIVE_BOX_H

#include "core/scheme.h"

/* The box scheme for equations of first order in time: a loop and its work, which gm_two_step_close closes.
 */
struct gm_progress gm_dispersive_advance(const struct gm_task *task);
void *gm_dispersive_open(const struct gm_problem *problem);

#endif
