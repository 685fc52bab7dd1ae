/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A movie made beside the session that is played. */
#include "app/explorer/worker/recorder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/interrupt.h"
#include "app/explorer/background/job.h"
#include "render/files/sink.h"
#include "render/message.h"
#include "render/pixels/canvas.h"

enum { WIDTH = 1280, HEIGHT = 720, RATE = 30 };

struct gm_recorder {
    struct gm_job painting;
    char *path;
    enum gm_theme theme;
    struct gm_sink *sink;

    /* the caller's */
    double begun; /* the time of the first frame, without what was left out */
    long frames;  /* that the movie has, with those that are under way */

    /* the caller's and the thread's in turn */
    struct gm_picture *picture;
    long repeat; /* so many frames show it */

    /* the thread's */
    struct gm_canvas *canvas; /* NULL: not yet */
    unsigned char *rgb;
    bool failed;
    char message[GM_MESSAGE];
};

static bool open_canvas(struct gm_recorder *recorder)
{
    if (!recorder->canvas) {
        const struct gm_appearance look = {.width = WIDTH, .height = HEIGHT, .theme = recorder->theme};
        recorder->canvas = gm_canvas_open(&look, recorder->message);
    }
    if (!recorder->rgb) {
        recorder->rgb = malloc((size_t)WIDTH * HEIGHT * 3);
    }
    return recorder->canvas && recorder->rgb;
}

/* Paints a picture once and puts it into the movie so many times. */
static void record(void *self)
{
    struct gm_recorder *recorder = self;
    recorder->failed = recorder->failed || !open_canvas(recorder) ||
                       !gm_canvas_paint(recorder->canvas, recorder->picture, recorder->rgb) ||
                       !gm_sink_hold(recorder->sink, recorder->rgb, recorder->repeat);
}

/* In the thread, because the context is its own. */
static void end(void *self)
{
    struct gm_recorder *recorder = self;
    gm_canvas_close(recorder->canvas);
    free(recorder->rgb);
}

static void release(struct gm_recorder *recorder)
{
    gm_picture_close(recorder->picture);
    free(recorder->path);
    free(recorder);
}

struct gm_recorder *gm_recorder_open(const char *path, enum gm_theme theme, char *message)
{
    struct gm_recorder *recorder = calloc(1, sizeof *recorder);
    if (!recorder) {
        gm_refuse(message, "There is not enough memory.");
        return NULL;
    }
    recorder->theme = theme;
    recorder->begun = NAN;
    recorder->path = strdup(path);
    recorder->picture = gm_picture_open();
    const struct gm_sink_settings settings = {
        .width = WIDTH, .height = HEIGHT, .fps = RATE, .interruptions = &gm_interrupted};
    if (!recorder->path || !recorder->picture) {
        gm_refuse(message, "There is not enough memory.");
        release(recorder);
        return NULL;
    }
    recorder->sink = gm_sink_open_movie(path, &settings, message);
    if (!recorder->sink) {
        release(recorder);
        return NULL;
    }
    if (!gm_job_open(&recorder->painting, record, end, recorder, -1, message)) {
        char given_up[GM_MESSAGE];
        gm_sink_close(recorder->sink, false, given_up);
        release(recorder);
        return NULL;
    }
    return recorder;
}

bool gm_recorder_close(struct gm_recorder *recorder, char *message)
{
    gm_job_close(&recorder->painting);
    bool good = gm_sink_close(recorder->sink, true, message);
    if (recorder->message[0]) { /* there was nothing to paint with */
        gm_refuse(message, "%s", recorder->message);
        good = false;
    }
    release(recorder);
    return good;
}

const char *gm_recorder_path(const struct gm_recorder *recorder)
{
    return recorder->path;
}

double gm_recorder_length(const struct gm_recorder *recorder)
{
    return (double)recorder->frames / RATE;
}

struct gm_picture *gm_recorder_due(struct gm_recorder *recorder, double now)
{
    if (isnan(recorder->begun)) {
        recorder->begun = now - 1.0 / RATE;
    }
    long due = (long)((now - recorder->begun) * RATE + 1e-6) - recorder->frames;
    if (due < 1 || gm_job_is_busy(&recorder->painting)) {
        return NULL;
    }
    if (due > RATE) { /* nothing changed for long */
        recorder->begun += (double)(due - RATE) / RATE;
        due = RATE;
    }
    recorder->repeat = due;
    gm_picture_clear(recorder->picture);
    return recorder->picture;
}

void gm_recorder_put(struct gm_recorder *recorder)
{
    recorder->frames += recorder->repeat;
    gm_job_begin(&recorder->painting);
}
