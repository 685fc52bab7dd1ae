/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lagrangians that are linear in the velocities. */
#ifndef GM_CORE_MODEL_ONE_FORM_H
#define GM_CORE_MODEL_ONE_FORM_H

#include "core/model/system.h"

/* True if d2L/dv2 = 0 is proved for all values of the parameters, where system->energy is L. Inside a body of the
   system's arena; the graph does not grow. */
bool gm_one_form_is_in(struct gm_user_system *system);

/* Derives theta, Omega, its Pfaffian and the bracket of a system with theta, and replaces L by H; adds a line `stop:` to
   a file without one, where the Pfaffian becomes 0. Inside a body of the system's arena, which is left with a fault for
   an odd number of coordinates, or for too many. */
void gm_one_form_derive(struct gm_user_system *system);

/* Replaces the velocities in the formulas of all lines by the rates. Inside a body of the system's arena. */
void gm_one_form_replace_velocities(struct gm_user_system *system);

#endif
