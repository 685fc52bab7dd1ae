/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scheme whose steps another one takes, of lengths of its own. */
#ifndef GM_CORE_ODE_FAMILIES_BASE_SCHEME_H
#define GM_CORE_ODE_FAMILIES_BASE_SCHEME_H

#include "core/problem.h"

struct gm_base_scheme {
    const struct gm_scheme *scheme;
    struct gm_problem problem; /* with one member */
    void *workspace;
    const double *carry; /* the compensations of the sums, before and after the next step; NULL: plain */
    double *carry_out;
};

/* Returns false when out of memory; to be closed in both cases. */
bool gm_base_open(struct gm_base_scheme *base, const struct gm_scheme *scheme,
                  const struct gm_problem *problem);
void gm_base_close(struct gm_base_scheme *base);
/* Forgets what is derived from an earlier state. */
void gm_base_reset(const struct gm_base_scheme *base);
/* out := a step h from y, with the task's limit and settings; adds its costs to the progress. */
enum gm_status gm_base_step(const struct gm_base_scheme *base, const struct gm_task *task, double h,
                            const double *y, double *out, struct gm_progress *progress);

#endif
