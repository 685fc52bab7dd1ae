/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_BACKEND_H
#define GM_RENDER_GL_BACKEND_H

#include "render/gl/library.h"

/* A way to get an OpenGL context without a screen; `self` is what its open returned. The libraries are never
   unloaded: Mesa and LLVM leave threads' destructors and exit handlers behind. */
struct gm_backend {
    const char *key;                           /* in GEOMINT_GL */
    const char *name;                          /* for people */
    const char *const *libraries;              /* the first that is there will do; ends with NULL */
    void *(*open)(char *message, size_t size); /* current on return; NULL with the reason on failure */
    void (*close)(void *self);
    bool (*use)(void *self);
    gm_library_function (*find)(void *self, const char *name);
};

extern const struct gm_backend gm_backend_osmesa, gm_backend_egl;

#endif
