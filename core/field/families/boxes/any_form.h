/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_BOXES_ANY_FORM_H
#define GM_CORE_FIELD_FAMILIES_BOXES_ANY_FORM_H

#include "core/field/families/boxes/collocation.h"

/* s at the stages of the cells, [(component * r + stage) * points + cell], to be freed: as the memory has them; without
   one, as a run with steps dt starts from the nodes y. The scheme's coefficients are a gm_collocation_tableau. NULL:
   memory is short. */
double *gm_any_form_stages(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                           const double *y, const double *memory);

#endif
