/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pen that writes PDF, with Cairo, which is opened when the first PDF is written: with its parts of X it is a quarter
   of all that the program would load at every start. Letters come from the same font file as in a PNG, and are placed
   by its layout. */
#include "render/vector/vector.h"

#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <errno.h>
#include <fontconfig/fontconfig.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "loader/library.h"
#include "render/address_space.h"
#include "render/drawing/fonts.h"
#include "render/message.h"

/* ---- Cairo ---- */

/* The functions in use: cairo_clip is cairo.clip. */
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
static struct {
#define GM_CAIRO_POINTER(name) __typeof__(cairo_##name) *name;
    GM_CAIRO_FUNCTIONS(GM_CAIRO_POINTER)
#undef GM_CAIRO_POINTER
} cairo;
/* clang-format on */

enum { TAKEN = 16 << 20 /* bytes of address space that Cairo and its libraries take */ };

static bool opened;
static char reason[GM_MESSAGE];

static void open_once(void)
{
    static const char *const names[] = {"libcairo.so.2", NULL};
#define GM_CAIRO_NAME(name) GM_LIBRARY_NAME(cairo_##name)
    void *library = gm_library_open(names, reason, sizeof reason);
    opened = library && gm_library_find(library, GM_CAIRO_FUNCTIONS(GM_CAIRO_NAME), &cairo);
    if (library && !opened) {
        gm_refuse(reason, "libcairo is too old");
    }
}

/* Returns false without Cairo, with one sentence in message and errno: ENOENT or ENOMEM. */
static bool open_cairo(char *message)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, open_once);
    if (!opened) {
        gm_refuse(message, "a PDF needs Cairo, but %s", reason);
        errno = gm_address_space_has(TAKEN) ? ENOENT : ENOMEM; /* the loader gives only a text */
    }
    return opened;
}

/* ---- the pen ---- */

enum { STOPS = 64 };

struct gm_pdf {
    cairo_t *cairo;
    struct gm_painter painter;
    cairo_font_face_t *fonts[GM_FONT_COUNT];
    int clip[4];
    size_t fields;
    bool short_of_memory;
};

static void set_ink(struct gm_pdf *pdf, struct gm_ink ink)
{
    cairo.set_source_rgba(pdf->cairo, ink.colour.r / 255.0, ink.colour.g / 255.0, ink.colour.b / 255.0,
                          ink.alpha);
}

static void clip(void *self, int left, int top, int width, int height)
{
    struct gm_pdf *pdf = self;
    const int wanted[4] = {left, top, width, height};
    if (memcmp(wanted, pdf->clip, sizeof wanted) != 0) {
        memcpy(pdf->clip, wanted, sizeof wanted);
        cairo.reset_clip(pdf->cairo);
        cairo.rectangle(pdf->cairo, left, top, width, height);
        cairo.clip(pdf->cairo);
    }
}

static void put_path(struct gm_pdf *pdf, const struct gm_polyline *line, bool closed)
{
    cairo.new_path(pdf->cairo);
    for (size_t i = 0; i < line->count; i++) {
        cairo.line_to(pdf->cairo, line->points[i].x, line->points[i].y);
    }
    if (closed || line->count == 1) {
        cairo.close_path(pdf->cairo);
    }
}

static void line(void *self, const struct gm_polyline *line, const struct gm_stroke *stroke)
{
    struct gm_pdf *pdf = self;
    double pattern[GM_DASH_PARTS];
    for (size_t i = 0; i < stroke->parts; i++) {
        pattern[i] = fmaxf(stroke->pattern[i], GM_SHORTEST_DASH * stroke->width);
    }
    put_path(pdf, line, line->closed);
    set_ink(pdf, stroke->ink);
    cairo.set_line_width(pdf->cairo, stroke->width);
    cairo.set_dash(pdf->cairo, pattern, (int)stroke->parts, 0.0);
    cairo.stroke(pdf->cairo);
}

static void disc(void *self, struct gm_point centre, float width, struct gm_ink ink)
{
    struct gm_pdf *pdf = self;
    set_ink(pdf, ink);
    cairo.set_line_width(pdf->cairo, width);
    cairo.set_dash(pdf->cairo, NULL, 0, 0.0);
    cairo.move_to(pdf->cairo, centre.x, centre.y);
    cairo.close_path(pdf->cairo);
    cairo.stroke(pdf->cairo);
}

static void fill(void *self, const struct gm_polyline *line, struct gm_ink ink)
{
    struct gm_pdf *pdf = self;
    if (ink.alpha > 0.0) {
        put_path(pdf, line, true);
        set_ink(pdf, ink);
        cairo.fill(pdf->cairo);
    }
}

static void box(void *self, float left, float top, float right, float bottom, struct gm_ink ink)
{
    struct gm_pdf *pdf = self;
    set_ink(pdf, ink);
    cairo.rectangle(pdf->cairo, left, top, right - left, bottom - top);
    cairo.fill(pdf->cairo);
}

/* ---- fields ---- */

static cairo_surface_t *image_of(const struct gm_field_image *image, enum gm_colour_map map,
                                 enum gm_theme theme)
{
    uint8_t palette[GM_PALETTE][4];
    uint32_t colours[GM_PALETTE];
    gm_field_image_palette(image, map, theme, palette);
    for (int i = 0; i < GM_PALETTE; i++) { /* opaque, or black: the same multiplied by the opacity */
        const uint8_t *c = palette[i];
        colours[i] = (uint32_t)c[3] << 24 | (uint32_t)c[0] << 16 | (uint32_t)c[1] << 8 | c[2];
    }
    cairo_surface_t *surface = cairo.image_surface_create(CAIRO_FORMAT_ARGB32, image->columns, image->rows);
    unsigned char *data = cairo.image_surface_get_data(surface);
    const size_t stride = (size_t)cairo.image_surface_get_stride(surface);
    for (size_t y = 0; data && y < (size_t)image->rows; y++) {
        for (size_t x = 0; x < (size_t)image->columns; x++) {
            memcpy(data + y * stride + 4 * x, &colours[image->pixels[y * (size_t)image->columns + x]],
                   sizeof *colours);
        }
    }
    cairo.surface_mark_dirty(surface);
    return surface;
}

static void put_image(void *self, const struct gm_field_image *image, const struct gm_mark *mark)
{
    struct gm_pdf *pdf = self;
    cairo_surface_t *surface = image_of(image, mark->map, pdf->painter.look.theme);
    cairo.save(pdf->cairo);
    cairo.translate(pdf->cairo, image->left, image->top);
    cairo.scale(pdf->cairo, (double)image->width / image->columns, (double)image->height / image->rows);
    cairo.set_source_surface(pdf->cairo, surface, 0.0, 0.0);
    cairo.paint_with_alpha(pdf->cairo, mark->style.alpha);
    cairo.restore(pdf->cairo);
    cairo.surface_destroy(surface);
    pdf->fields++;
}

static void field(void *self, const struct gm_axes *axes, const struct gm_mark *mark)
{
    struct gm_pdf *pdf = self;
    pdf->short_of_memory |= !gm_field_image_draw(axes, mark, pdf->clip, put_image, pdf);
}

static void ramp(void *self, struct gm_box box, enum gm_colour_map map)
{
    struct gm_pdf *pdf = self;
    cairo_pattern_t *pattern = cairo.pattern_create_linear(0.0, box.y + box.height, 0.0, box.y);
    for (int i = 0; i <= STOPS; i++) {
        const struct gm_rgb rgb = gm_colour_map_at(map, pdf->painter.look.theme, (double)i / STOPS);
        cairo.pattern_add_color_stop_rgb(pattern, (double)i / STOPS, rgb.r / 255.0, rgb.g / 255.0,
                                         rgb.b / 255.0);
    }
    const double left = floor(box.x + 0.5), top = floor(box.y + 0.5);
    cairo.set_source(pdf->cairo, pattern);
    cairo.rectangle(pdf->cairo, left, top, floor(box.x + box.width + 0.5) - left,
                    floor(box.y + box.height + 0.5) - top);
    cairo.fill(pdf->cairo);
    cairo.pattern_destroy(pattern);
}

/* ---- letters ---- */

/* Returns the font of a file; NULL when out of memory. */
static cairo_font_face_t *font_of(const char *file)
{
    FcPattern *pattern = gm_fonts()->FcPatternCreate();
    if (!pattern) {
        return NULL;
    }
    gm_fonts()->FcPatternAddString(pattern, FC_FILE, (const FcChar8 *)file);
    gm_fonts()->FcPatternAddInteger(pattern, FC_INDEX, 0);
    cairo_font_face_t *font = cairo.ft_font_face_create_for_pattern(pattern);
    gm_fonts()->FcPatternDestroy(pattern);
    return font;
}

/* Places each letter by the widths of the layout, as text, so that it can be found and copied. */
static void text(void *self, const struct gm_writing *writing, const char *text)
{
    struct gm_pdf *pdf = self;
    const int bytes = (int)strlen(text);
    cairo_glyph_t *glyphs = NULL;
    cairo_text_cluster_t *clusters = NULL;
    cairo_text_cluster_flags_t flags;
    int glyph_count = 0, cluster_count = 0;
    cairo.save(pdf->cairo);
    cairo.translate(pdf->cairo, writing->upwards ? floor(writing->x + 0.5) : writing->x,
                    writing->upwards ? writing->y : floor(writing->y + 0.5));
    if (writing->upwards) {
        cairo.rotate(pdf->cairo, -0.5 * M_PI);
    }
    cairo.set_font_face(pdf->cairo, pdf->fonts[writing->font]);
    cairo.set_font_size(pdf->cairo, writing->letters);
    set_ink(pdf, writing->ink);
    const cairo_status_t status =
        cairo.scaled_font_text_to_glyphs(cairo.get_scaled_font(pdf->cairo), 0.0, 0.0, text, bytes, &glyphs,
                                         &glyph_count, &clusters, &cluster_count, &flags);
    if (status == CAIRO_STATUS_SUCCESS) {
        cairo.show_text_glyphs(pdf->cairo, text, bytes, glyphs, glyph_count, clusters, cluster_count, flags);
    } else if (status == CAIRO_STATUS_NO_MEMORY) {
        pdf->short_of_memory = true;
    }
    cairo.glyph_free(glyphs);
    cairo.text_cluster_free(clusters);
    cairo.restore(pdf->cairo);
}

static const struct gm_pen pen = {.clip = clip,
                                  .box = box,
                                  .line = line,
                                  .disc = disc,
                                  .fill = fill,
                                  .field = field,
                                  .ramp = ramp,
                                  .text = text};

/* ---- the page ---- */

static cairo_status_t take_bytes(void *out, const unsigned char *data, unsigned length)
{
    return fwrite(data, 1, length, out) == length ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_NO_MEMORY;
}

/* Sets the metadata: the subject has the texts that reproduce the file. */
static void set_metadata(cairo_surface_t *surface, const char *title, const struct gm_png_text *texts,
                         size_t count)
{
    char *subject = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&subject, &size);
    for (size_t i = 0; stream && i < count; i++) {
        fprintf(stream, "%s%s: %s", i > 0 ? "\n" : "", texts[i].key, texts[i].text);
    }
    if (stream) {
        fclose(stream);
    }
    cairo.pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, title);
    cairo.pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_SUBJECT, subject ? subject : "");
    cairo.pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, "geomint " GM_VERSION);
    cairo.pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    free(subject);
}

static void draw_page(struct gm_pdf *pdf, const struct gm_appearance *look, struct gm_picture *picture)
{
    for (int i = 0; i < GM_FONT_COUNT; i++) {
        pdf->fonts[i] = font_of(gm_glyphs_file(pdf->painter.glyphs, (enum gm_font)i));
    }
    cairo_font_options_t *options = cairo.font_options_create();
    cairo.font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo.font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo.set_font_options(pdf->cairo, options);
    cairo.font_options_destroy(options);
    cairo.set_line_cap(pdf->cairo, CAIRO_LINE_CAP_ROUND);
    cairo.set_line_join(pdf->cairo, CAIRO_LINE_JOIN_ROUND);
    cairo.set_fill_rule(pdf->cairo, CAIRO_FILL_RULE_EVEN_ODD);
    set_ink(pdf, (struct gm_ink){gm_theme_colour(look->theme, GM_PAPER), 1.0});
    cairo.paint(pdf->cairo);
    if (!gm_page_draw(&pdf->painter, picture)) {
        pdf->short_of_memory = true;
    }
    for (int i = 0; i < GM_FONT_COUNT; i++) {
        cairo.font_face_destroy(pdf->fonts[i]);
    }
}

static bool draw(void *self, struct gm_drawing *drawing, FILE *out)
{
    struct gm_pdf *pdf = self;
    const struct gm_appearance *look = drawing->look;
    const double points = 72.0, mm = 25.4, dpi = look->dpi > 0.0 ? look->dpi : 96.0;
    const bool paged = look->page_width > 0.0 && look->page_height > 0.0;
    const double width = points * (paged ? look->page_width / mm : look->width / dpi);
    const double height = points * (paged ? look->page_height / mm : look->height / dpi);
    cairo_surface_t *surface = cairo.pdf_surface_create_for_stream(take_bytes, out, width, height);
    set_metadata(surface, look->title ? look->title : drawing->picture->title, drawing->texts,
                 drawing->count);
    pdf->cairo = cairo.create(surface);
    cairo.scale(pdf->cairo, width / look->width, height / look->height);
    draw_page(pdf, look, drawing->picture);
    const bool drawn = cairo.status(pdf->cairo) == CAIRO_STATUS_SUCCESS;
    cairo.destroy(pdf->cairo);
    cairo.surface_finish(surface);
    const bool finished = cairo.surface_status(surface) == CAIRO_STATUS_SUCCESS;
    cairo.surface_destroy(surface);
    drawing->fields = pdf->fields;
    return drawn && finished && !pdf->short_of_memory;
}

bool gm_pdf_write(const char *path, struct gm_drawing *drawing, char *message)
{
    struct gm_pdf pdf = {.clip = {0, 0, drawing->look->width, drawing->look->height}};
    const struct gm_drawer drawer = {&pen, draw, &pdf, &pdf.painter};
    return open_cairo(message) && gm_drawing_write(path, drawing, &drawer, message);
}

const char *gm_pdf_backend(void)
{
    static char name[48];
    char message[GM_MESSAGE];
    snprintf(name, sizeof name, "Cairo %s",
             open_cairo(message) ? cairo.version_string() : CAIRO_VERSION_STRING);
    return name;
}
