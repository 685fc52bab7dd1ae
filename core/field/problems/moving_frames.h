/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_PROBLEMS_MOVING_FRAMES_H
#define GM_CORE_FIELD_PROBLEMS_MOVING_FRAMES_H

#include <stdbool.h>

/* The nodes of an equation in a frame with the velocity lambda: at rest in that frame, or moving by lambda
   dt per step. */
enum gm_frame_nodes {
    GM_FRAME_EACH, /* moving for invariant schemes, fixed for the others */
    GM_FRAME_FIXED,
    GM_FRAME_MOVING,
};

/* A point of space and time with the value of the field there: what a symmetry moves. */
struct gm_event {
    double t, x, u;
};

static inline bool gm_frame_rests(int frame, bool invariant)
{
    return frame == GM_FRAME_FIXED || (frame == GM_FRAME_EACH && !invariant);
}

#endif
