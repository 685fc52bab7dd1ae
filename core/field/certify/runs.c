/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Short runs of a field: forward and back, for conserved quantities, and on finer and finer grids. */
#include "core/field/certify/runs.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/field/multisymplectic.h"
#include "core/functions/functions.h"

static const struct gm_settings no_settings;

/* The number of values of the field in a state: u, or all components, without those that only a two-step
   scheme holds. */
static size_t numbers_of(const struct gm_problem *problem)
{
    return problem->n == gm_wave_size(problem->line.points) ? problem->line.points : problem->n;
}

double gm_field_size(const struct gm_problem *problem, const double *y)
{
    double size = 1;
    for (size_t i = 0; i < numbers_of(problem); i++) {
        size = fmax(size, fabs(y[i]));
    }
    return size;
}

bool gm_field_begin(struct gm_field_subject *subject, const double *y)
{
    subject->run = gm_run_open(&subject->problem, subject->scheme, &no_settings, 0, subject->dt, y);
    return subject->run != NULL;
}

/* Returns true if a component has a rate of its own. The others follow by slopes and sums, with round-off
   and, if they begin as sums, with the errors of these. */
static bool moves(const struct gm_problem *problem, size_t component)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    const bool all = form && form->hessians;
    bool rate = !all;
    for (size_t row = 0; all && row < form->dimension; row++) {
        rate = rate || form->m[row * form->dimension + component] != 0;
    }
    for (size_t k = 0; all && k < form->potential_count; k++) {
        rate = rate && form->potentials[k].component != component;
    }
    return rate;
}

/* The largest difference of two states at common nodes: `other` has `finer` nodes for each of the
   problem's. */
static double apart(const struct gm_problem *problem, const double *y, const double *other, size_t finer)
{
    const size_t points = problem->line.points, components = numbers_of(problem) / points;
    double largest = 0;
    for (size_t c = 0; c < components; c++) {
        for (size_t i = 0; i < points && moves(problem, c); i++) {
            largest = gm_larger(fabs(y[c * points + i] - other[finer * (c * points + i)]), largest);
        }
    }
    return largest;
}

/* Forth 8 steps, back 7: the distance from the level after the first. Two-step schemes come back along their
   levels. */
static double return_defect(struct gm_field_subject *subject, const double *y)
{
    const size_t numbers = numbers_of(&subject->problem);
    double *first = malloc(numbers * sizeof *first), largest = INFINITY;
    if (first && gm_field_begin(subject, y)) {
        gm_run_advance(subject->run, 1);
        memcpy(first, gm_run_state(subject->run), numbers * sizeof *first);
        gm_run_advance(subject->run, 7);
        gm_run_set_step(subject->run, -subject->dt);
        if (gm_run_advance(subject->run, 7) == GM_OK) {
            largest = apart(&subject->problem, gm_run_state(subject->run), first, 1);
        }
        gm_run_close(subject->run);
    }
    free(first);
    return largest;
}

/* The factor of a number in slopes in space and time. */
static double slopes_of(const struct gm_field_subject *subject)
{
    return 1 + 1 / fabs(subject->dt) + 1 / subject->problem.line.dx;
}

/* A bound of the round-off in slopes in space and time of a state, multiplied by a scheme's equations. */
static double round_off(const struct gm_field_subject *subject, const double *y)
{
    enum { MULTIPLIED = 100 };
    return MULTIPLIED * DBL_EPSILON * gm_field_size(&subject->problem, y) * slopes_of(subject);
}

/* Notes a defect; one below `hidden`, the round-off, refutes no claim. */
static void note(struct gm_certificate *certificate, enum gm_claim claim, double defect, double hidden,
                 const char *name)
{
    if (defect > gm_certificate_claim(certificate, claim)->tolerance && defect < hidden) {
        gm_certificate_withhold(
            certificate, claim,
            "round-off hides it: the numbers are too large for so short a dt or so fine a grid");
    } else {
        gm_certificate_note(certificate, claim, defect, name);
    }
}

void gm_field_note_form(struct gm_certificate *certificate, struct gm_field_subject *subject, const double *y,
                        double size)
{
    /* tangents are differences over so much of a unit wave, of which the law takes slopes again; solves of
       steps that are long beside dx add as much as ten times that */
    const double over = 0.05 / 8 / 10;
    const char *const name = subject->problem.name;
    note(certificate, GM_SYMMETRIC, return_defect(subject, y) / size, round_off(subject, y) / size, name);
    if (!gm_field_begin(subject, y)) {
        return;
    }
    gm_run_advance(subject->run, 25);
    const double *const now = gm_run_state(subject->run);
    const double defect =
        gm_form_defect(&subject->problem, subject->scheme, subject->dt, now, gm_run_memory(subject->run));
    if (!isnan(defect)) {
        gm_certificate_claim(certificate, GM_MULTISYMPLECTIC)->tolerance = 1e-8;
        note(certificate, GM_MULTISYMPLECTIC, defect, round_off(subject, now) * slopes_of(subject) / over,
             name);
    } else if (subject->scheme->family->form) {
        gm_certificate_withhold(certificate, GM_MULTISYMPLECTIC,
                                "the step could not be differentiated at this state");
    }
    gm_run_close(subject->run);
}

void gm_field_note_kept(struct gm_certificate *certificate, enum gm_claim claim,
                        struct gm_field_subject *subject, const double *y, const struct gm_kept *kept,
                        const char *name)
{
    double change = INFINITY;
    if (gm_field_begin(subject, y)) {
        gm_run_advance(subject->run, 1);
        const double before =
            kept->value(kept->data, gm_run_state(subject->run), gm_run_memory(subject->run));
        if (gm_run_advance(subject->run, GM_FIELD_STEPS - 1) == GM_OK) {
            const double after =
                kept->value(kept->data, gm_run_state(subject->run), gm_run_memory(subject->run));
            change = fabs(after - before) / fmax(1, fabs(before));
        }
        gm_run_close(subject->run);
    }
    note(certificate, claim, change, round_off(subject, y), name);
}

double gm_field_order_in_time(const struct gm_field_subject *subject, const double *y, double until)
{
    const size_t n = subject->problem.n;
    double *end = calloc(3 * n, sizeof *end), change[2] = {0};
    bool good = end != NULL;
    for (int k = 0; good && k < 3; k++) {
        const struct gm_trial trial = {&subject->problem, subject->scheme, &no_settings,
                                       ldexp(subject->dt, -k), (int64_t)lround(until / subject->dt) << k};
        good = gm_trial_advance(&trial, y, end + (size_t)k * n);
    }
    for (size_t k = 0; good && k < 2; k++) {
        change[k] = gm_distance(end + k * n, end + (k + 1) * n, subject->problem.line.points);
    }
    free(end);
    return good ? gm_log2(change[0] / change[1]) : NAN;
}

/* ---- on finer and finer grids ---- */

enum { LEVELS = 4, STEPS = 16 };

/* The errors of runs, and by how much each differs from the next finer one. */
struct refined {
    double dt[LEVELS], error[LEVELS], change[LEVELS]; /* error: NaN without an exact solution */
    size_t count;
};

/* Adds a level; returns its state, which the caller frees. NULL if a step fails or when out of memory. */
static double *refine(const struct gm_certified_system *system, const struct gm_scheme *scheme,
                      struct refined *refined)
{
    const size_t k = refined->count;
    const int64_t steps = (int64_t)STEPS << k;
    const struct gm_trial trial = {system->problem, scheme, &no_settings, system->dt, steps};
    double *end = malloc(system->problem->n * sizeof *end);
    if (!end || !gm_trial_advance(&trial, system->start, end)) {
        free(end);
        return NULL;
    }
    refined->dt[k] = system->dt;
    refined->error[k] =
        system->error ? system->error(system->error_data, (double)steps * system->dt, end) : NAN;
    refined->count++;
    return end;
}

/* An exact solution closes on its ring up to a thousandth of its size. If that hides the remaining error,
   differences give the order. */
static double tell(const struct refined *refined, double by_differences, double wanted, double size,
                   struct gm_ladder *ladder, const char **reason)
{
    const size_t last = refined->count - 1;
    const double by_errors = gm_log2(refined->error[last - 1] / refined->error[last]);
    const bool exactly =
        by_errors > wanted || refined->error[last] > 2 * refined->change[last - 1] + 1e-3 * size;
    ladder->count = exactly ? last + 1 : last;
    for (size_t k = 0; k < ladder->count; k++) {
        ladder->dt[k] = refined->dt[k];
        ladder->error[k] = exactly ? refined->error[k] : refined->change[k];
    }
    ladder->settled = true;
    *reason = exactly && by_errors < wanted && by_differences > by_errors + 0.5
                  ? "runs agree with one another, but not with the solution of exact:"
                  : NULL;
    return exactly ? by_errors : by_differences;
}

/* The largest difference of this order of the start around the ring. */
static double largest_difference(const struct gm_certified_system *system, int order)
{
    const struct gm_grid1 *grid = &system->problem->line;
    const size_t points = grid->points;
    double largest = 0;
    for (size_t c = 0; c < system->problem->n / points; c++) {
        for (size_t i = 0; i < points && moves(system->problem, c); i++) {
            double sum = 0, weight = 1;
            for (int j = 0; j <= order; j++) {
                const size_t node = i + (size_t)j;
                sum += weight *
                       (system->start[c * points + node % points] + grid->jump * (double)(node / points));
                weight *= -(double)(order - j) / (j + 1);
            }
            largest = fmax(fabs(sum), largest);
        }
    }
    return largest;
}

/* Returns true if a start has the derivatives that an order needs: if one jumps, differences fall by less
   from grid to grid. */
static bool is_smooth(const struct gm_certified_system *coarse, const struct gm_certified_system *fine,
                      int order)
{
    const int differences = order + 2;
    const double on_coarse = largest_difference(coarse, differences),
                 on_fine = largest_difference(fine, differences),
                 round_off = ldexp(8 * DBL_EPSILON, differences) * gm_field_size(fine->problem, fine->start);
    return on_fine <= round_off || gm_log2(on_coarse / on_fine) > differences - 0.5;
}

double gm_field_order(const struct gm_certified_system *system, const struct gm_scheme *scheme,
                      struct gm_ladder *ladder, const char **reason)
{
    const double wanted = scheme->order - 0.15;
    struct refined refined = {.count = 0};
    double *before = NULL, size = 1, order = NAN, slope_before = NAN;
    const struct gm_certified_system *coarse = NULL;
    bool smooth = true;
    *reason =
        "differences between runs on finer and finer grids do not fall by one power: take more points and a "
        "shorter dt, or a start that closes better on its ring";
    for (; system && refined.count < LEVELS && isnan(order); system = system->finer) {
        const size_t k = refined.count;
        double *state = refine(system, scheme, &refined);
        if (!state) {
            *reason = "a run on a finer grid fails";
            break;
        }
        if (k == 0) {
            size = gm_field_size(system->problem, system->start);
        } else {
            const double change = apart(coarse->problem, before, state, 2);
            const double slope = k > 1 ? gm_log2(refined.change[k - 2] / change) : NAN;
            refined.change[k - 1] = change;
            if (change < 1e-11 * size) {
                *reason = "differences between runs on finer grids do not exceed round-off";
                free(state);
                break;
            }
            /* an order above that which is claimed may be one of grids that are too coarse for it */
            const double by_errors = gm_log2(refined.error[k - 1] / refined.error[k]);
            const bool told = fabs(by_errors - scheme->order) < 0.15 || fabs(slope - scheme->order) < 0.15 ||
                              fabs(slope - slope_before) < 0.15 ||
                              (slope > wanted && (k + 1 == LEVELS || !system->finer));
            if (told) {
                order = tell(&refined, slope, wanted, size, ladder, reason);
                smooth = !(order < wanted) || is_smooth(coarse, system, scheme->order);
            }
            slope_before = slope;
        }
        coarse = system;
        free(before);
        before = state;
    }
    free(before);
    if (!smooth) {
        *reason = "the start, or the way it closes on its ring, is not as smooth as the order asks for";
        *ladder = (struct gm_ladder){0};
        return NAN;
    }
    return order;
}
