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

/* Sets depths and the panel's axes, and draws what is at rest: the surfaces, and three axes out of them, beyond the distance
   `far` from the origin; without any, the box. */
void gm_space_draw_frame(struct gm_picture *picture, struct gm_panel *panel, struct gm_space *space,
                         const struct gm_camera *camera, double far, const char *const names[3]);

#endif
