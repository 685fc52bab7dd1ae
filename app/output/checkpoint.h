/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_CHECKPOINT_H
#define GM_APP_OUTPUT_CHECKPOINT_H

#include <stdint.h>

#include "app/output/frames.h"

/* Checkpoints: how far lanes have come, in a file that a killed or ended program continues from. */

/* Whether these lanes can be continued from a checkpoint, bit for bit. */
bool gm_checkpoint_fits(const struct gm_request *request);

/* ---- of a command that runs lanes one after the other ---- */

/* What is kept of a lane beside its state. */
struct gm_paused {
    double seconds;    /* processor time of its steps */
    uint64_t rows;     /* of its states that were saved, an end out of turn not among them */
    uint64_t saved;    /* the number of what they were saved to, as the caller counts such; 0: nothing */
    int64_t last_row;  /* the step of the last row; -1: there is none */
    double spacing[2]; /* of these rows: steps, model time; 0 or NAN: not by these */
    double *numbers;   /* of the caller, as many as gm_pause_open was told */
};

struct gm_pause;

/* Begins with nothing or, where `from` is not NULL, with what that file holds, which has to be of these
   lanes: the same but for until and steps. NULL with a sentence (GM_MESSAGE bytes). */
struct gm_pause *gm_pause_open(const struct gm_request *request, size_t numbers, const char *from,
                               char *message);
void gm_pause_close(struct gm_pause *pause);

/* Puts lane `index`, just opened, where it was; a lane that had not begun stays as it is. False with a
   sentence: it cannot be, or was further than it is to come now. */
bool gm_pause_restore(struct gm_pause *pause, size_t index, struct gm_lane *lane, struct gm_paused *paused,
                      char *message);

/* Whether states of a lane were saved before; of NULL: no. */
bool gm_pause_has_rows(const struct gm_pause *pause);

/* Takes note of the lane's present state. False when memory is short. */
bool gm_pause_note(struct gm_pause *pause, size_t index, const struct gm_lane *lane,
                   const struct gm_paused *paused);

/* Replaces the file by all that was noted, at once, or leaves it as it was. False with a sentence. */
bool gm_pause_write(const struct gm_pause *pause, const char *path, char *message);

/* ---- of a render behind one of its frames, in the frames' folder while the render goes on ---- */

/* FOLDER/NAME.checkpoint, or NAME-I-of-N.checkpoint of a shard; malloc'ed, NULL when memory is short. */
char *gm_checkpoint_path(const struct gm_frames *frames);

/* Replaces the file as gm_pause_write does. */
bool gm_checkpoint_write(const char *path, const struct gm_frames *frames, long frame,
                         const struct gm_lane *const *lanes, size_t count, char *message);

/* Puts lanes just opened into the state of the file and sets *frame; false if there is no file, or it is
   damaged or of another render or program. With *spoilt the lanes have to be opened anew. */
bool gm_checkpoint_read(const char *path, const struct gm_frames *frames, long *frame,
                        struct gm_lane *const *lanes, size_t count, bool *spoilt);

#endif
