/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_MOVING_FRAME_H
#define GM_SCENES_FIELD_MOVING_FRAME_H

#include "core/field/problems/moving_frames.h"
#include "scenes/common/graph.h"

/* An invariant scheme at a node: the nodes around it and the values there, and their images under the moving
   frame. Figures 19 to 23 of Razafindralandy, Hamdouni & Chhay (2018). */

enum { GM_STENCIL = 5 /* nodes, the one that is stepped in the middle */ };

/* Events relative to the node in the middle, which the frame's translations carry to t = x = 0: the nodes at
   the current level, then at the next one, where only their positions count. */
struct gm_moving_frame {
    bool known; /* there is such a node, and a frame */
    struct gm_event seen[2 * GM_STENCIL], carried[2 * GM_STENCIL];
};

/* The values that are shown, as a choice's list, and the row for it. */
enum { GM_PROFILES_SHOWN, GM_FRAME_SHOWN };
extern const char *const gm_axes_shown[];
#define GM_FRAME_ROWS(own, show, at, standard)                                                               \
    GM_CHOICE_ROW(own, show, "show", "profiles", gm_axes_shown,                                              \
                  "the profiles, or the moving frame: a node with its neighbours, and where the frame "      \
                  "carries them"),                                                                           \
        GM_REAL_ROW(own, at, "at", standard, -1e4, 1e4,                                                      \
                    "show=frame: the node nearest to this place of the original frame")

/* Returns the number of the node nearest to a position that has its stencil inside the line. */
size_t gm_stencil_node(const struct gm_grid1 *grid, double place);

struct gm_axes_style {
    double h, k;         /* the units of x and t */
    const char *value;   /* the name of u, "u" */
    const char *carried; /* the name of the carried u, "û" */
    const char *section; /* the cross-section that defines the frame, "û = 0, D₀û = 0" */
};

/* Draws four panels: the nodes as the lanes see them and as they are carried, and the values likewise. */
void gm_draw_moving_frame(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                          const struct gm_moving_frame *stencils, const struct gm_axes_style *look);

#endif
