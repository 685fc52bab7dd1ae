/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_CONTEXT_H
#define GM_RENDER_GL_CONTEXT_H

#include "render/gl/backend.h"

/* An OpenGL 3.3 core context without a screen. Painters draw into a framebuffer object. Libraries are loaded
   when the first context is opened, so a program that paints nothing starts fast, and runs without Mesa. They are
   never unloaded: Mesa and LLVM leave threads' destructors and exit handlers behind. */

enum gm_context_kind { GM_CONTEXT_OSMESA, GM_CONTEXT_EGL, GM_CONTEXT_KINDS };

/* Bytes of address space that Mesa and its libraries take. */
enum { GM_CONTEXT_TAKES = 512 << 20 };

/* Loads the library of a kind for good. Returns false with the reason. */
bool gm_context_load(enum gm_context_kind kind, char *message, size_t size);

/* Opens the context of a kind and makes it current in the calling thread. Returns NULL with the reason on
   failure. */
const struct gm_backend *gm_context_open(enum gm_context_kind kind, char *message, size_t size);

/* A program calls answer_crashes once, for all contexts. A crash between guard and unguard then ends it with
   one sentence on standard error, and exit status 5 if memory is limited: Mesa crashes when memory is
   refused. Existing handlers stay. One thread at a time. */
void gm_context_answer_crashes(void);
void gm_context_guard(void);
void gm_context_unguard(void);

#endif
