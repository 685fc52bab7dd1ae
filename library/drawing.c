/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures of a handle's lanes. A context of OpenGL is current in a thread: so pictures are
   drawn in a thread that knows nothing of the host, one at a time. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/output/printer.h"
#include "core/memory.h"
#include "library/handle.h"
#include "render/cells/text.h"
#include "render/pixels/canvas.h"

struct drawing {
    geomint *handle;
    const struct gm_lane **lanes;
    struct gm_appearance look;
    const char *path; /* of a file, and its format, or */
    enum gm_format format;
    unsigned char *rgba; /* pixels */
};

/* The canvas of the handle's last picture, or a new one; NULL with a message. */
static struct gm_canvas *open_canvas(const struct drawing *drawing, char *message)
{
    struct gm_kept_canvas *kept = &drawing->handle->kept;
    const struct gm_appearance *look = &drawing->look;
    const char *painter = getenv("GEOMINT_PAINTER");
    const bool fits = kept->look.width == look->width && kept->look.height == look->height &&
                      kept->look.scale == look->scale && kept->look.theme == look->theme &&
                      strcmp(kept->painter, painter ? painter : "") == 0;
    if (!kept->canvas || !fits) {
        gm_canvas_close(kept->canvas);
        *kept = (struct gm_kept_canvas){.canvas = gm_canvas_open(look, message), .look = *look};
        snprintf(kept->painter, sizeof kept->painter, "%s", painter ? painter : "");
    }
    return kept->canvas;
}

static bool paint(struct drawing *drawing, char *message)
{
    const struct gm_appearance *look = &drawing->look;
    struct gm_canvas *canvas = open_canvas(drawing, message);
    if (!canvas) {
        return false;
    }
    struct gm_picture *picture = gm_picture_open();
    const unsigned long refusals = gm_memory_refusals();
    bool painted = false;
    if (picture) {
        gm_lanes_draw(drawing->lanes, drawing->handle->request->count, picture);
        painted = gm_canvas_paint_opaque(canvas, picture, drawing->rgba);
    }
    const bool good = painted && gm_memory_refusals() == refusals;
    gm_picture_close(picture);
    if (!good || strcmp(gm_canvas_backend(canvas), "own") != 0) { /* a context of OpenGL is this thread's */
        gm_canvas_close(canvas);
        drawing->handle->kept.canvas = NULL;
    }
    return good ||
           gm_refuse(message, "there is not enough memory for a picture of %dx%d", look->width, look->height);
}

static bool print(struct drawing *drawing, char *message)
{
    struct gm_print print = {.path = drawing->path, .look = drawing->look, .format = drawing->format};
    return gm_still_write(&print, drawing->handle->request, drawing->lanes, message);
}

/* The body of a thread, where no OpenGL context of the host is current: so none is replaced. */
static void *draw(void *data)
{
    struct drawing *drawing = data;
    geomint *handle = drawing->handle;
    char message[GM_MESSAGE] = "";
    uselocale(gm_library_locale);
    if (handle->session || gm_handle_follow(handle)) { /* a session records its steps itself */
        for (size_t i = 0; i < handle->request->count; i++) {
            drawing->lanes[i] = handle->session ? handle->session->lanes[i] : handle->drawn[i].lane;
        }
        const bool pixels = !drawing->path || drawing->format == GM_FORMAT_PNG;
        if (pixels && !gm_canvas_choose(NULL, message)) {
            gm_handle_refuse(handle, GEOMINT_USAGE, message);
        } else if (!(drawing->path ? print : paint)(drawing, message)) {
            gm_handle_refuse(handle, gm_memory_refusals() > 0 ? GEOMINT_MEMORY : GEOMINT_FILE, message);
        }
    } else if (gm_memory_refusals() > 0) { /* of this thread, which gm_call_end does not see */
        gm_handle_refuse(handle, GEOMINT_MEMORY, "there is not enough memory");
    }
    return NULL;
}

/* Returns true if the sizes of a picture are in range, otherwise false with a message. */
static bool check(geomint *handle, const struct gm_appearance *look)
{
    char sentence[GM_MESSAGE];
    const int least = look->width < look->height ? look->width : look->height;
    const int most = look->width > look->height ? look->width : look->height;
    if (least < GM_LEAST_SIDE || most > GM_MOST_SIDE) {
        gm_refuse(sentence, "a picture of %dx%d: each side is from %d to %d", look->width, look->height,
                  GM_LEAST_SIDE, GM_MOST_SIDE);
        return gm_handle_refuse(handle, GEOMINT_USAGE, sentence);
    }
    if (look->scale != 0 && !(look->scale >= GM_LEAST_SCALE && look->scale <= GM_MOST_SCALE)) {
        gm_refuse(sentence, "letters and lines %g times as large: from %g to %g", look->scale, GM_LEAST_SCALE,
                  GM_MOST_SCALE);
        return gm_handle_refuse(handle, GEOMINT_USAGE, sentence);
    }
    return true;
}

static int draw_alone(struct drawing *drawing)
{
    static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;
    geomint *handle = drawing->handle;
    const struct gm_call call = gm_call_begin(handle);
    const size_t count = geomint_lanes(handle);
    pthread_t thread;
    if (gm_handle_has(handle, 0) && check(handle, &drawing->look)) {
        drawing->lanes = calloc(count, sizeof *drawing->lanes);
        pthread_mutex_lock(&turn);
        gm_memory_forget(); /* a shortage that is over spoils no picture */
        if (!drawing->lanes || pthread_create(&thread, NULL, draw, drawing) != 0 ||
            pthread_join(thread, NULL) != 0) {
            gm_handle_refuse(handle, GEOMINT_MEMORY, "there is not enough memory");
        }
        pthread_mutex_unlock(&turn);
        free(drawing->lanes);
    }
    return gm_call_end(&call);
}

int geomint_theme(geomint *handle, const char *name)
{
    const struct gm_call call = gm_call_begin(handle);
    const bool given = handle && gm_handle_given(handle, name, "name"),
               dark = given && strcmp(name, "dark") == 0;
    if (given && !dark && strcmp(name, "light") != 0) {
        gm_handle_refuse(handle, GEOMINT_USAGE, "a theme is light or dark");
    } else if (given) {
        handle->theme = dark ? GM_THEME_DARK : GM_THEME_LIGHT;
    }
    return gm_call_end(&call);
}

int geomint_draw(geomint *handle, int width, int height, double scale, unsigned char *rgba)
{
    if (!gm_handle_given(handle, rgba, "rgba")) {
        return geomint_status(handle);
    }
    const struct gm_appearance look = {
        .width = width, .height = height, .scale = scale, .theme = handle ? handle->theme : GM_THEME_LIGHT};
    return draw_alone(&(struct drawing){.handle = handle, .look = look, .rgba = rgba});
}

int geomint_save(geomint *handle, const char *path, int width, int height, double scale, const char *title)
{
    struct drawing drawing = {.handle = handle,
                              .look = {.width = width,
                                       .height = height,
                                       .scale = scale,
                                       .title = title,
                                       .theme = handle ? handle->theme : GM_THEME_LIGHT},
                              .path = path};
    if (!gm_handle_given(handle, path, "path")) {
        return geomint_status(handle);
    }
    if (!gm_format_of(path, &drawing.format)) {
        gm_handle_refuse(handle, GEOMINT_USAGE, "the name of a picture's file ends with .png, .svg or .pdf");
        return geomint_status(handle);
    }
    if (title && (!*title || !gm_text_is_plain(title))) {
        gm_handle_refuse(handle, GEOMINT_USAGE,
                         "the title is empty, or holds a character that cannot be shown");
        return geomint_status(handle);
    }
    return draw_alone(&drawing);
}
