/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_PROBLEMS_BURGERS_H
#define GM_CORE_FIELD_PROBLEMS_BURGERS_H

#include "core/field/field.h"
#include "core/field/problems/moving_frames.h"

/* Burgers' equation u_t + u u_x = nu u_xx and its frames of reference,
       (t, x, u) -> (t, x + lambda (t - t0), u + lambda).
   The nodes are those of gm_problem.line, the first and the last hold exact values. */

enum gm_burgers_test {
    GM_BURGERS_FRONT, /* -sinh(x/2nu) / (cosh(x/2nu) + exp(-t/4nu)), t0 = 0 */
    GM_BURGERS_SHOCK, /* (x - tanh(x / (2 nu t))) / t, t0 = 1 */
};

struct gm_burgers {
    int test, frame; /* enum gm_burgers_test, gm_frame_nodes */
    int printed;     /* the convection is u D u, not D(u^2/2) */
    double viscosity, lambda;
    double a, d; /* parameters of the family of moving frames (core/field/families/burgers.c) */
};

static inline const struct gm_burgers *gm_burgers_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

double gm_burgers_t0(const struct gm_burgers *burgers);

/* The exact value at time t, in the new frame, at the node that was at x at t0 and rests there (fixed) or
   moves. */
double gm_burgers_exact(const struct gm_burgers *burgers, bool fixed, double x, double t);

/* State: u at the nodes; where lambda is not 0 a companion follows, the same run in the frame lambda = 0 on
   as many nodes, and a number, 1 while it is well. */
size_t gm_burgers_size(const struct gm_burgers *burgers, size_t points);

/* The caller sets parameters (struct gm_burgers), line and n. */
extern const struct gm_problem gm_problem_burgers;

#endif
