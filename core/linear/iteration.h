/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implicit equations z = G(z) of a few unknowns: by sweeps z := G(z), and by Newton's method. The loops over
   kernels include this too, so what they need of it is inline. */
#ifndef GM_CORE_LINEAR_ITERATION_H
#define GM_CORE_LINEAR_ITERATION_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "core/linear/settled.h"
#include "core/problem.h"

#define ENTRY double
#define DIVIDE(a, b) ((a) / (b))
#define MAGNITUDE fabs
#define ELIMINATE gm_eliminate_columns
#include "core/linear/eliminate.loop.h"

/* Solves a x = r for one right side. */
static inline bool gm_eliminate(size_t n, double *a, double *r)
{
    return gm_eliminate_columns(n, a, 1, r);
}

/* residual := G(z) - z, and matrix := 1 - G'(z) by rows, or both times the same matrix. Adds to *scale the
   size with which changes are compared. Returns false if G or G' has no value at z. */
typedef bool gm_linear_equations(void *data, const double *z, double *residual, double *matrix,
                                 double *scale);

/* next := G(z); adds to *scale as above. Returns false if G has no value at z. */
typedef bool gm_swept_equations(void *data, const double *z, double *next, double *scale);

struct gm_implicit_equations {
    size_t size; /* unknowns */
    void *data;  /* data of the two functions */
    gm_swept_equations *sweep;
    gm_linear_equations *linear; /* NULL: sweeps alone */
    size_t counted; /* the first of these, whose changes Newton's method compares; sweeps compare all */
    /* If z are increments of stages y + z of n components each, Newton's method ends by
       gm_newton_is_settled. */
    const double *y; /* NULL: z are not increments */
    size_t n;
    /* Otherwise it ends by gm_is_settled, as sweeps do, or when a change is at most `least` of |z|. */
    double least, roundoff; /* the level of round-off is this part of the scale */
    bool halved;            /* steps of Newton's method are halved until the residual is no larger */
    bool exact;             /* the equations are linear: one step solves them */
};

/* The scratch of one of the solvers below, in numbers. Afterwards it begins with the last change of z. */
static inline size_t gm_newton_scratch(size_t size)
{
    return size * (size + 3);
}

/* The sum of |h a_ij J_cd Y_jd|, the terms of h f that rounding acts on, from the matrix I - h a_ij J(Y_j)
   and the stages Y_j = y + z_j, of n components each. */
static inline double gm_rounding_of_stages(size_t size, size_t n, const double *matrix, const double *y,
                                           const double *z)
{
    double sum = 0;
    for (size_t j = 0; j < size; j += n) {
        for (size_t c = j; c < j + n; c++) {
            double terms = 0;
            for (size_t i = 0; i < size; i++) {
                terms += fabs((i == c) - matrix[i * size + c]);
            }
            sum += terms * fabs(y[c - j] + z[c]);
        }
    }
    return sum;
}

/* The sum of magnitudes. */
static inline double gm_sum_of(const double *values, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += fabs(values[i]);
    }
    return sum;
}

/* Returns why a matrix with this number of entries was not eliminated. */
static inline enum gm_obstacle gm_obstacle_of(size_t entries, const double *matrix)
{
    return isfinite(gm_sum_of(matrix, entries)) ? GM_SINGULAR : GM_NOT_FINITE;
}

enum { GM_SWEEPS_MOST = 150, GM_NEWTON_STEPS = 50, GM_NEWTON_HALVINGS = 40 };

/* z := z + change, or a part of that where the residual there would be larger than *off; of a small change it
   may be. The residual, *off its 1-norm, and the matrix are those there. */
static inline __attribute__((always_inline)) bool
gm_newton_move(const struct gm_implicit_equations *equations, double *restrict scratch, double *restrict z,
               bool small, double *off, double *scale)
{
    const size_t size = equations->size;
    double *residual = scratch, *matrix = residual + size, *change = matrix + size * size,
           *start = change + size, part = 1, there = 0;
    bool good = false, nearer = false;
    for (size_t i = 0; i < size; i++) {
        change[i] = residual[i];
        start[i] = z[i];
    }
    for (int halving = 0; halving < GM_NEWTON_HALVINGS && !nearer; halving++, part /= 2) {
        for (size_t i = 0; i < size; i++) {
            z[i] = start[i] + part * change[i];
        }
        *scale = 0;
        good = equations->linear(equations->data, z, residual, matrix, scale);
        there = gm_sum_of(residual, size);
        nearer = good && (there <= *off || (small && isfinite(there)));
    }
    *off = there;
    return good;
}

/* Sweeps from z to the solution. Returns false if they diverge, or contract too slowly and `linear` is
   given; *progress has the reason. Of equations that the compiler knows the functions are inlined. */
static inline __attribute__((always_inline)) bool
gm_sweeps_solve(const struct gm_implicit_equations *equations, double *restrict scratch, double *restrict z,
                struct gm_progress *progress)
{
    double *next = scratch, previous = INFINITY, before_previous = INFINITY;
    for (int iteration = 0; iteration < GM_SWEEPS_MOST; iteration++) {
        double scale = 0, change = 0;
        if (!equations->sweep(equations->data, z, next, &scale)) {
            return false;
        }
        for (size_t i = 0; i < equations->size; i++) {
            change += fabs(next[i] - z[i]);
            z[i] = next[i];
        }
        progress->iterations++;
        const double roundoff = equations->roundoff * scale, before = previous;
        if (gm_is_settled(change, roundoff, &previous)) {
            return true;
        }
        progress->unsolved = gm_unsolved_by(change, scale);
        if (!(change < 1e100) ||
            (equations->linear && !GM_SWEEPS_CONTRACT(change, before_previous, roundoff))) {
            return false;
        }
        before_previous = before;
    }
    return false;
}

/* Solves the equations by Newton's method. */
static inline __attribute__((always_inline)) bool
gm_newton_solve(const struct gm_implicit_equations *equations, double *restrict scratch, double *restrict z,
                struct gm_progress *progress)
{
    const size_t size = equations->size, n = equations->n;
    double *change = scratch, *matrix = change + size, previous = INFINITY, scale = 0, off = INFINITY;
    for (int iteration = 0; iteration < GM_NEWTON_STEPS; iteration++) {
        if (iteration == 0 || !equations->halved) {
            scale = 0;
            if (!equations->linear(equations->data, z, change, matrix, &scale)) {
                return false;
            }
            off = equations->halved ? gm_sum_of(change, size) : 0;
        }
        const bool of_stages = equations->y != NULL;
        const double rounding = of_stages && gm_rounding_decides(scale, previous)
                                    ? gm_rounding_of_stages(size, n, matrix, equations->y, z)
                                    : 0;
        progress->iterations++;
        progress->solves++;
        if (!gm_eliminate(size, matrix, change)) {
            progress->unsolved.obstacle = gm_obstacle_of(size * size, matrix);
            return false;
        }
        double moved = 0, far = 0;
        for (size_t i = 0; i < equations->counted; i++) {
            moved += fabs(change[i]);
            far += of_stages ? 0 : fabs(z[i]);
            z[i] = equations->halved ? z[i] : z[i] + change[i];
        }
        for (size_t i = equations->counted; i < size && !equations->halved; i++) {
            z[i] += change[i];
        }
        const bool settled = of_stages
                                 ? gm_newton_is_settled(size, moved, scale, rounding, &previous)
                                 : (equations->exact && isfinite(moved)) || moved <= equations->least * far ||
                                       gm_is_settled(moved, equations->roundoff * scale, &previous);
        for (size_t i = 0; i < size && settled && equations->halved; i++) {
            z[i] += change[i];
        }
        if (settled) {
            return true;
        }
        progress->unsolved = gm_unsolved_by(moved, scale);
        if (!isfinite(moved) ||
            (equations->halved &&
             !gm_newton_move(equations, scratch, z, moved <= 0x1p-26 * scale, &off, &scale))) {
            return false;
        }
    }
    return false;
}

#endif
