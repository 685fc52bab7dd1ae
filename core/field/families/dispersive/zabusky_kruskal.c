/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Leapfrog for u_t + eta u u_x + mu u_xxx = 0 (Zabusky & Kruskal, Phys. Rev. Lett. 15 (1965) 240):
       u^{n+1} = u^{n-1} - eta dt/(3 dx) (u_{i+1} + u_i + u_{i-1}) (u_{i+1} - u_{i-1})
                         - mu dt/dx^3 (u_{i+2} - 2 u_{i+1} + 2 u_{i-1} - u_{i-2}).
   Stable for dt below about 0.385 dx^3/mu. */
#include "core/field/families/family.h"
#include "core/field/families/two_step.h"
#include "core/field/problems/problems.h"

/* next = base + step u_t */
static void add_rate(struct gm_two_step_work *work, const struct gm_problem *problem, const double *base,
                     double step)
{
    const double centred = step / (2 * problem->line.dx);
    gm_kdv_add_terms(work->level[1], base, work->level[2], work->points, 0,
                     centred * gm_kdv_of(problem)->eta / 3,
                     centred * gm_kdv_of(problem)->mu / (problem->line.dx * problem->line.dx));
}

static enum gm_status step(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                           struct gm_progress *progress)
{
    add_rate(work, problem, work->level[0], 2 * dt);
    progress->evaluations++;
    return GM_OK;
}

/* An Euler step: once, so that the order stays 2. */
static void start(struct gm_two_step_work *work, const struct gm_problem *problem, double dt, double gap)
{
    (void)gap;
    add_rate(work, problem, work->level[1], dt);
}

static const struct gm_two_step_row row = {.step = step, .start = start, .law = GM_LAW_NONE};

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_zabusky_kruskal, .family = &gm_family_zabusky_kruskal, .needs = GM_NEEDS_KDV,
     .coefficients = &row},
};

const struct gm_family gm_family_zabusky_kruskal = {
    .title = "Zabusky-Kruskal leapfrog",
    GM_FIELD_FAMILY,
    GM_TWO_STEP_LOOP,
};
