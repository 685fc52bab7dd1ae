/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_FAMILIES_ADVANCE_H
#define GM_CORE_MESH_FAMILIES_ADVANCE_H

#include "core/mesh/moving_mesh.h"
#include "core/mesh/solver.h"

/* What the families on meshes have in common. */

/* Solves the equations and finishes the step, task->steps times; in place if task->out is task->y. finish
   writes the end of the step over its start in `state`, and the largest multiplier. */
struct gm_progress gm_mesh_advance(const struct gm_task *task, struct gm_solver *solver,
                                   const struct gm_step_equations *equations,
                                   enum gm_status (*finish)(void *self, double *state, double *multiplier));

#endif
