/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_LAYOUT_APPEARANCE_H
#define GM_RENDER_LAYOUT_APPEARANCE_H

#include <stdbool.h>
#include <stdint.h>

#include "render/picture/picture.h"

/* Themes: what the roles and colour maps of a picture look like. */

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

/* Bounds of a side, in pixels, of the scale, and of pixels an inch, where somebody says them. */
enum { GM_LEAST_SIDE = 64, GM_MOST_SIDE = 16384 };
#define GM_LEAST_SCALE 0.25
#define GM_MOST_SCALE 4.0
#define GM_LEAST_DPI 24.0
#define GM_MOST_DPI 2400.0

/* How a picture is to look, whatever it shows. */
struct gm_appearance {
    int width, height; /* pixels */
    enum gm_theme theme;
    double scale; /* of letters and lines; 0: 1 */
    /* Pixels an inch of a picture whose size was given as lengths: letters and lines are then as large on the
       paper whatever this is. 0: the size was given in pixels. */
    double dpi;
    double page_width, page_height; /* of a drawing, in mm; 0: the pixels at their dpi, 96 where it is 0 */
    const char *title;              /* instead of the picture's own; NULL: that */
    bool live; /* for a screen, which is looked at while it is painted; else for a file */
};

#endif
