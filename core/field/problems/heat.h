/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_PROBLEMS_HEAT_H
#define GM_CORE_FIELD_PROBLEMS_HEAT_H

#include "core/field/field.h"
#include "core/field/problems/moving_frames.h"

/* The heat equation u_t = nu u_xx for u > 0 and its frames of reference,
       (t, x, u) -> (t, x + lambda t, u exp(-lambda x/(2 nu) - lambda^2 t/(4 nu))).
   The nodes are those of gm_problem.line, the first and the last hold exact values. */

/* All are made of kernels K(x, s) = exp(-x^2/(4 nu s)) / sqrt(s), whose age s is t + `age`. */
enum gm_heat_start {
    GM_HEAT_KERNEL, /* K(x, s) sqrt(age): of the height 1 at t = 0 */
    GM_HEAT_TWO,    /* a kernel at -1.5, and one at 1.5 of the height 0.6 and three times the age */
    GM_HEAT_FRONT,  /* 0.1 + 0.45 erfc(x / sqrt(4 nu s)): from 1 down to a tenth */
};

struct gm_heat {
    int start, frame; /* enum gm_frame_nodes */
    double diffusivity, lambda, age;
};

static inline const struct gm_heat *gm_heat_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

/* The exact value at time t, in the new frame, at the node that was at x at t = 0 and rests there (fixed) or
   moves. */
double gm_heat_exact(const struct gm_heat *heat, bool fixed, double x, double t);
/* The divisor of a value at the node of gm_heat_exact that gives the value in the original frame. */
double gm_heat_factor(const struct gm_heat *heat, bool fixed, double x, double t);

/* The caller sets parameters (struct gm_heat), line and n, the points. */
extern const struct gm_problem gm_problem_heat;

#endif
