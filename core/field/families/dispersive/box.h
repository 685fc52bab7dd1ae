/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_DISPERSIVE_BOX_H
#define GM_CORE_FIELD_FAMILIES_DISPERSIVE_BOX_H

#include "core/field/families/two_step.h"
#include "core/field/field.h"

/* The box scheme for equations of first order in time: a loop and its work, which gm_two_step_close
   closes. */
struct gm_progress gm_dispersive_advance(const struct gm_task *task);
void *gm_dispersive_open(const struct gm_problem *problem);

/* One step of the linearised scheme: the tangent at the next level, from the tangent at the current one,
   both as real parts, then imaginary ones; `base` holds the means of the solution in the cells between the
   two levels, likewise. */
enum gm_status gm_dispersive_tangent(struct gm_two_step_work *work, const struct gm_problem *problem,
                                     double dt, const double *base, const double *now, double *next);

#endif
