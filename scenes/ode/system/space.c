/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A user-defined system in space: its surfaces with axes through them, or the box of its range. */
#include "scenes/ode/system/parts.h"

#include <math.h>
#include <string.h>

void gm_system_take_surfaces(struct gm_picture *picture, const struct gm_lane *lane, struct gm_space *space)
{
    const struct gm_system_lane *parameters = lane->parameters;
    const struct gm_tape *tape = &parameters->owner->surfaces;
    struct gm_view before = gm_lane_view(lane);
    struct gm_ellipsoid *surfaces = gm_picture_memory(picture, (tape->outputs + 1) * sizeof *surfaces);
    double sizes[3 * GM_MOST_SURFACES];
    before.state = before.start;
    before.t = before.t0;
    space->surface_count = surfaces ? tape->outputs / 3 : 0;
    space->surfaces = surfaces;
    if (space->surface_count > 0) {
        gm_system_values(tape, &before, gm_system_centre(&before), sizes);
    }
    for (size_t i = 0; i < space->surface_count; i++) {
        memcpy(surfaces[i].axes, sizes + 3 * i, sizeof surfaces[i].axes);
    }
}

/* Sets bounds that move outwards in steps of an eighth of the largest range, about; a flat range stays
   flat. */
static void set_box(struct gm_space *space, const struct gm_seen *seen)
{
    double width = 0, size = 0;
    for (size_t k = 0; k < 3; k++) {
        width = fmax(width, seen->high[k] - seen->low[k]);
        size = fmax(size, fmax(fabs(seen->low[k]), fabs(seen->high[k])));
    }
    const bool moves = width > 1e-12 * size;
    width = moves ? 1.06 * width : size > 0 ? size : 1;
    const double step = ldexp(1, ilogb(width)) / 8, margin = moves ? 0.03 * width : 0.5 * width;
    for (size_t k = 0; k < 3; k++) {
        const bool empty = seen->low[k] > seen->high[k];
        const double low = empty ? 0 : seen->low[k], high = empty ? 0 : seen->high[k];
        const bool flat = moves && high - low < 1e-9 * width;
        space->low[k] = flat ? low : step * floor((low - margin) / step);
        space->high[k] = flat ? low : step * ceil((high + margin) / step);
    }
}

struct gm_space gm_system_space(struct gm_picture *picture, struct gm_panel *panel,
                                const struct gm_lane *lane, const struct gm_seen *seen,
                                const char *const names[3])
{
    const struct gm_camera *camera = &((const struct gm_system_lane *)lane->parameters)->camera;
    struct gm_space space = {0};
    gm_system_take_surfaces(picture, lane, &space);
    set_box(&space, seen);
    gm_space_turn(&space, camera, lane->run->t - lane->t0);
    gm_space_draw_frame(picture, panel, &space, camera, seen->far, names);
    return space;
}
