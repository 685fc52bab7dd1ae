/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_BURGERS_DRAW_H
#define GM_SCENES_FIELD_BURGERS_DRAW_H

#include "core/field/families/burgers.h"
#include "scenes/field/moving_frame.h"

/* The pictures of scenes/field/burgers.c, and its parameters. */

struct gm_burgers_scene {
    struct gm_timing timing;
    struct gm_burgers burgers;
    double dx, courant, offset, at;
    int show;
};

void gm_burgers_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

#endif
