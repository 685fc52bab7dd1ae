/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steppers of the GNU Scientific Library, to compare with: RK4, Prince & Dormand's of order 8, the Adams and
   the backward differentiation formulae. The parameter `tolerance` defines a step of length dt:
       0      one step of the library, without error control
       > 0    the library's adaptive driver over dt, with that absolute and relative tolerance
   The multistep methods choose order and step themselves, so for them 0 means 1e-8; they store their past,
   and such a run cannot be resumed bit for bit. GSL manual, chapter "Ordinary differential
   equations". */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include "core/memory.h"
#include "core/ode/families/family.h"

/* default tolerance of the multistep methods */
#define STANDARD_TOLERANCE 1e-8
/* of a driver within dt: where a motion slides along a jump of its rates there is no end to them */
enum { MOST_STEPS = 100000 };

struct workspace {
    struct gm_arena *arena; /* owns all of this */
    const struct gm_problem *problem;
    const gsl_odeiv2_step_type *type;
    unsigned long evaluations, solves;
    gsl_odeiv2_system system;
    gsl_odeiv2_driver **drivers; /* one for each member, because each has its own past */
    double dt, tolerance;        /* the settings of the drivers */
    double *state;               /* n * m, after the last good step */
    double *y;                   /* n */
    int64_t good;                /* number of the last good step, counted from the run's first */
    enum gm_status status;       /* why the step after it failed */
};

static int field(double t, const double y[], double f[], void *parameters)
{
    (void)t;
    struct workspace *workspace = parameters;
    gm_field(workspace->problem, y, f, 1);
    workspace->evaluations++;
    for (size_t c = 0; c < workspace->problem->n; c++) {
        if (!isfinite(f[c])) {
            return GSL_EBADFUNC;
        }
    }
    return GSL_SUCCESS;
}

static int jacobian(double t, const double y[], double *dfdy, double dfdt[], void *parameters)
{
    (void)t;
    struct workspace *workspace = parameters;
    const struct gm_problem *problem = workspace->problem;
    gm_ode_of(problem)->loops[GM_ISA_BASELINE]->jacobian(problem, y, dfdy);
    memset(dfdt, 0, problem->n * sizeof *dfdt);
    workspace->solves++;
    return GSL_SUCCESS;
}

static void close_drivers(void *data)
{
    struct workspace *workspace = data;
    for (size_t i = 0; i < workspace->problem->m; i++) {
        if (workspace->drivers[i]) {
            gsl_odeiv2_driver_free(workspace->drivers[i]);
            workspace->drivers[i] = NULL;
        }
    }
}

/* Under the guard. */
static bool make_drivers(void *data)
{
    struct workspace *workspace = data;
    const double tolerance = workspace->tolerance > 0 ? workspace->tolerance : STANDARD_TOLERANCE;
    close_drivers(workspace);
    for (size_t i = 0; i < workspace->problem->m; i++) {
        workspace->drivers[i] = gsl_odeiv2_driver_alloc_y_new(&workspace->system, workspace->type,
                                                              workspace->dt, tolerance, tolerance);
        if (!workspace->drivers[i]) {
            return false;
        }
        gsl_odeiv2_driver_set_nmax(workspace->drivers[i], MOST_STEPS);
    }
    return true;
}

static void open_all(struct gm_arena *arena, void *data)
{
    struct gm_workspace *opening = data;
    const struct gm_problem *problem = opening->problem;
    struct workspace *workspace = opening->opened = gm_arena_take(arena, 1, sizeof *workspace);
    workspace->arena = arena;
    workspace->problem = problem;
    workspace->type = *(const gsl_odeiv2_step_type *const *)opening->scheme->coefficients;
    workspace->system = (gsl_odeiv2_system){field, jacobian, problem->n, workspace};
    workspace->dt = 1;
    workspace->good = -1;
    workspace->drivers = gm_arena_take(arena, problem->m, sizeof *workspace->drivers);
    workspace->state = gm_arena_take(arena, problem->n * problem->m, sizeof *workspace->state);
    workspace->y = gm_arena_take(arena, problem->n, sizeof *workspace->y);
    gm_arena_keep(arena, workspace, close_drivers);
    gm_arena_need(arena, gm_memory_guard_gsl(make_drivers, workspace));
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    return gm_workspace_open(problem, scheme, open_all);
}

static void workspace_reset(void *pointer)
{
    struct workspace *workspace = pointer;
    workspace->good = -1;
    workspace->dt = 0; /* the next step starts without a past */
}

static int advance(struct workspace *workspace, gsl_odeiv2_driver *driver, double t, double dt, double *y)
{
    const bool multistep =
        workspace->type == gsl_odeiv2_step_msadams || workspace->type == gsl_odeiv2_step_msbdf;
    if (workspace->tolerance > 0 || multistep) {
        const double until = t + dt;
        return gsl_odeiv2_driver_apply(driver, &t, until, y);
    }
    double *const error = driver->e->yerr;
    return gsl_odeiv2_step_apply(driver->s, t, dt, y, error, NULL, NULL, &workspace->system);
}

/* One step of all members from workspace->state, in place unless it fails. */
static enum gm_status step(const struct gm_task *task, struct workspace *workspace, double t)
{
    const size_t n = task->problem->n, m = task->problem->m;
    for (size_t i = 0; i < m; i++) {
        gm_member_take(workspace->state, workspace->y, n, m, i);
        const int result = advance(workspace, workspace->drivers[i], t, task->dt, workspace->y);
        if (result == GSL_EBADFUNC) {
            return GM_BLOW_UP;
        }
        if (result != GSL_SUCCESS) {
            return GM_STEP_COLLAPSE; /* the driver's steps have become too small */
        }
        if (!gm_is_within(workspace->y, n, task->limit)) {
            return GM_BLOW_UP;
        }
        gm_member_put(workspace->y, task->out, n, m, i);
    }
    memcpy(workspace->state, task->out, n * m * sizeof(double));
    return GM_OK;
}

static bool set_up(const struct gm_task *task, struct workspace *workspace)
{
    const bool retuned = workspace->tolerance != task->settings->tolerance;
    const bool reversed = workspace->dt != task->dt;
    workspace->tolerance = task->settings->tolerance;
    workspace->dt = task->dt;
    if (retuned && !make_drivers(workspace)) {
        return false;
    }
    for (size_t i = 0; (retuned || reversed) && i < task->problem->m; i++) {
        gsl_odeiv2_driver_reset_hstart(workspace->drivers[i], task->dt);
    }
    return true;
}

struct stretch {
    const struct gm_task *task;
    int64_t done;
};

/* Runs under the guard: a stepper allocates memory for linear equations at every step. */
static bool make_steps(void *data)
{
    struct stretch *stretch = data;
    const struct gm_task *task = stretch->task;
    struct workspace *workspace = task->workspace;
    if (!set_up(task, workspace)) {
        return false;
    }
    while (stretch->done < task->steps && workspace->status == GM_OK) {
        /* a time of the library's own that does not depend on how the run was cut; problems are autonomous */
        workspace->status = step(task, workspace, (double)(task->steps_before + stretch->done) * task->dt);
        stretch->done += workspace->status == GM_OK ? 1 : 0;
    }
    return true;
}

static struct gm_progress loop(const struct gm_task *task)
{
    struct workspace *workspace = task->workspace;
    const size_t size = task->problem->n * task->problem->m * sizeof(double);
    struct gm_progress progress = {.done = task->steps, .status = GM_OK};
    /* the steps before a failed one are requested: they cannot be repeated, but are stored */
    if (workspace->status != GM_OK && workspace->good == task->steps_before + task->steps) {
        memcpy(task->out, workspace->state, size);
        progress.evaluations = workspace->evaluations;
        progress.solves = workspace->solves;
        return progress;
    }
    workspace->evaluations = 0;
    workspace->solves = 0;
    workspace->status = GM_OK;
    memcpy(workspace->state, task->y, size);
    struct stretch stretch = {.task = task};
    if (!gm_memory_guard_gsl(make_steps, &stretch)) {
        workspace->status = GM_OUT_OF_MEMORY;
        workspace->tolerance = NAN; /* no driver's tolerance: all drivers are rebuilt */
    }
    workspace->good = task->steps_before + stretch.done;
    progress.done = stretch.done;
    progress.status = workspace->status;
    progress.evaluations = workspace->evaluations;
    progress.solves = workspace->solves;
    return progress;
}

const struct gm_family gm_family_gsl_steppers = {
    .title = "GSL steppers",
    GM_ROWS(gsl_steppers),
    .parameters = gm_settings_of_tolerance,
    .loop = loop,
    .workspace_open = workspace_open,
    .workspace_close = gm_workspace_close,
    .workspace_reset = workspace_reset,
    .not_resumable = true,
};
