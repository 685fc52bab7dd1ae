/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From an axis to the surface, and boxes that meet. */
#include "render/layout/surface.h"

#include <math.h>

double gm_anchor_share(enum gm_anchor anchor)
{
    return anchor == GM_ANCHOR_LEFT ? 0.0 : anchor == GM_ANCHOR_CENTRE ? 0.5 : 1.0;
}

const struct gm_mark *gm_panel_field(const struct gm_panel *panel)
{
    for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
        if (mark->kind == GM_MARK_MESH || mark->kind == GM_MARK_IMAGE) {
            return mark;
        }
    }
    return NULL;
}

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
