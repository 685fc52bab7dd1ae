/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Any scheme Phi, and the way back to the invariants I_j at their values at the start, D(y) = the rows dI_j/dy:
       z = Phi_h(y_0),   y_1 = z + D(z)' lambda,   I(y_1) = I(start)
   keeps the order of Phi, for every I is constant along the exact motion. Moved before and after the step by the same
   multipliers,
       z = Phi_h(y_0 + D(y_0)' mu),   y_1 = z + D(y_1)' mu,   I(y_1) = I(start)
   it is symmetric if Phi is. It is not symplectic. Hairer, Lubich & Wanner (2006), sections IV.4.2, V.4.1.

   On systems with constraints g(q) = 0, G = dg/dq, a step of the motion with the multipliers of g'' = 0,
       (q, p) = Phi_h(y_0),   q_1 = q + M^-1 G' mu,  g(q_1) = 0,   p_1 = p + G' nu,  G v_1 = 0
   E. Hairer & G. Wanner, Solving Ordinary Differential Equations II (1996), section VII.2. */
#include "core/ode/families/family.h"
#include "core/ode/families/invariants/held.h"
#include "core/ode/variational/manifold.h"

/* z := z + D(z)' lambda, D at the first z */
static enum gm_status project(struct gm_held *held, const double *values, struct gm_progress *progress)
{
    double off[GM_MOST_CONSERVED], multipliers[GM_MOST_CONSERVED], before = INFINITY;
    gm_held_turn(held, held->z);
    for (int i = 0; i < GM_HELD_MOST; i++) {
        const double previous = before, miss = i == 0 ? gm_held_distance(held, values, off)
                                                      : gm_held_miss(held, values, held->z, off);
        if (gm_held_is_met(miss, &before)) {
            return GM_OK;
        }
        gm_held_solve(held, off, multipliers);
        gm_held_move(held->z, held->slopes, multipliers, held->count, held->n, held->z);
        if (i > 0 && gm_held_is_next_met(miss, previous)) {
            return GM_OK;
        }
    }
    return before <= GM_HELD_MET ? GM_OK : gm_held_fails(held, values, progress);
}

static enum gm_status project_symmetrically(struct gm_held *held, const struct gm_task *task, const double *y,
                                            const double *values, struct gm_progress *progress)
{
    const size_t n = held->n, count = held->count;
    double off[GM_MOST_CONSERVED], sum[GM_MOST_CONSERVED], mu[GM_MOST_CONSERVED] = {0};
    double miss = INFINITY, before = INFINITY, change = INFINITY;
    gm_conserved_slopes(&held->conserved, y, held->start_slopes);
    for (int i = 0; i < GM_HELD_MOST; i++) {
        gm_held_move(y, held->start_slopes, mu, count, n, held->move);
        const enum gm_status status = gm_base_step(&held->base, task->dt, held->move, held->next, progress);
        if (status != GM_OK) { /* from moved states it is this iteration that fails */
            return i == 0 ? status : gm_held_fails(held, values, progress);
        }
        if (i == 0) {
            memcpy(held->z, held->next, n * sizeof *held->z);
        }
        gm_held_turn(held, held->z);
        change = gm_held_move(held->next, held->slopes, mu, count, n, held->z);
        miss = gm_held_miss(held, values, held->z, off);
        if (gm_held_is_met(miss, &before) && change <= 16 * GM_EPSILON * gm_sum_of(held->z, n)) {
            return GM_OK;
        }
        gm_held_solve(held, off, sum); /* both moves change the invariants, by about the same */
        for (size_t j = 0; j < count; j++) {
            mu[j] += sum[j] / 2;
        }
    }
    const bool met = miss <= GM_HELD_MET && change <= GM_HELD_MET * gm_sum_of(held->z, n);
    return met ? GM_OK : gm_held_fails(held, values, progress);
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    struct gm_held *held = members->family;
    const double *values = members->memory + GM_HELD_VALUES;
    enum gm_status status = GM_OK;
    gm_base_begin(&held->base, task);
    if (held->holding->symmetric) {
        status = project_symmetrically(held, task, members->y, values, progress);
    } else {
        status = gm_base_step(&held->base, task->dt, members->y, held->z, progress);
        memcpy(held->next, held->z, held->n * sizeof *held->z);
        if (status == GM_OK && held->holding->constraints) {
            status = gm_manifold_project(&held->base.problem, held->z) ? GM_OK : GM_NO_CONVERGENCE;
        } else if (status == GM_OK) {
            status = project(held, values, progress);
        }
    }
    if (status != GM_OK) {
        return status;
    }
    memcpy(members->y, held->z, held->n * sizeof *held->z);
    if (!held->holding->constraints) {
        double square = 0; /* 0 of a length below the root of the smallest number */
        for (size_t c = 0; c < held->n; c++) {
            const double moved = held->z[c] - held->next[c];
            square += moved * moved;
        }
        members->memory[GM_HELD_CORRECTION] = sqrt(square);
    }
    return GM_OK;
}

static const struct gm_holding gauss4 = {.base = "gauss4", .constraints = true},
                               gauss6 = {.base = "gauss6", .constraints = true},
                               rk4 = {.base = "rk4", .constraints = true};

const struct gm_family gm_family_projected = {
    .title = "projected onto invariants",
    GM_ROWS(projected),
    GM_HELD_FAMILY(step),
};
