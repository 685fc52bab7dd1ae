/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_BACKEND_H
#define GM_RENDER_GL_BACKEND_H

#include "render/gl/library.h"

/* A way to get an OpenGL context without a screen; `self` is the result of open. The libraries are never
   unloaded: Mesa and LLVM leave threads' destructors and exit handlers behind. */
struct gm_backend {
    void *(*load)(char *message, size_t size);                /* the library, or NULL */
    void *(*open)(void *library, char *message, size_t size); /* the context, made current, or NULL */
    void (*close)(void *self);
    bool (*use)(void *self);     /* makes the context current in the calling thread, which has no other one */
    void (*release)(void *self); /* makes it current in none */
    gm_library_function (*find)(void *self, const char *name); /* a GL function, or NULL */
};

extern const struct gm_backend gm_backend_osmesa, gm_backend_egl;

#endif
