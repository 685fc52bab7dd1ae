/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tests for the end of an iteration. The loops over kernels include this too, so all of it is inline.
   A change is the sum of magnitudes; the one before it starts as infinity. */
#ifndef GM_CORE_LINEAR_SETTLED_H
#define GM_CORE_LINEAR_SETTLED_H

#include <stdbool.h>
#include <stddef.h>

#include "core/status.h"

#define GM_EPSILON 2.220446049250313e-16

/* A change of `size` unknowns that is not larger than this leaves them as they are, even at values of
   1e-308. */
#define GM_LEAST_CHANGE(size) ((double)(size)*0x1p-1021)

/* Sweeps z := h A f(y + z), of doubles or of slots of them, are at their end if the change is not smaller
   than the one before or, changes being in geometric progression, the next one would be below
   `negligible`, 2^-60 of the first (with more, invariants drift), and it is at the level of rounding. */
#define GM_SWEEPS_ARE_SETTLED(change, previous, negligible, roundoff, least)                                 \
    (((change) <= (least)) |                                                                                 \
     ((((change) >= (previous)) | ((change) * (change) <= (negligible) * (previous))) &                      \
      ((change) <= (roundoff))))
/* If two sweeps do not make the change four times smaller, Newton's method needs fewer evaluations. */
#define GM_SWEEPS_CONTRACT(change, before_previous, roundoff)                                                \
    (((change) <= 0.25 * (before_previous)) | ((change) <= (roundoff)))

/* Returns true if the rounding of the terms of h f can decide that Newton's method is at its end. With the
   rule of gm_newton_is_settled the previous change is then less than 2^-26 of the scale. */
static inline bool gm_rounding_decides(double scale, double previous)
{
    return previous <= 0x1p-26 * scale;
}

/* Returns true if Newton's method for stages is at its end. `scale` is the sum of |y| + |z|, `rounding` the
   rounding of the terms of h f. Without `rounding` stiff equations with long steps never settle; without its
   bound a first guess settles if its residual is only rounding. Changes that are halved still fall. */
static inline bool gm_newton_is_settled(size_t size, double change, double scale, double rounding,
                                        double *previous)
{
    const double most = 0x1p25 * scale;
    const double level = GM_EPSILON * (64 * scale + (rounding < most ? rounding : most));
    const bool settled = change <= GM_LEAST_CHANGE(size) || change <= 0x1p-60 * scale ||
                         (change > 0.9 * *previous && change <= level);
    *previous = change;
    return settled;
}

/* Returns true if an iteration is at its end. Changes of at most `least` are round-off, even if they still
   fall. Larger changes, up to `roundoff`, are round-off when they no longer fall. */
static inline bool gm_is_settled_within(double change, double least, double roundoff, double *previous)
{
    const bool settled =
        change <= 0x1p-1000 || change <= least || (change >= *previous && change <= roundoff);
    *previous = change;
    return settled;
}

/* Returns true if another iteration is at its end: a change far below the level of round-off is the last
   one. */
static inline bool gm_is_settled(double change, double roundoff, double *previous)
{
    return gm_is_settled_within(change, 0x1p-14 * roundoff, roundoff, previous);
}

/* Returns the reason why an iteration with this last change has not settled. */
static inline struct gm_unsolved gm_unsolved_by(double change, double scale)
{
    return (struct gm_unsolved){change < 1e100 ? GM_STILL_LARGE : GM_NOT_FINITE, .change = change / scale};
}

#endif
