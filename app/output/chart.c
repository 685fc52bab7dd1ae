/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a command that measures puts its diagram and its table. */
#include "app/output/chart.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/output/folder.h"
#include "app/output/provenance.h"
#include "core/memory.h"
#include "render/files/png.h"
#include "render/gl/canvas.h"
#include "render/message.h"

static bool paint(const struct gm_chart *chart, const void *data,
                  void (*draw)(const void *data, struct gm_picture *picture), char *message)
{
    const int width = chart->width, height = chart->height;
    struct gm_canvas *canvas = gm_canvas_open(width, height, chart->theme, message);
    if (!canvas) {
        return false;
    }
    struct gm_picture *picture = gm_picture_open();
    unsigned char *rgb = malloc((size_t)width * (size_t)height * 3);
    struct gm_provenance provenance = {0};
    bool good = picture && rgb &&
                gm_provenance_of_command(&provenance, chart->command, width, height, chart->theme,
                                         gm_canvas_backend(canvas));
    if (good) {
        draw(data, picture);
        good = gm_canvas_paint(canvas, picture, rgb) && !gm_memory_was_short();
    }
    if (good) {
        good = gm_png_write(chart->png, width, height, rgb, provenance.texts, provenance.count, message);
    } else {
        snprintf(message, GM_MESSAGE, "not enough memory for a picture of %dx%d", width, height);
    }
    gm_provenance_close(&provenance);
    free(rgb);
    gm_picture_close(picture);
    gm_canvas_close(canvas);
    return good;
}

bool gm_chart_write(struct gm_chart *chart, const void *data,
                    void (*draw)(const void *data, struct gm_picture *picture),
                    bool (*write)(const void *data, const char *path), char *message)
{
    const char *folder = chart->folder ? chart->folder : ".";
    const int png = snprintf(chart->png, sizeof chart->png, "%s/%s.png", folder, chart->name);
    const int csv = snprintf(chart->csv, sizeof chart->csv, "%s/%s.csv", folder, chart->name);
    if (png >= (int)sizeof chart->png || csv >= (int)sizeof chart->csv) {
        snprintf(message, GM_MESSAGE, "the name of the folder is too long");
        return false;
    }
    if (!gm_folder_make(chart->folder, message) || !paint(chart, data, draw, message)) {
        return false;
    }
    if (write && !write(data, chart->csv)) {
        snprintf(message, GM_MESSAGE, "%.400s could not be written: %s", chart->csv, strerror(errno));
        return false;
    }
    return true;
}
