/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_GL_H
#define GM_RENDER_GL_GL_H

#include <stdbool.h>

#include <GL/glcorearb.h>

#include "render/gl/context.h"

/* The GL functions the painter uses, found at run time through the context. */
#define GM_GL_FUNCTIONS(X)                                                                                   \
    X(ActiveTexture, ACTIVETEXTURE)                                                                          \
    X(AttachShader, ATTACHSHADER)                                                                            \
    X(BindAttribLocation, BINDATTRIBLOCATION)                                                                \
    X(BindBuffer, BINDBUFFER)                                                                                \
    X(BindFramebuffer, BINDFRAMEBUFFER)                                                                      \
    X(BindRenderbuffer, BINDRENDERBUFFER)                                                                    \
    X(BindTexture, BINDTEXTURE)                                                                              \
    X(BindVertexArray, BINDVERTEXARRAY)                                                                      \
    X(BlendFuncSeparate, BLENDFUNCSEPARATE)                                                                  \
    X(BufferData, BUFFERDATA)                                                                                \
    X(BufferSubData, BUFFERSUBDATA)                                                                          \
    X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS)                                                        \
    X(Clear, CLEAR)                                                                                          \
    X(ClearColor, CLEARCOLOR)                                                                                \
    X(ClearStencil, CLEARSTENCIL)                                                                            \
    X(ColorMask, COLORMASK)                                                                                  \
    X(CompileShader, COMPILESHADER)                                                                          \
    X(CreateProgram, CREATEPROGRAM)                                                                          \
    X(CreateShader, CREATESHADER)                                                                            \
    X(DeleteFramebuffers, DELETEFRAMEBUFFERS)                                                                \
    X(DeleteRenderbuffers, DELETERENDERBUFFERS)                                                              \
    X(DeleteShader, DELETESHADER)                                                                            \
    X(DeleteTextures, DELETETEXTURES)                                                                        \
    X(Disable, DISABLE)                                                                                      \
    X(DrawArrays, DRAWARRAYS)                                                                                \
    X(DrawElements, DRAWELEMENTS)                                                                            \
    X(Enable, ENABLE)                                                                                        \
    X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY)                                                      \
    X(FramebufferRenderbuffer, FRAMEBUFFERRENDERBUFFER)                                                      \
    X(GenBuffers, GENBUFFERS)                                                                                \
    X(GenFramebuffers, GENFRAMEBUFFERS)                                                                      \
    X(GenRenderbuffers, GENRENDERBUFFERS)                                                                    \
    X(GenTextures, GENTEXTURES)                                                                              \
    X(GenVertexArrays, GENVERTEXARRAYS)                                                                      \
    X(GetError, GETERROR)                                                                                    \
    X(GetIntegerv, GETINTEGERV)                                                                              \
    X(GetProgramiv, GETPROGRAMIV)                                                                            \
    X(GetString, GETSTRING)                                                                                  \
    X(GetUniformLocation, GETUNIFORMLOCATION)                                                                \
    X(LinkProgram, LINKPROGRAM)                                                                              \
    X(PixelStorei, PIXELSTOREI)                                                                              \
    X(ReadPixels, READPIXELS)                                                                                \
    X(RenderbufferStorage, RENDERBUFFERSTORAGE)                                                              \
    X(Scissor, SCISSOR)                                                                                      \
    X(ShaderSource, SHADERSOURCE)                                                                            \
    X(StencilFunc, STENCILFUNC)                                                                              \
    X(StencilMask, STENCILMASK)                                                                              \
    X(StencilOp, STENCILOP)                                                                                  \
    X(TexImage2D, TEXIMAGE2D)                                                                                \
    X(TexParameteri, TEXPARAMETERI)                                                                          \
    X(TexSubImage2D, TEXSUBIMAGE2D)                                                                          \
    X(Uniform1i, UNIFORM1I)                                                                                  \
    X(Uniform2f, UNIFORM2F)                                                                                  \
    X(UseProgram, USEPROGRAM)                                                                                \
    X(VertexAttribPointer, VERTEXATTRIBPOINTER)                                                              \
    X(Viewport, VIEWPORT)

struct gm_gl {
#define GM_GL_MEMBER(name, type) PFNGL##type##PROC name;
    GM_GL_FUNCTIONS(GM_GL_MEMBER)
#undef GM_GL_MEMBER
};

/* Returns the name of the first function that is missing, or NULL. */
const char *gm_gl_load(struct gm_gl *gl, const struct gm_context *context);

#endif
