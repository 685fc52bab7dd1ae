/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_LAYOUT_LAYOUT_H
#define GM_RENDER_LAYOUT_LAYOUT_H

#include "render/layout/panel.h"

/* Where everything of a picture goes on a surface of given size; the layout is one for all painters. */

struct gm_layout {
    struct gm_axes *frames;
    size_t frame_count;
    struct gm_label *labels; /* every text, those among the marks and of the ticks included */
    size_t label_count;
};

/* Lays the picture out; the result lives in the picture's arena until its next clear. NULL when memory is
   short. Labels never overlap each other nor leave the surface: what does not fit is left out. */
const struct gm_layout *gm_layout_make(struct gm_picture *picture, const struct gm_metrics *metrics);

/* The panel of a state that a place of the surface is in, and the place in its own units; NULL if there is
   none, or if its axes are logarithmic. */
const struct gm_panel *gm_layout_locate(const struct gm_layout *layout, double across, double down, double *x,
                                        double *y);

#endif
