/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_LAYOUT_APPEARANCE_H
#define GM_RENDER_LAYOUT_APPEARANCE_H

#include <stdbool.h>
#include <stdint.h>

#include "render/picture/picture.h"

/* Themes: the look of a picture's roles and colour maps. */

enum gm_theme { GM_THEME_LIGHT, GM_THEME_DARK, GM_THEME_COUNT };

struct gm_rgb {
    uint8_t r, g, b;
};

/* Returns the squared distance of two colours; green weighs most, as in the eye. */
static inline int gm_rgb_distance(struct gm_rgb a, struct gm_rgb b)
{
    const int r = a.r - b.r, g = a.g - b.g, blue = a.b - b.b;
    return 2 * r * r + 4 * g * g + 3 * blue * blue;
}

/* Returns the colour of a role in a theme; render/layout/appearance.c describes the choice of lane colours. */
struct gm_rgb gm_theme_colour(enum gm_theme theme, enum gm_role role);

/* Returns the colour of a map at 0 <= x <= 1; x is clamped. */
struct gm_rgb gm_colour_map_at(enum gm_colour_map map, enum gm_theme theme, double x);

/* Returns a colour in a light from 0 to 1. */
static inline struct gm_rgb gm_rgb_lit(struct gm_rgb rgb, double light)
{
    return (struct gm_rgb){(uint8_t)(rgb.r * light + 0.5), (uint8_t)(rgb.g * light + 0.5),
                           (uint8_t)(rgb.b * light + 0.5)};
}

/* Bounds of a side in pixels, of the scale, and of pixels per inch, if the user gives them. */
enum { GM_LEAST_SIDE = 64, GM_MOST_SIDE = 16384 };
#define GM_LEAST_SCALE 0.25
#define GM_MOST_SCALE 4.0
#define GM_LEAST_DPI 24.0
#define GM_MOST_DPI 2400.0

struct gm_cells;

/* The look of a picture, whatever it shows. */
struct gm_appearance {
    int width, height; /* pixels */
    enum gm_theme theme;
    double scale; /* factor of letters and lines; 0: 1 */
    /* Pixels per inch if the size was given as lengths: letters and lines then have the same size on paper
       for every dpi. 0: the size was given in pixels. */
    double dpi;
    double page_width, page_height; /* size of a drawing, in mm; 0: the pixels at their dpi, or at 96 */
    const char *title;              /* replaces the picture's title; NULL: does not */
    bool live;                      /* painted for a screen while the user watches, not for a file */
    const struct gm_cells *screen;  /* cells to draw instead of the picture; NULL: none */
};

#endif
