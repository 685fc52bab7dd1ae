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

#include "core/basics.h"
#include "core/ode/certify/measure.h"
#include "core/ode/kernel/members.h"
#include "core/ode/variational/manifold.h"

enum { MOST = 2 * GM_SUBJECT_COMPONENTS, TANGENTS = 2 * GM_SUBJECT_TANGENTS, LEVELS = 4 };

/* The derivative of one step at the start; the error of its entries is what the last extrapolation still
   changes. Under constraints the members begin on the manifold, as close as may be to where they would
   without; `start` is the derivative of where they begin, else the identity. */
struct derivative {
    double at[TANGENTS][TANGENTS], start[TANGENTS][TANGENTS];
    double error, largest;
};

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
            derivative->error = fmax(derivative->error, gm_romberg(table, LEVELS));
            derivative->error = held ? fmax(derivative->error, gm_romberg(begun, LEVELS)) : derivative->error;
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
    const double scale = subject->scale;
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
    return areas_defect(subject, scheme, derivative, exp(-gm_subject_friction(subject) * dt));
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

/* How far a run that turns round ends from its start. Where the scheme chooses its steps, a few of them, so
   that it has chosen some. */
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
    /* so many times round-off is stretched on the way back */
    const bool told = gm_subject_turn(subject, scheme, dt, steps, reflected, push, pushed);
    return (struct defect){size, told && size > 1e-14 * gm_distance(pushed, back, n) / push};
}

/* What is told of the derivative of a step. */
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

/* What steps of length dt, dt / 4, dt / 16 tell. The defect of a scheme falls like a power of dt: one that is
   gone all of a sudden was that of a solver that found another solution, or of a step beyond all measure. */
static double decide(const struct gm_subject *subject, const struct gm_scheme *scheme, enum gm_claim claim,
                     double tolerance)
{
    enum { SHORTER = 2, POWERS = 5 };
    const double steepest = pow(4, (scheme->order ? scheme->order : 8) + POWERS), roundoff = 1e-15;
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
    /* A scheme that chooses its step may end for want of one: what it has done counts. */
    const bool adaptive = scheme->family->adaptive;
    const double dt = adaptive ? subject->dt / 200 : subject->dt / 12;
    double whole[MOST];
    gm_subject_start(subject, scheme, whole);
    return gm_subject_advance(subject, scheme, dt, adaptive ? 1000 : 100, 1, whole, end) || adaptive;
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
        near[c] = subject->start[c] + 100 * DBL_EPSILON * subject->scale * sin((double)(3 * c + 1));
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
