/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The implicit Runge-Kutta family over a problem's kernels, for one pass; see core/ode/compiled/pass.h. */

enum { K(IMPLICIT_ITERATIONS) = 150 };

/* Updates components [from, to) of the increments, z := h a f in the active lanes. Returns the sum of the
   changes: a sum passes a NaN on, a maximum may lose it. */
GM_INLINE real K(implicit_update)(const struct gm_tableau *row, int stages, int from, int to, double h,
                                  mask active, real f[][GM_COMPONENTS], real z[][GM_COMPONENTS])
{
    real change = K(constant)(0);
    for (int i = 0; i < stages; i++) {
        for (int c = from; c < to; c += GM_AT_ONCE) {
            some next = h * row->a[i][0] * K(take)(&f[0][c]);
            for (int j = 1; j < stages; j++) {
                next += h * row->a[i][j] * K(take)(&f[j][c]);
            }
            const some last = K(take)(&z[i][c]);
            change = K(add_magnitudes)(change, next - last);
            K(put)(&z[i][c], K(pick_some)(active, next, last));
        }
    }
    return change;
}

/* Components [from, to) of slope i, in the lanes that are active. */
GM_INLINE void K(implicit_take)(int from, int to, mask active, const real *slope, real *f)
{
    for (int c = from; c < to; c += GM_AT_ONCE) {
        K(put)(&f[c], K(pick_some)(active, K(take)(&slope[c - from]), K(take)(&f[c])));
    }
}

/* One iteration: new slopes at y + z, and new z from them. If q' depends on p alone and p' on q alone, p' is
   taken at the new q, which doubles the order in h that an iteration gains. */
GM_INLINE real K(implicit_iterate)(const struct gm_tableau *row, int stages, const real *y, double h,
                                   const void *parameters, mask active, real f[][GM_COMPONENTS],
                                   real z[][GM_COMPONENTS])
{
#ifdef GM_SEPARABLE
    enum { HALF = GM_COMPONENTS / 2 };
    for (int i = 0; i < stages; i++) {
        real p[HALF], velocity[HALF];
        for (int c = 0; c < HALF; c += GM_AT_ONCE) {
            K(put)(&p[c], K(take)(&y[HALF + c]) + K(take)(&z[i][HALF + c]));
        }
        K(velocity)(p, velocity, parameters);
        K(implicit_take)(0, HALF, active, velocity, f[i]);
    }
    const real change = K(implicit_update)(row, stages, 0, HALF, h, active, f, z);
    for (int i = 0; i < stages; i++) {
        real q[HALF], force[HALF];
        for (int c = 0; c < HALF; c += GM_AT_ONCE) {
            K(put)(&q[c], K(take)(&y[c]) + K(take)(&z[i][c]));
        }
        K(force)(q, force, parameters);
        K(implicit_take)(HALF, GM_COMPONENTS, active, force, f[i]);
    }
    return change + K(implicit_update)(row, stages, HALF, GM_COMPONENTS, h, active, f, z);
#else
    for (int i = 0; i < stages; i++) {
        real stage[GM_COMPONENTS], slope[GM_COMPONENTS];
        for (int c = 0; c < GM_COMPONENTS; c += GM_AT_ONCE) {
            K(put)(&stage[c], K(take)(&y[c]) + K(take)(&z[i][c]));
        }
        K(field)(stage, slope, parameters);
        K(implicit_take)(0, GM_COMPONENTS, active, slope, f[i]);
    }
    return K(implicit_update)(row, stages, 0, GM_COMPONENTS, h, active, f, z);
#endif
}

/* Solves for the slopes f_i = f(y + z_i) of the lanes by fixed-point iteration, from z = 0, until the change
   of z is at its end, or does not shrink as it should. A lane that is done is frozen, so its bits do not depend
   on the others. Returns the lanes that were solved. */
GM_INLINE mask K(implicit_fixed_point)(const struct gm_tableau *row, int stages, const real *y, double h,
                                       const void *parameters, real f[][GM_COMPONENTS],
                                       real z[][GM_COMPONENTS], struct K(counts) * counts)
{
    for (int c = 0; c < GM_COMPONENTS; c += GM_AT_ONCE) {
        for (int i = 0; i < stages; i++) {
            K(put)(&z[i][c], (some){0});
            K(put)(&f[i][c], (some){0});
        }
    }
    real negligible = K(constant)(0); /* 2^-60 of the first change: with more, invariants drift */
    real previous = K(constant)(1e300), before_previous = previous;
    const real least = K(constant)(GM_LEAST_CHANGE(stages * GM_COMPONENTS));
    mask active = K(all)(), solved = K(other)(active);
    for (int iteration = 0; iteration < K(IMPLICIT_ITERATIONS); iteration++) {
        const real change = K(implicit_iterate)(row, stages, y, h, parameters, active, f, z);
        if (iteration == 0) {
            negligible = 8.673617379884035e-19 * change;
        }
        const unsigned iterating = K(holding)(active, counts->lanes);
        counts->evaluations += (unsigned long)stages * iterating;
        counts->iterations += iterating;
        real norm = K(constant)(0);
        for (int c = 0; c < GM_COMPONENTS; c += GM_AT_ONCE) {
            norm = K(add_magnitudes)(norm, K(take)(&y[c]));
        }
        const real roundoff = (8 * stages * 2.220446049250313e-16) * norm;
        const mask settled = GM_SWEEPS_ARE_SETTLED(change, previous, negligible, roundoff, least);
        const mask contract = GM_SWEEPS_CONTRACT(change, before_previous, roundoff);
        const mask done = K(both)(active, settled);
        solved |= done;
        active &= K(both)(K(other)(done), contract);
        if (!K(somewhere)(active)) {
            break;
        }
        before_previous = previous;
        previous = change;
    }
    return solved;
}

#ifdef GM_PASS_SCALAR

GM_INLINE bool implicit_slope(void *data, size_t stage, const double *state, double *f, double *jacobian)
{
    (void)stage;
    field_scalar(state, f, data);
    jacobian_scalar(state, (double(*)[GM_COMPONENTS])jacobian, data);
    return true;
}

/* Solves the equations by Newton's method for one member, and writes its increment. */
static bool implicit_newton(const struct gm_tableau *row, const double *y, double h, const void *parameters,
                            double *increment, struct gm_progress *progress)
{
    enum { N = GM_COMPONENTS, MOST = GM_TABLEAU_STAGES * N };
    double z[MOST] = {0}, f[MOST], state[N], jacobian[N * N], scratch[MOST * (MOST + 1)];
    struct gm_stages stages = {
        .count = (size_t)row->stages,
        .n = N,
        .h = h,
        .y = y,
        .a = row->a,
        .b = row->b,
        .c = row->a,
        .d = row->b,
        .slope = implicit_slope,
        .data = (void *)parameters,
        .f = f,
        .state = state,
        .jacobian = jacobian,
        .progress = progress,
    };
    const struct gm_implicit_equations equations = {

        .linear = gm_stages_linear,
        .size = stages.count * N,
        .data = &stages,
        .counted = stages.count * N,
        .y = y,
        .n = N};
    if (!gm_newton_solve(&equations, scratch, z, progress)) {
        return false;
    }
    gm_stages_increment(&stages, z, increment);
    return true;
}

#endif

/* Solves the lanes in `which`, one by one; returns the solved ones. */
static __attribute__((noinline)) mask K(implicit_by_newton)(const struct gm_tableau *row, mask which,
                                                            const real *y, double h, const void *parameters,
                                                            real *increments, struct K(counts) * counts)
{
    mask solved = K(other)(K(all)());
    for (int l = 0; l < GM_LANES; l++) {
        if (!K(mask_lane)(which, l)) {
            continue;
        }
        double state[GM_COMPONENTS], increment[GM_COMPONENTS] = {0};
        for (int c = 0; c < GM_COMPONENTS; c++) {
            state[c] = K(lane)(y[c], l);
        }
        struct gm_progress cost = {0};
        const bool found = implicit_newton(row, state, h, parameters, increment, &cost);
        K(set_mask_lane)(&solved, l, found);
        for (int c = 0; c < GM_COMPONENTS; c++) {
            K(set_lane)(&increments[c], l, increment[c]);
        }
        if (l < counts->lanes) {
            counts->evaluations += cost.evaluations;
            counts->iterations += cost.iterations;
            counts->solves += cost.solves;
        }
        if (!found) {
            counts->unsolved = cost.unsolved;
        }
    }
    return solved;
}

GM_INLINE mask K(implicit_step_stages)(const struct gm_tableau *row, int stages, struct K(block) * block,
                                       double dt, const void *parameters, bool compensated, bool stiff,
                                       real f[][GM_COMPONENTS], real z[][GM_COMPONENTS],
                                       struct K(counts) * counts)
{
    mask good = K(all)();
    for (int substep = 0; substep < row->composition->steps; substep++) {
        const double h = dt * gm_composition_fraction(row->composition, substep);
        mask solved = K(other)(K(all)());
        if (!stiff) {
            solved = K(implicit_fixed_point)(row, stages, block->y, h, parameters, f, z, counts);
        } else {
            memset(f, 0, (size_t)stages * sizeof f[0]);
        }
        const mask rest = K(other)(solved);
        if (K(somewhere)(rest)) { /* Newton's method leaves its increment in z[0] */
            solved |= K(implicit_by_newton)(row, rest, block->y, h, parameters, z[0], counts);
        }
        good &= solved;
        for (int c = 0; c < GM_COMPONENTS; c += GM_AT_ONCE) {
            some increment = h * row->b[0] * K(take)(&f[0][c]);
            for (int i = 1; i < stages; i++) {
                increment += h * row->b[i] * K(take)(&f[i][c]);
            }
            increment = K(pick_some)(rest, K(take)(&z[0][c]), increment);
            K(add_some)(&block->y[c], &block->carry[c], increment, compensated);
        }
    }
    return good;
}

/* The number of stages as a constant, so that the small loops unroll; of more stages there are fewer
   schemes. */
#define GM_IMPLICIT_STEP(name, count, room)                                                                  \
    GM_INLINE mask K(implicit_step_##name)(const struct gm_tableau *row, struct K(block) * block, double dt, \
                                           const void *parameters, bool compensated, bool stiff,             \
                                           struct K(counts) * counts)                                        \
    {                                                                                                        \
        real f[room][GM_COMPONENTS], z[room][GM_COMPONENTS];                                                 \
        return K(implicit_step_stages)(row, count, block, dt, parameters, compensated, stiff, f, z, counts); \
    }
GM_IMPLICIT_STEP(1, 1, 1)
GM_IMPLICIT_STEP(2, 2, 2)
GM_IMPLICIT_STEP(3, 3, 3)
GM_IMPLICIT_STEP(4, 4, 4)
GM_IMPLICIT_STEP(any, row->stages, GM_TABLEAU_STAGES)
#undef GM_IMPLICIT_STEP

#define GM_ROW struct gm_tableau
#define GM_DRIVE K(implicit_drive_1)
#define GM_STEP K(implicit_step_1)
#include "core/ode/kernel/drive.h"
#define GM_ROW struct gm_tableau
#define GM_DRIVE K(implicit_drive_2)
#define GM_STEP K(implicit_step_2)
#include "core/ode/kernel/drive.h"
#define GM_ROW struct gm_tableau
#define GM_DRIVE K(implicit_drive_3)
#define GM_STEP K(implicit_step_3)
#include "core/ode/kernel/drive.h"
#define GM_ROW struct gm_tableau
#define GM_DRIVE K(implicit_drive_4)
#define GM_STEP K(implicit_step_4)
#include "core/ode/kernel/drive.h"
#define GM_ROW struct gm_tableau
#define GM_DRIVE K(implicit_drive_any)
#define GM_STEP K(implicit_step_any)
#include "core/ode/kernel/drive.h"

__attribute__((unused)) static struct gm_progress K(implicit_runge_kutta_run)(const struct gm_task *task)
{
    const struct gm_tableau *row = task->scheme->coefficients;
    const bool compensated = task->carry != NULL;
    switch (row->stages) {
    case 1:
        return K(implicit_drive_1)(task, row, compensated);
    case 2:
        return K(implicit_drive_2)(task, row, compensated);
    case 3:
        return K(implicit_drive_3)(task, row, compensated);
    case 4:
        return K(implicit_drive_4)(task, row, compensated);
    default:
        return K(implicit_drive_any)(task, row, compensated);
    }
}
