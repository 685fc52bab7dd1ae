/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A system that somebody wrote down, as a problem that schemes advance: its formulas are interpreted, until
   loops that were compiled of them take over. */
#ifndef GM_CORE_ODE_USER_PROBLEM_H
#define GM_CORE_ODE_USER_PROBLEM_H

#include "core/ode/ode.h"
#include "core/ode/user/model.h"

/* The problem with these values of the system's variables, those of parameters and where components start
   (gm_equations_start), of which the latter tell whether it attracts there. The model outlives it. m is 1, and
   may be changed. False: out of memory. To be closed in both cases. */
bool gm_user_problem_open(struct gm_problem *problem, const struct gm_user_model *model,
                          const double *values);
void gm_user_problem_close(struct gm_problem *problem);

struct gm_loops; /* core/ode/kernel/loops.h */

/* The text of its kernels (core/ode/user/kernel.h) for a family that has such loops (`over`, of
   core/ode/kernel/loops.h), malloc'ed; NULL with why there is none, or NULL for want of memory. */
char *gm_user_problem_kernel(const struct gm_problem *problem, int over, const char **lacks);
/* Where whoever compiles it notes which compilation is its own; NULL at first. */
void **gm_user_problem_note(const struct gm_problem *problem);
/* From the next step on it is advanced by these loops, as far as they go, which outlive it; NULL: by the
   interpreter again, which a run can that was opened while it was. The numbers stay the same. */
void gm_user_problem_take(struct gm_problem *problem, const struct gm_loops *loops);
/* Takes the loops that the build compiled of these formulas, if there are such (`over` as above). */
void gm_user_problem_take_compiled(struct gm_problem *problem, int over);
/* Those that advance it; NULL: the interpreter. */
const struct gm_loops *gm_user_problem_taken(const struct gm_problem *problem);

#endif
