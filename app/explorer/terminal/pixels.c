/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures painted and encoded beside the screen. */
#include "app/explorer/terminal/pixels.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/explorer/background/job.h"
#include "render/message.h"
#include "render/pixels/canvas.h"

struct gm_pixels {
    struct gm_job painting;
    bool busy; /* a picture was begun and not yet taken */

    /* the caller's and the thread's in turn */
    struct gm_picture *picture;
    struct gm_pixels_job job;
    const char *bytes;
    size_t size;
    char message[GM_MESSAGE];

    /* the thread's */
    struct gm_pixels_job made_for; /* what the following are for */
    struct gm_canvas *canvas;
    struct gm_inline *image;
    unsigned char *rgb;
};

static void forget(void *self)
{
    struct gm_pixels *pixels = self;
    gm_canvas_close(pixels->canvas);
    gm_inline_close(pixels->image);
    free(pixels->rgb);
    pixels->canvas = NULL;
    pixels->image = NULL;
    pixels->rgb = NULL;
}

static bool same_place(const struct gm_pixels_job *a, const struct gm_pixels_job *b)
{
    return a->kind == b->kind && a->theme == b->theme && memcmp(&a->place, &b->place, sizeof a->place) == 0;
}

/* Makes sure of a canvas of the right size. */
static bool prepare(struct gm_pixels *pixels)
{
    const struct gm_pixels_job *job = &pixels->job;
    struct gm_appearance look = {.theme = job->theme, .live = true};
    if (pixels->canvas && same_place(job, &pixels->made_for)) {
        return true;
    }
    forget(pixels);
    pixels->made_for = *job;
    gm_inline_size(&job->place, job->kind, &look.width, &look.height);
    pixels->canvas = gm_canvas_open(&look, pixels->message);
    if (!pixels->canvas) {
        return false;
    }
    pixels->image = gm_inline_open(job->kind, &job->place, job->most_width, job->most_height);
    pixels->rgb = malloc((size_t)look.width * (size_t)look.height * 3);
    return pixels->image && pixels->rgb;
}

static void paint(void *self)
{
    struct gm_pixels *pixels = self;
    snprintf(pixels->message, sizeof pixels->message, "There is not enough memory for a picture.");
    pixels->bytes = NULL;
    pixels->size = 0;
    if (!prepare(pixels) || !gm_canvas_paint(pixels->canvas, pixels->picture, pixels->rgb) ||
        !gm_inline_encode(pixels->image, pixels->rgb, pixels->job.whole, &pixels->bytes, &pixels->size)) {
        pixels->bytes = NULL;
        forget(pixels);
    } else if (!pixels->bytes) {
        pixels->bytes = ""; /* nothing changed */
    }
}

struct gm_pixels *gm_pixels_open(int wake, char *message)
{
    struct gm_pixels *pixels = calloc(1, sizeof *pixels);
    if (!pixels) {
        gm_refuse(message, "There is not enough memory.");
        return NULL;
    }
    /* a context of OpenGL, where there is one, is the thread's: it is closed there */
    if (!gm_job_open(&pixels->painting, paint, forget, pixels, wake, message)) {
        free(pixels);
        return NULL;
    }
    return pixels;
}

void gm_pixels_close(struct gm_pixels *pixels)
{
    if (pixels) {
        gm_job_close(&pixels->painting);
        free(pixels);
    }
}

void gm_pixels_paint(struct gm_pixels *pixels, struct gm_picture *picture, const struct gm_pixels_job *job)
{
    pixels->picture = picture;
    pixels->job = *job;
    pixels->busy = true;
    gm_job_begin(&pixels->painting);
}

bool gm_pixels_busy(const struct gm_pixels *pixels)
{
    return pixels->busy;
}

bool gm_pixels_take(struct gm_pixels *pixels, const char **bytes, size_t *size, char *message)
{
    if (!pixels->busy || gm_job_is_busy(&pixels->painting)) {
        return false;
    }
    pixels->busy = false;
    *bytes = pixels->bytes;
    *size = pixels->size;
    snprintf(message, GM_MESSAGE, "%s", pixels->message);
    return true;
}

const struct gm_panel *gm_pixels_locate(struct gm_pixels *pixels, struct gm_picture *picture, double across,
                                        double down, double *x, double *y)
{
    return pixels->canvas ? gm_canvas_locate(pixels->canvas, picture, across, down, x, y) : NULL;
}
