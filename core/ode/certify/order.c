/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of a scheme, as the slope of its error against dt. The reference is GSL's Prince-Dormand stepper,
   which shares no code with the schemes. */
#include <math.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "core/functions/functions.h"
#include "core/ode/certify/measure.h"
#include "core/ode/kernel/loops.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/certify.h"

/* The error is summed over several times: at a single one it may happen to vanish. */
enum { TIMES = 4, STEPS = 400 /* of the reference with events, between two times */ };

static int field_for_gsl(double t, const double y[], double f[], void *problem)
{
    (void)t;
    gm_field(problem, y, f, 1);
    return GSL_SUCCESS;
}

/* The same by short steps of a high order, which meet the events. */
static bool solve_with_events(const struct gm_problem *problem, double until, int64_t steps, double *y)
{
    const struct gm_settings settings = {.compensated = 1};
    const struct gm_trial trial = {problem, gm_scheme_find_for("gauss8", problem), &settings,
                                   until / (double)steps, steps};
    return gm_trial_advance(&trial, y, y);
}

static bool has_events(const struct gm_problem *problem)
{
    return problem->events && (problem->events->changes || problem->events->breaks > 0);
}

/* y := the solution at `until`, from y */
static bool solve_by_gsl(const struct gm_problem *problem, double until, double *y)
{
    struct gm_problem copy = *problem;
    return has_events(problem)
               ? solve_with_events(problem, until, STEPS, y)
               : gm_certify_solve(&(gsl_odeiv2_system){field_for_gsl, NULL, problem->n, &copy}, 1e-15, until,
                                  y);
}

/* The solution at k until / TIMES, k = 1.., one after the other; with events, which may depend on the time, each from the
   start. */
static bool solve_at_times(const struct gm_subject *subject, double until,
                           double exact[TIMES][GM_SUBJECT_COMPONENTS])
{
    const size_t size = subject->problem.n * sizeof(double);
    const bool again = has_events(&subject->problem);
    double y[GM_SUBJECT_COMPONENTS];
    for (int k = 0; k < TIMES; k++) {
        if (again || k == 0) {
            memcpy(y, subject->start, size);
        }
        if (!(again ? solve_with_events(&subject->problem, (k + 1) * until / TIMES, (k + 1) * STEPS, y)
                    : solve_by_gsl(&subject->problem, until / TIMES, y))) {
            return false;
        }
        memcpy(exact[k], y, size);
    }
    return true;
}

struct trial {
    double error; /* infinite: the run failed; NaN: out of memory */
    double step;  /* mean length of a scheme's own steps by a tolerance */
};

static struct trial make_trial(const struct gm_subject *subject, const struct gm_settings *settings,
                               double dt, int64_t steps_between, double exact[TIMES][GM_SUBJECT_COMPONENTS])
{
    struct gm_run *run = gm_run_open(&subject->problem, subject->scheme, settings, 0, dt, subject->start);
    if (!run) {
        return (struct trial){.error = NAN};
    }
    double sum = 0;
    for (int k = 0; k < TIMES; k++) {
        gm_run_advance(run, steps_between);
        sum += gm_distance(gm_run_state(run), exact[k], subject->problem.n);
    }
    const struct trial trial = {run->status == GM_OK ? sum : INFINITY, run->t / (double)run->own_steps};
    gm_run_close(run);
    return trial;
}

/* Returns the error of an adaptive scheme against the solution at the time that it reached; infinite: the run failed. */
static double error_at_own_time(const struct gm_subject *subject, const struct gm_settings *settings,
                                double dt, double until)
{
    struct gm_run *run = gm_run_open(&subject->problem, subject->scheme, settings, 0, dt, subject->start);
    if (!run) {
        return NAN;
    }
    double exact[GM_SUBJECT_COMPONENTS], error = NAN;
    memcpy(exact, subject->start, subject->problem.n * sizeof *exact);
    if (gm_run_until(run, until) != GM_OK) {
        error = INFINITY;
    } else if (solve_by_gsl(&subject->problem, run->t, exact)) {
        error = gm_distance(gm_run_state(run), exact, subject->problem.n);
    }
    gm_run_close(run);
    return error;
}

/* the slope by least squares */
static double slope(const double *x, const double *y, int count)
{
    double mean_x = 0, mean_y = 0, above = 0, below = 0;
    for (int i = 0; i < count; i++) {
        mean_x += x[i] / count;
        mean_y += y[i] / count;
    }
    for (int i = 0; i < count; i++) {
        above += (x[i] - mean_x) * (y[i] - mean_y);
        below += (x[i] - mean_x) * (x[i] - mean_x);
    }
    return above / below;
}

/* Returns the slope against the tolerance or, for a scheme with an order, against the mean step. */
static double measure_by_tolerance(const struct gm_subject *subject)
{
    enum { LADDER = 4 };
    const double until = 10 * subject->unit;
    double exact[TIMES][GM_SUBJECT_COMPONENTS], x[LADDER], e[LADDER];
    if (!solve_at_times(subject, until, exact)) {
        return NAN;
    }
    /* a step of dt meets each event, which one over the whole time would jump over */
    const int64_t between = subject->problem.events ? (int64_t)ceil(until / (TIMES * fabs(subject->dt))) : 1;
    for (int i = 0; i < LADDER; i++) {
        const struct gm_settings settings = {.tolerance = gm_pow(10, -4 - 2 * i)};
        const struct trial trial =
            make_trial(subject, &settings, until / (double)(TIMES * between), between, exact);
        if (i == 0 && trial.error <= 1e-12 * subject->scale) {
            return NAN; /* it is exact here, up to round-off */
        }
        x[i] = gm_log(subject->scheme->family->by_tolerance ? trial.step : settings.tolerance);
        e[i] = gm_log(trial.error);
    }
    return slope(x, e, LADDER);
}

double gm_measure_order(const struct gm_subject *subject, struct gm_ladder *ladder)
{
    enum { PER_OCTAVE = 4, COARSER = 2 * PER_OCTAVE, FITTED = PER_OCTAVE + 1, HALF = FITTED / 2 + 1 };
    const struct gm_scheme *scheme = subject->scheme;
    *ladder = (struct gm_ladder){.count = 0};
    if (scheme->order == 0 || scheme->family->by_tolerance) {
        const double order = measure_by_tolerance(subject);
        ladder->settled = !isnan(order);
        return order;
    }
    /* The higher the order, the longer the time until round-off is small against the error. Variational
       schemes with a varying time may not reach a turning point. */
    const bool adaptive = scheme->family->adaptive;
    const bool varies_time = scheme->family->parameters == gm_settings_of_variational_time;
    const double span = varies_time ? 0.4 : scheme->order < 5 ? 2 : 10;
    const double plateau = 1e-12 * subject->scale, ceiling = 0.1 * subject->scale,
                 until = span * subject->unit;
    double exact[TIMES][GM_SUBJECT_COMPONENTS];
    if (!adaptive && !solve_at_times(subject, until, exact)) {
        return NAN;
    }
    /* the finest steps, a factor of two apart, whose error exceeds round-off */
    double x[GM_LADDER], e[GM_LADDER];
    int count = 0;
    int64_t between = 0;
    ladder->fails = true;
    /* the highest orders exceed round-off at large steps only */
    for (int i = scheme->order > 8 ? -COARSER : 0; i < GM_LADDER - COARSER; i++) {
        const int64_t before = between;
        const double finer = (adaptive ? 8 : span) / TIMES * gm_pow(2, 1 + (double)i / PER_OCTAVE);
        between = lround(finer);
        if (!adaptive && between == before) {
            continue;
        }
        const double dt = until / (TIMES * (adaptive ? finer : (double)between));
        const struct gm_settings settings = gm_subject_settings(dt);
        const double error = adaptive ? error_at_own_time(subject, &settings, dt, until)
                                      : make_trial(subject, &settings, dt, between, exact).error;
        ladder->fails = ladder->fails && isinf(error);
        if (error < plateau) {
            break;
        }
        ladder->large = !(error < ceiling);
        if (error < ceiling) {
            x[count] = gm_log(ladder->dt[count] = dt);
            e[count] = gm_log(ladder->error[count] = error);
            ladder->count = (size_t)++count;
        }
    }
    /* near round-off, errors that do not fall with the step are those of the reference */
    while (count > 1 && ladder->error[count - 1] < 100 * plateau &&
           ladder->error[count - 1] > 0.9 * ladder->error[count - 2]) {
        ladder->count = (size_t)--count;
    }
    if (count < FITTED) {
        return NAN;
    }
    const double finest = slope(x + count - FITTED, e + count - FITTED, FITTED);
    const int coarser = count - FITTED - PER_OCTAVE;
    const double earlier = coarser >= 0 ? slope(x + coarser, e + coarser, FITTED) : NAN;
    /* An order that still grows with shorter steps may reach that of the scheme. Errors that do not fall at all are
       settled. */
    const double coarse = slope(x + count - FITTED, e + count - FITTED, HALF),
                 fine = slope(x + count - HALF, e + count - HALF, HALF);
    const bool grows = finest <= 0.95 * scheme->order && 2 * fine - coarse > 0.95 * scheme->order;
    ladder->settled = fabs(earlier - finest) < 0.05 * fmax(finest, 1) && !grows;
    return finest;
}
