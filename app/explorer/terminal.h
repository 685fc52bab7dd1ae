/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_TERMINAL_H
#define GM_APP_EXPLORER_TERMINAL_H

#include "render/cells.h"

/* What the terminal can show, and why we think so: override over environment over terminfo. */

enum gm_colours { GM_COLOURS_NONE, GM_COLOURS_16, GM_COLOURS_256, GM_COLOURS_TRUE };

enum { GM_REASON = 160 };

struct gm_terminal {
    const char *name;     /* TERM; "" if it is not set */
    bool input, output;   /* standard input and output are terminals */
    bool known;           /* terminfo has an entry that can address the cursor */
    bool utf8;            /* the locale's letters */
    const char *codeset;  /* as the locale names it */
    int terminfo_colours; /* -1: none */
    int columns, rows;
    enum gm_colours colours;
    enum gm_blocks blocks;
    enum gm_theme theme;
    char colours_why[GM_REASON], blocks_why[GM_REASON], theme_why[GM_REASON], size_why[GM_REASON];
};

/* Looks at the environment, the locale and terminfo; nothing is written. False with a sentence (GM_MESSAGE
   bytes) if an override is not understood. */
bool gm_terminal_detect(struct gm_terminal *terminal, char *message);

/* Whether the explorer can run here; if not, why, in one sentence. */
bool gm_terminal_serves(const struct gm_terminal *terminal, char *message);

/* The size of the terminal now. */
void gm_terminal_size(int *columns, int *rows);

const char *gm_blocks_name(enum gm_blocks blocks);

/* `geomint terminal`: what was found and what follows from it. */
int gm_terminal_report(void);

#endif
