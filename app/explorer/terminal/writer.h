/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_TERMINAL_WRITER_H
#define GM_APP_EXPLORER_TERMINAL_WRITER_H

#include "app/explorer/terminal/terminal.h"

/* Writes screens of cells to the terminal, only what changed since the last one, and never waits for it.
 *
 * The whole screen goes this way, not the picture's rectangle alone. Were ncurses to own the rest, two
 * writers would keep two ideas of the cursor, the colours in force and of what the terminal shows; every
 * resize, scroll and suspension would have to be healed in both. ncurses knows true colour only where TERM
 * ends in -direct, and its output blocks. So ncurses sets the terminal up, reads the keys, knows terminfo and
 * restores everything at the end; its own screen stays blank and is refreshed once, at the start. */

enum { GM_WRITER_FLYING = 64 };

struct gm_writer {
    int fd;
    bool own_fd;
    enum gm_colours colours;
    enum gm_theme theme;
    bool bright; /* 16 colours: the terminal has the upper eight as colours of their own */
    /* capabilities of terminfo; NULL where it has none */
    const char *place, *plain, *strong, *reversed, *set_foreground, *set_background;
    bool corner;           /* the last cell of the screen may be written without a scroll */
    struct gm_cells shown; /* what the terminal shows, once all is sent */
    bool known;            /* that is so */
    char *out;
    size_t length, capacity, sent;
    bool failed; /* memory is short or the terminal is gone */
    /* screens that the terminal was asked about: how many, and the sizes of those it has not yet answered */
    bool asks;
    unsigned long asked, answered; /* or given up */
    unsigned long heard;           /* answers that did come */
    size_t flying[GM_WRITER_FLYING];
    int64_t sent_at[GM_WRITER_FLYING]; /* and when, in milliseconds */
    int64_t asked_at;                  /* the last one, or the last answer */
    int trip;                          /* milliseconds that an answer takes at the least */
    size_t bound;                      /* so many bytes may be on their way */
    /* the state of the terminal */
    int column, row;
    long foreground, background; /* -1: unknown */
    bool bold, reverse;
    int16_t *nearest; /* 256 colours: the index for 15 bits of colour, -1 if not yet known */
};

bool gm_writer_open(struct gm_writer *writer, const struct gm_terminal *terminal);
/* Waits up to half a second for what is under way, so that no sequence is cut in two. */
void gm_writer_close(struct gm_writer *writer);

/* Whether everything was sent. */
bool gm_writer_idle(const struct gm_writer *writer);
/* Whether another screen may be drawn: everything was sent, and not too much of it is still on its way. A
   terminal at the end of a long line is asked after each screen whether it has read it, because otherwise
   seconds of frames would pile up in the line, and keys be answered behind them. Where answers come much
   later than the way there and back takes, less is sent, down to one screen at a time. `ready` counts the
   answers. */
bool gm_writer_takes(struct gm_writer *writer, unsigned long ready);
/* How long to wait for such an answer before it is given up, in milliseconds; -1: none is awaited. */
int gm_writer_patience(const struct gm_writer *writer);
/* A picture of pixels among the cells, as bytes. */
struct gm_writer_image {
    const char *bytes;
    size_t size;
};

/* Takes a screen; what differs from the last one is put in line, and the image with it (NULL: none is to be
   sent). Cells without a glyph are the image's. Only when idle. */
void gm_writer_draw(struct gm_writer *writer, const struct gm_cells *cells,
                    const struct gm_writer_image *image);
/* Offers a text to the clipboard of the terminal (OSC 52); most ask the user first, or need to be told that
   they may. Only when idle, or after something else was put in line. */
void gm_writer_copy(struct gm_writer *writer, const char *text);
/* Puts something in line that is not seen on the screen. Only when idle. */
void gm_writer_tell(struct gm_writer *writer, const char *text);
/* Sends what the terminal takes now. False when it is gone. */
bool gm_writer_send(struct gm_writer *writer);
/* Drops what is not sent yet, for which there is no time left; a sequence that is cut by that is ended. */
void gm_writer_cut(struct gm_writer *writer);
/* The terminal may show anything: the next screen is written in full. */
void gm_writer_forget(struct gm_writer *writer);

#endif
