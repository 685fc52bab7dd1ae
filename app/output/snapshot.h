/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_SNAPSHOT_H
#define GM_APP_OUTPUT_SNAPSHOT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "scenes/common/lane.h"

/* The file of a checkpoint: packed lanes and whose they are. */
struct gm_snapshot {
    const char *identity; /* of what is gone on with; "" to no end: see gm_program_checksum */
    int64_t position;     /* how far that has come, as it counts */
    uint32_t lanes;
    unsigned char *body; /* malloc'ed by gm_snapshot_read */
    size_t size;
};

/* Replaces the file at once, or leaves it as it was. False with a sentence (GM_MESSAGE bytes). */
bool gm_snapshot_write(const char *path, const struct gm_snapshot *snapshot, char *message);

/* Reads the one of this identity. False with a sentence: there is none, it is damaged or of something
   else. */
bool gm_snapshot_read(const char *path, struct gm_snapshot *snapshot, char *message);

/* Puts a lane just opened into a packed state, which must be one that this lane can have at the time t; from
   at most *size bytes, of which *size is then what it took. False: the lane is no good any more. */
bool gm_snapshot_unpack(struct gm_lane *lane, double t, const unsigned char *bytes, size_t *size);

/* The checksum of the running program: what another build made is not ours, whatever its version says. False
   if the program cannot be read. */
bool gm_program_checksum(unsigned *checksum);

#endif
