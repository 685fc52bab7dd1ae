/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_FRAMES_H
#define GM_SCENES_FIELD_FRAMES_H

#include "core/field/problems/moving_frames.h"
#include "scenes/field/field.h"

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

/* Draws the whole picture, of the node nearest to the parameter `at`: the nodes as the lanes see them and as they
   are carried, and the values likewise. */
void gm_draw_moving_frame(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                          const struct gm_axes_style *look);

/* Equations seen from frames of reference (struct gm_framed), for lanes of fields: Korteweg and de Vries', heat
   and Burgers'. `at_rest` is the value in the original frame at a node's start, `exact` the exact one there at a
   place of that frame. `draw_frame` draws the moving frame at the node nearest to the parameter `at`. */

/* Between nodes it is linear. */
double gm_kdv_at_rest(const struct gm_view *view, size_t node);
/* Returns how far the nodes have moved from their start, in the problem's frame. */
double gm_kdv_shift(const struct gm_view *view);
/* Defects of a step under a boost by 1/2 and under a scaling by 1.3; NaN without a moving frame. */
double gm_kdv_boost_defect(const struct gm_view *view);
double gm_kdv_scaling_defect(const struct gm_view *view);
void gm_kdv_draw_frame(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);
/* Writes the reason why evolution and projection cannot step. */
void gm_kdv_failure(const struct gm_view *view, char *text, size_t size);

double gm_heat_at_rest(const struct gm_view *view, size_t node);
double gm_heat_exact_at_rest(const struct gm_view *view, double x);
/* The largest error at a node in the original frame. */
double gm_heat_error(const struct gm_view *view);
/* Defects of a step under a boost and a projection by 1/2 and under a scaling by 1.3. */
double gm_heat_boost_defect(const struct gm_view *view);
double gm_heat_projection_defect(const struct gm_view *view);
double gm_heat_scaling_defect(const struct gm_view *view);
void gm_heat_draw_frame(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);
/* Writes why an invariant scheme cannot step. */
void gm_heat_failure(const struct gm_view *view, char *text, size_t size);

double gm_burgers_at_rest(const struct gm_view *view, size_t node);
double gm_burgers_exact_at_rest(const struct gm_view *view, double x);
/* The largest error at a node, and h times the sum of all. */
double gm_burgers_sup_error(const struct gm_view *view);
double gm_burgers_l1_error(const struct gm_view *view);
/* The largest value at rest, and how far it is above 1. */
double gm_burgers_amplitude(const struct gm_view *view);
double gm_burgers_overshoot(const struct gm_view *view);
/* If this is 1 or more, no projection turns D0 u into 0, and the invariant scheme has no frame to step in. */
double gm_burgers_compression(const struct gm_view *view);
/* The largest difference from the companion's value as many nodes back as the frame has moved; between nodes it
   is linear. */
double gm_burgers_galilean_defect(const struct gm_view *view);
/* Defects of a step under a projection by 1/2 and under a scaling by 1.3. */
double gm_burgers_projection_defect(const struct gm_view *view);
double gm_burgers_scaling_defect(const struct gm_view *view);
void gm_burgers_draw_frame(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

/* Draws fields that are seen from frames of reference: the profiles at rest, in a panel for each scheme, and the
   graphs over time; of several schemes in several frames over the velocity of the frame. The problems' parameters
   begin with struct gm_framed. */
void gm_draw_profiles(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                      const struct gm_field_look *look, const struct gm_graph *graphs, size_t graph_count);

#endif
