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

void gm_frame_ends_set(struct gm_frame_ends *ends, const struct gm_task *task, int64_t k, double *level)
{
    const struct gm_user_line *line = &gm_framed_of(task->problem)->line;
    const struct gm_grid1 *grid = &task->problem->line;
    const double places[] = {gm_grid1_node(grid, 0), gm_grid1_node(grid, grid->points - 1)};
    if (ends->next == ends->count) {
        const int64_t rest = task->steps - k;
        const size_t count = rest < GM_ENDS_BLOCK ? (size_t)rest : GM_ENDS_BLOCK;
        double events[4 * GM_ENDS_BLOCK];
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
