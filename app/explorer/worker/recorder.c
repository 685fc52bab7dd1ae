/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A movie of what is seen: frames to ffmpeg in a thread, so that steps do not wait for it. */
#include "app/explorer/worker/recorder.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/request/drive.h"
#include "render/files/sink.h"
#include "render/files/thread.h"
#include "render/gl/canvas.h"
#include "render/message.h"

enum { WIDTH = 1280, HEIGHT = 720, RATE = 30 };

struct gm_recorder {
    pthread_t thread;
    char *path;
    enum gm_theme theme;
    struct gm_picture *picture;
    struct gm_sink *sink;

    /* the caller's */
    double begun; /* the time of the first frame, without what was left out */
    long frames;  /* that the movie has, with those that are under way */
    long due;     /* of them the picture that is due */

    /* shared, under the lock */
    pthread_mutex_t lock;
    pthread_cond_t news;
    bool busy, leave, failed;
    long repeat; /* so many frames show the picture */
    char message[GM_MESSAGE];
};

/* Paints a picture once and puts it into the movie so many times. */
static bool record(struct gm_recorder *recorder, struct gm_canvas *canvas, long repeat)
{
    const size_t size = (size_t)WIDTH * HEIGHT * 3;
    unsigned char *painted = NULL;
    for (long i = 0; i < repeat; i++) {
        unsigned char *frame = gm_sink_frame(recorder->sink);
        if (!frame) {
            free(painted);
            return false;
        }
        if (i == 0) {
            bool ok = gm_canvas_paint(canvas, recorder->picture, frame);
            if (ok && repeat > 1) { /* a frame that is put is the sink's */
                painted = malloc(size);
                ok = painted != NULL;
            }
            if (!ok) {
                gm_sink_put(recorder->sink, frame, 0, NULL, 0);
                return false;
            }
            if (painted) {
                memcpy(painted, frame, size);
            }
        } else {
            memcpy(frame, painted, size);
        }
        if (!gm_sink_put(recorder->sink, frame, 0, NULL, 0)) {
            free(painted);
            return false;
        }
    }
    free(painted);
    return true;
}

static void *work(void *self)
{
    struct gm_recorder *recorder = self;
    char message[GM_MESSAGE];
    struct gm_canvas *canvas = gm_canvas_open(WIDTH, HEIGHT, recorder->theme, message);
    pthread_mutex_lock(&recorder->lock);
    if (!canvas) {
        recorder->failed = true;
        snprintf(recorder->message, sizeof recorder->message, "%s", message);
    }
    while (!recorder->leave || recorder->busy) { /* what is under way is finished */
        if (!recorder->busy) {
            pthread_cond_wait(&recorder->news, &recorder->lock);
            continue;
        }
        if (!recorder->failed) {
            long repeat = recorder->repeat;
            pthread_mutex_unlock(&recorder->lock);
            bool ok = record(recorder, canvas, repeat);
            pthread_mutex_lock(&recorder->lock);
            recorder->failed = !ok;
        }
        recorder->busy = false;
    }
    pthread_mutex_unlock(&recorder->lock);
    gm_canvas_close(canvas); /* here, because the context is this thread's */
    return NULL;
}

static void release(struct gm_recorder *recorder)
{
    pthread_mutex_destroy(&recorder->lock);
    pthread_cond_destroy(&recorder->news);
    gm_picture_close(recorder->picture);
    free(recorder->path);
    free(recorder);
}

struct gm_recorder *gm_recorder_open(const char *path, enum gm_theme theme, char *message)
{
    struct gm_recorder *recorder = calloc(1, sizeof *recorder);
    if (!recorder) {
        snprintf(message, GM_MESSAGE, "There is not enough memory.");
        return NULL;
    }
    pthread_mutex_init(&recorder->lock, NULL);
    pthread_cond_init(&recorder->news, NULL);
    recorder->theme = theme;
    recorder->begun = NAN;
    recorder->path = strdup(path);
    recorder->picture = gm_picture_open();
    const struct gm_sink_settings settings = {
        .width = WIDTH, .height = HEIGHT, .fps = RATE, .interruptions = &gm_interrupted};
    if (!recorder->path || !recorder->picture) {
        snprintf(message, GM_MESSAGE, "There is not enough memory.");
        release(recorder);
        return NULL;
    }
    recorder->sink = gm_sink_open_movie(path, &settings, message);
    if (!recorder->sink) {
        release(recorder);
        return NULL;
    }
    const int error = gm_thread_start(&recorder->thread, work, recorder);
    if (error != 0) {
        gm_sink_close(recorder->sink, false, message);
        snprintf(message, GM_MESSAGE, "No thread could be started: %s.", strerror(error));
        release(recorder);
        return NULL;
    }
    return recorder;
}

bool gm_recorder_close(struct gm_recorder *recorder, char *message)
{
    pthread_mutex_lock(&recorder->lock);
    recorder->leave = true;
    pthread_cond_signal(&recorder->news);
    pthread_mutex_unlock(&recorder->lock);
    pthread_join(recorder->thread, NULL);
    bool good = gm_sink_close(recorder->sink, true, message);
    if (recorder->message[0]) { /* there was no GL to paint with */
        snprintf(message, GM_MESSAGE, "%s", recorder->message);
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
    pthread_mutex_lock(&recorder->lock);
    bool busy = recorder->busy;
    pthread_mutex_unlock(&recorder->lock);
    if (due < 1 || busy) {
        return NULL;
    }
    if (due > RATE) { /* nothing changed for long */
        recorder->begun += (double)(due - RATE) / RATE;
        due = RATE;
    }
    recorder->due = due;
    gm_picture_clear(recorder->picture);
    return recorder->picture;
}

void gm_recorder_put(struct gm_recorder *recorder)
{
    recorder->frames += recorder->due;
    pthread_mutex_lock(&recorder->lock);
    recorder->repeat = recorder->due;
    recorder->busy = true;
    pthread_cond_signal(&recorder->news);
    pthread_mutex_unlock(&recorder->lock);
}
