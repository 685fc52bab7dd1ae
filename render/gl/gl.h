/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_GL_H
#define GM_RENDER_GL_GL_H

#include <GL/glcorearb.h>
#include <stdbool.h>

#include "render/gl/context.h"
#include "render/triangles/triangles.h"

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

/* The programs of a batch (struct gm_vertex says what its vertices mean). */

/* Uses the program, made when it is first wanted (most pictures need few of the five), for a picture of so many
   pixels. False if this OpenGL cannot compile it. */
bool gm_shaders_use(const struct gm_gl *gl, GLuint *programs, enum gm_program program, int width, int height);

/* A batch through OpenGL: its vertices in one buffer, its calls one by one, its images as textures. */
struct gm_stream {
    const struct gm_gl *gl;
    GLuint programs[GM_PROGRAM_COUNT], array, buffer, index_buffer;
    GLuint *images; /* textures for the images of a frame, used again in the next */
    size_t image_count, images_used;
    float *texels;
    size_t texel_capacity;
};

/* Needs a current context, with which it ends. False, with a sentence in message, when shaders do not compile. */
bool gm_stream_open(struct gm_stream *stream, const struct gm_gl *gl, char *message);

/* Draws everything into the bound framebuffer of width x height pixels. The glyph atlas is bound to texture
   unit 0, the colour maps to unit 1. */
bool gm_stream_draw(struct gm_stream *stream, const struct gm_batch *batch, int width, int height);

#endif
