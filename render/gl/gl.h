/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_GL_H
#define GM_RENDER_GL_GL_H

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

/* The GL functions the painter uses, found at run time through the context: glClear is gl->Clear. */
/* clang-format off */
#define GM_GL_FUNCTIONS(F) \
    F(ActiveTexture) F(AttachShader) F(BindAttribLocation) F(BindBuffer) F(BindFramebuffer) \
    F(BindRenderbuffer) F(BindTexture) F(BindVertexArray) F(BlendFuncSeparate) F(BufferData) \
    F(BufferSubData) F(CheckFramebufferStatus) F(Clear) F(ClearColor) F(ClearStencil) F(ColorMask) \
    F(CompileShader) F(CreateProgram) F(CreateShader) F(DeleteFramebuffers) F(DeleteRenderbuffers) \
    F(DeleteShader) F(DeleteTextures) F(Disable) F(DrawArrays) F(DrawElements) F(Enable) \
    F(EnableVertexAttribArray) F(FramebufferRenderbuffer) F(GenBuffers) F(GenFramebuffers) \
    F(GenRenderbuffers) F(GenTextures) F(GenVertexArrays) F(GetError) F(GetIntegerv) F(GetProgramiv) \
    F(GetString) F(GetUniformLocation) F(LinkProgram) F(PixelStorei) F(ReadPixels) F(RenderbufferStorage) \
    F(Scissor) F(ShaderSource) F(StencilFunc) F(StencilMask) F(StencilOp) F(TexImage2D) F(TexParameteri) \
    F(TexSubImage2D) F(Uniform1i) F(Uniform2f) F(UseProgram) F(VertexAttribPointer) F(Viewport)
struct gm_gl {
#define GM_GL_POINTER(name) __typeof__(gl##name) *name;
    GM_GL_FUNCTIONS(GM_GL_POINTER)
#undef GM_GL_POINTER
};
/* clang-format on */

#endif
