/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop of schemes on nodes between two ends, whose values are exact, in a frame of reference: Burgers' equation and the
   heat equation. */
#ifndef GM_CORE_FIELD_FAMILIES_BETWEEN_ENDS_H
#define GM_CORE_FIELD_FAMILIES_BETWEEN_ENDS_H

#include "core/field/families/frames.h"
#include "core/field/families/two_step.h"

/* One step of length k on nodes h apart, each displaced by sigma. u and out have `points` entries; out[0] and
   out[points - 1] hold the boundary values of the new level already. */
struct gm_ends_step {
    const struct gm_framed *framed;
    size_t points;
    double h, k, sigma;
    const double *u;
    double *out;
    double *constant, *above, *right; /* [points], of implicit schemes */
};

/* The coefficients of a scheme. */
struct gm_ends_method {
    enum gm_status (*make)(const struct gm_ends_step *step, struct gm_progress *progress);
    bool implicit;
    bool special; /* gm_moving_frames.are_special */
};

static inline bool gm_ends_are_special(const struct gm_scheme *scheme)
{
    return ((const struct gm_ends_method *)scheme->coefficients)->special;
}

struct gm_progress gm_ends_advance(const struct gm_task *task);
/* The fields of a family that advances so. */
#define GM_ENDS_LOOP                                                                                         \
    .loop = gm_ends_advance, .workspace_open = gm_two_step_open, .workspace_close = gm_two_step_close

/* The value in the middle of three nodes about x after a step from where a symmetry carries them; *arrival is where it
   carries that of the plain step. */
double gm_ends_carried(const struct gm_ends_method *method,
                       struct gm_event (*carry)(const struct gm_framed *framed,
                                                const struct gm_point_symmetry *symmetry,
                                                struct gm_event event),
                       const struct gm_ends_step *plain, const struct gm_point_symmetry *symmetry, double x,
                       double *arrival);

#endif
