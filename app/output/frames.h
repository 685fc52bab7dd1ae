/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_FRAMES_H
#define GM_APP_OUTPUT_FRAMES_H

#include <stdint.h>

#include "app/output/provenance.h"
#include "app/words/request.h"

/* What is asked for of a render's frames. */
struct gm_pace {
    bool movie;
    long frames;        /* so many; 0: not given */
    int64_t every;      /* one every so many steps; 0: not given */
    double fps, rate;   /* frames, and model time, a second of the movie; NAN: not given */
    double from, at;    /* model time of the first, or of the only one; NAN: not given */
    long shard, shards; /* 0, 0: not given */
};

/* When the frames of a render are, in model time, and which of them are one shard's. */
struct gm_schedule {
    long count;
    double first, last; /* model times, evenly divided */
    bool still;         /* one picture, not a sequence */
    long shard, shards; /* blocks of frames go to the shards in turn; 1 of 1: all are ours */
    long ours;          /* how many frames that is */
};

/* False with a sentence (GM_MESSAGE bytes) if that contradicts itself or the request. */
bool gm_schedule_make(struct gm_schedule *schedule, const struct gm_request *request,
                      const struct gm_pace *pace, char *message);

double gm_schedule_time(const struct gm_schedule *schedule, long frame);

bool gm_schedule_is_ours(const struct gm_schedule *schedule, long frame);
/* The last of ours; -1 if none is. */
long gm_schedule_last(const struct gm_schedule *schedule);

/* The numbered pictures of a render, FOLDER/NAME-%06ld.png. Each tells which frame of
   which render it is, and of which build of the program; one that is whole and tells just that need not be
   made again. */
struct gm_frames {
    const struct gm_schedule *schedule;
    char *folder, *name;
    char *pattern;  /* for gm_sink_open_png */
    char *identity; /* of the render: its lanes, its size, the frames' times, the program */
    bool *there;    /* per frame: whole, and of this identity */
    long found;     /* how many of ours are there */
};

/* Makes the folder if it is missing and looks for frames. False with a sentence (GM_MESSAGE bytes). */
bool gm_frames_open(struct gm_frames *frames, const struct gm_schedule *schedule, const char *folder,
                    const char *name, const struct gm_provenance *provenance, char *message);
void gm_frames_close(struct gm_frames *frames);

/* What frame `frame` tells of itself under GM_KEY_FRAME, and where it lies; malloc'ed, NULL when memory is
   short. */
char *gm_frames_text(const struct gm_frames *frames, long frame);
char *gm_frames_path(const struct gm_frames *frames, long frame);

/* The first frame of ours that is missing, or the last; -1 if there is none. */
long gm_frames_missing(const struct gm_frames *frames, bool last);

/* Removes the frames, and the folder if nothing else is in it. */
void gm_frames_remove(const struct gm_frames *frames);

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
   damaged or of another render or program, or if memory was short (core/memory.h). With *spoilt the lanes have to be opened anew. */
bool gm_checkpoint_read(const char *path, const struct gm_frames *frames, long *frame,
                        struct gm_lane *const *lanes, size_t count, bool *spoilt);

#endif
