/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a tour tells of its steps. */
#include "app/tours/tour.h"
#include "core/basics.h"

#include <stdlib.h>

void gm_tour_close(struct gm_tour *tour)
{
    for (size_t i = 0; i < tour->count; i++) {
        struct gm_tour_step *step = &tour->steps[i];
        char *texts[] = {step->title, step->say,     step->ask,  step->answer,
                         step->watch, step->attempt, step->show, step->study_words};
        for (size_t k = 0; k < GM_COUNT(texts); k++) {
            free(texts[k]);
        }
        gm_request_close(&step->request);
        for (size_t k = 0; k < step->change_count; k++) {
            free(step->changes[k].text);
        }
        free(step->changes);
    }
    free(tour->steps);
    free(tour->name);
    free(tour->title);
    free(tour->about);
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
