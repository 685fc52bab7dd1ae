/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The families of this wing as declarations, from the list families.def. */
#ifndef GM_CORE_MESH_FAMILIES_FAMILIES_H
#define GM_CORE_MESH_FAMILIES_FAMILIES_H

#include "core/basics.h"
#include "core/mesh/equations.h"
#include "core/scheme.h"

#define GM_FAMILY(name) extern const struct gm_family gm_family_##name;
#include "core/mesh/families/families.def"
#undef GM_FAMILY

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

/* The common fields of all families; each adds only its array of schemes. */
#define GM_MESH_FAMILY                                                                                       \
    .kind = &gm_kind_mesh, .schemes = schemes, .count = GM_COUNT(schemes),                                   \
    .workspace_open = gm_mesh_workspace_open, .workspace_close = gm_mesh_workspace_close,                    \
    .workspace_reset = gm_mesh_workspace_reset, .memory = gm_mesh_memory, .start = gm_mesh_restart,          \
    .loop = gm_mesh_loop

#endif
