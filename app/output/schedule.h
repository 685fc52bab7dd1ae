/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_SCHEDULE_H
#define GM_APP_OUTPUT_SCHEDULE_H

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

#endif
