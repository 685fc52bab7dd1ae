/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_LAYOUT_APPEARANCE_H
#define GM_RENDER_LAYOUT_APPEARANCE_H

#include "render/layout/theme.h"

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
};

#endif
