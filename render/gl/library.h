/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_LIBRARY_H
#define GM_RENDER_GL_LIBRARY_H

#include <stdbool.h>
#include <stddef.h>

/* Shared libraries that are opened when they are needed. */

typedef void (*gm_library_function)(void);

/* Opens the first of these libraries that is there (a list that ends with NULL), or says why there is none:
   "libEGL.so.1 is not installed", of the first name, or what the loader has against one that is. */
void *gm_library_open(const char *const *names, char *message, size_t size);

/* Finds functions by name; all of them, or false. */
struct gm_library_symbol {
    const char *name;
    void *function; /* the address of a pointer to the function */
};
bool gm_library_find(void *library, const struct gm_library_symbol *symbols, size_t count);

#endif
