/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Any scheme Phi that knows nothing of the past, by steps h that follow the motion. The run's dt is ds.

   controlled-...: the integrating controller. A monitor Q(y) > 0 is the wanted density of steps, ds = Q dt;
   the density rho is integrated beside the motion,
       G(y)         = dQ/ds = grad Q . f / Q
       rho_{n+1/2}  = rho_n + ds/2 G(y_n),           rho_0 = Q(y_0)
       y_{n+1}      = Phi_h(y_n),   t_{n+1} = t_n + h,   h = ds / rho_{n+1/2}
       rho_{n+1}    = rho_{n+1/2} + ds/2 G(y_{n+1})
   With a symmetric Phi this is a symmetric map of (y, rho), reversible if Phi is: in motions that come back
   the energy error does not drift. The order is Phi's, and the quantities that Phi conserves stay so.
   E. Hairer & G. Soderlind, SIAM J. Sci. Comput. 26 (2005) 1838; Hairer, Lubich & Wanner (2006), section
   VIII.3.2. The memory is rho / Q (0: a new run), G, and the compensation of the sum of times.

   error-controlled-verlet: the usual step size control, an estimate of the local error held at ds^2,
       h_{n+1} = h_n ds / |y_{n+1} - y_n - h_n f(y_n)|^(1/2),
   and a step with an error above 2 ds^2 is repeated. The step depends on the past of the motion, and the
   advantage of a symplectic Phi is lost. The memory is h, 0, and the compensation of the sum of times.
   Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I (1993), section II.4; Hairer, Lubich &
   Wanner (2006), section VIII.1. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/kind.h"
#include "core/ode/families/families.h"
#include "core/ode/families/splitting/splitting.h"
#include "core/ode/kernel/loops.h"
#include "core/ode_scheme_texts.h"
#include "core/schemes.h"

struct row {
    const char *base; /* Phi */
    bool by_error;
};

enum { CONTROL, SLOPE, TIME_CARRY, REMEMBERED }; /* the memory; CONTROL is rho / Q, or h */

struct workspace {
    struct gm_scheme base;          /* Phi */
    struct gm_splitting_row pieces; /* the pieces of Phi, made once, if it is a composition */
    void *base_workspace;           /* workspace of Phi's loop; NULL: not needed */
    double *state, *carry;          /* 2 n each: before and after a step */
    double *field, *gradient;       /* n */
    double storage[];
};

static void workspace_close(void *data)
{
    struct workspace *workspace = data;
    if (workspace && workspace->base_workspace) {
        workspace->base.family->workspace_close(workspace->base_workspace);
    }
    free(workspace);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct row *row = scheme->coefficients;
    const struct gm_scheme *base = gm_scheme_find(row->base);
    const size_t n = problem->n;
    struct workspace *workspace = calloc(1, sizeof *workspace + 6 * n * sizeof(double));
    if (!workspace) {
        return NULL;
    }
    workspace->base = *base;
    if (base->family == &gm_family_splitting) {
        struct gm_splitting made;
        workspace->pieces.splitting = *gm_splitting_of(base->coefficients, &made);
        workspace->base.coefficients = &workspace->pieces;
    }
    workspace->state = workspace->storage;
    workspace->carry = workspace->state + 2 * n;
    workspace->field = workspace->carry + 2 * n;
    workspace->gradient = workspace->field + n;
    if (!gm_scheme_workspace_open(base, problem, &workspace->base_workspace)) {
        workspace_close(workspace);
        return NULL;
    }
    return workspace;
}

static void workspace_reset(void *data)
{
    struct workspace *workspace = data;
    if (workspace->base_workspace && workspace->base.family->workspace_reset) {
        workspace->base.family->workspace_reset(workspace->base_workspace);
    }
}

/* Computes Q and G at y; false if Q is not a density. If Q depends on coordinates alone and q' = p, no force
   is evaluated. */
static bool look(const struct gm_problem *problem, const struct workspace *workspace, const double *y,
                 double *density, double *slope, struct gm_progress *progress)
{
    const struct gm_ode *ode = gm_ode_of(problem);
    const bool moves_by_momenta = ode->monitor->of_places && ode->split && ode->split->unit_mass;
    const size_t count = moves_by_momenta ? problem->n / 2 : problem->n;
    const double *rates = moves_by_momenta ? y + count : workspace->field;
    ode->monitor->density(problem, y, density, workspace->gradient);
    if (!moves_by_momenta) {
        gm_field(problem, y, workspace->field, 1);
        progress->evaluations++;
    }
    *slope = 0;
    for (size_t c = 0; c < count; c++) {
        *slope += workspace->gradient[c] * rates[c];
    }
    *slope /= *density;
    return *density > 0 && isfinite(*density) && isfinite(*slope);
}

/* the length of y_{n+1} - y_n - h f(y_n) */
static double error_of(const struct gm_problem *problem, const struct workspace *workspace, double h,
                       const double *before, const double *after)
{
    double sum = 0;
    gm_field(problem, before, workspace->field, 1);
    for (size_t c = 0; c < problem->n; c++) {
        const double difference = after[c] - before[c] - h * workspace->field[c];
        sum += difference * difference;
    }
    return sqrt(sum);
}

/* The step after one of length h with that error: no more than 5 times, no less than a fifth as long. */
static double next_by_error(double h, double ds, double error)
{
    return h * fmin(5, fmax(0.2, fabs(ds) / sqrt(error)));
}

/* A call of the loop, while it makes its steps: the state goes from one half of the workspace to the other. */
struct course {
    const struct gm_task *task;
    const struct workspace *workspace;
    gm_loop *advance;    /* the loop of Phi */
    struct gm_task step; /* the task of that loop */
    double *memory;
    double density; /* Q at step.y; 0: it is not known */
    struct gm_progress progress;
};

static struct course begin(const struct gm_task *task)
{
    const struct workspace *workspace = task->workspace;
    const size_t n = task->problem->n;
    struct course course = {
        .task = task,
        .workspace = workspace,
        .advance = gm_scheme_loop(&workspace->base, task->problem),
        .step = *task,
        .memory = task->memory_out,
        .progress = {.status = GM_OK, .t = task->t},
    };
    course.step.scheme = &workspace->base;
    course.step.workspace = workspace->base_workspace;
    course.step.steps = 1;
    course.step.steps_before = 0; /* each is a run of its own */
    course.step.y = workspace->state;
    course.step.out = workspace->state + n;
    course.step.memory = course.step.memory_out = NULL;
    memcpy(workspace->state, task->y, n * sizeof(double));
    if (task->carry) { /* a scheme without compensation leaves it unchanged */
        course.step.carry = workspace->carry;
        course.step.carry_out = workspace->carry + n;
        memcpy(workspace->carry, task->carry, n * sizeof(double));
        memcpy(workspace->carry + n, task->carry, n * sizeof(double));
    }
    return course;
}

/* Phi_h */
static enum gm_status make_step(struct course *course, double h)
{
    course->step.dt = h;
    const struct gm_progress made = course->advance(&course->step);
    course->progress.evaluations += made.evaluations;
    course->progress.solves += made.solves;
    course->progress.iterations += made.iterations;
    course->progress.unsolved = made.unsolved;
    return made.done == 1 ? GM_OK : made.status;
}

/* The run continues from the step that was made. */
static void take_step(struct course *course)
{
    struct gm_task *step = &course->step;
    const double *y = step->out, *carry = step->carry_out;
    step->out = (double *)step->y;
    step->y = y;
    step->carry_out = (double *)step->carry;
    step->carry = carry;
}

static enum gm_status monitored_step(struct course *course, double *h)
{
    const struct gm_problem *problem = course->task->problem;
    const double half = course->task->dt / 2;
    double *memory = course->memory;
    if (course->density == 0) {
        gm_ode_of(problem)->monitor->density(problem, course->step.y, &course->density, NULL);
    }
    const double middle = memory[CONTROL] * course->density + half * memory[SLOPE];
    *h = 2 * half / middle;
    if (!(middle > 0 && isfinite(middle) && *h != 0)) {
        return GM_STEP_COLLAPSE;
    }
    const enum gm_status status = make_step(course, *h);
    if (status != GM_OK) {
        return status;
    }
    if (!look(problem, course->workspace, course->step.out, &course->density, &memory[SLOPE],
              &course->progress)) {
        return GM_STEP_COLLAPSE;
    }
    memory[CONTROL] = (middle + half * memory[SLOPE]) / course->density;
    return memory[CONTROL] > 0 ? GM_OK : GM_STEP_COLLAPSE;
}

static enum gm_status error_controlled_step(struct course *course, double *h)
{
    const double ds = course->task->dt;
    double error = 0;
    do {
        *h = course->memory[CONTROL];
        const enum gm_status status = make_step(course, *h);
        if (status != GM_OK) {
            return status;
        }
        error = error_of(course->task->problem, course->workspace, *h, course->step.y, course->step.out);
        course->progress.evaluations++;
        course->memory[CONTROL] = next_by_error(*h, ds, error);
    } while (error > 2 * ds * ds);
    return GM_OK;
}

static struct gm_progress loop(const struct gm_task *task)
{
    const struct row *row = task->scheme->coefficients;
    const size_t bytes = task->problem->n * sizeof(double);
    memcpy(task->memory_out, task->memory, REMEMBERED * sizeof(double));
    struct course course = begin(task);
    struct gm_progress *progress = &course.progress;
    for (; progress->done < task->steps && progress->t < task->until; progress->done++) {
        double h;
        progress->status = row->by_error ? error_controlled_step(&course, &h) : monitored_step(&course, &h);
        if (progress->status != GM_OK) {
            return *progress;
        }
        take_step(&course);
        const double before = progress->t, whole = course.memory[TIME_CARRY] + h;
        progress->t += whole;
        course.memory[TIME_CARRY] = whole + (before - progress->t);
        if (progress->t == before) {
            progress->status = GM_STEP_COLLAPSE;
            return *progress;
        }
    }
    memcpy(task->out, course.step.y, bytes);
    if (task->carry) {
        memcpy(task->carry_out, course.step.carry, bytes);
    }
    return *progress;
}

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    return REMEMBERED * problem->m;
}

static enum gm_status start(const struct gm_task *task)
{
    const struct row *row = task->scheme->coefficients;
    double *memory = task->memory_out;
    if (row->by_error) {
        struct course course = begin(task);
        double h;
        memory[CONTROL] = task->dt;
        return error_controlled_step(&course, &h);
    }
    double density;
    struct gm_progress none = {0};
    const bool good = look(task->problem, task->workspace, task->y, &density, &memory[SLOPE], &none);
    memory[CONTROL] = memory[CONTROL] > 0 ? memory[CONTROL] : 1;
    return good ? GM_OK : GM_STEP_COLLAPSE;
}

#define CONTROLLED(...)                                                                                      \
    .family = &gm_family_controlled_steps, .coefficients = &(const struct row)                               \
    {                                                                                                        \
        __VA_ARGS__                                                                                          \
    }
#define BY_MONITOR(phi, facets) CONTROLLED(.base = phi), .needs = GM_NEEDS_MONITOR | (facets)

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_controlled_verlet2, BY_MONITOR("verlet", GM_NEEDS_SPLIT)},
    {GM_TEXTS_controlled_blanes_moan4, BY_MONITOR("blanes-moan4", GM_NEEDS_SPLIT)},
    {GM_TEXTS_controlled_blanes_moan_nystrom6,
     BY_MONITOR("blanes-moan-nystrom6", GM_NEEDS_SPLIT | GM_NEEDS_NYSTROM)},
    {GM_TEXTS_controlled_kahan_li8, BY_MONITOR("kahan-li8", GM_NEEDS_SPLIT)},
    {GM_TEXTS_controlled_gauss4, BY_MONITOR("gauss4", 0)},
    {GM_TEXTS_controlled_gauss8, BY_MONITOR("gauss8", 0)},
    {GM_TEXTS_error_controlled_verlet, CONTROLLED(.base = "verlet", .by_error = true),
     .needs = GM_NEEDS_SPLIT},
};

const struct gm_family gm_family_controlled_steps = {
    .kind = &gm_kind_ode,
    .title = "controlled steps",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .parameters = gm_settings_of_sums,
    .loop = loop,
    .memory = memory,
    .start = start,
    .workspace_open = workspace_open,
    .workspace_close = workspace_close,
    .workspace_reset = workspace_reset,
    .adaptive = true,
};
