/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MODEL_DECLARATIONS_H
#define GM_CORE_MODEL_DECLARATIONS_H

#include "core/model/scope.h"

/* The declarations of a system, read in this order: each needs the earlier ones. */

/* Finds the kind of the system, and checks that every line belongs to it. */
void gm_declared_kind(struct gm_reading *reading);
/* Finds the lets with arguments, which every formula may call. */
void gm_declared_functions(struct gm_reading *reading);
void gm_declared_parameters(struct gm_reading *reading);
/* Declares components, velocities and the time; the variables then have the order of struct
   gm_system_variable. */
void gm_declared_state(struct gm_reading *reading);
/* Reads the formulas of parameters in other parameters, after all have their numbers. */
void gm_declared_relations(struct gm_reading *reading);
/* Declares lets and observables, except elements of a list. */
void gm_declared_lets(struct gm_reading *reading);

#endif
