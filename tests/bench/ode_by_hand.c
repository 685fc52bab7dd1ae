/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a careful programmer writes for one scheme and one problem. */
#include "tests/bench/ode_by_hand.h"

#include <math.h>
#include <string.h>

#include "core/basics.h"

void gm_hand_kepler_verlet(double *y, double h, long steps)
{
    double q1 = y[0], q2 = y[1], p1 = y[2], p2 = y[3];
    double square = q1 * q1 + q2 * q2, pull = 1 / (square * sqrt(square));
    for (long i = 0; i < steps; i++) {
        p1 -= h / 2 * pull * q1;
        p2 -= h / 2 * pull * q2;
        q1 += h * p1;
        q2 += h * p2;
        square = q1 * q1 + q2 * q2;
        pull = 1 / (square * sqrt(square));
        p1 -= h / 2 * pull * q1;
        p2 -= h / 2 * pull * q2;
    }
    y[0] = q1, y[1] = q2, y[2] = p1, y[3] = p2;
}

static inline void kepler(const double *y, double *f)
{
    const double square = y[0] * y[0] + y[1] * y[1], pull = 1 / (square * sqrt(square));
    f[0] = y[2];
    f[1] = y[3];
    f[2] = -pull * y[0];
    f[3] = -pull * y[1];
}

static inline void vortices(const double *y, double *f)
{
    for (int i = 0; i < 8; i++) {
        f[i] = 0;
    }
    for (int i = 0; i < 4; i++) {
        for (int j = i + 1; j < 4; j++) {
            const double dx = y[i] - y[j], dy = y[4 + i] - y[4 + j];
            const double turn = GM_HAND_STRENGTH / (2 * M_PI) / (dx * dx + dy * dy);
            f[i] -= turn * dy;
            f[j] += turn * dy;
            f[4 + i] += turn * dx;
            f[4 + j] -= turn * dx;
        }
    }
}

#define RK4(name, n, field)                                                                                  \
    void name(double *y, double h, long steps)                                                               \
    {                                                                                                        \
        for (long s = 0; s < steps; s++) {                                                                   \
            double k1[n], k2[n], k3[n], k4[n], at[n];                                                        \
            field(y, k1);                                                                                    \
            for (int c = 0; c < n; c++) {                                                                    \
                at[c] = y[c] + h / 2 * k1[c];                                                                \
            }                                                                                                \
            field(at, k2);                                                                                   \
            for (int c = 0; c < n; c++) {                                                                    \
                at[c] = y[c] + h / 2 * k2[c];                                                                \
            }                                                                                                \
            field(at, k3);                                                                                   \
            for (int c = 0; c < n; c++) {                                                                    \
                at[c] = y[c] + h * k3[c];                                                                    \
            }                                                                                                \
            field(at, k4);                                                                                   \
            for (int c = 0; c < n; c++) {                                                                    \
                y[c] += h / 6 * (k1[c] + 2 * k2[c] + 2 * k3[c] + k4[c]);                                     \
            }                                                                                                \
        }                                                                                                    \
    }
RK4(gm_hand_kepler_rk4, 4, kepler)
RK4(gm_hand_vortices_rk4, 8, vortices)

/* Four vortices in a register: the next one and the one opposite give four pairs and twice two. */
typedef double four __attribute__((vector_size(4 * sizeof(double))));

static inline __attribute__((always_inline)) void velocities(const four *at_x, const four *at_y, four *fx,
                                                             four *fy)
{
    const four x = *at_x, y = *at_y;
    const four dx = x - __builtin_shufflevector(x, x, 1, 2, 3, 0),
               dy = y - __builtin_shufflevector(y, y, 1, 2, 3, 0);
    const four far_dx = x - __builtin_shufflevector(x, x, 2, 3, 0, 1);
    const four far_dy = y - __builtin_shufflevector(y, y, 2, 3, 0, 1);
    const four turn = GM_HAND_STRENGTH / (2 * M_PI) / (dx * dx + dy * dy);
    const four far = GM_HAND_STRENGTH / (2 * M_PI) / (far_dx * far_dx + far_dy * far_dy);
    const four pull_x = dx * turn, pull_y = dy * turn;
    *fx = __builtin_shufflevector(pull_y, pull_y, 3, 0, 1, 2) - pull_y - far_dy * far;
    *fy = pull_x - __builtin_shufflevector(pull_x, pull_x, 3, 0, 1, 2) + far_dx * far;
}

GM_CLONES void gm_hand_vortices_rk4_simd(double *state, double h, long steps)
{
    four x, y;
    memcpy(&x, state, sizeof x);
    memcpy(&y, state + 4, sizeof y);
    for (long s = 0; s < steps; s++) {
        four a1, b1, a2, b2, a3, b3, a4, b4;
        velocities(&x, &y, &a1, &b1);
        four at_x = x + h / 2 * a1, at_y = y + h / 2 * b1;
        velocities(&at_x, &at_y, &a2, &b2);
        at_x = x + h / 2 * a2, at_y = y + h / 2 * b2;
        velocities(&at_x, &at_y, &a3, &b3);
        at_x = x + h * a3, at_y = y + h * b3;
        velocities(&at_x, &at_y, &a4, &b4);
        x += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
        y += h / 6 * (b1 + 2 * b2 + 2 * b3 + b4);
    }
    memcpy(state, &x, sizeof x);
    memcpy(state + 4, &y, sizeof y);
}

static inline __attribute__((always_inline)) double sum_of_magnitudes(four a, four b)
{
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        sum += fabs(a[i]) + fabs(b[i]);
    }
    return sum;
}

/* By iteration from 0, until the change is nothing or, at the level of round-off, no longer decreases, or the next
   one would be 2^-60 of the first. */
GM_CLONES static long midpoint_alike(double *state, double h, long steps)
{
    long evaluations = 0;
    four x, y;
    memcpy(&x, state, sizeof x);
    memcpy(&y, state + 4, sizeof y);
    for (long s = 0; s < steps; s++) {
        const double roundoff = 8 * 0x1p-52 * sum_of_magnitudes(x, y);
        double change = 1e300, before, negligible = 0;
        four a = {0}, b = {0}, fx, fy;
        bool last = false;
        do {
            before = change;
            const four at_x = x + a, at_y = y + b;
            velocities(&at_x, &at_y, &fx, &fy);
            evaluations++;
            const four next_a = h / 2 * fx, next_b = h / 2 * fy;
            change = sum_of_magnitudes(next_a - a, next_b - b);
            negligible = before == 1e300 ? 0x1p-60 * change : negligible;
            last = change >= before || change * change <= negligible * before;
            a = next_a;
            b = next_b;
        } while (change != 0 && !(last && change <= roundoff));
        x += h * fx;
        y += h * fy;
    }
    memcpy(state, &x, sizeof x);
    memcpy(state + 4, &y, sizeof y);
    return evaluations;
}

/* By iteration from the increments of the step before, until they stay. */
GM_CLONES static long midpoint_from_last(double *state, double h, long steps)
{
    const double enough = 1e-16;
    long evaluations = 1;
    four x, y, a, b;
    memcpy(&x, state, sizeof x);
    memcpy(&y, state + 4, sizeof y);
    velocities(&x, &y, &a, &b);
    for (long s = 0; s < steps; s++) {
        double change = INFINITY, before;
        do {
            evaluations++;
            four fx, fy;
            before = change;
            const four at_x = x + h / 2 * a, at_y = y + h / 2 * b;
            velocities(&at_x, &at_y, &fx, &fy);
            const four da = fx - a, db = fy - b, square = da * da + db * db;
            change = h * h * (square[0] + square[1] + square[2] + square[3]);
            a = fx;
            b = fy;
        } while (change > enough * enough && change < before);
        x += h * a;
        y += h * b;
    }
    memcpy(state, &x, sizeof x);
    memcpy(state + 4, &y, sizeof y);
    return evaluations;
}

long gm_hand_vortices_midpoint_simd(double *state, double h, long steps, bool alike)
{
    return alike ? midpoint_alike(state, h, steps) : midpoint_from_last(state, h, steps);
}

/* A plain loop over the ensemble, step by step. */
void gm_hand_ensemble_kepler_verlet(double *y, size_t m, double h, long steps)
{
    double *restrict q1 = y, *restrict q2 = y + m, *restrict p1 = y + 2 * m, *restrict p2 = y + 3 * m;
    for (long s = 0; s < steps; s++) {
        for (size_t i = 0; i < m; i++) {
            double square = q1[i] * q1[i] + q2[i] * q2[i], pull = h / 2 / (square * sqrt(square));
            const double u = p1[i] - pull * q1[i], v = p2[i] - pull * q2[i];
            q1[i] += h * u;
            q2[i] += h * v;
            square = q1[i] * q1[i] + q2[i] * q2[i], pull = h / 2 / (square * sqrt(square));
            p1[i] = u - pull * q1[i];
            p2[i] = v - pull * q2[i];
        }
    }
}

void gm_hand_ensemble_oscillator_verlet(double *y, size_t m, double h, long steps)
{
    double *restrict q = y, *restrict p = y + m;
    for (long s = 0; s < steps; s++) {
        for (size_t i = 0; i < m; i++) {
            const double v = p[i] - h / 2 * q[i];
            q[i] += h * v;
            p[i] = v - h / 2 * q[i];
        }
    }
}

void gm_hand_ensemble_oscillator_rk4(double *y, size_t m, double h, long steps)
{
    double *restrict q = y, *restrict p = y + m;
    for (long s = 0; s < steps; s++) {
        for (size_t i = 0; i < m; i++) {
            const double a1 = p[i], b1 = -q[i], a2 = p[i] + h / 2 * b1, b2 = -(q[i] + h / 2 * a1);
            const double a3 = p[i] + h / 2 * b2, b3 = -(q[i] + h / 2 * a2), a4 = p[i] + h * b3,
                         b4 = -(q[i] + h * a3);
            q[i] += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
            p[i] += h / 6 * (b1 + 2 * b2 + 2 * b3 + b4);
        }
    }
}

GM_CLONES void gm_hand_pair_sum(const double *state, double *f, size_t count)
{
    const double *restrict x = state, *restrict y = state + count;
    double *restrict sum_y = f, *restrict sum_x = f + count;
    memset(f, 0, 2 * count * sizeof *f);
    for (size_t i = 0; i < count; i++) {
        const double x_i = x[i], y_i = y[i];
        double mine_x = 0, mine_y = 0;
#pragma omp simd reduction(+ : mine_x, mine_y)
        for (size_t j = i + 1; j < count; j++) {
            const double dx = x_i - x[j], dy = y_i - y[j], inverse = 1 / (dx * dx + dy * dy);
            mine_x += dx * inverse;
            mine_y += dy * inverse;
            sum_x[j] -= dx * inverse;
            sum_y[j] -= dy * inverse;
        }
        sum_x[i] += mine_x;
        sum_y[i] += mine_y;
    }
    for (size_t i = 0; i < count; i++) {
        sum_y[i] = -sum_y[i];
    }
}
