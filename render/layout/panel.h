/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_LAYOUT_PANEL_H
#define GM_RENDER_LAYOUT_PANEL_H

#include <stddef.h>

#include "render/picture/picture.h"

/* The round values of an axis, and their labels. */

enum { GM_TICK_MAX = 12 };

/* Gives the range that the axis shows: never empty, positive on a log axis. */
void gm_axis_shown(const struct gm_axis *axis, double *low, double *high);

/* Gives round tick values of a range, at least 3 if possible, at most max <= GM_TICK_MAX. Returns their
   number. */
size_t gm_ticks(const struct gm_axis *axis, size_t max, double *values);
/* Writes a tick's label: a true minus sign, pi/2, powers of ten with superscripts. `step` is the distance of
   ticks. */
void gm_tick_format(enum gm_scale scale, double value, double step, char *text, size_t size);

/* The contents of a surface, as plain data. Painters differ in how they measure text and in their unit (a
   pixel; for the terminal a part of a cell). y grows downwards. */

enum gm_text_size { GM_TEXT_TITLE, GM_TEXT_PANEL, GM_TEXT_LABEL, GM_TEXT_TICK, GM_TEXT_SIZE_COUNT };

struct gm_metrics {
    double width, height;            /* size of the surface */
    double line[GM_TEXT_SIZE_COUNT]; /* height of a line of text of each size */
    /* Returns the width of a text in its font: titles and panel names are bold, the clock is in the title's
       size. */
    double (*measure)(const void *self, enum gm_text_size size, const char *text);
    const void *self;
    double scale; /* surface units per pixel of a picture 720 high */
    bool terse;   /* leaves out the subtitle and all graphs but the first */
};

struct gm_box {
    double x, y, width, height;
};

struct gm_tick {
    double position; /* place on the surface */
    double value;
    const char *label;
};

struct gm_label { /* a text placed on the surface */
    const char *text;
    enum gm_text_size size;
    enum gm_role role;
    double x, y; /* place of the anchor; y is the top of the line */
    enum gm_anchor anchor;
    bool bold, mono;
    bool vertical;    /* reads upwards; x is then the left edge, y the middle of the height */
    bool among_marks; /* a text of a panel's data, to be legible on all marks */
};

struct gm_axes { /* a panel on the surface */
    const struct gm_panel *panel;
    struct gm_box box; /* the data; marks are clipped to it */
    /* surface = origin + factor * value (of log10 of the value on a log axis) */
    double x_origin, x_factor, y_origin, y_factor;
    struct gm_tick x_ticks[GM_TICK_MAX], y_ticks[GM_TICK_MAX];
    size_t x_tick_count, y_tick_count;
    struct gm_box colour_bar; /* width 0: none */
    double bar_tip[2];        /* heights of the tips below and above the bar, if values lie beyond; 0: none */
    struct gm_tick bar_ticks[GM_TICK_MAX];
    size_t bar_tick_count;
};

/* A place in a state's panel, in units of its axes. The panel is NULL beside all states, and on logarithmic axes. */
struct gm_spot {
    const struct gm_panel *panel;
    double x, y;
};

/* Returns the part of a text's width on the left of its anchor: 0, 1/2 or 1. */
double gm_anchor_share(enum gm_anchor anchor);

/* Returns the mark of a panel that its colour bar explains; NULL without one. */
const struct gm_mark *gm_panel_field(const struct gm_panel *panel);

/* Returns the surface coordinate of a value on a frame's axes. */
double gm_axes_x(const struct gm_axes *axes, double value);
double gm_axes_y(const struct gm_axes *axes, double value);

/* Returns the value of an image at a place, from 0 to 1 from the left and from the bottom: bilinear between
   the middles of the cells. */
double gm_image_value(const struct gm_mark *image, double across, double up);

/* Rounds towards zero, within the bounds; NaN becomes the lower one. */
int gm_clamp(double value, int low, int high);

/* Pixels from a place of the surface on; `across` and `down` are their numbers in a unit of it. */
struct gm_pixel_grid {
    double left, top, across, down;
    int clip[4]; /* {left, top, right, bottom}: the pixels that are wanted */
};
typedef void gm_pixel_put(void *self, const struct gm_mark *mark, int x, int y, double value, double light);

/* Calls `put` for every pixel whose middle is in a triangle of a mesh, or on an edge of it, with the value and
   the light there, which are linear in the triangle. */
void gm_mesh_walk(const struct gm_axes *axes, const struct gm_mark *mark, const struct gm_pixel_grid *pixels,
                  gm_pixel_put *put, void *self);

/* Returns true if boxes overlap. Neighbours in a line need air, lines may touch, and empty boxes overlap
   nothing. */
bool gm_boxes_overlap(const struct gm_box *a, const struct gm_box *b, double air);

/* The labels of a layout under construction. A label is taken only if it is wholly on the surface and on no
   earlier label, so their order is their rank. */

struct gm_label_list {
    struct gm_picture *picture;
    const struct gm_metrics *metrics;
    struct gm_label *labels;
    struct gm_box *boxes; /* the boxes of the labels */
    size_t count, capacity;
};

/* Returns false when out of memory. */
bool gm_labels_open(struct gm_label_list *list, struct gm_picture *picture, const struct gm_metrics *metrics,
                    size_t capacity);

/* Returns true if the label was taken. Empty texts never are. */
bool gm_labels_add(struct gm_label_list *list, struct gm_label label);

double gm_labels_width(const struct gm_label_list *list, enum gm_text_size size, const char *text);

/* Returns the text, shortened to width with an ellipsis if needed; "" if not even that fits. A word with a
   figure in it is not cut. */
const char *gm_labels_shorten(const struct gm_label_list *list, enum gm_text_size size, const char *text,
                              double width);

/* Shortens a text with a number, such as "energy error now 2.4·10⁻³". The last words before the number give
   way first; the number is whole, or the text is "". At most `*words` words are shown, and `*words` is set to
   their number, so that similar texts can be shortened alike. Of an event "at t = 3" the time gives way. */
const char *gm_labels_shorten_number(struct gm_label_list *list, enum gm_text_size size, const char *text,
                                     double width, size_t *words);
/* Returns the bytes before the number of a text; 0 without a number, or if it is the time of an event. */
size_t gm_before_number(const char *text);

/* Returns the text, or a complete front of it; "" if neither fits. */
const char *gm_labels_whole(struct gm_label_list *list, enum gm_text_size size, const char *text,
                            double width);

/* Writes the name of a lane without keys that are one word: "Verlet, Δt = 0.1" becomes "Verlet, 0.1". */
void gm_name_without_keys(const char *name, char *text, size_t size);

/* Breaks a text at blanks into at most `most` lines of a width, the last shortened; returns their number. */
size_t gm_labels_wrap(const struct gm_label_list *list, enum gm_text_size size, const char *text,
                      double width, size_t most, const char **lines);

/* Returns true if lines of gm_labels_wrap hold all of the text. */
bool gm_lines_are_whole(const char *const *lines, size_t count, const char *text);

/* One panel of a layout: the room for its texts around the data, and its axes once its box is set. */

/* The details of a panel besides its data, in the order in which they give way when room is short. */
enum gm_detail {
    GM_DETAIL_ALL,
    GM_DETAIL_NO_NOTE,
    GM_DETAIL_NO_AXIS_LABELS,
    GM_DETAIL_NO_TICKS,
    GM_DETAIL_DATA
};

/* Most lines of a title, and of a key. */
enum { GM_TITLE_LINES = 3, GM_KEY_LINES = 3 };

struct gm_border {
    double left, right, top, bottom;
    double bar;        /* room of a colour bar, beyond `right` */
    size_t note_lines; /* lines under the title that `top` has room for */
};

/* Returns the room around the data. With `calm`, tick labels have a usual width, so that decisions do not
   change from frame to frame. */
struct gm_border gm_border_of(const struct gm_label_list *list, const struct gm_panel *panel,
                              enum gm_detail detail, bool x_label, bool calm);

/* Returns the number of lines of the panel's keys in a width; 1 without keys. */
size_t gm_key_lines(const struct gm_label_list *list, const struct gm_panel *panel, double width);

/* Gives the range shown: not empty; logarithms, of positive values, on log axes. */
void gm_axis_range(const struct gm_axis *axis, double *low, double *high);

/* The contents of a panel of a group. */
struct gm_fill {
    struct gm_box box; /* the data */
    enum gm_detail detail;
    bool x_label;       /* the x axis is named */
    size_t note_lines;  /* lines of the group's notes and keys: all titles are above this number */
    size_t note_words;  /* most words before a note's number */
    bool small_title;   /* the group's titles are too long for their usual size */
    size_t title_lines; /* lines that have room */
    size_t title_skip; /* bytes at the front of the title that the whole group shares and that are left out */
    double title_left, title_width; /* room for titles, which begin at the box if they fit */
};

/* Maps the panel to the box, and places ticks and labels. */
void gm_axes_fill(struct gm_label_list *list, struct gm_axes *axes, const struct gm_panel *panel,
                  const struct gm_fill *fill);

/* Places a text among the marks of frame `own`, after all other labels: on its own data, and on none of the
   other `count` frames. */
void gm_axes_note(struct gm_label_list *list, const struct gm_axes *axes, size_t count, size_t own,
                  const struct gm_mark *mark);

/* The layout of a picture on a surface of given size, the same for all painters. */

struct gm_layout {
    struct gm_axes *frames;
    size_t frame_count;
    struct gm_label *labels; /* all texts, even those among the marks and of ticks */
    size_t label_count;
};

/* Lays the picture out. The result lives in the picture's arena until its next clear; NULL when out of
   memory. Labels never overlap or leave the surface: a label without room is left out. */
const struct gm_layout *gm_layout_make(struct gm_picture *picture, const struct gm_metrics *metrics);

/* Returns the spot at a place of the surface. */
struct gm_spot gm_layout_locate(const struct gm_layout *layout, double across, double down);

#endif
