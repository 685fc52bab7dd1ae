/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steps of equal cost: dt of each lane so that all evaluate equally often. */
#include "app/request/equal_cost.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Evaluations per model time over the first steps; NAN with a sentence if there are none. */
static double rate_of(const struct gm_request *request, size_t index, char *message)
{
    enum { STEPS = 32 };
    struct gm_lane *lane = gm_request_open_lane(request, index, message);
    if (!lane) {
        return NAN;
    }
    /* starting a scheme with memory may cost evaluations that no later step does */
    gm_run_advance(lane->run, 1);
    const unsigned long before = lane->run->evaluations;
    const double t = lane->run->t;
    gm_run_advance(lane->run, STEPS);
    const double rate = (double)(lane->run->evaluations - before) / fabs(lane->run->t - t);
    if (!(rate > 0) || !isfinite(rate)) {
        snprintf(message, GM_MESSAGE,
                 "equal=cost compares evaluations, and %s counts none over its first %d steps",
                 lane->scheme->name, STEPS);
    }
    gm_lane_close(lane);
    return rate > 0 && isfinite(rate) ? rate : NAN;
}

bool gm_equal_cost(struct gm_request *request, size_t index, size_t like, char *message)
{
    struct gm_lane_spec *spec = &request->lanes[index];
    struct gm_timing *timing = spec->parameters;
    const struct gm_parameter *row = gm_scene_parameter(request->scene, "dt");
    const double wanted = rate_of(request, like, message);
    /* an implicit scheme's evaluations a step depend on the step */
    enum { ROUNDS = 4 };
    for (int round = 0; round < ROUNDS && index != like; round++) {
        const double rate = rate_of(request, index, message);
        if (isnan(rate) || isnan(wanted)) {
            return false;
        }
        timing->dt *= rate / wanted;
        if (!(timing->dt >= row->lowest && timing->dt <= row->highest)) {
            snprintf(message, GM_MESSAGE, "equal=cost asks for dt = %.3g of %s, which lies beyond %g to %g",
                     timing->dt, spec->scheme->name, row->lowest, row->highest);
            return false;
        }
    }
    struct gm_shown *shown = &spec->shown;
    char *name = shown->colour_name[0] ? shown->colour_name : shown->panel_name;
    const size_t size = shown->colour_name[0] ? sizeof shown->colour_name : sizeof shown->panel_name;
    char text[sizeof shown->panel_name];
    const int length =
        snprintf(text, sizeof text, "%s, Δt %.3g", name[0] ? name : spec->scheme->title, timing->dt);
    if (length > 0 && (size_t)length < size) { /* else the name alone says more than half of both */
        memcpy(name, text, (size_t)length + 1);
    }
    return !isnan(wanted);
}
