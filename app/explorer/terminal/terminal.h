/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_TERMINAL_TERMINAL_H
#define GM_APP_EXPLORER_TERMINAL_TERMINAL_H

#include "app/explorer/terminal/answers.h"
#include "render/cells/cells.h"
#include "render/files/inline_image.h"

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

#endif
