/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_FAMILIES_CONTROL_H
#define GM_CORE_MESH_FAMILIES_CONTROL_H

#include "core/mesh/moving_mesh.h"
#include "core/mesh/tableau.h"

/* A row of the family. */
struct gm_control {
    enum gm_mesh_kind kind;
    const struct gm_tableau *tableau;
};

#endif
