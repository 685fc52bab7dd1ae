/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GROW_H
#define GM_RENDER_GROW_H

#include <stdbool.h>
#include <stddef.h>

/* Makes room for `wanted` elements of a size in *block, a pointer to the elements or NULL, which at least
   doubles. Returns false when out of memory; the block then stays as it was. */
bool gm_grow(void *block, size_t *capacity, size_t wanted, size_t size);

#endif
