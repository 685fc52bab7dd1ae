/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The correction of a state to given values of invariants I_j, D = the rows dI_j/dy: with a rotation V of the rows
   that makes them orthogonal (one-sided Jacobi method),
       (D D')^+ = V diag(1/s_j^2) V',   s_j the lengths of the rows of V'D,
   without those rows whose length, or whose distance, is round-off. G.H. Golub & C.F. Van Loan, Matrix Computations (2013),
   section 8.6.3. */
#include "core/ode/families/invariants/held.h"

#include <stdio.h>

#include "core/ode/families/family.h"
#include "core/ode/variational/action.h"
#include "core/schemes.h"

const struct gm_holding *gm_holding_of(const struct gm_scheme *scheme)
{
    return scheme->family->memory == gm_held_memory ? scheme->coefficients : NULL;
}

const struct gm_scheme *gm_holding_base(const struct gm_scheme *scheme)
{
    const struct gm_holding *holding = scheme->coefficients;
    return holding->base ? gm_scheme_find(holding->base) : scheme->base;
}

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0;
    for (size_t c = 0; c < n; c++) {
        sum += a[c] * b[c];
    }
    return sum;
}

/* (a, b) := (a - t b, b + t a) / sqrt(1 + t^2) */
static void rotate(double *a, double *b, size_t n, double t)
{
    const double cosine = 1 / sqrt(1 + t * t), sine = t * cosine;
    for (size_t c = 0; c < n; c++) {
        const double before = a[c];
        a[c] = cosine * before - sine * b[c];
        b[c] = sine * before + cosine * b[c];
    }
}

void gm_held_turn(struct gm_held *held, const double *y)
{
    enum { SWEEPS = 30 };
    const size_t n = held->n, count = held->count;
    bool turned = true;
    gm_conserved_both(&held->conserved, y, held->slopes);
    memcpy(held->values, held->slopes + count * n, count * sizeof *held->values);
    memcpy(held->turned, held->slopes, count * n * sizeof *held->turned);
    for (size_t j = 0; j < count; j++) {
        held->scale[j] = 0;
        for (size_t c = 0; c < n; c++) {
            held->scale[j] += fabs(held->slopes[j * n + c] * y[c]);
        }
        for (size_t i = 0; i < count; i++) {
            held->turn[j][i] = i == j;
        }
    }
    for (int sweep = 0; turned && sweep < SWEEPS; sweep++) {
        turned = false;
        for (size_t i = 0; i < count; i++) {
            for (size_t j = i + 1; j < count; j++) {
                double *a = held->turned + i * n, *b = held->turned + j * n;
                const double aa = dot(a, a, n), bb = dot(b, b, n), ab = dot(a, b, n);
                if (fabs(ab) > 4 * GM_EPSILON * sqrt(aa * bb)) {
                    const double ratio = (bb - aa) / (2 * ab);
                    const double t = copysign(1, ratio) / (fabs(ratio) + sqrt(1 + ratio * ratio));
                    rotate(a, b, n, t);
                    rotate(held->turn[i], held->turn[j], count, t);
                    turned = true;
                }
            }
        }
    }
    for (size_t j = 0; j < count; j++) {
        held->length[j] = dot(held->turned + j * n, held->turned + j * n, n);
    }
}

/* The distance of invariant j from its value, relative to its scale. */
static double distance(const struct gm_held *held, const double *values, size_t j)
{
    const double off = values[j] - held->values[j];
    return off == 0 ? 0 : fabs(off) / (fabs(values[j]) + held->scale[j]);
}

double gm_held_distance(const struct gm_held *held, const double *values, double *off)
{
    double miss = 0;
    for (size_t j = 0; j < held->count; j++) {
        const double part = distance(held, values, j);
        off[j] = values[j] - held->values[j];
        miss = part <= miss || isnan(miss) ? miss : part;
    }
    return miss;
}

enum gm_status gm_held_fails(const struct gm_held *held, const double *values, struct gm_progress *progress)
{
    size_t farthest = 0;
    for (size_t j = 1; j < held->count && !isnan(distance(held, values, farthest)); j++) {
        farthest = distance(held, values, j) <= distance(held, values, farthest) ? farthest : j;
    }
    progress->unsolved = (struct gm_unsolved){
        .obstacle = GM_STAYS_OFF, .invariant = (int)farthest, .change = distance(held, values, farthest)};
    return GM_NO_CONVERGENCE;
}

double gm_held_miss(struct gm_held *held, const double *values, const double *y, double *off)
{
    gm_conserved_values(&held->conserved, y, held->values);
    return gm_held_distance(held, values, off);
}

void gm_held_solve(const struct gm_held *held, const double *off, double *multipliers)
{
    double longest = 0;
    memset(multipliers, 0, held->count * sizeof *multipliers);
    for (size_t j = 0; j < held->count; j++) {
        longest = fmax(longest, held->length[j]);
    }
    for (size_t j = 0; j < held->count; j++) {
        const double part = dot(held->turn[j], off, held->count);
        double round_off = 0; /* divided by a short length it would be a long way */
        for (size_t i = 0; i < held->count; i++) {
            round_off += 4 * GM_EPSILON * fabs(held->turn[j][i]) * (fabs(held->values[i]) + held->scale[i]);
        }
        for (size_t i = 0; held->length[j] > 1e-24 * longest && fabs(part) > round_off && i < held->count;
             i++) {
            multipliers[i] += part / held->length[j] * held->turn[j][i];
        }
    }
}

double gm_held_move(const double *from, const double *slopes, const double *multipliers, size_t count,
                    size_t n, double *y)
{
    double change = 0;
    for (size_t c = 0; c < n; c++) {
        double to = from[c];
        for (size_t j = 0; j < count; j++) {
            to += multipliers[j] * slopes[j * n + c];
        }
        change += fabs(to - y[c]);
        y[c] = to;
    }
    return change;
}

/* ---- the hooks ---- */

void *gm_held_open(struct gm_members *members, const struct gm_problem *problem,
                   const struct gm_scheme *scheme)
{
    const struct gm_holding *holding = scheme->coefficients;
    const size_t n = problem->n, count = holding->count;
    char lacks[GM_FAULT_SENTENCE];
    struct gm_held *held = gm_arena_take(members->arena, 1, sizeof *held);
    held->holding = holding;
    held->n = n;
    held->count = count;
    double **const arrays[] = {&held->z, &held->next, &held->move};
    double **const rows[] = {&held->start_slopes, &held->slopes, &held->turned}; /* behind slopes: values */
    for (size_t i = 0; i < 3; i++) {
        *arrays[i] = gm_arena_take(members->arena, n, sizeof(double));
        *rows[i] = gm_arena_take(members->arena, count * (n + 1), sizeof(double));
    }
    gm_base_open(members->arena, &held->base, gm_holding_base(scheme), problem, 1);
    if (count > 0) {
        gm_arena_need(members->arena,
                      gm_conserved_open(&held->conserved, &held->base.problem, holding->names, count, lacks));
        gm_arena_keep(members->arena, &held->conserved, gm_conserved_close);
    }
    return held;
}

void gm_held_reset(void *data)
{
    gm_base_reset(&((const struct gm_held *)((struct gm_members *)data)->family)->base);
}

size_t gm_held_memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_holding *holding = scheme->coefficients;
    return holding->constraints ? 0 : (GM_HELD_VALUES + holding->count) * problem->m;
}

/* Notes the values of every member. They stay if the state still has them, so that a run that turns round comes
   back. */
enum gm_status gm_held_start(const struct gm_task *task)
{
    const double still = 1e-9;
    struct gm_held *held = ((struct gm_members *)task->workspace)->family;
    const size_t m = task->problem->m;
    double *memory = task->memory_out, off[GM_MOST_CONSERVED], values[GM_MOST_CONSERVED];
    for (size_t member = 0; held->count > 0 && member < m; member++) {
        gm_member_take(task->y, held->z, held->n, m, member);
        gm_member_take(memory + GM_HELD_VALUES * m, values, held->count, m, member);
        gm_held_turn(held, held->z);
        const double miss = gm_held_miss(held, values, held->z, off);
        const bool keeps = memory[GM_HELD_IS_SET * m + member] == 1 && miss <= still;
        if (!keeps) {
            gm_member_put(held->values, memory + GM_HELD_VALUES * m, held->count, m, member);
        }
        memory[GM_HELD_IS_SET * m + member] = 1;
    }
    return GM_OK;
}

size_t gm_held_column(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    const struct gm_holding *holding = scheme->coefficients;
    char lacks[GM_FAULT_SENTENCE];
    for (size_t i = 0; i < holding->count; i++) {
        struct gm_conserved conserved; /* of the names so far, for none may be another one's invariant */
        if (!gm_conserved_open(&conserved, problem, holding->names, i + 1, lacks)) {
            return holding->columns[i];
        }
        gm_conserved_close(&conserved);
    }
    return 0;
}

const char *gm_held_lacks(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    static _Thread_local char lacks[GM_FAULT_SENTENCE];
    const struct gm_holding *holding = scheme->coefficients;
    const struct gm_scheme *base = gm_holding_base(scheme);
    struct gm_conserved conserved;
    if (!gm_scheme_fits(base, problem)) {
        const char *of_base = gm_scheme_lacks(base, problem);
        return of_base ? of_base : "another scheme";
    }
    if (holding->constraints) {
        return NULL;
    }
    if (gm_action_constraints(problem) > 0) {
        return "a motion without constraints, or projected(...; constraints)";
    }
    if (!gm_conserved_open(&conserved, problem, holding->names, holding->count, lacks)) {
        const size_t column = lacks[0] ? gm_held_column(scheme, problem) : 0;
        if (column > 0) {
            const size_t length = strlen(lacks);
            snprintf(lacks + length, sizeof lacks - length, ", in column %zu", column);
        }
        return lacks[0] ? lacks : "more memory";
    }
    const bool linear = conserved.linear && scheme->family->adaptive;
    gm_conserved_close(&conserved);
    return linear ? "an invariant that is not linear; every step conserves a linear one" : NULL;
}
