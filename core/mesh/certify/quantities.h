/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_CERTIFY_QUANTITIES_H
#define GM_CORE_MESH_CERTIFY_QUANTITIES_H

#include "core/quantity.h"

/* At the nodes between the ends: the field u, their places x, and the velocities of both, u_dot (following
   the node) and x_dot. */
size_t gm_mesh_quantities(const struct gm_run *run, struct gm_quantity *quantities);

#endif
