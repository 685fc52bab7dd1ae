/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Words that take the place of a file's formulas. */
#ifndef GM_APP_WORDS_REPLACING_H
#define GM_APP_WORDS_REPLACING_H

#include <stdbool.h>

#include "app/words/lines.h"

struct gm_arguments;

extern const char *const gm_replacing_keys[]; /* H L V rate bracket S K-matrix L-matrix, and NULL */

/* Whether a word is a formula in place of one of a text's lines. */
bool gm_replacing_has(const char *text, const char *word);
/* Puts formulas that were typed where the text has its own; other lines stay. False: no memory. */
bool gm_replacing_lines(struct gm_system_lines *written, int count, char *const words[]);

/* The formulas of a text as words, "H=p^2/2", as they take the place of its own behind the file's name. False: no
   memory. */
bool gm_replacing_words(const char *text, struct gm_arguments *words);

#endif
