/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Common functions for making the scene of a user-defined system. */
#include "scenes/common/system/pieces.h"

#include <math.h>
#include <stdlib.h>

#include "core/model/equations.h"

size_t gm_system_count_items(const struct gm_user_system *system, enum gm_system_word word)
{
    size_t count = 0;
    while (gm_system_item_of(system, word, count)) {
        count++;
    }
    return count;
}

double *gm_system_start_values(const struct gm_system_lane *lane, const char *given)
{
    const struct gm_system_scene *system_scene = lane->owner;
    double *known = malloc(system_scene->system.variable_count * sizeof *known);
    for (size_t i = 0; known && i < system_scene->system.variable_count; i++) {
        known[i] = NAN;
    }
    for (size_t row = GM_SYSTEM_ROWS; known && row < system_scene->row_count; row++) {
        if (system_scene->variables[row] != GM_NO_VARIABLE && (!given || given[row])) {
            known[system_scene->variables[row]] = lane->values[row - GM_SYSTEM_ROWS];
        }
    }
    if (known && gm_system_is_field(&system_scene->system)) {
        const bool follows =
            given && !lane->grid.points_given && gm_system_points_follow(&system_scene->system);
        known[system_scene->system.velocities - 1] = follows ? NAN : (double)lane->grid.points;
    }
    double *values = known ? gm_equations_start(&system_scene->system, known) : NULL;
    free(known);
    return values;
}

double gm_system_half_length(const struct gm_system_lane *lane)
{
    double *values = gm_system_start_values(lane, NULL);
    const double half = values ? values[lane->owner->system.velocities - GM_RING_PARAMETERS] : NAN;
    free(values);
    return half;
}

void gm_system_open_tape(struct gm_system_scene *system_scene, struct gm_tape *tape, const gm_node_id *nodes,
                         size_t count)
{
    const size_t inputs = system_scene->system.variable_count;
    const double *unused = gm_arena_take(system_scene->arena, inputs, sizeof *unused);
    gm_tape_keep(system_scene->arena, tape,
                 gm_tape_open(tape, &system_scene->system.graph, nodes, count, inputs, unused));
}

struct gm_tape *gm_system_take_tape(struct gm_system_scene *system_scene, const gm_node_id *nodes,
                                    size_t count)
{
    struct gm_tape *tape = gm_arena_take(system_scene->arena, 1, sizeof *tape);
    gm_system_open_tape(system_scene, tape, nodes, count);
    return tape;
}

void gm_system_take_observables(struct gm_system_scene *system_scene, size_t most)
{
    system_scene->observables = gm_arena_take(system_scene->arena, most, sizeof *system_scene->observables);
    system_scene->measures = gm_arena_take(system_scene->arena, most, sizeof *system_scene->measures);
    system_scene->scene.observables = system_scene->observables;
}
