/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_DISPERSIVE_BOX_H
#define GM_CORE_FIELD_FAMILIES_DISPERSIVE_BOX_H

#include "core/field/multisymplectic.h"

/* The box scheme for equations of first order in time, as functions of gm_family: a loop and its work, which
   gm_two_step_close closes, and the multisymplectic law. */
struct gm_progress gm_dispersive_advance(const struct gm_task *task);
void *gm_dispersive_open(const struct gm_problem *problem);
double gm_dispersive_form(const struct gm_law *law);

/* Measures the residual of the local law of mass or charge over the next step of the box in every cell. */
void gm_dispersive_content(const struct gm_law *law, void *residual);

#endif
