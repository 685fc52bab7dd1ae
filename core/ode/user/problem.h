/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A user-defined system as a problem that schemes advance: its formulas are interpreted until compiled loops
   take over. */
#ifndef GM_CORE_ODE_USER_PROBLEM_H
#define GM_CORE_ODE_USER_PROBLEM_H

#include "core/ode/ode.h"
#include "core/ode/user/model.h"

/* Opens the problem with these values of the system's variables: of parameters, and of components at the
   start (gm_equations_start), which decide whether it attracts there. The model outlives it. m is 1, and may
   be changed. Returns false when out of memory. The caller closes it in both cases. */
bool gm_user_problem_open(struct gm_problem *problem, const struct gm_user_model *model,
                          const double *values);
void gm_user_problem_close(struct gm_problem *problem);

/* The motion of a system without the tangents that it carries along. */
struct gm_user_motion {
    const struct gm_user_system *whole; /* the system with its tangents */
    struct gm_user_system system;
    struct gm_user_model model;
    struct gm_problem problem;
};
/* Returns the motion of a problem, in the arena; NULL if it carries no tangents. */
const struct gm_user_motion *gm_user_problem_motion(struct gm_arena *arena, const struct gm_problem *problem);

struct gm_loops; /* core/ode/kernel/loops.h */

/* Returns the text of its kernels (core/ode/user/kernel.h) for a family that has such loops (`over`, see
   core/ode/kernel/loops.h); the caller frees. NULL with the reason, which is NULL when out of memory. */
char *gm_user_problem_kernel(const struct gm_problem *problem, int over, const char **lacks);
/* Returns the address of the compiler's note on its compilation; NULL at first. */
void **gm_user_problem_note(const struct gm_problem *problem);
/* From the next step on these loops advance the problem, as far as they go, and outlive it. NULL: the
   interpreter again, for a run that was opened with it. The numbers stay the same. */
void gm_user_problem_take(struct gm_problem *problem, const struct gm_loops *loops);
/* Lets all motions with frozen switches take such loops from now on, whose text is that of one of them. */
void gm_user_problem_take_frozen(struct gm_problem *problem, const struct gm_loops *loops);
/* Takes the loops that the build compiled of these formulas, if they exist; `over` is the family, as in
   gm_user_problem_kernel. */
void gm_user_problem_take_compiled(struct gm_problem *problem, int over);
/* Returns the loops that advance it; NULL: the interpreter. */
const struct gm_loops *gm_user_problem_taken(const struct gm_problem *problem);

#endif
