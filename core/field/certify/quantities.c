/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A state of a field on a line by names. */
#include <stdio.h>

#include "core/field/families/frames.h"
#include "core/quantity.h"
#include "core/run.h"

/* Returns the velocity of nodes that move with their frame of reference; 0 if they do not. */
static double speed_of(const struct gm_run *run)
{
    return gm_moving_frames_of(run->problem) && !gm_frame_rests(gm_framed_of(run->problem), run->scheme)
               ? gm_framed_of(run->problem)->lambda
               : 0;
}

/* The current places of nodes that move with a frame. */
static void places(const struct gm_run *run, size_t first, double *values)
{
    const double travelled = speed_of(run) * (run->t - gm_framed_of(run->problem)->line.begin);
    gm_quantity_grid(run).derive(run, first, values);
    for (size_t i = 0; i < run->problem->line.points; i++) {
        values[i] += travelled;
    }
}

static struct gm_quantity *add(struct gm_quantity *end, const char *name, enum gm_support support,
                               size_t count, size_t first)
{
    *end = (struct gm_quantity){.support = support, .count = count, .width = 1, .first = first};
    snprintf(end->name, sizeof end->name, "%s", name);
    return end + 1;
}

/* The field at the nodes of `grid`, and what else a state holds: u; the level of another time, u_other,
   and that time less the current one, other_time; of a complex field its parts psi_re and psi_im; of
   Burgers' equation in a moving frame the nodes' places x, and the companion u_companion. */
size_t gm_field_quantities(const struct gm_run *run, struct gm_quantity *quantities)
{
    const struct gm_problem *problem = run->problem;
    const struct gm_field *field = gm_field_of(problem);
    const size_t points = problem->line.points, seen = gm_grid1_seen(&problem->line);
    const bool burgers = field->equation == GM_NEEDS_BURGERS;
    const bool companion = burgers && gm_framed_of(problem)->lambda != 0;
    struct gm_quantity *end = quantities + 1;
    *quantities = gm_quantity_grid(run);
    if (speed_of(run) != 0) {
        snprintf(quantities->name, sizeof quantities->name, "x");
        quantities->fixed = false;
        quantities->derive = places;
    }
    if (gm_form_is_state(field->form)) {
        for (size_t c = 0; c < field->form->dimension; c++) {
            end = add(end, field->form->names[c], GM_ON_NODES, points, c * points);
        }
    } else if (field->dispersive && field->form->kept == 2) {
        end = add(end, "psi_re", GM_ON_NODES, points, 0);
        end = add(end, "psi_im", GM_ON_NODES, points, points);
    } else {
        end = add(end, "u", GM_ON_NODES, seen, 0);
    }
    if (companion) {
        end = add(end, "u_companion", GM_ON_NODES, points, points);
    }
    if (problem->n == gm_wave_size(points) && !burgers) {
        end = add(end, "u_other", GM_ON_NODES, seen, points);
        end = add(end, "other_time", GM_ON_RUN, 1, 2 * points);
    }
    return (size_t)(end - quantities);
}
