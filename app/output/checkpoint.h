/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_CHECKPOINT_H
#define GM_APP_OUTPUT_CHECKPOINT_H

#include "app/output/frames.h"

/* The state of a render's lanes behind one of its frames, in the frames' folder while the render goes on:
   what a killed render continues from. */

/* FOLDER/NAME.checkpoint, or NAME-I-of-N.checkpoint of a shard; malloc'ed, NULL when memory is short. */
char *gm_checkpoint_path(const struct gm_frames *frames);

/* Whether these lanes can be continued from a snapshot, bit for bit. */
bool gm_checkpoint_fits(const struct gm_request *request);

/* Replaces the file at once, or leaves it as it was. False with a sentence (GM_MESSAGE bytes). */
bool gm_checkpoint_write(const char *path, const struct gm_frames *frames, long frame,
                         const struct gm_lane *const *lanes, size_t count, char *message);

/* Puts lanes just opened into the state of the file and sets *frame; false if there is no file, or it is
   damaged or of another render or program. With *spoilt the lanes have to be opened anew. */
bool gm_checkpoint_read(const char *path, const struct gm_frames *frames, long *frame,
                        struct gm_lane *const *lanes, size_t count, bool *spoilt);

#endif
