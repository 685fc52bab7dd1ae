/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Wave equations u_tt - u_xx + V'(u) = 0: sine-Gordon, and the linear one. */
#ifndef GM_CORE_FIELD_PROBLEMS_WAVE_H
#define GM_CORE_FIELD_PROBLEMS_WAVE_H

#include "core/field/field.h"

/* u_tt - u_xx + V'(u) = 0, V = -cos u or V = 0: the caller sets line and n = gm_wave_size(line.points). */
extern const struct gm_problem gm_problem_sine_gordon, gm_problem_wave;

/* The form of every wave equation, in s = (u, u_t, u_x). */
extern const struct gm_form gm_form_of_waves;

#endif
