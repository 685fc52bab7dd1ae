/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checkpoints of runs and of renders. */
#include "app/output/frames.h"

#include <errno.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "core/arena.h"
#include "render/files/deflate.h"
#include "render/files/regular_file.h"
#include "render/files/temporary.h"
#include "render/message.h"
#include "scenes/common/lane_pack.h"

/* The file: this head, the identity, and the records of the lanes in order, each after its size in bytes,
   0 for a lane that has not begun. A record is struct gm_paused, then the packed lane. Its numbers have
   this machine's format, the lanes' bytes this program's. */
struct head {
    char magic[16];
    uint64_t identity_size, body_size;
    int64_t position;  /* the frame of a render */
    uint32_t checksum; /* over the identity, the body and this head with checksum 0 */
    uint32_t lanes;
};

static const char magic[16] = "geomint state 2";

struct record {
    unsigned char *bytes; /* NULL: the lane has not begun */
    uint64_t size;
    unsigned char *block; /* the memory of a noted record; NULL: it is the file's, or there is no record */
};

struct gm_pause {
    struct gm_arena *arena; /* has it all */
    const struct gm_request *request;
    const char *from, *identity;
    int64_t position;
    size_t numbers, count;
    struct record *records; /* one per lane */
};

static struct gm_pause *open_lanes(const char *identity, size_t count, size_t numbers)
{
    struct gm_arena *arena = gm_arena_open();
    struct gm_pause *pause = arena ? gm_arena_take(arena, 1, sizeof *pause) : NULL;
    char *copy = pause ? gm_arena_print(arena, "%s", identity) : NULL;
    struct record *records = copy ? gm_arena_take(arena, count, sizeof *records) : NULL;
    if (!records) {
        gm_arena_close(arena);
        return NULL;
    }
    *pause = (struct gm_pause){
        .arena = arena, .identity = copy, .numbers = numbers, .count = count, .records = records};
    return pause;
}

void gm_pause_close(struct gm_pause *pause)
{
    gm_arena_close(pause ? pause->arena : NULL);
}

/* ---- a record ---- */

/* Before the packed lane there are the fields of struct gm_paused in their order, and the caller's numbers. */
enum { FIELDS = offsetof(struct gm_paused, numbers) };

static size_t head_size(const struct gm_pause *pause)
{
    return FIELDS + pause->numbers * sizeof(double);
}

/* One function writes and reads. */
static unsigned char *pass(unsigned char *at, void *data, size_t size, bool write)
{
    memcpy(write ? at : data, write ? data : at, size);
    return at + size;
}

static void pass_head(const struct gm_pause *pause, unsigned char *at, struct gm_paused *paused, bool write)
{
    at = pass(at, paused, FIELDS, write);
    if (pause->numbers > 0) {
        pass(at, paused->numbers, pause->numbers * sizeof(double), write);
    }
}

bool gm_pause_note(struct gm_pause *pause, size_t index, const struct gm_lane *lane,
                   const struct gm_paused *paused)
{
    struct record *record = &pause->records[index];
    const size_t head = head_size(pause), size = head + gm_lane_pack_size(lane);
    unsigned char *block = gm_arena_resize(pause->arena, record->block, size, 1);
    if (!block) {
        return false;
    }
    *record = (struct record){block, size, block};
    struct gm_paused copy = *paused;
    pass_head(pause, block, &copy, true);
    gm_lane_pack(lane, block + head);
    return true;
}

/* Puts a lane at its start into the state of its record, which must be possible for this lane at the time
   t. If it returns false the lane cannot be used any more. */
static bool unpack(const struct gm_pause *pause, size_t index, struct gm_lane *lane, double t,
                   struct gm_paused *paused)
{
    const struct record *record = &pause->records[index];
    const struct gm_run *run = lane->run;
    const double t0 = run->t0, dt = run->dt;
    const size_t head = head_size(pause), whole = record->size - head;
    size_t size = whole;
    pass_head(pause, record->bytes, paused, false);
    if (!gm_lane_unpack(lane, record->bytes + head, &size) || size != whole || run->dt != dt) {
        return false;
    }
    /* an event that ended the run began a segment there */
    const bool ended = run->stopped || run->status != GM_OK;
    return (ended || (run->t0 == t0 && run->n == run->steps)) && run->steps <= gm_run_steps_by(run, t);
}

/* ---- the file ---- */

struct writing {
    const struct gm_pause *pause;
    struct head head;
};

static bool write_file(FILE *file, const void *context)
{
    const struct writing *writing = context;
    const struct gm_pause *pause = writing->pause;
    fwrite(&writing->head, sizeof writing->head, 1, file);
    fputs(pause->identity, file);
    for (size_t i = 0; i < pause->count; i++) {
        const struct record *record = &pause->records[i];
        fwrite(&record->size, sizeof record->size, 1, file);
        if (record->size > 0) {
            fwrite(record->bytes, 1, record->size, file);
        }
    }
    return !ferror(file);
}

bool gm_pause_write(const struct gm_pause *pause, const char *path, char *message)
{
    struct writing writing = {pause,
                              {.identity_size = strlen(pause->identity),
                               .position = pause->position,
                               .lanes = (uint32_t)pause->count}};
    struct head *head = &writing.head;
    memcpy(head->magic, magic, sizeof magic);
    uint32_t checksum = gm_deflate()->libdeflate_crc32(0, pause->identity, head->identity_size);
    for (size_t i = 0; i < pause->count; i++) {
        const struct record *record = &pause->records[i];
        checksum = gm_deflate()->libdeflate_crc32(checksum, &record->size, sizeof record->size);
        if (record->size > 0) { /* NULL would restart the checksum */
            checksum = gm_deflate()->libdeflate_crc32(checksum, record->bytes, record->size);
        }
        head->body_size += sizeof record->size + record->size;
    }
    head->checksum = gm_deflate()->libdeflate_crc32(checksum, head, sizeof *head);
    return gm_temporary_make(path, write_file, &writing) ||
           gm_temporary_refuse(message, path, strerror(errno));
}

/* Splits the body into records; returns false if it does not consist of them. */
static bool take_apart(struct gm_pause *pause, unsigned char *at, size_t left)
{
    for (size_t i = 0; i < pause->count; i++) {
        struct record *record = &pause->records[i];
        if (left < sizeof record->size) {
            return false;
        }
        at = pass(at, &record->size, sizeof record->size, false);
        left -= sizeof record->size;
        if (record->size > left || (record->size > 0 && record->size < head_size(pause))) {
            return false;
        }
        record->bytes = record->size > 0 ? at : NULL;
        at += record->size;
        left -= record->size;
    }
    return left == 0;
}

/* The reason why the file does not fit, or NULL, if its records were read. */
static const char *read_file(FILE *file, size_t size, struct gm_pause *pause)
{
    struct head head;
    if (fread(&head, sizeof head, 1, file) != 1 || memcmp(head.magic, magic, sizeof magic) != 0) {
        return "is not a checkpoint";
    }
    size -= sizeof head;
    if (head.identity_size > size || size - head.identity_size != head.body_size) {
        return "is damaged";
    }
    unsigned char *bytes = gm_arena_take(pause->arena, size + 1, 1);
    if (!bytes) {
        return "does not fit into memory";
    }
    const bool whole = fread(bytes, 1, size, file) == size;
    const uint32_t checksum = head.checksum;
    head.checksum = 0;
    if (!whole || gm_deflate()->libdeflate_crc32(gm_deflate()->libdeflate_crc32(0, bytes, size), &head,
                                                 sizeof head) != checksum) {
        return "is damaged";
    }
    if (head.identity_size != strlen(pause->identity) ||
        memcmp(bytes, pause->identity, head.identity_size) != 0) {
        return "is a checkpoint of something else, or of another build of geomint";
    }
    pause->position = head.position;
    return head.lanes == pause->count && take_apart(pause, bytes + head.identity_size, head.body_size)
               ? NULL
               : "is not a checkpoint of these lanes";
}

static bool read_lanes(struct gm_pause *pause, const char *path, char *message)
{
    size_t size = 0;
    char reason[GM_REGULAR_REASON];
    gm_temporary_sweep(path);
    FILE *file = gm_regular_open(path, SIZE_MAX, &size, reason);
    if (!file) {
        return gm_refuse(message, "%.300s could not be read: %s", path, reason);
    }
    const char *fault = read_file(file, size, pause);
    fclose(file);
    return !fault || gm_refuse(message, "%.360s %s", path, fault);
}

/* ---- runs ---- */

bool gm_checkpoint_fits(const struct gm_request *request)
{
    for (size_t i = 0; i < request->count; i++) {
        if (request->lanes[i].scheme->family->not_resumable) {
            return false;
        }
    }
    return request->change_count == 0;
}

static char *identify(const struct gm_request *request, size_t numbers)
{
    struct gm_text_stream writing;
    unsigned program = 0;
    const struct gm_scene *scene = request->scene;
    FILE *stream = gm_program_checksum(&program) ? gm_stream_begin(&writing) : NULL;
    if (!stream) {
        return NULL;
    }
    fprintf(stream, "run %s, %zu numbers, program %08x\n", scene->mark ? scene->mark : scene->name, numbers,
            program);
    gm_provenance_put_lanes(stream, request, true);
    return gm_stream_end(&writing);
}

struct gm_pause *gm_pause_open(const struct gm_request *request, size_t numbers, const char *from,
                               char *message)
{
    char *identity = identify(request, numbers);
    struct gm_pause *pause = identity ? open_lanes(identity, request->count, numbers) : NULL;
    free(identity);
    if (!pause) {
        gm_refuse(message, "not enough memory");
        return NULL;
    }
    pause->request = request;
    pause->from = from;
    if (from && !read_lanes(pause, from, message)) {
        gm_pause_close(pause);
        return NULL;
    }
    return pause;
}

bool gm_pause_restore(struct gm_pause *pause, size_t index, struct gm_lane *lane, struct gm_paused *paused,
                      char *message)
{
    if (!pause->records[index].bytes) {
        return true;
    }
    if (!unpack(pause, index, lane, lane->t0 + 1e300 * lane->run->dt, paused)) { /* at any time */
        return gm_refuse(message, "%.360s is not a checkpoint of these lanes", pause->from);
    }
    if (lane->run->steps > pause->request->lanes[index].steps) {
        return gm_refuse(message, "%.300s has come to t = %.10g already, which is beyond the end asked for",
                         pause->from, lane->run->t);
    }
    return true;
}

bool gm_pause_has_rows(const struct gm_pause *pause)
{
    bool any = false;
    for (size_t i = 0; pause && i < pause->count; i++) {
        uint64_t rows = 0;
        if (pause->records[i].bytes) {
            memcpy(&rows, pause->records[i].bytes + offsetof(struct gm_paused, rows), sizeof rows);
        }
        any |= rows > 0;
    }
    return any;
}

/* ---- renders ---- */

bool gm_checkpoint_write(const char *path, const struct gm_frames *frames, long frame,
                         const struct gm_lane *const *lanes, size_t count, char *message)
{
    const struct gm_paused nothing = {0};
    struct gm_pause *pause = open_lanes(frames->identity, count, 0);
    bool noted = pause != NULL;
    if (pause) {
        pause->position = frame;
    }
    for (size_t i = 0; i < count && noted; i++) {
        noted = gm_pause_note(pause, i, lanes[i], &nothing);
    }
    const bool written = noted ? gm_pause_write(pause, path, message)
                               : gm_temporary_refuse(message, path, "not enough memory");
    gm_pause_close(pause);
    return written;
}

bool gm_checkpoint_read(const char *path, const struct gm_frames *frames, long *frame,
                        struct gm_lane *const *lanes, size_t count, bool *spoilt)
{
    char message[GM_MESSAGE];
    struct gm_paused nothing = {0};
    struct gm_pause *pause = open_lanes(frames->identity, count, 0);
    const bool there = pause && read_lanes(pause, path, message) && pause->position >= 0 &&
                       pause->position < frames->schedule->count;
    *spoilt = false;
    *frame = there ? (long)pause->position : -1;
    for (size_t i = 0; i < count && there && !*spoilt; i++) {
        *spoilt = !pause->records[i].bytes ||
                  !unpack(pause, i, lanes[i], gm_schedule_time(frames->schedule, *frame), &nothing);
    }
    gm_pause_close(pause);
    return there && !*spoilt;
}
