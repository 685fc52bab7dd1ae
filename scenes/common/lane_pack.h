/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_LANE_PACK_H
#define GM_SCENES_COMMON_LANE_PACK_H

#include "scenes/common/lane.h"

/* All that a lane becomes in time, as a block of bytes: the run's state, history and tracks. The parameters
   and the scheme are not among it; whoever unpacks has opened a lane with the same. */

size_t gm_lane_pack_size(const struct gm_lane *lane);

/* Into gm_lane_pack_size bytes, which the same build of the program understands. */
void gm_lane_pack(const struct gm_lane *lane, void *bytes);

/* Into a lane of the same scene, parameters, settings and scheme, from at most *size bytes, of which *size is
   then what it took. False if they are not of such a lane, which is then no good any more. */
bool gm_lane_unpack(struct gm_lane *lane, const void *bytes, size_t *size);

/* A copy with its own past: a fork. NULL if memory is short. */
struct gm_lane *gm_lane_copy(const struct gm_lane *lane);

#endif
