/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The three levels that the laws of a wave problem speak of, where the state holds two: a step is made
   aside. */
#include "core/field/families/waves/levels.h"

#include <math.h>
#include <stdlib.h>

#include "core/field/families/two_step.h"

void gm_levels_close(struct gm_levels *levels)
{
    free(levels->storage);
}

bool gm_levels_open(struct gm_levels *levels, const struct gm_problem *problem,
                    const struct gm_scheme *scheme, double dt, const double *y, const double *memory)
{
    const size_t points = problem->line.points, size = gm_wave_size(points);
    const struct gm_two_step_row *row = scheme->coefficients;
    const bool at_start = y[2 * points] != -dt, centred = row->law == GM_LAW_CENTRED;
    double *out = malloc((size + 2 * points) * sizeof *out);
    void *work = scheme->family->workspace_open(problem, scheme);
    const struct gm_task task = {
        .problem = problem,
        .scheme = scheme,
        .dt = dt,
        .steps = at_start ? 2 : 1,
        .limit = INFINITY,
        .y = y,
        .out = out,
        .memory = centred ? memory : NULL,
        .memory_out = centred && out ? out + size : NULL,
        .workspace = work,
    };
    const bool good = out && work && scheme->family->loop(&task).status == GM_OK;
    if (work) {
        scheme->family->workspace_close(work);
    }
    if (!good) {
        free(out);
        return false;
    }
    *levels = (struct gm_levels){
        .storage = out,
        .past = at_start ? y : y + points,
        .now = out + points,
        .next = out,
    };
    if (centred) {
        levels->v_past = at_start ? memory : memory + points;
        levels->v_now = out + size + points;
        levels->v_next = out + size;
    }
    return true;
}
