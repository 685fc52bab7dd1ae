/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss-Legendre collocation in space and time for M s_t + K s_x = grad S(s): r stages across a cell, s
   stages across a step, multisymplectic (S. Reich, J. Comput. Phys. 157 (2000) 473); r = s = 1 is the box.
   For u_tt - u_xx + V'(u) = 0 the memory is u and v = u_t at the r stages of every cell.

   With the tableau (A, b, c) around a ring, z = e^(i theta) the shift by a cell, the derivative of stage
   values is circulant,
       D(z) = [A^-1 - A^-1 1 b' A^-1 / (z - 1 + rho)] / dx,   rho = b' A^-1 1 = 2 (r = 1), 0 (r = 2),
   and skew: each mode has r branches, on which D is i omega:
       r = 1   omega dx = 2 tan(theta/2)
       r = 2   omega dx = [-beta +- sqrt(beta^2 + 4 a^2)] / 2,   a = 2 sqrt 3,   beta = 6 cot(theta/2)
               stage values (a - i omega dx, a + i omega dx)
   A branch of infinite frequency (r = 1, z = -1: an even number of cells; r = 2, z = 1) is 0, which the slope
   of w forces. A step is that of the s-stage Gauss method for
       u'' = D^2 u - V'(u),
   solved for the stages of u'', branch by branch but for V', and iterated, which contracts by dt^2/4.

   From values at the nodes the stages are found by averaging (r = 1) or by trigonometric interpolation (r =
   2), and the other way round: the nodes' own values of the collocation polynomials lose an order if they do
   not start as part of a discrete solution. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/field/families/gauss_box.h"

static const struct gm_gauss_tableau midpoint = {1, {{0.5}}, {1}, {0.5}};
static const struct gm_gauss_tableau gauss4 = {
    2,
    {{0.25, 0.25 - GM_ROOT3 / 6}, {0.25 + GM_ROOT3 / 6, 0.25}},
    {0.5, 0.5},
    {0.5 - GM_ROOT3 / 6, 0.5 + GM_ROOT3 / 6},
};

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    return 2 * ((const struct gm_gauss_tableau *)scheme->coefficients)->n * problem->line.points + 1;
}

/* Corrects v so that a step leads to the other level as well as to the order of the scheme. */
static void correct(struct gm_gauss_work *work, const struct gm_problem *problem, double gap, const double *u,
                    double *v, const double *other_nodes)
{
    enum { TIMES = 2 };
    const size_t count = work->tableau->n * work->points, size = count * sizeof *u;
    struct gm_progress uncounted = {.status = GM_OK};
    double *other = malloc(2 * size);
    for (int k = 0; other && k < TIMES; k++) {
        gm_gauss_to_stages(work, &problem->line, other_nodes, other, other + count);
        memcpy(work->u, u, size);
        memcpy(work->v, v, size);
        if (gm_gauss_step(work, problem, gap, NULL, &uncounted) != GM_OK) {
            break;
        }
        for (size_t at = 0; at < count; at++) {
            v[at] += (other[at] - work->next_u[at]) / gap;
        }
    }
    free(other);
}

/* u and v at the stages, from the two levels: for r = 1 so that the first step leads from one to the
   other, for r = 2 by the first terms of Taylor's series, v = [u(t + g) - u(t)]/g - g [2 u''(t) + u''(t +
   g)]/6 + O(g^3). The last number of the memory says that it is filled, and is not to be filled anew for
   another dt. */
static enum gm_status start(const struct gm_task *task)
{
    const struct gm_problem *problem = task->problem;
    const struct gm_line *line = &problem->line;
    const struct gm_gauss_tableau *tableau = task->scheme->coefficients;
    const size_t points = line->points, r = tableau->n, count = r * points;
    const double gap = task->y[2 * points];
    double *u = task->memory_out, *v = u + count, *filled = v + count;
    struct gm_gauss_work *work = task->workspace;
    if (*filled == 1) {
        return GM_OK;
    }
    double *second = work->next_u, *other = work->v, *second_other = work->next_v;
    gm_gauss_to_stages(work, line, task->y, u, second);
    gm_gauss_to_stages(work, line, task->y + points, other, second_other);
    if (r == 1) {
        memcpy(work->u, u, count * sizeof *u);
        for (size_t i = 0; i < points; i++) {
            work->stages[i] = (u[i] + other[i]) / 2;
        }
        gm_gauss_forces(work, problem, NULL);
        gm_gauss_prepare(work, line->dx, gap);
        gm_gauss_forward(work, work->force, work->hat);
        gm_gauss_forward(work, work->stages, work->hat_u);
        for (size_t mode = 0; mode < points; mode++) {
            const double frequency = work->branches[2 * mode > points ? points - mode : mode].frequency;
            work->hat[mode] =
                isinf(frequency) ? 0 : -frequency * frequency * work->hat_u[mode] - work->hat[mode];
        }
        gm_gauss_backward(work, work->hat, work->force);
        for (size_t i = 0; i < points; i++) {
            v[i] = (other[i] - u[i]) / gap - gap / 2 * work->force[i];
        }
    } else {
        for (size_t at = 0; at < count; at++) {
            const double slant = gm_gauss_slant(line, tableau, at / points, at % points);
            const double here = second[at] - gm_field_of(problem)->wave->slope(u[at] + slant);
            const double there = second_other[at] - gm_field_of(problem)->wave->slope(other[at] + slant);
            v[at] = (other[at] - u[at]) / gap - gap * (2 * here + there) / 6;
        }
        gm_gauss_share_mean(v, points);
        correct(work, problem, gap, u, v, task->y + points);
    }
    *filled = 1;
    return GM_OK;
}

static struct gm_progress advance(const struct gm_task *task)
{
    struct gm_gauss_work *work = task->workspace;
    const struct gm_line *line = &task->problem->line;
    const size_t points = work->points, count = work->tableau->n * points, size = count * sizeof(double);
    struct gm_progress progress = {.status = GM_OK};
    memcpy(work->next_u, task->memory, size);
    memcpy(work->next_v, task->memory + count, size);
    for (long k = 0; k < task->steps; k++) {
        memcpy(work->u, work->next_u, size);
        memcpy(work->v, work->next_v, size);
        progress.status = gm_gauss_step(work, task->problem, task->dt, NULL, &progress);
        if (progress.status == GM_OK && !gm_field_within(work->next_u, count, task->limit)) {
            progress.status = GM_BLOW_UP;
        }
        if (progress.status != GM_OK) {
            return progress;
        }
        progress.done++;
    }
    memcpy(task->memory_out, work->next_u, size);
    memcpy(task->memory_out + count, work->next_v, size);
    task->memory_out[2 * count] = 1;
    gm_gauss_to_nodes(work, line, work->next_u, task->out);
    gm_gauss_to_nodes(work, line, work->u, task->out + points);
    task->out[2 * points] = -task->dt;
    return progress;
}

static const struct gm_scheme schemes[] = {
    {
        .name = "gauss-box2",
        .alias = "gauss-box",
        .title = "Gauss box, r = s = 1",
        .formula =
            "u″ = D²u − V′(u),  D(z) = [A⁻¹ − A⁻¹1bᵀA⁻¹/(z − 1 + bᵀA⁻¹1)]/Δx,  midpoint rule in x and t",
        .reference = "S. Reich, J. Comput. Phys. 157 (2000) 473: the box, by Fourier modes",
        .family = &gm_family_gauss_box,
        .coefficients = &midpoint,
        .order = 2,
        .needs = GM_NEEDS_WAVE,
        .claims = GM_MULTISYMPLECTIC | GM_SYMMETRIC,
    },
    {
        .name = "gauss-box3",
        .title = "Gauss box, r = s = 2",
        .formula = "u″ = D²u − V′(u),  D(z) = [A⁻¹ − A⁻¹1bᵀA⁻¹/(z − 1)]/Δx,  two stages of Gauss in x and t",
        .reference = "S. Reich, J. Comput. Phys. 157 (2000) 473; the order is that of the stages",
        .family = &gm_family_gauss_box,
        .coefficients = &gauss4,
        .order = 3,
        .needs = GM_NEEDS_WAVE,
        .claims = GM_MULTISYMPLECTIC | GM_SYMMETRIC,
    },
};

const struct gm_family gm_family_gauss_box = {
    .kind = &gm_kind_field,
    .title = "multisymplectic Gauss collocation",
    .schemes = schemes,
    .count = sizeof schemes / sizeof schemes[0],
    .loop = advance,
    .memory = memory,
    .start = start,
    .workspace_open = gm_gauss_open,
    .workspace_close = gm_gauss_close,
    .form = gm_gauss_form,
};
