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
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/field/families/boxes/modes.h"
#include "core/field/families/families.h"
#include "core/field/multisymplectic.h"
#include "core/linear/differences.h"

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    return 2 * ((const struct gm_collocation_tableau *)scheme->coefficients)->r * problem->line.points + 1;
}

/* Corrects v so that a step leads to the other level as well as to the order of the scheme. */
static void correct(struct gm_gauss_work *work, const struct gm_problem *problem, double gap, const double *u,
                    double *v, const double *other_nodes)
{
    enum { TIMES = 2 };
    const size_t count = work->tableau->r * work->points, size = count * sizeof *u;
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
    const struct gm_grid1 *grid = &problem->line;
    const struct gm_collocation_tableau *tableau = task->scheme->coefficients;
    const size_t points = grid->points, r = tableau->r, count = r * points;
    const double gap = task->y[2 * points];
    double *u = task->memory_out, *v = u + count, *filled = v + count;
    struct gm_gauss_work *work = task->workspace;
    if (*filled == 1) {
        return GM_OK;
    }
    double *second = work->next_u, *other = work->v, *second_other = work->next_v;
    gm_gauss_to_stages(work, grid, task->y, u, second);
    gm_gauss_to_stages(work, grid, task->y + points, other, second_other);
    if (r == 1) {
        memcpy(work->u, u, count * sizeof *u);
        for (size_t i = 0; i < points; i++) {
            work->stages[i] = (u[i] + other[i]) / 2;
        }
        gm_gauss_forces(work, problem, NULL);
        gm_gauss_prepare(work, grid->dx, gap);
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
            const double slant = gm_gauss_slant(grid, tableau, at / points, at % points);
            const double here = second[at] - gm_field_of(problem)->wave->slope(problem, u[at] + slant);
            const double there =
                second_other[at] - gm_field_of(problem)->wave->slope(problem, other[at] + slant);
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
    const struct gm_grid1 *grid = &task->problem->line;
    const size_t points = work->points, count = work->tableau->r * points, size = count * sizeof(double);
    struct gm_progress progress = {.status = GM_OK};
    memcpy(work->next_u, task->memory, size);
    memcpy(work->next_v, task->memory + count, size);
    for (int64_t k = 0; k < task->steps; k++) {
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
    gm_gauss_to_nodes(work, grid, work->next_u, task->out);
    gm_gauss_to_nodes(work, grid, work->u, task->out + points);
    task->out[2 * points] = -task->dt;
    return progress;
}

/* u_t^2/2 + u_x^2/2 + V(u) at the stages of the cells; the square of the slope branch by branch. */
static double wave_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y,
                          const double *memory)
{
    (void)y;
    const struct gm_grid1 *grid = &problem->line;
    struct gm_gauss_work *work = gm_gauss_open(problem, scheme);
    if (!work) {
        return NAN;
    }
    const size_t points = work->points, r = work->tableau->r;
    const double *u = memory, *v = u + r * points;
    double sum = grid->jump * grid->jump / (2 * grid->dx * grid->dx * (double)points), slopes = 0;
    gm_gauss_prepare(work, grid->dx, grid->dx);
    for (size_t m = 0; m < r; m++) {
        gm_gauss_forward(work, u + m * points, work->hat_u + m * points);
    }
    for (size_t at = 0; at < (points / 2 + 1) * r; at++) {
        const struct gm_gauss_branch *branch = &work->branches[at];
        const size_t mode = at / r;
        if (!isinf(branch->frequency)) {
            const double slope =
                branch->frequency * cabs(gm_gauss_amplitude(branch, r, points, mode, work->hat_u));
            slopes += (mode > 0 && 2 * mode < points ? 2 : 1) * slope * slope;
        }
    }
    sum += slopes / (double)(2 * r * points);
    for (size_t at = 0; at < r * points; at++) {
        const double slant = gm_gauss_slant(grid, work->tableau, at / points, at % points);
        sum += work->tableau->b[at / points] *
               (v[at] * v[at] / 2 + gm_field_of(problem)->wave->potential(problem, u[at] + slant));
    }
    gm_gauss_close(work);
    return grid->dx * sum;
}

/* The discrete multisymplectic law: two tangents of a step, with their faces in time and space. */

/* What the law needs of one tangent, which work holds before and after its step: u and v at the stages of the
   cells, and u and w at their sides, at the stages in time. The slope of w is u'' + V''(m) u, work->hat_v: where
   a branch has infinite frequency it is that of w alone, and on those of high frequency it tells u and w better
   than u, whose round-off the way to the sides would multiply by the cube of the number of cells. */
static void find_faces(struct gm_gauss_work *work, double dx, const double *curvature, struct gm_faces *faces)
{
    enum { U, V, W, DIMENSION };
    const double high = 4;
    const struct gm_collocation_tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->r;
    for (size_t i = 0; i < points; i++) {
        for (size_t m = 0; m < r; m++) {
            double *lower = faces->lower + (i * r + m) * DIMENSION;
            double *upper = faces->upper + (i * r + m) * DIMENSION;
            lower[U] = work->u[m * points + i];
            lower[V] = work->v[m * points + i];
            upper[U] = work->next_u[m * points + i];
            upper[V] = work->next_v[m * points + i];
        }
    }
    for (size_t j = 0; j < r; j++) {
        const double *stages = work->stages + j * r * points, *bend = curvature + j * r * points;
        for (size_t m = 0; m < r; m++) {
            for (size_t i = 0; i < points; i++) {
                faces->scratch[i] =
                    work->force[(j * r + m) * points + i] + bend[m * points + i] * stages[m * points + i];
            }
            gm_gauss_forward(work, faces->scratch, work->hat_v + m * points);
            gm_gauss_forward(work, stages + m * points, work->hat_u + m * points);
        }
        for (size_t mode = 0; mode <= points / 2; mode++) {
            const double angle = gm_gauss_angle(mode, points);
            double complex of_u = 0, of_w = 0;
            for (size_t e = 0; e < r; e++) {
                const struct gm_gauss_branch *branch = &work->branches[mode * r + e];
                /* b' A^-1 of the vector / (z - 1 + rho) */
                const double complex side =
                    r == 1      ? 2 / (cexp(I * angle) + 1)
                    : mode == 0 ? branch->vector[0]
                                : GM_ROOT3 * (branch->vector[1] - branch->vector[0]) / (cexp(I * angle) - 1);
                const double complex push = gm_gauss_amplitude(branch, r, points, mode, work->hat_v);
                if (isinf(branch->frequency)) {
                    /* -dx A of the balancing slope of w */
                    of_w -= dx * push *
                            (r == 1 ? tableau->a[0][0]
                                    : tableau->a[0][0] * branch->vector[0] +
                                          tableau->a[0][1] * branch->vector[1]);
                    continue;
                }
                const double square = branch->frequency * branch->frequency;
                const double complex u = square * dx * dx > high
                                             ? -push / square
                                             : gm_gauss_amplitude(branch, r, points, mode, work->hat_u);
                of_u += side * u;
                of_w += side * I * branch->frequency * u;
            }
            work->hat[mode] = of_u;
            work->hat[points + mode] = of_w;
            if (mode > 0 && 2 * mode < points) {
                work->hat[points - mode] = conj(of_u);
                work->hat[2 * points - mode] = conj(of_w);
            }
        }
        gm_gauss_backward(work, work->hat, faces->scratch);
        for (size_t i = 0; i <= points; i++) {
            faces->sides[(i * r + j) * DIMENSION + U] = faces->scratch[i < points ? i : 0];
        }
        gm_gauss_backward(work, work->hat + points, faces->scratch);
        for (size_t i = 0; i <= points; i++) {
            faces->sides[(i * r + j) * DIMENSION + W] = faces->scratch[i < points ? i : 0];
        }
    }
}

/* A step of the loop, as gm_map: u and v at the stages of the cells to the same. */
struct base {
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    double dt;
    struct gm_gauss_work *work;
    const double *y;
};

static bool one_step(const void *context, const double *from, double *to)
{
    const struct base *base = context;
    const size_t count = 2 * base->work->tableau->r * base->work->points;
    double *memory = malloc((base->problem->n + 2 * (count + 1)) * sizeof *memory);
    if (!memory) {
        return false;
    }
    double *given = memory + base->problem->n, *made = given + count + 1;
    memcpy(given, from, count * sizeof *given);
    const struct gm_task task = {
        .problem = base->problem,
        .scheme = base->scheme,
        .dt = base->dt,
        .steps = 1,
        .limit = INFINITY,
        .y = base->y,
        .out = memory,
        .memory = given,
        .memory_out = made,
        .workspace = base->work,
    };
    const bool good = base->scheme->family->loop(&task).status == GM_OK;
    memcpy(to, made, count * sizeof *to);
    free(memory);
    return good;
}

/* Advances a tangent from u and v of its start (count numbers) and finds its faces. */
static bool advance_tangent(const struct base *base, const double *memory, const double *curvature,
                            bool by_differences, const double *start, struct gm_faces *faces)
{
    struct gm_gauss_work *work = base->work;
    const size_t half = work->tableau->r * work->points, size = half * sizeof(double);
    struct gm_problem straight = *base->problem;
    straight.line.jump = 0;
    struct gm_progress uncounted = {.status = GM_OK};
    double *end = malloc(2 * size);
    bool good = end != NULL;
    good =
        good && (!by_differences || gm_differentiate(one_step, base, 2 * half, memory, start, 2 * half, end));
    memcpy(work->u, start, size);
    memcpy(work->v, start + half, size);
    good = good && gm_gauss_step(work, &straight, base->dt, curvature, &uncounted) == GM_OK;
    if (good && by_differences) {
        memcpy(work->next_u, end, size);
        memcpy(work->next_v, end + half, size);
    }
    if (good) {
        find_faces(work, base->problem->line.dx, curvature, faces);
    }
    free(end);
    return good;
}

static double form(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                   const double *y, const double *memory, bool by_differences)
{
    const struct gm_collocation_tableau *tableau = scheme->coefficients;
    const size_t points = problem->line.points, r = tableau->r, half = r * points, q = r * r;
    const struct gm_lattice cells = {points, r, r, tableau->b, tableau->b, problem->line.dx, dt};
    struct gm_gauss_work *work = gm_gauss_open(problem, scheme);
    struct gm_faces faces[2] = {{0}};
    double *arrays = malloc((q * points + 2 * half) * sizeof *arrays), residual = NAN;
    const struct base base = {problem, scheme, dt, work, y};
    struct gm_progress uncounted = {.status = GM_OK};
    bool good = work && arrays;
    for (size_t k = 0; k < 2; k++) {
        good &= gm_faces_open(&faces[k], gm_field_of(problem)->form, &cells);
    }
    if (good) {
        double *curvature = arrays, *start = arrays + q * points;
        memcpy(work->u, memory, half * sizeof *arrays);
        memcpy(work->v, memory + half, half * sizeof *arrays);
        good = gm_gauss_step(work, problem, dt, NULL, &uncounted) == GM_OK;
        for (size_t at = 0; at < q * points; at++) {
            const double slant = gm_gauss_slant(&problem->line, tableau, at / points % r, at % points);
            curvature[at] = gm_field_of(problem)->wave->curvature(problem, work->stages[at] + slant);
        }
        for (size_t k = 0; good && k < 2; k++) {
            for (size_t m = 0; m < 2 * r; m++) {
                const double shift = tableau->c[m % r];
                gm_tangent_start(start + m * points, points, 2 + (double)k,
                                 0.3 + 0.4 * (double)k + (double)(m / r) +
                                     2 * M_PI * (2 + (double)k) * shift / (double)points);
            }
            good = advance_tangent(&base, memory, curvature, by_differences, start, &faces[k]);
        }
        if (good) {
            residual = gm_lattice_law(gm_field_of(problem)->form, &cells, &faces[0], &faces[1]);
        }
    }
    gm_faces_close(&faces[0]);
    gm_faces_close(&faces[1]);
    free(arrays);
    if (work) {
        gm_gauss_close(work);
    }
    return residual;
}

static const struct gm_scheme schemes[] = {
    {
        .name = "gauss-box2",
        .alias = "gauss-box",
        .title = "Gauss box, r = s = 1",
        .formula =
            "u″ = D²u − V′(u),  D(z) = [A⁻¹ − A⁻¹1bᵀA⁻¹/(z − 1 + bᵀA⁻¹1)]/Δx,  midpoint rule in x and t",
        .reference = "S. Reich, J. Comput. Phys. 157 (2000) 473: the box, by Fourier modes",
        .family = &gm_family_gauss,
        .coefficients = &gm_collocation_midpoint,
        .order = 2,
        .needs = GM_NEEDS_WAVE,
        .claims = GM_MULTISYMPLECTIC | GM_SYMMETRIC,
    },
    {
        .name = "gauss-box3",
        .title = "Gauss box, r = s = 2",
        .formula = "u″ = D²u − V′(u),  D(z) = [A⁻¹ − A⁻¹1bᵀA⁻¹/(z − 1)]/Δx,  two stages of Gauss in x and t",
        .reference = "S. Reich, J. Comput. Phys. 157 (2000) 473; the order is that of the stages",
        .family = &gm_family_gauss,
        .coefficients = &gm_collocation_gauss4,
        .order = 3,
        .needs = GM_NEEDS_WAVE,
        .claims = GM_MULTISYMPLECTIC | GM_SYMMETRIC,
    },
};

const struct gm_family gm_family_gauss = {
    .kind = &gm_kind_field,
    .title = "multisymplectic Gauss collocation",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .loop = advance,
    .memory = memory,
    .start = start,
    .workspace_open = gm_gauss_open,
    .workspace_close = gm_gauss_close,
    .form = form,
    .wave_energy = wave_energy,
};
