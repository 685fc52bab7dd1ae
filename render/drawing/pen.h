/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_DRAWING_PEN_H
#define GM_RENDER_DRAWING_PEN_H

#include "render/drawing/glyphs.h"
#include "render/drawing/polyline.h"
#include "render/layout/surface.h"
#include "render/layout/theme.h"

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

#endif
