/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Observables of a room that are formulas of the forms of its flow: psi, a 0-form; w, the vorticity, and its walls' part
   with it, a dual 2-form; u = -star d psi, a dual 1-form; scalar and temperature, 0-forms. */
#ifndef GM_CORE_FLOW_OBSERVED_H
#define GM_CORE_FLOW_OBSERVED_H

#include "core/flow/flow.h"
#include "core/flow/room.h"

struct gm_flow_forms;

/* Called in a body of the arena, which outlives the flow's complex. */
struct gm_flow_forms *gm_flow_forms_open(struct gm_arena *arena, const struct gm_room *room,
                                         const struct gm_flow *flow);

/* The value of a root of room->observed at a state and a time of the flow. */
double gm_flow_observed(struct gm_flow_forms *forms, const double *y, double t, size_t root);

#endif
