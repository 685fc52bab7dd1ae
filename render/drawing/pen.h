/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_DRAWING_PEN_H
#define GM_RENDER_DRAWING_PEN_H

#include <stdbool.h>
#include <stddef.h>

#include "render/drawing/glyphs.h"
#include "render/layout/appearance.h"
#include "render/layout/panel.h"
#include "render/message.h"

/* Polylines in pixels, before they become triangles. All buffers grow and stay. */

struct gm_point {
    float x, y;
};

static inline struct gm_point gm_point_minus(struct gm_point a, struct gm_point b)
{
    return (struct gm_point){a.x - b.x, a.y - b.y};
}

static inline float gm_point_dot(struct gm_point a, struct gm_point b)
{
    return a.x * b.x + a.y * b.y;
}

struct gm_polyline {
    struct gm_point *points;
    size_t count, capacity;
    bool closed; /* the last point is joined to the first */
};

/* Makes room for count points; their contents are lost. Returns false when out of memory. */
bool gm_polyline_reserve(struct gm_polyline *line, size_t count);
void gm_polyline_free(struct gm_polyline *line);

struct gm_bounds {
    float left, top, right, bottom;
};

/* Gives the next piece of a line inside bounds, from *from on, and moves *from past it. Returns false at the
   end. A line wholly inside is one piece and stays closed. */
bool gm_polyline_clip(const struct gm_polyline *line, struct gm_bounds bounds, size_t *from,
                      struct gm_polyline *piece);

/* Removes points, in place, such that the line moves by at most `tolerance`. */
void gm_polyline_simplify(struct gm_polyline *line, float tolerance);

/* Cuts a line into dashes: pattern is lengths drawn and left out in turn; a drawn length of 0 is a dot.
   *state begins zeroed; returns false at the end. */
struct gm_dashing {
    size_t segment, part;
    float within; /* length of the segment already used */
};
bool gm_polyline_dash(const struct gm_polyline *line, const float *pattern, size_t parts,
                      struct gm_dashing *state, struct gm_polyline *dash);

float gm_polyline_length(const struct gm_polyline *line);

/* A pen: the few operations that draw a picture. Triangles, SVG and PDF each have one. Places and lengths are
   in pixels of the picture, y downwards; later shapes cover earlier ones. */

struct gm_ink {
    struct gm_rgb colour;
    double alpha; /* 0 to 1; clamped */
};

enum { GM_DASH_PARTS = 6 };

/* Cairo omits lengths of 0 among dashes: drawings give these dots this length, in widths of the line. */
#define GM_SHORTEST_DASH 0.25f

/* A line has round joints and ends. */
struct gm_stroke {
    float width;
    struct gm_ink ink;
    /* Lengths drawn and left out in turn, `parts` of them; 0: solid. Round ends reach out by half a width on
       both sides, so a length of 0 is a dot. */
    float pattern[GM_DASH_PARTS];
    size_t parts;
};

struct gm_writing {
    enum gm_font font;
    int letters;           /* height of the letters (the em) */
    double x, y;           /* start of the text on the baseline */
    double width;          /* width of the whole text */
    enum gm_anchor anchor; /* the end that keeps its place in other fonts */
    bool upwards;
    struct gm_ink ink;
};

struct gm_pen {
    /* Clips all later shapes to this rectangle. */
    void (*clip)(void *self, int left, int top, int width, int height);
    /* Draws an upright rectangle with edges on whole pixels. */
    void (*box)(void *self, float left, float top, float right, float bottom, struct gm_ink ink);
    void (*line)(void *self, const struct gm_polyline *line, const struct gm_stroke *stroke);
    void (*disc)(void *self, struct gm_point centre, float width, struct gm_ink ink);
    /* Fills the inside of a closed line (even-odd). */
    void (*fill)(void *self, const struct gm_polyline *line, struct gm_ink ink);
    /* Draws a mesh or an image: values are interpolated, and then coloured. */
    void (*field)(void *self, const struct gm_axes *frame, const struct gm_mark *mark);
    /* Draws the colours of a map, the low end at the bottom of the box. */
    void (*ramp)(void *self, struct gm_box box, enum gm_colour_map map);
    void (*text)(void *self, const struct gm_writing *writing, const char *text);
};

/* The painter draws a layout with any pen: sizes of letters and strokes, the look, and buffers reused for
   every frame. */
struct gm_painter {
    const struct gm_pen *pen;
    void *self; /* state of the pen */
    struct gm_appearance look;
    double scale;                    /* pixels per pixel of a picture 720 high */
    double density;                  /* pixels per pixel of a screen, which is 1/96 inch */
    double enlarged;                 /* factor of letters against their usual size; at least 1 */
    int letters[GM_TEXT_SIZE_COUNT]; /* heights of letters (em) */
    struct gm_glyphs *glyphs;
    struct gm_polyline line, piece;
};

/* The layout's view of the fonts; the painter is its self. */
struct gm_metrics gm_painter_metrics(const struct gm_painter *painter);

/* A cell of the screen of a terminal has GM_CELL_WIDTH x GM_CELL_HEIGHT pixels. */
enum { GM_CELL_WIDTH = 9, GM_CELL_HEIGHT = 18 };

/* A page that is drawn with one pen in one look, as often as its picture changes. */

/* Returns false on failure, with a sentence in message (GM_MESSAGE bytes) and errno (gm_glyphs_open). The
   caller closes the page in both cases. */
bool gm_page_open(struct gm_painter *painter, const struct gm_pen *pen, void *self,
                  const struct gm_appearance *look, char *message);
void gm_page_close(struct gm_painter *painter);

/* Lays the picture out and draws it. Returns false when out of memory. */
bool gm_page_draw(struct gm_painter *painter, struct gm_picture *picture);

#endif
