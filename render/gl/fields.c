/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes, images and colour bars: values reach every pixel before they become colours. */
#include <math.h>
#include <stdlib.h>

#include "render/gl/brush.h"

static struct gm_vertex vertex(double x, double y, double across, double along, double alpha, enum gm_map map)
{
    const uint8_t row = map == GM_MAP_SEQUENTIAL ? 0 : 255;
    return (struct gm_vertex){(float)x,     (float)y,     (float)across,
                              (float)along, (float)alpha, {row, 0, 0, 255}};
}

static void paint_mesh(struct gm_brush *brush, const struct gm_frame *frame, const struct gm_mark *mark)
{
    uint32_t *indices;
    gm_batch_state(&brush->batch, GM_PROGRAM_FIELD, GM_STENCIL_NONE);
    struct gm_vertex *vertices =
        gm_batch_mesh(&brush->batch, mark->count, 3 * mark->triangle_count, &indices);
    if (vertices == NULL) {
        return;
    }
    const size_t first = (size_t)(vertices - brush->batch.vertices);
    const double factor = 1.0 / (mark->high - mark->low);
    for (size_t i = 0; i < mark->count; i++) {
        vertices[i] =
            vertex(gm_frame_x(frame, mark->points[2 * i]), gm_frame_y(frame, mark->points[2 * i + 1]),
                   factor * (mark->values[i] - mark->low), 0.0, mark->style.alpha, mark->map);
    }
    for (size_t i = 0; i < 3 * mark->triangle_count; i++) {
        indices[i] = (uint32_t)(first + (size_t)mark->triangles[i]);
    }
}

static void put_quad(struct gm_batch *batch, struct gm_vertex corners[4])
{
    struct gm_vertex *strip = gm_batch_strip(batch, 4);
    if (strip == NULL) {
        return;
    }
    for (int i = 0; i < 4; i++) {
        strip[i] = corners[i];
    }
    gm_batch_end(batch, 0);
}

void gm_brush_ramp(void *self, struct gm_box box, enum gm_map map)
{
    struct gm_brush *brush = self;
    gm_batch_state(&brush->batch, GM_PROGRAM_FIELD, GM_STENCIL_NONE);
    const double right = box.x + box.width, bottom = box.y + box.height;
    put_quad(&brush->batch, (struct gm_vertex[4]){vertex(box.x, box.y, 1.0, 0.0, 1.0, map),
                                                    vertex(right, box.y, 1.0, 0.0, 1.0, map),
                                                    vertex(box.x, bottom, 0.0, 0.0, 1.0, map),
                                                    vertex(right, bottom, 0.0, 0.0, 1.0, map)});
    gm_batch_state(&brush->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
}

/* A texture that no image of this frame uses yet; 0 when memory is short. */
static GLuint next_texture(struct gm_brush *brush)
{
    const struct gm_gl *gl = brush->gl;
    gl->ActiveTexture(GL_TEXTURE2);
    if (brush->images_used == brush->image_count) {
        GLuint *images = realloc(brush->images, (brush->image_count + 1) * sizeof *images);
        if (images == NULL) {
            return 0;
        }
        brush->images = images;
        gl->GenTextures(1, &images[brush->image_count]);
        gl->BindTexture(GL_TEXTURE_2D, images[brush->image_count++]);
        gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
    const GLuint texture = brush->images[brush->images_used++];
    gl->BindTexture(GL_TEXTURE_2D, texture);
    return texture;
}

static void paint_image(struct gm_brush *brush, const struct gm_frame *frame, const struct gm_mark *mark)
{
    const struct gm_gl *gl = brush->gl;
    GLint most = 1;
    gl->GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    /* Every stride-th value of images that are larger than a texture may be. */
    const size_t limit = (size_t)most, row_stride = (mark->rows - 1) / limit + 1,
                 column_stride = (mark->columns - 1) / limit + 1;
    const size_t rows = (mark->rows - 1) / row_stride + 1, columns = (mark->columns - 1) / column_stride + 1;
    if (brush->texel_capacity < rows * columns) {
        float *texels = realloc(brush->texels, rows * columns * sizeof *texels);
        if (texels == NULL) {
            return;
        }
        brush->texels = texels;
        brush->texel_capacity = rows * columns;
    }
    const double factor = 1.0 / (mark->high - mark->low);
    for (size_t row = 0; row < rows; row++) {
        const double *values = mark->values + row * row_stride * mark->columns;
        for (size_t column = 0; column < columns; column++) {
            brush->texels[row * columns + column] =
                (float)(factor * (values[column * column_stride] - mark->low));
        }
    }
    const GLuint texture = next_texture(brush);
    if (texture == 0) {
        return;
    }
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, (GLsizei)columns, (GLsizei)rows, 0, GL_RED, GL_FLOAT,
                   brush->texels);
    const double left = gm_frame_x(frame, mark->points[0]), right = gm_frame_x(frame, mark->points[2]);
    const double bottom = gm_frame_y(frame, mark->points[1]), top = gm_frame_y(frame, mark->points[3]);
    const double alpha = mark->style.alpha;
    gm_batch_state(&brush->batch, GM_PROGRAM_IMAGE, GM_STENCIL_NONE);
    gm_batch_texture(&brush->batch, texture);
    put_quad(&brush->batch, (struct gm_vertex[4]){vertex(left, bottom, 0.0, 0.0, alpha, mark->map),
                                                    vertex(right, bottom, 1.0, 0.0, alpha, mark->map),
                                                    vertex(left, top, 0.0, 1.0, alpha, mark->map),
                                                    vertex(right, top, 1.0, 1.0, alpha, mark->map)});
    gm_batch_texture(&brush->batch, 0);
    gm_batch_state(&brush->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
}

void gm_brush_field(void *self, const struct gm_frame *frame, const struct gm_mark *mark)
{
    if (mark->kind == GM_MARK_MESH) {
        paint_mesh(self, frame, mark);
    } else {
        paint_image(self, frame, mark);
    }
}
