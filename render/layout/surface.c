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

int gm_clamp(double value, int low, int high)
{
    return value > low ? (value < high ? (int)value : high) : low;
}

double gm_image_value(const struct gm_mark *mark, double u, double v)
{
    const double across = u * (double)mark->columns - 0.5, up = v * (double)mark->rows - 0.5;
    const int last_column = (int)mark->columns - 1, last_row = (int)mark->rows - 1;
    const int left = gm_clamp(across, 0, last_column), below = gm_clamp(up, 0, last_row);
    const int right = left < last_column ? left + 1 : left, above = below < last_row ? below + 1 : below;
    const double s = fmin(fmax(across - left, 0.0), 1.0), t = fmin(fmax(up - below, 0.0), 1.0);
    const double *low = mark->values + (size_t)below * mark->columns;
    const double *high = mark->values + (size_t)above * mark->columns;
    return (1.0 - t) * ((1.0 - s) * low[left] + s * low[right]) +
           t * ((1.0 - s) * high[left] + s * high[right]);
}

struct corner {
    double x, y, value, light; /* x and y in pixels */
};

/* The pixels of gm_mesh_walk, and its call at each of them. */
struct walk {
    const struct gm_mark *mark;
    const int *clip;
    gm_pixel_put *put;
    void *self;
};

static void walk_triangle(const struct walk *walk, const struct corner c[3])
{
    const double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
    const double rounding = 1e-9;
    const int *clip = walk->clip;
    if (!(fabs(area) > 0.0) || !isfinite(area)) {
        return;
    }
    const int left = gm_clamp(fmin(c[0].x, fmin(c[1].x, c[2].x)), clip[0], clip[2]);
    const int right = gm_clamp(fmax(c[0].x, fmax(c[1].x, c[2].x)) + 1.0, clip[0], clip[2]);
    const int top = gm_clamp(fmin(c[0].y, fmin(c[1].y, c[2].y)), clip[1], clip[3]);
    const int bottom = gm_clamp(fmax(c[0].y, fmax(c[1].y, c[2].y)) + 1.0, clip[1], clip[3]);
    for (int y = top; y < bottom; y++) {
        for (int x = left; x < right; x++) {
            const double px = x + 0.5 - c[0].x, py = y + 0.5 - c[0].y;
            const double second = (px * (c[2].y - c[0].y) - (c[2].x - c[0].x) * py) / area;
            const double third = ((c[1].x - c[0].x) * py - px * (c[1].y - c[0].y)) / area;
            if (second >= -rounding && third >= -rounding && second + third <= 1.0 + rounding) {
                walk->put(walk->self, walk->mark, x, y,
                          c[0].value + second * (c[1].value - c[0].value) + third * (c[2].value - c[0].value),
                          c[0].light + second * (c[1].light - c[0].light) +
                              third * (c[2].light - c[0].light));
            }
        }
    }
}

void gm_mesh_walk(const struct gm_axes *axes, const struct gm_mark *mark, const struct gm_pixel_grid *pixels,
                  gm_pixel_put *put, void *self)
{
    const struct walk walk = {mark, pixels->clip, put, self};
    for (size_t i = 0; i < mark->triangle_count; i++) {
        struct corner corners[3];
        bool known = true;
        for (size_t k = 0; k < 3; k++) {
            const size_t vertex = (size_t)mark->triangles[3 * i + k];
            const double *point = &mark->points[2 * vertex];
            corners[k] = (struct corner){pixels->across * (gm_axes_x(axes, point[0]) - pixels->left),
                                         pixels->down * (gm_axes_y(axes, point[1]) - pixels->top),
                                         mark->values[vertex], mark->light ? mark->light[vertex] : 1};
            known = known && isfinite(corners[k].value);
        }
        if (known) {
            walk_triangle(&walk, corners);
        }
    }
}

bool gm_boxes_overlap(const struct gm_box *a, const struct gm_box *b, double air)
{
    const double touch = 1e-6;
    return a->width > 0.0 && b->width > 0.0 && a->x < b->x + b->width + air && b->x < a->x + a->width + air &&
           a->y < b->y + b->height - touch && b->y < a->y + a->height - touch;
}
