/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Any scheme Phi, whose step goes as far in its direction as an invariant I allows:
       d = Phi_h(y_0) - y_0,   y_1 = y_0 + gamma d,   t_1 = t_0 + gamma h,   I(y_1) = I(start),   gamma near 1
   gamma - 1 is of the size of h^(p - 1), and the order p of Phi is kept at the time t_1. D.I. Ketcheson, SIAM J. Numer.
   Anal. 57 (2019) 2850; H. Ranocha, M. Sayyari, L. Dalcin, M. Parsani & D.I. Ketcheson, SIAM J. Sci. Comput. 42 (2020)
   A612. The family has no rows: they are user-defined. */
#include <math.h>
#include <string.h>

#include "core/ode/families/families.h"
#include "core/ode/families/invariants/held.h"

/* z := y + gamma move: from gamma = 1 a step of Newton's method, then the secant method, whose next miss is known before:
   the last one times the last factor of them. */
static enum gm_status relax(struct gm_held *held, const double *y, double value, double *gamma,
                            struct gm_progress *progress)
{
    double off = 0, slope = 0, change = 0, before = INFINITY;
    *gamma = 1;
    for (int i = 0; i < GM_HELD_MOST; i++) {
        const double last = off;
        double miss;
        for (size_t c = 0; c < held->n; c++) {
            held->z[c] = y[c] + *gamma * held->move[c];
        }
        if (i == 0) {
            gm_conserved_both(&held->conserved, held->z, held->slopes);
            held->scale[0] = 0;
            for (size_t c = 0; c < held->n; c++) {
                held->scale[0] += fabs(held->slopes[c] * held->z[c]);
                slope += held->slopes[c] * held->move[c];
            }
            held->values[0] = held->slopes[held->n];
            miss = gm_held_distance(held, &value, &off);
        } else {
            miss = gm_held_miss(held, &value, held->z, &off);
            slope = (last - off) / change;
        }
        const double previous = before;
        if (gm_held_is_met(miss, &before)) {
            return GM_OK;
        }
        change = off / slope;
        if (!(fabs(*gamma + change - 1) <= 0.5)) {
            break;
        }
        *gamma += change;
        if (i > 0 && gm_held_is_next_met(miss, previous)) {
            for (size_t c = 0; c < held->n; c++) {
                held->z[c] = y[c] + *gamma * held->move[c];
            }
            return GM_OK;
        }
    }
    return before <= GM_HELD_MET ? GM_OK : gm_held_fails(held, &value, progress);
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    struct gm_held *held = members->family;
    double *memory = members->memory, gamma;
    gm_base_begin(&held->base, task);
    enum gm_status status = gm_base_step(&held->base, task->dt, members->y, held->z, progress);
    for (size_t c = 0; c < held->n; c++) {
        held->move[c] = held->z[c] - members->y[c];
    }
    status = status == GM_OK ? relax(held, members->y, memory[GM_HELD_VALUES], &gamma, progress) : status;
    if (status != GM_OK) {
        return status;
    }
    memcpy(members->y, held->z, held->n * sizeof *held->z);
    memory[GM_HELD_CORRECTION] = gamma - 1;
    return gm_members_pass(progress, gamma * task->dt, &memory[GM_HELD_TIME_CARRY]);
}

const struct gm_family gm_family_relaxed = {
    .kind = &gm_kind_ode,
    .title = "relaxed along the step",
    GM_HELD_FAMILY(step),
    .adaptive = true,
};
