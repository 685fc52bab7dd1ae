/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_CONTEXT_H
#define GM_RENDER_GL_CONTEXT_H

#include "render/gl/library.h"

/* An OpenGL 3.3 core context without a screen. It has no surface of its own worth drawing to: painters draw
   into a framebuffer object. Libraries are loaded when the first context is opened, so that a program which
   paints nothing starts fast, and runs where Mesa has neither. */

enum gm_context_kind { GM_CONTEXT_OSMESA, GM_CONTEXT_EGL, GM_CONTEXT_KINDS };

/* Bytes of the address space, by Mesa and what it loads. */
enum { GM_CONTEXT_TAKES = 512 << 20 };

struct gm_context;

/* Loads the library of a kind, which stays. False with the reason. */
bool gm_context_load(enum gm_context_kind kind, char *message, size_t size);

/* Opens a context and makes it current. NULL on failure, with the reason. */
struct gm_context *gm_context_open(enum gm_context_kind kind, char *message, size_t size);
void gm_context_close(struct gm_context *context);

/* Makes the context current in the calling thread, in which no other one is; and current in none. */
bool gm_context_use(const struct gm_context *context);
void gm_context_release(const struct gm_context *context);

/* A GL function; NULL if there is none of that name. */
gm_library_function gm_context_find(const struct gm_context *context, const char *name);

/* Of a program, which says so once, for all contexts: between the two others a crash ends it with one
   sentence on standard error: Mesa dies of memory that it is refused (exit status 5). Nothing changes where
   there are handlers already. One thread at a time. */
void gm_context_answer_crashes(void);
void gm_context_guard(void);
void gm_context_unguard(void);

#endif
