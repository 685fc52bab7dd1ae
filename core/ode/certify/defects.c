/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What of the geometry a scheme breaks in a step or a short run: the defects of symplecticity, volume,
   symmetry, reversibility, energy and other invariants. The derivative of a step is found by extrapolated
   differences between members of an ensemble, so it asks nothing of the scheme. A defect refutes a claim only
   where it stands clear of the error of the measurement: steps that stretch phase space a millionfold stretch
   round-off too. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/certify/measure.h"
#include "core/ode/kernel/members.h"
#include "core/ode/variational/manifold.h"
#include "core/run.h"

enum { MOST = 2 * GM_SUBJECT_COMPONENTS, TANGENTS = 2 * GM_SUBJECT_TANGENTS, LEVELS = 4 };

/* The derivative of one step at the start; the error of its entries is what the last extrapolation still
   changes. Under constraints the members begin on the manifold, as close as may be to where they would
   without; `start` is the derivative of where they begin, else the identity. */
struct derivative {
    double at[TANGENTS][TANGENTS], start[TANGENTS][TANGENTS];
    double error, largest;
};

/* by Romberg's scheme; returns the last change */
static double extrapolate(double table[LEVELS])
{
    double power = 4, last = 0;
    for (size_t done = 1; done < LEVELS; done++, power *= 4) {
        for (size_t level = LEVELS - 1; level >= done; level--) {
            last = (table[level] - table[level - 1]) / (power - 1);
            table[level] += last;
        }
    }
    return fabs(last);
}

/* Every member of a start onto the manifold of the constraints. */
static bool project(const struct gm_problem *problem, size_t members, double *start)
{
    double y[MOST];
    bool good = true;
    for (size_t member = 0; good && member < members; member++) {
        for (size_t c = 0; c < problem->n; c++) {
            y[c] = start[c * members + member];
        }
        good = gm_manifold_project(problem, y);
        for (size_t c = 0; c < problem->n; c++) {
            start[c * members + member] = y[c];
        }
    }
    return good;
}

static bool differentiate(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                          double widest, struct derivative *derivative)
{
    const size_t n = gm_subject_components(subject, scheme), members = n * LEVELS * 2;
    double from[MOST], *start = malloc(2 * n * members * sizeof *start),
                       *end = start ? start + n * members : NULL;
    if (!start) {
        return false;
    }
    derivative->error = derivative->largest = 0;
    gm_subject_start(subject, scheme, from);
    for (size_t column = 0; column < n; column++) {
        for (size_t level = 0; level < LEVELS; level++) {
            for (size_t side = 0; side < 2; side++) {
                const size_t member = (column * LEVELS + level) * 2 + side;
                for (size_t c = 0; c < n; c++) {
                    const double shift = c == column ? ldexp(widest, -(int)level) : 0;
                    start[c * members + member] = from[c] + (side ? -shift : shift);
                }
            }
        }
    }
    const bool held = gm_action_constraints(&subject->problem) > 0;
    const bool made = (!held || project(&subject->problem, members, start)) &&
                      gm_subject_advance(subject, scheme, dt, 1, members, start, end);
    for (size_t row = 0; made && row < n; row++) {
        for (size_t column = 0; column < n; column++) {
            double table[LEVELS], begun[LEVELS];
            for (size_t level = 0; level < LEVELS; level++) {
                const size_t at = row * members + (column * LEVELS + level) * 2;
                const size_t below = column * members + (column * LEVELS + level) * 2;
                const double apart = held ? ldexp(2 * widest, -(int)level) : start[below] - start[below + 1];
                table[level] = (end[at] - end[at + 1]) / apart;
                begun[level] = (start[at] - start[at + 1]) / apart;
            }
            derivative->error = fmax(derivative->error, extrapolate(table));
            derivative->error = held ? fmax(derivative->error, extrapolate(begun)) : derivative->error;
            derivative->start[row][column] = held ? begun[LEVELS - 1] : row == column;
            derivative->at[row][column] = table[LEVELS - 1];
            derivative->largest = fmax(derivative->largest, fabs(table[LEVELS - 1]));
        }
    }
    free(start);
    return made && isfinite(derivative->largest) && isfinite(derivative->error);
}

/* A defect of one step: NaN where it fails; clear where it stands clear of the error of its measurement. */
struct defect {
    double size;
    bool clear;
};

typedef struct defect defect_at(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                                double tolerance);

/* What steps of length dt, dt / 4, dt / 16 tell. The defect of a scheme falls like a power of dt: one that is
   gone all of a sudden was that of a solver that found another solution, or of a step beyond all measure. */
static double decide(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                     double tolerance, defect_at *measure)
{
    enum { SHORTER = 2, POWERS = 5 };
    const double steepest = pow(4, (scheme->order ? scheme->order : 8) + POWERS), roundoff = 1e-15;
    for (int shorter = 0; shorter <= SHORTER; shorter++, dt /= 4) {
        const struct defect here = measure(subject, scheme, dt, tolerance);
        if (here.size <= tolerance) {
            return here.size;
        }
        if (here.clear) {
            const struct defect next = measure(subject, scheme, dt / 4, tolerance);
            if (!(next.size <= tolerance) || here.size <= steepest * fmax(next.size, roundoff)) {
                return here.size;
            }
        }
    }
    return NAN;
}

typedef double defect_of(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                         const struct derivative *derivative);

/* Of a polynomial of this degree in the entries of the derivative, which has to be the same between closer
   members. */
static struct defect of_derivative(const struct gm_subject *subject, const struct gm_scheme *scheme,
                                   double dt, double tolerance, int degree, defect_of *defect)
{
    const size_t n = gm_subject_components(subject, scheme);
    struct derivative derivative, closer;
    struct defect found = {.size = NAN};
    const double scale = subject->scale > 0 ? subject->scale : 1;
    for (double distance = 0.02 * scale;
         distance > 1e-4 * scale && !found.clear && !(found.size <= tolerance); distance /= 4) {
        if (!differentiate(subject, scheme, dt, distance, &derivative)) {
            continue;
        }
        found.size = defect(subject, scheme, dt, &derivative);
        if (found.size > tolerance && differentiate(subject, scheme, dt, distance / 4, &closer)) {
            double error = derivative.error;
            for (size_t row = 0; row < n; row++) {
                error = fmax(error, gm_distance(derivative.at[row], closer.at[row], n));
            }
            const double stretch = degree * (double)n * pow(fmax(1, derivative.largest), degree - 1);
            found.clear = found.size > 10 * stretch * error;
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

/* Every area is to be `area` times what it was. */
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
    return areas_defect(subject, scheme, derivative, exp(-subject->friction * dt));
}

static struct defect of_form(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                             double tolerance)
{
    return of_derivative(subject, scheme, dt, tolerance, 2, form_defect);
}

double gm_symplecticity_defect(const struct gm_subject *subject, const struct gm_scheme *scheme,
                               double tolerance)
{
    return decide(subject, scheme, subject->dt, tolerance, of_form);
}

static struct defect of_conformal_form(const struct gm_subject *subject, const struct gm_scheme *scheme,
                                       double dt, double tolerance)
{
    return of_derivative(subject, scheme, dt, tolerance, 2, conformal_form_defect);
}

double gm_conformal_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, double tolerance)
{
    return decide(subject, scheme, subject->dt, tolerance, of_conformal_form);
}

static double bracket_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                             const struct derivative *derivative)
{
    const struct gm_poisson *poisson = gm_ode_of(&subject->problem)->poisson;
    const size_t n = subject->problem.n;
    double start[MOST], end[MOST], *before = malloc(2 * n * n * sizeof *before),
                                   *after = before ? before + n * n : NULL, defect = 0;
    gm_subject_start(subject, scheme, start);
    if (!before || !gm_subject_advance(subject, scheme, dt, 1, 1, start, end)) {
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

static struct defect of_bracket(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                                double tolerance)
{
    return of_derivative(subject, scheme, dt, tolerance, 2, bracket_defect);
}

double gm_poisson_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, double tolerance)
{
    return decide(subject, scheme, subject->dt, tolerance, of_bracket);
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

static struct defect of_determinant(const struct gm_subject *subject, const struct gm_scheme *scheme,
                                    double dt, double tolerance)
{
    return of_derivative(subject, scheme, dt, tolerance, 3, determinant_defect);
}

double gm_volume_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, double tolerance)
{
    return subject->problem.n == 3 ? decide(subject, scheme, subject->dt, tolerance, of_determinant) : NAN;
}

/* How far a run that turns round ends from its start. Where the scheme chooses its steps, a few of them, so
   that it has chosen some. */
static struct defect of_way_back(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                                 bool reflected)
{
    const int64_t steps = scheme->family->adaptive ? 3 : 1;
    const size_t n = gm_subject_components(subject, scheme);
    const double scale = subject->scale > 0 ? subject->scale : 1, push = 1e-12 * scale;
    double start[MOST], back[MOST], pushed[MOST];
    gm_subject_start(subject, scheme, start);
    if (!gm_subject_turn(subject, scheme, dt, steps, reflected, 0, back)) {
        return (struct defect){.size = NAN};
    }
    const double size = gm_distance(back, start, n) / scale;
    /* so many times round-off is stretched on the way back */
    const bool told = gm_subject_turn(subject, scheme, dt, steps, reflected, push, pushed);
    return (struct defect){size, told && size > 1e-14 * gm_distance(pushed, back, n) / push};
}

static struct defect of_return(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                               double tolerance)
{
    return (void)tolerance, of_way_back(subject, scheme, dt, false);
}

static struct defect of_reflection(const struct gm_subject *subject, const struct gm_scheme *scheme,
                                   double dt, double tolerance)
{
    return (void)tolerance, of_way_back(subject, scheme, dt, true);
}

static double step_of(const struct gm_subject *subject, const struct gm_scheme *scheme)
{
    return scheme->family->adaptive ? subject->dt / 4 : subject->dt;
}

double gm_symmetry_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, double tolerance)
{
    return decide(subject, scheme, step_of(subject, scheme), tolerance, of_return);
}

double gm_reversibility_defect(const struct gm_subject *subject, const struct gm_scheme *scheme,
                               double tolerance)
{
    return decide(subject, scheme, step_of(subject, scheme), tolerance, of_reflection);
}

/* The state after many smaller steps; false: they fail. */
static bool go_on(const struct gm_subject *subject, const struct gm_scheme *scheme, double *end)
{
    /* A scheme that chooses its step may end for want of one: what it has done counts. */
    const bool adaptive = scheme->family->adaptive;
    const double dt = adaptive ? subject->dt / 200 : subject->dt / 12;
    double whole[MOST];
    gm_subject_start(subject, scheme, whole);
    return gm_subject_advance(subject, scheme, dt, adaptive ? 1000 : 100, 1, whole, end) || adaptive;
}

struct gm_manifold_defects gm_constraint_defects(const struct gm_subject *subject,
                                                 const struct gm_scheme *scheme)
{
    double end[MOST];
    return go_on(subject, scheme, end) ? gm_manifold_defects(&subject->problem, end)
                                       : (struct gm_manifold_defects){NAN, NAN};
}

static double change_of(double before, double after)
{
    return fabs(after - before) / fmax(1, fabs(before));
}

double gm_drift_of(const struct gm_subject *subject, const struct gm_scheme *scheme,
                   const struct gm_kept *kept)
{
    double end[MOST];
    return go_on(subject, scheme, end)
               ? change_of(kept->value(kept->data, subject->start, NULL), kept->value(kept->data, end, NULL))
               : NAN;
}

double gm_round_off_of(const struct gm_subject *subject, const struct gm_kept *kept)
{
    double near[MOST];
    for (size_t c = 0; c < subject->problem.n; c++) {
        near[c] = subject->start[c] + 100 * DBL_EPSILON * subject->scale * sin((double)(3 * c + 1));
    }
    return change_of(kept->value(kept->data, subject->start, NULL), kept->value(kept->data, near, NULL));
}

double gm_drift(const struct gm_subject *subject, const struct gm_scheme *scheme,
                gm_invariant *const *quantities, size_t count)
{
    double end[MOST], largest = 0;
    if (!go_on(subject, scheme, end)) {
        return NAN;
    }
    for (size_t i = 0; i < count && quantities[i]; i++) {
        largest = fmax(largest, change_of(quantities[i](&subject->problem, subject->start),
                                          quantities[i](&subject->problem, end)));
    }
    return largest;
}

double gm_energy_drift(const struct gm_subject *subject, const struct gm_scheme *scheme)
{
    static gm_invariant *const energies[] = {gm_energy};
    return gm_drift(subject, scheme, energies, 1);
}
