/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_KERNEL_MEMBERS_H
#define GM_CORE_ODE_KERNEL_MEMBERS_H

#include "core/arena.h"
#include "core/linear/settled.h"
#include "core/ode/kernel/stages.h"
#include "core/scheme.h"

/* Copy `count` numbers of one of m members out of [number * m + member], or into it. */
static inline void gm_member_take(const double *from, double *to, size_t count, size_t m, size_t member)
{
    for (size_t c = 0; c < count; c++) {
        to[c] = from[c * m + member];
    }
}

static inline void gm_member_put(const double *from, double *to, size_t count, size_t m, size_t member)
{
    for (size_t c = 0; c < count; c++) {
        to[c * m + member] = from[c];
    }
}

/* Opens a workspace by a body, whose data is a gm_workspace; NULL when out of memory. What it opens begins with the
   pointer to the arena that owns it, by which gm_workspace_close closes it. */
struct gm_workspace {
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    void *opened;
};
void *gm_workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme,
                        void (*body)(struct gm_arena *arena, void *opening));
void gm_workspace_close(void *workspace);

/* The loop of families that advance a problem member by member, through its callbacks. */

/* Beyond this many components no matrix is made, and an iteration that does not contract has failed. */
enum { GM_NEWTON_LARGEST = 64 };
size_t gm_matrix_size(const struct gm_problem *problem); /* n * n, or 0 */
/* True if gm_stages_by_newton has a matrix, of this kind or a sparse one. */
bool gm_newton_fits(const struct gm_problem *problem);

/* The workspace: one member's state and memory, and scratch for the step. */
struct gm_members {
    struct gm_arena *arena; /* owns all of this */
    size_t n, remembered;
    double *y;       /* n */
    double *memory;  /* remembered */
    double *carry;   /* n, the compensation of the sums; NULL: plain */
    double *scratch; /* scratch of the requested size */
    void *family;    /* what the family's `open` returned; or NULL */
};

/* Makes one step of one member: changes members->y and members->memory in place. Returns the reason of a
   failure. */
typedef enum gm_status gm_member_step(const struct gm_task *task, struct gm_members *members,
                                      struct gm_progress *progress);

/* A family that advances a problem member by member. */
struct gm_member_family {
    gm_member_step *step;
    /* doubles of memory of a member, for gm_members_memory: this number, and this number of halves of a state */
    size_t remembered, halves;
    size_t vectors, squares; /* the scratch is this number of states, and of n * n matrices */
    /* the scratch in doubles; NULL: as above */
    size_t (*room)(const struct gm_problem *problem, const struct gm_scheme *scheme);
    /* Opens what the family has besides, members->family, in the body of the arena; NULL: nothing. */
    void *(*open)(struct gm_members *members, const struct gm_problem *problem,
                  const struct gm_scheme *scheme);
    bool evaluated_at_start; /* the start evaluates a force, which the first steps count */
};

/* Makes all steps of all members with the step of the scheme's family; the workspace is a gm_members. Memory
   is [double * m + member], like the state. */
struct gm_progress gm_members_loop(const struct gm_task *task);
size_t gm_members_memory(const struct gm_problem *problem, const struct gm_scheme *scheme);
void *gm_members_workspace(const struct gm_problem *problem, const struct gm_scheme *scheme);

/* The fields of a struct gm_family that every such family has, with those of its struct gm_member_family. */
#define GM_MEMBERS_BY(family)                                                                                \
    .loop = gm_members_loop, .workspace_open = gm_members_workspace, .workspace_close = gm_workspace_close,  \
    .members = family
#define GM_MEMBERS_OF_NO_ROWS(...) GM_MEMBERS_BY((&(const struct gm_member_family){__VA_ARGS__}))
/* The kind, and the rows of a list `schemes`, or those that families/schemes.text gives the family. */
#define GM_ROWS_LISTED .kind = &gm_kind_ode, .schemes = schemes, .count = GM_COUNT(schemes)
#define GM_ROWS(family)                                                                                      \
    .kind = &gm_kind_ode, .schemes = (const struct gm_scheme[]){GM_SCHEMES_##family},                        \
    .count = sizeof((const struct gm_scheme[]){GM_SCHEMES_##family}) / sizeof(struct gm_scheme)
#define GM_MEMBERS(family, ...) GM_ROWS(family), GM_MEMBERS_OF_NO_ROWS(__VA_ARGS__)
#define GM_MEMBERS_WITH_MEMORY(family, ...) GM_MEMBERS(family, __VA_ARGS__), .memory = gm_members_memory

/* Adds a step to the time that a scheme with its own steps has reached, by a compensated sum. Returns
   GM_STEP_COLLAPSE if it changes nothing. */
static inline enum gm_status gm_members_pass(struct gm_progress *progress, double h, double *carry)
{
    const double before = progress->t, whole = *carry + h;
    progress->t += whole;
    *carry = whole + (before - progress->t);
    return progress->t == before ? GM_STEP_COLLAPSE : GM_OK;
}

/* Returns true if all are at most the limit, and none is NaN. */
bool gm_is_within(const double *y, size_t count, double limit);

/* Writes the Jacobian of f at y, n * n by rows; false if the problem has none, or it would be too large a
   matrix. */
bool gm_jacobian(const struct gm_problem *problem, const double *y, double *jacobian);

/* Returns H(y) of one member. */
double gm_energy(const struct gm_problem *problem, const double *y);

#endif
