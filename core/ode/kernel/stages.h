/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stages of a Runge-Kutta method as equations for Newton's method. The loops over kernels include this too, so all
   of it is inline. */
#ifndef GM_CORE_ODE_KERNEL_STAGES_H
#define GM_CORE_ODE_KERNEL_STAGES_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "core/linear/iteration.h"

enum { GM_TABLEAU_STAGES = 16 };

/* The stages Y_i = y + z_i, z_i = h sum_j a_ij f(Y_j), of `count` with n components each. */
struct gm_stages {
    size_t count, n;
    double h;
    const double *y;
    const double (*a)[GM_TABLEAU_STAGES], *b;
    const double (*c)[GM_TABLEAU_STAGES], *d; /* c and d replace a and b for components from n / 2 on */
    /* writes f at the state of stage j, and its Jacobian by rows unless that is NULL; false: not defined */
    bool (*slope)(void *data, size_t j, const double *state, double *f, double *jacobian);
    void *data;
    double *f, *state, *jacobian; /* scratch: count * n, n and n * n */
    struct gm_progress *progress;
};

/* gm_implicit_equations.sweep; data is a gm_stages */
static inline bool gm_stages_sweep(void *data, const double *z, double *next, double *scale)
{
    const struct gm_stages *stages = data;
    const size_t n = stages->n;
    for (size_t j = 0; j < stages->count; j++) {
        for (size_t c = 0; c < n; c++) {
            stages->state[c] = stages->y[c] + z[j * n + c];
            *scale += fabs(stages->y[c]) + fabs(z[j * n + c]);
        }
        if (!stages->slope(stages->data, j, stages->state, stages->f + j * n, NULL)) {
            return false;
        }
    }
    stages->progress->evaluations += stages->count;
    for (size_t i = 0; i < stages->count; i++) {
        for (size_t c = 0; c < n; c++) {
            const double *row = c < n / 2 ? stages->a[i] : stages->c[i];
            double sum = 0;
            for (size_t j = 0; j < stages->count; j++) {
                sum += stages->h * row[j] * stages->f[j * n + c];
            }
            next[i * n + c] = sum;
        }
    }
    return true;
}

/* gm_implicit_equations.linear; data is a gm_stages */
static inline __attribute__((always_inline)) bool
gm_stages_linear(void *data, const double *z, double *residual, double *matrix, double *scale)
{
    const struct gm_stages *stages = data;
    const size_t n = stages->n, count = stages->count, size = count * n;
    const double h = stages->h, (*const sides[])[GM_TABLEAU_STAGES] = {stages->a, stages->c};
    double *restrict state = stages->state;
    for (size_t j = 0; j < count; j++) {
        for (size_t c = 0; c < n; c++) {
            state[c] = stages->y[c] + z[j * n + c];
            *scale += fabs(stages->y[c]) + fabs(z[j * n + c]);
        }
        if (!stages->slope(stages->data, j, state, stages->f + j * n, stages->jacobian)) {
            return false;
        }
        for (size_t i = 0; i < count; i++) {
            for (size_t r = 0; r < n; r++) {
                const double factor = h * sides[r >= n / 2][i][j];
                const double *restrict row = stages->jacobian + r * n;
                double *restrict to = matrix + (i * n + r) * size + j * n;
                for (size_t c = 0; c < n; c++) {
                    to[c] = -(factor * row[c]);
                }
                to[r] += i == j ? 1 : 0;
            }
        }
    }
    stages->progress->evaluations += stages->count;
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 0; c < n; c++) {
            const double *row = sides[c >= n / 2][i];
            double sum = -z[i * n + c];
            for (size_t j = 0; j < count; j++) {
                sum += h * row[j] * stages->f[j * n + c];
            }
            residual[i * n + c] = sum;
        }
    }
    return true;
}

/* Finds the weights w with sum w_k z_k = h sum b_i f_i, z = h A f: A' w = b; a stiffly accurate method has
   z_s itself. After Newton's method steps are made of z: f(y + z) would multiply the rest of its last change
   by h J. Returns false if A is singular, or nearly so. */
static inline bool gm_weights_of_stages(size_t stages, const double a[][GM_TABLEAU_STAGES], const double *b,
                                        double *weights)
{
    double matrix[GM_TABLEAU_STAGES * GM_TABLEAU_STAGES];
    if (memcmp(a[stages - 1], b, stages * sizeof *b) == 0) {
        memset(weights, 0, stages * sizeof *b);
        weights[stages - 1] = 1;
        return true;
    }
    for (size_t i = 0; i < stages; i++) {
        for (size_t j = 0; j < stages; j++) {
            matrix[i * stages + j] = a[j][i];
        }
    }
    memcpy(weights, b, stages * sizeof *b);
    return gm_eliminate(stages, matrix, weights) && gm_sum_of(weights, stages) < 0x1p10;
}

/* increment := h sum b_i f_i; if z, from Newton's method, is not NULL, it is made of z when the weights
   allow. */
static inline void gm_stages_increment(const struct gm_stages *stages, const double *z, double *increment)
{
    const size_t n = stages->n;
    double weights[GM_TABLEAU_STAGES];
    bool by_z = false;
    for (size_t c = 0; c < n; c++) {
        const bool second = c >= n / 2;
        const double *b = second ? stages->d : stages->b;
        if (z && (c == 0 || (c == n / 2 && stages->c != stages->a))) {
            by_z = gm_weights_of_stages(stages->count, second ? stages->c : stages->a, b, weights);
        }
        increment[c] = 0;
        for (size_t i = 0; i < stages->count; i++) {
            increment[c] += by_z ? weights[i] * z[i * n + c] : stages->h * b[i] * stages->f[i * n + c];
        }
    }
}

#endif
