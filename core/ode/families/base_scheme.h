/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scheme whose steps another one takes, of lengths of its own. */
#ifndef GM_CORE_ODE_FAMILIES_BASE_SCHEME_H
#define GM_CORE_ODE_FAMILIES_BASE_SCHEME_H

#include "core/arena.h"
#include "core/problem.h"

struct gm_base_scheme {
    const struct gm_scheme *scheme;
    struct gm_problem problem;
    void *workspace;
    gm_loop *advance;    /* its loop */
    struct gm_task step; /* the next one; the caller may set what gm_base_begin leaves out */
};

/* Opens it for this number of members, in the body of an arena, which closes it. */
void gm_base_open(struct gm_arena *arena, struct gm_base_scheme *base, const struct gm_scheme *scheme,
                  const struct gm_problem *problem, size_t members);
/* Forgets what is derived from an earlier state. */
void gm_base_reset(const struct gm_base_scheme *base);
/* Prepares steps with the task's limit and settings. Their sums are plain, and each counts as the first of a run. */
void gm_base_begin(struct gm_base_scheme *base, const struct gm_task *task);
/* out := a step h from y; adds its costs to the progress. */
enum gm_status gm_base_step(struct gm_base_scheme *base, double h, const double *y, double *out,
                            struct gm_progress *progress);

#endif
