/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_BACKEND_H
#define GM_RENDER_GL_BACKEND_H

#include "loader/library.h"

/* A way to get a context, of which a process has one of each kind. */
struct gm_backend {
    void *(*load)(char *message, size_t size); /* the library, or NULL */
    const char *(*open)(void *library);        /* makes the context current, or returns why not */
    void (*close)(void);
    bool (*use)(void);     /* makes the context current in the calling thread, which has no other one */
    void (*release)(void); /* makes it current in none */
    gm_library_function (*find)(const char *name); /* a GL function, or NULL */
};
extern const struct gm_backend gm_backend_osmesa, gm_backend_egl;

#endif
