/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_LAYOUT_AXES_H
#define GM_RENDER_LAYOUT_AXES_H

#include "render/layout/labels.h"

/* One panel of a layout: the room its texts take around the data, and its axes once its box is known. */

/* What a panel shows besides its data, in the order in which it gives way when room is short. */
enum gm_detail {
    GM_DETAIL_ALL,
    GM_DETAIL_NO_NOTE,
    GM_DETAIL_NO_AXIS_LABELS,
    GM_DETAIL_NO_TICKS,
    GM_DETAIL_DATA
};

/* Most lines of a title that goes on below. */
enum { GM_TITLE_LINES = 3, GM_KEY_LINES = 3 };

struct gm_border {
    double left, right, top, bottom;
    double bar;        /* of a colour bar, beyond `right` */
    size_t note_lines; /* that `top` has room for, under the title */
};

/* The room around the data. With `calm`, tick labels count with a usual width instead of their own, so that
   decisions do not change from frame to frame. */
struct gm_border gm_border_of(const struct gm_label_list *list, const struct gm_panel *panel,
                              enum gm_detail detail, bool x_label, bool calm);

/* How many lines the panel's keys take in a width; 1 for none. */
size_t gm_key_lines(const struct gm_label_list *list, const struct gm_panel *panel, double width);

/* Ranges as shown: not empty, positive on a log axis; logarithms of the values on log axes. */
void gm_axis_range(const struct gm_axis *axis, double *low, double *high);

/* How a panel of a group is to be filled. */
struct gm_fill {
    struct gm_box box; /* of the data */
    enum gm_detail detail;
    bool x_label;       /* names the x axis */
    size_t note_lines;  /* of the group's notes and keys: titles stand above so many in all panels */
    size_t note_words;  /* most of those before a note's number */
    bool small_title;   /* where the group's titles are too long for their usual size */
    size_t title_lines; /* that there is room for */
    size_t title_skip;  /* bytes at the front of the title that all of the group share and that it can do
                           without */
    double title_left, title_width; /* room for titles, which begin with the box where they fit so */
};

/* Maps the panel to the box, places ticks and labels. */
void gm_axes_fill(struct gm_label_list *list, struct gm_axes *axes, const struct gm_panel *panel,
                  const struct gm_fill *fill);

/* Places a text among the marks of frame number `own`, when all other labels are: on its own data, and on no
   other frame of all `count`. */
void gm_axes_note(struct gm_label_list *list, const struct gm_axes *axes, size_t count, size_t own,
                  const struct gm_mark *mark);

#endif
