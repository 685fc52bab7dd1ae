/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Leapfrog for u_t + eta u u_x + mu u_xxx = 0 (Zabusky & Kruskal, Phys. Rev. Lett. 15 (1965) 240):
       u^{n+1} = u^{n-1} - eta dt/(3 dx) (u_{i+1} + u_i + u_{i-1}) (u_{i+1} - u_{i-1})
                         - mu dt/dx^3 (u_{i+2} - 2 u_{i+1} + 2 u_{i-1} - u_{i-2}).
   Stable for dt below about 0.385 dx^3/mu. */
#include "core/field/families/family.h"
#include "core/field/families/two_step.h"
#include "core/field/problems/problems.h"

/* 2 u_t at node i */
static double twice_rate(const struct gm_problem *problem, const double *u, size_t i)
{
    const size_t n = problem->line.points;
    const double dx = problem->line.dx;
    const double l2 = u[(i + 2 * n - 2) % n], l = u[(i + n - 1) % n], r = u[(i + 1) % n], r2 = u[(i + 2) % n];
    return -gm_kdv_of(problem)->eta / (3 * dx) * (r + u[i] + l) * (r - l) -
           gm_kdv_of(problem)->mu / (dx * dx * dx) * (r2 - 2 * r + 2 * l - l2);
}

static enum gm_status step(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                           struct gm_progress *progress)
{
    const double *past = work->level[0], *now = work->level[1];
    double *next = work->level[2];
    const double dx = problem->line.dx;
    const double convection = gm_kdv_of(problem)->eta * dt / (3 * dx),
                 third = gm_kdv_of(problem)->mu * dt / (dx * dx * dx);
    for (size_t i = 2; i + 2 < work->points; i++) {
        const double l = now[i - 1], r = now[i + 1];
        next[i] = past[i] - convection * (r + now[i] + l) * (r - l) -
                  third * (now[i + 2] - 2 * r + 2 * l - now[i - 2]);
    }
    for (size_t i = 0; i < work->points; i++) {
        if (i < 2 || i + 2 >= work->points) {
            next[i] = past[i] + dt * twice_rate(problem, now, i);
        } else {
            i = work->points - 3;
        }
    }
    progress->evaluations++;
    return GM_OK;
}

/* An Euler step: once, so that the order stays 2. */
static void start(struct gm_two_step_work *work, const struct gm_problem *problem, double dt, double gap)
{
    (void)gap;
    const double *now = work->level[1];
    double *next = work->level[2];
    for (size_t i = 0; i < work->points; i++) {
        next[i] = now[i] + dt / 2 * twice_rate(problem, now, i);
    }
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
