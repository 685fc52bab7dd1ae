/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_WAVES_FORM_H
#define GM_CORE_FIELD_FAMILIES_WAVES_FORM_H

#include "core/field/multisymplectic.h"

/* gm_family.form of the schemes for u_tt - u_xx + V'(u) = 0 whose rows are struct gm_two_step_row. */
double gm_wave_form(const struct gm_law *law);

#endif
