/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lanes as they are now, as one PNG. */
#include "app/output/still.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/output/provenance.h"
#include "core/memory.h"
#include "render/gl/canvas.h"

static bool write_texts(const char *path, int width, int height, const unsigned char *rgb,
                        const struct gm_provenance *provenance, char *steps, char *message)
{
    struct gm_png_text texts[GM_PROVENANCE_TEXTS + 1];
    memcpy(texts, provenance->texts, provenance->count * sizeof texts[0]);
    texts[provenance->count] = (struct gm_png_text){GM_KEY_STEPS, steps};
    return gm_png_write(path, width, height, rgb, texts, provenance->count + 1, message);
}

bool gm_still_write(const char *path, int width, int height, enum gm_theme theme,
                    const struct gm_request *request, const struct gm_lane *const *lanes, char *message)
{
    struct gm_canvas *canvas = gm_canvas_open(width, height, theme, message);
    if (!canvas) {
        return false;
    }
    struct gm_picture *picture = gm_picture_open();
    unsigned char *rgb = malloc((size_t)width * (size_t)height * 3);
    char *steps = gm_provenance_steps(lanes, request->count);
    struct gm_provenance provenance = {0};
    bool good = picture && rgb && steps &&
                gm_provenance_make(&provenance, request, width, height, theme, gm_canvas_backend(canvas));
    if (good) {
        request->scene->draw(lanes, request->count, picture);
        good = gm_canvas_paint(canvas, picture, rgb) && !gm_memory_was_short();
    }
    if (good) {
        good = write_texts(path, width, height, rgb, &provenance, steps, message);
    } else {
        snprintf(message, GM_MESSAGE, "not enough memory for a picture of %dx%d", width, height);
    }
    gm_provenance_close(&provenance);
    free(steps);
    free(rgb);
    gm_picture_close(picture);
    gm_canvas_close(canvas);
    return good;
}
