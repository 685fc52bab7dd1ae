/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nystrom methods for q'' = g(q), so for H = T(p) + V(q) with a quadratic T, g = T'' F, F = -dV/dq:
       Q_i = q0 + c_i h q0' + h^2 sum_j a_ij g(Q_j)
       q1  = q0 +     h q0' + h^2 sum_i b_i  g(Q_i),   q1' = q0' + h sum_i bv_i g(Q_i)
   T' is affine, so that only the velocity at a momentum, v(p0 + h sum_j a_ij F_j), and the force are
   evaluated:
       Q_i = q0 + h [(c_i - 1) v(p0) + v(p0 + h sum_j a_ij F_j)]
   If a stage depends on itself or a later one, all are found by fixed-point iteration. A last component that
   is the time moves with the stages. The family has no rows: they are user-defined. E.J. Nystrom (1925);
   E. Hairer, S.P. Norsett & G. Wanner, Solving Ordinary Differential Equations I (1993), II.14. */
#include "core/ode/families/family.h"
#include "core/ode/families/runge_kutta/row.h"

/* The scratch: the forces at the stages, the velocity at p0, a state and its slope, and the next forces. */
struct scratch {
    double *forces, *velocity, *state, *slope, *next;
    size_t half;
};

static struct scratch scratch_of(const struct gm_members *members, int stages)
{
    const size_t half = members->n / 2;
    double *at = members->scratch;
    return (struct scratch){.half = half,
                            .forces = at,
                            .velocity = at + (size_t)stages * half,
                            .state = at + ((size_t)stages + 1) * half,
                            .slope = at + ((size_t)stages + 1) * half + members->n,
                            .next = at + ((size_t)stages + 1) * half + 2 * members->n};
}

/* slope[0 .. half) := q' at the state's momenta */
static void find_velocity(const struct gm_problem *problem, const struct scratch *scratch)
{
    const struct gm_loops *loops = gm_ode_of(problem)->loops[GM_ISA_BASELINE];
    if (gm_ode_of(problem)->split->unit_mass) {
        memcpy(scratch->slope, scratch->state + scratch->half, scratch->half * sizeof(double));
    } else if (loops->velocity) {
        loops->velocity(problem, scratch->state, scratch->slope, 1);
    } else {
        gm_field(problem, scratch->state, scratch->slope, 1);
    }
}

/* slope[half .. 2 half) := p' at the state's positions */
static void find_force(const struct gm_problem *problem, const struct scratch *scratch)
{
    const struct gm_loops *loops = gm_ode_of(problem)->loops[GM_ISA_BASELINE];
    if (loops->force) {
        loops->force(problem, scratch->state, scratch->slope + scratch->half, 1);
    } else {
        gm_field(problem, scratch->state, scratch->slope, 1);
    }
}

/* A step. */
struct work {
    const struct gm_task *task;
    const struct gm_members *members;
    struct scratch scratch;
    bool is_explicit;
    struct gm_progress *progress;
};

/* state := positions at the time c h with these weights of the forces, as far as there are `count` */
static void place(const struct work *work, const double *forces, const double *weights, int count, double c)
{
    const struct scratch *scratch = &work->scratch;
    const struct gm_members *members = work->members;
    const size_t half = scratch->half;
    const double h = work->task->dt;
    memcpy(scratch->state, members->y, members->n * sizeof(double));
    for (int j = 0; j < count; j++) {
        for (size_t k = 0; weights[j] != 0 && k < half; k++) {
            scratch->state[half + k] += h * weights[j] * forces[(size_t)j * half + k];
        }
    }
    find_velocity(work->task->problem, scratch);
    for (size_t k = 0; k < half; k++) {
        scratch->state[k] += h * ((c - 1) * scratch->velocity[k] + scratch->slope[k]);
    }
    if (members->n % 2 != 0) {
        scratch->state[members->n - 1] += c * h;
    }
}

/* Evaluates all forces once, each from the newest values of the others. */
static bool sweep(void *data, const double *forces, double *next, double *scale)
{
    const struct work *work = data;
    const struct gm_nystrom_row *row = work->task->scheme->coefficients;
    const size_t half = work->scratch.half, count = (size_t)row->stages * half;
    memmove(next, forces, count * sizeof *next);
    for (int i = 0; i < row->stages; i++) {
        place(work, next, row->a[i], work->is_explicit ? i : row->stages, row->c[i]);
        find_force(work->task->problem, &work->scratch);
        memcpy(next + (size_t)i * half, work->scratch.slope + half, half * sizeof *next);
    }
    work->progress->evaluations += (unsigned long)row->stages;
    *scale += gm_sum_of(next, count);
    return true;
}

static bool is_explicit_row(const struct gm_nystrom_row *row)
{
    bool is_explicit = true;
    for (int i = 0; i < row->stages; i++) {
        for (int j = i; j < row->stages; j++) {
            is_explicit = is_explicit && row->a[i][j] == 0;
        }
    }
    return is_explicit;
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct gm_nystrom_row *row = task->scheme->coefficients;
    struct work work = {task, members, scratch_of(members, row->stages), is_explicit_row(row), progress};
    const struct scratch *scratch = &work.scratch;
    const size_t half = scratch->half;
    double *forces = scratch->forces, size = 0;
    memcpy(scratch->state, members->y, members->n * sizeof(double));
    find_velocity(task->problem, scratch);
    memcpy(scratch->velocity, scratch->slope, half * sizeof(double));
    memset(forces, 0, (size_t)row->stages * half * sizeof(double));
    const struct gm_implicit_equations equations = {
        .size = (size_t)row->stages * half, .data = &work, .sweep = sweep, .roundoff = 8 * GM_EPSILON};
    if (work.is_explicit) {
        sweep(&work, forces, forces, &size);
        if (!(size < 1e100)) {
            return GM_BLOW_UP;
        }
    } else if (!gm_sweeps_solve(&equations, scratch->next, forces, progress)) {
        return GM_NO_CONVERGENCE;
    }
    place(&work, forces, row->b, row->stages, 1);
    memcpy(members->y, scratch->state, half * sizeof(double));
    for (int i = 0; i < row->stages; i++) {
        for (size_t k = 0; k < half; k++) {
            members->y[half + k] += task->dt * row->bv[i] * forces[(size_t)i * half + k];
        }
    }
    if (members->n % 2 != 0) {
        members->y[members->n - 1] += task->dt;
    }
    return GM_OK;
}

static size_t room(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_nystrom_row *row = scheme->coefficients;
    return (2 * (size_t)row->stages + 1) * (problem->n / 2) + 2 * problem->n;
}

const struct gm_family gm_family_nystrom = {
    .kind = &gm_kind_ode,
    .title = "Nyström",
    GM_MEMBERS_OF_NO_ROWS(.step = step, .room = room),
};
