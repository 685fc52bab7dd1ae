/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_EXPRESSION_NEAREST_H
#define GM_CORE_EXPRESSION_NEAREST_H

#include <stdbool.h>
#include <stddef.h>

/* The candidate that `word` probably means: the first that begins with it, else the shortest that it
   abbreviates, else the one with the smallest edit distance, at most one slip for three letters. NULL if all
   are farther away: such a guess would mislead. candidate(i, data) is name i of count. */
const char *gm_nearest(const char *word, size_t count, const char *(*candidate)(size_t i, const void *data),
                       const void *data);

/* Returns true if a text contains a word of at least three letters, in any case. */
bool gm_word_is_part(const char *word, const char *text);

#endif
