/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cairo, opened when the first PDF is written: with its parts of X it is a quarter of all that the program
   would load at every start. */
#ifndef GM_RENDER_VECTOR_CAIRO_H
#define GM_RENDER_VECTOR_CAIRO_H

#include <stdbool.h>

#include <cairo-ft.h>
#include <cairo-pdf.h>

/* The functions in use: cairo_clip is gm_cairo.clip. */
/* clang-format off */
#define GM_CAIRO_FUNCTIONS(F) \
    F(clip) F(close_path) F(create) F(destroy) F(fill) F(font_face_destroy) F(font_options_create) \
    F(font_options_destroy) F(font_options_set_hint_metrics) F(font_options_set_hint_style) \
    F(ft_font_face_create_for_pattern) F(get_scaled_font) F(glyph_free) F(image_surface_create) \
    F(image_surface_get_data) F(image_surface_get_stride) F(line_to) F(move_to) F(new_path) F(paint) \
    F(paint_with_alpha) F(pattern_add_color_stop_rgb) F(pattern_create_linear) F(pattern_destroy) \
    F(pdf_surface_create_for_stream) F(pdf_surface_set_metadata) F(rectangle) F(reset_clip) F(restore) \
    F(rotate) F(save) F(scale) F(scaled_font_text_to_glyphs) F(set_dash) F(set_fill_rule) F(set_font_face) \
    F(set_font_options) F(set_font_size) F(set_line_cap) F(set_line_join) F(set_line_width) F(set_source) \
    F(set_source_rgba) F(set_source_surface) F(show_text_glyphs) F(status) F(stroke) F(surface_destroy) \
    F(surface_finish) F(surface_mark_dirty) F(surface_status) F(text_cluster_free) F(translate) \
    F(version_string)
struct gm_cairo {
#define GM_CAIRO_POINTER(name) __typeof__(cairo_##name) *name;
    GM_CAIRO_FUNCTIONS(GM_CAIRO_POINTER)
#undef GM_CAIRO_POINTER
};
/* clang-format on */

extern struct gm_cairo gm_cairo;

/* Returns false without Cairo, with one sentence in message and errno: ENOENT or ENOMEM. */
bool gm_cairo_open(char *message);

#endif
