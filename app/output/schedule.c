/* SPDX-License-Identifier: GPL-3.0-or-later */
/* When the frames of a render are, and which of them are a shard's. */
#include "app/output/schedule.h"

#include <math.h>
#include <stdio.h>

static double end_of(const struct gm_request *request)
{
    double end = -INFINITY;
    for (size_t i = 0; i < request->count; i++) {
        const struct gm_timing *timing = request->lanes[i].parameters;
        const double t0 = gm_scene_t0(request->scene, timing);
        /* a scheme that chooses its steps ends at `until`, the others at the step that is nearest to it */
        const double steps_end = t0 + (double)request->lanes[i].steps * timing->dt;
        end = fmax(end, request->lanes[i].scheme->family->own_time ? timing->until : steps_end);
    }
    return end;
}

static bool take_shard(struct gm_schedule *schedule, const struct gm_options *options, char *message)
{
    schedule->shard = options->shards > 0 ? options->shard : 1;
    schedule->shards = options->shards > 0 ? options->shards : 1;
    if (options->shards > 0 && options->movie) {
        snprintf(message, GM_MESSAGE,
                 "--shard makes frames: leave --movie to one more run of the same command without --shard, "
                 "when all shards are done");
        return false;
    }
    if (options->shards > 0 && schedule->still) {
        snprintf(message, GM_MESSAGE,
                 "--shard divides frames, and there is one picture; how many? --frames N");
        return false;
    }
    for (long frame = 0; frame < schedule->count; frame++) {
        schedule->ours += gm_schedule_is_ours(schedule, frame);
    }
    return true;
}

bool gm_schedule_make(struct gm_schedule *schedule, const struct gm_request *request,
                      const struct gm_options *options, char *message)
{
    const struct gm_timing *timing = request->lanes[0].parameters;
    const double end = end_of(request);
    const double start = gm_scene_t0(request->scene, timing);
    const double first = isnan(options->from) ? start : fmin(options->from, end);
    const struct {
        const char *name;
        double value;
    } times[] = {{"--at", options->at}, {"--from", options->from}};
    for (size_t i = 0; i < sizeof times / sizeof times[0]; i++) {
        if (times[i].value < start || times[i].value > fmax(end, timing->until)) {
            snprintf(message, GM_MESSAGE, "%s %g lies %s, t = %g", times[i].name, times[i].value,
                     times[i].value < start ? "before the start" : "after the end",
                     times[i].value < start ? start : end);
            return false;
        }
    }
    if (!isnan(options->at)) {
        *schedule = (struct gm_schedule){
            .count = 1, .first = options->at, .last = options->at, .still = !options->movie};
        return take_shard(schedule, options, message);
    }
    const bool paced = options->movie || !isnan(options->rate) || !isnan(options->fps);
    if (end >= GM_NEVER && (paced || options->frames || options->every)) {
        snprintf(message, GM_MESSAGE,
                 "where a scheme chooses its steps, frames need until= instead of steps=");
        return false;
    }
    double count = 1;
    *schedule = (struct gm_schedule){.first = first, .last = end};
    if (options->frames) {
        count = (double)options->frames;
    } else if (options->every) {
        const double interval = (double)options->every * timing->dt;
        count = floor((end - first) / interval * (1 + 1e-12) + 1e-9) + 1;
        schedule->last = first + (count - 1) * interval;
    } else if (paced) {
        const double fps = isnan(options->fps) ? 30 : options->fps;
        /* ten seconds, unless told otherwise */
        const double rate = isnan(options->rate) ? (end - first) / 10 : options->rate;
        count = rate > 0 ? fmax(1, round((end - first) * fps / rate)) + 1 : 2;
    } else {
        schedule->still = true;
    }
    if (!(count <= 1e7)) {
        snprintf(message, GM_MESSAGE, "that makes %.3g frames; 1e7 is the most", count);
        return false;
    }
    schedule->count = (long)count;
    if (schedule->count == 1) {
        schedule->first = schedule->last;
    }
    return take_shard(schedule, options, message);
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
