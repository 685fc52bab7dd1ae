/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop of schemes of two steps: three levels that change places, the first step after a change of dt,
   and the memory of a scheme. */
#include "core/field/families/two_step.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"

void *gm_two_step_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    enum { ARRAYS = 11 };
    const size_t points = problem->line.points, length = points + 2 * GM_LEVEL_PAD;
    struct gm_two_step_work *work = calloc(1, sizeof *work + ARRAYS * length * sizeof(double));
    if (!work) {
        return NULL;
    }
    double **const arrays[ARRAYS] = {&work->level[0], &work->level[1], &work->level[2], &work->force,
                                     &work->right,    &work->guess,    &work->cells,    &work->change,
                                     &work->rate[0],  &work->rate[1],  &work->rate[2]};
    work->points = points;
    work->scheme = scheme;
    for (size_t i = 0; i < ARRAYS; i++) {
        *arrays[i] = (double *)(void *)(work + 1) + i * length + GM_LEVEL_PAD;
    }
    return work;
}

void gm_two_step_close(void *workspace)
{
    struct gm_two_step_work *work = workspace;
    gm_ring_newton_close(&work->newton);
    free(work);
}

GM_CLONES bool gm_level_is_within(const double *level, size_t points, double from, double limit)
{
    long outside = 0;
    for (size_t i = 0; i < points; i++) {
        outside += !(fabs(level[i] - from) <= limit);
    }
    return outside == 0;
}

/* The other level of the state lies at neither t + dt nor t - dt: the level at t + dt by the velocity at t,
   to second order from both sides, so that a change of dt costs no order. */
void gm_wave_start(struct gm_two_step_work *work, const struct gm_problem *problem, double dt, double gap)
{
    const double *other = work->level[0], *now = work->level[1];
    double *next = work->level[2];
    const double over = 1 / (problem->line.dx * problem->line.dx);
    gm_field_of(problem)->wave->slopes(problem, now, work->force, work->points);
    for (size_t i = 0; i < work->points; i++) {
        const double acceleration = over * ((now + i)[1] - 2 * now[i] + (now + i)[-1]) - work->force[i];
        const double velocity = (other[i] - now[i]) / gap - gap / 2 * acceleration;
        next[i] = now[i] + dt * (velocity + dt / 2 * acceleration);
    }
}

void gm_level_close_ring(double *level, size_t points)
{
    for (size_t i = 0; i < GM_LEVEL_PAD; i++) {
        level[(ptrdiff_t)i - GM_LEVEL_PAD] = level[points - GM_LEVEL_PAD + i];
        level[points + i] = level[i];
    }
}

GM_CLONES static void add_terms(const double *u, const double *base, double *restrict next, size_t points,
                                double drift, double convection, double dispersion)
{
    for (size_t j = 0; j < points; j++) {
        const double *here = u + j, right = here[1], left = here[-1];
        next[j] = base[j] + (drift - convection * (left + here[0] + right)) * (right - left) -
                  dispersion * (here[2] - 2 * right + 2 * left - here[-2]);
    }
}

void gm_kdv_add_terms(double *u, const double *base, double *next, size_t points, double drift,
                      double convection, double dispersion)
{
    gm_level_close_ring(u, points);
    add_terms(u, base, next, points, drift, convection, dispersion);
}

static void subtract(double *change, const double *level, const double *before, size_t points)
{
    for (size_t i = 0; i < points; i++) {
        change[i] = level[i] - before[i];
    }
}

static double *rotate(double *level[3])
{
    double *past = level[0];
    level[0] = level[1];
    level[1] = level[2];
    return level[2] = past;
}

struct gm_progress gm_two_step_advance(const struct gm_task *task)
{
    const struct gm_two_step_row *row = task->scheme->coefficients;
    struct gm_two_step_work *work = task->workspace;
    const size_t points = work->points, size = points * sizeof(double);
    const double jump = task->problem->line.jump, gap = task->y[2 * points];
    struct gm_progress progress = {.status = GM_OK};
    double *next = work->level[2];
    memcpy(work->level[1], task->y, size);
    memcpy(work->level[0], task->y + points, size);
    gm_grid1_close(work->level[1], points, jump);
    gm_grid1_close(work->level[0], points, jump);
    const bool own = !row->keeps_origin || task->memory[0] == 1,
               remembers = row->keeps_change && task->memory;
    const bool regular = row->single || (own && gap == -task->dt);
    if (remembers) {
        memcpy(work->change, task->memory, size);
    } else if (row->keeps_change) {
        subtract(work->change, task->y, task->y + points, points);
    }
    if (row->keeps_rates) {
        memcpy(work->rate[1], task->memory, size);
        memcpy(work->rate[0], task->memory + points, size);
    }
    for (int64_t k = 0; k < task->steps; k++) {
        const bool begins = k == 0 && !regular, returns = begins && own && gap == task->dt;
        work->first = begins && !returns;
        if (returns) {
            memcpy(next, work->level[0], size);
            memcpy(work->rate[2], work->rate[0], size);
        } else if (work->first && row->start) {
            row->start(work, task->problem, task->dt, gap);
        } else {
            progress.status = row->step(work, task->problem, task->dt, &progress);
        }
        if (begins && row->keeps_change) {
            subtract(work->change, next, work->level[1], points);
        }
        if (progress.status == GM_OK && !gm_level_is_within(next, points, 0, task->limit)) {
            progress.status = GM_BLOW_UP;
        }
        if (progress.status != GM_OK) {
            return progress;
        }
        gm_grid1_close(next, points, jump);
        next = rotate(work->level);
        rotate(work->rate);
        progress.done++;
    }
    gm_wave_write(task, work->level[1], work->level[0]);
    if (remembers) {
        memcpy(task->memory_out, work->change, size);
    }
    if (row->keeps_rates) {
        memcpy(task->memory_out, work->rate[1], size);
        memcpy(task->memory_out + points, work->rate[0], size);
    }
    if (row->keeps_origin) {
        task->memory_out[0] = 1;
    }
    return progress;
}
