/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_LIBRARY_H
#define GM_RENDER_GL_LIBRARY_H

#include <stdbool.h>
#include <stddef.h>

/* Shared libraries that are opened when they are needed. */

typedef void (*gm_library_function)(void);

/* Opens the first of these libraries that exists; the list ends with NULL. On failure returns NULL with the
   reason: "libEGL.so.1 is not installed", for the first name, or the loader's message. */
void *gm_library_open(const char *const *names, char *message, size_t size);

/* Functions to find by name: all of them, or false. */
struct gm_library_symbol {
    const char *name;
    void *function; /* the address of a pointer to the function */
};
bool gm_library_find(void *library, const struct gm_library_symbol *symbols, size_t count);

#endif
