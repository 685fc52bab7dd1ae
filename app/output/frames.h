/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_FRAMES_H
#define GM_APP_OUTPUT_FRAMES_H

#include <stdint.h>

#include "app/output/provenance.h"
#include "app/words/request.h"

/* The options of a render's frames. */
struct gm_pace {
    const char *movie;  /* its file; NULL: not given */
    long frames;        /* number of frames; 0: not given */
    int64_t every;      /* steps per frame; 0: not given */
    double fps, rate;   /* frames and model time per second of the movie; NAN: not given */
    double from, at;    /* model time of the first frame, or of the only one; NAN: not given */
    long shard, shards; /* 0, 0: not given */
};

/* The frames of a render in model time, and those of one shard. */
struct gm_schedule {
    long count;
    double first, last; /* model times, evenly divided */
    bool still;         /* one picture, not a sequence */
    long shard, shards; /* blocks of frames alternate between the shards; 1 of 1: all are ours */
    long ours;          /* number of our frames */
};

/* Returns false with a sentence (GM_MESSAGE bytes) if the options contradict each other or the request. */
bool gm_schedule_make(struct gm_schedule *schedule, const struct gm_request *request,
                      const struct gm_pace *pace, char *message);

double gm_schedule_time(const struct gm_schedule *schedule, long frame);

bool gm_schedule_is_ours(const struct gm_schedule *schedule, long frame);

/* The numbered pictures of a render, FOLDER/NAME-%06ld.png. Their metadata names the frame, the render and
   the build of the program; a complete picture with the expected metadata is kept. */
struct gm_frames {
    struct gm_arena *arena; /* owns the texts */
    const struct gm_schedule *schedule;
    const char *folder, *name;
    const char *identity; /* the lanes, the size, the frames' times and the program */
    bool *there;          /* per frame: complete, and of this identity */
    long found;           /* number of our existing frames */
};

/* Makes the folder if it is missing and looks for frames, in a body of the arena, which it may leave with a
   sentence. */
void gm_frames_open(struct gm_frames *frames, struct gm_arena *arena, const struct gm_schedule *schedule,
                    const char *folder, const char *name, const struct gm_provenance *provenance);

/* The metadata of frame `frame` under GM_KEY_FRAME, and its path, in the arena. */
const char *gm_frames_text(const struct gm_frames *frames, long frame);
const char *gm_frames_path(const struct gm_frames *frames, long frame);

/* Checkpoints: the states of lanes in a file, from which a killed or ended run is resumed. */

/* Returns true if these lanes can be resumed from a checkpoint, bit for bit. */
bool gm_checkpoint_fits(const struct gm_request *request);

/* ---- checkpoints of a command that runs lanes one after the other ---- */

/* The data of a lane that a checkpoint stores with its state. */
struct gm_paused {
    double seconds;    /* CPU time of the lane's steps */
    uint64_t rows;     /* number of saved states, without an additional last one */
    uint64_t saved;    /* the identity of the saved file, given by the caller; 0: none */
    int64_t last_row;  /* the step of the last row; -1: no rows */
    double spacing[2]; /* steps and model time between these rows; 0 or NAN: undefined */
    double *numbers;   /* the caller's numbers; gm_pause_open was given their number */
};

struct gm_pause;

/* Begins empty or, unless `from` is NULL, with the contents of that file, which must belong to these
   lanes; only until and steps may differ. Returns NULL with a sentence (GM_MESSAGE bytes). */
struct gm_pause *gm_pause_open(const struct gm_request *request, size_t numbers, const char *from,
                               char *message);
void gm_pause_close(struct gm_pause *pause);

/* Restores lane `index`, just opened; a lane that had not begun stays as it is. Returns false with a
   sentence if that is impossible, or if the lane was beyond its new end. */
bool gm_pause_restore(struct gm_pause *pause, size_t index, struct gm_lane *lane, struct gm_paused *paused,
                      char *message);

/* Returns true if states of a lane were saved before; false for NULL. */
bool gm_pause_has_rows(const struct gm_pause *pause);

/* Notes the lane's current state. Returns false when out of memory. */
bool gm_pause_note(struct gm_pause *pause, size_t index, const struct gm_lane *lane,
                   const struct gm_paused *paused);

/* Replaces the file by all noted states, at once, or leaves it as it was. Returns false with a sentence. */
bool gm_pause_write(const struct gm_pause *pause, const char *path, char *message);

/* ---- the checkpoint of a render after one of its frames, in the frames' folder during the render ---- */

/* Replaces the file as gm_pause_write does. */
bool gm_checkpoint_write(const char *path, const struct gm_frames *frames, long frame,
                         const struct gm_lane *const *lanes, size_t count, char *message);

/* Puts lanes just opened into the state of the file and sets *frame. Returns false if there is no file, if
   it is damaged or another render's or program's, or when out of memory (core/memory.h). With *spoilt the
   lanes must be opened again. */
bool gm_checkpoint_read(const char *path, const struct gm_frames *frames, long *frame,
                        struct gm_lane *const *lanes, size_t count, bool *spoilt);

#endif
