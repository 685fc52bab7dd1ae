/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_SINK_KIND_H
#define GM_RENDER_FILES_SINK_KIND_H

#include "render/files/sink.h"
#include "render/message.h"

/* What the kinds of sink share with sink.c, and with nobody else: the queue is sink.c's, a kind says what
   becomes of a frame. */

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

/* How long ffmpeg may take no data, or take to finish, before it is given up, in milliseconds. Tests shorten
   it. */
extern int gm_sink_movie_patience;

#endif
