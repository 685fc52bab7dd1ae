/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_GRID_CHART_H
#define GM_APP_GRID_CHART_H

#include "scenes/common/graph.h"

/* The common functions of the pictures of grids. */

/* A panel with axes. */
struct gm_panel *gm_chart_panel(struct gm_picture *picture, enum gm_place place, const char *title,
                                const struct gm_axis *x, const struct gm_axis *y);

/* The colour of line number `index`. */
struct gm_style gm_chart_style(size_t index);

/* A line with its points, and its name among the panel's keys; without points it draws nothing. */
void gm_chart_line(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                   const double *points, size_t count, const char *name);

/* The count + 1 edges of the cells around `count` >= 1 values in rising order: halfway between them, on the axis'
   scale. Returns the axis. */
struct gm_axis gm_chart_edges(const char *label, const double *values, size_t count, bool logarithmic,
                              double *edges);

#endif
