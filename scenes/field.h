/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_H
#define GM_SCENES_FIELD_H

#include "scenes/graph.h"

/* What the scenes of fields on a line have in common: the profile now, and the field so far over space and
 * time. */

/* A row of the surface: the field at so many points, every two hundredth of the run. */
enum { GM_SURFACE_COLUMNS = 240, GM_SURFACE_ROWS = 256 };

/* What of a lane is drawn. */
struct gm_field_look {
    double (*value)(const struct gm_view *view, size_t node);
    double (*exact)(const struct gm_view *view, double x); /* NULL: not drawn */
    const char *name;                                      /* of the value, for axes: "u" */
    double low, high;                                      /* the values that are shown at least */
    enum gm_map map;
};

size_t gm_surface_width(const struct gm_view *view);
double gm_surface_interval(const void *parameters);
/* Fills one row of the surface. */
void gm_surface_record(const struct gm_view *view, double (*value)(const struct gm_view *, size_t),
                       double *entry);

/* A panel for every lane: the surface, from track `track`. */
void gm_draw_surfaces(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                      size_t track, const struct gm_field_look *look);
/* One graph: the profiles of all lanes now, over the exact one. */
void gm_draw_profiles(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                      const struct gm_field_look *look);

/* The Delta t that all lanes share, as ",  dt = 0.05"; "" where they differ. */
const char *gm_shared_step(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count);

#endif
