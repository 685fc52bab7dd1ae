/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_DRAWING_PEN_H
#define GM_RENDER_DRAWING_PEN_H

#include <stdbool.h>
#include <stddef.h>

#include "render/drawing/glyphs.h"
#include "render/layout/appearance.h"
#include "render/layout/layout.h"
#include "render/layout/panel.h"
#include "render/message.h"

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

/* What draws: the few operations that a picture is made of. Triangles, SVG and PDF each have them. Places and
   lengths are in pixels of the picture, y downwards; what is drawn later lies over what was drawn before. */

struct gm_ink {
    struct gm_rgb colour;
    double alpha; /* 0 to 1, else clamped */
};

enum { GM_DASH_PARTS = 6 };

/* Where dots are lengths of 0 Cairo leaves out those among dashes: drawings have this
   length for them, in widths of the line. */
#define GM_SHORTEST_DASH 0.25f

/* A line has round joints and ends. */
struct gm_stroke {
    float width;
    struct gm_ink ink;
    /* Lengths drawn and left out in turn, `parts` of them; 0: solid. Ends are round: half a width reaches out
       on both sides, so that a length of 0 is a dot. */
    float pattern[GM_DASH_PARTS];
    size_t parts;
};

struct gm_writing {
    enum gm_font font;
    int letters;           /* their height (the em) */
    double x, y;           /* where the text begins on its baseline */
    double width;          /* of all of it */
    enum gm_anchor anchor; /* which of its ends keeps its place in other fonts */
    bool upwards;
    struct gm_ink ink;
};

struct gm_pen {
    /* Nothing outside of this rectangle is touched from now on. */
    void (*clip)(void *self, int left, int top, int width, int height);
    /* An upright rectangle; its edges lie on whole pixels. */
    void (*box)(void *self, float left, float top, float right, float bottom, struct gm_ink ink);
    void (*line)(void *self, const struct gm_polyline *line, const struct gm_stroke *stroke);
    void (*disc)(void *self, struct gm_point centre, float width, struct gm_ink ink);
    /* The inside of a closed line (even-odd). */
    void (*fill)(void *self, const struct gm_polyline *line, struct gm_ink ink);
    /* A mesh or an image: values between those given are interpolated, and then get their colour. */
    void (*field)(void *self, const struct gm_axes *frame, const struct gm_mark *mark);
    /* The colours of a map, its low end at the bottom of the box. */
    void (*ramp)(void *self, struct gm_box box, enum gm_colour_map map);
    void (*text)(void *self, const struct gm_writing *writing, const char *text);
};

/* What draws a layout with a pen, alike for all pens: the sizes of letters and strokes, the look, and memory
   that is used again for every frame. Each of its functions has a file of its own. */
struct gm_painter {
    const struct gm_pen *pen;
    void *self; /* of the pen */
    struct gm_appearance look;
    double scale;                    /* pixels for a pixel of a picture 720 high */
    double density;                  /* pixels for one of a screen, which is 1/96 inch */
    double enlarged;                 /* how many times letters are larger than usual; at least 1 */
    int letters[GM_TEXT_SIZE_COUNT]; /* heights of letters (em) */
    struct gm_glyphs *glyphs;
    struct gm_polyline line, piece;
};

/* marks.c: everything of a panel's data but its texts. */
void gm_paint_marks(struct gm_painter *painter, const struct gm_axes *axes);

/* frame.c: grid, marks, axes and colour bar. */
void gm_paint_axes(struct gm_painter *painter, const struct gm_axes *axes);

/* text.c: every label of the layout, those among the marks on plates of paper; and the layout's view of the
   fonts, whose self is the painter. */
void gm_paint_labels(struct gm_painter *painter, const struct gm_layout *layout);
struct gm_metrics gm_painter_metrics(const struct gm_painter *painter);

/* A page that is drawn with one pen in one look, as often as its picture changes. */

/* False on failure, with one sentence in message (GM_MESSAGE bytes) and errno (gm_glyphs_open). To be closed in both
   cases. */
bool gm_page_open(struct gm_painter *painter, const struct gm_pen *pen, void *self,
                  const struct gm_appearance *look, char *message);
void gm_page_close(struct gm_painter *painter);

/* Lays the picture out and draws it. False when memory is short. */
bool gm_page_draw(struct gm_painter *painter, struct gm_picture *picture);

#endif
