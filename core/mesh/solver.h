/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_SOLVER_H
#define GM_CORE_MESH_SOLVER_H

#include "core/mesh/equations.h"
#include "core/scheme.h"

/* The steps of all schemes on meshes: the same number of unknowns at every node, node by node, so that
   matrices are banded.

   The LU factors are kept over iterations and steps until they converge too slowly. They are derived data:
   what they were made from (a state and unknowns) is part of the scheme's memory, so a run that is resumed
   recomputes the same factors and continues with the same bits. First guesses are extrapolated from the last
   six steps. */

/* The functions that all families share. */
size_t gm_mesh_memory(const struct gm_problem *problem, const struct gm_scheme *scheme);
enum gm_status gm_mesh_restart(const struct gm_task *task);
/* Makes steps, in place if task->out is task->y. */
struct gm_progress gm_mesh_loop(const struct gm_task *task);
void *gm_mesh_workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme);
void gm_mesh_workspace_close(void *workspace);
void gm_mesh_workspace_reset(void *workspace);

#endif
