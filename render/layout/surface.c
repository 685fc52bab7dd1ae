/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The map from an axis to the surface, and overlaps of boxes. */
#include "render/layout/panel.h"

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

double gm_axes_x(const struct gm_axes *axes, double value)
{
    return frame_coordinate(&axes->panel->x, axes->x_origin, axes->x_factor, value);
}

double gm_axes_y(const struct gm_axes *axes, double value)
{
    return frame_coordinate(&axes->panel->y, axes->y_origin, axes->y_factor, value);
}

/* Rounds towards zero, within the bounds; NaN becomes the lower one. */
static int clamp(double value, int low, int high)
{
    return value > low ? (value < high ? (int)value : high) : low;
}

double gm_image_value(const struct gm_mark *mark, double u, double v)
{
    const double across = u * (double)mark->columns - 0.5, up = v * (double)mark->rows - 0.5;
    const int last_column = (int)mark->columns - 1, last_row = (int)mark->rows - 1;
    const int left = clamp(across, 0, last_column), below = clamp(up, 0, last_row);
    const int right = left < last_column ? left + 1 : left, above = below < last_row ? below + 1 : below;
    const double s = fmin(fmax(across - left, 0.0), 1.0), t = fmin(fmax(up - below, 0.0), 1.0);
    const double *low = mark->values + (size_t)below * mark->columns;
    const double *high = mark->values + (size_t)above * mark->columns;
    return (1.0 - t) * ((1.0 - s) * low[left] + s * low[right]) +
           t * ((1.0 - s) * high[left] + s * high[right]);
}

bool gm_boxes_overlap(const struct gm_box *a, const struct gm_box *b, double air)
{
    const double touch = 1e-6;
    return a->width > 0.0 && b->width > 0.0 && a->x < b->x + b->width + air && b->x < a->x + a->width + air &&
           a->y < b->y + b->height - touch && b->y < a->y + a->height - touch;
}
