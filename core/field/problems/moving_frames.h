/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_PROBLEMS_MOVING_FRAMES_H
#define GM_CORE_FIELD_PROBLEMS_MOVING_FRAMES_H

#include "core/field/field.h"
#include "core/scheme.h"
#include "core/user/line.h"

/* The nodes of an equation in a frame with the velocity lambda: at rest in that frame, or moving by lambda
   dt per step. */
enum gm_frame_nodes {
    GM_FRAME_EACH, /* moving for invariant schemes, fixed for the others */
    GM_FRAME_FIXED,
    GM_FRAME_MOVING,
};

/* First in the parameters of every equation with frames of reference. */
struct gm_framed {
    struct gm_user_line line; /* first; of a file, else empty. The exact solution is that in the frame */
    double lambda;
    int frame; /* enum gm_frame_nodes */
};
static inline const struct gm_framed *gm_framed_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

/* A point of space and time with the value of the field there: what a symmetry moves. */
struct gm_event {
    double t, x, u;
};

/* Returns true if the nodes rest in the frame when this scheme runs. */
static inline bool gm_frame_rests(const struct gm_framed *framed, const struct gm_scheme *scheme)
{
    return framed->frame == GM_FRAME_FIXED ||
           (framed->frame == GM_FRAME_EACH && !(scheme->claims & GM_EQUIVARIANT));
}

/* Returns the exact value at time t at the node that starts at x and moves with this speed. */
double gm_frame_exact(const struct gm_framed *framed, double speed, double x, double t);

/* Writes what the first node, and then the last one, hold after each of `count` steps from number `first` of a task
   on, at most GM_ENDS_BLOCK, if they move with this speed: the exact values. */
enum { GM_ENDS_BLOCK = 64 };
void gm_frame_ends(const struct gm_task *task, double speed, int64_t first, size_t count, double *values);

#endif
