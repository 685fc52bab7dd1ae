/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_EXPRESSION_NEAREST_H
#define GM_CORE_EXPRESSION_NEAREST_H

#include <stddef.h>

/* What was probably meant by word: the first candidate that begins with it, else the shortest that it
   abbreviates, else the one with the smallest edit distance, up to one slip of the fingers for three letters.
   NULL if there is none: a guess from farther away would mislead. candidate(i, data) gives name i of
   count. */
const char *gm_nearest(const char *word, size_t count, const char *(*candidate)(size_t i, const void *data),
                       const void *data);

#endif
