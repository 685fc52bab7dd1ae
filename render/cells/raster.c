/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The raster beneath the character cells: sub-pixels with the level and role of their mark. */
#include "render/cells/grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool gm_raster_open(struct gm_raster *raster, int width, int height, enum gm_theme theme)
{
    size_t count = (size_t)width * (size_t)height;
    *raster = (struct gm_raster){.width = width,
                                 .height = height,
                                 .unit_x = 1,
                                 .unit_y = 1,
                                 .scale = 1,
                                 .theme = theme,
                                 .at = malloc(count * sizeof *raster->at),
                                 .mask = calloc(count, 1),
                                 .left = width,
                                 .top = height,
                                 .clip_right = width,
                                 .clip_bottom = height};
    if (!raster->at || !raster->mask) {
        gm_raster_close(raster);
        return false;
    }
    struct gm_subpixel paper = {gm_theme_colour(theme, GM_PAPER), GM_LEVEL_PAPER, GM_PAPER};
    for (int i = 0; i < width; i++) {
        raster->at[i] = paper;
    }
    for (int row = 1; row < height; row++) {
        memcpy(&raster->at[(size_t)row * (size_t)width], raster->at, (size_t)width * sizeof paper);
    }
    return true;
}

void gm_raster_close(struct gm_raster *raster)
{
    free(raster->at);
    free(raster->mask);
    raster->at = NULL;
    raster->mask = NULL;
}

void gm_raster_clip(struct gm_raster *raster, const struct gm_box *box)
{
    /* A sub-pixel belongs to the box if its middle does. The one after the end belongs too, so that a mark on
       the edge is visible. */
    raster->clip_left = gm_clamp(floor(box->x / raster->unit_x), 0, raster->width);
    raster->clip_top = gm_clamp(floor(box->y / raster->unit_y), 0, raster->height);
    raster->clip_right = gm_clamp(floor((box->x + box->width) / raster->unit_x) + 1, 0, raster->width);
    raster->clip_bottom = gm_clamp(floor((box->y + box->height) / raster->unit_y) + 1, 0, raster->height);
}

struct gm_raster_place gm_raster_place(const struct gm_raster *raster, const struct gm_axes *axes,
                                       const double *point)
{
    return (struct gm_raster_place){gm_axes_x(axes, point[0]) / raster->unit_x,
                                    gm_axes_y(axes, point[1]) / raster->unit_y};
}

bool gm_raster_is_place(struct gm_raster_place place)
{
    return isfinite(place.x) && isfinite(place.y);
}

/* ---- the mask ---- */

void gm_raster_cover(struct gm_raster *raster, int x, int y, double coverage)
{
    if (x < raster->clip_left || x >= raster->clip_right || y < raster->clip_top ||
        y >= raster->clip_bottom) {
        return;
    }
    uint8_t value = (uint8_t)(255 * (coverage < 1 ? coverage : 1));
    uint8_t *mask = &raster->mask[(size_t)y * (size_t)raster->width + (size_t)x];
    if (value > *mask) {
        *mask = value;
    }
    raster->left = x < raster->left ? x : raster->left;
    raster->top = y < raster->top ? y : raster->top;
    raster->right = x + 1 > raster->right ? x + 1 : raster->right;
    raster->bottom = y + 1 > raster->bottom ? y + 1 : raster->bottom;
}

static uint8_t mix(uint8_t from, uint8_t to, unsigned weight)
{
    return (uint8_t)((from * (255 - weight) + to * weight + 127) / 255);
}

static void blend(struct gm_subpixel *at, struct gm_rgb colour, unsigned weight, enum gm_level level,
                  enum gm_role role)
{
    at->colour = (struct gm_rgb){mix(at->colour.r, colour.r, weight), mix(at->colour.g, colour.g, weight),
                                 mix(at->colour.b, colour.b, weight)};
    if (level == GM_LEVEL_PAPER) { /* the mark covers too little of it */
        return;
    }
    at->level = (uint8_t)(level == GM_LEVEL_LINE && at->level >= GM_LEVEL_FIELD ? GM_LEVEL_OVER : level);
    at->role = (uint8_t)role;
}

void gm_raster_settle(struct gm_raster *raster, struct gm_rgb colour, double alpha, enum gm_level level,
                      enum gm_role role)
{
    unsigned opacity = (unsigned)(255 * (alpha < 0 ? 0 : alpha < 1 ? alpha : 1));
    for (int y = raster->top; y < raster->bottom; y++) {
        size_t row = (size_t)y * (size_t)raster->width;
        for (int x = raster->left; x < raster->right; x++) {
            uint8_t *mask = &raster->mask[row + (size_t)x];
            if (!*mask) {
                continue;
            }
            unsigned coverage = *mask;
            *mask = 0;
            if (raster->sharp) {
                coverage = coverage >= 128 ? 255 : 0;
            }
            unsigned weight = coverage * opacity / 255;
            if (weight > 0) {
                blend(&raster->at[row + (size_t)x], colour, weight, coverage >= 64 ? level : GM_LEVEL_PAPER,
                      role);
            }
        }
    }
    raster->left = raster->width;
    raster->top = raster->height;
    raster->right = raster->bottom = 0;
}
