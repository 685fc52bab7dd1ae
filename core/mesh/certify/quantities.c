/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A state on a moving mesh by names. */
#include <stdio.h>

#include "core/basics.h"
#include "core/quantity.h"
#include "core/run.h"

/* At the nodes between the ends: the field u, their places x, and the velocities of both, u_dot (following
   the node) and x_dot. */
size_t gm_mesh_quantities(const struct gm_run *run, struct gm_quantity *quantities)
{
    static const char *const names[] = {"u", "x", "u_dot", "x_dot"};
    enum { COUNT = GM_COUNT(names) };
    const size_t points = run->problem->n / COUNT;
    for (size_t i = 0; i < COUNT; i++) {
        quantities[i] = (struct gm_quantity){
            .support = GM_ON_NODES, .count = points, .width = 1, .first = i * points, .axis = i == 1 ? 1 : 0};
        snprintf(quantities[i].name, sizeof quantities->name, "%s", names[i]);
    }
    return COUNT;
}
