/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Themes: what the roles and colour maps of a picture look like. */
#ifndef GM_RENDER_LAYOUT_THEME_H
#define GM_RENDER_LAYOUT_THEME_H

#include <stdint.h>

#include "render/picture/picture.h"

enum gm_theme { GM_THEME_LIGHT, GM_THEME_DARK, GM_THEME_COUNT };

struct gm_rgb {
    uint8_t r, g, b;
};

/* How far apart two colours are, as a square; green weighs most, as in the eye. */
static inline int gm_rgb_distance(struct gm_rgb a, struct gm_rgb b)
{
    const int r = a.r - b.r, g = a.g - b.g, blue = a.b - b.b;
    return 2 * r * r + 4 * g * g + 3 * blue * blue;
}

/* What a role looks like in a theme (render/layout/theme.c says how the lane colours were chosen). */
struct gm_rgb gm_theme_colour(enum gm_theme theme, enum gm_role role);

/* A colour map at position 0 <= x <= 1; clamped. */
struct gm_rgb gm_colour_map_at(enum gm_colour_map map, enum gm_theme theme, double x);

#endif
