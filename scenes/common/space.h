/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_SPACE_H
#define GM_SCENES_COMMON_SPACE_H

#include "scenes/common/camera.h"

/* Marks of a picture for objects in space. Points are triples x, y, z. Distant objects are thin and pale,
   those behind a surface fainter. */

struct gm_stroke_in_space {
    struct gm_style style;
    bool fades;                    /* a trail, the newest point last, as in gm_draw_trail */
    const struct gm_ellipsoid *on; /* surface that the line lies on; NULL: none, or all (gm_space_hides) */
};
/* Draws a line through the points; a NaN breaks it. */
void gm_space_line(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                   struct gm_stroke_in_space stroke, const double *points, size_t count);
/* Draws a straight line, parts of which may be hidden. */
void gm_space_segment(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                      struct gm_style style, const double from[3], const double to[3]);
/* Draws discs, the farthest first. */
void gm_space_points(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                     struct gm_style style, const double *points, size_t count);

/* Draws the surfaces with circles of latitude and longitude, and the intersection of the first two. */
void gm_space_draw_surfaces(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space);
/* Draws the three axes from the surfaces up to `reach`, with three names (NULL: none). */
void gm_space_draw_axes(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                        double reach, const char *const *names);
/* Draws the edges of the box that do not cover its contents, with numbers at their ends, and the names of its
   axes. */
void gm_space_draw_box(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                       const char *const *names);

#endif
