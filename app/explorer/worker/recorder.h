/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_RECORDER_H
#define GM_APP_EXPLORER_WORKER_RECORDER_H

#include "app/base/interrupt.h"
#include "render/layout/theme.h"

/* A movie of what is seen: a thread that paints pictures and hands them to ffmpeg, so that steps
   do not wait for it. The movie goes with the clock on the wall: a picture is held for as long as it was
   seen, but where nothing changes for no longer than a second. */

struct gm_recorder;

/* Begins the movie `path` (.mp4). NULL with a sentence (GM_MESSAGE bytes). */
struct gm_recorder *gm_recorder_open(const char *path, enum gm_theme theme, char *message);
/* Finishes the movie, which may take a second; gm_interrupted gives it up as a sink does. False with a
   sentence if it could not be made. */
bool gm_recorder_close(struct gm_recorder *recorder, char *message);

const char *gm_recorder_path(const struct gm_recorder *recorder);
/* Seconds of the movie so far. */
double gm_recorder_length(const struct gm_recorder *recorder);

/* The picture to draw the next frame into, or NULL while it is too early for one or the last is being
   painted. `now` is the time on the wall in seconds. */
struct gm_picture *gm_recorder_due(struct gm_recorder *recorder, double now);
/* The picture that was due is drawn. */
void gm_recorder_put(struct gm_recorder *recorder);

#endif
