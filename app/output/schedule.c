/* SPDX-License-Identifier: GPL-3.0-or-later */
/* When the frames of a render are, and which of them are a shard's. */
#include "app/output/schedule.h"
#include "core/basics.h"

#include <math.h>

static double end_of(const struct gm_request *request)
{
    double end = -INFINITY;
    for (size_t i = 0; i < request->count; i++) {
        end = fmax(end, request->lanes[i].end);
    }
    return end;
}

static bool take_shard(struct gm_schedule *schedule, const struct gm_pace *pace, char *message)
{
    schedule->shard = pace->shards > 0 ? pace->shard : 1;
    schedule->shards = pace->shards > 0 ? pace->shards : 1;
    if (pace->shards > 0 && pace->movie) {
        return gm_refuse(
            message,
            "--shard makes frames: leave --movie to one more run of the same command without --shard, "
            "when all shards are done");
    }
    if (pace->shards > 0 && schedule->still) {
        return gm_refuse(message, "--shard divides frames, and there is one picture; how many? --frames N");
    }
    for (long frame = 0; frame < schedule->count; frame++) {
        schedule->ours += gm_schedule_is_ours(schedule, frame);
    }
    return true;
}

bool gm_schedule_make(struct gm_schedule *schedule, const struct gm_request *request,
                      const struct gm_pace *pace, char *message)
{
    const struct gm_timing *timing = request->lanes[0].parameters;
    const double end = end_of(request);
    const double start = gm_scene_t0(request->scene, timing);
    const double first = isnan(pace->from) ? start : fmin(pace->from, end);
    const struct {
        const char *name;
        double value;
    } times[] = {{"--at", pace->at}, {"--from", pace->from}};
    for (size_t i = 0; i < GM_COUNT(times); i++) {
        if (times[i].value < start || times[i].value > fmax(end, timing->until)) {
            return gm_refuse(message, "%s %g lies %s, t = %g", times[i].name, times[i].value,
                             times[i].value < start ? "before the start" : "after the end",
                             times[i].value < start ? start : end);
        }
    }
    if (!isnan(pace->at)) {
        *schedule =
            (struct gm_schedule){.count = 1, .first = pace->at, .last = pace->at, .still = !pace->movie};
        return take_shard(schedule, pace, message);
    }
    const bool paced = pace->movie || !isnan(pace->rate) || !isnan(pace->fps);
    if (end >= GM_NEVER && (paced || pace->frames || pace->every)) {
        return gm_refuse(message, "where a scheme chooses its steps, frames need until= instead of steps=");
    }
    double count = 1;
    *schedule = (struct gm_schedule){.first = first, .last = end};
    if (pace->frames) {
        count = (double)pace->frames;
    } else if (pace->every) {
        const double interval = (double)pace->every * timing->dt;
        count = floor((end - first) / interval * (1 + 1e-12) + 1e-9) + 1;
        schedule->last = first + (count - 1) * interval;
    } else if (paced) {
        const double fps = isnan(pace->fps) ? 30 : pace->fps;
        /* ten seconds, unless told otherwise */
        const double rate = isnan(pace->rate) ? (end - first) / 10 : pace->rate;
        count = rate > 0 ? fmax(1, round((end - first) * fps / rate)) + 1 : 2;
    } else {
        schedule->still = true;
    }
    if (!(count <= 1e7)) {
        return gm_refuse(message, "that makes %.3g frames; 1e7 is the most", count);
    }
    schedule->count = (long)count;
    if (schedule->count == 1) {
        schedule->first = schedule->last;
    }
    return take_shard(schedule, pace, message);
}

double gm_schedule_time(const struct gm_schedule *schedule, long frame)
{
    if (frame + 1 >= schedule->count) {
        return schedule->last;
    }
    return schedule->first +
           (schedule->last - schedule->first) * (double)frame / (double)(schedule->count - 1);
}

bool gm_schedule_is_ours(const struct gm_schedule *schedule, long frame)
{
    /* blocks, so that a shard's last frames need not wait for a whole simulation; short enough for all shards
       to have the same to do */
    enum { LONGEST = 16, BLOCKS = 8 };
    const long fair = schedule->count / (BLOCKS * schedule->shards);
    const long block = fair < 1 ? 1 : fair < LONGEST ? fair : LONGEST;
    return frame / block % schedule->shards == schedule->shard - 1;
}

long gm_schedule_last(const struct gm_schedule *schedule)
{
    long frame = schedule->count - 1;
    while (frame >= 0 && !gm_schedule_is_ours(schedule, frame)) {
        frame--;
    }
    return frame;
}
