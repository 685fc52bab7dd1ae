/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tools of families that advance one member after the other: the loop, Jacobians, energies. */
#include "core/ode/kernel/members.h"

#include <math.h>
#include <string.h>

#include "core/ode/kernel/loops.h"

bool gm_is_within(const double *y, size_t count, double limit)
{
    bool within = true;
    for (size_t i = 0; i < count; i++) {
        within &= fabs(y[i]) <= limit;
    }
    return within;
}

size_t gm_members_memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_member_family *members = scheme->family->members;
    return (members->remembered + members->halves * (problem->n / 2)) * problem->m;
}

void *gm_workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme,
                        void (*body)(struct gm_arena *arena, void *opening))
{
    struct gm_workspace opening = {problem, scheme, NULL};
    return gm_arena_made(body, &opening) ? opening.opened : NULL;
}

void gm_workspace_close(void *workspace)
{
    gm_arena_close(*(struct gm_arena **)workspace);
}

static void open_members(struct gm_arena *arena, void *data)
{
    struct gm_workspace *opening = data;
    const struct gm_problem *problem = opening->problem;
    const struct gm_family *family = opening->scheme->family;
    const struct gm_member_family *own = family->members;
    const size_t remembered = family->memory ? family->memory(problem, opening->scheme) / problem->m : 0;
    const size_t n = problem->n, scratch = own->room ? own->room(problem, opening->scheme)
                                                     : (own->vectors + own->squares * n) * n;
    struct gm_members *members = opening->opened = gm_arena_take(arena, 1, sizeof *members);
    *members = (struct gm_members){.n = n,
                                   .remembered = remembered,
                                   .arena = arena,
                                   .y = gm_arena_take(arena, 2 * n + remembered + scratch, sizeof(double))};
    members->memory = members->y + n;
    members->scratch = members->memory + remembered + n; /* a carry between */
    members->family = own->open ? own->open(members, problem, opening->scheme) : NULL;
}

void *gm_members_workspace(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    return gm_workspace_open(problem, scheme, open_members);
}

struct gm_progress gm_members_loop(const struct gm_task *task)
{
    struct gm_members *members = task->workspace;
    const size_t n = members->n, m = task->problem->m;
    const struct gm_member_family *family = task->scheme->family->members;
    const bool adaptive = task->scheme->family->adaptive;
    struct gm_progress progress = {.done = task->steps, .status = GM_OK, .t = task->t};
    progress.traced = task->trace != NULL;
    progress.evaluations = family->evaluated_at_start && task->steps_before == 0 ? m : 0;
    members->carry = task->carry ? members->memory + members->remembered : NULL;
    for (size_t member = 0; member < m; member++) {
        gm_member_take(task->y, members->y, n, m, member);
        if (members->remembered > 0) {
            gm_member_take(task->memory, members->memory, members->remembered, m, member);
        }
        if (members->carry) {
            gm_member_take(task->carry, members->carry, n, m, member);
        }
        for (int64_t done = 0; done < progress.done; done++) {
            enum gm_status status = family->step(task, members, &progress);
            if (status == GM_OK && !gm_is_within(members->y, n, task->limit)) {
                status = GM_BLOW_UP;
            }
            if (status != GM_OK) {
                progress.done = done;
                progress.status = status;
            } else if (adaptive && progress.t >= task->until) {
                progress.done = done + 1;
            }
            if (task->trace && status == GM_OK) {
                memcpy(task->trace + (size_t)done * n, members->y, n * sizeof *members->y);
            }
        }
        gm_member_put(members->y, task->out, n, m, member);
        if (members->remembered > 0) {
            gm_member_put(members->memory, task->memory_out, members->remembered, m, member);
        }
        if (members->carry) {
            gm_member_put(members->carry, task->carry_out, n, m, member);
        }
    }
    return progress;
}

size_t gm_matrix_size(const struct gm_problem *problem)
{
    const bool made = gm_ode_of(problem)->loops[GM_ISA_BASELINE]->jacobian && problem->n <= GM_NEWTON_LARGEST;
    return made ? problem->n * problem->n : 0;
}

bool gm_newton_fits(const struct gm_problem *problem)
{
    return gm_matrix_size(problem) > 0 || gm_ode_of(problem)->loops[GM_ISA_BASELINE]->correct;
}

bool gm_jacobian(const struct gm_problem *problem, const double *y, double *jacobian)
{
    if (gm_matrix_size(problem) == 0) {
        return false;
    }
    gm_ode_of(problem)->loops[GM_ISA_BASELINE]->jacobian(problem, y, jacobian);
    return true;
}

double gm_energy(const struct gm_problem *problem, const double *y)
{
    double energy;
    gm_ode_of(problem)->hamiltonian->energy(problem, y, &energy, 1);
    return energy;
}
