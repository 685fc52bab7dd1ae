/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_FIELD_H
#define GM_SCENES_FIELD_FIELD_H

#include "scenes/common/graph.h"

/* The common part of all scenes of fields on a line: the current profile, and the field so far over space and
   time. */

/* The choice drawn over space and time: the field, or a law, number GM_SHOW_FIELD + 1 + enum gm_local_law. */
enum { GM_SHOW_FIELD };

/* The look of a lane's field. */
struct gm_field_look {
    double (*value)(const struct gm_view *view, size_t node);
    double (*exact)(const struct gm_view *view, double x); /* NULL: not drawn */
    const char *name;                                      /* the name of the value, for axes: "u" */
    double low, high;                                      /* the least range of values that is shown */
    enum gm_colour_map map;
    double reach;        /* half of the line's part that is drawn, of profiles at rest */
    int show;            /* the content of the surfaces: scenes/field/kind.h */
    const char *content; /* the name of the third law: "mass" */
};

/* Returns the component u at a node, which most scenes show. */
double gm_field_u(const struct gm_view *view, size_t node);

/* Draws the whole picture but its titles: the clock, the surfaces from track 0, the profiles and
   `graph_count` graphs over time; if a law is shown, its residual replaces the second graph. */
void gm_draw_field(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                   const struct gm_field_look *look, const struct gm_graph *graphs, size_t graph_count);

/* Returns the Delta t that all lanes share, as ",  dt = 0.05"; "" if they differ. */
const char *gm_shared_step(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count);

#endif
