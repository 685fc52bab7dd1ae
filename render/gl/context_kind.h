/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_CONTEXT_KIND_H
#define GM_RENDER_GL_CONTEXT_KIND_H

#include "render/gl/context.h"

/* One way to get a context; `self` is what its open returned. */
struct gm_context_kind {
    const char *key;                           /* in GEOMINT_GL */
    const char *name;                          /* for people */
    void *(*open)(char *message, size_t size); /* current on return; NULL with the reason on failure */
    void (*close)(void *self);
    bool (*use)(void *self);
    gm_context_function (*find)(void *self, const char *name);
};

/* Opens the first of these libraries that is there (a list that ends with NULL), or says why there is none:
   "libEGL.so.1 is not installed", of the first name, or what the loader has against one that is. */
void *gm_context_library(const char *const *names, char *message, size_t size);

extern const struct gm_context_kind gm_context_osmesa, gm_context_egl;

#endif
