/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From an axis to the surface, and boxes that meet. */
#include "render/layout/surface.h"

#include <math.h>

static double frame_coordinate(const struct gm_axis *axis, double origin, double factor, double value)
{
    if (axis->scale == GM_LOG) {
        value = value > 0.0 ? log10(value) : -400.0;
    }
    return origin + factor * value;
}

double gm_frame_x(const struct gm_frame *frame, double value)
{
    return frame_coordinate(&frame->panel->x, frame->x_origin, frame->x_factor, value);
}

double gm_frame_y(const struct gm_frame *frame, double value)
{
    return frame_coordinate(&frame->panel->y, frame->y_origin, frame->y_factor, value);
}

bool gm_boxes_overlap(const struct gm_box *a, const struct gm_box *b, double air)
{
    const double touch = 1e-6;
    return a->width > 0.0 && b->width > 0.0 && a->x < b->x + b->width + air && b->x < a->x + a->width + air &&
           a->y < b->y + b->height - touch && b->y < a->y + a->height - touch;
}
