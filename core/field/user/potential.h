/* SPDX-License-Identifier: GPL-3.0-or-later */
/* u_tt = u_xx - V'(u) with a potential that somebody wrote. */
#ifndef GM_CORE_FIELD_USER_POTENTIAL_H
#define GM_CORE_FIELD_USER_POTENTIAL_H

#include "core/field/field.h"
#include "core/model/potential.h"

/* The problem with these values of all variables (gm_equations_start); the caller sets line and n, as of
   gm_problem_wave. False where memory was refused. To be closed in both cases. */
bool gm_user_wave_open(struct gm_problem *problem, const struct gm_user_wave *wave, const double *values);
void gm_user_wave_close(struct gm_problem *problem);

/* The exact solution as the file tells it; NaN where it does not. */
double gm_user_wave_exact(const struct gm_problem *problem, double x, double t);

/* Writes the state of a wave problem: the level at t = 0, and that at `gap`, which is the exact one where
   that is told. */
void gm_user_wave_levels(const struct gm_problem *problem, double gap, double *y);

/* Whether the field closes on the problem's line: it is finite everywhere; u at one end is that at the other,
   further by the jump, but for a thousandth of its range; and V' is the same further by the jump. Between walls nothing
   closes, and there is no jump. A sentence if not. */
bool gm_user_wave_closes(const struct gm_problem *problem, const char *name, char *sentence, size_t size);

#endif
