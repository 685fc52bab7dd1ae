/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The queue of frames and its workers; and numbered PNG files, written by several threads. */
#include "render/files/sink.h"

#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/address_space.h"
#include "render/files/thread.h"

/* A frame is in `queue` from put until a worker takes it, and in `idle` while it is unused. There are at most
   `limit` frames, made at need: put never waits, gm_sink_frame does. */

enum {
    STACK = 8 << 20, /* bytes of a thread's stack */
    MOST_WORKERS = 64,
    MOST_FRAMES = MOST_WORKERS + 2,
    MOST_DIGITS = 64,
};

struct gm_sink {
    const struct gm_sink_kind *kind;
    void *self;
    size_t frame_size;
    pthread_mutex_t lock;
    pthread_cond_t work;   /* signals workers: a job, or the end */
    pthread_cond_t vacant; /* signals gm_sink_frame: an idle frame, or a failure */
    size_t limit, made, idle_count, queued, head;
    unsigned char *frames[MOST_FRAMES], *idle[MOST_FRAMES]; /* all frames made; the unused ones */
    struct gm_sink_job queue[MOST_FRAMES];                  /* a ring of `limit` jobs */
    bool closing, dropping, failed;
    int worker_count;
    pthread_t workers[MOST_WORKERS];
    char message[GM_MESSAGE];
};

static void free_texts(struct gm_png_text *texts, size_t count)
{
    for (size_t i = 0; texts && i < count; i++) {
        free((char *)texts[i].key);
        free((char *)texts[i].text);
    }
    free(texts);
}

/* Returns copies for free_texts. */
static struct gm_png_text *copy_texts(const struct gm_png_text *texts, size_t count)
{
    struct gm_png_text *copy = calloc(count ? count : 1, sizeof *copy);
    for (size_t i = 0; copy && i < count; i++) {
        copy[i].key = strdup(texts[i].key);
        copy[i].text = strdup(texts[i].text);
        if (!copy[i].key || !copy[i].text) {
            free_texts(copy, count);
            return NULL;
        }
    }
    return copy;
}

/* Notes the first failure, the only one reported. The caller holds the lock. */
static void note_failure(struct gm_sink *sink, const char *message)
{
    if (!sink->failed) {
        sink->failed = true;
        snprintf(sink->message, sizeof sink->message, "%s", message);
    }
    pthread_cond_broadcast(&sink->vacant);
}

static void *work(void *argument)
{
    struct gm_sink *sink = argument;
    pthread_mutex_lock(&sink->lock);
    for (;;) {
        while (sink->queued == 0 && !sink->closing) {
            pthread_cond_wait(&sink->work, &sink->lock);
        }
        if (sink->queued == 0) {
            break;
        }
        struct gm_sink_job job = sink->queue[sink->head];
        sink->head = (sink->head + 1) % sink->limit;
        sink->queued--;
        bool wanted = !sink->failed && !sink->dropping;
        pthread_mutex_unlock(&sink->lock);

        char message[GM_MESSAGE] = "";
        const bool done = !wanted || sink->kind->write(sink->self, &job, message);
        free_texts(job.texts, job.text_count);

        pthread_mutex_lock(&sink->lock);
        sink->idle[sink->idle_count++] = job.frame;
        pthread_cond_signal(&sink->vacant);
        if (!done) {
            note_failure(sink, message);
        }
    }
    pthread_mutex_unlock(&sink->lock);
    return NULL;
}

static void release(struct gm_sink *sink)
{
    for (size_t i = 0; i < sink->made; i++) {
        free(sink->frames[i]);
    }
    pthread_mutex_destroy(&sink->lock);
    pthread_cond_destroy(&sink->work);
    pthread_cond_destroy(&sink->vacant);
    free(sink);
}

static void end_workers(struct gm_sink *sink, bool drop)
{
    pthread_mutex_lock(&sink->lock);
    sink->closing = true;
    sink->dropping = drop;
    pthread_cond_broadcast(&sink->work);
    pthread_mutex_unlock(&sink->lock);
    for (int i = 0; i < sink->worker_count; i++) {
        pthread_join(sink->workers[i], NULL);
    }
}

static bool start_workers(struct gm_sink *sink, int workers)
{
    while (sink->worker_count < workers &&
           gm_thread_start(&sink->workers[sink->worker_count], work, sink) == 0) {
        sink->worker_count++;
    }
    if (sink->worker_count == 0) {
        gm_address_space_has(STACK); /* notes whether it was memory, which pthread_create does not report */
    }
    return sink->worker_count > 0;
}

struct gm_sink *gm_sink_start(const struct gm_sink_kind *kind, void *self, int workers, size_t frame_size,
                              char *message)
{
    struct gm_sink *sink = calloc(1, sizeof *sink);
    if (sink) {
        pthread_mutex_init(&sink->lock, NULL);
        pthread_cond_init(&sink->work, NULL);
        pthread_cond_init(&sink->vacant, NULL);
        sink->kind = kind;
        sink->self = self;
        sink->frame_size = frame_size;
        sink->limit = (size_t)workers + MOST_FRAMES - MOST_WORKERS;
        if (start_workers(sink, workers)) {
            return sink;
        }
        release(sink);
    }
    kind->close(self, false, message);
    gm_refuse(message, "not enough memory or threads to write frames");
    return NULL;
}

unsigned char *gm_sink_frame(struct gm_sink *sink)
{
    unsigned char *frame = NULL;
    pthread_mutex_lock(&sink->lock);
    while (!sink->failed && sink->idle_count == 0 && sink->made == sink->limit) {
        pthread_cond_wait(&sink->vacant, &sink->lock);
    }
    if (!sink->failed && sink->idle_count == 0) {
        frame = malloc(sink->frame_size);
        if (frame) {
            sink->frames[sink->made++] = frame;
        } else {
            note_failure(sink, "not enough memory for a frame");
        }
    } else if (!sink->failed) {
        frame = sink->idle[--sink->idle_count];
    }
    pthread_mutex_unlock(&sink->lock);
    return frame;
}

bool gm_sink_put(struct gm_sink *sink, unsigned char *frame, long number, const struct gm_png_text *texts,
                 size_t count)
{
    struct gm_png_text *copy = copy_texts(texts, count);
    pthread_mutex_lock(&sink->lock);
    if (!copy) {
        note_failure(sink, "not enough memory for a frame's texts");
    }
    bool taken = !sink->failed;
    if (taken) {
        sink->queue[(sink->head + sink->queued) % sink->limit] =
            (struct gm_sink_job){.frame = frame, .number = number, .texts = copy, .text_count = count};
        sink->queued++;
        pthread_cond_signal(&sink->work);
    } else {
        sink->idle[sink->idle_count++] = frame;
    }
    pthread_mutex_unlock(&sink->lock);
    if (!taken) {
        free_texts(copy, count);
    }
    return taken;
}

bool gm_sink_hold(struct gm_sink *sink, const unsigned char *rgb, long count)
{
    for (long i = 0; i < count; i++) {
        unsigned char *frame = gm_sink_frame(sink);
        if (!frame) {
            return false;
        }
        memcpy(frame, rgb, sink->frame_size);
        if (!gm_sink_put(sink, frame, i, NULL, 0)) {
            return false;
        }
    }
    return true;
}

bool gm_sink_flush(struct gm_sink *sink)
{
    pthread_mutex_lock(&sink->lock);
    while (!sink->failed && sink->idle_count < sink->made) {
        pthread_cond_wait(&sink->vacant, &sink->lock);
    }
    const bool whole = !sink->failed;
    pthread_mutex_unlock(&sink->lock);
    return whole;
}

bool gm_sink_close(struct gm_sink *sink, bool keep, char *message)
{
    end_workers(sink, !keep);
    char late[GM_MESSAGE] = "";
    if (!sink->kind->close(sink->self, keep && !sink->failed, late)) {
        note_failure(sink, late);
    }
    bool whole = !sink->failed;
    if (!whole) {
        gm_refuse(message, "%s", sink->message);
    }
    release(sink);
    return whole;
}

/* ---- PNG files ---- */

/* The pattern is parsed and not given to printf, because the user may have put a % into the folder's name. */
struct png_sink {
    char *pattern;
    size_t before, after; /* start and end of the conversion in the pattern; both 0 without one */
    bool zeros;
    int digits;
    int width, height;
    double dpi;
    struct gm_png_text *texts;
    size_t text_count;
};

/* Finds the last %d, %6d, %06ld, ... of the file's name. */
static void find_conversion(struct png_sink *self)
{
    const char *slash = strrchr(self->pattern, '/');
    for (const char *at = slash ? slash : self->pattern; (at = strchr(at, '%')); at++) {
        const char *end = at + 1;
        bool zeros = *end == '0';
        int digits = 0;
        for (; *end >= '0' && *end <= '9' && digits <= MOST_DIGITS; end++) {
            digits = 10 * digits + (*end - '0');
        }
        end += *end == 'l';
        if (*end == 'd' && digits <= MOST_DIGITS) {
            self->before = (size_t)(at - self->pattern);
            self->after = (size_t)(end + 1 - self->pattern);
            self->zeros = zeros;
            self->digits = digits;
        }
    }
}

static char *format_path(const struct png_sink *self, long number)
{
    char *path = NULL;
    if (self->after == 0) {
        return strdup(self->pattern);
    }
    if (asprintf(&path, self->zeros ? "%.*s%0*ld%s" : "%.*s%*ld%s", (int)self->before, self->pattern,
                 self->digits, number, self->pattern + self->after) < 0) {
        return NULL;
    }
    return path;
}

static bool write_frame(void *argument, const struct gm_sink_job *job, char *message)
{
    const struct png_sink *self = argument;
    size_t total = self->text_count + job->text_count;
    struct gm_png_text *all = calloc(total ? total : 1, sizeof *all);
    char *path = format_path(self, job->number);
    bool written = false;
    if (all && path) {
        memcpy(all, self->texts, self->text_count * sizeof *all);
        for (size_t i = 0; i < job->text_count; i++) {
            all[self->text_count + i] = job->texts[i];
        }
        const struct gm_png image = {.width = self->width,
                                     .height = self->height,
                                     .dpi = self->dpi,
                                     .pixels = job->frame,
                                     .texts = all,
                                     .text_count = total};
        written = gm_png_write(path, &image, message);
    } else {
        gm_refuse(message, "not enough memory for a frame");
    }
    free(all);
    free(path);
    return written;
}

static bool close_png(void *argument, bool keep, char *message)
{
    struct png_sink *self = argument;
    (void)keep; /* finished files stay, the others have no name yet */
    (void)message;
    free_texts(self->texts, self->text_count);
    free(self->pattern);
    free(self);
    return true;
}

static int count_processors(void)
{
    cpu_set_t processors;
    return sched_getaffinity(0, sizeof processors, &processors) == 0 ? CPU_COUNT(&processors) : 1;
}

struct gm_sink *gm_sink_open_png(const char *pattern, const struct gm_sink_settings *settings, char *message)
{
    static const struct gm_sink_kind kind = {.write = write_frame, .close = close_png};
    struct png_sink *self = calloc(1, sizeof *self);
    if (!self) {
        gm_refuse(message, "not enough memory to write frames");
        return NULL;
    }
    *self = (struct png_sink){
        .pattern = strdup(pattern),
        .width = settings->width,
        .height = settings->height,
        .dpi = settings->dpi,
        .texts = copy_texts(settings->texts, settings->text_count),
        .text_count = settings->text_count,
    };
    if (!self->pattern || !self->texts) {
        close_png(self, false, message);
        gm_refuse(message, "not enough memory to write frames");
        return NULL;
    }
    find_conversion(self);
    int workers = settings->threads > 0 ? settings->threads : count_processors();
    if (self->after == 0) {
        workers = 1; /* of several frames with one name the last must win */
    }
    return gm_sink_start(&kind, self, workers < MOST_WORKERS ? workers : MOST_WORKERS,
                         (size_t)settings->width * (size_t)settings->height * 3, message);
}
