/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_KDV_FRAME_H
#define GM_SCENES_FIELD_KDV_FRAME_H

#include "scenes/field/field.h"

/* The frames of the Korteweg-de Vries equation (struct gm_kdv), for lanes of fields. */

/* Returns the value in the original frame at a node's start; between nodes it is linear. */
double gm_kdv_at_rest(const struct gm_view *view, size_t node);
/* Returns how far the nodes have moved from their start, in the problem's frame. */
double gm_kdv_shift(const struct gm_view *view);

/* Defects of a step under a boost by 1/2 and under a scaling by 1.3; NaN without a moving frame. */
double gm_kdv_boost_defect(const struct gm_view *view);
double gm_kdv_scaling_defect(const struct gm_view *view);

/* Draws the moving frame at the node nearest to the parameter `at`. */
void gm_kdv_draw_frame(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

/* Writes the reason why evolution and projection cannot step. */
void gm_kdv_failure(const struct gm_view *view, char *text, size_t size);

#endif
