/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_WAVES_FORM_H
#define GM_CORE_FIELD_FAMILIES_WAVES_FORM_H

#include "core/field/multisymplectic.h"

/* Three levels of a wave problem around the last but one that a run made, as its laws need them. */
struct gm_levels {
    const double *past, *now, *next;       /* u, points each */
    const double *v_past, *v_now, *v_next; /* u_t, of a scheme that keeps it in its memory; else NULL */
};

/* The levels from the state and the memory of a scheme with a struct gm_two_step_row, by a step ahead, two
   at the start. */
struct gm_levels gm_levels_of(const struct gm_law *law);

/* gm_family.form of the schemes for u_tt - u_xx + V'(u) = 0 whose rows are struct gm_two_step_row. */
double gm_wave_form(const struct gm_law *law);

#endif
