/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_MOVING_FRAME_H
#define GM_SCENES_FIELD_MOVING_FRAME_H

#include "core/field/problems/moving_frames.h"
#include "scenes/common/graph.h"

/* An invariant scheme at a node: the nodes around it and the values there, and their images under the moving
   frame. Figures 19 to 23 of Razafindralandy, Hamdouni & Chhay (2018). */

enum { GM_STENCIL = 5 /* nodes, the one that is stepped in the middle */ };

/* The exact value at a node; what starts there if the file gives none. */
double gm_exact_at_node(const struct gm_view *view, size_t node);

/* Returns how far a node that rests in its frame has travelled in the original one; 0 if it moves along. */
double gm_frame_travel(const struct gm_view *view);

struct gm_axes_style {
    const char *title, *constant, *note; /* the picture's title, and parts of its subtitle, or "" */
    const char *value;                   /* the name of u, "u" */
    const char *carried;                 /* the name of the carried u, "û" */
    const char *section;                 /* the cross-section that defines the frame, "û = 0, D₀û = 0" */
    /* Carries the events about node j, on nodes that get `unit` apart; false if there is no frame. */
    bool (*carry)(const struct gm_view *view, size_t j, double unit, struct gm_event *seen,
                  struct gm_event *carried);
};

/* Draws the whole picture, of the node nearest to the parameter `at`: the nodes as the lanes see them and as they are carried,
   and the values likewise. */
void gm_draw_moving_frame(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                          const struct gm_axes_style *look);

#endif
