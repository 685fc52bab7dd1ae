/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A system that is said by the words of a command line alone, as the text of a file. */
#ifndef GM_APP_WORDS_WORDED_H
#define GM_APP_WORDS_WORDED_H

#include <stdbool.h>

#include "app/words/lines.h"

extern const char *const gm_worded_keys[]; /* H L rate coordinates momenta, and NULL */

/* Whether a word sets H, L or rate. */
bool gm_worded_is_formula(const char *word);

/* Writes the lines of the file that "system H=... key=value ..." would be: coordinates that are not said are q, or
   q1, q2 and so on, names of the state have their values at the start, others are parameters. False with a
   sentence, and a place where it has one. */
bool gm_worded_write(struct gm_system_lines *written, int count, char *const words[],
                     struct gm_word_place *place, char *message);

#endif
