/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The discrete multisymplectic law of Gauss-Legendre collocation (gauss_box.c): two tangents of a step, with
   their faces in time and space. */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/field/families/gauss_box.h"
#include "core/field/multisymplectic.h"
#include "core/linear/differences.h"

/* What the law needs of one tangent, which work holds before and after its step: u and v at the stages of the
   cells, and u and w at their sides, at the stages in time. Where a branch has infinite frequency the force
   on it (work->hat_v holds its part at the first stage) is balanced by w. */
static void find_faces(struct gm_gauss_work *work, double dx, const double *curvature, struct gm_faces *faces)
{
    enum { U, V, W, DIMENSION };
    const struct gm_gauss_tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->n;
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
                work->force[i] = bend[m * points + i] * stages[m * points + i];
            }
            gm_gauss_forward(work, work->force, work->hat_v + m * points);
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
                if (isinf(branch->frequency)) {
                    const double complex push = gm_gauss_amplitude(branch, r, points, mode, work->hat_v);
                    /* -dx A of the balancing slope of w */
                    of_w -= dx * push *
                            (r == 1 ? tableau->a[0][0]
                                    : tableau->a[0][0] * branch->vector[0] +
                                          tableau->a[0][1] * branch->vector[1]);
                    continue;
                }
                const double complex u = gm_gauss_amplitude(branch, r, points, mode, work->hat_u);
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
        gm_gauss_backward(work, work->hat, work->force);
        for (size_t i = 0; i <= points; i++) {
            faces->sides[(i * r + j) * DIMENSION + U] = work->force[i < points ? i : 0];
        }
        gm_gauss_backward(work, work->hat + points, work->force);
        for (size_t i = 0; i <= points; i++) {
            faces->sides[(i * r + j) * DIMENSION + W] = work->force[i < points ? i : 0];
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
    const size_t count = 2 * base->work->tableau->n * base->work->points;
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
    const size_t half = work->tableau->n * work->points, size = half * sizeof(double);
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

double gm_gauss_form(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                     const double *y, const double *memory, bool by_differences)
{
    const struct gm_gauss_tableau *tableau = scheme->coefficients;
    const size_t points = problem->line.points, r = tableau->n, half = r * points, q = r * r;
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
            curvature[at] = gm_field_of(problem)->wave->curvature(work->stages[at] + slant);
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
