/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checkpoints of a render, from which a killed one goes on. */
#include "app/output/checkpoint.h"

#include <errno.h>
#include <libdeflate.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/request/drive.h"
#include "render/files/regular_file.h"
#include "render/files/temporary.h"
#include "scenes/frame/lane_pack.h"

/* The file: this head, the frames' identity, the packed lanes one after the other. Its numbers are this
   machine's, as the lanes' bytes are this program's. */
struct head {
    char magic[16];
    uint64_t identity_size, body_size;
    int64_t frame;
    uint32_t checksum; /* of the identity and the body */
    uint32_t lanes;
};

static const char magic[16] = "geomint state 1";

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

static bool write_file(const char *path, const struct head *head, const char *identity,
                       const unsigned char *body)
{
    FILE *file = fopen(path, "wbxe");
    if (!file) {
        return false;
    }
    bool good = fwrite(head, sizeof *head, 1, file) == 1 &&
                fwrite(identity, 1, head->identity_size, file) == head->identity_size &&
                fwrite(body, 1, head->body_size, file) == head->body_size && fflush(file) == 0 &&
                fsync(fileno(file)) == 0;
    good = fclose(file) == 0 && good;
    return good;
}

bool gm_checkpoint_write(const char *path, const struct gm_frames *frames, long frame,
                         const struct gm_lane *const *lanes, size_t count, char *message)
{
    struct head head = {.identity_size = strlen(frames->identity), .frame = frame, .lanes = (uint32_t)count};
    memcpy(head.magic, magic, sizeof magic);
    size_t size = 0;
    unsigned char *body = pack(lanes, count, &size);
    char *temporary = gm_temporary_name(path, ".tmp");
    bool good = body && temporary;
    if (good) {
        head.body_size = size;
        head.checksum =
            libdeflate_crc32(libdeflate_crc32(0, frames->identity, head.identity_size), body, size);
        good = write_file(temporary, &head, frames->identity, body) && rename(temporary, path) == 0;
    }
    if (!good) {
        snprintf(message, GM_MESSAGE, "cannot write %.360s: %s", path, strerror(errno));
        if (temporary) {
            unlink(temporary);
        }
    }
    free(temporary);
    free(body);
    return good;
}

/* What follows the head; malloc'ed, NULL if the file is not the one that is meant. */
static unsigned char *read_body(FILE *file, size_t size, const struct gm_frames *frames, size_t count,
                                struct head *head)
{
    const size_t identity_size = strlen(frames->identity);
    if (fread(head, sizeof *head, 1, file) != 1 || memcmp(head->magic, magic, sizeof magic) != 0 ||
        head->identity_size != identity_size || head->lanes != count || head->frame < 0 ||
        head->frame >= frames->schedule->count || size - sizeof *head < identity_size ||
        size - sizeof *head - identity_size != head->body_size) {
        return NULL;
    }
    unsigned char *bytes = malloc(identity_size + head->body_size);
    if (!bytes || fread(bytes, 1, identity_size + head->body_size, file) != identity_size + head->body_size ||
        memcmp(bytes, frames->identity, identity_size) != 0 ||
        libdeflate_crc32(0, bytes, identity_size + head->body_size) != head->checksum) {
        free(bytes);
        return NULL;
    }
    return bytes;
}

/* Puts a lane just opened into a packed state, which must be one that this lane can have at the time t. */
static bool unpack(struct gm_lane *lane, double t, const unsigned char *bytes, size_t *size)
{
    const struct gm_run *run = lane->run;
    const double t0 = run->t0, dt = run->dt;
    const long most = lane->scheme->family->own_time ? GM_MOST_STEPS
                                                     : gm_drive_step_at(&(struct gm_drive){.lane = lane}, t);
    return gm_lane_unpack(lane, bytes, size) && run->t0 == t0 && run->dt == dt && run->n == run->steps &&
           run->steps <= most;
}

bool gm_checkpoint_read(const char *path, const struct gm_frames *frames, long *frame,
                        struct gm_lane *const *lanes, size_t count, bool *spoilt)
{
    *spoilt = false;
    gm_temporary_sweep(path);
    size_t size = 0;
    char reason[GM_REGULAR_REASON];
    FILE *file = gm_regular_open(path, SIZE_MAX, &size, reason);
    if (!file) {
        return false;
    }
    struct head head;
    unsigned char *bytes = read_body(file, size, frames, count, &head);
    fclose(file);
    if (!bytes) {
        return false;
    }
    const unsigned char *at = bytes + head.identity_size, *end = at + head.body_size;
    bool good = true;
    for (size_t i = 0; good && i < count; i++) {
        size_t taken = (size_t)(end - at);
        good = unpack(lanes[i], gm_schedule_time(frames->schedule, head.frame), at, &taken);
        at += taken;
    }
    good = good && at == end;
    free(bytes);
    *spoilt = !good;
    *frame = head.frame;
    return good;
}
