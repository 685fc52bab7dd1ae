/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_BASE_PLACE_H
#define GM_APP_BASE_PLACE_H

#include <stddef.h>

/* Where in some words something is wrong. */
struct gm_word_place {
    int word;      /* below 0: nowhere in them */
    size_t offset; /* in bytes */
};

struct gm_fault;

/* Reports what is wrong with the text of a file, with its line and column (GM_MESSAGE bytes). */
void gm_place_report(const char *path, const char *text, const struct gm_fault *fault, char *message);

/* Appends to a message (GM_MESSAGE bytes) the line of a text that is wrong, and below it a line with a caret
   at the place. Only what is ASCII is shown as it is. */
void gm_place_show(const char *text, size_t length, size_t offset, char *message);

#endif
