/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Observables of a room that are formulas of the forms of its flow: psi, a 0-form; w, the vorticity with the part of
   walls, a dual 2-form; u = -star d psi, a dual 1-form; scalar and temperature, 0-forms. */
#ifndef GM_CORE_FLOW_OBSERVED_H
#define GM_CORE_FLOW_OBSERVED_H

#include "core/flow/flow.h"
#include "core/form/program.h"

struct gm_flow_forms;

/* Called in a body of the arena, which closes before the flow. `values` are those of the system's variables. */
struct gm_flow_forms *gm_flow_forms_open(struct gm_arena *arena, const struct gm_form_program *program,
                                         const struct gm_user_system *system, const double *values,
                                         const struct gm_flow *flow);

/* The value of a root of the program at a state and a time of the flow. */
double gm_flow_observed(struct gm_flow_forms *forms, const double *y, double t, size_t root);

#endif
