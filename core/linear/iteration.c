/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps, and Newton's method with halved steps (Deuflhard, Newton Methods for Nonlinear Problems (2004),
   3.1). */
#include "core/linear/iteration.h"

bool gm_sweeps_solve(const struct gm_implicit_equations *equations, double *scratch, double *z,
                     struct gm_progress *progress)
{
    return gm_sweeps_solve_by(equations, equations->sweep, scratch, z, progress);
}

bool gm_newton_solve(const struct gm_implicit_equations *equations, double *scratch, double *z,
                     struct gm_progress *progress)
{
    return gm_newton_solve_by(equations, equations->linear, scratch, z, progress);
}
