/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GROW_H
#define GM_RENDER_GROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Makes room for `wanted` elements of a size in *block, a pointer to the elements or NULL, which at least
   doubles. Returns false when out of memory; the block then stays as it was. */
static inline bool gm_grow(void *block, size_t *capacity, size_t wanted, size_t size)
{
    void *elements;
    if (wanted <= *capacity) {
        return true;
    }
    const size_t count = wanted > 2 * *capacity ? wanted : 2 * *capacity;
    memcpy(&elements, block, sizeof elements); /* a pointer of any type */
    elements = count > SIZE_MAX / 4 / size ? NULL : realloc(elements, count * size);
    if (!elements) {
        return false;
    }
    memcpy(block, &elements, sizeof elements);
    *capacity = count;
    return true;
}

#endif
