/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_NEAREST_H
#define GM_APP_NEAREST_H

#include <stddef.h>

/* The candidate with the smallest edit distance to word; NULL if even that is no likely slip of the fingers.
   candidate(i, data) gives name i of count. */
const char *gm_nearest(const char *word, size_t count, const char *(*candidate)(size_t i, const void *data),
                       const void *data);

#endif
