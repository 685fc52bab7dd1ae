/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_TERMINAL_DISPLAY_H
#define GM_APP_EXPLORER_TERMINAL_DISPLAY_H

#include "app/explorer/terminal/pixels.h"
#include "app/explorer/terminal/writer.h"
#include "render/cells/cells.h"

/* Shows composed screens on the terminal, with the picture of pixels that a screen leaves room for. Such a
   picture is painted beside, so a screen with a new one is shown a little later than it was composed, both
   together. Nothing waits for the terminal. */

struct gm_display {
    struct gm_writer writer;
    struct gm_terminal *terminal;
    int wake;
    struct gm_pixels *painter; /* NULL until it is needed */
    bool stale;                /* there is a newer picture than the one that was begun last */
    bool lost;                 /* the terminal may have lost parts of what it was sent */
    bool painted;              /* `bytes` wait to be shown */
    bool failed;               /* there is no font: no pixels */
    enum gm_inline_kind shown; /* what the terminal shows */
    struct gm_pixels_job job;  /* the last that was begun */
    const char *bytes;
    size_t size;
};

/* `wake` is an eventfd that is written to when a picture is ready. False when memory is short. */
bool gm_display_open(struct gm_display *display, struct gm_terminal *terminal, int wake);
void gm_display_close(struct gm_display *display);

/* A composed screen. */
struct gm_composed {
    const struct gm_cells *cells;
    struct gm_inline_place room; /* cells without a glyph, for a picture of pixels; no columns: none */
    enum gm_inline_kind pixels;  /* of what kind */
    enum gm_theme theme;
    struct gm_picture *picture; /* for that room; NULL: none */
};

/* Whether a screen can be shown now. Until then also the picture of the last one may be in use. */
bool gm_display_takes(struct gm_display *display);
/* Shows a screen. False if its picture has to be painted first: then that is in use until gm_display_takes,
   and the screen is to be shown again. */
bool gm_display_show(struct gm_display *display, const struct gm_composed *screen);
/* Sends what the terminal takes now. False when it is gone. */
bool gm_display_send(struct gm_display *display);
/* How long to wait for the terminal, in milliseconds; -1: there is nothing to wait for. */
int gm_display_patience(const struct gm_display *display);

/* The picture is another one. */
void gm_display_renew(struct gm_display *display);
/* The terminal may show anything. */
void gm_display_forget(struct gm_display *display);
/* Takes a picture that is ready; whether there was one. */
bool gm_display_read(struct gm_display *display);
/* Waits until no picture is in use: before what it belongs to is closed. */
void gm_display_finish(struct gm_display *display);

/* The panel of a state that a cell of the shown picture of pixels is in, and the place in its own units; NULL
   if there is none. */
const struct gm_panel *gm_display_locate(struct gm_display *display, struct gm_picture *picture, int column,
                                         int row, double *x, double *y);

/* Before the terminal goes back to the shell: removes what text does not cover, sends what is under way, and
   awaits the answers that the shell would take for keys. */
void gm_display_rest(struct gm_display *display);

#endif
