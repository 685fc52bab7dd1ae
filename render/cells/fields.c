/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes, images and their colour bar in the raster beneath the character cells. */
#include "render/cells/cover.h"

#include <math.h>

static void set_field(struct gm_raster *raster, int x, int y, struct gm_rgb colour)
{
    raster->at[(size_t)y * (size_t)raster->width + (size_t)x] =
        (struct gm_subpixel){colour, GM_LEVEL_FIELD, GM_INK};
}

static double map_position(const struct gm_mark *mark, double value)
{
    return mark->high > mark->low ? (value - mark->low) / (mark->high - mark->low) : 0.5;
}

static void mesh_triangle(struct gm_raster *raster, const struct gm_mark *mark,
                          const struct gm_raster_place corner[3], const double value[3])
{
    double area = (corner[1].x - corner[0].x) * (corner[2].y - corner[0].y) -
                  (corner[2].x - corner[0].x) * (corner[1].y - corner[0].y);
    if (area == 0) {
        return;
    }
    double low_x = gm_smaller(corner[0].x, gm_smaller(corner[1].x, corner[2].x));
    double low_y = gm_smaller(corner[0].y, gm_smaller(corner[1].y, corner[2].y));
    double high_x = gm_larger(corner[0].x, gm_larger(corner[1].x, corner[2].x));
    double high_y = gm_larger(corner[0].y, gm_larger(corner[1].y, corner[2].y));
    int left = gm_clamp(floor(low_x), raster->clip_left, raster->clip_right);
    int right = gm_clamp(ceil(high_x), raster->clip_left, raster->clip_right);
    int top = gm_clamp(floor(low_y), raster->clip_top, raster->clip_bottom);
    int bottom = gm_clamp(ceil(high_y), raster->clip_top, raster->clip_bottom);
    for (int y = top; y < bottom; y++) {
        for (int x = left; x < right; x++) {
            double px = x + 0.5 - corner[0].x, py = y + 0.5 - corner[0].y;
            double b = (px * (corner[2].y - corner[0].y) - (corner[2].x - corner[0].x) * py) / area;
            double c = ((corner[1].x - corner[0].x) * py - px * (corner[1].y - corner[0].y)) / area;
            if (b < -1e-9 || c < -1e-9 || b + c > 1 + 1e-9) {
                continue;
            }
            double here = value[0] + b * (value[1] - value[0]) + c * (value[2] - value[0]);
            set_field(raster, x, y, gm_map_colour(mark->map, raster->theme, map_position(mark, here)));
        }
    }
}

void gm_raster_mesh(struct gm_raster *raster, const struct gm_frame *frame, const struct gm_mark *mark)
{
    for (size_t i = 0; i < mark->triangle_count; i++) {
        struct gm_raster_place corner[3];
        double value[3];
        bool drawn = true;
        for (size_t k = 0; k < 3; k++) {
            size_t vertex = (size_t)mark->triangles[3 * i + k];
            corner[k] = gm_raster_place(raster, frame, &mark->points[2 * vertex]);
            value[k] = mark->values[vertex];
            drawn = drawn && gm_raster_is_place(corner[k]) && isfinite(value[k]);
        }
        if (drawn) {
            mesh_triangle(raster, mark, corner, value);
        }
    }
}

void gm_raster_image(struct gm_raster *raster, const struct gm_frame *frame, const struct gm_mark *mark)
{
    struct gm_raster_place low = gm_raster_place(raster, frame, &mark->points[0]);
    struct gm_raster_place high = gm_raster_place(raster, frame, &mark->points[2]);
    if (mark->rows == 0 || mark->columns == 0 || !gm_raster_is_place(low) || !gm_raster_is_place(high) ||
        low.x == high.x || low.y == high.y) {
        return;
    }
    for (int y = raster->clip_top; y < raster->clip_bottom; y++) {
        double v = (y + 0.5 - low.y) / (high.y - low.y);
        if (v < 0 || v > 1) {
            continue;
        }
        size_t row = (size_t)gm_clamp(v * (double)mark->rows, 0, (int)mark->rows - 1);
        for (int x = raster->clip_left; x < raster->clip_right; x++) {
            double u = (x + 0.5 - low.x) / (high.x - low.x);
            if (u < 0 || u > 1) {
                continue;
            }
            size_t column = (size_t)gm_clamp(u * (double)mark->columns, 0, (int)mark->columns - 1);
            double value = mark->values[row * mark->columns + column];
            if (isfinite(value)) {
                set_field(raster, x, y, gm_map_colour(mark->map, raster->theme, map_position(mark, value)));
            }
        }
    }
}

void gm_raster_bar(struct gm_raster *raster, const struct gm_box *box, enum gm_map map)
{
    gm_raster_clip(raster, box);
    for (int y = raster->clip_top; y < raster->clip_bottom; y++) {
        double position = 1 - ((y + 0.5) * raster->unit_y - box->y) / box->height;
        for (int x = raster->clip_left; x < raster->clip_right; x++) {
            set_field(raster, x, y, gm_map_colour(map, raster->theme, position));
        }
    }
}
