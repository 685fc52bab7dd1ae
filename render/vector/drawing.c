/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The common part of the pens that draw files: the file, made in memory and then written, and fields of colours as
   pixels, whose values are interpolated as in OpenGL: linearly in triangles, bilinearly between the cells' middles
   in images. */
#include "render/vector/vector.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/files/temporary.h"

bool gm_drawing_write(const char *path, struct gm_drawing *drawing, const struct gm_drawer *drawer,
                      char *message)
{
    char *bytes = NULL;
    size_t size = 0;
    const bool opened = gm_page_open(drawer->painter, drawer->pen, drawer->self, drawing->look, message);
    int error = opened ? ENOMEM : errno;
    FILE *out = opened ? open_memstream(&bytes, &size) : NULL;
    bool drawn = out && drawer->draw(drawer->self, drawing, out);
    if (out && fclose(out) != 0) {
        drawn = false;
    }
    gm_page_close(drawer->painter);
    if (drawn && bytes) {
        error = gm_temporary_write(path, bytes, size);
    }
    free(bytes);
    if (error != 0 && opened) {
        gm_temporary_refuse(message, path, strerror(error));
    }
    errno = error;
    return error == 0;
}

/* ---- fields of colours ---- */

void gm_field_image_palette(const struct gm_field_image *field, enum gm_colour_map map, enum gm_theme theme,
                            uint8_t palette[GM_PALETTE][4])
{
    memset(palette, 0, GM_PALETTE * sizeof *palette);
    for (int i = 0; i < GM_FIELD_COLOURS; i++) {
        const double place = (double)i / (GM_FIELD_COLOURS - 1);
        const struct gm_rgb rgb = gm_colour_map_at(map, theme, place);
        if (field->shade) {
            palette[i][3] = (uint8_t)(255 * (1 - place) + 0.5);
        } else {
            memcpy(palette[i], (const uint8_t[]){rgb.r, rgb.g, rgb.b, 255}, 4);
        }
    }
}

static void put(void *self, const struct gm_mark *mark, int x, int y, double value, double light)
{
    const struct gm_field_image *field = self;
    const double place = field->shade ? light : (value - mark->low) / (mark->high - mark->low);
    field->pixels[(size_t)y * (size_t)field->columns + (size_t)x] =
        (uint8_t)gm_clamp(place * (GM_FIELD_COLOURS - 1) + 0.5, 0, GM_FIELD_COLOURS - 1);
}

static void paint_image(struct gm_field_image *field, const struct gm_axes *axes, const struct gm_mark *mark,
                        int fine)
{
    const double left = gm_axes_x(axes, mark->points[0]), right = gm_axes_x(axes, mark->points[2]);
    const double bottom = gm_axes_y(axes, mark->points[1]), top = gm_axes_y(axes, mark->points[3]);
    for (int y = 0; y < field->rows; y++) {
        const double v = (field->top + (y + 0.5) / fine - bottom) / (top - bottom);
        for (int x = 0; x < field->columns; x++) {
            const double u = (field->left + (x + 0.5) / fine - left) / (right - left);
            const double value =
                u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0 ? gm_image_value(mark, u, v) : (double)NAN;
            if (isfinite(value)) {
                put(field, mark, x, y, value, 1);
            }
        }
    }
}

static bool paint(struct gm_field_image *field, const struct gm_axes *axes, const struct gm_mark *mark,
                  int fine)
{
    field->columns = fine * field->width;
    field->rows = fine * field->height;
    const size_t size = (size_t)field->columns * (size_t)field->rows;
    field->pixels = malloc(size);
    if (!field->pixels) {
        return false;
    }
    memset(field->pixels, GM_FIELD_NONE, size);
    if (mark->kind == GM_MARK_MESH) {
        const struct gm_pixel_grid pixels = {
            field->left, field->top, fine, fine, {0, 0, field->columns, field->rows}};
        gm_mesh_walk(axes, mark, &pixels, put, field);
    } else {
        paint_image(field, axes, mark, fine);
    }
    return true;
}

/* A pixel of the surface is painted as a whole or not at all, by its middle, as on a screen: nothing under
   the field's edge shines through half of it. */
static void keep_whole_pixels(struct gm_field_image *field, const struct gm_field_image *whole, int fine)
{
    for (int y = 0; y < field->rows; y++) {
        for (int x = 0; x < field->columns; x++) {
            uint8_t *pixel = &field->pixels[(size_t)y * (size_t)field->columns + (size_t)x];
            const uint8_t middle =
                whole->pixels[(size_t)(y / fine) * (size_t)whole->columns + (size_t)(x / fine)];
            if (middle == GM_FIELD_NONE || *pixel == GM_FIELD_NONE) {
                *pixel = middle;
            }
        }
    }
}

/* Paints the part of a mesh or an image in a rectangle. A pixel of the surface has two pixels on a side, since drawings
   are seen from near, or one in a large field. Without such a part the field is empty (width 0). Returns false when out
   of memory. */
static bool paint_field(struct gm_field_image *field, const struct gm_axes *axes, const struct gm_mark *mark,
                        const int clip[4])
{
    const size_t count = mark->kind == GM_MARK_IMAGE ? 2 : mark->count;
    double low_x = INFINITY, high_x = -INFINITY, low_y = INFINITY, high_y = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        const double x = gm_axes_x(axes, mark->points[2 * i]);
        const double y = gm_axes_y(axes, mark->points[2 * i + 1]);
        low_x = fmin(low_x, x);
        high_x = fmax(high_x, x);
        low_y = fmin(low_y, y);
        high_y = fmax(high_y, y);
    }
    const int left = gm_clamp(floor(low_x), clip[0], clip[0] + clip[2]);
    const int right = gm_clamp(ceil(high_x), clip[0], clip[0] + clip[2]);
    const int top = gm_clamp(floor(low_y), clip[1], clip[1] + clip[3]);
    const int bottom = gm_clamp(ceil(high_y), clip[1], clip[1] + clip[3]);
    *field = (struct gm_field_image){.left = left, .top = top, .shade = field->shade};
    if (right <= left || bottom <= top || !(mark->high > mark->low)) {
        return true;
    }
    field->width = right - left;
    field->height = bottom - top;
    const double large = 4e6; /* pixels */
    const int fine = (double)field->width * field->height > large ? 1 : 2;
    struct gm_field_image whole = *field;
    const bool painted = paint(&whole, axes, mark, 1) && paint(field, axes, mark, fine);
    if (painted) {
        keep_whole_pixels(field, &whole, fine);
    }
    free(whole.pixels);
    return painted;
}

bool gm_field_image_draw(const struct gm_axes *axes, const struct gm_mark *mark, const int clip[4],
                         gm_field_put *put_layer, void *self)
{
    bool painted = true;
    for (int layer = 0; painted && layer < (mark->light ? 2 : 1); layer++) {
        struct gm_field_image image = {.shade = layer > 0};
        painted = paint_field(&image, axes, mark, clip);
        if (painted && image.width > 0) {
            put_layer(self, &image, mark);
        }
        free(image.pixels);
    }
    return painted;
}
