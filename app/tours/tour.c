/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a tour tells of its steps. */
#include "app/tours/tour.h"

#include "core/arena.h"

void gm_tour_close(struct gm_tour *tour)
{
    gm_arena_close(tour->arena);
    *tour = (struct gm_tour){0};
}

size_t gm_tour_first(const struct gm_tour *tour, size_t step)
{
    while (step > 0 && !tour->steps[step].show) {
        step--;
    }
    return step;
}

double gm_tour_begin(const struct gm_tour *tour, size_t step)
{
    if (!tour->steps[step].show) {
        return tour->steps[step - 1].until;
    }
    const struct gm_request *request = &tour->steps[step].request;
    return gm_scene_t0(request->scene, request->lanes[0].parameters);
}
