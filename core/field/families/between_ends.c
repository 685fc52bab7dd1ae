/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/field/families/between_ends.h"

#include <string.h>

double gm_frame_exact(const struct gm_framed *framed, double speed, double x, double t)
{
    const double event[] = {x + speed * (t - framed->line.begin), t};
    double value;
    gm_user_line_events(&framed->line, event, 1, &value);
    return value;
}

/* The exact values that the first and the last node hold, if they move with this speed. Values of many steps are
   computed together. */
enum { BLOCK = 64 };
struct ends {
    double speed;
    size_t next, count; /* of the values, which are those of the first node and then those of the last */
    double values[2 * BLOCK];
};

/* Sets both ends of the level after step k of a task, from 0 on, one step after the other. */
static void set_ends(struct ends *ends, const struct gm_task *task, int64_t k, double *level)
{
    const struct gm_user_line *line = &gm_framed_of(task->problem)->line;
    const struct gm_grid1 *grid = &task->problem->line;
    const double places[] = {gm_grid1_node(grid, 0), gm_grid1_node(grid, grid->points - 1)};
    if (ends->next == ends->count) {
        const int64_t rest = task->steps - k;
        const size_t count = rest < BLOCK ? (size_t)rest : BLOCK;
        double events[4 * BLOCK];
        for (size_t i = 0; i < 2 * count; i++) {
            const double t = task->t0 + (double)(task->n + k + (int64_t)(i % count) + 1) * task->dt;
            events[i] = places[i / count] + ends->speed * (t - line->begin);
            events[2 * count + i] = t;
        }
        gm_user_line_events(line, events, 2 * count, ends->values);
        ends->next = 0;
        ends->count = count;
    }
    level[0] = ends->values[ends->next];
    level[grid->points - 1] = ends->values[ends->count + ends->next];
    ends->next++;
}

/* A level and its other half, and what its ends hold after the next steps. */
struct run {
    double **level;
    double middle, speed, shift; /* of values and of nodes; what the exact values are larger by */
    struct ends ends;
};

/* Makes step k of a level to its other half, with the exact values at both ends. */
static enum gm_status make_step(const struct gm_task *task, struct run *run, int64_t k,
                                struct gm_progress *progress)
{
    const struct gm_two_step_work *work = task->workspace;
    const struct gm_ends_method *method = task->scheme->coefficients;
    const struct gm_grid1 *grid = &task->problem->line;
    double **level = run->level;
    const struct gm_ends_step step = {
        .framed = gm_framed_of(task->problem),
        .points = grid->points,
        .h = grid->dx,
        .k = task->dt,
        .sigma = run->speed * task->dt,
        .u = level[0],
        .out = level[1],
        .constant = work->right,
        .above = work->guess,
        .right = work->cells,
    };
    set_ends(&run->ends, task, k, level[1]);
    level[1][0] -= run->shift;
    level[1][grid->points - 1] -= run->shift;
    enum gm_status status = method->make(&step, progress);
    if (status == GM_OK && !gm_level_is_within(level[1], grid->points, run->middle, task->limit)) {
        status = GM_BLOW_UP;
    }
    if (status == GM_OK) {
        double *past = level[0];
        level[0] = level[1];
        level[1] = past;
    }
    return status;
}

struct gm_progress gm_ends_advance(const struct gm_task *task)
{
    struct gm_two_step_work *work = task->workspace;
    const struct gm_framed *framed = gm_framed_of(task->problem);
    const size_t points = work->points, size = points * sizeof(double);
    const double lambda = framed->lambda, speed = gm_frame_rests(framed, task->scheme) ? 0 : lambda;
    const bool has_companion = task->problem->n > points;
    struct run run = {
        .level = work->level, .middle = has_companion ? lambda : 0, .speed = speed, .ends.speed = speed};
    /* its nodes are those that move along */
    struct run companion = {.level = work->rate, .shift = lambda, .ends.speed = lambda};
    bool accompanied = has_companion && task->y[2 * points] != 0;
    struct gm_progress progress = {.status = GM_OK}, uncounted = {.status = GM_OK};
    memcpy(work->level[0], task->y, size);
    if (has_companion) {
        memcpy(companion.level[0], task->y + points, size);
    }
    for (int64_t k = 0; k < task->steps; k++) {
        progress.status = make_step(task, &run, k, &progress);
        if (progress.status != GM_OK) {
            return progress;
        }
        /* a companion that fails stands still: its failure is not this run's */
        accompanied = accompanied && make_step(task, &companion, k, &uncounted) == GM_OK;
        progress.done++;
    }
    memcpy(task->out, work->level[0], size);
    if (has_companion) {
        memcpy(task->out + points, companion.level[0], size);
        task->out[2 * points] = accompanied;
    }
    return progress;
}

double gm_ends_carried(const struct gm_ends_method *method,
                       struct gm_event (*carry)(const struct gm_framed *framed,
                                                const struct gm_point_symmetry *symmetry,
                                                struct gm_event event),
                       const struct gm_ends_step *plain, const struct gm_point_symmetry *symmetry, double x,
                       double *arrival)
{
    struct gm_progress progress = {.status = GM_OK};
    struct gm_ends_step step = *plain;
    double made[3] = {0}, carried[3];
    step.out = made;
    method->make(&step, &progress);
    const struct gm_event there =
        carry(step.framed, symmetry, (struct gm_event){.t = step.k, .x = x, .u = made[1]});
    for (int i = 0; i < 3; i++) {
        carried[i] =
            carry(step.framed, symmetry, (struct gm_event){.x = x + (i - 1) * step.h, .u = plain->u[i]}).u;
    }
    step.h = symmetry->scale * plain->h;
    step.k = there.t;
    step.sigma = there.x - symmetry->scale * x;
    step.u = carried;
    method->make(&step, &progress);
    *arrival = there.u;
    return made[1];
}
