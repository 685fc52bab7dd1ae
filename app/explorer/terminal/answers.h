/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_TERMINAL_ANSWERS_H
#define GM_APP_EXPLORER_TERMINAL_ANSWERS_H

#include <stdbool.h>
#include <stddef.h>

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

#endif
