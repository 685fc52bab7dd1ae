/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_TERMINAL_DEVICE_H
#define GM_APP_EXPLORER_TERMINAL_DEVICE_H

#include <stdbool.h>
#include <stddef.h>

#include "app/base/interrupt.h"
#include "render/cells/cells.h"
#include "render/files/images.h"
#include "render/layout/appearance.h"

/* What a terminal answers when it is asked what it is. The answers arrive among the keys, sometimes late, and
   are sorted out of them here; every other byte stays a key. */

enum { GM_ANSWER_LONGEST = 256, GM_TYPED_AHEAD = 4096 };

struct gm_answers {
    bool attributes;             /* it told its device attributes: it answers questions at all */
    bool sixel;                  /* and sixels are among them */
    bool kitty;                  /* Kitty's images */
    bool synchronised;           /* frames are shown at once (mode 2026) */
    bool true_colour;            /* a colour of 24 bits that was set came back as it was */
    bool ground_told;            /* it told its background, */
    double ground;               /* of this luminance, from 0 to 1 */
    int cell_width, cell_height; /* in pixels; 0: not told */
    int text_width, text_height; /* the whole text area in pixels; 0: not told */
    int registers;               /* colours of a sixel picture; 0: not told */
    int most_width, most_height; /* of a sixel picture; 0: not told */
    unsigned long ready;         /* how often it said that it has read all it was sent */
    /* an answer that has begun */
    char held[GM_ANSWER_LONGEST];
    size_t count;
};

/* Takes what was read; what is no answer goes to `keys`, which has room for count + GM_ANSWER_LONGEST bytes.
   Returns its size. What may still become an answer is kept; gm_answers_release gives it up. */
size_t gm_answers_sort(struct gm_answers *answers, const char *bytes, size_t count, char *keys);
/* The end of what was kept, after a pause that no answer makes. */
size_t gm_answers_release(struct gm_answers *answers, char *keys);

/* What to ask for beside device attributes and synchronised output: a few terminals would show the rest as
   text. The background; that, Kitty's images and colours of 24 bits. */
enum gm_ask { GM_ASK_PLAIN, GM_ASK_GROUND, GM_ASK_ALL };

/* Asks the terminal at standard input and output what it can show and waits for the answers, no longer than
   `patience` milliseconds for each of at most two rounds. What the user typed in the meantime goes to `typed`
   (GM_TYPED_AHEAD bytes). The terminal's settings are as before when it returns. Returns the milliseconds it
   took. */
int gm_answers_ask(struct gm_answers *answers, enum gm_ask which, int patience, char *typed,
                   size_t *typed_size);

/* Asks whether it has read all; answers count up `ready`. */
#define GM_ASK_READY "\033[5n"
/* Asks for the size of a cell. */
#define GM_ASK_CELL "\033[16t"
/* Asks for 256 colours of sixel pictures, where terminals begin with fewer, and for the limits of pictures: what only a
   terminal with pixels is asked. The device attributes come last. */
#define GM_ASK_LIMITS "\033[?1;3;256S\033[?1;1;0S\033[?2;1;0S" GM_ASK_CELL "\033[14t\033[c"

/* The mouse, as terminals report it (SGR, xterm's modes 1002 and 1006): read here rather than by ncurses,
   whose terminfo entries still name the older form, which ends at column 223 and knows no dragging. */

#define GM_MOUSE_ON "\033[?1002h\033[?1006h"
#define GM_MOUSE_OFF "\033[?1006l\033[?1002l"
#define GM_MOUSE_FRONT "\033[<" /* what every report begins with */

enum { GM_KEY_MOUSE = 01200 }; /* the number that ncurses gives to that */

enum gm_mouse_kind { GM_MOUSE_PRESS, GM_MOUSE_DRAG, GM_MOUSE_RELEASE, GM_MOUSE_UP, GM_MOUSE_DOWN };

struct gm_mouse_event {
    enum gm_mouse_kind kind; /* of the left button, or the wheel */
    int column, row;         /* from 0 */
};

struct gm_mouse {
    bool reading;
    char text[24];
    size_t length;
};

enum gm_mouse_result { GM_MOUSE_NOT, GM_MOUSE_PART, GM_MOUSE_EVENT };

/* Takes a key; those that belong to a report are its own. */
enum gm_mouse_result gm_mouse_feed(struct gm_mouse *mouse, int key, struct gm_mouse_event *event);

/* What the terminal can show, and why we think so: option over environment over what the terminal answers
   over terminfo. */

enum gm_colours { GM_COLOURS_NONE, GM_COLOURS_16, GM_COLOURS_256, GM_COLOURS_TRUE };

/* What the user says about the terminal on the command line; NULL: nothing. */
struct gm_overrides {
    const char *colours, *graphics, *theme;
};

/* How pictures are shown: as pixels, or else as one kind of block. Text is ASCII where the blocks are. */
struct gm_graphics {
    enum gm_inline_kind pixels;
    enum gm_blocks blocks;
};

enum { GM_REASON = 160 };

struct gm_terminal {
    const char *name;     /* TERM; "" if it is not set */
    bool input, output;   /* standard input and output are terminals */
    bool known;           /* terminfo has an entry that can address the cursor */
    bool utf8;            /* the locale's letters */
    const char *codeset;  /* as the locale names it */
    int terminfo_colours; /* -1: none */
    int columns, rows;
    int cell_width, cell_height; /* in pixels; 0: unknown */
    enum gm_colours colours;
    struct gm_graphics graphics;
    bool can_pixels[GM_INLINE_COUNT], can_blocks[GM_BLOCKS_COUNT];
    enum gm_theme theme;
    struct gm_answers answers;
    int asked;                  /* milliseconds until the answers were there; -1: it was not asked */
    bool demanded;              /* the graphics, by the user */
    char typed[GM_TYPED_AHEAD]; /* keys that came while it was asked */
    size_t typed_size;
    char colours_why[GM_REASON], graphics_why[GM_REASON], theme_why[GM_REASON], size_why[GM_REASON];
    char kitty_why[GM_REASON], sixel_why[GM_REASON], cell_why[GM_REASON];
};

/* Looks at the options, the environment, the locale and terminfo, and asks the terminal if there is one.
   False with a sentence (GM_MESSAGE bytes) if an override is not understood. */
bool gm_terminal_detect(struct gm_terminal *terminal, const struct gm_overrides *overrides, char *message);

/* Whether the explorer can run here; if not, why, in one sentence. */
bool gm_terminal_serves(const struct gm_terminal *terminal, char *message);

/* The size of the terminal now. */
void gm_terminal_size(int *columns, int *rows);
/* The size of a cell in pixels now, if the system knows it; otherwise both stay. */
void gm_terminal_cell(int *width, int *height);

/* Decides again on graphics, by answers that came late. */
void gm_terminal_reconsider(struct gm_terminal *terminal);

/* The next of the ways to show pictures that this terminal has. */
struct gm_graphics gm_graphics_next(const struct gm_terminal *terminal, struct gm_graphics graphics);

/* `geomint terminal`: what was found and what follows from it. */
int gm_terminal_report(const struct gm_overrides *overrides);

/* The terminal as a device: taken over by ncurses at the start, given back on every way out, its keys and
   signals read. Answers among the keys go to the terminal's answers. */

/* Takes the terminal over. `wake` is an eventfd that signals are announced on. Keys typed before come first.
   False with a sentence (GM_MESSAGE bytes). */
bool gm_console_open(int wake, struct gm_terminal *terminal, char *message);
/* Gives it back. Harmless if it was given back before. Signals are still noted, so that what the explorer has
   to finish is not cut off: SIGINT, SIGTERM and SIGQUIT count as gm_interrupted, the third ends the
   process. */
void gm_console_close(void);
/* Signals do what they did before. */
void gm_console_release(void);

/* The next key of those that have come, as ncurses numbers them; -1 if there is none. */
int gm_console_key(void);
/* How long to wait for the rest of a key or an answer that has begun, in milliseconds; -1 if none has. Then
   gm_console_key takes it as it is. */
int gm_console_patience(void);

/* The signal that asks to leave, or 0. */
int gm_console_leaving(void);
/* Whether the size may have changed since the last call. */
bool gm_console_resized(void);
/* Whether the user asked to suspend (Ctrl-Z) since the last call. */
bool gm_console_stopping(void);
/* Gives the terminal back, stops the process, and takes the terminal over again when it goes on, unless that
   is to leave. */
void gm_console_stop(void);

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

/* Shows composed screens on the terminal, with the picture of pixels that a screen leaves room for. Such a
   picture is painted beside, so a screen with a new one is shown a little later than it was composed, both
   together. Nothing waits for the terminal. */

/* A picture of pixels. */
struct gm_pixels_job {
    enum gm_inline_kind kind;
    enum gm_theme theme;
    struct gm_inline_place place;
    int most_width, most_height; /* as for gm_inline_open */
    bool whole;                  /* the terminal may have lost what was sent before */
};

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
