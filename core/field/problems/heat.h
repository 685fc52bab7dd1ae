/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_PROBLEMS_HEAT_H
#define GM_CORE_FIELD_PROBLEMS_HEAT_H

#include "core/field/field.h"
#include "core/field/problems/moving_frames.h"

/* The heat equation u_t = nu u_xx for u > 0 and its frames of reference,
       (t, x, u) -> (t, x + lambda t, u exp(-lambda x/(2 nu) - lambda^2 t/(4 nu))),   t from the start on.
   The nodes are those of gm_problem.line, the first and the last hold exact values. */

struct gm_heat {
    struct gm_framed framed; /* first */
    double diffusivity;
};

static inline const struct gm_heat *gm_heat_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

/* The divisor of the value at time t, in the new frame, at the node that was at x at the start and rests there (fixed)
   or moves, which gives the value in the original frame. */
double gm_heat_factor(const struct gm_heat *heat, bool fixed, double x, double t);

/* The caller sets parameters (struct gm_heat), line and n, the points. */
extern const struct gm_problem gm_problem_heat;

#endif
