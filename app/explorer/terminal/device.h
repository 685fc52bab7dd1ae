/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_TERMINAL_DEVICE_H
#define GM_APP_EXPLORER_TERMINAL_DEVICE_H

#include <stdbool.h>
#include <stddef.h>

#include "app/base/interrupt.h"
#include "render/cells/grid.h"
#include "render/files/images.h"
#include "render/layout/appearance.h"

/* The answers of a terminal that is asked about its abilities. They arrive among the keys, sometimes late,
   and are sorted out here; all other bytes are keys. */

enum { GM_ANSWER_LONGEST = 256, GM_TYPED_AHEAD = 4096 };

struct gm_answers {
    bool attributes;             /* the terminal reported device attributes: it answers questions at all */
    bool sixel;                  /* sixels are supported */
    bool kitty;                  /* Kitty's images are supported */
    bool synchronised;           /* frames can be shown at once (mode 2026) */
    bool true_colour;            /* 24-bit colours are supported: one that was set came back unchanged */
    bool ground_told;            /* the terminal reported its background */
    double ground;               /* luminance of the background, 0 to 1 */
    int cell_width, cell_height; /* size of a cell in pixels; 0: not reported */
    int text_width, text_height; /* size of the text area in pixels; 0: not reported */
    int registers;               /* number of colours of a sixel picture; 0: not reported */
    int most_width, most_height; /* limits of a sixel picture in pixels; 0: not reported */
    unsigned long ready;         /* number of reports that all input has been read */
    /* the first `count` bytes of an incomplete answer */
    char held[GM_ANSWER_LONGEST];
    size_t count;
};

/* Sorts the bytes read. Bytes of keys go to `keys`, which has room for count + GM_ANSWER_LONGEST bytes;
   returns their number. The start of a possible answer is held until gm_answers_release. */
size_t gm_answers_sort(struct gm_answers *answers, const char *bytes, size_t count, char *keys);
/* Moves the held bytes to `keys` after a pause longer than any inside an answer; returns their number. */
size_t gm_answers_release(struct gm_answers *answers, char *keys);

/* The questions beyond device attributes and synchronised output, which some terminals would show as text:
   none; the background; that, Kitty's images and 24-bit colours. */
enum gm_ask { GM_ASK_PLAIN, GM_ASK_GROUND, GM_ASK_ALL };

/* Asks the terminal at standard input and output about its abilities, in at most two rounds of at most
   `patience` ms each. Keys typed meanwhile go to `typed` (GM_TYPED_AHEAD bytes). Restores the terminal's
   settings. Returns the duration in ms. */
int gm_answers_ask(struct gm_answers *answers, enum gm_ask which, int patience, char *typed,
                   size_t *typed_size);

/* Asks whether all input has been read; answers count up `ready`. */
#define GM_ASK_READY "\033[5n"
/* Asks for the size of a cell. */
#define GM_ASK_CELL "\033[16t"
/* Asks for 256 colours of sixel pictures, as some terminals start with fewer, and for the limits of
   pictures. Only a terminal with pixels is asked. The device attributes come last. */
#define GM_ASK_LIMITS "\033[?1;3;256S\033[?1;1;0S\033[?2;1;0S" GM_ASK_CELL "\033[14t\033[c"

/* The mouse, as terminals report it (SGR, xterm's modes 1002 and 1006). ncurses does not read it: its
   terminfo entries name the older form, which ends at column 223 and has no dragging. */

#define GM_MOUSE_ON "\033[?1002h\033[?1006h"
#define GM_MOUSE_OFF "\033[?1006l\033[?1002l"
#define GM_MOUSE_FRONT "\033[<" /* the start of every report */

enum { GM_KEY_MOUSE = 01200 }; /* the key number of the start of a report */

enum gm_mouse_kind { GM_MOUSE_PRESS, GM_MOUSE_DRAG, GM_MOUSE_RELEASE, GM_MOUSE_UP, GM_MOUSE_DOWN };

struct gm_mouse_event {
    enum gm_mouse_kind kind; /* the action of the left button or the wheel */
    int column, row;         /* cell of the mouse, from 0 */
};

struct gm_mouse {
    bool reading;
    char text[24];
    size_t length;
};

enum gm_mouse_result { GM_MOUSE_NOT, GM_MOUSE_PART, GM_MOUSE_EVENT };

/* Takes a key; returns GM_MOUSE_NOT if it is not part of a report, GM_MOUSE_EVENT if it completes one. */
enum gm_mouse_result gm_mouse_feed(struct gm_mouse *mouse, int key, struct gm_mouse_event *event);

/* The abilities of the terminal and the reasons: an option precedes the environment, the terminal's
   answers and terminfo. */

enum gm_colours { GM_COLOURS_NONE, GM_COLOURS_16, GM_COLOURS_256, GM_COLOURS_TRUE };

/* The command line's options on the terminal; NULL: not given. */
struct gm_overrides {
    const char *colours, *graphics, *theme;
    const char *shot, *screen, *keys; /* the file of a picture of the explorer, the screen's size, a script */
    const char *words;                /* the words with which `again` repeats it */
};

/* The way to show pictures: as pixels, or else as blocks. Text is ASCII if the blocks are. */
struct gm_graphics {
    enum gm_inline_kind pixels;
    enum gm_blocks blocks;
};

enum { GM_REASON = 160 };

struct gm_terminal {
    const char *name;     /* TERM; "" if it is not set */
    bool input, output;   /* standard input, output is a terminal */
    bool known;           /* terminfo has an entry that can address the cursor */
    bool utf8;            /* the locale uses UTF-8 */
    const char *codeset;  /* the locale's character encoding */
    int terminfo_colours; /* number of colours in terminfo; -1: none */
    int columns, rows;
    int cell_width, cell_height; /* size of a cell in pixels; 0: unknown */
    enum gm_colours colours;
    struct gm_graphics graphics;
    bool can_pixels[GM_INLINE_COUNT], can_blocks[GM_BLOCKS_COUNT];
    enum gm_theme theme;
    struct gm_answers answers;
    int asked;                  /* milliseconds until the answers came; -1: not asked */
    bool demanded;              /* the user chose the graphics */
    char typed[GM_TYPED_AHEAD]; /* keys that came while it was asked */
    size_t typed_size;
    char colours_why[GM_REASON], graphics_why[GM_REASON], theme_why[GM_REASON], size_why[GM_REASON];
    char kitty_why[GM_REASON], sixel_why[GM_REASON], cell_why[GM_REASON];
};

/* Reads the options, the environment, the locale and terminfo, and asks the terminal if there is one.
   Returns false and fills message (GM_MESSAGE bytes) if an option is not understood. */
bool gm_terminal_detect(struct gm_terminal *terminal, const struct gm_overrides *overrides, char *message);

/* Describes an imaginary terminal, whatever is at hand: the options, 80x24 cells, true colours, braille.
   Returns false and fills message if an option is not understood. */
bool gm_terminal_imagine(struct gm_terminal *terminal, const struct gm_overrides *overrides, char *message);

/* Returns true if the explorer can run here; otherwise fills message with the reason. */
bool gm_terminal_serves(const struct gm_terminal *terminal, char *message);

/* Sets the terminal's current size in cells. */
void gm_terminal_size(int *columns, int *rows);
/* Sets the current size of a cell in pixels if the system knows it. */
void gm_terminal_cell(int *width, int *height);

/* Decides on graphics again, from late answers. */
void gm_terminal_reconsider(struct gm_terminal *terminal);

/* Returns the terminal's next way to show pictures. */
struct gm_graphics gm_graphics_next(const struct gm_terminal *terminal, struct gm_graphics graphics);

/* Prints the report of `geomint terminal`; returns an exit status. */
int gm_terminal_report(const struct gm_overrides *overrides);

/* The terminal as a device. ncurses takes it over; every exit restores it. Answers among the keys go to
   terminal->answers. */

/* Takes the terminal over; keys typed earlier come first. `wake` is an eventfd, written on signals.
   Returns false on failure and fills message (GM_MESSAGE bytes). */
bool gm_console_open(int wake, struct gm_terminal *terminal, char *message);
/* Restores the terminal, once. Signals are still noted, so that the explorer can finish files: SIGINT,
   SIGTERM and SIGQUIT set gm_interrupted, the third one ends the process. */
void gm_console_close(void);
/* Restores the former signal handlers. */
void gm_console_release(void);

/* Returns the next available key, as ncurses numbers it; -1 if no key is available. */
int gm_console_key(void);
/* Returns the milliseconds to wait for the rest of an incomplete key or answer, after which gm_console_key
   returns its bytes; -1 if none is incomplete. */
int gm_console_patience(void);

/* Returns the signal that asks to leave, or 0. */
int gm_console_leaving(void);
/* Returns true if the size may have changed since the last call. */
bool gm_console_resized(void);
/* Returns true if the user pressed Ctrl-Z since the last call. */
bool gm_console_stopping(void);
/* Restores the terminal and stops the process. When resumed it takes the terminal over again, unless a
   signal asks it to leave. */
void gm_console_stop(void);

/* Returns a capability of the terminal that ncurses set up; NULL: it has none. */
const char *gm_capability(const char *name);
/* Copies a capability, or NULL, without its padding $<5>, which is for old terminals; returns the bytes. */
size_t gm_capability_copy(const char *capability, char *bytes, size_t size);

/* Writes the changed cells of screens to the terminal, without ever waiting for it. The whole screen goes
   this way. If ncurses owned all but the picture, two writers would track the cursor, the colours and the
   screen's content, and every resize, scroll and suspension would have to repair both. ncurses also needs
   a TERM that ends in -direct for true colour, and its output blocks. So ncurses sets up the terminal,
   reads keys and terminfo, and restores everything at the end; its own screen stays blank and is refreshed
   once, at the start. */

enum { GM_WRITER_FLYING = 64 };

struct gm_writer {
    int fd;
    bool own_fd;
    enum gm_colours colours;
    enum gm_theme theme;
    bool bright; /* 16 colours: the upper eight are separate colours */
    /* capabilities of terminfo; NULL if absent */
    const char *place, *plain, *strong, *reversed, *set_foreground, *set_background;
    bool corner;           /* the last cell of the screen can be written without a scroll */
    struct gm_cells shown; /* the screen that the terminal shows once all is sent */
    bool known;            /* `shown` is valid; else the next screen is written in full */
    char *out;
    size_t length, capacity, sent;
    bool failed; /* out of memory, or the terminal is gone */
    /* questions after screens: their number, and the sizes of unanswered screens */
    bool asks;
    unsigned long asked, answered; /* questions asked, and those answered or given up */
    unsigned long heard;           /* answers received */
    size_t flying[GM_WRITER_FLYING];
    int64_t sent_at[GM_WRITER_FLYING]; /* times (ms) at which those screens were sent */
    int64_t asked_at;                  /* time (ms) of the last question or answer */
    int trip;                          /* the shortest time of an answer, in milliseconds */
    size_t bound;                      /* the most bytes that may be unanswered */
    /* the terminal's cursor, colours and attributes */
    int column, row;
    long foreground, background; /* the current colours; -1: unknown */
    bool bold, reverse;
    int16_t *nearest; /* 256 colours: the index for 15 bits of colour; -1: not computed */
};

bool gm_writer_open(struct gm_writer *writer, const struct gm_terminal *terminal);
/* Waits up to half a second for pending bytes, so that no sequence is cut in two. */
void gm_writer_close(struct gm_writer *writer);

/* Returns true if everything was sent. */
bool gm_writer_idle(const struct gm_writer *writer);
/* Returns true if everything was sent and few enough bytes are unanswered. The terminal is asked after
   each screen whether it has read it: on a slow line, seconds of frames would otherwise queue up and delay
   the response to keys. If answers take much longer than the round trip, less is sent, down to one screen
   at a time. `ready` counts the answers. */
bool gm_writer_takes(struct gm_writer *writer, unsigned long ready);
/* Returns the milliseconds to wait for such an answer; -1 if none is awaited. */
int gm_writer_patience(const struct gm_writer *writer);
/* A picture of pixels among the cells, as bytes. */
struct gm_writer_image {
    const char *bytes;
    size_t size;
};

/* Queues the changes from the last screen, and the image (may be NULL), which covers the cells without a
   glyph. Call it only when idle. */
void gm_writer_draw(struct gm_writer *writer, const struct gm_cells *cells,
                    const struct gm_writer_image *image);
/* Offers a text to the terminal's clipboard (OSC 52); most terminals ask the user or need permission. Call
   it when idle, or after queueing other bytes. */
void gm_writer_copy(struct gm_writer *writer, const char *text);
/* Queues bytes that are not visible on the screen. Call it only when idle. */
void gm_writer_tell(struct gm_writer *writer, const char *text);
/* Sends the bytes that the terminal accepts; returns false when it is gone. */
bool gm_writer_send(struct gm_writer *writer);
/* Drops the unsent bytes and ends a sequence that this cuts. */
void gm_writer_cut(struct gm_writer *writer);

/* Shows composed screens with a picture of pixels. A thread paints the picture, so a screen with a new one
   appears a little later, both together. Nothing waits for the terminal. */

/* The settings of a picture of pixels. */
struct gm_pixels_job {
    enum gm_inline_kind kind;
    enum gm_theme theme;
    struct gm_inline_place place;
    int most_width, most_height; /* limits in pixels, as for gm_inline_open */
    bool whole;                  /* the terminal may have lost earlier pictures */
};

struct gm_face;
struct gm_screen;
struct gm_display {
    struct gm_writer writer;
    struct gm_terminal *terminal;
    int wake;
    struct gm_pixels *painter; /* NULL until needed */
    bool stale;                /* the last picture started is out of date */
    bool lost;                 /* the terminal may have lost part of its picture */
    bool painted;              /* the painted bytes are not yet shown */
    bool failed;               /* painting failed, for lack of a font: no pixels */
    enum gm_inline_kind shown; /* the kind of picture that the terminal shows */
    struct gm_pixels_job job;  /* the last one started */
};

/* Opens a display; `wake` is an eventfd, written when a picture is ready. Returns false when out of
   memory. */
bool gm_display_open(struct gm_display *display, struct gm_terminal *terminal, int wake);
void gm_display_close(struct gm_display *display);

/* Returns true if a screen can be shown now. Until then the last screen's picture may be in use. */
bool gm_display_takes(struct gm_display *display);
/* Shows a composed screen with a picture (NULL: none). Returns false if that must be painted first: it is in use
   until gm_display_takes, then call again. */
bool gm_display_show(struct gm_display *display, const struct gm_screen *screen, const struct gm_face *face,
                     struct gm_picture *picture);
/* Invalidates the shown screen and picture. */
void gm_display_forget(struct gm_display *display);
/* Takes a finished picture; returns true if there was one. */
bool gm_display_read(struct gm_display *display);
/* Waits until no picture is in use. Call it before closing the picture's owner. */
void gm_display_finish(struct gm_display *display);

/* Returns the spot in the middle of a cell of the shown picture. */
struct gm_spot gm_display_locate(struct gm_display *display, struct gm_picture *picture, int column, int row);

/* Prepares the terminal for the shell: removes the picture, sends pending bytes, and awaits answers that
   the shell would read as keys. */
void gm_display_rest(struct gm_display *display);

#endif
