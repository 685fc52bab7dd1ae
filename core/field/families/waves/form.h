/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_WAVES_FORM_H
#define GM_CORE_FIELD_FAMILIES_WAVES_FORM_H

#include "core/field/field.h"

/* gm_family.form of the schemes for u_tt - u_xx + V'(u) = 0 whose rows are struct gm_two_step_row. */
double gm_wave_form(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                    const double *y, const double *memory, bool by_differences);

#endif
