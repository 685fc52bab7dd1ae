/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stages of one step of one member, solved through the problem's field and Jacobian. */
#ifndef GM_CORE_ODE_KERNEL_STAGE_SOLVER_H
#define GM_CORE_ODE_KERNEL_STAGE_SOLVER_H

#include "core/ode/kernel/stages.h"
#include "core/ode/ode.h"

struct gm_stage_solver {
    struct gm_stages stages; /* the caller sets h, y, the coefficients and progress */
    struct gm_implicit_equations equations;
    double *z, *scratch;
};

/* The scratch of a solver of `count` stages, in doubles, and a solver that works in it. */
size_t gm_stage_solver_room(const struct gm_problem *problem, size_t count);
struct gm_stage_solver gm_stage_solver_lay(const struct gm_problem *problem, size_t count, double *scratch);

/* Solve for z from 0. On failure return false, and progress holds the reason; Newton's method fails if n is
   too large for a matrix. */
bool gm_stages_by_sweeps(struct gm_stage_solver *solver);
bool gm_stages_by_newton(struct gm_stage_solver *solver);

#endif
