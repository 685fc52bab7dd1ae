/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures to files: pixels to PNG, drawings to SVG and PDF. */
#include "app/output/printer.h"

#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "app/output/folder.h"
#include "app/output/say.h"
#include "core/memory.h"
#include "render/drawing/glyphs.h"
#include "render/message.h"
#include "render/pixels/canvas.h"
#include "render/vector/vector.h"

static const char *const names[GM_FORMAT_COUNT] = {"png", "svg", "pdf"};

const char *gm_format_name(enum gm_format format)
{
    return names[format];
}

bool gm_format_find(const char *name, enum gm_format *format)
{
    for (int i = 0; i < GM_FORMAT_COUNT; i++) {
        if (strcasecmp(name, names[i]) == 0) {
            *format = (enum gm_format)i;
            return true;
        }
    }
    return false;
}

bool gm_format_of(const char *path, enum gm_format *format)
{
    const char *dot = strrchr(basename(path), '.');
    return dot && gm_format_find(dot + 1, format);
}

void gm_printer_expect(enum gm_format format)
{
    if (format == GM_FORMAT_PNG) {
        gm_canvas_expect();
    }
}

/* Writes a picture with its metadata; a PNG is painted on the canvas first. Returns false with a sentence, or when
   out of memory. */
static bool write_file(struct gm_print *print, struct gm_picture *picture, struct gm_canvas *canvas,
                       unsigned char *rgb, const struct gm_provenance *provenance, char *message)
{
    const struct gm_appearance *look = &print->look;
    const char *path = strcmp(print->path, "-") == 0 ? "/dev/stdout" : print->path;
    if (gm_memory_was_short()) {
        return false;
    }
    if (!canvas) {
        struct gm_drawing drawing = {
            .look = look, .picture = picture, .texts = provenance->texts, .count = provenance->count};
        const bool drawn =
            (print->format == GM_FORMAT_SVG ? gm_svg_write : gm_pdf_write)(path, &drawing, message);
        print->fields = drawing.fields;
        if (!drawn && errno == ENOMEM) {
            gm_memory_refused(); /* possibly Cairo's, which does not report it otherwise */
        }
        return drawn;
    }
    if (!gm_canvas_paint(canvas, picture, rgb)) {
        gm_memory_refused();
    }
    const struct gm_png image = {.width = look->width,
                                 .height = look->height,
                                 .dpi = look->dpi,
                                 .pixels = rgb,
                                 .texts = provenance->texts,
                                 .text_count = provenance->count};
    return !gm_memory_was_short() && gm_png_write(path, &image, message);
}

bool gm_print_write(struct gm_print *print, const struct gm_printed *content, char *message)
{
    const struct gm_appearance *look = &print->look;
    const bool painted = print->format == GM_FORMAT_PNG;
    struct gm_canvas *canvas = painted ? gm_canvas_open(look, message) : NULL;
    unsigned char *rgb = canvas ? malloc((size_t)look->width * (size_t)look->height * 3) : NULL;
    struct gm_picture *picture = gm_picture_open();
    struct gm_provenance provenance = {0};
    bool printed = false;
    const char *writer = print->format == GM_FORMAT_SVG ? "SVG" : gm_pdf_backend();
    if ((!painted || rgb) && picture &&
        content->describe(&provenance, content->data, look, canvas ? gm_canvas_backend(canvas) : writer)) {
        gm_picture_draw(picture, content->draw, content->data);
        printed = write_file(print, picture, canvas, rgb, &provenance, message);
    }
    gm_provenance_close(&provenance);
    gm_picture_close(picture);
    free(rgb);
    gm_canvas_close(canvas);
    if (!printed && gm_memory_was_short()) {
        gm_refuse(message, "not enough memory for a picture of %dx%d", look->width, look->height);
    }
    return printed;
}

int gm_printer_fail(const char *path, const char *message)
{
    struct pollfd pipe = {.fd = STDOUT_FILENO, .events = POLLOUT};
    if (path && strcmp(path, "-") == 0 && poll(&pipe, 1, 0) > 0 && (pipe.revents & POLLERR)) {
        return GM_EXIT_PIPE;
    }
    return gm_give_up(GM_EXIT_FILE, "%s", message);
}

/* The letters that the font lacks, the last place of them for that there are more. */
static void tell_lacking(void)
{
    enum { TOLD = GM_LACKING - 1 };
    uint32_t letters[GM_LACKING];
    const size_t count = gm_glyphs_lacking(letters);
    char told[TOLD * 16] = "";
    for (size_t i = 0; i < count && i < TOLD; i++) {
        const char *between = i == 0 ? "" : i + 1 == count ? " and " : ", ";
        gm_append(told, sizeof told, "%sU+%04" PRIX32, between, letters[i]);
    }
    if (count == 1) {
        gm_complain("the font has no letter %s: a box stands for it in the picture", told);
    } else if (count > 1) {
        gm_complain("the font has no letters %s%s: boxes stand for them in the picture", told,
                    count > TOLD ? " and others" : "");
    }
}

void gm_printer_report(const struct gm_print *print, const char *table)
{
    if (strcmp(print->path, "-") != 0) {
        gm_complain("wrote %s%s%s", print->path, table[0] ? " and " : "", table);
    }
    if (print->format != GM_FORMAT_SVG) {
        tell_lacking();
    }
    if (print->fields > 0 && !gm_memory_was_short()) {
        gm_complain("%s in it %s of pixels; all else is lines and letters",
                    print->fields > 1 ? "the fields of colours" : "the field of colours",
                    print->fields > 1 ? "are images" : "is an image");
    }
}

/* The lanes of a picture, and the words from which they are. */
struct still {
    const struct gm_request *request;
    const struct gm_lane *const *lanes;
};

static bool describe_still(struct gm_provenance *provenance, const void *data,
                           const struct gm_appearance *look, const char *painter)
{
    const struct still *still = data;
    return gm_provenance_make(provenance, still->request, look, painter) &&
           gm_provenance_take_lanes(provenance, still->lanes, still->request->count, true);
}

static void draw_still(const void *data, struct gm_picture *picture)
{
    const struct still *still = data;
    gm_lanes_draw(still->lanes, still->request->count, picture);
}

bool gm_still_write(struct gm_print *print, const struct gm_request *request,
                    const struct gm_lane *const *lanes, char *message)
{
    const struct gm_printed content = {&(struct still){request, lanes}, describe_still, draw_still};
    return gm_folder_make_for(print->path, message) && gm_print_write(print, &content, message);
}
