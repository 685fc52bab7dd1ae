/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The splitting family over a problem's kernels, for one pass; see core/ode/compiled/pass.h. The table is
   read at run time: a row is data. */

/* The force is stored from the last kick of a step to the first of the next, if q has not moved between, and
   is counted once, even if a call ends in between and it is computed again. */
GM_INLINE mask K(splitting_step)(const struct gm_splitting *table, struct K(block) * block, double h,
                                 const void *parameters, bool compensated, bool stiff,
                                 struct K(counts) * counts)
{
    (void)stiff;
    enum { HALF = GM_COMPONENTS / 2 };
    const bool ends_with_kick = table->pieces[table->count - 1].piece == GM_KICK;
#pragma GCC unroll 3
    for (int i = 0; i < table->count; i++) {
        const double c = table->pieces[i].fraction * h;
        if (table->pieces[i].piece == GM_DRIFT) {
            real velocity[HALF];
            K(velocity)(block->y + HALF, velocity, parameters);
            for (int k = 0; k < HALF; k++) {
                K(add)(&block->y[k], &block->carry[k], c * velocity[k], compensated);
            }
            block->force_known = false;
            continue;
        }
        if (!block->force_known) {
            K(force)(block->y, block->force, parameters);
            block->force_known = true;
            const bool counted = i == 0 && ends_with_kick && counts->continued;
            counts->evaluations += counted ? 0 : (unsigned long)counts->lanes;
        }
        for (int k = 0; k < HALF; k++) {
            K(add)(&block->y[HALF + k], &block->carry[HALF + k], c * block->force[k], compensated);
        }
    }
    return K(all)();
}

#define GM_DRIVE K(splitting_drive)
#define GM_ROW struct gm_splitting
#define GM_STEP K(splitting_step)
#define GM_ABREAST K(ABREAST)
#define GM_QUICK
#include "core/ode/kernel/drive.h"

/* Kick, drift, kick. The force is known before every step, so that none of its operations waits for an answer:
   half the time of the table's loop. */
GM_INLINE void K(know_force)(struct K(block) * block, const void *parameters, struct K(counts) * counts)
{
    K(force)(block->y, block->force, parameters);
    counts->evaluations += counts->continued ? 0 : (unsigned long)counts->lanes;
}

GM_INLINE mask K(kick_drift_kick)(const struct gm_three *three, struct K(block) * block, double h,
                                  const void *parameters, bool compensated, bool stiff,
                                  struct K(counts) * counts)
{
    (void)stiff;
    (void)compensated;
    enum { HALF = GM_COMPONENTS / 2 };
    const double first = three->first * h, drift = three->drift * h, last = three->last * h;
    real velocity[HALF];
    for (int k = 0; k < HALF; k++) {
        block->y[HALF + k] += first * block->force[k];
    }
    K(velocity)(block->y + HALF, velocity, parameters);
    for (int k = 0; k < HALF; k++) {
        block->y[k] += drift * velocity[k];
    }
    K(force)(block->y, block->force, parameters);
    for (int k = 0; k < HALF; k++) {
        block->y[HALF + k] += last * block->force[k];
    }
    counts->evaluations += (unsigned long)counts->lanes;
    return K(all)();
}

#define GM_DRIVE K(kick_drift_kick_drive)
#define GM_ROW struct gm_three
#define GM_STEP K(kick_drift_kick)
#define GM_ABREAST K(ABREAST)
#define GM_QUICK
#define GM_PRIME K(know_force)
#include "core/ode/kernel/drive.h"

__attribute__((unused)) static struct gm_progress K(splitting_run)(const struct gm_task *task)
{
    const struct gm_splitting *table = task->scheme->coefficients;
    if (table->count == 3 && table->pieces[0].piece == GM_KICK && table->pieces[1].piece == GM_DRIFT &&
        table->pieces[2].piece == GM_KICK && !task->carry) {
        const struct gm_three three = {.first = table->pieces[0].fraction,
                                       .drift = table->pieces[1].fraction,
                                       .last = table->pieces[2].fraction};
        return K(kick_drift_kick_drive)(task, &three, false);
    }
    return task->carry ? K(splitting_drive)(task, table, true) : K(splitting_drive)(task, table, false);
}
