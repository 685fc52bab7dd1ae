/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shaders of a frame. */
#include "render/gl/shaders.h"

/* The first row of pixels in memory is the top of the picture, so y is not inverted. */
static const char vertex_source[] = "#version 330 core\n"
                                    "uniform vec2 scale;\n"
                                    "in vec2 place;\n"
                                    "in vec3 shape;\n"
                                    "in vec4 colour;\n"
                                    "out vec3 edge;\n"
                                    "out vec4 ink;\n"
                                    "void main() {\n"
                                    "    gl_Position = vec4(place * scale - 1.0, 0.0, 1.0);\n"
                                    "    edge = shape;\n"
                                    "    ink = colour;\n"
                                    "}\n";

static const char fragment_head[] =
    "#version 330 core\n"
    "uniform sampler2D glyphs, maps, image;\n"
    "in vec3 edge;\n"
    "in vec4 ink;\n"
    "out vec4 pixel;\n"
    "vec3 mapped(float value) {\n"
    "    int last = textureSize(maps, 0).x - 1;\n"
    "    ivec2 shade = ivec2(clamp(value, 0.0, 1.0) * float(last) + 0.5, ink.r + 0.5);\n"
    "    return texelFetch(maps, shade, 0).rgb;\n"
    "}\n"
    "float covered() { return clamp(edge.z + 0.5 - length(edge.xy), 0.0, 1.0); }\n";

/* All shaders read all of edge and ink, with factors of 1 and terms of 0 if need be: llvmpipe compiles the
   setup of triangles once for each choice of components, 4 ms that no cache on disk saves. */
static const char *const fragment_sources[GM_PROGRAM_COUNT] = {
    [GM_PROGRAM_INK] = "void main() { pixel = vec4(ink.rgb, ink.a * covered()); }\n",
    [GM_PROGRAM_CORE] = "void main() { if (covered() < 1.0) discard; pixel = ink; }\n",
    [GM_PROGRAM_TEXT] =
        "void main() { pixel = vec4(ink.rgb, edge.z * ink.a * texelFetch(glyphs, ivec2(edge.xy), 0).r); }\n",
    [GM_PROGRAM_FIELD] = "void main() { pixel = vec4(ink.gba * mapped(edge.x + edge.y), edge.z); }\n",
    [GM_PROGRAM_IMAGE] =
        "void main() { pixel = vec4(ink.gba * mapped(texture(image, edge.xy).r), edge.z); }\n",
};

static GLuint compile(const struct gm_gl *gl, GLenum kind, const char *head, const char *body)
{
    const GLuint shader = gl->CreateShader(kind);
    const char *sources[] = {head, body};
    gl->ShaderSource(shader, 2, sources, NULL);
    gl->CompileShader(shader);
    return shader;
}

static bool link_program(const struct gm_gl *gl, GLuint program, const char *fragment_body)
{
    const GLuint vertex = compile(gl, GL_VERTEX_SHADER, vertex_source, "");
    const GLuint fragment = compile(gl, GL_FRAGMENT_SHADER, fragment_head, fragment_body);
    gl->AttachShader(program, vertex);
    gl->AttachShader(program, fragment);
    gl->BindAttribLocation(program, 0, "place");
    gl->BindAttribLocation(program, 1, "shape");
    gl->BindAttribLocation(program, 2, "colour");
    gl->LinkProgram(program);
    gl->DeleteShader(vertex);
    gl->DeleteShader(fragment);
    GLint linked = GL_FALSE;
    gl->GetProgramiv(program, GL_LINK_STATUS, &linked);
    return linked;
}

bool gm_shaders_use(const struct gm_gl *gl, GLuint *programs, enum gm_program program, int width, int height)
{
    static const char *const samplers[] = {"glyphs", "maps", "image"}; /* sorted by texture unit */
    const bool is_new = programs[program] == 0;
    const GLuint made = programs[program] = is_new ? gl->CreateProgram() : programs[program];
    const bool linked = !is_new || link_program(gl, made, fragment_sources[program]);
    gl->UseProgram(made); /* a program that is not linked gives a GL error here and in all later uses */
    for (int unit = 0; is_new && linked && unit < 3; unit++) {
        const GLint location = gl->GetUniformLocation(made, samplers[unit]);
        if (location >= 0) {
            gl->Uniform1i(location, unit);
        }
    }
    if (linked) {
        gl->Uniform2f(gl->GetUniformLocation(made, "scale"), 2.0f / (float)width, 2.0f / (float)height);
    }
    return linked;
}
