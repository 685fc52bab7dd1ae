/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The defects of a scheme's geometry in a step or a short run: of symplecticity, volume, symmetry,
   reversibility, energy and other invariants. The derivative of a step is found by extrapolated differences,
   so it needs nothing from the scheme. A defect refutes a claim only if it exceeds the error of the
   measurement: steps that stretch phase space a millionfold stretch round-off too. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/functions/functions.h"
#include "core/linear/differences.h"
#include "core/ode/certify/measure.h"
#include "core/ode/kernel/members.h"
#include "core/ode/variational/manifold.h"

enum { MOST = 2 * GM_SUBJECT_COMPONENTS, TANGENTS = 2 * GM_SUBJECT_TANGENTS };

/* The derivative of one step at the start, and the derivative of its initial state: the identity, or under
   constraints that of the nearest state on the manifold. */
struct derivative {
    double at[TANGENTS][TANGENTS], start[TANGENTS][TANGENTS];
    double largest;
};

struct step {
    const struct gm_subject *subject;
    const struct gm_scheme *scheme;
    double dt;
};

/* Writes the initial state of a step, followed by its final state. */
static bool make_step(const void *context, const double *from, double *to)
{
    const struct step *step = context;
    const struct gm_problem *problem = &step->subject->problem;
    const size_t n = gm_subject_components(step->subject, step->scheme);
    memcpy(to, from, n * sizeof *to);
    return (gm_action_constraints(problem) == 0 || gm_manifold_project(problem, to)) &&
           gm_subject_advance(step->subject, step->scheme, step->dt, 1, to, to + n);
}

static bool differentiate(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                          double length, struct derivative *derivative)
{
    const size_t n = gm_subject_components(subject, scheme);
    double from[MOST], along[TANGENTS] = {0}, slope[2 * TANGENTS];
    gm_subject_start(subject, scheme, from);
    derivative->largest = 0;
    for (size_t column = 0; column < n; column++) {
        along[column] = length;
        if (!gm_differentiate(make_step, &(const struct step){subject, scheme, dt}, n, from, along, 2 * n,
                              slope)) {
            return false;
        }
        along[column] = 0;
        for (size_t row = 0; row < n; row++) {
            derivative->start[row][column] = slope[row] / length;
            derivative->at[row][column] = slope[n + row] / length;
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

typedef double defect_of(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                         const struct derivative *derivative);

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
static struct defect of_derivative(const struct gm_subject *subject, const struct gm_scheme *scheme,
                                   double dt, double tolerance, int degree, defect_of *defect)
{
    enum { AVERAGED = 16 };
    const size_t n = gm_subject_components(subject, scheme);
    struct derivative derivative, closer;
    struct defect found = {.size = NAN};
    for (double length = 0.4 * subject->scale;
         length > 2e-3 * subject->scale && !found.clear && !(found.size <= tolerance / 10); length /= 4) {
        if (!differentiate(subject, scheme, dt, length, &derivative)) {
            continue;
        }
        double size = defect(subject, scheme, dt, &derivative);
        for (int k = 1; k < AVERAGED && size > tolerance / 10 && size < 10 * tolerance &&
                        differentiate(subject, scheme, dt, length * (1 - k / 32.), &closer);
             k++) {
            average(&derivative, &closer, n, k + 1);
            size = defect(subject, scheme, dt, &derivative);
        }
        found.size = fmin(size, found.size);
        if (size > tolerance && differentiate(subject, scheme, dt, length / 3, &closer)) {
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
static double add_form(double form, const double (*tangent)[TANGENTS], size_t all, size_t n, size_t a,
                       size_t b)
{
    for (size_t copy = 0; copy < all; copy += n) {
        for (size_t q = copy; q < copy + n / 2; q++) {
            form += tangent[q][a] * tangent[q + n / 2][b] - tangent[q + n / 2][a] * tangent[q][b];
        }
    }
    return form;
}

/* Returns how far areas differ from `area` times their value before the step. */
static double areas_defect(const struct gm_subject *subject, const struct gm_scheme *scheme,
                           const struct derivative *derivative, double area)
{
    const size_t all = gm_subject_components(subject, scheme), n = subject->problem.n;
    double defect = 0;
    for (size_t a = 0; a < all; a++) {
        for (size_t b = 0; b < all; b++) {
            const double wanted = area * add_form(0, derivative->start, all, n, a, b);
            defect = fmax(defect, fabs(add_form(-wanted, derivative->at, all, n, a, b)));
        }
    }
    return defect;
}

static double form_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                          const struct derivative *derivative)
{
    (void)dt;
    return areas_defect(subject, scheme, derivative, 1);
}

static double conformal_form_defect(const struct gm_subject *subject, const struct gm_scheme *scheme,
                                    double dt, const struct derivative *derivative)
{
    return areas_defect(subject, scheme, derivative, gm_exp(-gm_subject_friction(subject) * dt));
}

static double bracket_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                             const struct derivative *derivative)
{
    const struct gm_poisson *poisson = gm_ode_of(&subject->problem)->poisson;
    const size_t n = subject->problem.n;
    double start[MOST], end[MOST], *before = malloc(2 * n * n * sizeof *before),
                                   *after = before ? before + n * n : NULL, defect = 0;
    gm_subject_start(subject, scheme, start);
    if (!before || !gm_subject_advance(subject, scheme, dt, 1, start, end)) {
        free(before);
        return NAN;
    }
    poisson->bracket(&subject->problem, start, before);
    poisson->bracket(&subject->problem, end, after);
    for (size_t a = 0; a < n; a++) {
        for (size_t b = 0; b < n; b++) {
            double carried = 0;
            for (size_t i = 0; i < n * n; i++) {
                carried += derivative->at[a][i / n] * before[i] * derivative->at[b][i % n];
            }
            defect = fmax(defect, fabs(carried - after[a * n + b]));
        }
    }
    free(before);
    return defect;
}

static double determinant_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                                 const struct derivative *derivative)
{
    const double(*tangent)[TANGENTS] = derivative->at;
    (void)subject;
    (void)scheme;
    (void)dt;
    double determinant = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        determinant += tangent[0][i] * (tangent[1][j] * tangent[2][k] - tangent[1][k] * tangent[2][j]);
    }
    return fabs(determinant - 1);
}

/* Returns the distance of a reversed run's end from its start. An adaptive scheme makes 3 steps, so that its
   control has acted. */
static struct defect of_way_back(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                                 bool reflected)
{
    const int64_t steps = scheme->family->adaptive ? 3 : 1;
    const size_t n = gm_subject_components(subject, scheme);
    const double push = 1e-12 * subject->scale;
    double start[MOST], back[MOST], pushed[MOST];
    gm_subject_start(subject, scheme, start);
    if (!gm_subject_turn(subject, scheme, dt, steps, reflected, 0, back)) {
        return (struct defect){.size = NAN};
    }
    const double size = gm_distance(back, start, n) / subject->scale;
    /* the size must exceed round-off times its growth on the return */
    const bool told = gm_subject_turn(subject, scheme, dt, steps, reflected, push, pushed);
    return (struct defect){size, told && size > 1e-14 * gm_distance(pushed, back, n) / push};
}

/* Claims about the derivative of a step: the defect of each is a polynomial of this degree in its entries. */
static const struct {
    enum gm_claim claim;
    int degree;
    defect_of *defect;
} of_step[] = {
    {GM_SYMPLECTIC, 2, form_defect},
    {GM_CONFORMAL, 2, conformal_form_defect},
    {GM_POISSON_MAP, 2, bracket_defect},
    {GM_KEEPS_VOLUME, 3, determinant_defect},
};

static struct defect defect_at(const struct gm_subject *subject, const struct gm_scheme *scheme,
                               enum gm_claim claim, double dt, double tolerance)
{
    for (size_t i = 0; i < GM_COUNT(of_step); i++) {
        if (of_step[i].claim == claim) {
            return of_derivative(subject, scheme, dt, tolerance, of_step[i].degree, of_step[i].defect);
        }
    }
    return of_way_back(subject, scheme, dt, claim == GM_REVERSIBLE);
}

/* Decides by steps of length dt, dt / 4, dt / 16. The defect of a scheme falls like a power of dt: a defect
   that vanishes suddenly came from another solution of the solver, or from a step that is far too large. */
static double decide(const struct gm_subject *subject, const struct gm_scheme *scheme, enum gm_claim claim,
                     double tolerance)
{
    enum { SHORTER = 2, POWERS = 5 };
    const double steepest = gm_pow(4, (scheme->order ? scheme->order : 8) + POWERS), roundoff = 1e-15;
    double dt = scheme->family->adaptive ? subject->dt / 4 : subject->dt;
    for (int shorter = 0; shorter <= SHORTER; shorter++, dt /= 4) {
        const struct defect here = defect_at(subject, scheme, claim, dt, tolerance);
        if (here.size <= tolerance) {
            return here.size;
        }
        if (here.clear) {
            const struct defect next = defect_at(subject, scheme, claim, dt / 4, tolerance);
            if (!(next.size <= tolerance) || here.size <= steepest * fmax(next.size, roundoff)) {
                return here.size;
            }
        }
    }
    return NAN;
}

/* The state after many smaller steps; false: they fail. */
static bool go_on(const struct gm_subject *subject, const struct gm_scheme *scheme, double *end)
{
    /* An adaptive scheme may end when no step is possible: the steps before count. */
    const bool adaptive = scheme->family->adaptive;
    const double dt = adaptive ? subject->dt / 200 : subject->dt / 12;
    double whole[MOST];
    gm_subject_start(subject, scheme, whole);
    return gm_subject_advance(subject, scheme, dt, adaptive ? 1000 : 100, whole, end) || adaptive;
}

static double change_of(const struct gm_kept *kept, const double *from, const double *to)
{
    const double before = kept->value(kept->data, from, NULL), after = kept->value(kept->data, to, NULL);
    return fabs(after - before) / fmax(1, fabs(before));
}

double gm_drift(const struct gm_subject *subject, const struct gm_scheme *scheme, const struct gm_kept *kept)
{
    double end[MOST];
    return go_on(subject, scheme, end) ? change_of(kept, subject->start, end) : NAN;
}

double gm_round_off_of(const struct gm_subject *subject, const struct gm_kept *kept)
{
    double near[MOST];
    for (size_t c = 0; c < subject->problem.n; c++) {
        near[c] = subject->start[c] + 100 * DBL_EPSILON * subject->scale * gm_sin((double)(3 * c + 1));
    }
    return change_of(kept, subject->start, near);
}

static double energy_drift(const struct gm_subject *subject, const struct gm_scheme *scheme)
{
    const struct gm_ode *ode = gm_ode_of(&subject->problem);
    const struct gm_invariant energy = {ode->hamiltonian ? gm_energy : ode->poisson->energy,
                                        &subject->problem};
    return gm_drift(subject, scheme, &(const struct gm_kept){.value = gm_invariant_value, .data = &energy});
}

static double constraint_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, bool hidden)
{
    double end[MOST];
    if (!go_on(subject, scheme, end)) {
        return NAN;
    }
    const struct gm_manifold_defects defects = gm_manifold_defects(&subject->problem, end);
    return hidden ? defects.hidden : defects.constraint;
}

double gm_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, enum gm_claim claim,
                 double tolerance)
{
    switch (claim) {
    case GM_KEEPS_ENERGY:
        return energy_drift(subject, scheme);
    case GM_KEEPS_CONSTRAINTS:
    case GM_KEEPS_HIDDEN:
        return constraint_defect(subject, scheme, claim == GM_KEEPS_HIDDEN);
    default:
        return decide(subject, scheme, claim, tolerance);
    }
}
