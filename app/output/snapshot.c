/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The file of a checkpoint, and the lanes that are packed in it. */
#include "app/output/snapshot.h"

#include <errno.h>
#include <libdeflate.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/words/drive.h"
#include "render/files/regular_file.h"
#include "render/files/temporary.h"
#include "render/message.h"
#include "scenes/common/lane_pack.h"

/* The file: this head, the identity, the body. Its numbers are this machine's, as the lanes' bytes are this
   program's. */
struct head {
    char magic[16];
    uint64_t identity_size, body_size;
    int64_t position;
    uint32_t checksum; /* of the identity and the body */
    uint32_t lanes;
};

static const char magic[16] = "geomint state 1";

bool gm_program_checksum(unsigned *checksum)
{
    FILE *file = fopen("/proc/self/exe", "rbe");
    if (!file) {
        return false;
    }
    char bytes[1 << 16];
    size_t size = 0;
    *checksum = 0;
    while ((size = fread(bytes, 1, sizeof bytes, file)) > 0) {
        *checksum = libdeflate_crc32(*checksum, bytes, size);
    }
    const bool good = !ferror(file);
    fclose(file);
    return good;
}

struct writing {
    const struct head *head;
    const struct gm_snapshot *snapshot;
};

static bool write_body(FILE *file, const void *context)
{
    const struct writing *writing = context;
    const struct head *head = writing->head;
    return fwrite(head, sizeof *head, 1, file) == 1 &&
           fwrite(writing->snapshot->identity, 1, head->identity_size, file) == head->identity_size &&
           fwrite(writing->snapshot->body, 1, head->body_size, file) == head->body_size;
}

bool gm_snapshot_write(const char *path, const struct gm_snapshot *snapshot, char *message)
{
    struct head head = {.identity_size = strlen(snapshot->identity),
                        .body_size = snapshot->size,
                        .position = snapshot->position,
                        .lanes = snapshot->lanes};
    memcpy(head.magic, magic, sizeof magic);
    head.checksum = libdeflate_crc32(libdeflate_crc32(0, snapshot->identity, head.identity_size),
                                     snapshot->body, snapshot->size);
    const struct writing writing = {&head, snapshot};
    return gm_temporary_make(path, write_body, &writing) ||
           gm_temporary_refuse(message, path, strerror(errno));
}

/* Why the file is not the one that is meant; NULL: it is, and the body is read. */
static const char *read_file(FILE *file, size_t size, struct gm_snapshot *snapshot)
{
    struct head head;
    const size_t identity_size = strlen(snapshot->identity);
    if (fread(&head, sizeof head, 1, file) != 1 || memcmp(head.magic, magic, sizeof magic) != 0) {
        return "is no checkpoint";
    }
    if (head.identity_size > size - sizeof head ||
        size - sizeof head - head.identity_size != head.body_size) {
        return "is damaged";
    }
    unsigned char *bytes = malloc(head.identity_size + head.body_size + 1);
    if (!bytes) {
        return "does not fit into memory";
    }
    const char *reason = NULL;
    if (fread(bytes, 1, head.identity_size + head.body_size, file) != head.identity_size + head.body_size ||
        libdeflate_crc32(0, bytes, head.identity_size + head.body_size) != head.checksum) {
        reason = "is damaged";
    } else if (head.identity_size != identity_size || memcmp(bytes, snapshot->identity, identity_size) != 0) {
        reason = "is a checkpoint of something else, or of another build of geomint";
    }
    if (reason) {
        free(bytes);
        return reason;
    }
    memmove(bytes, bytes + identity_size, head.body_size);
    snapshot->position = head.position;
    snapshot->lanes = head.lanes;
    snapshot->body = bytes;
    snapshot->size = head.body_size;
    return NULL;
}

bool gm_snapshot_read(const char *path, struct gm_snapshot *snapshot, char *message)
{
    size_t size = 0;
    char reason[GM_REGULAR_REASON];
    gm_temporary_sweep(path);
    FILE *file = gm_regular_open(path, SIZE_MAX, &size, reason);
    if (!file) {
        return gm_refuse(message, "%.300s could not be read: %s", path, reason);
    }
    const char *fault = read_file(file, size, snapshot);
    fclose(file);
    if (fault) {
        gm_refuse(message, "%.360s %s", path, fault);
    }
    return !fault;
}

bool gm_snapshot_unpack(struct gm_lane *lane, double t, const unsigned char *bytes, size_t *size)
{
    const struct gm_run *run = lane->run;
    const double t0 = run->t0, dt = run->dt;
    return gm_lane_unpack(lane, bytes, size) && run->t0 == t0 && run->dt == dt && run->n == run->steps &&
           run->steps <= gm_run_steps_by(run, t);
}
