/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a command that measures puts its diagram and its table. */
#include "app/output/chart.h"

#include <stdio.h>
#include <stdlib.h>

#include "app/output/folder.h"
#include "app/output/provenance.h"
#include "app/request/drive.h"
#include "core/memory.h"
#include "render/files/png.h"
#include "render/gl/canvas.h"

bool gm_chart_open(struct gm_chart *chart, const struct gm_options *options, const char *command,
                   const char *name, char *message)
{
    const char *folder = options->out ? options->out : ".";
    name = options->name ? options->name : name;
    chart->options = options;
    chart->command = command;
    const int png = snprintf(chart->png, sizeof chart->png, "%s/%s.png", folder, name);
    const int csv = snprintf(chart->csv, sizeof chart->csv, "%s/%s.csv", folder, name);
    if (png >= (int)sizeof chart->png || csv >= (int)sizeof chart->csv) {
        snprintf(message, GM_MESSAGE, "the name of the folder is too long");
        return false;
    }
    return gm_folder_make(options->out, message);
}

bool gm_chart_paint(const struct gm_chart *chart, const void *data,
                    void (*draw)(const void *data, struct gm_picture *picture), char *message)
{
    const int width = chart->options->width, height = chart->options->height;
    struct gm_canvas *canvas = gm_canvas_open(width, height, chart->options->theme, message);
    if (!canvas) {
        return false;
    }
    struct gm_picture *picture = gm_picture_open();
    unsigned char *rgb = malloc((size_t)width * (size_t)height * 3);
    struct gm_provenance provenance = {0};
    bool good =
        picture && rgb &&
        gm_provenance_of_command(&provenance, chart->command, chart->options, gm_canvas_backend(canvas));
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

void gm_chart_tell(const struct gm_chart *chart)
{
    gm_complain("wrote %s and %s", chart->png, chart->csv);
}
