/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_BOXES_ANY_FORM_H
#define GM_CORE_FIELD_FAMILIES_BOXES_ANY_FORM_H

#include "core/field/families/boxes/collocation.h"

extern const struct gm_collocation_tableau gm_collocation_gauss4;

/* The functions of a family of boxes; see gm_family. */
size_t gm_any_form_memory(const struct gm_problem *problem, const struct gm_scheme *scheme);
enum gm_status gm_any_form_start(const struct gm_task *task);
struct gm_progress gm_any_form_advance(const struct gm_task *task);
double gm_any_form_law(const struct gm_law *law);

/* s at the stages of the cells, [(component * r + stage) * points + cell], as a memory of the family has
   them. The scheme's coefficients are a gm_collocation_tableau. */
const double *gm_any_form_stages(const double *memory);

/* The integral of a density of s and the slopes of the state's components, with Gauss's rule at the stages
   of the cells; NaN when out of memory, or if `memory` is NULL. */
double gm_any_form_integral(const struct gm_problem *problem, const struct gm_scheme *scheme,
                            const double *memory,
                            double (*density)(const struct gm_problem *problem, const double *s,
                                              const double *slope));

#endif
