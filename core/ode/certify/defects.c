/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The defects of a scheme's geometry in a step or a short run: of symplecticity, volume, symmetry,
   reversibility, energy and other invariants. The derivative of a step is found by extrapolated differences,
   so it needs nothing from the scheme. A defect refutes a claim only if it exceeds the error of the
   measurement: steps that stretch phase space a millionfold stretch round-off too. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/basics.h"
#include "core/functions/functions.h"
#include "core/linear/differences.h"
#include "core/ode/certify/measure.h"
#include "core/ode/kernel/members.h"
#include "core/ode/variational/manifold.h"

enum {
    MOST = 2 * GM_SUBJECT_COMPONENTS,
    TANGENTS = 2 * GM_SUBJECT_TANGENTS,
    SQUARE = GM_SUBJECT_TANGENTS * GM_SUBJECT_TANGENTS
};

/* The derivative of one step at the start, and the derivative of its initial state: the identity, or under
   constraints that of the nearest state on the manifold; of components in units of their sizes. */
struct derivative {
    const struct gm_subject *subject;
    double dt;
    double at[TANGENTS][TANGENTS], start[TANGENTS][TANGENTS];
    double largest;
};

/* Writes the initial state of a step, followed by its final state. */
static bool make_step(const void *context, const double *from, double *to)
{
    const struct derivative *derivative = context;
    const struct gm_problem *problem = &derivative->subject->problem;
    const size_t n = gm_subject_components(derivative->subject);
    memcpy(to, from, n * sizeof *to);
    return (gm_action_constraints(problem) == 0 || gm_manifold_project(problem, to)) &&
           gm_subject_advance(derivative->subject, derivative->dt, 1, to, to + n);
}

static bool differentiate(const struct gm_subject *subject, double dt, double length,
                          struct derivative *derivative)
{
    const size_t n = gm_subject_components(subject);
    double from[MOST], along[TANGENTS] = {0}, slope[2 * TANGENTS];
    gm_subject_start(subject, from);
    derivative->subject = subject;
    derivative->dt = dt;
    derivative->largest = 0;
    for (size_t column = 0; column < n; column++) {
        along[column] = length * gm_subject_size(subject, column);
        if (!gm_differentiate(&(const struct gm_map){make_step, derivative, n, 2 * n}, from, along, slope)) {
            return false;
        }
        along[column] = 0;
        for (size_t row = 0; row < n; row++) {
            const double size = length * gm_subject_size(subject, row);
            derivative->start[row][column] = slope[row] / size;
            derivative->at[row][column] = slope[n + row] / size;
            derivative->largest = gm_larger(fabs(derivative->at[row][column]), derivative->largest);
        }
    }
    return isfinite(derivative->largest);
}

/* A defect of one step: NaN if the step fails; `clear` if it exceeds the error of its measurement. */
struct defect {
    double size;
    bool clear;
};

typedef double defect_of(const struct derivative *derivative);

/* mean := the mean of `count` derivatives; before, it is the mean of all but `next`. */
static void average(struct derivative *mean, const struct derivative *next, size_t n, int count)
{
    for (size_t i = 0; i < n * n; i++) {
        const size_t row = i / n, column = i % n;
        mean->at[row][column] += (next->at[row][column] - mean->at[row][column]) / count;
        mean->start[row][column] += (next->start[row][column] - mean->start[row][column]) / count;
    }
}

/* Returns a defect that is a polynomial of this degree in the entries of the derivative. It is clear if
   shorter differences give nearly the same entries. A defect near the tolerance is measured again with the
   mean of several derivatives, in which round-off is less. */
static struct defect of_derivative(const struct gm_subject *subject, double dt, double tolerance, int degree,
                                   defect_of *defect)
{
    enum { AVERAGED = 16 };
    const size_t n = gm_subject_components(subject);
    struct derivative derivative, closer;
    struct defect found = {.size = NAN};
    for (double length = 0.4; length > 2e-3 && !found.clear && !(found.size <= tolerance / 10); length /= 4) {
        if (!differentiate(subject, dt, length, &derivative)) {
            continue;
        }
        double size = defect(&derivative);
        for (int k = 1; k < AVERAGED && size > tolerance / 10 && size < 10 * tolerance &&
                        differentiate(subject, dt, length * (1 - k / 32.), &closer);
             k++) {
            average(&derivative, &closer, n, k + 1);
            size = defect(&derivative);
        }
        found.size = fmin(size, found.size);
        if (size > tolerance && differentiate(subject, dt, length / 3, &closer)) {
            double error = 0;
            for (size_t row = 0; row < n; row++) {
                error = fmax(error, gm_distance(derivative.at[row], closer.at[row], n));
            }
            const double stretch = degree * (double)n * gm_pow(fmax(1, derivative.largest), degree - 1);
            found.clear = size > 10 * stretch * error;
        }
    }
    return found;
}

/* form + dq ^ dp, summed over the copies of phase space, of two columns */
static double add_form(double form, const double (*tangent)[TANGENTS], const struct gm_subject *subject,
                       size_t a, size_t b)
{
    const size_t all = gm_subject_components(subject), n = subject->problem.n;
    for (size_t copy = 0; copy < all; copy += n) {
        for (size_t q = copy; q < copy + n / 2; q++) {
            form += tangent[q][a] * tangent[q + n / 2][b] - tangent[q + n / 2][a] * tangent[q][b];
        }
    }
    return form;
}

/* Returns how far areas differ from `area` times their value before the step. A time that is the last component is the
   same for all states of an area. */
static double areas_defect(const struct derivative *derivative, double area)
{
    const struct gm_subject *subject = derivative->subject;
    const size_t all = gm_subject_components(subject) - gm_has_time(&subject->problem);
    double defect = 0;
    for (size_t a = 0; a < all; a++) {
        for (size_t b = 0; b < all; b++) {
            const double wanted = area * add_form(0, derivative->start, subject, a, b);
            defect = fmax(defect, fabs(add_form(-wanted, derivative->at, subject, a, b)));
        }
    }
    return defect;
}

/* Omega_ij = d theta_j/d q_i - d theta_i/d q_j */
static void find_omega(const struct gm_problem *problem, const double *q, double *omega)
{
    const size_t n = problem->n;
    double weights[GM_SUBJECT_TANGENTS + 1] = {0}, values[GM_SUBJECT_TANGENTS + 1], curvature[SQUARE],
                                         slopes[SQUARE + GM_SUBJECT_TANGENTS];
    gm_ode_of(problem)->degenerate->functions(problem, q, weights, values, slopes, curvature);
    for (size_t i = 0; i < n * n; i++) {
        omega[i] = slopes[i % n * n + i / n] - slopes[i];
    }
}

/* The largest entry of M' A(y1) M - A(y0) for a matrix A of states that is a form, else of M A(y0) M' - A(y1); NaN if
   the step fails. */
static double carried_defect(const struct derivative *derivative, bool form,
                             void (*find)(const struct gm_problem *problem, const double *y, double *matrix))
{
    const struct gm_subject *subject = derivative->subject;
    const size_t n = subject->problem.n;
    double start[MOST], end[MOST], defect = 0, from[SQUARE], to[SQUARE];
    gm_subject_start(subject, start);
    if (!gm_subject_advance(subject, derivative->dt, 1, start, end)) {
        return NAN;
    }
    find(&subject->problem, form ? end : start, from);
    find(&subject->problem, form ? start : end, to);
    for (size_t i = 0; i < n * n; i++) { /* in units of the components' sizes, too */
        const double row = gm_subject_size(subject, i / n) / subject->scale,
                     column = gm_subject_size(subject, i % n) / subject->scale;
        from[i] = form ? from[i] * row * column : from[i] / (row * column);
        to[i] = form ? to[i] * row * column : to[i] / (row * column);
    }
    for (size_t row = 0; row < n; row++) {
        for (size_t column = 0; column < n; column++) {
            double carried = 0;
            for (size_t i = 0; i < n * n; i++) {
                const size_t k = i / n, l = i % n;
                carried += (form ? derivative->at[k][row] : derivative->at[row][k]) * from[i] *
                           (form ? derivative->at[l][column] : derivative->at[column][l]);
            }
            defect = fmax(defect, fabs(carried - to[row * n + column]));
        }
    }
    return defect;
}

static double form_defect(const struct derivative *derivative)
{
    return gm_ode_of(&derivative->subject->problem)->degenerate ? carried_defect(derivative, true, find_omega)
                                                                : areas_defect(derivative, 1);
}

static double conformal_form_defect(const struct derivative *derivative)
{
    return areas_defect(derivative, gm_exp(-gm_subject_friction(derivative->subject) * derivative->dt));
}

static double bracket_defect(const struct derivative *derivative)
{
    return carried_defect(derivative, false, gm_ode_of(&derivative->subject->problem)->poisson->bracket);
}

static double determinant_defect(const struct derivative *derivative)
{
    const size_t n = gm_subject_components(derivative->subject);
    struct derivative rest = *derivative; /* what elimination leaves */
    double determinant = 1;
    for (size_t i = 0; i < n; i++) {
        size_t pivot = i;
        for (size_t row = i + 1; row < n; row++) {
            pivot = fabs(rest.at[row][i]) > fabs(rest.at[pivot][i]) ? row : pivot;
        }
        for (size_t column = 0; column < n; column++) {
            const double entry = rest.at[pivot][column];
            rest.at[pivot][column] = pivot == i ? entry : -rest.at[i][column];
            rest.at[i][column] = entry;
        }
        determinant *= rest.at[i][i];
        for (size_t row = i + 1; row < n; row++) {
            const double factor = rest.at[row][i] / rest.at[i][i];
            for (size_t column = i; column < n; column++) {
                rest.at[row][column] -= factor * rest.at[i][column];
            }
        }
    }
    return fabs(determinant - 1);
}

/* The largest difference of two states, in units of the components' sizes. */
static double distance(const struct gm_subject *subject, const double *a, const double *b)
{
    double largest = 0;
    for (size_t c = 0; c < gm_subject_components(subject); c++) {
        largest = fmax(largest, fabs(a[c] - b[c]) / gm_subject_size(subject, c));
    }
    return largest;
}

/* Returns the distance of a reversed run's end from its start. An adaptive scheme makes 3 steps, so that its
   control has acted. */
static struct defect of_way_back(const struct gm_subject *subject, double dt, bool reflected)
{
    const int64_t steps = subject->scheme->family->adaptive ? 3 : 1;
    const double push = 1e-12 * gm_subject_size(subject, 0);
    double start[MOST], back[MOST], pushed[MOST];
    gm_subject_start(subject, start);
    if (!gm_subject_turn(subject, dt, steps, reflected, 0, back)) {
        return (struct defect){.size = NAN};
    }
    const double size = distance(subject, back, start);
    /* the size must exceed round-off times its growth on the return */
    const bool told = gm_subject_turn(subject, dt, steps, reflected, push, pushed);
    return (struct defect){size, told && size > 1e-2 * distance(subject, pushed, back)};
}

/* Claims about the derivative of a step: the defect of each is a polynomial of this degree in its entries; 0: the number
   of components. */
static const struct {
    enum gm_claim claim;
    int degree;
    defect_of *defect;
} of_step[] = {
    {GM_SYMPLECTIC, 2, form_defect},
    {GM_CONFORMAL, 2, conformal_form_defect},
    {GM_POISSON_MAP, 2, bracket_defect},
    {GM_KEEPS_VOLUME, 0, determinant_defect},
};

static struct defect defect_at(const struct gm_subject *subject, enum gm_claim claim, double dt,
                               double tolerance)
{
    for (size_t i = 0; i < GM_COUNT(of_step); i++) {
        if (of_step[i].claim == claim) {
            const int degree =
                of_step[i].degree > 0 ? of_step[i].degree : (int)gm_subject_components(subject);
            return of_derivative(subject, dt, tolerance, degree, of_step[i].defect);
        }
    }
    return of_way_back(subject, dt, claim == GM_REVERSIBLE);
}

/* Decides by steps of length dt, dt / 4, dt / 16. The defect of a scheme falls like a power of dt: a defect
   that vanishes suddenly came from another solution of the solver, or from a step that is far too large. */
static double decide(const struct gm_subject *subject, enum gm_claim claim, double tolerance)
{
    enum { SHORTER = 2, POWERS = 5 };
    const double steepest = gm_pow(4, (subject->scheme->order ? subject->scheme->order : 8) + POWERS),
                 roundoff = 1e-15;
    double dt = subject->scheme->family->adaptive ? subject->dt / 4 : subject->dt;
    for (int shorter = 0; shorter <= SHORTER; shorter++, dt /= 4) {
        const struct defect here = defect_at(subject, claim, dt, tolerance);
        if (here.size <= tolerance) {
            return here.size;
        }
        if (subject->problem.events) { /* a shorter step does not meet the event */
            return here.clear ? here.size : NAN;
        }
        if (here.clear) {
            const struct defect next = defect_at(subject, claim, dt / 4, tolerance);
            if (!(next.size <= tolerance) || here.size <= steepest * fmax(next.size, roundoff)) {
                return here.size;
            }
        }
    }
    return NAN;
}

double gm_step_error(const struct gm_subject *subject)
{
    double start[MOST], once[MOST], twice[MOST];
    gm_subject_start(subject, start);
    return gm_subject_advance(subject, subject->dt, 1, start, once) &&
                   gm_subject_advance(subject, subject->dt / 2, 2, start, twice)
               ? distance(subject, once, twice)
               : NAN;
}

/* The state after many smaller steps; false: they fail. */
static bool go_on(const struct gm_subject *subject, double *end)
{
    /* An adaptive scheme may end when no step is possible: the steps before count, if there are any. */
    const bool adaptive = subject->scheme->family->adaptive;
    const double dt = adaptive ? subject->dt / 200 : subject->dt / 12,
                 steps = fmax(adaptive ? 1000 : 100, ceil(1.1 * subject->passed / dt));
    double whole[MOST];
    gm_subject_start(subject, whole);
    return gm_subject_advance(subject, dt, (int64_t)steps, whole, end) ||
           (adaptive && memcmp(whole, end, gm_subject_components(subject) * sizeof *end) != 0);
}

double gm_kept_unit(const struct gm_subject *subject, const struct gm_kept *kept)
{
    enum { PARTS = 4, STEPS = 8 };
    const double other = 1e4, before = kept->value(kept->data, subject->start, NULL);
    const struct gm_subject between = gm_subject_between_events(subject);
    double start[MOST], end[MOST], terms = 0;
    gm_subject_start(subject, start);
    if (!gm_subject_advance(&between, subject->dt, STEPS, start, end)) {
        return 1;
    }
    for (int k = 1; k <= PARTS; k++) {
        double moved[MOST];
        for (size_t c = 0; c < subject->problem.n; c++) { /* some of the components, any */
            moved[c] = gm_sin(k * (double)(3 * c + 1)) > 0 ? end[c] : start[c];
        }
        terms = fmax(terms, fabs(kept->value(kept->data, moved, NULL) - before));
    }
    return terms > 0 && isfinite(terms) && (terms < 1 / other || terms > other) ? terms : 1;
}

double gm_kept_size(const struct gm_subject *subject, const struct gm_kept *kept)
{
    return fmax(gm_kept_unit(subject, kept), fabs(kept->value(kept->data, subject->start, NULL)));
}

double gm_drift(const struct gm_subject *subject, const struct gm_kept *kept)
{
    double end[MOST];
    const struct gm_subject between = gm_subject_between_events(subject);
    return go_on(&between, end)
               ? fabs(kept->value(kept->data, end, NULL) - kept->value(kept->data, subject->start, NULL)) /
                     gm_kept_size(subject, kept)
               : NAN;
}

double gm_round_off_of(const struct gm_subject *subject, const struct gm_kept *kept)
{
    double near[MOST];
    for (size_t c = 0; c < subject->problem.n; c++) {
        near[c] =
            subject->start[c] + 100 * DBL_EPSILON * gm_subject_size(subject, c) * gm_sin((double)(3 * c + 1));
    }
    return fabs(kept->value(kept->data, near, NULL) - kept->value(kept->data, subject->start, NULL));
}

static double energy_drift(const struct gm_subject *subject)
{
    const struct gm_ode *ode = gm_ode_of(&subject->problem);
    const struct gm_invariant energy = {ode->hamiltonian ? gm_energy : ode->poisson->energy,
                                        &subject->problem};
    return gm_drift(subject, &(const struct gm_kept){.value = gm_invariant_value, .data = &energy});
}

static double constraint_defect(const struct gm_subject *subject, bool hidden)
{
    double end[MOST];
    if (!go_on(subject, end)) {
        return NAN;
    }
    const struct gm_manifold_defects defects = gm_manifold_defects(&subject->problem, end);
    return hidden ? defects.hidden : defects.constraint;
}

double gm_defect(const struct gm_subject *subject, enum gm_claim claim, double tolerance)
{
    switch (claim) {
    case GM_KEEPS_ENERGY:
        return energy_drift(subject);
    case GM_KEEPS_CONSTRAINTS:
    case GM_KEEPS_HIDDEN:
        return constraint_defect(subject, claim == GM_KEEPS_HIDDEN);
    default:
        return decide(subject, claim, tolerance);
    }
}
