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
#include "core/ode/families/adaptive/variational_time.h"
#include "core/ode/families/base_scheme.h"
#include "core/ode/families/family.h"
#include "core/schemes.h"

struct row {
    const char *base; /* Phi */
    bool by_error;
};

enum { CONTROL, SLOPE, TIME_CARRY, REMEMBERED }; /* the memory; CONTROL is rho / Q, or h */

struct work {
    struct gm_base_scheme base; /* Phi */
    double density;             /* Q at `after`; 0: not known */
    double *after, *carry;      /* n each: after a step */
    double *field, *gradient;   /* n */
};

static void *open_work(struct gm_members *members, const struct gm_problem *problem,
                       const struct gm_scheme *scheme)
{
    const struct row *row = scheme->coefficients;
    struct work *work = gm_arena_take(members->arena, 1, sizeof *work);
    gm_base_open(members->arena, &work->base, gm_scheme_find(row->base), problem, 1);
    work->after = members->scratch;
    work->carry = work->after + members->n;
    work->field = work->carry + members->n;
    work->gradient = work->field + members->n;
    return work;
}

static void workspace_reset(void *data)
{
    struct work *work = ((struct gm_members *)data)->family;
    work->density = 0;
    gm_base_reset(&work->base);
}

/* Computes Q and G at y; false if Q is not a density. If Q depends on coordinates alone and q' = p, no force
   is evaluated. */
static bool look(const struct gm_problem *problem, struct work *work, const double *y, double *slope,
                 struct gm_progress *progress)
{
    const struct gm_ode *ode = gm_ode_of(problem);
    const bool moves_by_momenta = ode->monitor->of_places && ode->split && ode->split->unit_mass;
    const size_t count = moves_by_momenta ? problem->n / 2 : problem->n;
    const double *rates = moves_by_momenta ? y + count : work->field;
    ode->monitor->density(problem, y, &work->density, work->gradient);
    if (!moves_by_momenta) {
        gm_field(problem, y, work->field, 1);
        progress->evaluations++;
    }
    *slope = 0;
    for (size_t c = 0; c < count; c++) {
        *slope += work->gradient[c] * rates[c];
    }
    *slope /= work->density;
    return work->density > 0 && isfinite(work->density) && isfinite(*slope);
}

/* the length of y_{n+1} - y_n - h f(y_n) */
static double error_of(const struct gm_problem *problem, const struct work *work, double h, const double *y)
{
    double sum = 0;
    gm_field(problem, y, work->field, 1);
    for (size_t c = 0; c < problem->n; c++) {
        const double difference = work->after[c] - y[c] - h * work->field[c];
        sum += difference * difference;
    }
    return sqrt(sum);
}

static enum gm_status monitored_step(const struct gm_task *task, struct work *work, const double *y,
                                     double *memory, double *h, struct gm_progress *progress)
{
    const struct gm_problem *problem = task->problem;
    const double half = task->dt / 2;
    if (work->density == 0 || memcmp(work->after, y, problem->n * sizeof *y) != 0) {
        gm_ode_of(problem)->monitor->density(problem, y, &work->density, NULL);
    }
    const double middle = memory[CONTROL] * work->density + half * memory[SLOPE];
    *h = 2 * half / middle;
    if (!(middle > 0 && isfinite(middle) && *h != 0)) {
        return GM_STEP_COLLAPSE;
    }
    const enum gm_status status = gm_base_step(&work->base, *h, y, work->after, progress);
    if (status != GM_OK) {
        return status;
    }
    if (!look(problem, work, work->after, &memory[SLOPE], progress)) {
        return GM_STEP_COLLAPSE;
    }
    memory[CONTROL] = (middle + half * memory[SLOPE]) / work->density;
    return memory[CONTROL] > 0 ? GM_OK : GM_STEP_COLLAPSE;
}

/* The next step is at most 5 times, and at least a fifth as long. */
static enum gm_status error_controlled_step(const struct gm_task *task, struct work *work, const double *y,
                                            double *memory, double *h, struct gm_progress *progress)
{
    const double ds = task->dt;
    double error = 0;
    do {
        *h = memory[CONTROL];
        const enum gm_status status = gm_base_step(&work->base, *h, y, work->after, progress);
        if (status != GM_OK) {
            return status;
        }
        error = error_of(task->problem, work, *h, y);
        progress->evaluations++;
        memory[CONTROL] = *h * fmin(5, fmax(0.2, fabs(ds) / sqrt(error)));
    } while (error > 2 * ds * ds);
    return GM_OK;
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct row *row = task->scheme->coefficients;
    struct work *work = members->family;
    const size_t bytes = members->n * sizeof(double);
    double h;
    gm_base_begin(&work->base, task);
    work->base.step.carry = members->carry;
    work->base.step.carry_out = work->carry;
    const enum gm_status status = (row->by_error ? error_controlled_step : monitored_step)(
        task, work, members->y, members->memory, &h, progress);
    if (status != GM_OK) {
        return status;
    }
    memcpy(members->y, work->after, bytes);
    if (members->carry) {
        memcpy(members->carry, work->carry, bytes);
    }
    return gm_members_pass(progress, h, &members->memory[TIME_CARRY]);
}

static enum gm_status start(const struct gm_task *task)
{
    const struct row *row = task->scheme->coefficients;
    struct work *work = ((struct gm_members *)task->workspace)->family;
    double *memory = task->memory_out, h;
    struct gm_progress none = {0};
    if (row->by_error) {
        gm_base_begin(&work->base, task);
        work->base.step.carry = task->carry;
        work->base.step.carry_out = work->carry;
        memory[CONTROL] = task->dt;
        return error_controlled_step(task, work, task->y, memory, &h, &none);
    }
    const bool good = look(task->problem, work, task->y, &memory[SLOPE], &none);
    work->density = 0; /* it is not that at `after` */
    memory[CONTROL] = memory[CONTROL] > 0 ? memory[CONTROL] : 1;
    return good ? GM_OK : GM_STEP_COLLAPSE;
}

static const char *lacks(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    const struct row *row = scheme->coefficients;
    return row->by_error ? gm_lacks_events(scheme, problem) : NULL;
}

static const struct row verlet = {.base = "verlet"}, blanes_moan4 = {.base = "blanes-moan4"},
                        blanes_moan_nystrom6 = {.base = "blanes-moan-nystrom6"},
                        kahan_li8 = {.base = "kahan-li8"}, gauss4 = {.base = "gauss4"},
                        gauss8 = {.base = "gauss8"}, verlet_by_error = {.base = "verlet", .by_error = true};

const struct gm_family gm_family_controlled_steps = {
    .title = "controlled steps",
    GM_MEMBERS_WITH_MEMORY(controlled_steps, .step = step, .open = open_work, .remembered = REMEMBERED,
                           .vectors = 4),
    .parameters = gm_settings_of_sums,
    .start = start,
    .workspace_reset = workspace_reset,
    .lacks = lacks,
    .adaptive = true,
};
