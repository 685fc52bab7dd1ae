/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_LAYOUT_LAYOUT_H
#define GM_RENDER_LAYOUT_LAYOUT_H

#include "render/layout/panel.h"

/* The layout of a picture on a surface of given size, the same for all painters. */

struct gm_layout {
    struct gm_axes *frames;
    size_t frame_count;
    struct gm_label *labels; /* all texts, even those among the marks and of ticks */
    size_t label_count;
};

/* Lays the picture out. The result lives in the picture's arena until its next clear; NULL when out of
   memory. Labels never overlap or leave the surface: a label without room is left out. */
const struct gm_layout *gm_layout_make(struct gm_picture *picture, const struct gm_metrics *metrics);

/* Returns the spot at a place of the surface. */
struct gm_spot gm_layout_locate(const struct gm_layout *layout, double across, double down);

#endif
