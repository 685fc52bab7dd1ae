/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_LANE_PACK_H
#define GM_SCENES_COMMON_LANE_PACK_H

#include "scenes/common/lane.h"

/* The changing state of a lane as a block of bytes: the run's state, history and tracks. Parameters and
   scheme are not included: it is unpacked into a lane opened with the same. */

size_t gm_lane_pack_size(const struct gm_lane *lane);

/* Writes gm_lane_pack_size bytes, in a format of this build of the program. */
void gm_lane_pack(const struct gm_lane *lane, void *bytes);

/* Reads a lane of the same scene, parameters, settings and scheme from at most *size bytes; sets *size to the
   bytes read. Returns false if they are not from such a lane, which must then be closed. */
bool gm_lane_unpack(struct gm_lane *lane, const void *bytes, size_t *size);

/* Returns a copy with its own past, a fork; NULL when out of memory. */
struct gm_lane *gm_lane_copy(const struct gm_lane *lane);

#endif
