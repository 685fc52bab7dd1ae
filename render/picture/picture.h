/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_PICTURE_PICTURE_H
#define GM_RENDER_PICTURE_PICTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* A picture is plain data: panels with axes and marks, in the units of the model. Pixels, colours and fonts
   belong to the painters (GL, terminal, data). It lives in an arena that gm_picture_clear empties: one
   picture is redrawn for every frame. */

/* The meaning of a colour; a theme defines the colour. */
enum gm_role {
    GM_PAPER,
    GM_INK,
    GM_SECONDARY,
    GM_GRID,
    GM_INITIAL, /* the initial state: red */
    GM_EXACT,   /* the exact solution: grey */
    GM_OVER,    /* lines over a field of colours: near white in every theme */
    GM_LANE,    /* GM_LANE + i is the colour of lane i, 0 <= i < GM_LANE_COLOURS */
    GM_ROLE_COUNT = GM_LANE + 6,
};
enum { GM_LANE_COLOURS = 6 };

enum gm_dash {
    GM_SOLID,
    GM_LONG_DASH,
    GM_DOTS,
    GM_DASH_DOT,
    GM_SHORT_DASH,
    GM_DASH_DOT_DOT,
    GM_DASH_COUNT,
};

/* Lane i has role GM_LANE + i and dash i everywhere (modulo their counts). */
enum gm_role gm_lane_role(size_t lane);
enum gm_dash gm_lane_dash(size_t lane);

struct gm_style {
    enum gm_role role;
    double alpha; /* 0 to 1 */
    double width; /* width of a line or diameter of a point, in pixels of a picture 720 high */
    enum gm_dash dash;
};

enum gm_colour_map { GM_MAP_SEQUENTIAL, GM_MAP_DIVERGING }; /* perceptually uniform colour maps */

enum gm_mark_kind {
    GM_MARK_LINE, /* points joined; also to the first if `closed` */
    GM_MARK_POINTS,
    GM_MARK_POLYGON, /* filled, even-odd */
    GM_MARK_MESH,    /* triangles coloured by a value at each vertex */
    GM_MARK_IMAGE,   /* a grid of values over a rectangle */
    GM_MARK_TEXT,    /* near points[0], opaque; left out without room beside other labels */
};

/* The shape of points. */
enum gm_glyph { GM_DISC, GM_RING, GM_HALF_DISC, GM_DOTTED_RING, GM_CROSS };

enum gm_anchor { GM_ANCHOR_LEFT, GM_ANCHOR_CENTRE, GM_ANCHOR_RIGHT };

struct gm_mark {
    enum gm_mark_kind kind;
    struct gm_style style;
    enum gm_glyph glyph;
    bool closed;
    const double *points; /* count pairs x, y in the panel's units; image: 2 corners (low, high) */
    size_t count;
    const int *triangles; /* mesh: triangle_count triples of vertex numbers */
    size_t triangle_count;
    const double *values; /* mesh: count; image: rows * columns, row by row from the bottom */
    const double *light;  /* mesh: count, by which colours are multiplied, from 0 to 1; NULL: 1 */
    size_t rows, columns;
    enum gm_colour_map map;
    double low, high;  /* the values at the ends of the colour map */
    bool below, above; /* some values lie beyond low or high, by a hundredth of the range at least */
    const char *text;
    enum gm_anchor anchor;
    bool fixed; /* a text stays at its place and does not move to find room */
    double least,
        most; /* dots of the shorter sides of panels that show it: from least to below most; 0: any */
    struct gm_mark *next;
};

enum gm_scale { GM_LINEAR, GM_LOG, GM_PI /* linear, ticks at fractions of pi */ };

struct gm_axis {
    const char *label; /* name and unit; "" for none */
    enum gm_scale scale;
    double low, high;    /* the range shown, low < high; positive on a log axis */
    const double *ticks; /* rising values of ticks, used if they have room; NULL: round values */
    size_t tick_count;
    double least_tick,
        largest_tick; /* range of ticks on an axis longer than the data; equal: the whole axis */
};

/* The place of a panel: states share a grid on the left, graphs are on the right. */
enum gm_place { GM_PLACE_STATE, GM_PLACE_GRAPH };

/* The name of a line in its colour, with its dash, under a panel's title. */
struct gm_key {
    const char *name;
    struct gm_style style;
    struct gm_key *next;
};

struct gm_panel {
    enum gm_place place;
    const char *title; /* "" for none */
    const char *note;  /* one line under the title, in secondary ink; "" for none */
    enum gm_role title_role;
    struct gm_axis x, y;
    bool equal;      /* one unit is equally long on both axes */
    bool axes;       /* axes, ticks and grid are drawn */
    bool colour_bar; /* colour bar of the first mesh or image */
    const char *colour_bar_label;
    struct gm_key *first_key, *last_key; /* shown on the note's line if the note is empty */
    struct gm_mark *first, *last;
    struct gm_panel *next;
};

/* A paragraph of text about a picture, as in a lecture. */
struct gm_paragraph {
    const char *text;
    enum gm_role role;
    bool bold;
};

struct gm_picture {
    const char *title, *subtitle;
    const char *clock;               /* top right */
    const char *caption;             /* a sentence along the bottom; "" for none */
    const struct gm_paragraph *told; /* told_count paragraphs below all else, instead of the caption */
    size_t told_count, told_lines; /* least number of lines for them, so that the panels above do not move */
    size_t state_columns;          /* columns of the grid of states; 0: as many as make them largest */
    bool graphs_below; /* graphs may be in a row under the states, if the states are then larger */
    struct gm_panel *first, *last;
    struct gm_picture_store *arena;
};

/* Returns an empty picture; NULL when out of memory. */
struct gm_picture *gm_picture_open(void);
void gm_picture_close(struct gm_picture *picture);
void gm_picture_clear(struct gm_picture *picture);

/* Calls draw(data, picture). Panels and marks are added by such a body, which ends early when memory runs short:
   what was drawn until then remains, and the result is false. Bodies may be nested. */
bool gm_picture_draw(struct gm_picture *picture, void (*draw)(const void *data, struct gm_picture *picture),
                     const void *data);

/* Returns memory of the picture's arena, aligned for doubles, until the next clear. When out of memory it leaves
   the body that draws; NULL outside of one. */
void *gm_picture_memory(struct gm_picture *picture, size_t size);
/* Returns a formatted text in the arena. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
const char *
gm_picture_text(struct gm_picture *picture, const char *format, ...);

struct gm_panel *gm_panel_add(struct gm_picture *picture, enum gm_place place, const char *title);

/* Adds a name to the panel's keys, for a line without another label. */
void gm_panel_key(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                  const char *name);

/* Marks. Points are copied. A line breaks where a coordinate is not finite, or not positive on a log axis, so
   that a NaN never reaches a painter. The panel's axes must be set before its marks. A mark that is not shown
   (no points, no memory) may still be written to. The first piece of a line with breaks is returned. */
struct gm_mark *gm_mark_line(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                             const double *points, size_t count, bool closed);
struct gm_mark *gm_mark_points(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                               const double *points, size_t count);
struct gm_mark *gm_mark_polygon(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                                const double *points, size_t count);
struct gm_mark *gm_mark_text(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                             double x, double y, enum gm_anchor anchor, const char *text);
struct gm_mark *gm_mark_mesh(struct gm_picture *picture, struct gm_panel *panel, enum gm_colour_map map,
                             double low, double high, const double *points, const double *values,
                             size_t count, const int *triangles, size_t triangle_count);
struct gm_mark *gm_mark_image(struct gm_picture *picture, struct gm_panel *panel, enum gm_colour_map map,
                              double low, double high, const double corners[4], const double *values,
                              size_t rows, size_t columns);
/* Adds marks of another panel to one with the same axes: from `first` to `last`, whose points both share. */
void gm_marks_repeat(struct gm_picture *picture, struct gm_panel *panel, const struct gm_mark *first,
                     const struct gm_mark *last);
/* Returns true if a panel of that width and height, in dots of its painter, shows the mark. */
bool gm_mark_is_shown(const struct gm_mark *mark, double width, double height);
/* Adds the lines of equal value of a triangle mesh, at `levels`. */
void gm_mark_level_lines(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                         const double *points, const double *values, size_t count, const int *triangles,
                         size_t triangle_count, const double *levels, size_t level_count);

/* Widens [*low, *high] to hold value (ignored unless finite). An empty range begins with low > high. */
void gm_range_add(double *low, double *high, double value);
/* Widens a range to round bounds, so that axes change in rare steps. Empty ranges become [0, 1]. */
void gm_range_round(double *low, double *high, enum gm_scale scale);

#endif
