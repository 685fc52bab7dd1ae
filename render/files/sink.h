/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_SINK_H
#define GM_RENDER_FILES_SINK_H

#include <signal.h>

#include "render/files/images.h"
#include "render/message.h"

/* Where frames go: numbered PNG files, one PNG file, or a movie. Frames are encoded by worker threads behind
   a bounded queue: gm_sink_frame waits while all frames are in use, so memory does not grow with their
   number. Messages have room for GM_MESSAGE bytes. */

struct gm_sink;

struct gm_sink_settings {
    int width, height;
    double dpi;                      /* pixels an inch, which a PNG tells; 0: it does not */
    double fps;                      /* of a movie; its last frame stands for one second */
    int threads;                     /* encoders; 0: as many as there are processors */
    const struct gm_png_text *texts; /* of every PNG; copied */
    size_t text_count;
    /* Of a movie: how often the user has asked to leave; NULL: never. Once: an ffmpeg that does nothing is
       not waited for any longer, one that works is. Twice: none is. */
    const volatile sig_atomic_t *interruptions;
};

/* PNG files; `pattern` holds one %d-like conversion ("frames/disc-%06ld.png"), or none for a single file. */
struct gm_sink *gm_sink_open_png(const char *pattern, const struct gm_sink_settings *settings, char *message);
/* .mp4, .webm or .gif through ffmpeg's standard input; its own messages go to path + ".log", which is
   removed if all went well. The movie gets its name when it is complete. */
struct gm_sink *gm_sink_open_movie(const char *path, const struct gm_sink_settings *settings, char *message);
/* Whether a path has one of these endings. */
bool gm_sink_is_movie(const char *path);
/* How long ffmpeg may take no data, or take to finish, before it is given up, in milliseconds. Tests shorten
   it. */
extern int gm_sink_movie_patience;

/* An empty frame of width * height * 3 bytes to paint into; waits for one. NULL after a failure. */
unsigned char *gm_sink_frame(struct gm_sink *sink);
/* Hands the frame over, also on failure; `number` is its place in the sequence of PNGs (a movie has the order
   in which frames are put). Extra texts (this frame's time) are copied. */
bool gm_sink_put(struct gm_sink *sink, unsigned char *frame, long number, const struct gm_png_text *texts,
                 size_t count);
/* Hands copies of a picture over, for so many frames of a movie. False after a failure. */
bool gm_sink_hold(struct gm_sink *sink, const unsigned char *rgb, long count);
/* Waits until every frame that was put is written; no frame may be in hand. False after a failure. */
bool gm_sink_flush(struct gm_sink *sink);
/* Finishes what was put (keep) or gives the movie up (not keep; finished PNGs stay). False if any frame
   failed, with the sentence of the first failure. */
bool gm_sink_close(struct gm_sink *sink, bool keep, char *message);

/* A kind of sink says what becomes of a frame; the queue is the same for all. */
struct gm_sink_kind {
    /* Called in a worker thread, with one worker in the order in which frames were put. */
    bool (*frame)(void *self, const unsigned char *rgb, long number, const struct gm_png_text *texts,
                  size_t count, char *message);
    /* Called once, with no worker left; frees self. `keep` is false if the sink is given up or has failed. */
    bool (*close)(void *self, bool keep, char *message);
};

/* Takes self over, also on failure. */
struct gm_sink *gm_sink_start(const struct gm_sink_kind *kind, void *self, int workers, size_t frame_size,
                              char *message);

/* Copies that belong to the caller. */
struct gm_png_text *gm_texts_copy(const struct gm_png_text *texts, size_t count);
void gm_texts_free(struct gm_png_text *texts, size_t count);

#endif
