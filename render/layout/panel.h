/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_LAYOUT_PANEL_H
#define GM_RENDER_LAYOUT_PANEL_H

#include <stddef.h>

#include "render/picture/picture.h"

/* The round values of an axis, and how they are written. */

enum { GM_TICK_MAX = 12 };

/* The range as the axis shows it: never empty, positive on a log axis. */
void gm_axis_shown(const struct gm_axis *axis, double *low, double *high);

/* Round tick values of a range: at least 3 where possible, at most max <= GM_TICK_MAX. */
size_t gm_ticks(const struct gm_axis *axis, size_t max, double *values);
/* A tick's label: a true minus sign, pi/2, powers of ten with superscripts. `step` is the distance of
   ticks. */
void gm_tick_format(enum gm_scale scale, double value, double step, char *text, size_t size);

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

/* The labels of a layout under construction: a label is taken only if it is wholly on the surface and on no
   label taken before, so the order in which they are offered is their rank. */

struct gm_label_list {
    struct gm_picture *picture;
    const struct gm_metrics *metrics;
    struct gm_label *labels;
    struct gm_box *boxes; /* what each covers */
    size_t count, capacity;
};

/* False when memory is short. */
bool gm_labels_open(struct gm_label_list *list, struct gm_picture *picture, const struct gm_metrics *metrics,
                    size_t capacity);

/* True if the label was taken. Empty texts never are. */
bool gm_labels_add(struct gm_label_list *list, struct gm_label label);

double gm_labels_width(const struct gm_label_list *list, enum gm_text_size size, const char *text);

/* The text, shortened to width with an ellipsis where needed; "" if not even that fits. A word with a
   figure in it is not cut. */
const char *gm_labels_shorten(const struct gm_label_list *list, enum gm_text_size size, const char *text,
                              double width);

/* The same for a text that tells a number, such as "energy error now 2.4·10⁻³": of what stands before the
   number the last words give way, so that it begins as it did; the number is whole, or the text is "". At most
   `*words` of them are shown, which is set to how many are, so that texts of a kind can be shortened alike.
   Where something happened "at t = 3" what happened comes first. */
const char *gm_labels_shorten_number(struct gm_label_list *list, enum gm_text_size size, const char *text,
                                     double width, size_t *words);
/* The bytes before the number that a text tells; 0: none, or it tells when something happened. */
size_t gm_before_number(const char *text);

/* The text, or a front of it that says something whole; "" if neither fits. */
const char *gm_labels_whole(struct gm_label_list *list, enum gm_text_size size, const char *text,
                            double width);

/* Writes the name of a lane without the keys of its values, which are one word: of "Verlet, Δt = 0.1"
   "Verlet, 0.1". */
void gm_name_without_keys(const char *name, char *text, size_t size);

/* Breaks a text at blanks into at most `most` lines of a width, the last shortened; returns their number. */
size_t gm_labels_wrap(const struct gm_label_list *list, enum gm_text_size size, const char *text,
                      double width, size_t most, const char **lines);

/* Whether lines of gm_labels_wrap hold all of the text. */
bool gm_lines_are_whole(const char *const *lines, size_t count, const char *text);

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
