/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A state on a moving mesh by names. */
#include <stdio.h>

#include "core/basics.h"
#include "core/mesh/moving_mesh.h"
#include "core/quantity.h"
#include "core/run.h"

/* At the nodes between the ends: the field u, their places x, and the velocities of both, u_dot (following
   the node) and x_dot; of nodes alone the places and their velocities. */
size_t gm_mesh_quantities(const struct gm_run *run, struct gm_quantity *quantities)
{
    static const char *const names[] = {"u", "x", "u_dot", "x_dot"};
    const struct gm_mesh mesh = gm_mesh_of_problem(run->problem);
    const size_t apart = mesh.alone ? 2 : 1, count = GM_COUNT(names) / apart;
    for (size_t i = 0; i < count; i++) {
        const size_t name = mesh.alone ? 2 * i + 1 : i;
        quantities[i] = (struct gm_quantity){.support = GM_ON_NODES,
                                             .count = mesh.points,
                                             .width = 1,
                                             .first = i * mesh.points,
                                             .axis = name == 1};
        snprintf(quantities[i].name, sizeof quantities->name, "%s", names[name]);
    }
    return count;
}
