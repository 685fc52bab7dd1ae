/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Newton's method for the equations of one step on a mesh: with factors that are kept, then, where that
   fails, with new ones and shortened steps, from one first guess after the other. */
#include "core/mesh/equations.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/functions/functions.h"
#include "core/linear/extrapolation.h"

/* MANY: after more iterations the factors are recomputed, which costs as much as about ten of them. */
enum { MANY = 4, PAST = 6, SIMPLIFIED = 15, FULL = 40, HALVINGS = 12 };

static const double tolerance = 1e-11; /* change of unknowns, when solved */
static const double contracts = 0.2;   /* the ratio of changes that gives the remaining error */

enum {
    MEMORY_PAST,       /* number of stored steps, at most 6 */
    MEMORY_STAMP,      /* number of factorisations: names the current factors */
    MEMORY_SLOW,       /* 1: the last step converged slowly, so the factors must be recomputed */
    MEMORY_MULTIPLIER, /* largest multiplier of the last step */
    MEMORY_STEP,       /* length of the step that the factors were made for */
    MEMORY_TIME,       /* its time */
    MEMORY_HEAD,       /* offset of 6 past unknowns, newest first, then the factors' state and unknowns */
};

/* The change below which the equations are solved: round-off need not be smaller. */
static double enough(const struct gm_mesh_solver *solver)
{
    return fmax(tolerance, 4 * solver->noise);
}

/* The limit of a change that no longer shrinks: multipliers carry noise, velocities the round-off of
   places over dt. */
static double stagnation(const struct gm_mesh_solver *solver)
{
    return fmax(1e-9, 10 * solver->noise);
}

size_t gm_mesh_memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_mesh mesh = gm_mesh_of_problem(problem);
    const size_t n = mesh.points * gm_mesh_layout_of(scheme->coefficients, &mesh).per_node;
    return MEMORY_HEAD + (PAST + 1) * n + 4 * mesh.points + scheme->family->adaptive;
}

void gm_mesh_workspace_close(void *workspace)
{
    struct gm_mesh_solver *solver = workspace;
    for (size_t i = 0; i < GM_STAGES; i++) {
        gm_elements_close(&solver->stage[i]);
    }
    gm_elements_close(&solver->ends);
    gm_banded_close(&solver->matrix);
    gm_banded_close(&solver->projection);
    gm_banded_close(&solver->places);
    free(solver->unknowns);
    free(solver);
}

void *gm_mesh_workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    struct gm_mesh_solver *solver = calloc(1, sizeof *solver);
    if (!solver) {
        return NULL;
    }
    const struct gm_mesh *mesh = &solver->mesh;
    solver->mesh = gm_mesh_of_problem(problem);
    solver->row = scheme->coefficients;
    solver->of = gm_mesh_layout_of(solver->row, mesh);
    solver->kind = solver->of.smoothed ? GM_MESH_FREE : solver->row->kind;
    solver->mesh.cell = solver->row->kind == GM_MESH_FREE ? mesh->cell : NULL;
    solver->stages = solver->row->tableau->stages;
    const size_t points = mesh->points, n = points * solver->of.per_node, moves = solver->of.projected;
    bool good = gm_elements_open(&solver->ends, mesh);
    for (size_t i = 0; i < solver->stages; i++) {
        good = good && gm_elements_open(&solver->stage[i], mesh);
    }
    good = good && gm_banded_open(&solver->matrix, n, 2 * solver->of.per_node - 1) &&
           gm_banded_open(&solver->projection, moves * points, 2 * moves - 1) &&
           gm_banded_open(&solver->places, points, 1);
    double *next = calloc(3 * n + 10 * points + 1 + solver->stages * (3 * points + 1), sizeof *next);
    solver->unknowns = next;
    if (!good || !next) {
        gm_mesh_workspace_close(solver);
        return NULL;
    }
    solver->residual = next + n;
    solver->trial = solver->residual + n;
    solver->momenta = solver->trial + n;
    solver->motion = solver->momenta + 2 * points;
    solver->slack = solver->motion + 3 * points;
    solver->whole = solver->slack + points + 1;
    next = solver->whole + 4 * points;
    for (size_t i = 0; i < solver->stages; i++, next += 3 * points + 1) {
        solver->forces[i] = next;
        solver->share[i] = next + 2 * points;
    }
    return solver;
}

void gm_mesh_workspace_reset(void *workspace)
{
    ((struct gm_mesh_solver *)workspace)->stamp = 0;
}

/* Copies the nodes at the end of a step, or at a start, into `state`. */
static enum gm_status store(const struct gm_mesh_solver *solver, double *state, double limit)
{
    const struct gm_elements *end = &solver->ends;
    const double *const parts[] = {end->y, end->x, end->u, end->v};
    for (size_t part = 0; part < GM_COUNT(parts); part++) {
        for (size_t k = 1; k <= solver->mesh.points; k++, state++) {
            *state = parts[part][k];
            if (!(fabs(*state) <= limit)) {
                return GM_BLOW_UP;
            }
        }
    }
    return GM_OK;
}

/* The density of steps of an adaptive scheme, which is 0 in a new run. */
static double *density(const struct gm_task *task)
{
    return task->memory_out + gm_mesh_memory(task->problem, task->scheme) - 1;
}

enum gm_status gm_mesh_restart(const struct gm_task *task)
{
    struct gm_mesh_solver *solver = task->workspace;
    memset(task->memory_out, 0, MEMORY_HEAD * sizeof *task->memory_out);
    solver->stamp = 0;
    solver->mesh.t = task->t;
    if (task->scheme->family->adaptive) { /* a reversed run keeps it */
        *density(task) = *density(task) > 0 ? *density(task) : 1;
    }
    if (!gm_mesh_carry(&solver->mesh, solver->kind, task->y, task->out)) {
        return GM_MESH_CROSSING;
    }
    if (!solver->of.smoothed) {
        return GM_OK;
    }
    gm_step_place(solver, task->out, task->t, task->dt);
    return gm_step_begin(solver) ? store(solver, task->out, task->limit) : GM_MESH_CROSSING;
}

enum gm_mesh_kind gm_scheme_mesh(const struct gm_scheme *scheme)
{
    return ((const struct gm_mesh_row *)scheme->coefficients)->kind;
}

const char *gm_mesh_lacks(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    const bool alone = gm_mesh_of_problem(problem).alone;
    return alone && gm_scheme_mesh(scheme) != GM_MESH_FREE ? "a field; nodes alone are for free- schemes"
                                                           : NULL;
}

bool gm_scheme_relaxes(const struct gm_scheme *scheme)
{
    return gm_scheme_mesh(scheme) == GM_MESH_MOVING &&
           !((const struct gm_mesh_row *)scheme->coefficients)->multiplied;
}

double gm_mesh_multiplier_norm(const struct gm_run *run)
{
    return gm_run_memory(run)[MEMORY_MULTIPLIER];
}

double gm_mesh_factorisations(const struct gm_run *run)
{
    return gm_run_memory(run)[MEMORY_STAMP];
}

static double *past(double *memory, size_t n, size_t back)
{
    return memory + MEMORY_HEAD + back * n;
}

/* The first guess from the last `order` steps: 1 repeats the last one, 4 is cubic, 6 quintic. */
static void guess(struct gm_mesh_solver *solver, double *memory, size_t order)
{
    const double *steps[PAST];
    for (size_t back = 0; back < PAST; back++) {
        steps[back] = past(memory, solver->matrix.n, back);
    }
    if (order == 0) {
        gm_step_guess(solver, solver->unknowns);
    } else {
        gm_extrapolate(steps, order, solver->unknowns, solver->matrix.n);
    }
}

/* Factors the derivative where the residual has just been evaluated. */
static bool factor(struct gm_mesh_solver *solver)
{
    const size_t points = solver->mesh.points;
    gm_banded_clear(&solver->matrix);
    for (size_t e = 0; e <= points; e++) {
        const struct gm_assembly assembly = {&solver->matrix, points, solver->of.per_node, e};
        gm_step_matrix(solver, &assembly);
    }
    return gm_banded_factor(&solver->matrix);
}

/* Factors the step's matrix and stores its data. False if singular. */
static bool refresh(struct gm_mesh_solver *solver, double *memory)
{
    const size_t n = solver->matrix.n;
    double *made_from = past(memory, n, PAST);
    memcpy(made_from, solver->unknowns, n * sizeof *made_from);
    memcpy(made_from + n, solver->state, 4 * solver->mesh.points * sizeof *made_from);
    memory[MEMORY_STEP] = solver->h;
    memory[MEMORY_TIME] = solver->t;
    solver->stamp = ++memory[MEMORY_STAMP];
    return factor(solver);
}

/* Makes the factors that the memory names, unless the solver has them. If they cannot be made, the step
   makes new ones. */
static void restore(struct gm_mesh_solver *solver, double *memory)
{
    if (memory[MEMORY_STAMP] != solver->stamp) {
        const double *made_from = past(memory, solver->matrix.n, PAST);
        gm_step_place(solver, made_from + solver->matrix.n, memory[MEMORY_TIME], memory[MEMORY_STEP]);
        if (gm_step_residual(solver, made_from) && factor(solver)) {
            solver->stamp = memory[MEMORY_STAMP];
        } else {
            memory[MEMORY_SLOW] = 1;
        }
    }
}

/* unknowns -= share * change; the largest weighted relative change */
static double move(struct gm_mesh_solver *solver, const double *change, double share)
{
    double *unknowns = solver->unknowns, largest = 0, sum = 0;
    const size_t width = solver->of.per_node;
    for (size_t k = 0; k < solver->mesh.points; k++) {
        for (size_t j = 0; j < width; j++) {
            const size_t i = k * width + j;
            unknowns[i] -= share * change[i];
            const double size = solver->weights[j] * fabs(change[i]) / (1 + fabs(unknowns[i]));
            largest = size > largest ? size : largest;
            sum += size;
        }
    }
    return isfinite(sum) ? largest : INFINITY;
}

enum outcome { SOLVED, TANGLED, DIVERGED };

/* Newton's iteration with the factors at hand, from solver->unknowns. */
static enum outcome iterate(struct gm_mesh_solver *solver, double *memory, struct gm_progress *progress)
{
    bool fresh = memory[MEMORY_STAMP] == 0 || memory[MEMORY_SLOW] != 0, refreshed = false;
    double before = INFINITY;
    for (int iteration = 1; iteration <= SIMPLIFIED; iteration++) {
        progress->evaluations++;
        if (!gm_step_residual(solver, solver->unknowns)) {
            return TANGLED;
        }
        if (fresh) {
            if (!refresh(solver, memory)) {
                return DIVERGED;
            }
            fresh = false;
            refreshed = true;
            before = INFINITY;
        }
        gm_banded_solve(&solver->matrix, solver->residual);
        progress->solves++;
        progress->iterations++;
        const double change = move(solver, solver->residual, 1);
        const double ratio = change / before;
        /* the error after this change is about ratio / (1 - ratio) of it */
        const bool stands = iteration > 3 && ratio > 0.5 && change < stagnation(solver);
        if (stands || change < enough(solver) ||
            (ratio > 0 && ratio < contracts && change * ratio < 0.1 * tolerance)) {
            memory[MEMORY_SLOW] = iteration > MANY && !stands;
            return SOLVED;
        }
        if (!(change < INFINITY)) {
            return DIVERGED;
        }
        if (ratio > (iteration == 2 ? 2 : 0.5) || iteration == 7) {
            if (refreshed && ratio > 1) {
                return DIVERGED;
            }
            fresh = !refreshed;
        }
        before = change;
    }
    return DIVERGED;
}

/* Newton's iteration with a new matrix every time; a step is shortened until every cell is positive. */
static enum outcome iterate_fully(struct gm_mesh_solver *solver, double *memory, struct gm_progress *progress)
{
    const size_t n = solver->matrix.n;
    enum outcome failure = DIVERGED;
    progress->evaluations++;
    if (!gm_step_residual(solver, solver->unknowns)) {
        return TANGLED;
    }
    double before = INFINITY;
    for (int iteration = 1; iteration <= FULL; iteration++) {
        if (!refresh(solver, memory)) {
            return failure;
        }
        gm_banded_solve(&solver->matrix, solver->residual);
        progress->solves++;
        progress->iterations++;
        memcpy(solver->trial, solver->residual, n * sizeof *solver->trial);
        double share = 1;
        for (int halving = 0;; halving++) {
            const double change = move(solver, solver->trial, share);
            if (!(change < INFINITY)) {
                return failure;
            }
            progress->evaluations++;
            if (gm_step_residual(solver, solver->unknowns)) {
                if (share == 1 &&
                    (change < enough(solver) || (change > before / 2 && change < stagnation(solver)))) {
                    memory[MEMORY_SLOW] = 0;
                    return SOLVED;
                }
                before = change;
                break;
            }
            failure = TANGLED;
            if (halving == HALVINGS) {
                return failure;
            }
            /* back, and half as far */
            move(solver, solver->trial, -share);
            share /= 2;
        }
    }
    return failure;
}

static void remember(struct gm_mesh_solver *solver, double *memory)
{
    const size_t n = solver->matrix.n;
    memmove(past(memory, n, 1), past(memory, n, 0), (PAST - 1) * n * sizeof *memory);
    memcpy(past(memory, n, 0), solver->unknowns, n * sizeof *memory);
    memory[MEMORY_PAST] = fmin(PAST, memory[MEMORY_PAST] + 1);
}

/* Solves for the step from `state`; leaves the unknowns in solver->unknowns, the residual's by-products
   beside them, and stores both in the memory. */
static enum gm_status solve(struct gm_mesh_solver *solver, double *memory, const double *state, double t,
                            double h, struct gm_progress *progress)
{
    const size_t known = (size_t)fmin(PAST, fmax(0, memory[MEMORY_PAST])); /* a file may hold any number */
    restore(solver, memory);
    gm_step_place(solver, state, t, h);
    guess(solver, memory, known);
    enum outcome outcome = iterate(solver, memory, progress);
    bool tangled = false;
    for (size_t order = known; outcome != SOLVED; order--) {
        guess(solver, memory, order);
        outcome = iterate_fully(solver, memory, progress);
        tangled |= outcome == TANGLED;
        if (order <= 1) {
            break;
        }
    }
    if (outcome != SOLVED) {
        return tangled ? GM_MESH_CROSSING : GM_NO_CONVERGENCE;
    }
    remember(solver, memory);
    progress->evaluations++;
    return gm_step_residual(solver, solver->unknowns) ? GM_OK : GM_MESH_CROSSING;
}

/* Sets the tolerances of a step of this length. */
static void scale(struct gm_mesh_solver *solver, double h)
{
    const struct gm_mesh_layout *of = &solver->of;
    /* a single velocity is found more sharply: it takes that to undo 200 steps, and to see the local law, to 1e-11 */
    const double sharp = of->stride == 0 ? 30 : 1;
    solver->noise = DBL_EPSILON * solver->mesh.length / fabs(h);
    for (size_t i = 0; i < of->per_node; i++) {
        /* multipliers of constraints on places carry round-off divided by the squared step */
        solver->weights[i] = sharp * (of->multiplier > 0 && i >= of->multiplier ? fabs(h) : 1);
    }
}

/* The rate of log sigma of time-symmetric steps (core/mesh/families/adaptive.c). */
static double growth(struct gm_mesh_solver *solver, const double *state)
{
    const struct gm_elements *at = &solver->ends;
    double sum = gm_pow(0.208 * solver->mesh.length / (double)at->count, -4), change = 0;
    gm_elements_place(&solver->ends, state);
    for (size_t e = 0; e < at->count; e++) {
        const double d = at->x[e + 1] - at->x[e], weight = 1 / (d * d * d * d);
        sum += weight;
        change -= weight * (at->v[e + 1] - at->v[e]) / d;
    }
    return change / (2 * sum);
}

struct gm_progress gm_mesh_loop(const struct gm_task *task)
{
    struct gm_mesh_solver *solver = task->workspace;
    const struct gm_mesh *mesh = &solver->mesh;
    const bool adaptive = task->scheme->family->adaptive;
    const size_t size = mesh->points * sizeof(double);
    double *memory = task->memory_out, *state = mesh->alone ? solver->whole : task->out,
           *rho = adaptive ? density(task) : NULL;
    struct gm_progress progress = {.status = GM_OK, .t = task->t};
    if (task->out != task->y) {
        memcpy(task->out, task->y, task->problem->n * sizeof *state);
        memcpy(memory, task->memory, gm_mesh_memory(task->problem, task->scheme) * sizeof *memory);
    }
    if (mesh->alone) {
        memset(state, 0, 4 * size);
        memcpy(state + mesh->points, task->out, size);
        memcpy(state + 3 * mesh->points, task->out + mesh->points, size);
    }
    while (progress.done < task->steps && (!adaptive || progress.t < task->until)) {
        const double half = adaptive ? *rho + task->dt / 2 * growth(solver, state) : 1, h = task->dt / half,
                     t = task->t0 + (double)(task->n + progress.done) * task->dt;
        if (!(half > 1e-3 && half < 1e3)) {
            progress.status = GM_STEP_COLLAPSE;
            break;
        }
        scale(solver, h);
        progress.status = solve(solver, memory, state, t, h, &progress);
        if (progress.status == GM_OK) {
            progress.status = gm_step_end(solver, &memory[MEMORY_MULTIPLIER]);
        }
        if (progress.status == GM_OK) {
            progress.status = store(solver, state, task->limit);
        }
        if (progress.status != GM_OK) {
            break;
        }
        if (adaptive) {
            *rho = half + task->dt / 2 * growth(solver, state);
            progress.t += h;
        }
        progress.done++;
    }
    if (mesh->alone) {
        memcpy(task->out, state + mesh->points, size);
        memcpy(task->out + mesh->points, state + 3 * mesh->points, size);
    }
    return progress;
}
