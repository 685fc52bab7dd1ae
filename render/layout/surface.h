/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_LAYOUT_SURFACE_H
#define GM_RENDER_LAYOUT_SURFACE_H

#include "render/layout/ticks.h"

/* What stands on a surface, as plain data. Painters differ in how they measure text and in their unit (a
   pixel; for the terminal a part of a cell). y grows downwards. */

enum gm_text_size { GM_TEXT_TITLE, GM_TEXT_PANEL, GM_TEXT_LABEL, GM_TEXT_TICK, GM_TEXT_SIZE_COUNT };

struct gm_metrics {
    double width, height;            /* of the surface */
    double line[GM_TEXT_SIZE_COUNT]; /* height of a line of text of each size */
    /* A text's width as it will be set: title and panel names are bold, the clock is in the title's size. */
    double (*measure)(const void *self, enum gm_text_size size, const char *text);
    const void *self;
    double scale; /* surface units a pixel of a picture 720 high */
    bool terse;   /* leave out the subtitle and all graphs but the first */
};

struct gm_box {
    double x, y, width, height;
};

struct gm_tick {
    double position; /* on the surface */
    double value;
    const char *label;
};

struct gm_label { /* a text placed on the surface */
    const char *text;
    enum gm_text_size size;
    enum gm_role role;
    bool bold, mono;
    double x, y; /* of the anchor; y is the top of the line */
    enum gm_anchor anchor;
    bool vertical;    /* reads upwards; x is then its left edge, y the middle of its height */
    bool among_marks; /* a text of a panel's data, to be read on whatever lies under it */
};

struct gm_axes { /* a panel on the surface */
    const struct gm_panel *panel;
    struct gm_box box; /* of the data; marks are clipped to it */
    /* surface = origin + factor * value (of log10 of the value on a log axis) */
    double x_origin, x_factor, y_origin, y_factor;
    struct gm_tick x_ticks[GM_TICK_MAX], y_ticks[GM_TICK_MAX];
    size_t x_tick_count, y_tick_count;
    struct gm_box colour_bar; /* width 0: none */
    double bar_tip[2]; /* height of the point below and above the bar, where values lie beyond; 0: none */
    struct gm_tick bar_ticks[GM_TICK_MAX];
    size_t bar_tick_count;
};

/* What of a text's width stands on the left of its anchor: 0, 1/2 or 1. */
double gm_anchor_share(enum gm_anchor anchor);

/* The mark of a panel whose values have colours, which a colour bar tells of; NULL if there is none. */
const struct gm_mark *gm_panel_field(const struct gm_panel *panel);

/* Surface coordinates of a value on a frame's axes. */
double gm_axes_x(const struct gm_axes *axes, double value);
double gm_axes_y(const struct gm_axes *axes, double value);

/* The value of an image at a place from 0 to 1 in both directions, from its left and its bottom: linear in both
   between the middles of its cells. */
double gm_image_value(const struct gm_mark *image, double across, double up);

/* Neighbours in a line need air between them; lines may touch. Empty boxes overlap nothing. */
bool gm_boxes_overlap(const struct gm_box *a, const struct gm_box *b, double air);

#endif
