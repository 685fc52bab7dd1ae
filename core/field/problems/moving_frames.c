/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact values in frames of reference. The heat equation is eq. 73 of Razafindralandy et al. (2018); its boosts are those
   of P.J. Olver, Applications of Lie Groups to Differential Equations (1993), ex. 2.41. */
#include "core/field/problems/moving_frames.h"

double gm_frame_exact(const struct gm_framed *framed, double speed, double x, double t)
{
    const double event[] = {x + speed * (t - framed->line.begin), t};
    double value;
    gm_user_line_events(&framed->line, event, 1, &value);
    return value;
}

void gm_frame_ends(const struct gm_task *task, double speed, int64_t first, size_t count, double *values)
{
    const struct gm_user_line *line = &gm_framed_of(task->problem)->line;
    const struct gm_grid1 *grid = &task->problem->line;
    const double ends[] = {gm_grid1_node(grid, 0), gm_grid1_node(grid, grid->points - 1)};
    double events[4 * GM_ENDS_BLOCK];
    for (size_t i = 0; i < 2 * count; i++) {
        const double t = task->t0 + (double)(task->n + first + (int64_t)(i % count) + 1) * task->dt;
        events[i] = ends[i / count] + speed * (t - line->begin);
        events[2 * count + i] = t;
    }
    gm_user_line_events(line, events, 2 * count, values);
}

double gm_heat_factor(const struct gm_framed *framed, bool fixed, double x, double t)
{
    const double lambda = framed->lambda, passed = t - framed->line.begin;
    const double original = fixed ? x - lambda * passed : x;
    return exp(-lambda / (4 * framed->viscosity) * (2 * original + lambda * passed));
}

const struct gm_problem gm_problem_burgers = {
    .name = "Burgers",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.equation = GM_NEEDS_BURGERS},
    .m = 1,
    .bound = 1e3,
};

const struct gm_problem gm_problem_heat = {
    .name = "heat",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.equation = GM_NEEDS_HEAT},
    .m = 1,
    .bound = 1e200,
};
