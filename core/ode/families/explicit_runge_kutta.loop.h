/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The explicit Runge-Kutta family over a problem's kernels, for one pass; see core/ode/families/pass.h. */

GM_INLINE mask K(explicit_step)(const struct gm_explicit_tableau *tableau, struct K(block) * block, double h,
                                const void *parameters, bool compensated, bool stiff,
                                struct K(counts) * counts)
{
    (void)stiff;
    real k[GM_EXPLICIT_STAGES][GM_COMPONENTS];
#pragma GCC unroll 8
    for (int i = 0; i < tableau->stages; i++) {
        real stage[GM_COMPONENTS];
        for (int c = 0; c < GM_COMPONENTS; c++) {
            stage[c] = block->y[c];
#pragma GCC unroll 8
            for (int j = 0; j < i; j++) {
                if (tableau->a[i][j] != 0) {
                    stage[c] += h * tableau->a[i][j] * k[j][c];
                }
            }
        }
        K(field)(stage, k[i], parameters);
    }
    for (int c = 0; c < GM_COMPONENTS; c++) {
        real increment = h * tableau->b[0] * k[0][c];
#pragma GCC unroll 8
        for (int i = 1; i < tableau->stages; i++) {
            increment += h * tableau->b[i] * k[i][c];
        }
        K(add)(&block->y[c], &block->carry[c], increment, compensated);
    }
    counts->evaluations += (unsigned long)(tableau->stages * counts->lanes);
    return K(all)();
}

#define GM_DRIVE K(explicit_drive)
#define GM_ROW struct gm_explicit_tableau
#define GM_STEP K(explicit_step)
#define GM_ABREAST K(ABREAST)
#include "core/ode/kernel/drive.h"

__attribute__((unused)) static struct gm_progress K(explicit_runge_kutta_run)(const struct gm_task *task)
{
    const enum gm_explicit_row *row = task->scheme->coefficients;
    switch (*row) {
#define GM_EXPLICIT(identifier, ...)                                                                         \
    case GM_EXPLICIT_##identifier:                                                                           \
        return task->carry ? K(explicit_drive)(task, &gm_explicit_##identifier, true)                        \
                           : K(explicit_drive)(task, &gm_explicit_##identifier, false);
#include "core/ode/families/explicit_runge_kutta.def"
#undef GM_EXPLICIT
    case GM_EXPLICIT_COUNT:
        break;
    }
    return (struct gm_progress){.status = GM_NO_CONVERGENCE};
}
