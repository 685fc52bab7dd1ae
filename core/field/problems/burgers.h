/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_PROBLEMS_BURGERS_H
#define GM_CORE_FIELD_PROBLEMS_BURGERS_H

#include "core/field/field.h"
#include "core/field/problems/moving_frames.h"

/* Burgers' equation u_t + u u_x = nu u_xx and its frames of reference,
       (t, x, u) -> (t, x + lambda t, u + lambda),   t from the start on.
   The nodes are those of gm_problem.line, the first and the last hold exact values. */

struct gm_burgers {
    struct gm_framed framed; /* first */
    int printed;             /* the convection is u D u, not D(u^2/2) */
    double viscosity;
    double a, d; /* parameters of the family of moving frames (core/field/families/burgers.c) */
};

static inline const struct gm_burgers *gm_burgers_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

/* State: u at the nodes; where lambda is not 0 a companion follows, the same run in the frame lambda = 0 on
   as many nodes, and a number, 1 while it is well. */
static inline size_t gm_burgers_size(const struct gm_burgers *burgers, size_t points)
{
    return burgers->framed.lambda != 0 ? 2 * points + 1 : points;
}

/* The caller sets parameters (struct gm_burgers), line and n. */
extern const struct gm_problem gm_problem_burgers;

#endif
