/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbered pictures of a render: when they are, which there are already, and whose. */
#include "app/output/frames.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/output/folder.h"
#include "core/arena.h"
#include "core/basics.h"
#include "render/files/deflate.h"
#include "render/files/temporary.h"

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
    double end = -INFINITY;
    for (size_t i = 0; i < request->count; i++) {
        end = fmax(end, request->lanes[i].end);
    }
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
        return gm_refuse(message, "frames of an adaptive scheme need until= instead of steps=");
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
        /* ten seconds by default */
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

static const char *identify(struct gm_arena *arena, const struct gm_schedule *schedule,
                            const struct gm_provenance *provenance)
{
    unsigned checksum = 0, program = 0;
    if (!gm_program_checksum(&program)) {
        gm_arena_refuse(arena, "the program itself could not be read: %s", strerror(errno));
    }
    for (size_t i = 0; i < provenance->count; i++) {
        const char *text = provenance->texts[i].text;
        checksum = gm_deflate()->libdeflate_crc32(checksum, text, strlen(text) + 1);
    }
    return gm_arena_print(arena, "%ld from t = %.17g to %.17g, render %08x, program %08x", schedule->count,
                          schedule->first, schedule->last, checksum, program);
}

const char *gm_frames_text(const struct gm_frames *frames, long frame)
{
    return gm_arena_print(frames->arena, "%ld of %s", frame + 1, frames->identity);
}

const char *gm_frames_path(const struct gm_frames *frames, long frame)
{
    return gm_arena_print(frames->arena, "%s/%s-%06ld.png", frames->folder, frames->name, frame);
}

/* Checks one file of the folder: a frame, or a killed run's incomplete one. */
static void look_at(struct gm_frames *frames, int folder, const char *file)
{
    const size_t length = strlen(frames->name);
    const bool hidden = file[0] == '.';
    long frame = 0;
    int used = 0;
    if (strncmp(file + hidden, frames->name, length) != 0 ||
        sscanf(file + hidden + length, "-%ld.png%n", &frame, &used) != 1 || used == 0 || frame < 0 ||
        frame >= frames->schedule->count) {
        return;
    }
    const bool ours = gm_schedule_is_ours(frames->schedule, frame);
    if (hidden && ours && gm_temporary_is_stale(file)) {
        unlinkat(folder, file, 0);
    }
    if (!hidden && !frames->there[frame] &&
        gm_png_tells(gm_frames_path(frames, frame), GM_KEY_FRAME, gm_frames_text(frames, frame))) {
        frames->there[frame] = true;
        frames->found += ours;
    }
}

static void close_folder(void *folder)
{
    closedir(folder);
}

void gm_frames_open(struct gm_frames *frames, struct gm_arena *arena, const struct gm_schedule *schedule,
                    const char *folder, const char *name, const struct gm_provenance *provenance)
{
    char message[GM_MESSAGE];
    *frames = (struct gm_frames){.arena = arena,
                                 .schedule = schedule,
                                 .folder = folder,
                                 .name = name,
                                 .identity = identify(arena, schedule, provenance)};
    gm_arena_check(arena, gm_folder_make(folder, message), message);
    frames->there = gm_arena_take(arena, (size_t)schedule->count, sizeof *frames->there);
    /* the folder is read instead of trying every possible frame */
    const size_t mark = gm_arena_mark(arena);
    DIR *files = opendir(folder);
    const struct dirent *entry = NULL;
    if (files) {
        gm_arena_keep(arena, files, close_folder);
    }
    while (files && (entry = readdir(files))) {
        look_at(frames, dirfd(files), entry->d_name);
    }
    gm_arena_release(arena, mark);
}
