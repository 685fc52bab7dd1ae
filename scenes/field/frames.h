/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_FRAMES_H
#define GM_SCENES_FIELD_FRAMES_H

#include "core/field/families/frames.h"
#include "scenes/field/kind.h"

/* Equations that are recognised, and frames of reference (struct gm_framed): what the files of such fields share. */

/* Hooks of their kinds. */
bool gm_equation_open(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values);
void gm_equation_start(const struct gm_problem *problem, double *y);
#define GM_EQUATION                                                                                          \
    .no_walls = "boundary: the schemes for this equation alone need no walls", .draw = gm_field_draw

/* The choices of "frame", by enum gm_frame_nodes, NULL-terminated. */
extern const char *const gm_frame_choices[];
#define GM_FRAME_ROW                                                                                         \
    GM_CHOICE_ROW(                                                                                           \
        GM_FIELD_LANE, grid.frame, "frame", "each", gm_frame_choices,                                        \
        "nodes at rest in the frame, or moving by lambda dt per step, for invariant schemes only; each: "    \
        "moving for the invariant schemes, fixed for the others")

/* Returns the grid from one end of the line to the other. */
struct gm_grid1 gm_field_between_ends(const struct gm_system_lane *lane);

/* Returns how far a node that rests in its frame has travelled in the original one; 0 if it moves along. */
double gm_frame_travel(const struct gm_view *view);

/* Defects of a step under a boost and a projection by 1/2, and under a scaling by 1.3; NaN without a moving frame. */
double gm_boost_defect(const struct gm_view *view);
double gm_projection_defect(const struct gm_view *view);
double gm_scaling_defect(const struct gm_view *view);

/* Draws the moving frame of schemes at the node nearest to the parameter `at`: the nodes around it as the lanes see
   them and as they are carried, and the values likewise, as in figures 19 to 23 of Razafindralandy, Hamdouni & Chhay
   (2018). */
void gm_draw_moving_frame(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

/* Draws fields that are seen from frames of reference: the profiles at rest, in a panel for each scheme, and the
   graphs over time; of several schemes in several frames over the velocity of the frame. */
void gm_draw_profiles(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                      const struct gm_field_look *look, const struct gm_graph *graphs, size_t graph_count);

#endif
