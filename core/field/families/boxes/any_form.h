/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_BOXES_ANY_FORM_H
#define GM_CORE_FIELD_FAMILIES_BOXES_ANY_FORM_H

#include "core/field/families/boxes/collocation.h"

/* s at the stages of the cells, [(component * r + stage) * points + cell], as a memory of the family has them. The
   scheme's coefficients are a gm_collocation_tableau. */
const double *gm_any_form_stages(const double *memory);

/* The integral of a density of s and the slopes of the state's components, by Gauss's rule at the stages of the
   cells; NaN where memory is short, or is NULL. */
double gm_any_form_integral(const struct gm_problem *problem, const struct gm_scheme *scheme,
                            const double *memory,
                            double (*density)(const struct gm_problem *problem, const double *s,
                                              const double *slope));

#endif
