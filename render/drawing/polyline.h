/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_DRAWING_POLYLINE_H
#define GM_RENDER_DRAWING_POLYLINE_H

#include <stdbool.h>
#include <stddef.h>

/* Polylines in pixels: what is done to them before they become triangles. All buffers grow and stay. */

struct gm_point {
    float x, y;
};

struct gm_polyline {
    struct gm_point *points;
    size_t count, capacity;
    bool closed; /* the last point is joined to the first */
};

/* Room for count points, contents lost. False when memory is short. */
bool gm_polyline_reserve(struct gm_polyline *line, size_t count);
void gm_polyline_free(struct gm_polyline *line);

struct gm_bounds {
    float left, top, right, bottom;
};

/* The next piece of a line inside bounds, from *from on, which is moved behind it. False at the end. A line
   wholly inside is one piece and stays closed. */
bool gm_polyline_clip(const struct gm_polyline *line, struct gm_bounds bounds, size_t *from,
                      struct gm_polyline *piece);

/* Leaves out points, in place, such that the line moves by at most `tolerance`. */
void gm_polyline_simplify(struct gm_polyline *line, float tolerance);

/* Cuts a line into dashes: pattern is lengths drawn and left out in turn, drawn ones may be 0 (a dot).
   Start with *state zeroed; false at the end. */
struct gm_dashing {
    size_t segment, part;
    float within; /* length already used of the segment */
};
bool gm_polyline_dash(const struct gm_polyline *line, const float *pattern, size_t parts,
                      struct gm_dashing *state, struct gm_polyline *dash);

float gm_polyline_length(const struct gm_polyline *line);

#endif
