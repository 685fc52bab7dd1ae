/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_CONTEXT_H
#define GM_RENDER_GL_CONTEXT_H

#include "render/gl/library.h"

/* An OpenGL 3.3 core context without a screen. It has no surface of its own worth drawing to: painters draw
   into a framebuffer object. Libraries are loaded when the first context is opened, so that a program which
   paints nothing starts fast, and one whose Mesa lacks OSMesa still runs with EGL. */

struct gm_context;

/* Opens the first kind of context that works here, or the one named by the environment variable GEOMINT_GL
   (osmesa or egl), and makes it current. NULL on failure, with one sentence in message. */
struct gm_context *gm_context_open(char *message, size_t size);
void gm_context_close(struct gm_context *context);

/* Makes the context current in the calling thread. */
bool gm_context_use(const struct gm_context *context);

/* A GL function; NULL if there is none of that name. */
gm_library_function gm_context_find(const struct gm_context *context, const char *name);

/* Of a program, which says so once, for all contexts: between the two others a crash ends it with one
   sentence on standard error: Mesa dies of memory that it is refused (exit status 5), and OSMesa of a driver
   that it does not know (3). Nothing changes where there are handlers already. One thread at a time. */
void gm_context_answer_crashes(void);
void gm_context_guard(void);
void gm_context_unguard(void);

/* "OSMesa" or "EGL". */
const char *gm_context_name(const struct gm_context *context);

#endif
