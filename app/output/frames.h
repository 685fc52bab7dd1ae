/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_FRAMES_H
#define GM_APP_OUTPUT_FRAMES_H

#include "app/output/provenance.h"
#include "app/output/schedule.h"

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

#endif
