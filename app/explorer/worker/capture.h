/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_CAPTURE_H
#define GM_APP_EXPLORER_WORKER_CAPTURE_H

#include "app/explorer/worker/play.h"
#include "app/explorer/worker/recorder.h"
#include "app/runs/shot.h"

/* What is kept of a session that is played: pictures, a movie, the command lines that redo it. */

struct gm_capture {
    struct gm_recorder *recorder; /* NULL: no movie is made */
    bool unrecorded;              /* something changed since its last frame */
    char *commands[GM_COMMANDS];  /* of the view at the time they were asked for; NULL: they were not */
    unsigned long command_number; /* changes with every one */
};

/* Ends without a movie: gm_capture_stop_recording comes first. */
void gm_capture_close(struct gm_capture *capture);

/* Writes the system that is played, if it is somebody's own, to a file. */
void gm_capture_save_system(struct gm_play *play);
/* Saves the picture. */
void gm_capture_save(struct gm_play *play, enum gm_theme theme);
/* Begins the movie, or ends it. */
void gm_capture_record(struct gm_capture *capture, struct gm_play *play, enum gm_theme theme);
/* True with a sentence (GM_MESSAGE bytes) if there was a movie. */
bool gm_capture_stop_recording(struct gm_capture *capture, char *sentence);
/* Takes a frame of the movie if one is due. */
void gm_capture_take_frame(struct gm_capture *capture, const struct gm_session *session);
/* Tells the command lines of the view. */
void gm_capture_tell(struct gm_capture *capture, const struct gm_session *session, enum gm_theme theme);

#endif
