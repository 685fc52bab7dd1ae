/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_TERMINAL_PIXELS_H
#define GM_APP_EXPLORER_TERMINAL_PIXELS_H

#include "render/files/inline_image.h"
#include "render/layout/theme.h"

/* The thread that paints pictures and encodes them for a terminal that shows pixels, so that neither keys nor steps wait
   for it. One picture at a time. */

struct gm_pixels;

struct gm_pixels_job {
    enum gm_inline_kind kind;
    enum gm_theme theme;
    struct gm_inline_place place;
    int most_width, most_height; /* as for gm_inline_open */
    bool whole;                  /* the terminal may have lost what was sent before */
};

/* `wake` is an eventfd that is written to when a picture is ready. NULL with a sentence (GM_MESSAGE
   bytes). */
struct gm_pixels *gm_pixels_open(int wake, char *message);
void gm_pixels_close(struct gm_pixels *pixels);

/* Begins a picture, which stays the painter's until gm_pixels_take tells of it. Not while it is busy. */
void gm_pixels_paint(struct gm_pixels *pixels, struct gm_picture *picture, const struct gm_pixels_job *job);
/* Whether a picture was begun and not yet taken. */
bool gm_pixels_busy(const struct gm_pixels *pixels);

/* The panel of a state that a pixel of the picture painted last is in, as gm_canvas_locate. Not while
   busy. */
const struct gm_panel *gm_pixels_locate(struct gm_pixels *pixels, struct gm_picture *picture, double across,
                                        double down, double *x, double *y);

/* Once for each picture, when it is ready: its bytes, which stay until the next is begun. With them NULL it
   failed, for the reason in `message` (GM_MESSAGE bytes). */
bool gm_pixels_take(struct gm_pixels *pixels, const char **bytes, size_t *size, char *message);

#endif
