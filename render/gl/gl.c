/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The functions of OpenGL, looked up in the context. */
#include "render/gl/gl.h"

const char *gm_gl_load(struct gm_gl *gl, const struct gm_context *context)
{
#define GM_GL_FIND(name, type)                                                                               \
    gl->name = (PFNGL##type##PROC)gm_context_find(context, "gl" #name);                                      \
    if (!gl->name)                                                                                           \
        return "gl" #name;
    GM_GL_FUNCTIONS(GM_GL_FIND)
#undef GM_GL_FIND
    return NULL;
}
