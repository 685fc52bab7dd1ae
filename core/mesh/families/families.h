/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The families of this wing as declarations, from the list families.def. */
#ifndef GM_CORE_MESH_FAMILIES_FAMILIES_H
#define GM_CORE_MESH_FAMILIES_FAMILIES_H

#include "core/basics.h"
#include "core/mesh/equations.h"

#define GM_FAMILY(name) extern const struct gm_family gm_family_##name;
#include "core/mesh/families/families.def"
#undef GM_FAMILY

/* The common fields of all families; each adds only its array of schemes. */
#define GM_MESH_FAMILY                                                                                       \
    .kind = &gm_kind_mesh, .schemes = schemes, .count = GM_COUNT(schemes),                                   \
    .workspace_open = gm_mesh_workspace_open, .workspace_close = gm_mesh_workspace_close,                    \
    .workspace_reset = gm_mesh_workspace_reset, .memory = gm_mesh_memory, .start = gm_mesh_restart,          \
    .loop = gm_mesh_loop, .lacks = gm_mesh_lacks

#endif
