/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_WAVES_LEVELS_H
#define GM_CORE_FIELD_FAMILIES_WAVES_LEVELS_H

#include "core/field/field.h"

/* Three levels of a wave problem around the last but one that a run made, as its laws need them. */
struct gm_levels {
    double *storage;
    const double *past, *now, *next;       /* u, points each */
    const double *v_past, *v_now, *v_next; /* u_t, of a scheme that keeps it in its memory; else NULL */
};

/* From the state `y` and the memory of a scheme whose row is a struct gm_two_step_row, by a step ahead, two
   at the start. False where memory is short or the step fails. */
bool gm_levels_open(struct gm_levels *levels, const struct gm_problem *problem,
                    const struct gm_scheme *scheme, double dt, const double *y, const double *memory);
void gm_levels_close(struct gm_levels *levels);

#endif
