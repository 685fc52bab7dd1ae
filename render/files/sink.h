/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_SINK_H
#define GM_RENDER_FILES_SINK_H

#include <stdatomic.h>

#include "render/files/images.h"
#include "render/message.h"

/* The destinations of frames: numbered PNG files, one PNG file, or a movie. Worker threads encode frames from
   a bounded queue: gm_sink_frame waits while all frames are in use, so memory does not grow with their
   number. Messages have room for GM_MESSAGE bytes. */

struct gm_sink;

struct gm_sink_settings {
    int width, height;
    double dpi;                      /* pixels per inch of a PNG; 0: none */
    double fps;                      /* frames per second of a movie; its last frame stays for a second */
    int threads;                     /* encoders; 0: one per processor */
    const struct gm_png_text *texts; /* texts of every PNG; copied */
    size_t text_count;
    /* number of the user's interrupts, for a movie; NULL: none. After the first an idle ffmpeg is given up,
       after the second any. */
    const atomic_int *interruptions;
};

/* Opens PNG files; `pattern` holds one %d-like conversion ("frames/disc-%06ld.png"), or none for a single
   file. */
struct gm_sink *gm_sink_open_png(const char *pattern, const struct gm_sink_settings *settings, char *message);
/* Opens .mp4, .webm or .gif through ffmpeg's standard input. ffmpeg's messages go to path + ".log", which is
   removed on success. The movie gets its name when it is complete. */
struct gm_sink *gm_sink_open_movie(const char *path, const struct gm_sink_settings *settings, char *message);
/* Returns true if a path has the ending of a movie. */
bool gm_sink_is_movie(const char *path);
/* Milliseconds that ffmpeg may take no data, or take to finish, before it is given up. Tests shorten it. */
extern int gm_sink_movie_patience;

/* Returns an empty frame of width * height * 3 bytes to paint into; waits for one. NULL after a failure. */
unsigned char *gm_sink_frame(struct gm_sink *sink);
/* Passes the frame on, also on failure; `number` is its place in the sequence of PNGs (a movie has the order
   of the calls). This frame's texts, such as its time, are copied. Returns false after a failure. */
bool gm_sink_put(struct gm_sink *sink, unsigned char *frame, long number, const struct gm_png_text *texts,
                 size_t count);
/* Copies a picture to `count` frames of a movie. Returns false after a failure. */
bool gm_sink_hold(struct gm_sink *sink, const unsigned char *rgb, long count);
/* Waits until every frame that was put is written; the caller must hold none. Returns false after a
   failure. */
bool gm_sink_flush(struct gm_sink *sink);
/* Finishes the frames that were put (keep) or gives the movie up (not keep; finished PNGs stay). Returns
   false with the sentence of the first failure. */
bool gm_sink_close(struct gm_sink *sink, bool keep, char *message);

/* A frame that was put, and its texts. */
struct gm_sink_job {
    unsigned char *frame;
    long number;
    struct gm_png_text *texts;
    size_t text_count;
};

/* A kind of sink defines what becomes of a frame; the queue is the same for all. */
struct gm_sink_kind {
    /* Called in a worker thread, with one worker in the order in which frames were put. */
    bool (*write)(void *self, const struct gm_sink_job *job, char *message);
    /* Called once, with no worker left; frees self. `keep` is false if the sink is given up or has failed. */
    bool (*close)(void *self, bool keep, char *message);
};

/* Takes self over, also on failure: then NULL with a sentence. There are at most 64 workers. */
struct gm_sink *gm_sink_start(const struct gm_sink_kind *kind, void *self, int workers, size_t frame_size,
                              char *message);

#endif
