/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The named arrays of a state, from its kind. */
#include "core/quantity.h"

#include <string.h>

#include "core/arena.h"
#include "core/kind.h"
#include "core/run.h"

static void nodes(const struct gm_run *run, size_t first, double *values)
{
    (void)first;
    const struct gm_grid1 *grid = &run->problem->line;
    for (size_t i = 0; i < gm_grid1_seen(grid); i++) {
        values[i] = gm_grid1_node(grid, i);
    }
}

struct gm_quantity gm_quantity_grid(const struct gm_run *run)
{
    return (struct gm_quantity){.name = "grid",
                                .support = GM_ON_NODES,
                                .count = gm_grid1_seen(&run->problem->line),
                                .width = 1,
                                .axis = 1,
                                .fixed = true,
                                .derive = nodes};
}

size_t gm_quantities(const struct gm_run *run, struct gm_quantity *quantities)
{
    return run->problem->kind->quantities(run, quantities);
}

size_t gm_quantities_beside_time(const struct gm_run *run, bool pictures, struct gm_quantity *quantities)
{
    const size_t all = gm_quantities(run, quantities);
    size_t count = 0;
    for (size_t i = 0; i < all; i++) {
        if (strcmp(quantities[i].name, "t") != 0 &&
            quantities[i].use != (pictures ? GM_FOR_TABLES : GM_FOR_PICTURES)) {
            quantities[count++] = quantities[i];
        }
    }
    return count;
}

const char *gm_component_name(struct gm_arena *arena, const struct gm_run *run, size_t component)
{
    struct gm_quantity quantities[GM_QUANTITIES];
    const size_t count = gm_quantities(run, quantities);
    const char *name = NULL;
    for (size_t i = 0; i < count; i++) {
        const struct gm_quantity *quantity = &quantities[i];
        const size_t number = component - quantity->first;
        if (!quantity->derive && component >= quantity->first && number < quantity->count) {
            name = quantity->support == GM_ON_RUN
                       ? gm_arena_print(arena, "%s", quantity->name)
                       : gm_arena_print(arena, "%s[%zu]", quantity->name, number + 1);
        }
    }
    return name ? name : gm_arena_print(arena, "y[%zu]", component + 1);
}

size_t gm_quantity_size(const struct gm_run *run, const struct gm_quantity *quantity)
{
    return quantity->count * quantity->width * run->problem->m;
}

size_t gm_quantity_shape(const struct gm_quantity *quantity, size_t members, size_t shape[GM_QUANTITY_AXES])
{
    size_t axes = 0;
    if (quantity->support != GM_ON_RUN) {
        shape[axes++] = quantity->count;
    }
    if (members > 1) {
        shape[axes++] = members;
    }
    if (quantity->width > 1) {
        shape[axes++] = quantity->width;
    }
    return axes;
}

const double *gm_quantity_values(const struct gm_run *run, const struct gm_quantity *quantity,
                                 double *scratch)
{
    if (!quantity->derive) {
        return gm_run_state(run) + quantity->first * run->problem->m;
    }
    quantity->derive(run, quantity->first, scratch);
    return scratch;
}
