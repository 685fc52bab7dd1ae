/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checkpoints of a render, from which a killed one goes on. */
#include "app/output/checkpoint.h"

#include <stdio.h>
#include <stdlib.h>

#include "app/output/snapshot.h"
#include "render/files/temporary.h"
#include "render/message.h"
#include "scenes/common/lane_pack.h"

char *gm_checkpoint_path(const struct gm_frames *frames)
{
    const struct gm_schedule *schedule = frames->schedule;
    char *path = NULL;
    const int length = schedule->shards > 1
                           ? asprintf(&path, "%s/%s-%ld-of-%ld.checkpoint", frames->folder, frames->name,
                                      schedule->shard, schedule->shards)
                           : asprintf(&path, "%s/%s.checkpoint", frames->folder, frames->name);
    return length < 0 ? NULL : path;
}

bool gm_checkpoint_fits(const struct gm_request *request)
{
    for (size_t i = 0; i < request->count; i++) {
        if (request->lanes[i].scheme->family->not_resumable) {
            return false;
        }
    }
    return request->change_count == 0;
}

/* The packed lanes; malloc'ed. */
static unsigned char *pack(const struct gm_lane *const *lanes, size_t count, size_t *size)
{
    *size = 0;
    for (size_t i = 0; i < count; i++) {
        *size += gm_lane_pack_size(lanes[i]);
    }
    unsigned char *body = malloc(*size);
    size_t at = 0;
    for (size_t i = 0; body && i < count; i++) {
        gm_lane_pack(lanes[i], body + at);
        at += gm_lane_pack_size(lanes[i]);
    }
    return body;
}

bool gm_checkpoint_write(const char *path, const struct gm_frames *frames, long frame,
                         const struct gm_lane *const *lanes, size_t count, char *message)
{
    struct gm_snapshot snapshot = {.identity = frames->identity, .position = frame, .lanes = (uint32_t)count};
    snapshot.body = pack(lanes, count, &snapshot.size);
    if (!snapshot.body) {
        return gm_temporary_refuse(message, path, "not enough memory");
    }
    const bool good = gm_snapshot_write(path, &snapshot, message);
    free(snapshot.body);
    return good;
}

bool gm_checkpoint_read(const char *path, const struct gm_frames *frames, long *frame,
                        struct gm_lane *const *lanes, size_t count, bool *spoilt)
{
    struct gm_snapshot snapshot = {.identity = frames->identity};
    char message[GM_MESSAGE];
    *spoilt = false;
    if (!gm_snapshot_read(path, &snapshot, message)) {
        return false;
    }
    bool good =
        snapshot.lanes == count && snapshot.position >= 0 && snapshot.position < frames->schedule->count;
    *frame = (long)snapshot.position;
    if (good) {
        const unsigned char *at = snapshot.body, *end = at + snapshot.size;
        for (size_t i = 0; good && i < count; i++) {
            size_t taken = (size_t)(end - at);
            good = gm_snapshot_unpack(lanes[i], gm_schedule_time(frames->schedule, *frame), at, &taken);
            at += taken;
        }
        good = good && at == end;
        *spoilt = !good;
    }
    free(snapshot.body);
    return good;
}
