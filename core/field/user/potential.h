/* SPDX-License-Identifier: GPL-3.0-or-later */
/* u_tt = u_xx - V'(u) with a potential that somebody wrote. */
#ifndef GM_CORE_FIELD_USER_POTENTIAL_H
#define GM_CORE_FIELD_USER_POTENTIAL_H

#include "core/field/field.h"
#include "core/model/recognition.h"
#include "core/user/line.h"

/* The problem with these values of all variables (gm_equations_start) on that ring, or between walls.
   False when out of memory; the caller closes it (gm_user_line_close). */
bool gm_user_wave_open(struct gm_problem *problem, const struct gm_user_wave *wave, const double *values,
                       const struct gm_grid1 *grid);

/* Returns true if the field closes on the problem's line: it is finite everywhere; u at the ends differs
   by the jump, up to a thousandth of its range; and V' has the jump as a period. Walls need no closure and
   have no jump. Else the fault has the reason. */
bool gm_user_wave_closes(const struct gm_problem *problem, struct gm_fault *fault);

#endif
