/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_SPACE_H
#define GM_SCENES_COMMON_SPACE_H

#include "scenes/common/camera.h"

/* Marks of a picture for what stands in space. Points are triples x, y, z. What is far is thin and pale, what
   is behind a surface fainter. */

struct gm_stroke_in_space {
    struct gm_style style;
    bool fades; /* a past, the newest last, as gm_draw_trail has it */
    const struct gm_ellipsoid
        *on; /* the surface that the line lies on; NULL: none, or all (gm_space_hides) */
};
/* A line through the points; a NaN breaks it. */
void gm_space_line(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                   struct gm_stroke_in_space stroke, const double *points, size_t count);
/* A straight one, parts of which may be hidden. */
void gm_space_segment(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                      struct gm_style style, const double from[3], const double to[3]);
/* Discs, those behind first. */
void gm_space_points(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                     struct gm_style style, const double *points, size_t count);

/* The surfaces with their circles of latitude and longitude, and where the first two meet. */
void gm_space_draw_surfaces(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space);
/* The three axes where they come out of the surfaces, up to `reach`, with their names (three; NULL: none). */
void gm_space_draw_axes(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                        double reach, const char *const *names);
/* The edges of the box that are not before what is in it; its ends in numbers, and the names of its axes. */
void gm_space_draw_box(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                       const char *const *names);

#endif
